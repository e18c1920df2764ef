// Dynamic tests: when the bodies of a pair will touch, and when their boxes will overlap.
#include "certificates/ball_separation.hpp"
#include "certificates/balls_together.hpp"
#include "certificates/conjunction.hpp"
#include "certificates/turning/rigid_motion.hpp"
#include "collision/broad_phase/box_overlap.hpp"
#include "collision/in_parts.hpp"
#include "collision/motions.hpp"
#include "collision/narrow_phase/mesh_margins.hpp"
#include "collision/narrow_phase/turning/loosely_turning.hpp"
#include "collision/profile.hpp"
#include "collision/shapes/bending_mesh.hpp"
#include "collision/world/pairs/pairs.hpp"
#include "collision/world/turning/tumbling.hpp"
#include "kds/roots/failure_time.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

namespace kds::collision {
namespace {

using Eigen::Vector3d;

constexpr double undecided = std::numeric_limits<double>::quiet_NaN();

template <int Degree>
bool at_rest(const certificates::PointMotion<Degree>& motion) {
  for (std::size_t i = 1; i <= Degree; ++i) {
    if (!motion.coefficients[i].isZero(0)) return false;
  }
  return true;
}

template <int Degree>
bool at_rest(const certificates::RigidMotion<Degree>& motion) {
  return at_rest(motion.path) && motion.angular_velocity.isZero(0);
}

/// Whether no point of the body moves.
template <class Motion>
bool at_rest(const MovingShape<Motion>& body) {
  return at_rest(body.motion) && !bends(body.shape.shape);
}

/// A body at rest at this place, displaced.
template <int Degree>
certificates::PointMotion<Degree> standing(const certificates::PointMotion<Degree>& motion, double t,
                                           const Vector3d& way) {
  certificates::PointMotion<Degree> place = motion.restarted(t);
  for (std::size_t i = 1; i <= Degree; ++i) place.coefficients[i] = Vector3d::Zero();
  place.coefficients[0] += way;
  return place;
}
template <int Degree>
certificates::RigidMotion<Degree> standing(const certificates::RigidMotion<Degree>& motion, double t,
                                           const Vector3d& way) {
  auto place = motion.restarted(t);
  place.path = standing(motion.path, t, way);
  place.angular_velocity = Vector3d::Zero();
  return place;
}

/// Bodies that were placed with a gap or an overlap up to this, relative to their coordinates, touch: nothing but
/// rounding is between them. They meet if they approach, and rest if they are pressed together. A larger value takes
/// more overlaps for touches.
constexpr double touch_rounding = 0x1p-40;

/// Whether bodies in contact at t only touch: a rounding farther apart, at rest, they would not be in contact.
template <class Motion>
bool only_touching(const MovingShape<Motion>& a, const MovingShape<Motion>& b, double t) {
  const Contact contact = contact_at(a, b, t);
  const Motion place_a = standing(a.motion, t, Vector3d::Zero());
  const auto largest = [t](const Motion& motion) { return path_of(motion).position(t).cwiseAbs().maxCoeff(); };
  const double size =
      largest(a.motion) + largest(b.motion) + std::min(a.shape.bounding_radius, b.shape.bounding_radius);
  double apart = touch_rounding * size;
  // Where there is a mesh, what is nearer than its margin is in contact.
  if constexpr (!turns<Motion>) {
    const bool exact = !has_mesh(a.shape.shape) && !has_mesh(b.shape.shape);
    if (!exact && !unbounded(a.shape.shape) && !unbounded(b.shape.shape)) {
      const auto share = [](const MovingShape<Motion>& body, const Motion& place) {
        return MeshClearance<Motion::degree>(place, body.shape.bounding_radius).share()[0];
      };
      apart = std::max(apart, 2 * (share(a, place_a) + share(b, standing(b.motion, t, Vector3d::Zero()))));
    }
  }
  // A mesh that bends is in contact within its tolerance already; and a little more is not much of an overlap.
  for (const PlacedShape* const shape : {&a.shape, &b.shape}) {
    if (bends(shape->shape)) apart = std::max(apart, 1.25 * bending_tolerance * shape->bounding_radius);
  }
  Vector3d way = apart * contact.normal;
  // Compounds may touch in several places, as in a corner: they are moved away from one after the other.
  for (int places = a.shape.parts || b.shape.parts ? 3 : 1;; --places) {
    const Motion place_b = standing(b.motion, t, way);
    const MovingShape<Motion> at_a{a.shape, place_a}, at_b{b.shape, place_b};
    if (!in_contact(at_a, at_b, t)) return true;
    if (places == 1) return false;
    way += apart * contact_at(at_a, at_b, t).normal;
  }
}

}  // namespace

/// Up to which time a pair is tested: at most to the end of a piece of the motion of a body that precesses, when it is
/// tested anew.
template <class Motion>
double Pairs<Motion>::horizon(const Pair& pair) const {
  if constexpr (turns<Motion>) {
    return std::min({clock_.horizon, bodies_[pair.a].turns_until, bodies_[pair.b].turns_until});
  }
  return clock_.horizon;
}

/// By far most tests are of two balls, and need two cache lines. This changes nothing but estimates_: for some of the
/// dirty pairs, a time from BallsTogether before which the balls do not meet.
template <class Motion>
void Pairs<Motion>::estimate_balls(std::size_t first, std::size_t last) {
  certificates::BallsTogether<Motion::degree> together;
  const auto put = [&](std::size_t place, std::size_t i) {
    const Pair& pair = pairs_[dirty_[i]];
    together.put(place, bodies_.mover(pair.a), bodies_.mover(pair.b));
  };
  const auto are_balls = [&](Slot slot) {
    return bodies_.mover(pairs_[slot].a).radius > 0 && bodies_.mover(pairs_[slot].b).radius > 0;
  };
  const auto care_for = [&](std::size_t i) {
    if (!std::isnan(estimates_[i]) || !are_balls(dirty_[i])) return;
    const auto& a = bodies_.mover(pairs_[dirty_[i]].a);
    const auto& b = bodies_.mover(pairs_[dirty_[i]].b);
    const double t =
        certificates::BallSeparation<Motion::degree>{a.motion, b.motion, a.radius, b.radius}.apart_until(clock_.now);
    if (t > clock_.now) estimates_[i] = t <= clock_.horizon ? t : never;
  };
  std::size_t i = first;
  for (; i + together.size <= last; i += together.size) {
    for (std::size_t k = 0; k < together.size; ++k) put(k, i + k);
    together.earliest_approaches(clock_.now, clock_.horizon, &estimates_[i]);
    for (std::size_t k = 0; k < together.size; ++k) care_for(i + k);
  }
  const std::span<const Slot> few(dirty_.data() + i, last - i);
  if (std::none_of(few.begin(), few.end(), are_balls)) {
    std::fill_n(estimates_.begin() + static_cast<std::ptrdiff_t>(i), last - i, undecided);
    return;
  }
  for (std::size_t k = 0; k < together.size; ++k) put(k, std::min(i + k, last - 1));
  std::array<double, together.size> rest;
  together.earliest_approaches(clock_.now, clock_.horizon, rest.data());
  for (std::size_t k = 0; i + k < last; ++k) {
    estimates_[i + k] = rest[k];
    care_for(i + k);
  }
}

template <class Motion>
void Pairs<Motion>::estimate_dirty(std::size_t from) {
  // When many bodies have entered, all pairs were to be tested; later it is some for each contact.
  constexpr std::size_t many = 1 << 16, far_too_many = 64;
  if (estimates_.capacity() > std::max(many, far_too_many * dirty_.size())) {
    estimates_ = LargeVector<double>();
    dirty_.shrink_to_fit();
  }
  estimates_.resize(dirty_.size());
  const std::size_t count = dirty_.size() - from;
  in_parts(count, threads_for(count, options_.threads),
           [&](std::size_t, std::size_t first, std::size_t last) { estimate_balls(from + first, from + last); });
}

/// Of the dirty pairs, tests those that rest on each other, from the first on, and leaves the others. Most pairs of a
/// heap need no test, since the resting contact keeps them apart.
template <class Motion>
void Pairs<Motion>::test_resting(std::size_t first) {
  std::size_t others = first;
  for (std::size_t i = first; i < dirty_.size(); ++i) {
    const Slot slot = dirty_[i];
    Pair& pair = pairs_[slot];
    const auto contact = pair.alive ? resting_.find(pair.a, pair.b) : Resting::none;
    if (contact == Resting::none) {
      dirty_[others++] = slot;
      continue;
    }
    ++counters_.pair_tests;
    pair.dirty = false;
    if (pair.fresh || pair.overlapping || !resting_.keeps_apart(contact)) {
      test(slot);
    } else {
      pair.estimated = false;
      if (contacts_.contains(slot)) contacts_.set(slot, never);
    }
    finish_test(slot);
  }
  dirty_.resize(others);
}

/// What is left to do when it is known when a pair meets.
template <class Motion>
void Pairs<Motion>::finish_test(Slot slot) {
  Pair& pair = pairs_[slot];
  pair.fresh = false;
  if (pair.listed) {
    if (follows_boxes_ && !unbounded(pair)) test_boxes(slot);
  } else if (!pair.overlapping) {
    release(slot);
  }
}

template <class Motion>
void Pairs<Motion>::test(std::size_t most) {
  const Stopwatch watch(profile_, Work::test);
  const std::size_t first = dirty_.size() - std::min(most, dirty_.size());
  if (!resting_.empty()) test_resting(first);
  estimate_dirty(first);
  const bool passes = options_.response == Response::none || bodies_.any_sensor();
  for (std::size_t i = first, dirty = dirty_.size(); i < dirty; ++i) {
    const Slot slot = dirty_[i];
    Pair& pair = pairs_[slot];
    pair.dirty = false;
    if (!pair.alive) continue;
    ++counters_.pair_tests;
    const double estimate = estimates_[i];
    // Balls that penetrate without counting as overlapping have bounced, and part, unless they have just come, or pass
    // through each other.
    const bool new_overlap = pair.fresh || (passes && mode(pair.a, pair.b) == ContactMode::transparent);
    const bool may_be_together = std::isnan(estimate) || (estimate == -never && new_overlap);
    if (may_be_together || pair.overlapping) [[unlikely]] {
      test(slot);
    } else {
      pair.estimated = std::abs(estimate) != never;
      if (pair.estimated || contacts_.contains(slot)) contacts_.set(slot, pair.estimated ? estimate : never);
    }
    finish_test(slot);
  }
  dirty_.resize(first);
}

template <class Motion>
void Pairs<Motion>::test(Slot slot) {
  Pair& pair = pairs_[slot];
  if constexpr (turns<Motion>) {
    const double end = horizon(pair);  // -never if one of them is left alone
    const bool apart = end < clock_.now || apart_in_all_pieces(slot) > end;
    if (apart && !pair.fresh && !pair.overlapping) return set_contact(slot, never);
  }
  const auto a = bodies_.moving(pair.a);
  const auto b = bodies_.moving(pair.b);
  FoundTouch found;
  const auto report_overlap = [&] {
    reports_.add(Reports::Kind::overlap, bodies_.id_of(pair.a), bodies_.id_of(pair.b), contact_at(a, b, clock_.now));
  };
  ContactEstimate next{never, true};
  const ContactMode mode = this->mode(pair.a, pair.b);
  if (mode == ContactMode::transparent) {
    if (pair.fresh && !pair.overlapping && in_contact(a, b, clock_.now)) {
      pair.overlapping = true;
      report_overlap();
    }
    if (at_rest(a) && at_rest(b)) {  // Nothing will happen, but a jump may have happened.
      next.time = in_contact(a, b, clock_.now) == pair.overlapping ? never : clock_.now;
    } else if (pair.overlapping) {
      next = certified_first_separation(a, b, clock_.now, horizon(pair));
    } else {
      next = estimated_first_contact(a, b, clock_.now, horizon(pair), mode, pair.memory, &found);
    }
  } else {
    if (pair.fresh) {
      pair.passes_at = -never;
      pair.overlapping = in_contact(a, b, clock_.now) && !only_touching(a, b, clock_.now);
      if (pair.overlapping) report_overlap();
    }
    if (pair.overlapping) {
      const double start = pair.passes_at == clock_.now ? next_up(clock_.now) : clock_.now;
      if (start <= horizon(pair)) next = certified_first_separation(a, b, start, horizon(pair));
    } else if (resting_.find(pair.a, pair.b) != Resting::none) {
      next = resting_.next_contact(pair.a, pair.b, clock_.now);
    } else if (!(at_rest(a) && at_rest(b))) {
      next = estimated_first_contact(a, b, clock_.now, horizon(pair), mode, pair.memory, &found);
    }
  }
  contacts_.set(slot, next.time);
  pair.estimated = !next.exact;
  remember(slot, found);
}

/// So many results of tests are made room for at a time: 0.1 ms.
constexpr std::size_t written_at_once = 2048;

/// Keeps what a test has found of a contact to come, so that it need not be found again when the contact is due.
template <class Motion>
void Pairs<Motion>::remember(Slot slot, const FoundTouch& found) {
  if (slot >= found_.size()) {
    if (found.time == never) return;
    found_.reserve(pairs_.capacity());  // so that it grows without a copy, and is written to a little at a time
    found_.resize(std::min(pairs_.capacity(), std::max<std::size_t>(slot + 1, found_.size() + written_at_once)));
  }
  found_[slot] = found;
}

template <class Motion>
void Pairs<Motion>::set_contact(Slot slot, double time) {
  pairs_[slot].estimated = false;
  contacts_.set(slot, time);
}

/// Most bounds are never certified, since the motions change before they are due.
template <class Motion>
bool Pairs<Motion>::certify() {
  const Slot slot = contacts_.top().slot;
  const Pair& pair = pairs_[slot];
  if (!pair.estimated) return false;
  const auto& a = bodies_.mover(pair.a);
  const auto& b = bodies_.mover(pair.b);
  if (a.radius > 0 && b.radius > 0) {
    const certificates::BallSeparation<Motion::degree> apart{a.motion, b.motion, a.radius, b.radius};
    const bool passes = mode(pair.a, pair.b) == ContactMode::transparent;
    set_contact(slot, passes ? failure_time(apart, clock_.now, clock_.horizon)
                             : apart.first_approach(clock_.now, clock_.horizon));
    return true;
  }
  FoundTouch found;
  const auto a_moves = bodies_.moving(pair.a), b_moves = bodies_.moving(pair.b);
  // Some tests look only a few turns or sizes ahead: each goes on where the last one has ended.
  const bool rests = !pair.overlapping && resting_.find(pair.a, pair.b) != Resting::none;
  const double from = turns<Motion> || rests ? contacts_.time(slot) : clock_.now;
  const ContactEstimate next =
      rests ? resting_.next_contact(pair.a, pair.b, from)
      : pair.overlapping
          ? certified_first_separation<Motion>(a_moves, b_moves, from, horizon(pair))
          : certified_first_contact<Motion>(a_moves, b_moves, from, horizon(pair), mode(pair.a, pair.b), &found);
  set_contact(slot, next.time);
  pairs_[slot].estimated = !next.exact;
  remember(slot, found);
  return true;
}

/// What is known of the present pieces does not count for a body that is left alone.
template <class Motion>
double Pairs<Motion>::alone_until(BodySlot id, double larger,
                                  const Tumbling<Motion>& tumbling) requires(turns<Motion>) {
  const double now = clock_.now;
  double until = never;
  bool estimated = false;
  std::optional<LooselyTurning<Motion::degree>> own;
  for (const Link& link : links(id)) {
    const Pair& pair = pairs_[link.slot];
    const bool in_queue = contacts_.contains(link.slot);
    if (pair.dirty || pair.overlapping || unbounded(pair) || (in_queue && !pair.estimated)) return now;
    estimated = estimated || in_queue;
    double apart = balls_apart_until(link.slot, larger);
    if (!(apart > now)) apart = apart_in_all_pieces(link.slot);
    const auto &shape = bodies_[id].shape, &other = bodies_[link.other].shape;
    if constexpr (turns<Motion>) {  // clang 14 compiles it for others, too
      if (!(apart > now) && shape && other && !tumbling.is_alone(link.other)) {
        if (!own) own = tumbling.loosely_turning(id, now);
        apart = apart_until(*shape, *own, *other, tumbling.loosely_turning(link.other, now));
        if (apart_.size() <= link.slot) apart_.resize(pairs_.size(), -never);
        apart_[link.slot] = apart;
      }
    }
    until = std::min(until, apart);
  }
  if (until > now && estimated) {
    for (const Link& link : links(id)) set_contact(link.slot, never);
  }
  return until;
}

template <class Motion>
void Pairs<Motion>::test_boxes(Slot slot) {
  Pair& pair = pairs_[slot];
  const BoxOverlap<Motion::degree> boxes(volumes_.box(pair.a), volumes_.box(pair.b));
  const auto apart = boxes.separations();
  const std::span<const typename BoxOverlap<Motion::degree>::Apart> sides(apart);
  // A change of motion may leave boxes that touch for good: they do not overlap, although no side has a gap.
  const double next = !pair.boxes_overlap ? certificates::first_all_broken(clock_.now, clock_.horizon, sides)
                      : certificates::all_broken(clock_.now, sides)
                          ? certificates::first_any_holds(clock_.now, clock_.horizon, sides)
                          : clock_.now;
  boxes_.set(slot, next);
  if (next == clock_.now) process_boxes(slot, clock_.now);
}

template <class Motion>
void Pairs<Motion>::process_boxes(Slot slot, double t) {
  Pair& pair = pairs_[slot];
  pair.boxes_overlap = !pair.boxes_overlap;
  clock_.now = t;
  report_boxes(pair.boxes_overlap, pair.a, pair.b);
  test_boxes(slot);
}

#define KDS_INSTANTIATE(motion) KDS_TEMPLATE_PART class Pairs<motion>;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
