// A moving point outside the sphere through four others: the certificate of Delaunay and regular triangulations in
// space.
#pragma once

#include "certificates/squared.hpp"
#include "kds/bounded.hpp"
#include "kds/certificate.hpp"
#include "kds/lasting.hpp"
#include "kds/motion.hpp"
#include "kds/odd_permutation.hpp"

namespace kds::certificates {

/// A moving point with a weight, in units of length squared: `weight()` gives it as a motion. Its power distance from x
/// is |x - point|^2 - weight.
template <class Path>
concept Weighted = requires(const Path& path) {
  path.weight();
};

/// e is not inside the sphere through a, b, c, d, which are positively oriented. With weights: the power distance of e
/// from the orthogonal sphere of the four is not less than its weight.
///
/// The determinant of the rows (x, y, z, x^2 + y^2 + z^2 - w), where x, y, z and w are a - e, b - e, c - e, d - e.
/// Degree 5 for linear, 10 for quadratic paths; weights of up to twice the degree of the paths leave it at that. Law:
/// even permutations of the five leave it as it is, odd ones change its sign; so the facet between two tetrahedra has
/// the same certificate seen from either side. Papers: [Shewchuk97] for the expansion, [Edelsbrunner96] for weights.
template <class Path>
struct InSphere {
  static constexpr int degree = 5 * Path::degree;
  const Path& a;
  const Path& b;
  const Path& c;
  const Path& d;
  const Path& e;

  InSphere(Lasting<Path> first, Lasting<Path> second, Lasting<Path> third, Lasting<Path> fourth, Lasting<Path> fifth)
      : a(first), b(second), c(third), d(fourth), e(fifth) {}

  template <class Number>
  auto polynomial(double epoch) const {
    return value([&](const auto& p, const auto& q) { return difference_about<Number>(p, q, epoch); });
  }

  Ball<DoubleDouble> extended_value(double t) const {
    return value([&](const auto& p, const auto& q) { return extended_difference(p, q, t); });
  }

  /// Cheap and sufficient: two of the five are the same point.
  bool vanishes() const {
    return a == b || a == c || a == d || a == e || b == c || b == d || b == e || c == d || c == e || d == e;
  }

  bool is_negative_of(const InSphere& other) const {
    return is_odd_permutation<Path, 5>({&a, &b, &c, &d, &e}, {&other.a, &other.b, &other.c, &other.d, &other.e});
  }

 private:
  template <class From>
  auto value(const From& from) const {
    const auto ax = from(a.axis(0), e.axis(0)), ay = from(a.axis(1), e.axis(1)), az = from(a.axis(2), e.axis(2));
    const auto bx = from(b.axis(0), e.axis(0)), by = from(b.axis(1), e.axis(1)), bz = from(b.axis(2), e.axis(2));
    const auto cx = from(c.axis(0), e.axis(0)), cy = from(c.axis(1), e.axis(1)), cz = from(c.axis(2), e.axis(2));
    const auto dx = from(d.axis(0), e.axis(0)), dy = from(d.axis(1), e.axis(1)), dz = from(d.axis(2), e.axis(2));
    const auto height = [&](const Path& p, const auto& x, const auto& y, const auto& z) {
      const auto sum = detail::squared(x) + detail::squared(y) + detail::squared(z);
      if constexpr (Weighted<Path>) {
        return sum - from(p.weight(), e.weight());
      } else {
        return (void)p, sum;
      }
    };
    const auto ab = ax * by - ay * bx, ac = ax * cy - ay * cx, ad = ax * dy - ay * dx;
    const auto bc = bx * cy - by * cx, bd = bx * dy - by * dx, cd = cx * dy - cy * dx;
    return (height(d, dx, dy, dz) * (az * bc - bz * ac + cz * ab) -
            height(c, cx, cy, cz) * (az * bd - bz * ad + dz * ab)) +
           (height(b, bx, by, bz) * (az * cd - cz * ad + dz * ac) -
            height(a, ax, ay, az) * (bz * cd - cz * bd + dz * bc));
  }
};

template <class Path>
InSphere(const Path&, const Path&, const Path&, const Path&, const Path&) -> InSphere<Path>;

}  // namespace kds::certificates
