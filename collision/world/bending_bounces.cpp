#include "collision/world/bending_bounces.hpp"

#include "certificates/turning/rigid_motion.hpp"
#include "collision/motions.hpp"
#include "collision/shapes/bending_mesh.hpp"
#include "collision/vectors.hpp"

#include <algorithm>
#include <cmath>

namespace kds::collision {

using Eigen::Vector3d;

namespace {

/// How a point of a body moves.
struct PointRate {
  Vector3d velocity, acceleration;
};
template <int Degree>
PointRate rate_at(const certificates::PointMotion<Degree>& motion, const Vector3d&, double t) {
  return {motion.velocity(t), motion.acceleration(t)};
}
template <int Degree>
PointRate rate_at(const certificates::RigidMotion<Degree>& motion, const Vector3d& point, double t) {
  const Vector3d turning = cross(motion.angular_velocity, point - motion.path.position(t));
  return {motion.path.velocity(t) + turning, motion.path.acceleration(t) + cross(motion.angular_velocity, turning)};
}

}  // namespace

template <class Motion>
SurfaceRate BendingBounces<Motion>::rate(BodySlot slot, const Contact& contact, bool is_a) const {
  return bodies_.bends(slot) ? surface_rate(bodies_.moving(slot), contact, is_a) : SurfaceRate{};
}

template <class Motion>
Vector3d BendingBounces<Motion>::velocity(BodySlot a, BodySlot b, const Contact& contact) const {
  if (!bend(a, b)) return Vector3d::Zero();
  return rate(b, contact, false).velocity - rate(a, contact, true).velocity;
}

template <class Motion>
double BendingBounces<Motion>::rebound(BodySlot a, BodySlot b, const Contact& contact, double approach,
                                       std::uint64_t burst) const {
  const Vector3d& n = contact.normal;
  const double t = contact.time;
  const SurfaceRate of_a = rate(a, contact, true), of_b = rate(b, contact, false);
  const PointRate at_a = rate_at(bodies_.motion(a), contact.point, t),
                  at_b = rate_at(bodies_.motion(b), contact.point, t);
  const Vector3d velocity_a = at_a.velocity + of_a.velocity;
  const Vector3d velocity_b = at_b.velocity + of_b.velocity;
  // A surface that turns carries its normal along, so that what slides on it is pressed to it or lifted off.
  const Vector3d normal_rate = bodies_.bends(a) ? of_a.normal_rate : of_b.normal_rate;
  double pressed = -dot(n, at_b.acceleration - at_a.acceleration) - 2 * dot(normal_rate, velocity_b - velocity_a);
  // Two bodies that fall together are not pressed together yet, but are when one of them lies on something: so what
  // each of them would press if the other were at rest counts too.
  for (const Vector3d& acceleration : {at_a.acceleration, at_b.acceleration, Vector3d(2 * bodies_.free_term(a, 2, t)),
                                       Vector3d(2 * bodies_.free_term(b, 2, t))}) {
    pressed = std::max(pressed, std::abs(dot(n, acceleration)));
  }
  double tolerance = 0;
  for (const BodySlot slot : {a, b}) {
    if (bodies_.bends(slot)) tolerance = std::max(tolerance, bending_tolerance * bodies_[slot].bounding_radius);
  }
  const double met = std::max(-dot(n, velocity_b - velocity_a), 0.0);
  constexpr double least = 0x1p-26;         // of the speed at which they meet: what would stick parts
  constexpr double of_roundings = 0x1p-40;  // of the speeds
  // A rise to twice the tolerance takes the root of twice the height times the acceleration.
  const double slowest =
      std::max({least * met, of_roundings * (norm(velocity_a) + norm(velocity_b)),
                0.5 * options_.shortest_flight * pressed, std::sqrt(4 * tolerance * std::max(pressed, 0.0))});
  const double rebound = std::max(std::min(bodies_[a].restitution, bodies_[b].restitution) * approach, slowest);
  if (burst <= options_.zeno.contacts) return rebound;
  // It meets others again and again at one instant. So it gets the speed that takes it out of the tolerance within the
  // shortest flight.
  const BodySlot mesh = bodies_.fixed(a) ? a : b;
  return std::max(rebound, bending_tolerance * bodies_[mesh].bounding_radius / options_.shortest_flight);
}

#define KDS_INSTANTIATE(motion) template class BendingBounces<motion>;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
