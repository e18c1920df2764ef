// Steps back and roll-backs to any earlier time, edits and all: snapshots now and then, and the calls made since.
#pragma once

#include "kds/framework/snapshot.hpp"
#include "kds/number_text.hpp"
#include "kds/raised_flag.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace kds {

/// Runs a simulator and can bring back each of its earlier states, bit for bit: it saves a snapshot every so many
/// events and records the calls in between, which are repeated from the last snapshot on. [Jefferson85] calls this
/// roll-back with periodic state saving.
///
/// All steps and edits must be made through it, or it does not know of them. Edits and listeners are called again when
/// they are replayed, and must then do the same (replaying() is true then). Events and calls that are rolled back are
/// forgotten: the run goes on from there. Simulator and parts are referred to, and must outlive it.
///
/// An exception of a listener comes out of the call; its event has happened, and counts. A snapshot is taken then, so
/// that a return to a later time does not repeat the event, and its exception.
///
/// With Simulator::set_window(), a step that finds no event looks ahead while the clock stays, so that several states
/// of one clock differ in their horizon and in the failure times that are known up to it. roll_back() brings back one
/// of these: next_time() may then see farther than it did, or less far. The events are the same.
///
/// Cost: memory, a snapshot every `every` events or calls, and a few words a call; a roll-back, a load and at most
/// `every` events and calls. Not for time that runs backwards (reverse.hpp).
template <class AnySimulator, class... Parts>
class History {
 public:
  /// `parts`: the sets of elements and whatever else is saved with the simulator. `every`, in events and calls, is 1 at
  /// least: 0 counts as 1.
  explicit History(std::uint64_t every, AnySimulator& simulator, Parts&... parts)
      : simulator_(simulator), parts_(parts...), every_(std::max<std::uint64_t>(every, 1)) {
    keep();
  }

  /// As Simulator::step().
  bool step(double limit = forever) {
    if (step_to_event(limit)) return true;
    // Structures may have taken up edits in it, apart from those that come later.
    Call* const last = last_call();
    if (!last || last->edit || (!last->ended && limit < last->limit)) {
      calls_.push_back({.limit = limit, .ended = true});
    } else {
      last->limit = std::max(last->limit, limit);
      last->ended = true;
    }
    return false;
  }
  /// As Simulator::advance_to(), which throws for a t that is not finite or before the clock.
  void advance_to(double t) {
    while (std::isfinite(t) && t >= simulator_.now() && step_to_event(t)) {
    }
    simulator_.advance_to(t);
    calls_.push_back({.limit = t, .edit = [&simulator = simulator_, t] { simulator.advance_to(t); }});
  }
  /// Calls f(), which may edit the elements, plan pieces, and so on, at the clock, but must not move it. f is kept as
  /// long as it may be replayed, and everything that it refers to must live as long. If it throws, what it did before
  /// stays done, but f is not called again.
  void edit(std::function<void()> f) {
    keep_now_and_then();
    keep_if_it_throws(f, [] {});
    calls_.push_back({.limit = simulator_.now(), .edit = std::move(f)});
  }

  /// Events from the beginning to the present state. Those that were rolled back do not count, and those that an edit
  /// processed because they were due are part of the edit.
  std::uint64_t events() const { return events_; }
  std::size_t snapshots() const { return kept_.size(); }
  /// Whether a replay is going on: all that is called then has been called before.
  bool replaying() const { return replaying_; }

  /// Back to time t: all edits up to and including t have been made, and all events have happened. Throws
  /// std::invalid_argument for a time after the clock, or before the first that is known.
  void roll_back(double t) {
    if (!(t <= simulator_.now()) || t < kept_.front().time) {
      throw std::invalid_argument("History: " + number_text(t) + " is not between " + number_text(kept_.front().time) +
                                  " and the clock at " + number_text(simulator_.now()));
    }
    replay([&](const Kept& kept) { return kept.time <= t; }, t, std::numeric_limits<std::uint64_t>::max());
    advance_to(t);
  }

  /// Undoes the last event and whatever came after it: the state is the one in which it was due. The clock may then
  /// stand before that time. False, and nothing is done, if there is no such event after the earliest snapshot that is
  /// kept.
  bool step_back() {
    if (events_ == kept_.front().events) return false;
    const std::uint64_t before = events_ - 1;
    replay([&](const Kept& kept) { return kept.events <= before; }, forever, before);
    return true;
  }

