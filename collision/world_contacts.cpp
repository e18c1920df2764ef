// Contacts of the world: dynamic tests, response, walls.
#include "certificates/ball_separation.hpp"
#include "certificates/conjunction.hpp"
#include "certificates/wall_separation.hpp"
#include "collision/parallel.hpp"
#include "collision/profile.hpp"
#include "collision/response/impulse.hpp"
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

/// Bodies that have been put so near that nothing but rounding is between them, this times their coordinates: they
/// touch, and so meet if they approach, and rest if they are pressed together. Larger takes more for a touch.
constexpr double touch_rounding = 0x1p-40;

/// Whether bodies in contact at t only touch: at rest in their places, and a rounding farther apart, they are free.
template <int Degree>
bool only_touching(const MovingShape<Degree>& a, const MovingShape<Degree>& b, double t) {
  const Contact contact = contact_at(a, b, t);
  certificates::PointMotion<Degree> place_a = a.motion.restarted(t);
  certificates::PointMotion<Degree> place_b = b.motion.restarted(t);
  for (std::size_t i = 1; i <= Degree; ++i) place_a.coefficients[i] = place_b.coefficients[i] = Vector3d::Zero();
  const double size = place_a.coefficients[0].cwiseAbs().maxCoeff() + place_b.coefficients[0].cwiseAbs().maxCoeff() +
                      std::min(a.shape.bounding_radius, b.shape.bounding_radius);
  place_b.coefficients[0] += touch_rounding * size * contact.normal;
  return !in_contact(MovingShape<Degree>{a.shape, place_a}, MovingShape<Degree>{b.shape, place_b}, t);
}

}  // namespace

template <int Degree>
void World<Degree>::test_dirty_pairs() {
  const Stopwatch watch(profile(), Work::test);
  // In the order of the bodies, whatever the broad phase, so that reports are made in one order.
  const bool reports = (options_.report_pairs && !broad_phase_->exact()) ||
                       std::any_of(dirty_.begin(), dirty_.end(), [&](PairSlot slot) { return pairs_[slot].fresh; });
  const auto earlier = [&](PairSlot x, PairSlot y) {
    return std::pair(pairs_[x].a, pairs_[x].b) < std::pair(pairs_[y].a, pairs_[y].b);
  };
  if (reports && !std::is_sorted(dirty_.begin(), dirty_.end(), earlier)) {
    std::sort(dirty_.begin(), dirty_.end(), earlier);
  }
  const std::vector<BallTest> tests = tests_of_balls();
  for (std::size_t i = 0; i < dirty_.size(); ++i) {
    const PairSlot slot = dirty_[i];
    pairs_[slot].dirty = false;
    if (!pairs_[slot].alive) continue;
    test(slot, tests.empty() ? test_of_balls(pairs_[slot]) : tests[i]);
    if (options_.report_pairs && !broad_phase_->exact()) test_boxes(slot);
    pairs_[slot].fresh = false;
  }
  dirty_.clear();
  std::erase_if(passing_, [&](const Passing& passing) { return !passing.let_pass || next_up(passing.at) < now_; });
}

/// Most tests by far are these, and need two cache lines. They change nothing.
template <int Degree>
auto World<Degree>::test_of_balls(const Pair& pair) const -> BallTest {
  if (pair.ignored || mode() != ContactMode::resolved || holds_.size() != free_holds_.size()) return {};
  const Mover& a = movers_[pair.a];
  const Mover& b = movers_[pair.b];
  if (!(a.ball_radius > 0 && b.ball_radius > 0) || (at_rest(a.motion) && at_rest(b.motion))) return {};
  const certificates::BallSeparation<Degree> apart{a.motion, b.motion, a.ball_radius, b.ball_radius};
  if (pair.fresh && !apart.surely_apart(now_)) return {};
  if (pair.let_pass == now_ && !pair.fresh) return {apart.first_approach(next_up(now_), horizon_), true, true};
  const auto [time, exact] = apart.estimated_first_approach(now_, horizon_);
  return {time, exact, true};
}

