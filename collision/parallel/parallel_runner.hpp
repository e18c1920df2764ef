// The implementation of a ParallelWorld: windows, and stretches as one world.
#pragma once

#include "collision/parallel/division.hpp"
#include "collision/parallel/domains.hpp"
#include "collision/parallel/parallel_world.hpp"
#include "collision/parallel/relayed_events.hpp"
#include "collision/parallel/untold_events.hpp"
#include "collision/parallel/window_length.hpp"
#include "collision/world/engine_image.hpp"
#include "kds/number_text.hpp"
#include "kds/raised_flag.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

namespace kds::collision {

namespace detail {

/// Each of several processes has one thread unless the options say otherwise: as a rule there is one process for each
/// core.
inline std::size_t threads_of_one(const ParallelOptions& options, const Team& team) {
  if (options.threads > 0) return options.threads;
  return team.count() > 1 ? 1 : std::max(1u, std::thread::hardware_concurrency());
}

inline const ParallelOptions& validated(const ParallelOptions& options) {
  validate(options);
  return options;
}

}  // namespace detail

/// Runs the scene in windows, or as one world.
template <class BodyMotionType>
class BasicParallelWorld<BodyMotionType>::Runner final {
 public:
  Runner(const WorldOptions& options, const ParallelOptions& parallel, ParallelListener* listener, Processes* processes)
      : parallel_(detail::validated(parallel)),
        team_(processes),
        threads_(detail::threads_of_one(parallel, team_)),
        listener_(team_.rank() == 0 ? listener : nullptr),
        relayed_(listener_, counters_),
        world_(options, &relayed_),
        store_(detail::EngineOf<Motion>::of(world_)),
        now_(options.start_time),
        domains_(options, threads_, store_, team_),
        logs_(records(listener)),
        responds_(options.response != Response::callback || options.law) {}

  World& whole() {
    require_told("ParallelWorld::whole");
    if (apart()) gather(now_);
    return world_;
  }
  const World& world() const { return world_; }
  std::string_view broad_phase() const {
    const std::string_view of_domain = domains_.broad_phase();
    return of_domain.empty() ? world_.broad_phase() : of_domain;
  }
  void add_shares(std::size_t count, const std::function<Description(std::size_t)>& body) {
    require_outside("ParallelWorld::add_shares");
    if (world_.size() > 0) throw std::logic_error("ParallelWorld::add_shares: there are bodies already");
    domains_.add_shares(count, body, now_);
  }
  template <class Archive>
  void archive(Archive& archive) {
    whole().archive(archive);
    if constexpr (Archive::loading) begin_at(world_.now());
  }
  kds::Snapshot save_parts(const WriteBodies& write, std::size_t bodies_in_block) {
    require_told("ParallelWorld::save_parts");
    if (apart()) return domains_.save(now_, write, std::max<std::size_t>(1, bodies_in_block));
    return team_.rank() == 0 ? kds::save(world_) : kds::Snapshot();
  }
  void load_parts(const kds::Snapshot& rest, const ReadBodies& read) {
    require_told("ParallelWorld::load_parts");
    typename Engine<Motion>::Image image;
    kds::detail::Reader reader(rest.bytes());
    store_.archive(reader, image);
    kds::detail::Reader::require(reader.at_end(), "there is more in it than was asked for");
    if (image.bodies.lent()) {
      domains_.load(image, read);
      if (team_.count() == 1) gather(image.now);
    } else {
      domains_.leave();
      domains_.store().put_part(nullptr);
      store_.become(image);
    }
    begin_at(image.callers_now);
  }
  void change(std::function<void(World&)> change) {
    if (!telling_) throw std::logic_error("ParallelWorld::change: must be called from within a callback; else whole()");
    if (team_.count() > 1) {
      throw std::logic_error("ParallelWorld::change: several processes run the scene, and this is called in one");
    }
    relayed_.add_change(std::move(change));
  }
  bool divided() const { return domains_.any(); }
  /// Whether the bodies are not in the whole world.
  bool apart() const { return divided() || domains_.store().is_part(); }
  std::size_t domains() const { return domains_.size(); }
  std::size_t stored() const { return domains_.store().bodies().size(); }
  double now() const { return now_; }
  const ParallelCounters& counters() const { return counters_; }
  WorldCounters work() const { return domains_.work() + world_.counters(); }
  const MessageCounters& messages() const { return team_.counters(); }
  const Motion& motion(BodyId id) const {
    const BodyStore<Motion>& store = domains_.store();
    if (!store.is_part() || !store_.bodies().has_lent(id)) return world_.motion(id);
    if (!domains_.has(body_slot(id))) {
      throw std::logic_error("ParallelWorld::motion: the body is owned by another process; whole() has all");
    }
    return store.bodies().motion(store.find(body_slot(id)));
  }

