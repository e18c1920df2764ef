// The clock of the world: which event is next, and the functions by which callers move it.
#include "collision/world/engine.hpp"

#include "collision/broad_phase/broad_phase.hpp"
#include "collision/motions.hpp"
#include "collision/profile.hpp"
#include "kds/number_text.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace kds::collision {
namespace {

/// Bodies that enter, pairs that are tested or events of the broad phase that are processed between two looks at the
/// clock: far less than a millisecond, and many more instructions than a look takes.
constexpr std::size_t small_part = 64;

void require_ahead(const char* function, double t, double now) {
  if (t >= now && t != never) return;
  throw std::invalid_argument(std::string(function) + ": " + number_text(t) + " is not a finite time from now on (" +
                              number_text(now) + ")");
}

/// Throws for a search up to the end of time, if events may go on until then.
template <class Motion>
void require_end(const char* function, double until, BroadPhaseKind broad_phase, const char* end) {
  if (until < never) return;
  const std::string called = std::string(function) + ": ", needs = std::string(", so it needs ") + end;
  if (broad_phase == BroadPhaseKind::sap) {
    throw std::invalid_argument(called + "sweep and prune by frames has no last event" + needs);
  }
  if (turns<Motion>) {
    throw std::invalid_argument(called + "bodies that turn may come near each other for ever" + needs);
  }
}

}  // namespace

template <class Motion>
Engine<Motion>::Engine(BasicWorld<Motion>& world, const WorldOptions& options, Listener* listener)
    : parts_(options),
      clock_(parts_.clock),
      callers_{.now = options.start_time},
      guard_(parts_.volumes.calling()),
      calls_(world, listener, parts_, guard_),
      motions_(parts_),
      membership_(parts_, motions_),
      response_(parts_, motions_, calls_, guard_),
      edits_(parts_, motions_, membership_, guard_, callers_),
      queries_(parts_, motions_, guard_, callers_),
      transfer_(parts_, membership_, edits_, guard_, callers_) {}

/// Each piece is an event of its own.
template <class Motion>
bool Engine<Motion>::step(double limit) {
  guard_.require_idle("World::step");
  look_at_all();
  return next_step(limit);
}

template <class Motion>
bool Engine<Motion>::next_step(double limit) {
  membership_.fit();
  if (limit == never && callers_.idle_for_ever) return false;
  if (limit < callers_.idle_until) {
    callers_.now = std::max(callers_.now, limit);
    clock_.now = std::max(clock_.now, callers_.now);
    return false;
  }
  if (std::isnan(limit)) throw std::invalid_argument("World::step: the limit is not a number");
  require_end<Motion>("World::step", limit, parts_.options.broad_phase, "a limit");
  if (limit < clock_.now) {  // next_time() has found that nothing happens until then.
    callers_.now = std::max(callers_.now, limit);
    return false;
  }
  callers_.next_time = -never;
  return guarded_event(limit, Search::makes);
}

/// The clock follows the events that have been processed, even if a listener throws.
template <class Motion>
bool Engine<Motion>::guarded_event(double limit, Search search) {
  struct Follow {
    Engine& engine;
    Search search;
    ~Follow() {
      if (search == Search::makes) engine.callers_.now = engine.clock_.now;
    }
  } follow{*this, search};
  return guard_.step([&] { return next_event(limit, search); });
}

/// How much of work that can be divided is done between two looks at the clock.
template <class Motion>
std::size_t Engine<Motion>::part_of_work() const {
  return deadline_ ? small_part : ~std::size_t{0};
}

/// A piece of a body that precesses is over; its report ends the step.
template <class Motion>
bool Engine<Motion>::process(Tumbling<Motion>&) {
  if constexpr (turns<Motion>) motions_.turn_on();
  return false;
}

template <class Motion>
bool Engine<Motion>::process(Volumes<Motion>&) {
  const BodySlot slot = parts_.volumes.next_body();
  motions_.update_volume(slot, parts_.volumes.renew(slot));
  return parts_.volumes.from_caller(slot);
}

