// The clock: runs kinetic structures in the order of time.
#pragma once

#include "kds/arithmetic/strict.hpp"
#include "kds/number_text.hpp"
#include "kds/roots/failure_time.hpp"
#include "kds/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

namespace kds {

/// A structure that keeps certificates true.
///
/// Semantic laws: (1) next_time() is the least failure time among its certificates, if that is not beyond its horizon;
/// otherwise it is `never` or some time beyond the horizon; (2) process() repairs what failed at next_time() and
/// certifies the new neighbours, with failure times not before it; (3) between events the state is exactly that of its
/// motions at t+; (4) audit(t) checks law 3 against the motions with exact signs and throws AuditFailure; (5) the
/// horizon is `never` at first, and extend_horizon(now, horizon) makes law 1 hold for another one, which may be nearer
/// too; the one that it has costs nothing.
///
/// A structure that keeps no failure times to save work has the horizon `never` all the time, and its extend_horizon()
/// does nothing. One that puts work off, such as the consequences of edits, is due for it: its process() returns a
/// bool, false if it has done such work and no event has come of it. Then next_time() is later, or the next call gives
/// true. One that has a clock of its own tells it, now(), which never is after that of the simulator: it goes forward
/// by process(), or is moved up to the simulator's by the caller.
template <class S>
concept KineticStructure = requires(S& structure, const S& observed, double t) {
  { observed.next_time() } -> std::convertible_to<double>;
  structure.process();
  structure.extend_horizon(t, t);
  observed.audit(t);
  { observed.counters() } -> std::convertible_to<Counters>;
};

/// Runs structures side by side: events in (time, structure, slot) order, structures in the order of the arguments.
///
/// The horizon is the simulator's: it is the same for all structures, which are told of it when the simulator is made
/// and whenever it changes. What a structure knows of later times makes no difference.
///
/// A structure that has an event before the clock (it was changed at an earlier time), or whose own clock is ahead (it
/// was advanced by itself), would turn the order of events round: step(), advance_to() and next_time() throw
/// std::logic_error, before anything is done. In the first case it can be brought up to the clock and the run goes on.
/// Work that it has put off at the time of its own clock is no event: a step does it. A next time that is not a number
/// is refused in the same way.
///
/// The structures are referred to, not owned. No virtual call, no allocation: a step costs a comparison a structure
/// on top of the structure's own work. All times are in seconds.
///
/// Threads: a simulator, its structures and their sets are for one thread at a time, const functions included (a queue
/// may rearrange itself when it is asked for its least). Different ones may run in different threads.
template <KineticStructure... Structures>
class Simulator {
 public:
  static_assert(sizeof...(Structures) > 0);

  /// The clock starts at `now`: finite, and not before the structures were made and last changed (neither is checked).
  /// Throws std::runtime_error where arithmetic is not that of arithmetic/strict.hpp.
  explicit Simulator(double now, Structures&... structures) : structures_(structures...), now_(now) {
    require_strict_arithmetic("Simulator");
    set_horizon(never);
  }

  double now() const { return now_; }
  double horizon() const { return horizon_; }

  /// Time of the next event within the horizon, `never` if there is none. The clock, if a structure has put off work: a
  /// step does that first.
  double next_time() const { return next().time; }

  /// Keeps only events up to `window` seconds ahead. Whenever the clock goes beyond, the structures certify again for
  /// another window. Infinite (the default) predicts everything; a step() without a limit does so too, and from then
  /// on. Throws std::invalid_argument for a window that is not > 0. Cost: a failure time for each certificate that the
  /// change concerns.
  void set_window(double window) {
    if (!(window > 0)) throw std::invalid_argument("Simulator::set_window: the window must be > 0");
    window_ = window;
    set_horizon(now_ + window);
  }

  /// Processes the next event if it is not later than `limit`; the clock moves to it. If there is none: false, and the
  /// clock stays where it is. Work that structures have put off until then is done on the way.
  bool step(double limit = never) {
    require_clocks(std::index_sequence_for<Structures...>{});
    for (;;) {
      if (limit > horizon_) look_ahead(limit);
      const Next found = next();
      if (!(found.time <= limit) || found.time == never) return false;
      now_ = found.time;
      if (!process(found.index, std::index_sequence_for<Structures...>{})) continue;
      if (found.behind) refuse(found.index, "had an event before it: it was changed at that time");
      return true;
    }
  }

  /// Processes all events up to and including t and sets the clock to t. Throws std::invalid_argument for a t before
  /// the clock, or one that is not finite (to run while there are events, call step() until it is false). If a listener
  /// throws, the clock stands at its event, and the run may go on.
  void advance_to(double t) {
    if (!std::isfinite(t)) throw std::invalid_argument("Simulator::advance_to: the time must be finite");
    if (t < now_) {
      throw std::invalid_argument("Simulator::advance_to: the clock stands at " + number_text(now_) +
                                  " and cannot go back to " + number_text(t));
    }
    while (step(t)) {
    }
    now_ = t;
  }

