// Where a triangle of a mesh and what it penetrates touch, in doubles.
#pragma once

#include "collision/narrow_phase/contact_patch.hpp"
#include "collision/narrow_phase/mesh_partners.hpp"
#include "collision/narrow_phase/nearest_point.hpp"
#include "collision/narrow_phase/segment_ways.hpp"
#include "collision/narrow_phase/turning/point_rates.hpp"
#include "collision/narrow_phase/turning/turning_mesh_sides.hpp"
#include "collision/shapes/support.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>
#include <vector>

namespace kds::collision {

/// The place at which two pieces touch, at the time of a view.
struct TurningTouch {
  Eigen::Vector3d point;   ///< from the origin of a
  Eigen::Vector3d normal;  ///< unit, from a to b
  Feature feature_a, feature_b;
  double approach;  ///< how fast they approach there, less the effect of roundings; not above zero if they do not
  double area = 0;  ///< of what they share, where a face lies on a face
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();  ///< of that: its centroid
};

namespace detail {

/// The points that are the farthest along a direction, in cyclic order, and what they are.
struct FarthestPoints {
  Feature feature;
  std::vector<Eigen::Vector3d> points;
};

/// Which of the heights are the greatest: a set of bits. Sines below parallel_sine do not count.
template <std::size_t Points>
unsigned highest(const std::array<Eigen::Vector3d, Points>& points, const Eigen::Vector3d& direction) {
  std::array<double, Points> height;
  double size = 0;
  for (std::size_t i = 0; i < Points; ++i) {
    height[i] = dot(direction, points[i]);
    size = std::max(size, norm(points[i] - points[0]));
  }
  const double top = *std::max_element(height.begin(), height.end());
  unsigned set = 0;
  for (std::size_t i = 0; i < Points; ++i) set |= height[i] >= top - parallel_sine * size ? 1u << i : 0u;
  return set;
}

inline FarthestPoints farthest_points(const MeshOfPair& mesh, std::uint32_t leaf,
                                      const std::array<Eigen::Vector3d, 3>& points, const Eigen::Vector3d& direction) {
  const LeafTriangle& triangle = mesh.triangle(leaf);
  const unsigned set = highest(points, direction);
  FarthestPoints result{Feature::face(triangle.index), {}};
  std::array<std::uint32_t, 3> vertex{};
  std::size_t count = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!(set >> i & 1)) continue;
    result.points.push_back(points[i]);
    vertex[count++] = triangle.vertices[i];
  }
  if (count == 1) result.feature = Feature::vertex(vertex[0]);
  if (count == 2) result.feature = Feature::edge(vertex[0], vertex[1]);
  return result;
}

inline FarthestPoints farthest_points(const BoxOfPair&, std::uint32_t, const std::array<Eigen::Vector3d, 8>& points,
                                      const Eigen::Vector3d& direction) {
  const unsigned set = highest(points, direction);
  unsigned in_all = 7, in_any = 0;  // bits of the corners' numbers
  for (unsigned i = 0; i < 8; ++i) {
    if (set >> i & 1) in_all &= i, in_any |= i;
  }
  const unsigned varied = in_any & ~in_all;  // the axes along which the feature stretches
  FarthestPoints result;
  if (varied == 0) {
    result = {Feature::vertex(in_all), {points[in_all]}};
  } else if ((varied & (varied - 1)) == 0) {
    result = {Feature::edge(in_all, in_any), {points[in_all], points[in_any]}};
  } else {
    unsigned axis = 0;  // of a box that is flat up to roundings the last one that can be
    for (unsigned d = 0; d < 3; ++d) axis = varied >> d & 1 ? axis : d;
    const unsigned first = 1u << (axis + 1) % 3, second = 1u << (axis + 2) % 3, base = in_all & 1u << axis;
    result = {Feature::face(2 * axis + (base != 0 ? 1 : 0)),
              {points[base], points[base | first], points[base | first | second], points[base | second]}};
  }
  return result;
}

