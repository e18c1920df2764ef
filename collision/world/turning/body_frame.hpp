// Where bodies that may rest on each other are, whether they move, and on which of their faces they lie.
#pragma once

#include "certificates/turning/turned_orientation.hpp"
#include "collision/shapes/polytope.hpp"
#include "collision/shapes/shape_forms.hpp"
#include "collision/vectors.hpp"
#include "collision/world/turning/rest_rules.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

namespace kds::collision::turning_rest {

using Eigen::Quaterniond;
using Eigen::Vector3d;

/// Where a body is at a time.
class BodyFrame {
 public:
  template <class Motion>
  BodyFrame(const Motion& motion, double t)
      : origin_(motion.path.position(t)),
        turn_(certificates::turned_orientation(motion.orientation, motion.spin(), t)),
        length_(dot(turn_.vec(), turn_.vec()) + turn_.w() * turn_.w()) {}

  const Vector3d& origin() const { return origin_; }
  Vector3d out(const Vector3d& x) const { return origin_ + turned(x, turn_.w()); }
  Vector3d back(const Vector3d& x) const { return turned(x - origin_, -turn_.w()); }

 private:
  /// q x q^-1 = x + 2 v x (v x x + w x) / |q|^2, for q = (w, v).
  Vector3d turned(const Vector3d& x, double w) const {
    const Vector3d v = turn_.vec();
    const Vector3d turn = cross(v, x) + w * x;
    return x + (2 / length_) * cross(v, turn);
  }

  Vector3d origin_;
  Quaterniond turn_;
  double length_;
};

/// Where a place at which two bodies have touched is by now, seen from that one of the two that does not slide away.
template <class Place>
Vector3d point_of(const Place& place, const BodyFrame& a, const BodyFrame& b, bool a_slides_away) {
  return a_slides_away ? b.out(place.on_b) : a.out(place.on_a);
}
/// How far apart the two are there. If one slides along itself below the other, along the normal.
template <class Place>
double apart(const Place& place, const BodyFrame& a, const BodyFrame& b, bool slides) {
  const Vector3d way = b.out(place.on_b) - a.out(place.on_a);
  return slides ? std::abs(dot(way, place.normal)) : norm(way);
}

/// How far a point of a box, a capsule or a hull is at most from an axis through its centre: unit, in the axes of the
/// body. Nothing of other shapes, or of a ball, that may be null.
inline std::optional<double> reach_about(const PlacedShape* shape, const Vector3d& axis) {
  if (!shape) return std::nullopt;
  double most = 0;
  if (const auto box = rounded_box_of(shape->shape)) {
    const Vector3d& h = box->half_extents;
    for (const double y : {-h[1], h[1]}) {
      for (const double z : {-h[2], h[2]}) most = std::max(most, norm(cross(axis, Vector3d(h[0], y, z))));
    }
    return most + box->radius;
  }
  const Polytope* const hull = polytope_of(shape->shape);
  if (!hull) return std::nullopt;
  for (const Vector3d& x : hull->points()) most = std::max(most, norm(cross(axis, x)));
  return most;
}

/// Whether a body is thin: no point of it is farther from one of its axes than a quarter of its radius. When it rolls
/// over its long edges all of its points are slow, while a bound by the radius tells that it is fast, again and again.
inline bool is_thin(const PlacedShape* shape, double radius) {
  for (int d = 0; d < 3; ++d) {
    const auto reach = reach_about(shape, Vector3d::Unit(d));
    if (reach && *reach <= 0.25 * radius) return true;
  }
  return false;
}

/// Whether no point of a body is faster than a speed, seen from what moves with a velocity: by a bound, but for thin
/// bodies.
template <class Motion>
bool all_slower(const Motion& motion, const Vector3d& velocity, const PlacedShape* shape, double radius, double speed,
                double t) {
  const double flies = norm(motion.path.velocity(t) - velocity), rate = norm(motion.angular_velocity);
  if (flies + rate * radius <= speed) return true;
  if (flies > speed || !is_thin(shape, radius)) return false;
  const BodyFrame frame(motion, t);
  const Vector3d axis = frame.back(frame.origin() + motion.angular_velocity) / rate;
  return flies + rate * reach_about(shape, axis).value_or(radius) <= speed;
}

/// How much faster than those of one corner the flights of all corners of the face make a hull that lies on it. `down`:
/// along its weight, of any length. Balls may be null.
template <class Motion>
double driven_by_corners(const PlacedShape* shape, const Motion& motion, const Vector3d& down, double t) {
  const Polytope* const hull = shape ? polytope_of(shape->shape) : nullptr;
  if (!hull) return 1;
  const auto& faces = hull->structure().faces;
  std::size_t most = 0;
  std::optional<Vector3d> in_hull;  // down, in its axes
  for (std::size_t i = 0; i < faces.size(); ++i) {
    if (faces[i].size() <= std::max(most, calm_corners)) continue;
    if (!in_hull) {
      const BodyFrame frame(motion, t);
      in_hull = frame.back(frame.origin() + down);
    }
    if (dot(hull->normals()[i], *in_hull) >= lying_side * norm(*in_hull)) most = faces[i].size();
  }
  return std::clamp(static_cast<double>(most) / static_cast<double>(calm_corners), 1.0, most_driven_by_corners);
}

}  // namespace kds::collision::turning_rest
