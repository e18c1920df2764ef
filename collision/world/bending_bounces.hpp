// How bodies bounce off meshes that bend.
#pragma once

#include "collision/narrow_phase/contact.hpp"
#include "collision/narrow_phase/surface_rate.hpp"
#include "collision/world/bodies.hpp"
#include "collision/world_options.hpp"

#include <Eigen/Core>

#include <cstdint>

namespace kds::collision {

/// The velocities of the surfaces of two bodies that meet, beside those of the bodies, and with what speed the two part
/// if one of them is a mesh that bends. Such a mesh is fixed.
template <class Motion>
class BendingBounces {
 public:
  BendingBounces(const Bodies<Motion>& bodies, const WorldOptions& options) : bodies_(bodies), options_(options) {}

  /// Whether one of the two is a mesh that bends.
  bool bend(BodySlot a, BodySlot b) const { return bodies_.bends(a) || bodies_.bends(b); }
  /// How the surface of a body moves at a contact by its bending. `is_a`: whether it is the first of the two.
  SurfaceRate rate(BodySlot slot, const Contact& contact, bool is_a) const;
  /// The velocity of the surface of b by its bending less that of the surface of a.
  Eigen::Vector3d velocity(BodySlot a, BodySlot b, const Contact& contact) const;
  /// The speed at which a body leaves a mesh that bends, after it has approached with `approach`, or parted if that is
  /// negative. It is at least so high that bounces take time and leave the tolerance within which contacts are found.
  /// Nothing rests on such a mesh: what lies on it bounces in flights of WorldOptions::shortest_flight. `burst`: so
  /// many meetings at nearly one time.
  double rebound(BodySlot a, BodySlot b, const Contact& contact, double approach, std::uint64_t burst) const;

 private:
  const Bodies<Motion>& bodies_;
  const WorldOptions& options_;
};

}  // namespace kds::collision
