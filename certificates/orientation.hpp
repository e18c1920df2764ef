// Three moving points of the plane in counter-clockwise order.
#pragma once

#include "kds/bounded.hpp"
#include "kds/certificate.hpp"
#include "kds/lasting.hpp"
#include "kds/motion.hpp"
#include "kds/odd_permutation.hpp"

namespace kds::certificates {

/// det(b - a, c - a) >= 0: a, b, c turn counter-clockwise, or are collinear. Twice the area of the triangle.
///
/// Degree 2 for linear, 4 for quadratic paths. A path is anything with axis(0) and axis(1): PlaneMotion, BoundedPoint,
/// or a PointMotion seen from above. Laws: Orientation(b, c, a) == Orientation(a, b, c) == -Orientation(b, a, c).
template <class Path>
struct Orientation {
  static constexpr int degree = 2 * Path::degree;
  Held<Path> a;
  Held<Path> b;
  Held<Path> c;

  Orientation(Lasting<Path> first, Lasting<Path> second, Lasting<Path> third) : a(first), b(second), c(third) {}

  template <class Number>
  auto polynomial(double epoch) const {
    const auto to = [&](const Path& p, int d) { return difference_about<Number>(p.axis(d), a.axis(d), epoch); };
    return to(b, 0) * to(c, 1) - to(b, 1) * to(c, 0);
  }

  Ball<DoubleDouble> extended_value(double t) const requires(!requires { Path::sampled; }) {
    const auto to = [&](const Path& p, int d) { return extended_difference(p.axis(d), a.axis(d), t); };
    return to(b, 0) * to(c, 1) - to(b, 1) * to(c, 0);
  }

  /// Cheap and sufficient: two of the three are the same point.
  bool vanishes() const requires(!requires { Path::sampled; }) { return a == b || b == c || c == a; }

  bool is_negative_of(const Orientation& other) const {
    return is_odd_permutation<Path, 3>({&a, &b, &c}, {&other.a, &other.b, &other.c});
  }
};

template <class Path>
Orientation(const Path&, const Path&, const Path&) -> Orientation<Path>;

}  // namespace kds::certificates
