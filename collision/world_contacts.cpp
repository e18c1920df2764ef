// Contacts of the world: dynamic tests, response, walls.
#include "certificates/conjunction.hpp"
#include "certificates/wall_separation.hpp"
#include "collision/profile.hpp"
#include "collision/world.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace kds::collision {
namespace {

using Eigen::Vector3d;

/// Rate at which b parts from a along the normal just after the contact; of two that have none, its derivative.
template <int Degree>
double parting(const Contact& contact, const certificates::PointMotion<Degree>& a,
               const certificates::PointMotion<Degree>& b) {
  const double t = contact.time;
  const double rate = contact.normal.dot(b.velocity(t) - a.velocity(t));
  return rate != 0 ? rate : contact.normal.dot(b.acceleration(t) - a.acceleration(t));
}

template <int Degree>
bool at_rest(const certificates::PointMotion<Degree>& motion) {
  for (std::size_t i = 1; i <= Degree; ++i) {
    if (!motion.coefficients[i].isZero(0)) return false;
  }
  return true;
}

}  // namespace

template <int Degree>
void World<Degree>::test_dirty_pairs() {
  const Stopwatch watch(profile(), Work::test);
  // In the order of the bodies, whatever the broad phase, so that overlaps are reported in one order.
  std::sort(dirty_.begin(), dirty_.end(), [&](PairSlot x, PairSlot y) {
    return std::pair(pairs_[x].a, pairs_[x].b) < std::pair(pairs_[y].a, pairs_[y].b);
  });
  for (const PairSlot slot : dirty_) {
    pairs_[slot].dirty = false;
    if (!pairs_[slot].alive) continue;
    test(slot);
    if (options_.report_pairs && !broad_phase_->exact()) test_boxes(slot);
    pairs_[slot].fresh = false;
  }
  dirty_.clear();
}

template <int Degree>
void World<Degree>::test(PairSlot slot) {
  Pair& pair = pairs_[slot];
  const auto a = moving(pair.a);
  const auto b = moving(pair.b);
  const auto report_overlap = [&] {
    pending_.push_back({Pending::Kind::overlap, pair.a, pair.b, contact_at(a, b, now_)});
  };
  ++counters_.pair_tests;
  double next = never;
  if (mode() == ContactMode::transparent) {
    if (pair.fresh && in_contact(a, b, now_)) {
      pair.touching = true;
      report_overlap();
    }
    if (at_rest(a.motion) && at_rest(b.motion)) {  // Nothing will happen, but a jump may have happened.
      next = in_contact(a, b, now_) == pair.touching ? never : now_;
    } else {
      next = pair.touching ? first_separation(a, b, now_, horizon_)
                           : first_contact(a, b, now_, horizon_, ContactMode::transparent);
    }
  } else {
    if (pair.fresh || pair.ignored) {
      pair.ignored = in_contact(a, b, now_);
      if (pair.fresh && pair.ignored) report_overlap();
    }
    if (!(at_rest(a.motion) && at_rest(b.motion))) {
      const double from = pair.ignored ? first_separation(a, b, now_, horizon_) : now_;
      if (from != never) next = first_contact(a, b, from, horizon_, ContactMode::resolved);
    }
  }
  contacts_.set(slot, next);
}

template <int Degree>
void World<Degree>::process_contact(PairSlot slot, double t) {
  contacts_.clear(slot);
  Pair& pair = pairs_[slot];
  const PairEvent event{pair.a, pair.b, contact_at(moving(pair.a), moving(pair.b), t)};
  if (mode() == ContactMode::transparent) {
    pair.touching = !pair.touching;
    mark_dirty(slot);
    if (pair.touching) {
      ++counters_.contacts;
      return listener_->contact(*this, event);
    }
    ++counters_.separations;
    return listener_->separation(*this, event);
  }
  ++counters_.contacts;
  pair.ignored = false;
  mark_dirty(slot);
  bool held = false;
  if (options_.response == Response::elastic) held = respond(slot, event.contact);
  listener_->contact(*this, event);
  if (held) listener_->held(*this, event);
  // A pair that is still pressed together (nobody can or will move it) passes through.
  if (pairs_[slot].alive && pairs_[slot].a == event.a && pairs_[slot].b == event.b) {
    if (parting(event.contact, bodies_[event.a].motion, bodies_[event.b].motion) < 0) {
      pairs_[slot].ignored = true;
      mark_dirty(slot);
    }
  }
}

template <int Degree>
std::uint64_t World<Degree>::count_meeting(Body& body, double t) const {
  if (t - body.burst_start > options_.zeno.interval) {
    body.meetings = 0;
    body.burst_start = t;
  }
  return ++body.meetings;
}

