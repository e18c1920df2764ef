// Separating axes of a triangle with a triangle or a box, one of them moving.
#pragma once

#include "collision/narrow_phase/curve_spans.hpp"
#include "collision/narrow_phase/mesh_margins.hpp"
#include "collision/narrow_phase/relative_motion.hpp"
#include "collision/narrow_phase/time_spans.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace kds::collision {

/// The numbers from `low` to `high`.
struct Interval {
  double low;
  double high;
};

struct PlacedSurface;

/// A triangle in world orientation about the centre of its body; by itself, or as a part of a surface.
struct PlacedTriangle {
  std::array<Eigen::Vector3d, 3> vertices;
  const PlacedSurface* surface = nullptr;
  std::uint32_t index = 0;  ///< in the surface

  Interval project(const Eigen::Vector3d& axis) const {
    const double x = dot(axis, vertices[0]);
    const double y = dot(axis, vertices[1]);
    const double z = dot(axis, vertices[2]);
    return {std::min(x, std::min(y, z)), std::max(x, std::max(y, z))};
  }
  Eigen::Vector3d edge(std::size_t i) const { return vertices[i == 2 ? 0 : i + 1] - vertices[i]; }
};

/// A solid box about its centre.
struct PlacedBox {
  std::array<Eigen::Vector3d, 3> half_axes;
  Eigen::Matrix3d rotation;  ///< columns: normals of its faces

  Interval project(const Eigen::Vector3d& axis) const {
    const double half_width =
        std::abs(dot(axis, half_axes[0])) + std::abs(dot(axis, half_axes[1])) + std::abs(dot(axis, half_axes[2]));
    return {-half_width, half_width};
  }
};

/// A ball about its centre.
struct PlacedBall {
  double radius;

  Interval project(const Eigen::Vector3d& axis) const {
    const double half_width = radius * std::sqrt(dot(axis, axis));
    return {-half_width, half_width};
  }
};

/// A capsule: all points nearer than a radius to a segment about its centre.
struct PlacedCapsule {
  Eigen::Vector3d half;  ///< of the segment
  double radius;

  Interval project(const Eigen::Vector3d& axis) const {
    const double half_width = std::abs(dot(axis, half)) + radius * std::sqrt(dot(axis, axis));
    return {-half_width, half_width};
  }
};

inline Interval interval(double x, double y) { return x < y ? Interval{x, y} : Interval{y, x}; }

/// Calls test(axis, interval of a, interval of b) for the directions that can separate the two, until it returns false;
/// returns its last result. The intervals are the projections on the axis, which has any length.
///
/// Two triangles: the two normals, the nine products of edges, and the normals of the six edges in their planes, which
/// alone separate triangles of one plane, and keep those of nearly one plane from counting as touching far away from
/// each other. Any direction is a valid witness of separation, however it was rounded, so a bad one (from nearly
/// parallel edges) only fails to separate. That an axis is perpendicular to the edges of which it is the product is
/// used only where this is true up to rounding: a product u x v is off by 2 roundings of |u| |v|, so the ends of u
/// project to points 2 |u| / sine of the angle apart. Where the sine is below 1/2 all vertices are projected; else that
/// is 8 of the radius.
template <class Test>
bool every_axis(const PlacedTriangle& a, const PlacedTriangle& b, Test&& test) {
  const std::array<Eigen::Vector3d, 3> u{a.edge(0), a.edge(1), a.edge(2)};
  const std::array<Eigen::Vector3d, 3> v{b.edge(0), b.edge(1), b.edge(2)};
  const auto nearly_parallel = [](const Eigen::Vector3d& axis, double square_u, double square_v) {
    return 4 * dot(axis, axis) < square_u * square_v;
  };
  const std::array<double, 3> uu{dot(u[0], u[0]), dot(u[1], u[1]), dot(u[2], u[2])};
  const std::array<double, 3> vv{dot(v[0], v[0]), dot(v[1], v[1]), dot(v[2], v[2])};
  // The ends of an edge project to one point, up to rounding, on an axis across it.
  const auto across = [](const PlacedTriangle& t, std::size_t i, const Eigen::Vector3d& axis) {
    return interval(dot(axis, t.vertices[i]), dot(axis, t.vertices[i == 0 ? 2 : i - 1]));
  };
  const auto flat = [](const PlacedTriangle& t, const Eigen::Vector3d& axis) {
    const double height = dot(axis, t.vertices[0]);
    return Interval{height, height};
  };
  const Eigen::Vector3d normal_a = cross(u[0], u[1]);
  const Interval height_a = nearly_parallel(normal_a, uu[0], uu[1]) ? a.project(normal_a) : flat(a, normal_a);
  if (!test(normal_a, height_a, b.project(normal_a))) return false;
  const Eigen::Vector3d normal_b = cross(v[0], v[1]);
  const Interval height_b = nearly_parallel(normal_b, vv[0], vv[1]) ? b.project(normal_b) : flat(b, normal_b);
  if (!test(normal_b, a.project(normal_b), height_b)) return false;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const Eigen::Vector3d axis = cross(u[i], v[j]);
      if (nearly_parallel(axis, uu[i], vv[j])) [[unlikely]] {
        if (!test(axis, a.project(axis), b.project(axis))) return false;
      } else if (!test(axis, across(a, i, axis), across(b, j, axis))) {
        return false;
      }
    }
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d axis = cross(u[i], normal_a);
    if (!test(axis, across(a, i, axis), b.project(axis))) return false;
  }
  for (std::size_t j = 0; j < 3; ++j) {
    const Eigen::Vector3d axis = cross(v[j], normal_b);
    if (!test(axis, a.project(axis), across(b, j, axis))) return false;
  }
  return true;
}

