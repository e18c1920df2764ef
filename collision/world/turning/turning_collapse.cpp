// What bodies that turn do that strike each other again and again in ever shorter flights.
#include "collision/motions.hpp"
#include "collision/response/joint_impulse.hpp"
#include "collision/vectors.hpp"
#include "collision/world/turning/collapse.hpp"
#include "collision/world/turning/turning_bounces.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace kds::collision {
namespace {

/// The greatest speed with which two of the bodies approach each other where they touch.
double greatest_approach(const std::vector<JointBody>& bodies, const std::vector<JointPlace>& places) {
  const auto velocity = [&](std::uint32_t i, const Eigen::Vector3d& arm) {
    const RigidVelocity& of = bodies[i].velocity;
    return Eigen::Vector3d(of.velocity + cross(of.angular_velocity, arm));
  };
  double most = 0;
  for (const JointPlace& at : places) {
    most = std::max(most, -dot(at.normal, velocity(at.b, at.arm_b) - velocity(at.a, at.arm_a)));
  }
  return most;
}

}  // namespace

/// If this contact is one of a collapse (collapse.hpp), the bodies of the collapse part, all at once, each pair fast
/// enough for a shortest flight: as after an impact without rebound and friction, which is what infinitely many of
/// their contacts would come to. `hit` is the impact of the two bodies alone.
template <class Motion>
Collapse TurningBounces<Motion>::part_together(BodySlot a, BodySlot b, const Contact& contact,
                                               const TurningImpact<Motion>& hit, std::uint64_t burst) {
  if (burst < detail::collapse_meetings || bending_.bend(a, b)) return Collapse::none;
  const double t = contact.time;
  const auto blows = resting_.note_blow(
      {.a = a, .b = b, .point = contact.point, .normal = contact.normal, .time = t, .least = hit.least});
  if (blows.size() < 2 || std::min(bodies_[a].restitution, bodies_[b].restitution) == 1) return Collapse::none;
  double most = 0;
  for (const detail::Blow& blow : blows) most = std::max(most, blow.least);
  const bool endless = burst > options_.zeno.contacts;
  if (!endless && !(hit.speed <= detail::collapse_speed * most)) return Collapse::none;
  std::vector<BodySlot> slots;
  std::vector<Motion> motions;
  std::vector<JointBody> bodies;
  std::vector<JointPlace> places;
  const auto holds_still = [this](BodySlot slot) { return bodies_.fixed(slot) || resting_.carries(slot); };
  const auto place_of = [&](BodySlot slot) {
    const auto found = std::find(slots.begin(), slots.end(), slot);
    if (found == slots.end()) {
      slots.push_back(slot);
      motions.push_back(met(slot, t));
      bodies.push_back({.mobility = holds_still(slot) ? Mobility::fixed() : mobility(slot),
                        .velocity = {motions.back().path.coefficients[1], motions.back().angular_velocity}});
      return static_cast<std::uint32_t>(slots.size() - 1);
    }
    return static_cast<std::uint32_t>(found - slots.begin());
  };
  // An impulse along its normal does not turn a ball.
  const auto arm = [&](std::uint32_t i, const detail::Blow& blow) {
    return bodies_.mover(slots[i]).radius > 0 ? Eigen::Vector3d(Eigen::Vector3d::Zero())
                                              : Eigen::Vector3d(blow.point - motions[i].path.coefficients[0]);
  };
  for (const detail::Blow& blow : blows) {
    const std::uint32_t of_a = place_of(blow.a), of_b = place_of(blow.b);
    places.push_back({.a = of_a,
                      .b = of_b,
                      .normal = blow.normal,
                      .arm_a = arm(of_a, blow),
                      .arm_b = arm(of_b, blow),
                      .least = most});  // Two that nothing presses together are pressed by their neighbours.
  }
  if (endless) {  // Perhaps nothing presses any of them.
    const double least = detail::parting_share * greatest_approach(bodies, places);
    for (JointPlace& at : places) at.least = std::max(at.least, least);
  }
  if (!part_jointly(bodies, places)) return endless ? Collapse::stuck : Collapse::none;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const BodySlot slot = slots[i];
    if (holds_still(slot)) continue;
    Motion& motion = motions[i];
    motion.path.coefficients[1] = bodies[i].velocity.velocity;
    motion.angular_velocity = bodies[i].velocity.angular_velocity;
    if (precesses(slot)) {
      // It is not led back to its free rotation: that could close a gap again.
      tumbling_.push(slot, bodies[i].angular_impulse);
      tumbling_.set_path(slot, motion.path);
      motion.angular_velocity = tumbling_.angular_velocity(slot);
      tumbling_.follow(slot, tumbling_.way_back(slot, motion.orientation), false, t);
    }
    ++counters_.motion_updates;
    motions_.set(slot, motion, false);
    const BodyId id = bodies_.id_of(slot);
    if (slot == a || slot == b) continue;
    reports_.add(Reports::Kind::moved, id, id, {.time = t});
    resting_.touch(slot);
  }
  return Collapse::parted;
}

#define KDS_INSTANTIATE(motion) KDS_TEMPLATE_PART class TurningBounces<motion>;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