/// Notes which area two faces share, and its centroid.
inline void note_area(TurningTouch& touch, const std::vector<Eigen::Vector3d>& corners) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 2; i < corners.size(); ++i) {
    const Eigen::Vector3d &p = corners[0], &q = corners[i - 1], &r = corners[i];
    const double area = norm(cross(q - p, r - p)) / 2;
    touch.area += area;
    sum += area / 3 * (p + q + r);
  }
  if (touch.area > 0) touch.middle = sum / touch.area;
}

template <int Degree>
double approach_at(const PointRates<Degree>& rates, const Eigen::Vector3d& normal, const Eigen::Vector3d& x) {
  return -dot(normal, rates.velocity(x)) - rates.noise(x);
}

/// A direction out of a solid whose surface a triangle is of; zero for others.
template <class Side, class Points>
Eigen::Vector3d outward(const Side& side, const Points& points) {
  if constexpr (std::is_same_v<Side, MeshOfPair>) {
    if (side.solid()) return cross(points[1] - points[0], points[2] - points[0]);
  }
  return Eigen::Vector3d::Zero();
}

}  // namespace detail

/// Of a triangle and a triangle or a box: along the direction in which they are the least deep in each other. The
/// middle of what they share, or where that does not approach but another does, the corner of it that approaches
/// fastest.
///
/// A triangle of the surface of a solid is not pushed out of that solid along its own normal: a face that lies in a
/// plane up to roundings may be less deep in it on the far side.
///
/// They approach if they do so along all directions in which they are no deeper than roundings. A body that slides on a
/// face, and is in it by a rounding, meets the walls below that face from inside: these must not stop it.
///
/// `flush`: a normal of the plane in which an edge of theirs is flush with a face, or zero. Along it they touch at all
/// times, so that it does not count. `deepest`: if they are deeper in each other the approach is -never.
template <int Degree, class HullB, class Side>
TurningTouch touch_of(const TurningHulls<Degree, HullB>& pair, const MeshOfPair& a, std::uint32_t leaf_a, const Side& b,
                      std::uint32_t leaf_b, const TurningView<Degree>& view, const PointRates<Degree>& rates,
                      const Eigen::Vector3d& origin, const Eigen::Vector3d& flush = Eigen::Vector3d::Zero(),
                      double deepest = never) {
  using Hulls = TurningHulls<Degree, HullB>;
  const typename Hulls::Seen seen(pair, view);
  const auto along = [&](const Eigen::Vector3d& normal) {
    const auto of_a = detail::farthest_points(a, leaf_a, seen.a, normal);
    const auto of_b = detail::farthest_points(b, leaf_b, seen.b, -normal);
    TurningTouch touch{patch_centre(of_a.points, of_b.points, seen.way, normal), normal, of_a.feature, of_b.feature, 0};
    touch.approach = detail::approach_at(rates, normal, origin + touch.point);
    if (of_a.points.size() > 2 && of_b.points.size() > 2) {
      detail::note_area(touch, patch_corners(of_a.points, of_b.points, seen.way, normal));
    }
    if (touch.approach > 0) return touch;
    for (const Eigen::Vector3d& x : patch_corners(of_a.points, of_b.points, seen.way, normal)) {
      const double approach = detail::approach_at(rates, normal, origin + x);
      if (approach > touch.approach) touch.approach = approach, touch.point = x;
    }
    return touch;
  };
  const Eigen::Vector3d out_of_b = detail::outward(b, seen.b);
  // Directions up to a thousandth of a radian from the normal. At an edge others, too, lead out of one of its faces.
  constexpr double cosine = 1 - 0x1p-20;
  const double along_normal = cosine * norm(out_of_b), along_flush = cosine * norm(flush);
  const auto counts = [&](const typename Hulls::Widest& way) {
    return !(dot(way.normal, out_of_b) > along_normal) && !(std::abs(dot(way.normal, flush)) > along_flush);
  };
  const auto widest = pair.widest(seen, counts);
  TurningTouch touch = along(widest.normal);
  if (widest.gap < -deepest) touch.approach = -never;
  const double roundings = pair.roundings(view);
  pair.every_gap(seen, [&](const typename Hulls::Widest& way) {
    if (way.gap < -roundings || way.way == widest.way || !(touch.approach > 0) || !counts(way)) return;
    touch.approach = std::min(touch.approach, along(way.normal).approach);
  });
  return touch;
}

