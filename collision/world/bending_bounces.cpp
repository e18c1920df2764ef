// How bodies bounce off meshes that bend.
#include "collision/motions.hpp"
#include "collision/response/impulse.hpp"
#include "collision/shapes/bending_mesh.hpp"
#include "collision/vectors.hpp"
#include "collision/world/engine.hpp"

#include <algorithm>
#include <cmath>

namespace kds::collision {

using Eigen::Vector3d;

template <class Motion>
SurfaceRate Engine<Motion>::surface_rate(BodySlot slot, const Contact& contact, bool is_a) const
    requires(!turns<Motion>) {
  if (!bends(slot)) return {};
  return collision::surface_rate(*bodies_[slot].shape, is_a ? contact.feature_a : contact.feature_b,
                                 contact.point - bodies_.path(slot).position(contact.time), contact.normal,
                                 contact.time);
}

/// The least speed at which a body leaves a mesh that bends, so that bounces take time, and leave the tolerance within
/// which contacts are found. Nothing rests on such a mesh: what lies on it bounces in flights of
/// WorldOptions::shortest_flight.
template <class Motion>
double Engine<Motion>::least_rebound(BodySlot a, BodySlot b, const Contact& contact) const requires(!turns<Motion>) {
  const Vector3d& n = contact.normal;
  const double t = contact.time;
  const SurfaceRate of_a = surface_rate(a, contact, true), of_b = surface_rate(b, contact, false);
  const Vector3d velocity_a = bodies_.path(a).velocity(t) + of_a.velocity;
  const Vector3d velocity_b = bodies_.path(b).velocity(t) + of_b.velocity;
  const Vector3d from_a = bodies_.path(a).acceleration(t), from_b = bodies_.path(b).acceleration(t);
  // A surface that turns carries its normal along, so that what slides on it is pressed to it or lifted off.
  const Vector3d normal_rate = bends(a) ? of_a.normal_rate : of_b.normal_rate;
  double pressed = -dot(n, from_b - from_a) - 2 * dot(normal_rate, velocity_b - velocity_a);
  // And what falls together will be pressed together when one of them lies on something.
  for (const Vector3d& acceleration :
       {from_a, from_b, Vector3d(2 * bodies_.free_term(a, 2, t)), Vector3d(2 * bodies_.free_term(b, 2, t))}) {
    pressed = std::max(pressed, std::abs(dot(n, acceleration)));
  }
  double tolerance = 0;
  for (const BodySlot slot : {a, b}) {
    if (bends(slot)) tolerance = std::max(tolerance, bending_tolerance * bodies_[slot].bounding_radius);
  }
  const double approach = std::max(-dot(n, velocity_b - velocity_a), 0.0);
  constexpr double least = 0x1p-26;         // of the speed of approach: what would stick parts
  constexpr double of_roundings = 0x1p-40;  // of the speeds
  // A rise to twice the tolerance takes the root of twice the height times the acceleration.
  return std::max({least * approach, of_roundings * (norm(velocity_a) + norm(velocity_b)),
                   0.5 * options_.shortest_flight * pressed, std::sqrt(4 * tolerance * std::max(pressed, 0.0))});
}

/// The mesh is fixed, so the other body leaves it with the velocity of the surface at the contact and the rebound.
template <class Motion>
void Engine<Motion>::bounce_off_surface(BodySlot a, BodySlot b, const Contact& contact,
                                        std::uint64_t burst) requires(!turns<Motion>) {
  const BodySlot free = bodies_.fixed(a) ? b : a;
  const double rate = parting(a, b, contact);
  const double restitution = std::min(bodies_[a].restitution, bodies_[b].restitution);
  double rebound = std::max(restitution * -rate, least_rebound(a, b, contact));
  if (burst > options_.zeno.contacts) {  // It meets others again and again at one instant: out of the tolerance, then.
    rebound =
        std::max(rebound, bending_tolerance * bodies_[free == a ? b : a].bounding_radius / options_.shortest_flight);
  }
  const Vector3d away = free == a ? Vector3d(-contact.normal) : contact.normal;
  const double change = std::max(rebound - rate, 0.0);
  // Even a body that parts already begins a new piece: from here on what is near is looked at anew.
  Motion motion = bodies_.motion(free).restarted(contact.time);
  if (resting_.rests(free)) {
    motion.coefficients[1] = resting_.drive(free, away, dot(away, motion.coefficients[1]) + change);
  } else {
    Vector3d none = Vector3d::Zero();
    change_relative_velocity(none, motion.coefficients[1], away, change, 0, bodies_[free].inverse_mass);
  }
  resting_.leave(free);
  ++counters_.motion_updates;
  set_motion(free, motion, false);
  resting_.disturb(free);
  resting_.solve();
}

#define KDS_INSTANTIATE(motion) KDS_TEMPLATE_PART class Engine<motion>;
KDS_FOR_EACH_PATH(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
