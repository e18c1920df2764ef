#include "collision/world/turning/turning_bounces.hpp"

#include "collision/motions.hpp"
#include "collision/narrow_phase/turning/point_rates.hpp"
#include "collision/response/turning_impulse.hpp"
#include "collision/vectors.hpp"
#include "collision/world/turning/collapse.hpp"
#include "collision/world/turning/pressing.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>

namespace kds::collision {

using Eigen::Vector3d;

namespace {

void give_impulse(RigidVelocity& body, const Mobility& mobility, const Vector3d& arm, const Vector3d& impulse) {
  body.velocity += mobility.inverse_mass * impulse;
  body.angular_velocity += mobility.turned_by(cross(arm, impulse));
}

/// Whether a body between two opposite walls that leaves one of them with a speed is back before the clock has gone on
/// by much, so that it would bounce between the two endlessly at one instant. `forced`: it is that fast only since it
/// is pressed to the wall, for a flight that is higher than its room. `size`: magnitude of the coordinates.
bool has_no_room(const ZenoPolicy& zeno, double room, double speed, double pressed, bool forced, double size) {
  const double shortest = zeno.interval / std::max(zeno.contacts, 1u);
  if (room <= std::max(shortest * speed, 0x1p-48 * size)) return true;
  return forced && pressed > 0 && 2 * pressed * room <= speed * speed;
}

}  // namespace

template <class Motion>
TurningBounces<Motion>::TurningBounces(WorldParts<Motion>& parts, MotionUpdates<Motion>& motions,
                                       ListenerCalls<Motion>& calls, const BendingBounces<Motion>& bending)
    : options_(parts.options),
      clock_(parts.clock),
      counters_(parts.counters),
      bodies_(parts.bodies),
      tumbling_(parts.tumbling),
      walls_(parts.walls),
      reports_(parts.reports),
      resting_(parts.resting),
      motions_(motions),
      calls_(calls),
      bending_(bending) {}

template <class Motion>
double TurningBounces<Motion>::parting(BodySlot a, BodySlot b, const Contact& contact) const {
  const PointRates<Motion::degree> rates(bodies_.motion(a), bodies_.motion(b), contact.time);
  const double rate = dot(contact.normal, rates.velocity(contact.point) + bending_.velocity(a, b, contact));
  return std::abs(rate) <= rates.noise(contact.point) ? 0 : rate;
}

/// The speed with which two bodies part that have approached each other. Bodies that are pressed together part fast
/// enough for a flight of WorldOptions::shortest_flight. Bodies that would stick part with a small share of the speed
/// of approach. Otherwise the two would meet endlessly at one instant.
template <class Motion>
double TurningBounces<Motion>::rebound(double approach, double pressed, double restitution) const {
  constexpr double least = 0x1p-26;  // of the speed of approach
  return std::max({restitution * approach, least * approach, 0.5 * options_.shortest_flight * pressed});
}

/// The acceleration with which the gap at a contact closes, by which the two are pressed together; negative where they
/// are lifted off. Of what presses because they turn, so much as a shortest flight is to make good.
template <class Motion>
double TurningBounces<Motion>::pressed(BodySlot a, const Motion& motion_a, BodySlot b, const Motion& motion_b,
                                       const Contact& contact) const {
  const Vector3d& n = contact.normal;
  const Vector3d &turns_a = motion_a.angular_velocity, &turns_b = motion_b.angular_velocity;
  const PointRates<Motion::degree> rates(motion_a, motion_b, contact.time);
  const auto ball = [&](BodySlot slot) { return bodies_.mover(slot).radius > 0; };
  const auto radius = [&](BodySlot slot) {
    const auto* const capsule = bodies_[slot].shape ? std::get_if<Capsule>(&bodies_[slot].shape->shape) : nullptr;
    return capsule ? capsule->radius : 0.0;
  };
  const bool plane = bodies_.unbounded(a) || bodies_.unbounded(b) || contact.feature_a.kind == Feature::Kind::face ||
                     contact.feature_b.kind == Feature::Kind::face;
  // The gap between what is round and a plane is that of its centre, or of the place on the axis of a capsule, and not
  // that of the point that touches, which turns away from the plane.
  const Vector3d point = ball(a)   ? motion_a.path.coefficients[0]
                         : ball(b) ? motion_b.path.coefficients[0]
                         : plane   ? Vector3d(contact.point + (radius(b) - radius(a)) * n)
                                   : contact.point;
  // What presses because bodies turn does so while they turn by a small angle. A speed for the whole of a shortest
  // flight would multiply the energy of bodies that spin fast.
  double most_turn = 0x1p-3;  // rad
  Vector3d acceleration = rates.acceleration(point), velocity = rates.velocity(point);
  // A side of a box that turns carries its normal along, so that what slides on it is pressed to it or lifted off. The
  // normal of two edges that cross turns with both, and the faster, the smaller their angle is.
  Vector3d normal_turns = Vector3d::Zero();
  double rounded = 0;  // what presses since the sides of capsules are round
  if (bodies_.unbounded(a) || bodies_.unbounded(b)) {
    // The normal is that of the half-space, which does not turn.
  } else if (contact.feature_a.kind == Feature::Kind::face) {
    normal_turns = cross(turns_a, n);
  } else if (contact.feature_b.kind == Feature::Kind::face) {
    normal_turns = cross(turns_b, n);
  } else {
    const auto edge_of = [&](BodySlot slot, const Feature& feature) {
      return bodies_[slot].shape ? contact_edge(bodies_[slot].shape->shape, feature) : std::nullopt;
    };
    const auto end_of = [&](BodySlot slot, const Feature& feature) {
      if (ball(slot)) return std::optional(bodies_.mover(slot).radius);
      return bodies_[slot].shape ? contact_end(bodies_[slot].shape->shape, feature) : std::nullopt;
    };
    const auto in_world = [&](const Motion& motion, const Vector3d& x) {
      const Eigen::Matrix3d axes = motion.rotation(contact.time).matrix();
      return Vector3d(axes.col(0) * x[0] + axes.col(1) * x[1] + axes.col(2) * x[2]);
    };
    auto edge_a = edge_of(a, contact.feature_a), edge_b = edge_of(b, contact.feature_b);
    if (!edge_a || !edge_b) {
      const auto end_a = edge_a ? std::optional(edge_a->radius) : end_of(a, contact.feature_a);
      const auto end_b = edge_b ? std::optional(edge_b->radius) : end_of(b, contact.feature_b);
      const double radii = end_a.value_or(0) + end_b.value_or(0);
      if (end_a && end_b && radii > 0) {
        const Vector3d way_a = *end_a * n, way_b = *end_b * n;  // from the one centre to the contact and on
        acceleration = rates.acceleration(contact.point) + cross(turns_a, cross(turns_a, way_a)) +
                       cross(turns_b, cross(turns_b, way_b));
        velocity = rates.velocity(contact.point) + cross(turns_a, way_a) + cross(turns_b, way_b);
        const Motion& of_edge = edge_a ? motion_a : motion_b;
        const auto& edge = edge_a ? edge_a : edge_b;
        rounded = edge ? -opens_at_side(in_world(of_edge, edge->along), of_edge.angular_velocity, velocity, n, radii)
                       : -opens_at_end(velocity, n, radii);
      }
    }
    if (edge_a && edge_b) {
      edge_a->along = in_world(motion_a, edge_a->along);
      edge_b->along = in_world(motion_b, edge_b->along);
      if (const auto edges = CrossingEdges::of(*edge_a, *edge_b, turns_a, turns_b, n)) {
        const Vector3d way_a = edges->radius_a * n, way_b = edges->radius_b * n;  // from the axes to the contact and on
        acceleration += cross(turns_a, cross(turns_a, way_a)) + cross(turns_b, cross(turns_b, way_b));
        velocity += cross(turns_a, way_a) + cross(turns_b, way_b);
        normal_turns = edges->normal_rate;
        rounded = (edges->radius_a + edges->radius_b) * squared_norm(normal_turns);
        most_turn *= edges->sine;
      }
    }
  }
  const double pressed = -dot(n, acceleration) - 2 * dot(normal_turns, velocity) + rounded;
  const double turn = options_.shortest_flight * std::max(norm(turns_a), norm(turns_b));
  if (!(turn > most_turn)) return pressed;
  const double of_paths = -dot(n, motion_b.path.acceleration(contact.time) - motion_a.path.acceleration(contact.time));
  return of_paths + most_turn / turn * (pressed - of_paths);
}

/// The motions of two bodies that meet after their impulse. They do not change where the two do not approach, unless
/// one of them bends: then the other, which is within the tolerance, begins a new piece that leaves it.
template <class Motion>
TurningImpact<Motion> TurningBounces<Motion>::impact(BodySlot a, BodySlot b, const Contact& contact,
                                                     std::uint64_t burst) {
  const bool often = burst > options_.zeno.contacts;
  TurningImpact<Motion> result{met(a, contact.time), met(b, contact.time)};
  Motion& motion_a = result.a;
  Motion& motion_b = result.b;
  const Vector3d& n = contact.normal;
  const PointRates<Motion::degree> rates(motion_a, motion_b, contact.time);
  const bool bending = bending_.bend(a, b);
  double approach = -dot(n, rates.velocity(contact.point) + bending_.velocity(a, b, contact));
  // A ball that was placed on a floor and is pulled down meets it without approaching it.
  if (std::abs(approach) <= rates.noise(contact.point)) approach = std::max(approach, 0.0);
  result.approach = approach >= 0 || bending;
  if (!result.approach) return result;
  const auto ball = [&](BodySlot slot) { return bodies_.mover(slot).radius > 0; };
  double pressed = this->pressed(a, motion_a, b, motion_b, contact);
  // Two bodies that fall together are not pressed together yet, but are when one of them lies on something: so what
  // each of them would press if the other were at rest counts too.
  const auto along_normal = [&](const Motion& motion) { return dot(n, motion.path.acceleration(contact.time)); };
  const double of_a_alone = along_normal(motion_a), of_b_alone = along_normal(motion_b);
  const double by_weight = std::max({of_a_alone - of_b_alone, std::abs(of_a_alone), std::abs(of_b_alone)});
  pressed = std::max({pressed, std::abs(of_a_alone), std::abs(of_b_alone)});
  result.speed = approach;
  result.least = 0.5 * options_.shortest_flight * std::max(pressed, 0.0);
  // Where the contacts of one instant are not resolved together (collapse.hpp), after too many nothing is lost any
  // more: with losses of energy three bodies in a line can make infinitely many.
  const double restitution = often ? 1 : std::min(bodies_[a].restitution, bodies_[b].restitution);
  RigidVelocity velocity_a{motion_a.path.coefficients[1], motion_a.angular_velocity};
  RigidVelocity velocity_b{motion_b.path.coefficients[1], motion_b.angular_velocity};
  if (bodies_.bends(a)) velocity_a.velocity += bending_.rate(a, contact, true).velocity;
  if (bodies_.bends(b)) velocity_b.velocity += bending_.rate(b, contact, false).velocity;
  const auto leaves_with = [&](double approaches) {
    return bending ? bending_.rebound(a, b, contact, approaches, burst) : rebound(approaches, pressed, restitution);
  };
  const auto mobility_of = [&](BodySlot slot) { return resting_.carries(slot) ? Mobility::fixed() : mobility(slot); };
  const Mobility of_a = mobility_of(a), of_b = mobility_of(b);
  // Of two bodies the lower counts, as of restitutions.
  Surfaces surfaces{
      .friction = often ? 0 : std::min(bodies_[a].friction, bodies_[b].friction),
      .tangential_restitution = std::min(bodies_[a].tangential_restitution, bodies_[b].tangential_restitution)};
  // An impulse along its normal does not turn a ball.
  const auto arm = [&](BodySlot slot, const Motion& motion) {
    return surfaces.smooth() && ball(slot) ? Vector3d(Vector3d::Zero())
                                           : Vector3d(contact.point - motion.path.coefficients[0]);
  };
  const ContactArms arms{n, arm(a, motion_a), arm(b, motion_b)};
  const double rolling = often ? 0 : std::min(bodies_[a].rolling_friction, bodies_[b].rolling_friction);
  const auto closing = [&] {
    return -dot(n, (velocity_b.velocity + cross(velocity_b.angular_velocity, arms.b)) -
                       (velocity_a.velocity + cross(velocity_a.angular_velocity, arms.a)));
  };
  Vector3d couple = Vector3d::Zero();
  if (rolling > 0) {
    const double change = approach + leaves_with(approach);
    couple = brake_turning(velocity_a, velocity_b, of_a, of_b, arms, rolling * push_for(change, of_a, of_b, arms));
    approach = closing();
  }
  // That bodies turn presses them together, but is no force: where it makes them part faster than they approach, the
  // energy of that is taken from how they turn.
  double speed = leaves_with(approach);
  const double paid = std::max(rebound(approach, by_weight, restitution), approach);
  if (!bending && speed > paid) {
    const double mass = push_for(1, of_a, of_b, arms);
    const TurningBrake brake =
        spend_turning(velocity_a, velocity_b, of_a, of_b, 0.5 * mass * (speed * speed - paid * paid));
    couple += brake.couple;
    approach = closing();
    const double affordable = std::sqrt(approach * approach + 2 * brake.spent / mass);
    speed = std::min(speed, std::max(rebound(approach, by_weight, restitution), affordable));
  }
  if (approach > 0) {
    surfaces.restitution = speed / approach;
    result.impulse = collide(velocity_a, velocity_b, of_a, of_b, arms, surfaces).impulse;
  } else {
    const double change = std::max(speed + approach, 0.0);
    result.impulse = push_for(change, of_a, of_b, arms) * n;
    give_impulse(velocity_a, of_a, arms.a, -result.impulse), give_impulse(velocity_b, of_b, arms.b, result.impulse);
  }
  const auto take_over = [&](BodySlot slot, const RigidVelocity& velocity, Motion& motion) {
    if (!bodies_.bends(slot))
      motion.path.coefficients[1] = velocity.velocity, motion.angular_velocity = velocity.angular_velocity;
  };
  take_over(a, velocity_a, motion_a), take_over(b, velocity_b, motion_b);
  result.turn_a = -cross(arms.a, result.impulse) - couple;
  result.turn_b = cross(arms.b, result.impulse) + couple;
  return result;
}

/// How much an impulse moves a body, at rest or not.
template <class Motion>
Mobility TurningBounces<Motion>::mobility(BodySlot slot) const {
  if (tumbling_.has(slot)) return Mobility::of(bodies_[slot].inverse_mass, tumbling_.inverse_inertia(slot));
  return Mobility::of_spherical(bodies_[slot].inverse_mass, bodies_[slot].inverse_inertia);
}

template <class Motion>
bool TurningBounces<Motion>::respond(BodySlot a, BodySlot b, const Contact& contact, std::uint64_t burst) {
  const bool may_wake = resting_.meet(a, b);
  TurningImpact<Motion> hit = impact(a, b, contact, burst);
  if (may_wake && hit.approach) {  // What rests wakes only where the impulse would move it.
    const auto mobility_of = [this](BodySlot slot) { return mobility(slot); };
    const bool woke = resting_.strike(a, hit.turn_a, b, hit.turn_b, hit.impulse, mobility_of);
    if (woke) hit = impact(a, b, contact, burst);
  }
  if (!may_wake && hit.approach) {
    const Collapse collapse = part_together(a, b, contact, hit, burst);
    if (collapse == Collapse::stuck) {  // They still approach, so they are let through.
      ++counters_.rebounds_suppressed;
      return true;
    }
    if (collapse == Collapse::parted) return rests_now(a, b, contact);
  }
  auto& [motion_a, motion_b, impulse, turn_a, turn_b, speed, least, approach] = hit;
  const auto both = {std::pair<BodySlot, const Motion&>{a, motion_a}, {b, motion_b}};
  if (!approach) {  // The pieces of their motions approach, their free rotations do not.
    turn_back(a, b, motion_a, motion_b, contact);
    for (const auto& [slot, motion] : both) {
      if (precesses(slot)) motions_.set(slot, motion, false);
    }
    return false;
  }
  const auto push = [&](BodySlot slot, Motion& motion, const Vector3d& angular_impulse) {
    if (!precesses(slot)) return;
    tumbling_.push(slot, angular_impulse);
    tumbling_.set_path(slot, motion.path);
    motion.angular_velocity = tumbling_.angular_velocity(slot);
  };
  push(a, motion_a, turn_a);
  push(b, motion_b, turn_b);
  turn_back(a, b, motion_a, motion_b, contact);
  for (const auto& [slot, motion] : both) {
    if (bodies_.fixed(slot) || resting_.carries(slot)) continue;
    ++counters_.motion_updates;
    motions_.set(slot, motion, false);
  }
  return !bending_.bend(a, b) && rests_now(a, b, contact);  // Nothing rests on what bends.
}

/// Whether two bodies that have met come to rest.
template <class Motion>
bool TurningBounces<Motion>::rests_now(BodySlot a, BodySlot b, const Contact& contact) {
  const bool rests = resting_.comes_to_rest(a, b, contact, [this](BodySlot slot) { return mobility(slot); });
  counters_.rebounds_suppressed += rests;
  return rests;
}

/// The motion of a body just before a contact, for one that precesses with the angular velocity of its free rotation.
template <class Motion>
Motion TurningBounces<Motion>::met(BodySlot slot, double t) {
  Motion motion = bodies_.motion(slot).restarted(t);
  if (!precesses(slot)) return motion;
  tumbling_.meet(slot, motion.orientation, t);
  motion.angular_velocity = tumbling_.angular_velocity(slot);
  return motion;
}

/// motion_a and motion_b are the motions just after a contact: bodies that precess get the pieces that lead back to
/// their free rotations. As the additional rotation may close the gap again, only so much of it is used that the two
/// bodies part with at least half of their speed.
template <class Motion>
void TurningBounces<Motion>::turn_back(BodySlot a, BodySlot b, Motion& motion_a, Motion& motion_b,
                                       const Contact& contact) {
  if (!precesses(a) && !precesses(b)) return;
  const double t = contact.time;
  const auto parting = [&](const Motion& of_a, const Motion& of_b) {
    const Vector3d of_bodies = PointRates<Motion::degree>(of_a, of_b, t).velocity(contact.point);
    return dot(contact.normal, of_bodies + bending_.velocity(a, b, contact));
  };
  std::optional<RotationPiece> piece_a, piece_b;
  Motion back_a = motion_a, back_b = motion_b;
  const auto look = [&](BodySlot slot, Motion& back, std::optional<RotationPiece>& piece) {
    if (!precesses(slot)) return;
    piece = tumbling_.way_back(slot, back.orientation);
    back.angular_velocity = piece->angular_velocity;
  };
  look(a, back_a, piece_a), look(b, back_b, piece_b);
  const double free = parting(motion_a, motion_b);
  const double led = parting(back_a, back_b);
  // If two neighbours led a body back in different ways it could go to and fro endlessly. So after some contacts at one
  // instant nothing is led back.
  const auto often = [&](BodySlot slot) {
    return bodies_.fixed(slot) || bodies_[slot].meetings >= detail::collapse_meetings;
  };
  const bool goes_on = often(a) && often(b);
  const bool whole = !goes_on && free > 0 && led >= free / 2;
  const double share = whole ? 1 : free > 0 && !goes_on ? free / 2 / (free - led) : 0;
  const auto lead = [&](BodySlot slot, Motion& motion, const std::optional<RotationPiece>& piece) {
    if (!piece) return;
    const Vector3d more = piece->angular_velocity - motion.angular_velocity;
    motion.angular_velocity = whole ? piece->angular_velocity : Vector3d(motion.angular_velocity + share * more);
    tumbling_.follow(slot, *piece, whole, t);
  };
  lead(a, motion_a, piece_a), lead(b, motion_b, piece_b);
}

/// Walls meet bounding balls, so they do not turn a body. One that has no room between two of them stands still along
/// their axis from then on.
template <class Motion>
void TurningBounces<Motion>::process_wall() {
  const BodySlot slot = walls_.next_body();
  const auto& body = bodies_[slot];
  const Walls& walls = *options_.walls;
  const int wall = walls_.next_wall();
  const int axis = wall / 2;
  const double out = wall % 2 != 0 ? 1 : -1;
  Motion motion = bodies_.motion(slot).restarted(clock_.now);
  auto& path = motion.path.coefficients;
  const double approach = path[1][axis] * out;
  double pressed = 0;
  if constexpr (Motion::degree >= 2) pressed = 2 * path[2][axis] * out;
  const double restitution = std::min(body.restitution, walls.restitution);
  const double speed = rebound(approach, pressed, restitution);
  const double room = walls.max[axis] - walls.min[axis] - 2 * body.bounding_radius;
  const double size = path[0].cwiseAbs().maxCoeff() + body.bounding_radius;
  const bool held = has_no_room(options_.zeno, room, speed, pressed, speed > restitution * approach, size);
  if (held) {
    for (std::size_t i = 1; i <= Motion::degree; ++i) path[i][axis] = 0;
    ++counters_.rebounds_suppressed;
  } else {
    path[1][axis] = -out * speed;
  }
  WallEvent event{bodies_.id_of(slot), wall, {.time = clock_.now}, bodies_[slot].user_data};
  event.contact.normal = Vector3d::Zero();  // not a unit vector times -1, whose zeros would be negative
  event.contact.normal[axis] = out;
  event.contact.point = path[0];
  event.contact.point[axis] = out > 0 ? walls.max[axis] : walls.min[axis];
  ++counters_.wall_contacts;
  ++counters_.motion_updates;
  if (tumbling_.has(slot)) tumbling_.set_path(slot, motion.path);
  motions_.set(slot, motion, false);
  calls_.tell([&](auto& listener, auto& world) {
    listener.wall(world, event);
    if (held) listener.rebound_suppressed_at_wall(world, event);
  });
}

#define KDS_INSTANTIATE(motion) template class TurningBounces<motion>;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