/// A triangle and a solid box: the normals of both and the products of their edges.
template <class Test>
bool every_axis(const PlacedTriangle& a, const PlacedBox& b, Test&& test) {
  const auto try_axis = [&](const Eigen::Vector3d& axis) { return test(axis, a.project(axis), b.project(axis)); };
  for (int i = 0; i < 3; ++i) {
    if (!try_axis(b.rotation.col(i))) return false;
  }
  const std::array<Eigen::Vector3d, 3> u{a.edge(0), a.edge(1), a.edge(2)};
  if (!try_axis(cross(u[0], u[1]))) return false;
  for (const auto& e : u) {
    for (int i = 0; i < 3; ++i) {
      if (!try_axis(cross(e, b.rotation.col(i)))) return false;
    }
  }
  return true;
}

/// A triangle and a round shape: not all directions that can separate them (there are infinitely many), but the normals
/// of the triangle and its edges, and of the box around the shape.
template <class Round, class Test>
bool every_axis_of_triangle(const PlacedTriangle& a, const Round& b, Test&& test) {
  const auto try_axis = [&](const Eigen::Vector3d& axis) { return test(axis, a.project(axis), b.project(axis)); };
  const std::array<Eigen::Vector3d, 3> u{a.edge(0), a.edge(1), a.edge(2)};
  const Eigen::Vector3d normal = cross(u[0], u[1]);
  if (!try_axis(normal)) return false;
  for (int d = 0; d < 3; ++d) {
    if (!try_axis(Eigen::Vector3d::Unit(d))) return false;
  }
  for (const auto& e : u) {
    if (!try_axis(cross(e, normal))) return false;
  }
  return true;
}

template <class Test>
bool every_axis(const PlacedTriangle& a, const PlacedBall& b, Test&& test) {
  return every_axis_of_triangle(a, b, test);
}

/// As for a ball, and the directions across the capsule and each edge.
template <class Test>
bool every_axis(const PlacedTriangle& a, const PlacedCapsule& b, Test&& test) {
  if (!every_axis_of_triangle(a, b, test)) return false;
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d axis = cross(a.edge(i), b.half);
    if (!test(axis, a.project(axis), b.project(axis))) return false;
  }
  return true;
}

