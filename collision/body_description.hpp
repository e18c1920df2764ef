// What a body is when it is added to a world.
#pragma once

#include "collision/broad_phase/kinetic_box.hpp"
#include "collision/shapes/shape.hpp"

#include <Eigen/Geometry>

#include <cstdint>
#include <functional>
#include <vector>

namespace kds::collision {

/// The volume that the broad phase sees.
enum class BoundingVolume : std::uint8_t {
  shape,   ///< the tightest box around the shape in its orientation
  sphere,  ///< the box around the bounding sphere: right for a shape in any orientation
};

/// A body to add.
template <int Degree>
struct BodyDescription {
  using Motion = certificates::PointMotion<Degree>;
  /// Gives a box that holds the body from time t until its valid_until, which must be later than t.
  using BoxFunction = std::function<KineticBox<Degree>(double t, const Motion& motion)>;

  Shape shape;
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  /// One or more pieces sorted by start. The first may lie in the past; in the future, the body enters then.
  std::vector<Motion> motion;
  double mass = 1;     ///< > 0
  bool fixed = false;  ///< infinite mass
  /// In [0, 1]: the speed after a contact over that before. Of two bodies, or a body and the walls, the lower counts.
  double restitution = 1;
  std::uint32_t category = 1;          ///< bits
  std::uint32_t collides_with = ~0u;   ///< a pair is tested if each one's category is in the other's mask
  BoundingVolume volume = BoundingVolume::shape;
  BoxFunction box;     ///< instead of `volume`: caller-given conservative boxes
};

}  // namespace kds::collision
