// Two features seen from each other: a flat patch that moves, and the origin.
#pragma once

#include "certificates/features/lanes.hpp"
#include "certificates/point_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace kds::certificates {

/// The set of differences x - y of the points of two features: a *patch*, which holds the origin when they touch.
/// A vertex minus a face is a triangle, an edge minus an edge a parallelogram.
enum class Patch { triangle, parallelogram };

/// The corners of a patch, in order around it, by coordinate. A triangle repeats its first corner.
using Corners = std::array<Lanes, 3>;

/// The corners of a patch as polynomials c[0] + c[1] s + ... of s in [0, 1], taken as exact.
///
/// This is where everything is translated to a local origin: corners are differences of the points given, so neither
/// the place of the features in the world nor a velocity that they share leaves a trace. The polynomials are not quite
/// the differences meant; `error` bounds by how much, and everything after this is about these polynomials. See
/// docs/features.md, "Rounding".
template <int Degree>
struct PatchPaths {
  static_assert(Degree == 1 || Degree == 2, "features: margins and turning axes are derived for lines and parabolas");
  static constexpr int degree = Degree;

  std::array<Corners, std::size_t{Degree} + 1> c;
  /// The greatest sum |c[0]| + |c[1]| + ... of any coordinate of any corner: no coordinate exceeds it in [0, 1].
  double size;
  /// No coordinate of a corner of the patch meant is farther than this from its polynomial, in [0, 1].
  double error;

  Corners at(double s) const {
    Corners q = c[Degree];
    for (std::size_t i = Degree; i-- > 0;) {
      for (std::size_t d = 0; d < 3; ++d) q[d] = q[d] * Lanes(s) + c[i][d];
    }
    return q;
  }

  Corners velocity(double s) const {
    Corners q = c[1];
    if constexpr (Degree == 2) {
      for (std::size_t d = 0; d < 3; ++d) q[d] = q[d] + c[2][d] * Lanes(2 * s);
    }
    return q;
  }
};

/// 2^-53, the relative error of one operation.
inline constexpr double half_ulp = 0x1p-53;

namespace detail {

template <int Degree>
double size_of(const PatchPaths<Degree>& paths) {
  Lanes size(0.0);
  Lanes all(0.0);
  for (std::size_t d = 0; d < 3; ++d) {
    Lanes magnitudes = magnitude(paths.c[0][d]);
    for (std::size_t i = 1; i <= Degree; ++i) magnitudes = magnitudes + magnitude(paths.c[i][d]);
    size = greater(magnitudes, size);
    all = all + magnitudes;
  }
  const double sum = sum_of(all);  // NaN or infinite if anything is
  if (!(sum < 0x1p1000)) throw std::invalid_argument("feature contact: a coordinate or a time is not finite");
  return highest(size);
}

/// Calls set(corner, x, y) for each corner x - y. A vertex and a face: x0 and y0, y1, y2; two edges: x0, x1 and y0, y1.
template <Patch kind, class Point, class Set>
void for_each_corner(const std::array<const Point*, 4>& p, Set&& set) {
  if constexpr (kind == Patch::triangle) {
    set(std::size_t{0}, *p[0], *p[1]);
    set(std::size_t{1}, *p[0], *p[2]);
    set(std::size_t{2}, *p[0], *p[3]);
    set(std::size_t{3}, *p[0], *p[1]);
  } else {
    set(std::size_t{0}, *p[0], *p[2]);
    set(std::size_t{1}, *p[1], *p[2]);
    set(std::size_t{2}, *p[1], *p[3]);
    set(std::size_t{3}, *p[0], *p[3]);
  }
}

/// The points' paths do not all start at t0: differences in double-double, moved to t0 there and rounded once.
template <Patch kind, int Degree>
PatchPaths<Degree> shifted_patch_paths(const std::array<const PointMotion<Degree>*, 4>& points, double t0,
                                       double duration) {
  std::array<std::array<std::array<double, 4>, 3>, std::size_t{Degree} + 1> c;
  double error = 0;
  for_each_corner<kind>(points, [&](std::size_t k, const PointMotion<Degree>& x, const PointMotion<Degree>& y) {
    const auto r = relative_motion<Ball<DoubleDouble>>(y, x, t0);
    for (std::size_t d = 0; d < 3; ++d) {
      double factor = 1;
      double bound = 0;
      for (std::size_t i = 0; i <= Degree; ++i) {
        c[i][d][k] = static_cast<double>(r[d].c[i].middle) * factor;
        bound += r[d].c[i].radius * factor;
        factor *= duration;
      }
      error = std::max(error, bound * (1 + 0x1p-40));
    }
  });
  PatchPaths<Degree> paths;
  for (std::size_t i = 0; i <= Degree; ++i) {
    for (std::size_t d = 0; d < 3; ++d) paths.c[i][d] = Lanes(c[i][d][0], c[i][d][1], c[i][d][2], c[i][d][3]);
  }
  paths.size = size_of(paths);
  paths.error = error + 6 * half_ulp * paths.size;
  return paths;
}

}  // namespace detail