/// Those of all dirty pairs, by several threads; none where they are few.
template <int Degree>
auto World<Degree>::tests_of_balls() const -> std::vector<BallTest> {
  const std::size_t threads = threads_for(dirty_.size(), options_.threads);
  if (threads == 1) return {};
  std::vector<BallTest> tests(dirty_.size());
  in_parts(dirty_.size(), threads, [&](std::size_t, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      if (pairs_[dirty_[i]].alive) tests[i] = test_of_balls(pairs_[dirty_[i]]);
    }
  });
  return tests;
}

template <int Degree>
void World<Degree>::test(PairSlot slot, const BallTest& of_balls) {
  Pair& pair = pairs_[slot];
  ++counters_.pair_tests;
  if (of_balls.done) [[likely]] {
    pair.estimated = !of_balls.exact;
    contacts_.set(slot, of_balls.time);
    return;
  }
  const auto a = moving(pair.a);
  const auto b = moving(pair.b);
  const auto report_overlap = [&] {
    pending_.push_back({Pending::Kind::overlap, pair.a, pair.b, contact_at(a, b, now_)});
  };
  ContactEstimate next{never, true};
  if (mode() == ContactMode::transparent) {
    if (pair.fresh && in_contact(a, b, now_)) {
      pair.touching = true;
      report_overlap();
    }
    if (at_rest(a.motion) && at_rest(b.motion)) {  // Nothing will happen, but a jump may have happened.
      next.time = in_contact(a, b, now_) == pair.touching ? never : now_;
    } else if (pair.touching) {
      next.time = first_separation(a, b, now_, horizon_);
    } else {
      next = estimated_first_contact(a, b, now_, horizon_, mode(), pair.memory);
    }
  } else {
    const bool passes = pair.let_pass == now_ && !pair.fresh;
    if ((pair.fresh || pair.ignored) && !passes) {
      pair.ignored = in_contact(a, b, now_) && !(pair.fresh && only_touching(a, b, now_));
      if (pair.fresh && pair.ignored) report_overlap();
    }
    if (find_hold(pair.a, pair.b) != no_hold) {
      next.time = next_contact_of_held(pair);
    } else if (!(at_rest(a.motion) && at_rest(b.motion))) {
      const double start = passes ? next_up(now_) : now_;
      if (pair.ignored && start <= horizon_) {
        const double from = first_separation(a, b, start, horizon_);
        if (from <= horizon_) next.time = first_contact(a, b, from, horizon_, mode());
      } else if (passes) {
        if (start <= horizon_) next.time = first_contact(a, b, start, horizon_, mode());
      } else {
        next = estimated_first_contact(a, b, now_, horizon_, mode(), pair.memory);
      }
    }
  }
  contacts_.set(slot, next.time);
  pair.estimated = !next.exact;
}

template <int Degree>
void World<Degree>::set_contact(PairSlot slot, double time) {
  pairs_[slot].estimated = false;
  contacts_.set(slot, time);
}

/// What comes first is no more than a lower bound: finds the exact time, which may be later. Most estimates never come
/// first, since motions change before.
template <int Degree>
void World<Degree>::certify_contact(PairSlot slot) {
  const Pair& pair = pairs_[slot];
  const Mover& a = movers_[pair.a];
  const Mover& b = movers_[pair.b];
  if (a.ball_radius > 0 && b.ball_radius > 0) {
    const certificates::BallSeparation<Degree> apart{a.motion, b.motion, a.ball_radius, b.ball_radius};
    return set_contact(slot, apart.first_approach(now_, horizon_));
  }
  set_contact(slot, first_contact(moving(pair.a), moving(pair.b), now_, horizon_, mode()));
}

template <int Degree>
void World<Degree>::certify_wall(BodyId id) {
  bodies_[id].wall_estimated = false;
  double first = never;
  for (int wall = 0; wall < 6; ++wall) {
    if (earliest_wall_time(id, wall) > std::min(first, horizon_)) continue;
    first = std::min(first, next_wall_time(id, wall, std::min(first, horizon_)));
  }
  walls_.set(id, first);
}

/// Balls need not be made into shapes for it.
template <int Degree>
Contact World<Degree>::contact_of(BodyId a, BodyId b, double t) const {
  const Mover& of_a = movers_[a];
  const Mover& of_b = movers_[b];
  if (of_a.ball_radius > 0 && of_b.ball_radius > 0) {
    return ball_contact_at(of_a.motion, of_b.motion, of_a.ball_radius, t);
  }
  return contact_at(moving(a), moving(b), t);
}

