// Four moving points of space, positively oriented.
#pragma once

#include "kds/bounded.hpp"
#include "kds/certificate.hpp"
#include "kds/lasting.hpp"
#include "kds/motion.hpp"
#include "kds/odd_permutation.hpp"

#include <array>

namespace kds::certificates {

/// det(b - a, c - a, d - a) >= 0: d is on the side of the plane a, b, c from which these turn counter-clockwise, or on
/// the plane. Six times the volume of the tetrahedron.
///
/// Degree 3 for linear, 6 for quadratic paths. A path is anything with axis(0), axis(1) and axis(2). Law: even
/// permutations of a, b, c, d leave it as it is, odd ones change its sign.
template <class Path>
struct SpaceOrientation {
  static constexpr int degree = 3 * Path::degree;
  const Path& a;
  const Path& b;
  const Path& c;
  const Path& d;

  SpaceOrientation(Lasting<Path> first, Lasting<Path> second, Lasting<Path> third, Lasting<Path> fourth)
      : a(first), b(second), c(third), d(fourth) {}

  template <class Number>
  auto polynomial(double epoch) const {
    return value([&](const Path& p, int axis) { return difference_about<Number>(p.axis(axis), a.axis(axis), epoch); });
  }

  Ball<DoubleDouble> extended_value(double t) const {
    return value([&](const Path& p, int axis) { return extended_difference(p.axis(axis), a.axis(axis), t); });
  }

  /// Cheap and sufficient: two of the four are the same point.
  bool vanishes() const { return a == b || a == c || a == d || b == c || b == d || c == d; }

  bool is_negative_of(const SpaceOrientation& other) const {
    return is_odd_permutation<Path, 4>({&a, &b, &c, &d}, {&other.a, &other.b, &other.c, &other.d});
  }

 private:
  template <class From>
  auto value(const From& from_a) const {
    const auto bx = from_a(b, 0), by = from_a(b, 1), bz = from_a(b, 2);
    const auto cx = from_a(c, 0), cy = from_a(c, 1), cz = from_a(c, 2);
    const auto dx = from_a(d, 0), dy = from_a(d, 1), dz = from_a(d, 2);
    return bz * (cx * dy - cy * dx) + cz * (dx * by - dy * bx) + dz * (bx * cy - by * cx);
  }
};

/// One coordinate of the vector (b - a) x (c - a) is >= 0: seen from far along that axis, a, b, c turn
/// counter-clockwise, or are seen from the side.
///
/// Degree 2 for linear, 4 for quadratic paths. Law: as Orientation in the plane.
template <class Path>
struct NormalDirection {
  static constexpr int degree = 2 * Path::degree;
  const Path& a;
  const Path& b;
  const Path& c;
  int axis;  ///< 0, 1 or 2

  template <class Number>
  auto polynomial(double epoch) const {
    return value([&](const Path& p, int d) { return difference_about<Number>(p.axis(d), a.axis(d), epoch); });
  }

  Ball<DoubleDouble> extended_value(double t) const {
    return value([&](const Path& p, int d) { return extended_difference(p.axis(d), a.axis(d), t); });
  }

  bool vanishes() const { return a == b || b == c || c == a; }

  bool is_negative_of(const NormalDirection& other) const {
    return axis == other.axis && is_odd_permutation<Path, 3>({&a, &b, &c}, {&other.a, &other.b, &other.c});
  }

 private:
  template <class From>
  auto value(const From& from_a) const {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    return from_a(b, u) * from_a(c, v) - from_a(b, v) * from_a(c, u);
  }
};

template <class Path>
SpaceOrientation(const Path&, const Path&, const Path&, const Path&) -> SpaceOrientation<Path>;

}  // namespace kds::certificates
