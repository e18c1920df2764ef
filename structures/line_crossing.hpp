// Points of the plane where lines given in doubles cross, and exact signs of such points.
#pragma once

#include "kds/arithmetic/ball.hpp"
#include "kds/arithmetic/exact.hpp"

#include <array>
#include <type_traits>

namespace kds::structures {

/// A line through a point, and which way along it: length, and length or length/s. The direction is not zero.
struct DirectedLine {
  std::array<double, 2> point, direction;
};

/// The point (x / w, y / w), w > 0: of what doubles generate by sums and products.
template <class Number>
struct RatioPoint {
  Number x, y, w;
};

namespace detail {

/// The sign of a formula without time, f<Number>(): with error balls where these decide, else exactly.
template <class Formula>
int sign_of_formula(const Formula& f) {
  const int sign = certain_sign(f.template operator()<Ball<double>>());
  return sign != 0 ? sign : f.template operator()<Exact>().sign();
}

template <class Number>
Number cross_product(const std::array<Number, 2>& a, const std::array<Number, 2>& b) {
  return a[0] * b[1] - a[1] * b[0];
}
template <class Number>
std::array<Number, 2> numbers(const std::array<double, 2>& a) {
  return {Number(a[0]), Number(a[1])};
}
template <class Number>
std::array<Number, 2> numbers_between(const std::array<double, 2>& from, const std::array<double, 2>& to) {
  return {Number(to[0]) - Number(from[0]), Number(to[1]) - Number(from[1])};
}

}  // namespace detail

/// A point of the plane that is known exactly, and in doubles with bounds on their errors, which nearly always suffice.
class LinePoint {
 public:
  /// `formula<Number>()` gives it as a RatioPoint<Number>, whose w is not zero and may be negative.
  template <class Formula>
  explicit LinePoint(const Formula& formula)
      : exact_(formula.template operator()<Exact>()), rounded_(formula.template operator()<Ball<double>>()) {
    if (exact_.w.sign() > 0) return;
    exact_ = {-exact_.x, -exact_.y, -exact_.w};
    rounded_ = {-rounded_.x, -rounded_.y, -rounded_.w};
  }
  /// Where two lines cross. Precondition: they are not parallel.
  static LinePoint crossing(const DirectedLine& a, const DirectedLine& b) {
    return LinePoint([&]<class Number>() {
      const auto v = detail::numbers<Number>(a.direction), u = detail::numbers<Number>(b.direction);
      const Number w = detail::cross_product(v, u);
      const Number way = detail::cross_product(detail::numbers_between<Number>(a.point, b.point), u);
      return RatioPoint<Number>{Number(a.point[0]) * w + v[0] * way, Number(a.point[1]) * w + v[1] * way, w};
    });
  }

  const RatioPoint<Exact>& exact() const { return exact_; }
  /// Less than 2^-bits below or above the point in either coordinate, and nearer to the origin.
  std::array<Exact, 2> truncated(int bits) const {
    return {truncated_quotient(exact_.x, exact_.w, bits), truncated_quotient(exact_.y, exact_.w, bits)};
  }

  /// -1 if a comes before b from left to right, and from below to above where both have one x; 0 if they are the same.
  friend int order(const LinePoint& a, const LinePoint& b) {
    const auto compare = [&](auto x) {
      const auto f = [&]<class Number>() {
        const auto &p = a.template in<Number>(), &q = b.template in<Number>();
        return p.*x(p) * q.w - q.*x(q) * p.w;
      };
      return detail::sign_of_formula(f);
    };
    const int sign = compare([]<class Number>(const RatioPoint<Number>&) { return &RatioPoint<Number>::x; });
    if (sign != 0) return sign;
    return compare([]<class Number>(const RatioPoint<Number>&) { return &RatioPoint<Number>::y; });
  }
  /// 1 if the point is to the left of the line, 0 if it is on it.
  friend int side(const LinePoint& a, const DirectedLine& line) {
    return detail::sign_of_formula([&]<class Number>() {
      const auto& p = a.template in<Number>();
      const auto v = detail::numbers<Number>(line.direction);
      return v[0] * (p.y - Number(line.point[1]) * p.w) - v[1] * (p.x - Number(line.point[0]) * p.w);
    });
  }

 private:
  template <class Number>
  const RatioPoint<Number>& in() const {
    if constexpr (std::is_same_v<Number, Exact>) {
      return exact_;
    } else {
      return rounded_;
    }
  }

  RatioPoint<Exact> exact_;
  RatioPoint<Ball<double>> rounded_;
};

/// 1 if the direction of b is to the left of that of a, 0 if the lines are parallel.
inline int turn(const DirectedLine& a, const DirectedLine& b) {
  return detail::sign_of_formula([&]<class Number>() {
    return detail::cross_product(detail::numbers<Number>(a.direction), detail::numbers<Number>(b.direction));
  });
}

}  // namespace kds::structures