/// What contacts of the next two days need.
template <class Motion>
void Engine<Motion>::prefetch_coming() const {
  parts_.pairs.look_ahead([this](BodySlot slot) { parts_.pairs.prefetch_list(slot); },
                          [this](BodySlot slot) {
                            parts_.pairs.prefetch(slot);
                            parts_.broad_phase->prefetch(slot);
                            parts_.walls.prefetch(slot);
                          });
}

template <class Motion>
bool Engine<Motion>::next_event(double limit, Search search) {
  const bool looks = search == Search::looks;
  callers_.idle_until = -never;
  callers_.idle_for_ever = false;
  bool looked_ahead = false;
  double reached = callers_.now;  // the clock if no event follows
  // Where it is not known that anything will happen, the broad phase runs ahead of the clock.
  double broad_phase_reached = clock_.now;
  const std::size_t part = part_of_work();
  const auto list = parts_.list();
  for (;;) {
    if (!looks && parts_.scripts.next_time() <= clock_.now) {  // the rest of those of which a part has been started
      motions_.start_pieces(part);
      return true;
    }
    if (parts_.bodies.any_waits()) membership_.enter_waiting(part);
    if (parts_.bodies.any_waits()) {
      if (late()) return true;
      continue;
    }
    if (!parts_.resting.solved()) parts_.resting.solve();
    if constexpr (turns<Motion>) motions_.look_at_tested();
    if (!parts_.pairs.tested()) parts_.pairs.test(part);
    if (!parts_.pairs.tested()) {
      if (late()) return true;
      continue;
    }
    if (parts_.bodies.size() > more_than_caches) prefetch_coming();
    const auto due = list.next();
    // Pending work is of this instant: all that happens at it has to be known before any of it is reported.
    const bool reports = !parts_.reports.empty();
    // Events beyond the horizon are not known: process up to it, then extend it.
    const double next = std::min({reports ? clock_.now : limit, clock_.horizon, due.time});
    const bool is_due = due.time == next && next < never;
    if (is_due && list.at(due.place, [](auto& part) { return part.certify(); })) continue;
    // A piece that starts now is the motion at t+, so it starts before the broad phase runs past this time.
    const bool moves = is_due && due.is_of(Stage::motions);
    const double until = next == never ? parts_.broad_phase->next_time() : moves ? next_down(next) : next;
    if (until == never) {
      clock_.now = std::max(clock_.now, broad_phase_reached);
      parts_.go_back(reached);
      callers_.idle_for_ever = true;
      return false;
    }
    {
      const Stopwatch watch(parts_.profile(), Work::sort);
      if (next == never) broad_phase_reached = until;
      const Ran ran = run_broad_phase(until);
      if (ran == Ran::until_late) return true;
      if (ran == Ran::to_a_pair || next == never) continue;
    }
    clock_.now = std::max(clock_.now, next);
    if (reports && !(is_due && due.is_of(Stage::boxes))) {
      if (!looks) calls_.report_next();
      return true;
    }
    if (is_due) {
      if (looks && list.at(due.place, [&](const auto& part) { return this->happens(part); })) return true;
      if (list.at(due.place, [&](auto& part) { return this->process(part); })) return true;
      if (due.place == list.template place_of<RestingPart<Motion>>()) reached = clock_.now;  // Motions have changed.
    } else if (next < limit) {
      // Without a limit: one window farther, and if nothing happens in that either, for all time.
      parts_.extend_horizon(limit == never && !looked_ahead ? clock_.horizon + parts_.options.window : limit);
      looked_ahead = true;
    } else {
      if (!looks) callers_.idle_until = std::min({clock_.horizon, due.time, parts_.broad_phase->next_time()});
      return false;
    }
  }
}

/// Precondition: nothing else is due before `until`.
template <class Motion>
inline typename Engine<Motion>::Ran Engine<Motion>::run_broad_phase(double until) {
  if (deadline_) {
    std::size_t events = 0;
    for (double t = parts_.broad_phase->next_time(); t <= until; t = parts_.broad_phase->next_time()) {
      if (parts_.broad_phase->advance(t, parts_.pairs)) return Ran::to_a_pair;
      clock_.now = std::max(clock_.now, t);
      if (++events % small_part == 0 && late()) return Ran::until_late;
    }
  }
  return parts_.broad_phase->advance(until, parts_.pairs) ? Ran::to_a_pair : Ran::all;
}