/// The same for the directions of k-DOPs, the axes among them. They are needed where sharp corners may face each other,
/// tip to tip: the directions above decide whether convex shapes overlap, but are all nearly perpendicular to the line
/// between such tips, and so show only a small part of their distance.
///
/// Bound on the distance. Let d lead from the nearest point of one shape to that of the other, two vertices (else a
/// direction above is within 45 degrees of d), so that the directions for which these are the nearest are a convex set
/// N of the sphere about d. Its sides are arcs along which directions of every_axis follow each other in steps of 90
/// degrees at most: of a triangle's edge, half a circle with the normal in the plane in its middle; of a box's, a
/// quarter. So, if a side is delta from d, some direction has a cosine of cos(delta) sqrt(1/2) with d at least, and the
/// distance is at most sqrt(2) / cos(delta) times the greatest separation that is seen.
/// - N lies in the set of each of the two vertices. A corner of a triangle with the angle theta has a sector of 180
///   degrees - theta, so that delta <= 90 degrees - theta / 2: where one of the triangles has no corner that is sharp
///   (Mesh::sharp_half_sine), 11.4 times. Of a vertex of a box, delta <= 35.3 degrees: 1.74 times.
/// - None of the 26 directions here leaves more than 27.6 degrees to its neighbours, so either delta is less, or N
/// holds
///   one of them: 1.6 times; and what k-DOPs see is no more than what is seen here.
template <class A, class B, class Test>
bool every_kdop_direction(const A& a, const B& b, Test&& test) {
  constexpr std::array<std::array<int, 3>, 13> directions{{{1, 0, 0},
                                                           {0, 1, 0},
                                                           {0, 0, 1},
                                                           {1, 1, 0},
                                                           {1, -1, 0},
                                                           {1, 0, 1},
                                                           {1, 0, -1},
                                                           {0, 1, 1},
                                                           {0, 1, -1},
                                                           {1, 1, 1},
                                                           {1, 1, -1},
                                                           {1, -1, 1},
                                                           {1, -1, -1}}};
  for (const auto& [x, y, z] : directions) {
    const Eigen::Vector3d direction(x, y, z);
    if (!test(direction, a.project(direction), b.project(direction))) return false;
  }
  return true;
}

/// Axes shorter than this are left out, which is always safe. With edges of 2^-110 or more that meet at sines of 2^-46
/// or more (`shortest_edge`, Mesh::thinnest_sine) they come from parallel edges alone; their squares do not underflow.
inline constexpr double vanishing_axis = 0x1p-400;

/// Cheap test: shrinks the window to times at which a and b may touch, with b moving; false if there are none.
/// Projections are widened by `margin` as in BoxPairTest, times the 1-norm of the axis, which is not below its length.
template <int Degree, class A, class B>
bool may_touch(const A& a, const B& b, const RelativeMotion<Degree>& motion,
               const std::array<double, std::size_t{Degree} + 1>& margin, TimeWindow& window) {
  return every_axis(a, b, [&](const Eigen::Vector3d& axis, const Interval& of_a, const Interval& of_b) {
    const double length = std::abs(axis[0]) + std::abs(axis[1]) + std::abs(axis[2]);
    if (!(length > vanishing_axis)) return true;
    // They overlap while low < axis . r < high.
    const double low = of_a.low - of_b.high - length * margin[0];
    const double high = of_a.high - of_b.low + length * margin[0];
    const double p0 = dot(axis, motion.coefficients[0]);
    const double p1 = dot(axis, motion.coefficients[1]);
    const double m1 = length * margin[1];
    if constexpr (Degree >= 3) {
      std::array<double, std::size_t{Degree} + 1> above{p0 - high, p1 - m1};
      std::array<double, std::size_t{Degree} + 1> below{low - p0, -p1 - m1};
      for (std::size_t i = 2; i <= Degree; ++i) {
        const double p = dot(axis, motion.coefficients[i]);
        above[i] = p - length * margin[i];
        below[i] = -p - length * margin[i];
      }
      return clip_to_negative(above, window) && clip_to_negative(below, window);
    } else if constexpr (Degree == 1) {
      return clip_to_negative(p0 - high, p1 - m1, window) && clip_to_negative(low - p0, -p1 - m1, window);
    } else {
      const double p2 = dot(axis, motion.coefficients[2]);
      const double m2 = length * margin[2];
      return clip_to_negative(p0 - high, p1 - m1, p2 - m2, window) &&
             clip_to_negative(low - p0, -p1 - m1, -p2 - m2, window);
    }
  });
}

}  // namespace kds::collision
