// The clock of the world: which event is next, and what the callers of the engine see.
#include "collision/world.hpp"

#include "collision/broad_phase/adaptive_broad_phase.hpp"
#include "collision/broad_phase/all_pairs.hpp"
#include "collision/broad_phase/kinetic_grid.hpp"
#include "collision/broad_phase/kinetic_sweep_and_prune.hpp"
#include "collision/broad_phase/swept_sweep_and_prune.hpp"
#include "collision/profile.hpp"
#include "kds/arithmetic/strict.hpp"
#include "kds/audit.hpp"
#include "kds/raised_flag.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace kds::collision {
namespace {

template <int Degree>
std::unique_ptr<BroadPhase<Degree>> new_broad_phase(const WorldOptions& options, double now, Profile* profile,
                                                    Kdops<Degree> kdops) {
  switch (options.broad_phase) {
    case BroadPhaseKind::automatic:
      return std::make_unique<AdaptiveBroadPhase<Degree>>(options.threads);
    case BroadPhaseKind::grid:
      return std::make_unique<KineticGrid<Degree>>(options.threads);
    case BroadPhaseKind::kinetic_sap:
      return std::make_unique<KineticSweepAndPrune<Degree>>(now, ListedAxes::automatic, std::move(kdops));
    case BroadPhaseKind::sap:
      if (!(options.rate > 0) || !std::isfinite(1 / options.rate)) {
        throw std::invalid_argument(
            "WorldOptions.rate: sweep and prune with swept boxes needs a rate > 0, finite and with a finite 1 / rate");
      }
      return std::make_unique<SweptSweepAndPrune<Degree>>(now, options.rate, profile);
    case BroadPhaseKind::all_pairs:
      return std::make_unique<AllPairs<Degree>>();
  }
  throw std::invalid_argument("WorldOptions.broad_phase: unknown");
}

void validate(const WorldOptions& options) {
  if (!std::isfinite(options.start_time)) throw std::invalid_argument("WorldOptions.start_time: must be finite");
  if (std::abs(options.start_time) > largest_magnitude) {
    throw std::invalid_argument("WorldOptions.start_time: must not be beyond 2^205 (5.1e61)");
  }
  if (!(options.window > 0)) throw std::invalid_argument("WorldOptions.window: must be > 0");
  if (!(options.rate >= 0) || !std::isfinite(options.rate)) {
    throw std::invalid_argument("WorldOptions.rate: must be finite and >= 0");
  }
  switch (options.response) {
    case Response::none:
    case Response::elastic:
    case Response::callback:
      break;
    default:
      throw std::invalid_argument("WorldOptions.response: unknown");
  }
  if (options.zeno.contacts == 0) throw std::invalid_argument("WorldOptions.zeno.contacts: must be > 0");
  if (!(options.zeno.interval >= 0)) throw std::invalid_argument("WorldOptions.zeno.interval: must be >= 0");
  if (options.walls) {
    const Walls& walls = *options.walls;
    if (!walls.min.allFinite() || !walls.max.allFinite()) {
      throw std::invalid_argument("WorldOptions.walls: must be finite");
    }
    if (!(walls.min.array() < walls.max.array()).all()) {
      throw std::invalid_argument("WorldOptions.walls: min must be below max");
    }
    if (!(walls.restitution >= 0 && walls.restitution <= 1)) {
      throw std::invalid_argument("WorldOptions.walls.restitution: must be in [0, 1]");
    }
  }
}

void require_ahead(const char* function, double t, double now) {
  if (t >= now && t != never) return;
  throw std::invalid_argument(std::string(function) + ": " + std::to_string(t) + " is not a finite time from now on (" +
                              std::to_string(now) + ")");
}

}  // namespace

template <int Degree>
World<Degree>::World(const WorldOptions& options, Listener* listener)
    : options_(options),
      listener_(listener ? listener : &silent_),
      resting_(*this),
      contacts_(PairRank{&pairs_}),
      boxes_(PairRank{&pairs_}),
      now_(options.start_time),
      clock_(options.start_time),
      horizon_(options.start_time + options.window) {
  require_strict_arithmetic("World");
  validate(options);
  make_broad_phase();
}

template <int Degree>
void World<Degree>::make_broad_phase() {
  broad_phase_ = new_broad_phase<Degree>(options_, now_, profile(), kdops());
  broad_phase_->extend_horizon(now_, horizon_);
}

template <int Degree>
World<Degree>::~World() = default;

template <int Degree>
void World<Degree>::reach(double limit) {
  if (!(limit > horizon_)) return;
  horizon_ = std::max(limit, horizon_ + options_.window);
  broad_phase_->extend_horizon(now_, horizon_);
  for (PairSlot slot = 0; slot < pairs_.size(); ++slot) {
    const bool boxes_known = slot >= boxes_.slots() || boxes_.contains(slot);
    if (pairs_[slot].alive && !(contacts_.contains(slot) && boxes_known)) mark_dirty(slot);
  }
  for (BodyId id = 0; id < bodies_.size(); ++id) {
    if (!bodies_[id].entered) continue;
    schedule_wall(id);
    schedule_volume(id);
  }
  resting_.extend_horizon();
}

