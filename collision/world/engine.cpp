// The clock of the world: which event is next, and the functions by which callers move it.
#include "collision/world/engine.hpp"

#include "collision/motions.hpp"
#include "collision/profile.hpp"
#include "collision/world/new_broad_phase.hpp"
#include "kds/arithmetic/strict.hpp"
#include "kds/audit.hpp"
#include "kds/raised_flag.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace kds::collision {
namespace {

/// Returns the options, or throws.
const WorldOptions& validated(const WorldOptions& options) {
  require_strict_arithmetic("World");
  validate(options);
  return options;
}

struct PairCollector final : PairListener {
  std::vector<std::pair<BodySlot, BodySlot>> pairs;
  void pair_began(BodySlot a, BodySlot b, double) override { pairs.emplace_back(a, b); }
  void pair_ended(BodySlot a, BodySlot b, double) override { std::erase(pairs, std::pair(a, b)); }
};

/// Bodies that enter, pairs that are tested or events of the broad phase that are processed between two looks at the
/// clock: far less than a millisecond, and many more instructions than a look takes.
constexpr std::size_t small_part = 64;

void require_ahead(const char* function, double t, double now) {
  if (t >= now && t != never) return;
  throw std::invalid_argument(std::string(function) + ": " + std::to_string(t) + " is not a finite time from now on (" +
                              std::to_string(now) + ")");
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
    : world_(world),
      options_(validated(options)),
      listener_(listener ? listener : &silent_),
      clock_{options.start_time, options.start_time + options.window},
      tumbling_(bodies_, options_, counters_),
      volumes_(bodies_, options_, clock_),
      walls_(bodies_, options_.walls, clock_),
      resting_(bodies_, options_, clock_, *this),
      pairs_(bodies_, volumes_, resting_, reports_, options_, clock_, counters_, profile()),
      unbounded_(bodies_, clock_, pairs_),
      self_contacts_(bodies_, clock_),
      callers_now_(options.start_time) {
  make_broad_phase();
}

template <class Motion>
void Engine<Motion>::make_broad_phase() {
  const auto box_of = [this](BodySlot slot) { return volumes_.box(slot); };
  broad_phase_ = new_broad_phase<Motion::degree>(options_, clock_.now, profile(), box_of, volumes_.kdops());
  broad_phase_->extend_horizon(clock_.now, clock_.horizon);
  expected_ = 0;
  pairs_.expect_exact(broad_phase_->exact());
}

/// Makes a broad phase for the bodies as they are now; pairs are listed as it finds them.
template <class Motion>
void Engine<Motion>::rebuild_broad_phase() {
  make_broad_phase();
  broad_phase_->reserve(reserved_);
  PairCollector found;
  std::vector<Entry> entries;
  std::vector<KineticBox<Motion::degree>> boxes;
  for (BodySlot slot = 0; slot < bodies_.slots(); ++slot) {
    if (!bodies_[slot].entered || !bodies_.in_broad_phase(slot)) continue;
    entries.push_back({slot, nullptr});
    boxes.push_back(volumes_.renew(slot));
    volumes_.schedule(slot);
  }
  for (std::size_t i = 0; i < entries.size(); ++i) entries[i].box = &boxes[i];
  broad_phase_->insert(entries, clock_.now, found);
  unbounded_.find();
  unbounded_.every_pair([&](BodySlot a, BodySlot b) { found.pair_began(a, b, clock_.now); });
  std::sort(found.pairs.begin(), found.pairs.end());
  pairs_.list_anew(found.pairs);
}

/// Puts the clock back after a search without a limit has found no event: the search has moved it beyond all times at
/// which bounding volumes meet and part, and nothing else has happened since.
template <class Motion>
void Engine<Motion>::go_back(double t) {
  if (clock_.now == t) return;
  clock_.now = t;
  counters_.broad_phase = counters_.broad_phase + broad_phase_->counters();
  rebuild_broad_phase();
}

template <class Motion>
void Engine<Motion>::set_horizon(double limit) {
  if (!(limit > clock_.horizon)) return;
  constexpr double farthest = 1;  // s, for bodies that turn, whose contacts are searched turn by turn
  const double window = turns<Motion> ? std::min(options_.window, farthest) : options_.window;
  clock_.horizon = std::max(limit, clock_.horizon + window);
  broad_phase_->extend_horizon(clock_.now, clock_.horizon);
  parts().each([](auto& part) { part.extend_horizon(); });
}

template <class Motion>
bool Engine<Motion>::step(double limit) {
  require_idle("World::step");
  if (limit == never && idle_for_ever_) return false;
  if (limit < idle_until_) {
    callers_now_ = std::max(callers_now_, limit);
    clock_.now = std::max(clock_.now, callers_now_);
    return false;
  }
  if (std::isnan(limit)) throw std::invalid_argument("World::step: the limit is not a number");
  require_end<Motion>("World::step", limit, options_.broad_phase, "a limit");
  if (limit < clock_.now) {  // next_time() has found that nothing happens until then.
    callers_now_ = std::max(callers_now_, limit);
    return false;
  }
  next_time_ = -never;
  return guarded_event(limit, Search::makes);
}

/// The clock follows the events that have been processed, even if a listener throws.
template <class Motion>
bool Engine<Motion>::guarded_event(double limit, Search search) {
  const kds::detail::RaisedFlag stepping(stepping_);  // Callbacks are called only from here.
  try {
    const bool found = next_event(limit, search);
    if (search == Search::makes) callers_now_ = clock_.now;
    return found;
  } catch (...) {
    if (search == Search::makes) callers_now_ = clock_.now;
    if (!std::exchange(telling_, false)) note_failure();
    throw;
  }
}

/// How much of work that can be divided is done between two looks at the clock.
template <class Motion>
std::size_t Engine<Motion>::part_of_work() const {
  return deadline_ ? small_part : ~std::size_t{0};
}

/// A piece of a body that precesses is over; its report ends the step.
template <class Motion>
bool Engine<Motion>::process(Tumbling<Motion>&) {
  if constexpr (turns<Motion>) turn_on();
  return false;
}

template <class Motion>
bool Engine<Motion>::process(Volumes<Motion>&) {
  const BodySlot slot = volumes_.next_body();
  update_volume(slot, volumes_.renew(slot));
  return volumes_.from_caller(slot);
}

/// What contacts of the next two days need.
template <class Motion>
void Engine<Motion>::prefetch_coming() const {
  pairs_.look_ahead([this](BodySlot slot) { pairs_.prefetch_list(slot); },
                    [this](BodySlot slot) {
                      pairs_.prefetch(slot);
                      broad_phase_->prefetch(slot);
                      walls_.prefetch(slot);
                    });
}

template <class Motion>
bool Engine<Motion>::next_event(double limit, Search search) {
  const bool looks = search == Search::looks;
  idle_until_ = -never;
  idle_for_ever_ = false;
  bool looked_ahead = false;
  double reached = callers_now_;  // the clock if no event follows
  // Where it is not known that anything will happen, the broad phase runs ahead of the clock.
  double broad_phase_reached = clock_.now;
  const std::size_t part = part_of_work();
  const auto parts = this->parts();
  for (;;) {
    if (!looks && scripts_.next_time() <= clock_.now) {  // the rest of those of which a part has been started
      start_pieces();
      return true;
    }
    if (bodies_.any_waits()) enter_new_bodies(part);
    if (bodies_.any_waits()) {
      if (late()) return true;
      continue;
    }
    if (!resting_.solved()) resting_.solve();
    if constexpr (turns<Motion>) look_at_tested();
    if (!pairs_.tested()) pairs_.test(part);
    if (!pairs_.tested()) {
      if (late()) return true;
      continue;
    }
    if (bodies_.size() > more_than_caches) prefetch_coming();
    const auto due = parts.next();
    // Pending work is of this instant: all that happens at it has to be known before any of it is reported.
    const bool reports = !reports_.empty();
    // Events beyond the horizon are not known: process up to it, then extend it.
    const double next = std::min({reports ? clock_.now : limit, clock_.horizon, due.time});
    const bool is_due = due.time == next && next < never;
    if (is_due && parts.at(due.place, [](auto& part) { return part.certify(); })) continue;
    // A piece that starts now is the motion at t+, so it starts before the broad phase runs past this time.
    const bool moves = is_due && due.is_of(Stage::motions);
    const double until = next == never ? broad_phase_->next_time() : moves ? next_down(next) : next;
    if (until == never) {
      clock_.now = std::max(clock_.now, broad_phase_reached);
      go_back(reached);
      idle_for_ever_ = true;
      return false;
    }
    {
      const Stopwatch watch(profile(), Work::sort);
      if (next == never) broad_phase_reached = until;
      const Ran ran = run_broad_phase(until);
      if (ran == Ran::until_late) return true;
      if (ran == Ran::to_a_pair || next == never) continue;
    }
    clock_.now = std::max(clock_.now, next);
    if (reports && !(is_due && due.is_of(Stage::boxes))) {
      if (!looks) report_next();
      return true;
    }
    if (is_due) {
      if (looks && parts.at(due.place, [&](const auto& part) { return this->happens(part); })) return true;
      if (parts.at(due.place, [&](auto& part) { return this->process(part); })) return true;
      if (due.place == parts.template place_of<Resting>()) reached = clock_.now;  // Motions have changed.
    } else if (next < limit) {
      // Without a limit: one window farther, and if nothing happens in that either, for all time.
      set_horizon(limit == never && !looked_ahead ? clock_.horizon + options_.window : limit);
      looked_ahead = true;
    } else {
      if (!looks) idle_until_ = std::min({clock_.horizon, due.time, broad_phase_->next_time()});
      return false;
    }
  }
}

/// Precondition: nothing else is due before `until`.
template <class Motion>
inline typename Engine<Motion>::Ran Engine<Motion>::run_broad_phase(double until) {
  if (deadline_) {
    std::size_t events = 0;
    for (double t = broad_phase_->next_time(); t <= until; t = broad_phase_->next_time()) {
      if (broad_phase_->advance(t, pairs_)) return Ran::to_a_pair;
      clock_.now = std::max(clock_.now, t);
      if (++events % small_part == 0 && late()) return Ran::until_late;
    }
  }
  return broad_phase_->advance(until, pairs_) ? Ran::to_a_pair : Ran::all;
}

/// The result stays in queues and lists, like all that is known of later times.
template <class Motion>
double Engine<Motion>::next_time() {
  require_idle("World::next_time");
  if (next_time_ != -never) return next_time_;
  if (clock_.now == callers_now_ && work_left()) return callers_now_;
  require_end<Motion>("World::next_time", looked_for_until_, options_.broad_phase, "a simulator with a window");
  next_time_ = guarded_event(looked_for_until_, Search::looks) ? clock_.now : never;
  return next_time_;
}

/// What follows from the event at its own time is found out at once. So the next event is known afterwards, and it
/// makes no difference whether callers look for it before they change something.
template <class Motion>
bool Engine<Motion>::process() {
  require_idle("World::process");
  const double t = next_time();
  if (t == never) return false;
  const bool happened = step(t);
  if (work_left() && reports_.empty() && guarded_event(callers_now_, Search::looks)) next_time_ = clock_.now;
  return happened;
}

/// How far events are predicted at a time is the world's own affair: Clock::horizon.
template <class Motion>
void Engine<Motion>::extend_horizon(double horizon) {
  require_idle("World::extend_horizon");
  if (next_time_ == never && horizon > looked_for_until_) next_time_ = -never;
  looked_for_until_ = horizon;
}

template <class Motion>
void Engine<Motion>::advance_to(double t) {
  require_idle("World::advance_to");
  require_ahead("World::advance_to", t, callers_now_);
  struct Unheard {
    Tumbling<Motion>& of;
    ~Unheard() { of.set_unheard_until(-never); }
  } unheard{tumbling_};
  if (listener_ == &silent_) unheard.of.set_unheard_until(t);
  while (step(t)) {
  }
}

template <class Motion>
bool Engine<Motion>::advance_for(double budget_seconds, double t) {
  require_idle("World::advance_for");
  require_ahead("World::advance_for", t, callers_now_);
  if (!(budget_seconds >= 0)) {
    throw std::invalid_argument("World::advance_for: a budget of " + std::to_string(budget_seconds) + " s is not >= 0");
  }
  const double longest = 1e9;  // s; what is counted in integers must not overflow
  const auto budget = std::chrono::duration<double>(std::min(budget_seconds, longest));
  const auto deadline = WallClock::now() + std::chrono::duration_cast<WallClock::duration>(budget);
  struct Reset {
    std::optional<WallClock::time_point>& of;
    ~Reset() { of.reset(); }
  } reset{deadline_};
  deadline_ = deadline;
  while (step(t)) {
    if (late()) return false;
  }
  return true;
}

/// Starts all pieces that are due in one go: bodies that jump together are not apart in between. But those of bodies
/// that enter only make them wait, so with a deadline they are started in parts.
template <class Motion>
void Engine<Motion>::start_pieces() {
  auto pieces = scripts_.take_next(part_of_work(), [&](BodySlot slot) { return !bodies_[slot].entered; });
  std::sort(pieces.begin(), pieces.end(),
            [this](const auto& x, const auto& y) { return bodies_.before(x.slot, y.slot); });
  std::vector<char> jumps;
  for (auto& [slot, motion] : pieces) {
    if constexpr (turns<Motion>) {
      if (tumbling_.is_alone(slot)) look_at(slot);
      if (tumbling_.has(slot)) motion = tumbling_.take_up(slot, motion, clock_.now);
    }
    jumps.push_back(bodies_[slot].entered && bodies_.is_jump(slot, motion, clock_.now));
    if (jumps.back()) resting_.drop_all(slot);
    resting_.leave(slot);
    bodies_.move(slot, motion);
    bodies_.accelerate_freely(slot, motion);
    for (const BodySlot sensor : bodies_.attachments().sensors(slot)) bodies_.move(sensor, motion);
  }
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const BodySlot slot = pieces[i].slot;
    if (bodies_[slot].entered) {
      ++counters_.motion_updates;
      set_motion(slot, pieces[i].motion, jumps[i]);
      resting_.disturb(slot);
    } else {
      wait_to_enter(slot);
    }
    if (!options_.report_pieces) continue;
    const BodyId id = bodies_.id_of(slot);
    reports_.add(Reports::Kind::piece, id, id, {.time = clock_.now});
  }
}

template <class Motion>
void Engine<Motion>::ring() {
  const TimerId timer = timers_.take_next();
  tell([&](Listener& listener) { listener.timer(world_, timer); });
}

/// Callers have changed something, so the time until the next event has to be searched again: where bodies have changed
/// after the next step, which finds out what follows now. Edits by callbacks are counted, so that a run ends.
template <class Motion>
void Engine<Motion>::count_edit(bool of_bodies) {
  idle_until_ = -never;
  const bool due_now = of_bodies || next_time_ == callers_now_;
  next_time_ = due_now && !stepping_ ? callers_now_ : -never;
  idle_for_ever_ = false;
  if (stepping_)
    edits_.count(clock_.now, options_.zeno.interval, std::max<std::uint64_t>(options_.most_edits, 64 * bodies_.size()));
}

#define KDS_INSTANTIATE(motion) template class Engine<motion>;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
