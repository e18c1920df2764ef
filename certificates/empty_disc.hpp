// Moving points and the smallest discs that contain others: how large the discs are, and what is outside.
#pragma once

#include "certificates/squared.hpp"
#include "kds/bounded.hpp"
#include "kds/certificate.hpp"
#include "kds/lasting.hpp"
#include "kds/motion.hpp"

namespace kds::certificates {

/// sign (a - c) . (b - c) >= 0: c is not inside the disc that has a and b as ends of a diameter, the smallest that
/// contains both; in other words, the angle at c is not obtuse. Degree 2 for linear, 4 for quadratic paths.
template <class Path>
struct OutsideDisc {
  static constexpr int degree = 2 * Path::degree;
  Held<Path> a;
  Held<Path> b;
  Held<Path> c;
  double sign;  ///< 1: outside; -1: inside

  OutsideDisc(Lasting<Path> first, Lasting<Path> second, Lasting<Path> third, double side)
      : a(first), b(second), c(third), sign(side) {}

  template <class Number>
  auto polynomial(double epoch) const {
    return value([&](const Path& p, int axis) { return difference_about<Number>(p.axis(axis), c.axis(axis), epoch); });
  }
  Ball<DoubleDouble> extended_value(double t) const requires(!requires { Path::sampled; }) {
    return value([&](const Path& p, int axis) { return extended_difference(p.axis(axis), c.axis(axis), t); });
  }
  /// Cheap and sufficient: c is one of the ends.
  bool vanishes() const requires(!requires { Path::sampled; }) { return a == c || b == c; }
  bool is_negative_of(const OutsideDisc& other) const {
    return sign == -other.sign && is_same_thing(a, other.a) && is_same_thing(b, other.b) && is_same_thing(c, other.c);
  }

 private:
  template <class From>
  auto value(const From& from_c) const {
    return (from_c(a, 0) * from_c(b, 0) + from_c(a, 1) * from_c(b, 1)) * sign;
  }
};

/// sign (4 r^2 - |b - a|^2) >= 0: the smallest disc that contains a and b has at most the radius r. Degree 2 for
/// linear, 4 for quadratic paths.
template <class Path>
struct PairRadius {
  static constexpr int degree = 2 * Path::degree;
  Held<Path> a;
  Held<Path> b;
  double radius;
  double sign;  ///< 1: at most this radius; -1: at least

  PairRadius(Lasting<Path> first, Lasting<Path> second, double limit, double side)
      : a(first), b(second), radius(limit), sign(side) {}

  bool is_negative_of(const PairRadius& other) const {
    return sign == -other.sign && is_same_thing(a, other.a) && is_same_thing(b, other.b) && radius == other.radius;
  }

  template <class Number>
  auto polynomial(double epoch) const {
    const auto apart = [&](int axis) {
      return detail::squared(difference_about<Number>(b.axis(axis), a.axis(axis), epoch));
    };
    return (apart(0) + apart(1) - detail::squared(constant<Number>(radius)) * 4.0) * -sign;
  }
};

/// sign (4 r^2 D^2 - |b - a|^2 |c - b|^2 |a - c|^2) >= 0, D being twice the area of the triangle a, b, c: the circle
/// through the three has at most the radius r. Degree 6 for linear, 12 for quadratic paths. Law: the order of a, b, c
/// does not matter.
template <class Path>
struct CircleRadius {
  static constexpr int degree = 6 * Path::degree;
  Held<Path> a;
  Held<Path> b;
  Held<Path> c;
  double radius;
  double sign;  ///< 1: at most this radius; -1: at least

  CircleRadius(Lasting<Path> first, Lasting<Path> second, Lasting<Path> third, double limit, double side)
      : a(first), b(second), c(third), radius(limit), sign(side) {}

  bool is_negative_of(const CircleRadius& other) const {
    return sign == -other.sign && is_same_thing(a, other.a) && is_same_thing(b, other.b) && is_same_thing(c, other.c) &&
           radius == other.radius;
  }

  template <class Number>
  auto polynomial(double epoch) const {
    return value([&](const Path& to, const Path& from, int axis) {
      return difference_about<Number>(to.axis(axis), from.axis(axis), epoch);
    });
  }
  Ball<DoubleDouble> extended_value(double t) const requires(!requires { Path::sampled; }) {
    return value([&](const Path& to, const Path& from, int axis) {
      return extended_difference(to.axis(axis), from.axis(axis), t);
    });
  }

 private:
  template <class Difference>
  auto value(const Difference& difference) const {
    const auto ux = difference(b, a, 0), uy = difference(b, a, 1);
    const auto vx = difference(c, a, 0), vy = difference(c, a, 1);
    const auto wx = difference(c, b, 0), wy = difference(c, b, 1);
    const auto length = [](const auto& x, const auto& y) { return detail::squared(x) + detail::squared(y); };
    const auto lengths = length(ux, uy) * length(vx, vy) * length(wx, wy);
    return (detail::squared((ux * vy - uy * vx) * radius) * 4.0 - lengths) * sign;
  }
};

}  // namespace kds::certificates
