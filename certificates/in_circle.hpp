// A moving point outside the circle through three others: the certificate of Delaunay triangulations.
#pragma once

#include "certificates/squared.hpp"
#include "kds/bounded.hpp"
#include "kds/certificate.hpp"
#include "kds/lasting.hpp"
#include "kds/motion.hpp"
#include "kds/odd_permutation.hpp"

namespace kds::certificates {

/// d is not inside the circle through a, b, c, which turn counter-clockwise.
///
/// Minus the determinant of the rows (x, y, x^2 + y^2), x and y being a - d, b - d, c - d. Degree 4 for linear, 8 for
/// quadratic paths. Laws: even permutations of a, b, c, d leave it as it is, odd ones change its sign; so the edge
/// between triangles a, b, c and b, a, d has the same certificate seen from either side. Paper: [Guibas85].
template <class Path>
struct InCircle {
  static constexpr int degree = 4 * Path::degree;
  Held<Path> a;
  Held<Path> b;
  Held<Path> c;
  Held<Path> d;

  InCircle(Lasting<Path> first, Lasting<Path> second, Lasting<Path> third, Lasting<Path> fourth)
      : a(first), b(second), c(third), d(fourth) {}

  template <class Number>
  auto polynomial(double epoch) const {
    return value([&](const Path& p, int axis) { return difference_about<Number>(p.axis(axis), d.axis(axis), epoch); });
  }

  Ball<DoubleDouble> extended_value(double t) const requires(!requires { Path::sampled; }) {
    return value([&](const Path& p, int axis) { return extended_difference(p.axis(axis), d.axis(axis), t); });
  }

  /// Cheap and sufficient: two of the four are the same point.
  bool vanishes() const requires(!requires { Path::sampled; }) {
    return a == b || a == c || a == d || b == c || b == d || c == d;
  }

  bool is_negative_of(const InCircle& other) const {
    return is_odd_permutation<Path, 4>({&a, &b, &c, &d}, {&other.a, &other.b, &other.c, &other.d});
  }

 private:
  template <class From>
  auto value(const From& from_d) const {
    const auto ax = from_d(a, 0), ay = from_d(a, 1);
    const auto bx = from_d(b, 0), by = from_d(b, 1);
    const auto cx = from_d(c, 0), cy = from_d(c, 1);
    return (detail::squared(ax) + detail::squared(ay)) * (by * cx - bx * cy) +
           (detail::squared(bx) + detail::squared(by)) * (cy * ax - cx * ay) +
           (detail::squared(cx) + detail::squared(cy)) * (ay * bx - ax * by);
  }
};

template <class Path>
InCircle(const Path&, const Path&, const Path&, const Path&) -> InCircle<Path>;

}  // namespace kds::certificates