  void advance_to(double t) {
    require_outside("ParallelWorld::advance_to");
    if (!(t >= now_ && t != never)) {
      throw std::invalid_argument("ParallelWorld::advance_to: " + number_text(t) +
                                  " is not a finite time from now on (" + number_text(now_) + ")");
    }
    if (!apart() && world_.now() != now_) {
      throw std::logic_error("ParallelWorld::advance_to: the whole world has been advanced by itself");
    }
    do {
      if (untold_.any()) {
        finish_step(t);
      } else if (!divided() && !divide(t)) {
        run_whole(t);
      } else {
        run_window(t);
      }
    } while (now_ < t);
  }

 private:
  bool records(const ParallelListener* listener) {
    const bool apart = parallel_.steps != nullptr;
    if ((team_.of_first(apart ? 1 : 0) != 0) != apart) {
      throw std::invalid_argument("ParallelOptions.steps: either all processes have one or none");
    }
    return team_.of_first(listener ? 1 : 0) != 0 || apart;
  }

  /// Threads of all processes.
  std::size_t workers() const { return threads_ * team_.count(); }

  void require_outside(const char* function) const {
    if (telling_) throw std::logic_error(std::string(function) + ": must not be called from within a callback");
  }

  void require_told(const char* function) const {
    require_outside(function);
    if (!untold_.any()) return;
    throw std::logic_error(std::string(function) +
                           ": a listener has thrown, and the events after that are still to be told, by advance_to()");
  }
  /// After a state has been loaded.
  void begin_at(double now) {
    now_ = now;
    counters_ = {};
    length_ = WindowLength();
    stretch_ = 0;
    unstarted_ = false;
  }

  // One world.

  /// A stretch of time as one world, up to t, and to `least` at least. Each is longer than the one before, until the
  /// scene can be divided.
  void run_whole(double t, double least = -never) {
    if (apart()) gather(now_);
    const double end = std::max(stretch_ > 0 && now_ + stretch_ > now_ ? std::min(t, now_ + stretch_) : t, least);
    stretch_ *= 2;
    ++counters_.stretches_whole;
    unstarted_ = false;
    const kds::detail::RaisedFlag telling(telling_);
    try {
      world_.advance_to(end);
    } catch (...) {
      now_ = world_.now();
      throw;
    }
    now_ = end;
  }

  // Division.

  /// Divides the scene, which is to be run up to t; false if it is to be run as one world.
  bool divide(double t) {
    if (!responds_ || domains_wanted(parallel_, workers(), world_.size()) < 2) {
      stretch_ = 0;
      return false;
    }
    // Who is to know bodies that lean on each other is found where all of them are known.
    if (apart() && !team_.all(!domains_.any_islands())) gather(now_);
    if (!unstarted_ && !apart()) {  // What callers have changed at this time has its consequences first.
      const kds::detail::RaisedFlag telling(telling_);
      world_.advance_to(now_);
    }
    if (!team_.all(domains_.store().engine().transfer().is_divisible())) {
      constexpr double first_stretch = 0x1p-6;  // of the time that there is; later ones are longer
      if (stretch_ == 0) stretch_ = first_stretch * (t - now_);
      return false;
    }
    const std::vector<BodySlot> answered = domains_.answered();
    auto division = find_division(answered);
    if (!division) return false;
    if (!(length_.seconds() > 0)) {
      const double fastest = division->greatest_speed + division->halo / division->straight_for;
      length_ = WindowLength(fastest > 0 ? division->room() / (4 * fastest) : parallel_.longest_window);
    }
    auto overlaps = apart() ? domains_.take_overlaps() : store_.transfer().overlaps();
    if (!apart()) store_.transfer().set_aside();
    domains_.begin(std::move(*division), answered, std::move(overlaps), logs_, now_);
    if (!team_.all(domains_.carriers_are_known())) {
      gather(now_);
      return false;
    }
    begin_window();
    domains_.make(now_);
    ++counters_.divisions;
    windows_since_division_ = 0;
    return true;
  }

  /// `answered`: as Domains::answered().
  std::optional<Division> find_division(std::span<const BodySlot> answered) {
    const Engine<Motion>& engine = domains_.store().engine();
    return collision::divide(engine.bodies(), engine.parts().scripts, answered, now_, parallel_, workers(), team_);
  }

  /// The scene is one world again, in every process.
  void gather(double now) {
    const auto overlaps = domains_.end();
    store_.transfer().go_on(now, overlaps);
  }

  /// Windows are so short that paths hardly bend.
  void begin_window() {
    window_begun_ = now_;
    window_events_ = 0;
    longest_ = std::min(parallel_.longest_window, domains_.division().straight_for);
    domains_.set_window_end(window_begun_ + longest_);
  }

  // Windows.

  /// A step of a window, up to t.
  void run_window(double t) {
    const double end = std::min({t, now_ + length_.step(), window_begun_ + longest_});
    if (!(end > now_ || t == now_)) return run_undivided(t);  // Steps would be shorter than a rounding of the clock.
    try {
      domains_.run(end);
    } catch (...) {
      if (team_.count() == 1) gather(now_);
      throw;
    }
    if (domains_.outcome().holds()) {
      take_events(end);
      return finish_step(t);
    }
    ++counters_.windows_failed;
    constexpr std::size_t most_failures = 6;
    if (!domains_.outcome().divisible || length_.failures() >= most_failures) return run_undivided(t);
    length_.failed();
    domains_.end_window(now_);
    begin_window();
    domains_.make(now_);
  }

