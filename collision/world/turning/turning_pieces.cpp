// How bodies that precess go on from piece to piece.
#include "collision/motions.hpp"
#include "collision/world/earliest_wall_time.hpp"
#include "collision/world/motion_updates.hpp"
#include "collision/world/turning/turning_extents.hpp"

#include <algorithm>
#include <cstdint>

namespace kds::collision {

template <class Motion>
void MotionUpdates<Motion>::turn_on() requires(turns<Motion>) {
  const BodySlot slot = tumbling_.next_body();
  // What is alone no longer may be left alone again, but not for less than its present piece lasts.
  if (tumbling_.is_alone(slot)) bodies_.move(slot, tumbling_.catch_up(slot, clock_.now));
  const double until = left_alone_until(slot);
  if (until > std::max(clock_.now, bodies_[slot].turns_until)) return tumbling_.leave_alone(slot, until);
  turn(slot, bodies_[slot].turns_until > clock_.now ? bodies_.motion(slot) : tumbling_.take_next().motion);
  reports_.add(Reports::Kind::moved, bodies_.id_of(slot), bodies_.id_of(slot), {.time = clock_.now});
}

/// A time up to which nothing needs to know how the body is turned; now if there is none. What it may meet until then
/// are bodies whose paths change, or that come near: their pairs are tested, and before that it is looked at.
template <class Motion>
double MotionUpdates<Motion>::left_alone_until(BodySlot slot) requires(turns<Motion>) {
  const double now = clock_.now;
  const bool seen = !(tumbling_.unheard_until() > now) || options_.report_pairs || volumes_.any_from_callers() ||
                    !bodies_.attachments().empty() || !resting_.empty();
  if (seen || tumbling_.is_alone(slot) || !bodies_[slot].entered) return now;
  // Also beyond the end of the call, since nothing may ask for it then, or for its motion alone.
  const double longest = std::max(tumbling_.unheard_until(), clock_.horizon);
  double until = std::min(longest, pairs_.alone_until(slot, path_rounding, tumbling_));
  if (options_.walls && until > now) {
    const double radius = (1 + path_rounding) * bodies_[slot].bounding_radius;
    until = std::min(until, earliest_wall_time_of_all(bodies_.path(slot), radius, *options_.walls, now));
  }
  return until > now && tumbling_.can_leave_alone(slot, until) ? until : now;
}

/// A body that was left alone has the piece that it would have otherwise.
template <class Motion>
void MotionUpdates<Motion>::look_at(BodySlot slot) requires(turns<Motion>) {
  turn(slot, tumbling_.catch_up(slot, clock_.now));
}

template <class Motion>
void MotionUpdates<Motion>::look_at_tested() requires(turns<Motion>) {
  if (!tumbling_.any_alone()) return;
  pairs_.every_untested([&](BodySlot a, BodySlot b, std::uint32_t pair) {
    if (!tumbling_.is_alone(a) && !tumbling_.is_alone(b)) return;
    const double apart = pairs_.balls_apart_until(pair, path_rounding);
    for (const BodySlot slot : {a, b}) {
      if (!tumbling_.is_alone(slot)) continue;
      if (!(apart > clock_.now) || !tumbling_.goes_on_alone(slot, apart)) look_at(slot);
    }
  });
}

/// All that happens at this instant has happened, or is about to: so a piece that begins now has begun.
template <class Motion>
void MotionUpdates<Motion>::look_at_all() requires(turns<Motion>) {
  for (BodySlot slot = 0; slot < bodies_.slots(); ++slot) {
    if (tumbling_.is_alone(slot)) turn(slot, tumbling_.catch_up(slot, next_up(clock_.now)));
  }
}

template <class Motion>
void MotionUpdates<Motion>::read(BodySlot slot) requires(turns<Motion>) {
  if (tumbling_.is_alone(slot)) bodies_.move(slot, tumbling_.catch_up_alone(slot, next_up(clock_.now)));
}

template <class Motion>
void MotionUpdates<Motion>::read_all() requires(turns<Motion>) {
  if (!tumbling_.any_alone()) return;
  for (BodySlot slot = 0; slot < bodies_.slots(); ++slot) read(slot);
}

/// The body goes on along its path and turns otherwise. Pairs with a body that is alone wait until that is looked at.
template <class Motion>
void MotionUpdates<Motion>::turn(BodySlot slot, const Motion& motion) requires(turns<Motion>) {
  const Stopwatch watch(profile_, Work::update);
  bodies_.move(slot, motion);
  if (bodies_.in_broad_phase(slot)) broad_phase_->update(slot, volumes_.renew(slot), clock_.now, pairs_);
  pairs_.turned(slot, [this](BodySlot other) { return tumbling_.is_alone(other); });
  walls_.schedule(slot);
  volumes_.schedule(slot);
  if (!bodies_.attachments().empty()) move_attached(slot, false);
}

#define KDS_INSTANTIATE(motion) KDS_TEMPLATE_PART class MotionUpdates<motion>;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
