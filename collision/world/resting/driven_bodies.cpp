// Bodies that a surface drives, and those that lean on them.
#include "collision/motions.hpp"
#include "collision/response/least_constraint.hpp"
#include "collision/world/resting/resting_contacts.hpp"

#include <vector>

namespace kds::collision {

using Eigen::Vector3d;

/// The law of impacts [Moreau88]: of all velocities that no contact forbids, those nearest to the velocities before,
/// measured by mass. The surface takes the place of a wall.
template <class Motion>
Vector3d RestingContacts<Motion>::drive(BodySlot id, const Vector3d& normal, double velocity) {
  Island island = find_island(id);
  std::vector<Vector3d> velocities;
  for (const BodySlot each : island.bodies) velocities.push_back(bodies_.path(each).velocity(clock_.now));
  velocities.push_back(Vector3d::Zero());  // of walls, and what the surface counts from
  const auto still = static_cast<std::uint32_t>(island.bodies.size());
  island.touches.push_back({still, of_[id].place, normal, 0, bodies_[id].inverse_mass, 0, velocity});
  least_constraint(velocities, island.touches);
  // The body is driven even if the others do not give way; then it meets them.
  Touch& driven = island.touches.back();
  const double lacks = velocity - parting_rate(velocities, driven);
  if (lacks > 0) give_push(velocities, driven, lacks);
  for (std::size_t i = 0; i < island.free; ++i) {
    if (island.bodies[i] == id) continue;
    leave(island.bodies[i]);
    Motion motion = bodies_.motion(island.bodies[i]).restarted(clock_.now);
    const bool changed = motion.coefficients[1] != velocities[i];
    motion.coefficients[1] = velocities[i];
    if (changed) listener_->take_up(island.bodies[i], motion);
    disturb(island.bodies[i]);
  }
  return velocities[of_[id].place];
}

#define KDS_INSTANTIATE(motion) KDS_TEMPLATE_PART class RestingContacts<motion>;
KDS_FOR_EACH_PATH(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