template <int Degree>
bool World<Degree>::respond(PairSlot slot, const Contact& contact) {
  const Pair& pair = pairs_[slot];
  const BodyId a = pair.a;
  const BodyId b = pair.b;
  const double inverse_a = bodies_[a].inverse_mass;
  const double inverse_b = bodies_[b].inverse_mass;
  if (inverse_a + inverse_b == 0) return false;
  const double t = contact.time;
  Motion motion_a = bodies_[a].motion.restarted(t);
  Motion motion_b = bodies_[b].motion.restarted(t);
  const Vector3d& n = contact.normal;
  const double approach = n.dot(motion_b.coefficients[1] - motion_a.coefficients[1]);
  const auto meetings = [&](BodyId id) {
    return bodies_[id].inverse_mass == 0 ? std::numeric_limits<std::uint64_t>::max() : count_meeting(bodies_[id], t);
  };
  const std::uint64_t burst = std::min(meetings(a), meetings(b));
  const std::uint64_t patience = options_.zeno.contacts;
  const bool held = burst > patience || !(approach < 0);
  if (burst > 2 * patience) {  // Holding does not help: the pair is left as it is, and so passes through.
    ++counters_.held;
    return true;
  }
  // Elastic: the relative normal velocity turns round. Held: it goes, and the relative normal acceleration with it.
  const auto exchange = [&](std::size_t order, double restitution) {
    const double relative = n.dot(motion_b.coefficients[order] - motion_a.coefficients[order]);
    const double impulse = -(1 + restitution) * relative / (inverse_a + inverse_b);
    motion_a.coefficients[order] -= impulse * inverse_a * n;
    motion_b.coefficients[order] += impulse * inverse_b * n;
  };
  exchange(1, held ? 0 : 1);
  if constexpr (Degree >= 2) {
    if (held) exchange(2, 0);
  }
  if (held) {
    ++counters_.held;
    pairs_[slot].ignored = true;
  }
  for (const auto& [id, motion] : {std::pair<BodyId, const Motion&>{a, motion_a}, {b, motion_b}}) {
    if (bodies_[id].inverse_mass == 0) continue;
    ++counters_.motion_updates;
    set_motion(id, motion, false);
  }
  return held;
}

template <int Degree>
void World<Degree>::test_boxes(PairSlot slot) {
  Pair& pair = pairs_[slot];
  const BoxOverlap<Degree> boxes(bodies_[pair.a].box, bodies_[pair.b].box);
  const auto apart = boxes.separations();
  const std::span<const typename BoxOverlap<Degree>::Apart> sides(apart);
  // A change of motion may leave boxes that touch for good: they do not overlap, although no side has a gap.
  const double next = !pair.boxes_overlap                         ? certificates::first_all_broken(now_, horizon_, sides)
                      : certificates::all_broken(now_, sides) ? certificates::first_any_holds(now_, horizon_, sides)
                                                                  : now_;
  boxes_.set(slot, next);
  if (next == now_) process_boxes(slot, now_);
}

template <int Degree>
void World<Degree>::process_boxes(PairSlot slot, double t) {
  Pair& pair = pairs_[slot];
  pair.boxes_overlap = !pair.boxes_overlap;
  const auto kind = pair.boxes_overlap ? Pending::Kind::pair_began : Pending::Kind::pair_ended;
  pending_.push_back({kind, pair.a, pair.b, {.time = t}});
  now_ = t;
  test_boxes(slot);
}

template <int Degree>
double World<Degree>::next_wall_time(const Body& body, int wall) const {
  const int axis = wall / 2;
  const bool upper = wall % 2 != 0;
  using Wall = certificates::WallSeparation<Degree>;
  const Motion& motion = body.motion;
  bool moves = false;
  for (std::size_t i = 1; i <= Degree; ++i) moves = moves || motion.coefficients[i][axis] != 0;
  if (!moves) return never;
  const Wall inside{motion.axis(axis), upper ? options_.walls->max[axis] : options_.walls->min[axis],
                    body.shape.bounding_radius, upper ? 1.0 : -1.0};
  const DerivativeCertificate<Wall> leaving{inside};
  // Outside and still going outward.
  return certificates::first_all_broken<Wall, DerivativeCertificate<Wall>>(now_, horizon_, {&inside, 1},
                                                                                        {&leaving, 1});
}

template <int Degree>
void World<Degree>::process_wall(BodyId id, double t) {
  Body& body = bodies_[id];
  int wall = 0;
  while (wall < 6 && next_wall_time(body, wall) != t) ++wall;
  const int axis = wall / 2;
  const double out = wall % 2 != 0 ? 1 : -1;
  Motion motion = body.motion.restarted(t);
  const bool held = count_meeting(body, t) > options_.zeno.contacts || motion.coefficients[1][axis] * out <= 0;
  motion.coefficients[1][axis] = held ? 0 : -motion.coefficients[1][axis];
  if constexpr (Degree >= 2) {
    if (held) motion.coefficients[2][axis] = 0;
  }
  WallEvent event{id, wall, {.time = t}};
  event.contact.normal = Vector3d::Unit(axis) * out;
  event.contact.point = motion.coefficients[0];
  event.contact.point[axis] = out > 0 ? options_.walls->max[axis] : options_.walls->min[axis];
  ++counters_.wall_contacts;
  ++counters_.motion_updates;
  counters_.held += held;
  set_motion(id, motion, false);
  listener_->wall(*this, event);
}

template class World<1>;
template class World<2>;

}  // namespace kds::collision