template <int Degree>
void World<Degree>::process_contact(PairSlot slot, double t) {
  contacts_.clear(slot);
  Pair& pair = pairs_[slot];
  const PairEvent event{pair.a, pair.b, contact_of(pair.a, pair.b, t)};
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
  bool passes = false;
  if (options_.response == Response::elastic) {
    held = respond(slot, event.contact);
  } else {
    held = passes = count_meeting(event.a, event.b) > patience();
    counters_.held += held;
  }
  listener_->contact(*this, event);
  if (held) listener_->held(*this, event);
  // A pair that is still pressed together (nobody can or will move it) passes through.
  if (!contains(event.a) || !contains(event.b) || find_hold(event.a, event.b) != no_hold) return;
  // Whether the broad phase still has the pair does not matter: the callback may have parted their boxes by a rounding.
  if (passes || parting(event.contact, movers_[event.a].motion, movers_[event.b].motion) < 0) {
    let_pass(event.a, event.b);
  }
}

/// Both have met others so often; a fixed body's meetings count only with another fixed one.
template <int Degree>
std::uint64_t World<Degree>::count_meeting(BodyId a, BodyId b) {
  const bool a_fixed = bodies_[a].inverse_mass == 0;
  const bool b_fixed = bodies_[b].inverse_mass == 0;
  if (a_fixed != b_fixed) return count_meeting(a_fixed ? b : a);
  const std::uint64_t of_a = count_meeting(a);
  return std::min(of_a, count_meeting(b));
}

template <int Degree>
std::uint64_t World<Degree>::count_meeting(BodyId id) {
  Body& body = bodies_[id];
  if (now_ - body.burst_start > options_.zeno.interval) {
    body.meetings = 0;
    body.burst_start = now_;
  }
  return ++body.meetings;
}

/// Whether what meets is held: see ZenoPolicy. `pressed`: relative acceleration towards each other; `size`: of the
/// coordinates.
template <int Degree>
bool World<Degree>::stays(double rebound, double pressed, double size, std::uint64_t burst) const {
  if (!(rebound > 0) || burst > options_.zeno.contacts) return true;
  if (!(pressed > 0)) return false;
  // Near a large clock doubles are sparse: a flight lasts some of them at least. And it rises by some roundings of the
  // coordinates: bodies with a light one between them bounce for ever where positions cannot come nearer.
  const double spacing = next_up(std::abs(now_)) - std::abs(now_);
  const double shortest = std::max(options_.zeno.interval / std::max(options_.zeno.contacts, 1u), 16 * spacing);
  const double lowest = 0x1p-48 * size;
  return 2 * rebound < shortest * pressed || rebound * rebound < 2 * pressed * lowest;
}

template <int Degree>
bool World<Degree>::respond(PairSlot slot, const Contact& contact) {
  const BodyId a = pairs_[slot].a;
  const BodyId b = pairs_[slot].b;
  const double inverse_a = bodies_[a].inverse_mass;
  const double inverse_b = bodies_[b].inverse_mass;
  if (inverse_a + inverse_b == 0) return false;
  Motion motion_a = movers_[a].motion.restarted(contact.time);
  Motion motion_b = movers_[b].motion.restarted(contact.time);
  const Vector3d& n = contact.normal;
  const auto relative = [&](std::size_t order) {
    return n.dot(motion_b.coefficients[order] - motion_a.coefficients[order]);
  };
  const double approach = -relative(1);
  const double restitution = std::min(bodies_[a].restitution, bodies_[b].restitution);
  double pressed = 0;
  if constexpr (Degree >= 2) pressed = -2 * relative(2);
  const std::uint64_t burst = count_meeting(a, b);
  if (burst > patience()) {  // Holding does not help: the pair is left as it is, and so passes through.
    ++counters_.held;
    let_pass(a, b);
    return true;
  }
  const double size = motion_a.coefficients[0].cwiseAbs().maxCoeff() + motion_b.coefficients[0].cwiseAbs().maxCoeff() +
                      bodies_[a].bounding_radius + bodies_[b].bounding_radius;
  const bool held = stays(restitution * approach, pressed, size, burst);
  if (held) {
    ++counters_.held;
    add_hold({.a = a, .b = b, .normal = n});
    disturb(a), disturb(b);
  } else {
    change_relative_velocity(motion_a.coefficients[1], motion_b.coefficients[1], n, (1 + restitution) * approach,
                             inverse_a, inverse_b);
    for (const auto& [id, motion] : {std::pair<BodyId, const Motion&>{a, motion_a}, {b, motion_b}}) {
      if (bodies_[id].inverse_mass == 0) continue;
      ++counters_.motion_updates;
      set_motion(id, motion, false);
      disturb(id);
    }
  }
  settle();
  return held;
}