/// The result stays in queues and lists, like all that is known of later times.
template <class Motion>
double Engine<Motion>::next_time() {
  guard_.require_idle("World::next_time");
  look_at_all();
  if (callers_.next_time != -never) return callers_.next_time;
  if (clock_.now == callers_.now && parts_.any_work()) return callers_.now;
  require_end<Motion>("World::next_time", callers_.looked_for_until, parts_.options.broad_phase,
                      "extend_horizon(), or a Simulator with a window");
  callers_.next_time = guarded_event(callers_.looked_for_until, Search::looks) ? clock_.now : never;
  return callers_.next_time;
}

/// What follows from the event at its own time is found out at once. So the next event is known afterwards, and it
/// makes no difference whether callers look for it before they change something.
template <class Motion>
bool Engine<Motion>::process() {
  guard_.require_idle("World::process");
  const double t = next_time();
  if (t == never) return false;
  const bool happened = step(t);
  if (parts_.any_work() && parts_.reports.empty() && guarded_event(callers_.now, Search::looks))
    callers_.next_time = clock_.now;
  return happened;
}

/// How far events are predicted at a time is the world's own affair: Clock::horizon.
template <class Motion>
void Engine<Motion>::extend_horizon(double horizon) {
  guard_.require_idle("World::extend_horizon");
  if (callers_.next_time == never && horizon > callers_.looked_for_until) callers_.next_time = -never;
  callers_.looked_for_until = horizon;
}

template <class Motion>
void Engine<Motion>::advance_to(double t) {
  guard_.require_idle("World::advance_to");
  require_ahead("World::advance_to", t, callers_.now);
  struct Unheard {
    Tumbling<Motion>& of;
    ~Unheard() { of.set_unheard_until(-never); }
  } unheard{parts_.tumbling};
  if (calls_.hears_pieces()) {
    look_at_all();
  } else {
    unheard.of.set_unheard_until(t);
  }
  const auto read = [&] {
    if constexpr (turns<Motion>) motions_.read_all();
  };
  try {
    while (next_step(t)) {
    }
  } catch (...) {
    if (guard_.whole()) read();  // The listener has thrown.
    throw;
  }
  read();
}

template <class Motion>
const Motion& Engine<Motion>::motion(BodyId id) {
  const BodySlot slot = bodies().slot_of(id);
  if constexpr (turns<Motion>) {
    if (guard_.stepping()) motions_.read(slot);
  }
  return bodies().motion(slot);
}

/// A listener that has asked for all once may do so at each event: until the end of the call none is left alone.
template <class Motion>
void Engine<Motion>::look_at_alone() {
  parts_.tumbling.set_unheard_until(-never);
  callers_.forget_next_event();
  guard_.change([&] {
    if constexpr (turns<Motion>) motions_.look_at_all();
  });
}

template <class Motion>
bool Engine<Motion>::advance_for(double budget_seconds, double t) {
  guard_.require_idle("World::advance_for");
  require_ahead("World::advance_for", t, callers_.now);
  if (!(budget_seconds >= 0)) {
    throw std::invalid_argument("World::advance_for: a budget of " + number_text(budget_seconds) + " s is not >= 0");
  }
  const double longest = 1e9;  // s; what is counted in integers must not overflow
  const auto budget = std::chrono::duration<double>(std::min(budget_seconds, longest));
  const auto deadline = WallClock::now() + std::chrono::duration_cast<WallClock::duration>(budget);
  struct Reset {
    std::optional<WallClock::time_point>& of;
    ~Reset() { of.reset(); }
  } reset{deadline_};
  deadline_ = deadline;
  look_at_all();
  while (next_step(t)) {
    if (late()) return false;
  }
  return true;
}

template <class Motion>
void Engine<Motion>::audit(double t) {
  guard_.require_whole("World::audit");
  look_within_step();
  parts_.audit(t);
}

#define KDS_INSTANTIATE(motion) template class Engine<motion>;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