template <int Degree>
bool World<Degree>::step(double limit) {
  require_idle("World::step");
  if (limit < idle_until_ || (limit == never && idle_until_ == never)) {
    if (limit < never) clock_ = std::max(clock_, limit);
    now_ = std::max(now_, clock_);
    return false;
  }
  if (std::isnan(limit)) throw std::invalid_argument("World::step: the limit is not a number");
  if (limit == never && options_.broad_phase == BroadPhaseKind::sap) {
    throw std::invalid_argument("World::step: sweep and prune by frames has no last event, so it needs a limit");
  }
  if (limit < now_) {  // Up to there nothing happens, as next_time() has found.
    clock_ = std::max(clock_, limit);
    return false;
  }
  next_time_ = -never;
  return guarded_event(limit, Search::makes);
}

/// The clock follows what has been done, even where a listener throws.
template <int Degree>
bool World<Degree>::guarded_event(double limit, Search search) {
  const kds::detail::RaisedFlag stepping(stepping_);  // Callbacks are called from here alone.
  try {
    const bool found = next_event(limit, search);
    if (search == Search::makes) clock_ = now_;
    return found;
  } catch (...) {
    if (search == Search::makes) clock_ = now_;
    if (!std::exchange(telling_, false)) note_failure();
    throw;
  }
}

template <int Degree>
bool World<Degree>::next_event(double limit, Search search) {
  const bool looks = search == Search::looks;
  idle_until_ = -never;
  bool looked_ahead = false;
  double reached = clock_;  // the clock, should nothing come
  for (;;) {
    if (!entering_.empty()) enter_new_bodies();
    if (!resting_.settled()) resting_.settle();
    if (!dirty_.empty()) test_dirty_pairs();
    const Agenda due = agenda();
    const auto [piece, boxes, volume, wall, let_go, contact] = due;
    // What is pending is of this instant, all of which has to be known before any of it is told.
    const bool reports = !reports_.empty();
    // Nothing is known beyond the horizon: look that far, then farther.
    const double next = std::min({reports ? now_ : limit, horizon_, due.first()});
    if (next < never && certify_next(contact == next, wall == next)) continue;
    // A piece that starts now is the motion at t+, so the broad phase may not run past it under the old one.
    const double until = next == never ? broad_phase_->next_time() : (piece == next ? next_down(next) : next);
    if (until == never) {
      if (looks) return false;
      idle_until_ = never;
      go_back(reached);
      return false;
    }
    {
      const Stopwatch watch(profile(), Work::sort);
      if (broad_phase_->advance(until, *this) || next == never) continue;
    }
    if (piece == next) {
      now_ = next;
      if (looks) return true;
      start_pieces();
      return true;
    }
    now_ = std::max(now_, next);
    const bool told =
        reports || wall == next || contact == next || (volume == next && caller_makes_box(volumes_.top().slot));
    if (looks && (told || boxes == next || let_go == next)) return true;
    if (boxes == next) {
      process_boxes(boxes_.top().slot, next);
    } else if (reports) {
      report_next();
      return true;
    } else if (volume == next) {
      if (renew_volume(volumes_.top().slot)) return true;
    } else if (wall == next) {
      process_wall(walls_.top().slot, next);
      return true;
    } else if (let_go == next) {
      resting_.process();
      reached = now_;
    } else if (contact == next) {
      const PairSlot slot = contacts_.top().slot;
      if (pairs_[slot].overlapping) {
        process_separation(slot, next);
      } else {
        process_contact(slot, next);
      }
      return true;
    } else if (next < limit) {
      // Without a limit a window farther, and where nothing happens in that either, as far as there is time.
      reach(limit == never && !looked_ahead ? horizon_ + options_.window : limit);
      looked_ahead = true;
    } else {
      if (!looks) idle_until_ = std::min({horizon_, due.first(), broad_phase_->next_time()});
      return false;
    }
  }
}

template <int Degree>
typename World<Degree>::Agenda World<Degree>::agenda() const {
  const auto time_of = [](const auto& queue) { return queue.empty() ? never : queue.top().time; };
  return {time_of(pieces_), time_of(boxes_),      time_of(volumes_),
          time_of(walls_),  resting_.next_time(), time_of(contacts_)};
}

/// What is found is kept in queues and lists, as all that is known of the time to come.
template <int Degree>
double World<Degree>::next_time() const {
  require_idle("World::next_time");
  if (next_time_ != -never) return next_time_;
  if (now_ == clock_ && work_left()) return clock_;
  if (horizon_ == never && options_.broad_phase == BroadPhaseKind::sap) {
    throw std::invalid_argument("World::next_time: sweep and prune by frames has no last event, so it needs a window");
  }
  auto& self = const_cast<World&>(*this);
  self.next_time_ = self.guarded_event(horizon_, Search::looks) ? now_ : never;
  return next_time_;
}