  /// Forgets what is not needed to go back to t; a return to earlier times is not possible from then on.
  void forget_before(double t) {
    std::size_t first = 0;
    while (first + 1 < kept_.size() && kept_[first + 1].time <= t) ++first;
    const std::size_t calls = kept_[first].calls;
    kept_.erase(kept_.begin(), kept_.begin() + static_cast<std::ptrdiff_t>(first));
    calls_.erase(calls_.begin(), calls_.begin() + static_cast<std::ptrdiff_t>(calls));
    for (Kept& kept : kept_) kept.calls -= calls;
  }

 private:
  /// An edit at time `limit`, an advance of the clock to it without events, or steps up to it.
  struct Call {
    double limit;
    std::uint64_t steps = 0;          ///< that found an event
    bool ended = false;               ///< whether one more step found none
    std::function<void()> edit = {};  ///< makes the edit or the advance
  };
  struct Kept {
    double time;
    std::uint64_t events;
    std::size_t calls;  ///< that had been made
    Snapshot snapshot;
  };

  static constexpr double forever = std::numeric_limits<double>::infinity();

  /// The last one since the last snapshot.
  Call* last_call() { return calls_.size() > kept_.back().calls ? &calls_.back() : nullptr; }

  /// A step, which is recorded if it finds an event.
  bool step_to_event(double limit) {
    keep_now_and_then();
    bool found = false;
    const double clock = simulator_.now();
    const std::uint64_t events = simulator_.counters().events;
    const auto happened = [&] { return simulator_.now() != clock || simulator_.counters().events != events; };
    keep_if_it_throws([&] { found = simulator_.step(limit); },
                      [&] {
                        if (happened()) record_event(limit);
                      });
    if (found) record_event(limit);
    return found;
  }
  void record_event(double limit) {
    Call* const last = last_call();
    if (last && last->steps > 0 && !last->ended && last->limit == limit) {
      ++last->steps;
    } else {
      calls_.push_back({.limit = limit, .steps = 1});
    }
    ++events_;
  }

  /// What was done before an exception could not be repeated by the calls that are recorded, so it is saved.
  template <class Work, class Record>
  void keep_if_it_throws(const Work& work, const Record& record) {
    try {
      work();
    } catch (...) {
      record();
      try {
        keep();
      } catch (const std::exception&) {
        // What cannot be saved any more is unusable, and says so when it is used again.
      }
      throw;
    }
  }
  void keep_now_and_then() {
    if (events_ - kept_.back().events + calls_.size() - kept_.back().calls >= every_) keep();
  }
  void keep() {
    const auto all = [&](auto&... parts) { return save(simulator_, parts...); };
    kept_.push_back({simulator_.now(), events_, calls_.size(), std::apply(all, parts_)});
  }

  /// Loads the last snapshot before a time and a number of events, and repeats the calls up to them.
  template <class WillDo>
  void replay(WillDo&& will_do, double t, std::uint64_t events) {
    while (!will_do(kept_.back())) kept_.pop_back();
    const Kept& from = kept_.back();
    std::apply([&](auto&... parts) { restore(from.snapshot, simulator_, parts...); }, parts_);
    events_ = from.events;
    std::vector<Call> calls(std::make_move_iterator(calls_.begin() + static_cast<std::ptrdiff_t>(from.calls)),
                            std::make_move_iterator(calls_.end()));
    calls_.resize(from.calls);
    const detail::RaisedFlag replaying(replaying_);
    for (Call& call : calls) {
      if (call.edit) {
        if (call.limit > t) break;
        edit(std::move(call.edit));
      } else {
        std::uint64_t done = 0;
        while (done < call.steps && events_ < events && step_to_event(std::min(call.limit, t))) ++done;
        if (done < call.steps) break;
        if (call.ended) step(std::min(call.limit, t));
      }
    }
  }

  AnySimulator& simulator_;
  std::tuple<Parts&...> parts_;
  std::uint64_t every_;
  std::uint64_t events_ = 0;
  std::vector<Kept> kept_;
  std::vector<Call> calls_;
  bool replaying_ = false;
};

}  // namespace kds
