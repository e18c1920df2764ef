// What there is to tell of a step of a window.
#pragma once

#include "collision/parallel/parallel_world.hpp"
#include "collision/parallel/relayed_events.hpp"
#include "collision/parallel/step_events.hpp"
#include "collision/parallel/world_events.hpp"
#include "collision/world/timers.hpp"

#include <cstddef>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

namespace kds::collision {

/// The events and timers of a step that holds and is not committed yet. What a listener that throws has been told
/// counts as told; the rest stays.
class UntoldEvents {
 public:
  using RungTimers = std::vector<Timers::Image::One>;

  /// `step`: if each process takes the events of its own domains.
  void begin(double end, EventMerge events, const RungTimers& timers, std::optional<StepEvents> step) {
    end_ = end, events_ = std::move(events), step_ = std::move(step);
    timers_.assign(timers.begin(), timers.end());
    told_ = 0;
  }
  /// Whether there is such a step.
  bool any() const { return end_.has_value(); }
  /// Its end; afterwards there is none.
  double finish() {
    events_ = {}, timers_.clear();
    return *std::exchange(end_, std::nullopt);
  }
  /// How many have been told, and the time of the last one.
  std::size_t told() const { return told_; }
  double told_until() const { return told_until_; }

  /// Tells all, or those up to one after which stops() is true. The listener may be null if there are no events.
  template <class Stops>
  void tell(ParallelListener* listener, StepListener* steps, const Stops& stops) {
    if (step_) steps->on_step(*std::exchange(step_, std::nullopt));
    while (!stops()) {
      const DomainEvent* const event = events_.empty() ? nullptr : &events_.next();
      if (!timers_.empty() && (!event || rings_before(*event))) {
        const auto [time, timer] = timers_.front();
        timers_.pop_front();
        note_told(time);
        if (listener) listener->timer(timer, time);
      } else if (event) {
        note_told(event->contact.time);
        relay(events_.take_next(), *listener);
      } else {
        return;
      }
    }
  }

 private:
  /// Whether the next timer is told before an event: at one time what follows from pieces of motion is told first.
  bool rings_before(const DomainEvent& event) const {
    const double time = timers_.front().time;
    return time < event.contact.time ||
           (time == event.contact.time && event.origin().phase != DomainEvent::Cause::Phase::pieces);
  }
  void note_told(double time) { ++told_, told_until_ = time; }

  std::optional<double> end_;
  EventMerge events_;
  std::deque<Timers::Image::One> timers_;
  std::optional<StepEvents> step_;
  std::size_t told_ = 0;
  double told_until_ = 0;
};

}  // namespace kds::collision