template <int Degree>
void World<Degree>::process() {
  const double t = next_time();
  if (t < never) step(t);
}

template <int Degree>
void World<Degree>::extend_horizon(double now, double horizon) {
  require_idle("World::extend_horizon");
  if (now > clock_) advance_to(now);
  idle_until_ = next_time_ = -never;
  change_or_fail([&] { reach(horizon); });
}

/// Where what comes next is a lower bound only, puts the exact time in its place, which may be later: true if so.
template <int Degree>
bool World<Degree>::certify_next(bool contact, bool wall) {
  if (contact && pairs_[contacts_.top().slot].estimated) {
    certify_contact(contacts_.top().slot);
    return true;
  }
  if (wall && bodies_[walls_.top().slot].wall_estimated) {
    certify_wall(walls_.top().slot);
    return true;
  }
  return false;
}

template <int Degree>
void World<Degree>::advance_to(double t) {
  require_idle("World::advance_to");
  require_ahead("World::advance_to", t, clock_);
  while (step(t)) {
  }
}

template <int Degree>
bool World<Degree>::advance_for(double budget_seconds, double t) {
  using Clock = std::chrono::steady_clock;
  require_idle("World::advance_for");
  require_ahead("World::advance_for", t, clock_);
  if (!(budget_seconds >= 0)) {
    throw std::invalid_argument("World::advance_for: a budget of " + std::to_string(budget_seconds) + " s is not >= 0");
  }
  const auto deadline = Clock::now() + std::chrono::duration<double>(budget_seconds);
  while (step(t)) {
    if (Clock::now() >= deadline) return false;
  }
  return true;
}

/// All that are due at once: bodies that jump together are not apart in between.
template <int Degree>
void World<Degree>::start_pieces() {
  struct Due {
    BodyId id;
    bool jumps;
  };
  std::vector<Due> due;
  while (!pieces_.empty() && pieces_.top().time == now_) {
    const BodyId id = pieces_.top().slot;
    Body& b = bodies_[id];
    auto& script = b.extras->script;
    const bool jumps = b.entered && is_jump(id, script.back());
    if (jumps) resting_.drop_all(id);
    movers_[id].motion = script.back();
    if constexpr (Degree >= 2) b.force = script.back().coefficients[2];
    script.pop_back();
    if (script.empty()) {
      pieces_.clear(id);
    } else {
      pieces_.set(id, script.back().start);
    }
    due.push_back({id, jumps});
  }
  for (const auto& [id, jumps] : due) {
    if (bodies_[id].entered) {
      ++counters_.motion_updates;
      set_motion(id, Motion(movers_[id].motion), jumps);
      resting_.disturb(id);
    } else {
      entering_.push_back(id);
    }
  }
}

/// True if the volume is one that a caller gives: that is an event.
template <int Degree>
bool World<Degree>::renew_volume(BodyId id) {
  update_volume(id, renewed_box(id));
  return caller_makes_box(id);
}

template <int Degree>
void World<Degree>::report_next() {
  const Reports::Report event = reports_.take_first();
  PairEvent pair{event.a, event.b, event.contact};
  switch (event.kind) {
    case Reports::Kind::overlap:
      ++counters_.overlaps;
      return tell([&](Listener& listener) { listener.overlap(*this, pair); });
    case Reports::Kind::separation:
      ++counters_.separations;
      return tell([&](Listener& listener) { listener.separation(*this, pair); });
    case Reports::Kind::held:
      return tell([&](Listener& listener) { listener.held(*this, pair); });
    case Reports::Kind::moved:
      return tell([&](Listener& listener) { listener.moved(*this, event.a); });
    case Reports::Kind::pair_began:
      return tell([&](Listener& listener) { listener.pair_began(*this, event.a, event.b, event.contact.time); });
    case Reports::Kind::pair_ended:
      return tell([&](Listener& listener) { listener.pair_ended(*this, event.a, event.b, event.contact.time); });
  }
}

/// Callers have changed something: what was known of the time until the next event is not. Edits by callbacks are
/// counted, so that a run ends.
template <int Degree>
void World<Degree>::count_edit() {
  idle_until_ = next_time_ = -never;
  if (stepping_) edits_.count(now_, options_.zeno.interval, std::max<std::uint64_t>(options_.most_edits, 64 * alive_));
}

template <int Degree>
WorldCounters World<Degree>::counters() const {
  WorldCounters counters = counters_;
  counters.broad_phase = counters_.broad_phase + broad_phase_->counters();  // and those of before it was loaded
  return counters;
}

template class World<1>;
template class World<2>;

}  // namespace kds::collision