  /// Moves the clock to t without looking for events. Precondition: now() <= t and none is due before t.
  void set_clock(double t) { now_ = t; }

  /// Turns the clock and the structures round, whose elements must have been turned before: see reverse() in
  /// framework/reverse.hpp.
  void turn_round() {
    now_ = 0.0 - now_;  // never -0
    horizon_ = now_ + window_;
    std::apply([&](auto&... s) { (s.turn_round(now_, horizon_), ...); }, structures_);
  }

  /// Checks every structure at the clock; throws AuditFailure.
  void audit() const {
    std::apply([&](const auto&... s) { (s.audit(now_), ...); }, structures_);
  }

  Counters counters() const {
    return std::apply([](const auto&... s) { return (Counters{} + ... + s.counters()); }, structures_);
  }

  /// Saves or loads the clock and the structures, which must have archive(). See save() in snapshot.hpp.
  template <class Archive>
  void archive(Archive& archive) {
    archive.tag("Simulator");
    archive(now_, horizon_, window_);
    if constexpr (Archive::loading) {
      archive.require(std::isfinite(now_), "the clock is not finite");
      archive.require(window_ > 0 && !std::isnan(horizon_), "a window is not > 0, or a horizon not a number");
    }
    std::apply([&](auto&... s) { (s.archive(archive), ...); }, structures_);
  }

 private:
  struct Next {
    double time;
    std::size_t index;    ///< of the structure
    bool behind = false;  ///< it has put off work of a time before the clock
  };
  Next next() const {
    Next first{never, 0};
    std::size_t index = 0;
    const auto consider = [&](const auto& structure) {
      const double time = structure.next_time();
      if (!(time >= first.time)) {
        if (std::isnan(time)) [[unlikely]]
          refuse(index, "says that its next event is at a time that is not a number");
        first = {time, index, behind(structure, time)};
      }
      ++index;
    };
    std::apply([&](const auto&... s) { (consider(s), ...); }, structures_);
    if (first.behind) first.time = now_;
    if (first.time < now_) [[unlikely]]
      refuse(first.index, "is due at " + number_text(first.time) + ": it was changed at a time before the clock");
    // A structure may know of events beyond the horizon, where others do not know of theirs.
    return first.time <= horizon_ ? first : Next{never, 0};
  }
  template <class Structure>
  bool behind(const Structure& structure, double time) const {
    if constexpr (requires {
                    requires std::same_as<decltype(std::declval<Structure&>().process()), bool>;
                    { structure.now() } -> std::same_as<double>;
                  }) {
      return time < now_ && time == structure.now();
    } else {
      return false;
    }
  }

  template <std::size_t... I>
  void require_clocks(std::index_sequence<I...>) const {
    (require_clock(std::get<I>(structures_), I), ...);
  }
  template <class Structure>
  void require_clock(const Structure& structure, std::size_t index) const {
    if constexpr (requires {
                    { structure.now() } -> std::same_as<double>;
                  }) {
      if (const double now = structure.now(); now > now_) [[unlikely]]
        refuse(index, "was advanced by itself to " + number_text(now));
    }
  }
  [[noreturn]] void refuse(std::size_t index, const std::string& what) const {
    throw std::logic_error("Simulator: the clock stands at " + number_text(now_) + ", and structure " +
                           std::to_string(index) + " (in the order of the arguments, from 0) " + what);
  }

  /// Whether there was an event.
  template <std::size_t... I>
  bool process(std::size_t index, std::index_sequence<I...>) {
    return ((I == index && process(std::get<I>(structures_))) || ...);
  }
  template <class Structure>
  static bool process(Structure& structure) {
    if constexpr (requires {
                    { structure.process() } -> std::same_as<bool>;
                  }) {
      return structure.process();
    } else {
      structure.process();
      return true;
    }
  }

  /// Certifies window by window until an event is known or the horizon covers the limit.
  void look_ahead(double limit) {
    if (limit == never) return set_horizon(never);
    // The windows grow while nothing happens, so that an idle stretch costs a logarithmic number of them.
    for (double ahead = window_; horizon_ < limit && next_time() == never; ahead *= 2) {
      set_horizon(std::min(limit, std::max(horizon_ + ahead, next_up(horizon_))));
    }
  }

  void set_horizon(double horizon) {
    horizon_ = horizon;
    std::apply([&](auto&... s) { (s.extend_horizon(now_, horizon), ...); }, structures_);
  }

  std::tuple<Structures&...> structures_;
  double now_;
  double horizon_ = never;
  double window_ = never;
};

}  // namespace kds