/// Of four moving points over [t0, t1]; s = (t - t0) / (t1 - t0).
///
/// Error: paths that start at t0 take a difference, and i + 1 roundings for the power i of the duration (one of them
/// the duration's own): (1 + 2 i) 2^-53 |c[i]| at most, to first order, so 6 x 2^-53 size covers degree 2. Other paths
/// are shifted in double-double, which adds the radius of that arithmetic.
template <Patch kind, int Degree>
PatchPaths<Degree> patch_paths(const std::array<const PointMotion<Degree>*, 4>& points, double t0, double t1) {
  const double duration = t1 - t0;
  bool start_now = true;
  for (const auto* p : points) start_now = start_now && p->start == t0;
  if (!start_now) return detail::shifted_patch_paths<kind>(points, t0, duration);
  PatchPaths<Degree> paths;
  double factor = 1;
  for (std::size_t i = 0; i <= Degree; ++i) {
    std::array<const Eigen::Vector3d*, 4> p;
    for (std::size_t k = 0; k < 4; ++k) p[k] = &points[k]->coefficients[i];
    for (int d = 0; d < 3; ++d) {
      const auto& [x0, x1, x2, x3] = p;
      const double a = (*x0)[d], b = (*x1)[d], e = (*x2)[d], f = (*x3)[d];
      paths.c[i][static_cast<std::size_t>(d)] =
          kind == Patch::triangle ? Lanes(a, a, a, a) - Lanes(b, e, f, b) : Lanes(a, b, b, a) - Lanes(e, e, f, f);
      if (i > 0) paths.c[i][static_cast<std::size_t>(d)] = paths.c[i][static_cast<std::size_t>(d)] * Lanes(factor);
    }
    factor *= duration;
  }
  paths.size = detail::size_of(paths);
  paths.error = 6 * half_ulp * paths.size;
  return paths;
}

/// Of four points by the control points of their paths.
///
/// Error: differences d[i] of control points are rounded once, and none is larger than `size`. Degree 1: c[1] = d[1] -
/// d[0] is rounded once more: three roundings of size. Degree 2: c[1] = 2 (d[1] - d[0]), 5 roundings with those of the
/// differences; c[2] = (d[2] - d[1]) - (d[1] - d[0]), 4 for the differences and 3 for the subtractions; 13 in all.
template <Patch kind, int Degree>
PatchPaths<Degree> patch_paths(const std::array<std::array<Eigen::Vector3d, 4>, std::size_t{Degree} + 1>& control) {
  const auto difference = [](const std::array<Eigen::Vector3d, 4>& p, int d) {
    if constexpr (kind == Patch::triangle) {
      return Lanes(p[0][d]) - Lanes(p[1][d], p[2][d], p[3][d], p[1][d]);
    } else {
      return Lanes(p[0][d], p[1][d], p[1][d], p[0][d]) - Lanes(p[2][d], p[2][d], p[3][d], p[3][d]);
    }
  };
  PatchPaths<Degree> paths;
  for (int d = 0; d < 3; ++d) {
    const auto i = static_cast<std::size_t>(d);
    paths.c[0][i] = difference(control[0], d);
    const Lanes first = difference(control[1], d) - paths.c[0][i];
    if constexpr (Degree == 1) {
      paths.c[1][i] = first;
    } else {
      paths.c[1][i] = first * Lanes(2.0);
      paths.c[2][i] = (difference(control[2], d) - difference(control[1], d)) - first;
    }
  }
  paths.size = detail::size_of(paths);
  paths.error = (Degree == 1 ? 6 : 16) * half_ulp * paths.size;
  return paths;
}

}  // namespace kds::certificates