  /// After a step that holds, up to `end`.
  void take_events(double end) {
    std::optional<StepEvents> step;
    if (parallel_.steps) step = domains_.take_step();
    EventMerge events;
    if (!parallel_.steps) events = domains_.take_events();
    untold_.begin(end, std::move(events), store_.parts().timers.due(end), std::move(step));
  }

  /// Tells of the events of a step, and commits it, unless the listener has asked for a change: then nothing that
  /// follows has happened yet.
  void finish_step(double t) {
    {
      const kds::detail::RaisedFlag telling(telling_);
      untold_.tell(listener_, parallel_.steps, [this] { return relayed_.awaits_change(); });
    }
    const double end = untold_.finish();
    if (relayed_.awaits_change()) return run_to_change(t);
    const double used = domains_.outcome().halo_used;
    commit(end);
    stretch_ = 0;
    const double elapsed = now_ - window_begun_;
    // Where bodies hop on their places they use up no halo, but what is compared is all that they have done in it.
    constexpr std::uint64_t most_events = 16;  // of each body that is known
    const bool lasts = window_events_ <= most_events * domains_.outcome().known;
    if (length_.goes_on(elapsed, used) && lasts && now_ < window_begun_ + longest_) return;
    length_.held(elapsed, used);
    ++counters_.windows;
    end_window();
  }

  /// Runs the scene from the beginning of the step as one world. The events that have been told are not told again; at
  /// the last of them the change is made.
  void run_to_change(double t) {
    ++counters_.windows_failed;
    relayed_.pass_over(untold_.told());
    stretch_ = std::max({stretch_, untold_.told_until() - now_, length_.step()});
    gather(now_);
    run_whole(t, untold_.told_until());
  }

  /// Runs a stretch of time through which windows do not get.
  void run_undivided(double t) {
    stretch_ = std::max(stretch_, 4 * length_.seconds());
    length_ = WindowLength(length_.seconds());
    gather(now_);
    run_whole(t);
  }

  void commit(double end) {
    unstarted_ = false;
    domains_.commit(end);
    const StepOutcome& outcome = domains_.outcome();
    counters_.overlaps += outcome.told[0], counters_.wall_contacts += outcome.told[1];
    counters_.contacts += outcome.told[2], counters_.separations += outcome.told[3];
    counters_.events_computed += outcome.computed, counters_.events_of_busiest += outcome.most_computed;
    counters_.bodies_owned += outcome.owned, counters_.bodies_known += outcome.known;
    counters_.copies_made += outcome.copies_made;
    ++counters_.steps;
    window_events_ += outcome.computed;
    now_ = end;
  }

  void end_window() {
    if (++windows_since_division_ % 16 == 0 && unbalanced()) return divide_anew();
    counters_.copies_corrected += domains_.outcome().wrong;
    domains_.end_window(now_);
    begin_window();
    domains_.exchange();
  }

  void divide_anew() {
    if (team_.count() > 1 && !team_.all(!domains_.any_islands())) return gather(now_);
    const std::vector<BodySlot> answered = domains_.answered();
    auto division = find_division(answered);
    if (!division) return gather(now_);
    domains_.begin(std::move(*division), answered, domains_.take_overlaps(), logs_, now_);
    if (!team_.all(domains_.carriers_are_known())) return gather(now_);
    begin_window();
    domains_.make(now_);
    ++counters_.divisions;
  }

  bool unbalanced() const {
    const std::uint64_t most = domains_.outcome().most_owned, all = domains_.outcome().owned;
    return most * domains_.size() > all + all / 2;
  }

  const ParallelOptions parallel_;
  Team team_;
  const std::size_t threads_;  ///< of this process
  ParallelListener* listener_;
  ParallelCounters counters_;
  RelayedEvents<Motion> relayed_;
  World world_;            ///< runs the scene while it is one world; else has its bodies, or lends them
  Engine<Motion>& store_;  ///< of world_
  double now_;
  Domains<Motion> domains_;  ///< none while the scene is one world
  const bool logs_;          ///< whether domains record events
  UntoldEvents untold_;
  WindowLength length_;
  double window_begun_ = 0;          ///< s
  std::uint64_t window_events_ = 0;  ///< computed in it by all domains
  double longest_ = 0;               ///< s: the longest that the window may be
  double stretch_ = 0;  ///< s: how long the scene is run as one world before it is divided again; 0: to the end
  std::size_t windows_since_division_ = 0;
  const bool responds_;    ///< whether motions after contacts are known without a listener
  bool unstarted_ = true;  ///< no body has entered
  bool telling_ = false;
};

}  // namespace kds::collision
