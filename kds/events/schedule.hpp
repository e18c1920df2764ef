// The certificates of a structure and the times at which they fail.
#pragma once

#include "kds/arithmetic/lattice.hpp"
#include "kds/events/default_event_queue.hpp"
#include "kds/events/event_queue.hpp"
#include "kds/events/place_queue.hpp"
#include "kds/roots/solver.hpp"
#include "kds/statistics.hpp"

#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <vector>

namespace kds {

/// Keeps the failure time of the certificate in each slot, and knows which fails first.
///
/// A structure calls certify() whenever a slot holds a new certificate, and, in its process(), failed() before it
/// repairs anything. With the certified solver nothing else is needed: events are at the times that failure_time()
/// gives, and no event proves early.
///
/// With any other solver the schedule corrects what exact signs can correct:
///  1. a certificate that does not hold when it is made fails at once, whatever the solver says, and one that holds
///     fails after now;
///  2. an event whose certificate still holds (it proves early) is not processed, but rescheduled to the certified
///     failure time: an event proves early once at most;
///  3. an event that comes late [Abam11] leaves its structure to be repaired late, by exact signs: certificates that
///     appear then, and have failed before, fail at once. They are counted.
/// A failure the solver misses altogether is not found. Counters: `rescheduled` (2), `repaired` (3); both stay zero
/// with the certified solver.
/// For neighbours in a row there is PlaceSchedule.
template <class Queue = DefaultEventQueue, FailureTimeSolver Solver = CertifiedSolver>
requires EventQueue<Queue> || std::same_as<Queue, PlaceQueue>
class Schedule {
 public:
  void resize(std::size_t slots) { queue_.resize(slots); }
  void clear(Slot slot) { queue_.clear(slot); }

  bool empty() const { return queue_.empty(); }
  bool contains(Slot slot) const { return queue_.contains(slot); }
  double time(Slot slot) const { return queue_.time(slot); }

  /// Time of the next failure within the horizon, `never` if there is none, and its slot.
  double next_time() const {
    if constexpr (std::same_as<Queue, PlaceQueue>) return queue_.next_time();
    return queue_.empty() ? never : queue_.top().time;
  }
  QueuedEvent next() const { return queue_.top(); }

  double horizon() const { return horizon_; }

  /// Failures beyond the horizon get no event. The structure certifies again those slots that the change concerns: see
  /// concerned().
  void set_horizon(double horizon) {
    extended_ = horizon > horizon_;
    horizon_ = horizon;
  }

  /// Whether the last change of the horizon concerns a slot: scheduled events stay right when the horizon grows, and
  /// those beyond a horizon that has shrunk are dropped.
  bool concerned(Slot slot) const {
    return extended_ ? !queue_.contains(slot) : queue_.contains(slot) && queue_.time(slot) > horizon_;
  }

  /// Schedules the failure of a slot's new certificate.
  template <Certificate C>
  void certify(Slot slot, const C& certificate, double now) {
    ++counters_.certificates;
    set(slot, solve(certificate, now));
  }

  /// Counts a certificate that appears in an event at `now` and has failed before, as it may after a late event.
  template <Certificate C>
  void look_for_late_events(const C& certificate, double now) {
    if constexpr (!Solver::certified) {
      counters_.repaired += sign_after(certificate, now) < 0 && sign_after(certificate, next_down(now)) < 0;
    }
  }

  /// The same for a certificate that is known to be positive just after now, since its negative has failed. See
  /// failure_time_after_turn().
  template <Certificate C>
  void certify_turned(Slot slot, const C& certificate, double now) {
    static_assert(AnswersAfterTurn<Solver, C> || !detail::NamesAfterTurn<Solver>,
                  "solver: `after_turn` must be `double after_turn(const C& certificate, double now, double horizon) "
                  "const` for each certificate C");
    if constexpr (AnswersAfterTurn<Solver, C>) {
      ++counters_.certificates;
      set(slot, solver_.after_turn(certificate, now, horizon_));
    } else {
      certify(slot, certificate, now);
    }
  }

  /// Schedules a slot by hand; `never` clears it.
  void set(Slot slot, double time) {
    if (time == never) {
      queue_.clear(slot);
    } else {
      queue_.set(slot, time);
    }
  }

  /// To be called by process(): whether the certificate of the slot on top has really failed at its time. If not, the
  /// event has been rescheduled, and there is nothing to repair. (A certificate that is zero throughout never fails:
  /// the event of such a slot was set by hand, and is valid.)
  template <Certificate C>
  bool failed(Slot slot, const C& certificate, double time) {
    if constexpr (!Solver::certified) {
      if (sign_after(certificate, time) > 0) {
        ++counters_.rescheduled;
        set(slot, failure_time(certificate, time, horizon_));
        return false;
      }
    }
    ++counters_.events;
    return true;
  }

  /// The counts of failed() and certify().
  const Counters& counters() const { return counters_; }
  const Queue& queue() const { return queue_; }

  /// Saves or loads the times of the slots, the horizon and the counters; see save() in snapshot.hpp. Queues are
  /// functions of their times, so that one may be loaded into another. Call settle() of a queue of places afterwards.
  template <class Archive>
  void archive(Archive& archive) {
    std::vector<double> times;
    if constexpr (!Archive::loading) {
      for (Slot slot = 0; slot < queue_.slots(); ++slot) times.push_back(queue_.time(slot));
    }
    archive(times, horizon_, counters_);
    if constexpr (Archive::loading) {
      archive.require(!std::isnan(horizon_), "a horizon is not a number");
      for (const double time : times) archive.require(time > -never, "a failure time is not a number, or -infinity");
      queue_.resize(0);
      queue_.resize(times.size());
      for (Slot slot = 0; slot < times.size(); ++slot) set(slot, times[slot]);
    }
  }

 private:
  template <Certificate C>
  double solve(const C& certificate, double now) const {
    if constexpr (Solver::certified) {
      return solver_(certificate, now, horizon_);
    } else {
      const int s = sign_after(certificate, now);
      if (s <= 0) return s < 0 && now <= horizon_ ? now : never;
      const double t = solver_(certificate, now, horizon_);
      if (!(t > now)) return next_up(now) <= horizon_ ? next_up(now) : never;  // also a NaN: failed() is exact
      return t <= horizon_ ? t : never;
    }
  }

  Solver solver_;
  double horizon_ = never;
  bool extended_ = false;

 protected:
  Queue queue_;
  Counters counters_;
};

}  // namespace kds