template <int Degree>
void World<Degree>::test_boxes(PairSlot slot) {
  Pair& pair = pairs_[slot];
  const BoxOverlap<Degree> boxes(bounding_box(pair.a), bounding_box(pair.b));
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
  // Moved in turn, two bodies may have parted and met again at one instant.
  const bool undone = pair.boxes_overlap && !pair.fresh && take_back(Pending::Kind::pair_ended, pair.a, pair.b, t);
  if (!undone) pending_.push_back({kind, pair.a, pair.b, {.time = t}});
  now_ = t;
  test_boxes(slot);
}

/// When the ball around a body is outside a wall and still going outward.
template <int Degree>
double World<Degree>::next_wall_time(BodyId id, int wall, double horizon) const {
  const int axis = wall / 2;
  const double out = wall % 2 != 0 ? 1 : -1;
  const Motion& motion = movers_[id].motion;
  using Wall = certificates::WallSeparation<Degree>;
  const auto inside = [&] {
    return Wall{motion.axis(axis), out > 0 ? options_.walls->max[axis] : options_.walls->min[axis],
                bodies_[id].bounding_radius, out};
  };
  if constexpr (Degree == 1) {
    return motion.coefficients[1][axis] * out > 0 ? failure_time(inside(), now_, horizon) : never;
  } else {
    bool moves = false;
    for (std::size_t i = 1; i <= Degree; ++i) moves = moves || motion.coefficients[i][axis] != 0;
    if (!moves) return never;
    const Wall wall_inside = inside();
    const DerivativeCertificate<Wall> leaving{wall_inside};
    return certificates::first_all_broken<Wall, DerivativeCertificate<Wall>>(now_, horizon, {&wall_inside, 1},
                                                                             {&leaving, 1});
  }
}

template <int Degree>
void World<Degree>::process_wall(BodyId id, double t) {
  const Body& body = bodies_[id];
  int wall = 0;
  while (wall < 6 && next_wall_time(id, wall, t) != t) ++wall;
  const int axis = wall / 2;
  const double out = wall % 2 != 0 ? 1 : -1;
  Motion motion = movers_[id].motion.restarted(t);
  const double approach = motion.coefficients[1][axis] * out;
  double pressed = 0;
  if constexpr (Degree >= 2) pressed = 2 * motion.coefficients[2][axis] * out;
  const double rebound = std::min(body.restitution, options_.walls->restitution) * approach;
  WallEvent event{id, wall, {.time = t}};
  event.contact.normal = Vector3d::Zero();  // not a unit vector times -1, whose zeros would be negative
  event.contact.normal[axis] = out;
  event.contact.point = motion.coefficients[0];
  event.contact.point[axis] = out > 0 ? options_.walls->max[axis] : options_.walls->min[axis];
  ++counters_.wall_contacts;
  const double size = motion.coefficients[0].cwiseAbs().maxCoeff() + body.bounding_radius;
  const bool held = stays(rebound, pressed, size, count_meeting(id));
  if (held) {
    ++counters_.held;
    add_hold({.a = id, .wall = wall, .normal = event.contact.normal});
  } else {
    motion.coefficients[1][axis] = -rebound * out;
    ++counters_.motion_updates;
    set_motion(id, motion, false);
  }
  disturb(id);
  settle();
  listener_->wall(*this, event);
  if (held) listener_->held_at_wall(*this, event);
}

template class World<1>;
template class World<2>;

}  // namespace kds::collision