/// Of a triangle and a ball: at the point of the triangle that is nearest to the centre.
template <int Degree>
TurningTouch touch_of(const TurningTriangleAndBall<Degree>& pair, const MeshOfPair& a, std::uint32_t leaf_a,
                      const BallOfPair&, std::uint32_t, const TurningView<Degree>& view,
                      const PointRates<Degree>& rates, const Eigen::Vector3d& origin) {
  const typename TurningTriangleAndBall<Degree>::Seen seen(pair, view);
  const LeafTriangle& triangle = a.triangle(leaf_a);
  int part = 0;
  TurningTouch touch;
  touch.point = seen.nearest(&part);
  const Eigen::Vector3d apart = seen.centre - touch.point;
  const double distance = norm(apart);
  touch.normal = distance > 0 ? Eigen::Vector3d(apart / distance) : seen.normal;
  const auto k = static_cast<std::size_t>(part) % 3;
  touch.feature_a = part < 3   ? Feature::vertex(triangle.vertices[k])
                    : part < 6 ? Feature::edge(triangle.vertices[k], triangle.vertices[(k + 1) % 3])
                               : Feature::face(triangle.index);
  touch.approach = detail::approach_at(rates, touch.normal, origin + touch.point);
  return touch;
}

/// Of a triangle and a capsule: where the capsule's segment is nearest to the triangle, in the middle of that; of one
/// that goes through it across its plane.
template <int Degree>
TurningTouch touch_of(const TurningTriangleAndCapsule<Degree>&, const MeshOfPair& a, std::uint32_t leaf_a,
                      const CapsuleOfPair& b, std::uint32_t, const TurningView<Degree>& view,
                      const PointRates<Degree>& rates, const Eigen::Vector3d& origin) {
  const LeafTriangle& leaf = a.triangle(leaf_a);
  PlacedTriangle triangle{a.corners(leaf_a)};
  for (Eigen::Vector3d& x : triangle.vertices) x = view.in_world_a(x);
  const Eigen::Vector3d half = view.in_world_b({0, 0, b.capsule().half_length});
  const double tolerance = parallel_sine * b.capsule().half_length;
  const NearestStretch nearest = nearest_stretch(triangle, view.way.value, half, tolerance);
  const Eigen::Vector3d apart = nearest.core - nearest.point;
  const double distance = norm(apart);
  Eigen::Vector3d normal = normalized(cross(triangle.edge(0), triangle.edge(1)));
  if (dot(normal, view.way.value - triangle.vertices[0]) < 0) normal = -normal;
  TurningTouch touch;
  touch.point = nearest.point;
  touch.normal = distance > 0 ? Eigen::Vector3d(apart / distance) : normal;
  touch.feature_a = detail::nearest_feature(nearest_point(triangle, nearest.core), leaf);
  touch.feature_b = detail::capsule_feature(nearest);
  touch.approach = detail::approach_at(rates, touch.normal, origin + touch.point);
  for (const double part :
       {nearest.low, nearest.high}) {  // one end of the stretch may approach where the middle does not
    if (touch.approach > 0) break;
    const Eigen::Vector3d on = view.way.value + part * half - distance * touch.normal;
    const double approach = detail::approach_at(rates, touch.normal, origin + on);
    if (approach > touch.approach) touch.approach = approach, touch.point = on;
  }
  return touch;
}

}  // namespace kds::collision
