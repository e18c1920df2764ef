#include "collision/parallel/parallel_world.hpp"

#include "collision/in_parts.hpp"
#include "collision/parallel/division.hpp"
#include "collision/parallel/domain.hpp"
#include "collision/parallel/relayed_events.hpp"
#include "collision/parallel/window_length.hpp"
#include "kds/raised_flag.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace kds::collision {

void validate(const ParallelOptions& options) {
  const auto fail = [](const char* what) { throw std::invalid_argument(std::string("ParallelOptions.") + what); };
  if (options.domains > most_domains) fail("domains: must be at most 64");
  if (!(options.halo > 0 && std::isfinite(options.halo))) fail("halo: must be > 0 and finite");
  if (!(options.longest_window > 0)) fail("longest_window: must be > 0");
}

namespace {

using detail::DomainEvent;
using detail::EventMerge;

const ParallelOptions& validated(const ParallelOptions& options) {
  validate(options);
  return options;
}

}  // namespace

/// Runs the scene in windows, or as one world.
template <class BodyMotionType>
class BasicParallelWorld<BodyMotionType>::Runner final {
 public:
  Runner(const WorldOptions& options, const ParallelOptions& parallel, ParallelListener* listener)
      : options_(options),
        parallel_(validated(parallel)),
        threads_(parallel.threads > 0 ? parallel.threads : std::max(1u, std::thread::hardware_concurrency())),
        listener_(listener),
        relayed_(listener, counters_),
        world_(options, &relayed_),
        store_(detail::EngineOf<Motion>::of(world_)),
        now_(options.start_time) {}

  World& whole() {
    require_outside("ParallelWorld::whole");
    if (!events_.empty()) {
      throw std::logic_error(
          "ParallelWorld::whole: a listener has thrown, and the events after that are still to be told, "
          "by advance_to()");
    }
    if (divided()) gather();
    return world_;
  }
  const World& world() const { return world_; }
  bool divided() const { return !domains_.empty(); }
  std::size_t domains() const { return divided() ? domains_.size() : 1; }
  double now() const { return now_; }
  const ParallelCounters& counters() const { return counters_; }
  WorldCounters work() const {
    WorldCounters all = work_ + world_.counters();
    for (const auto& domain : domains_) all = all + domain->work();
    return all;
  }

  void advance_to(double t) {
    require_outside("ParallelWorld::advance_to");
    if (!(t >= now_ && t != never)) {
      throw std::invalid_argument("ParallelWorld::advance_to: " + std::to_string(t) +
                                  " is not a finite time from now on (" + std::to_string(now_) + ")");
    }
    if (!divided() && world_.now() != now_) {
      throw std::logic_error("ParallelWorld::advance_to: the whole world has been advanced by itself");
    }
    tell_events();
    do {
      if (!divided() && !divide()) {
        run_whole(t);
      } else {
        run_window(t);
      }
      tell_events();
    } while (now_ < t);
  }

 private:
  using Overlap = typename Engine<Motion>::Overlap;

  void require_outside(const char* function) const {
    if (telling_) throw std::logic_error(std::string(function) + ": must not be called from within a callback");
  }

  template <class Work>
  void in_domains(const Work& work) {
    in_turn(domains_.size(), threads_, work);
  }

  // One world.

  /// A stretch of time as one world, up to t. Each is longer than the one before, until the scene can be divided.
  void run_whole(double t) {
    const double end = stretch_ > 0 && now_ + stretch_ > now_ ? std::min(t, now_ + stretch_) : t;
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

  /// Divides the scene; false if it is to be run as one world.
  bool divide() {
    if (domains_wanted(parallel_, threads_, world_.size()) < 2) {
      stretch_ = 0;
      return false;
    }
    if (!unstarted_) {  // What callers have changed at this time has its consequences first.
      const kds::detail::RaisedFlag telling(telling_);
      world_.advance_to(now_);
    }
    if (!store_.is_divisible()) return false;
    auto division = collision::divide(store_.bodies(), now_, parallel_, threads_);
    if (!division) return false;
    division_ = std::make_unique<Division>(std::move(*division));
    if (!(length_.seconds() > 0)) {
      const double fastest = division_->greatest_speed + std::sqrt(division_->greatest_bend * division_->halo);
      length_ = WindowLength(fastest > 0 ? division_->room() / (4 * fastest) : parallel_.longest_window);
    }
    overlaps_ = store_.overlaps();
    store_.set_aside();
    make_domains();
    ++counters_.divisions;
    windows_since_division_ = 0;
    return true;
  }

  /// The scene is one world again.
  void gather() {
    end_domains();
    division_.reset();
    store_.go_on(now_, overlaps_);
  }

  /// A path may leave the chord between two of its places by this much; windows are so short that it is far less than
  /// the halo.
  void begin_window() {
    window_begun_ = now_;
    longest_ = parallel_.longest_window;
    const double bend = division_->greatest_bend;
    if (bend > 0) longest_ = std::min(longest_, std::sqrt(division_->halo / bend));
    division_->bulge = bend > 0 ? bend * longest_ * longest_ / 4 : 0;
  }

  void end_domains() {
    for (const auto& domain : domains_) work_ = work_ + domain->work();
    domains_.clear();
  }

  void make_domains() {
    begin_window();
    const std::size_t count = division_->partition.size();
    std::vector<std::vector<BodySlot>> known(count);
    for (BodySlot number = 0; number < division_->known.size(); ++number) {
      for (std::size_t i = 0; i < count; ++i) {
        if ((division_->known[number] & domain_bit(i)) != 0) known[i].push_back(number);
      }
    }
    end_domains();
    domains_.resize(count);
    in_domains([&](std::size_t i) {
      domains_[i] = std::make_unique<Domain<Motion>>(options_, *division_, i, now_, listener_ != nullptr);
      domains_[i]->exchange({}, known[i], store_, overlaps_);
      domains_[i]->begin_window();
    });
  }

  // Windows.

  /// How much of the halo was needed: more than 1 if the window does not hold.
  double halo_used() const {
    double used = 0;
    for (std::size_t i = 0; i < domains_.size(); ++i) {
      double nearest = domains_[i]->nearest_wrong();
      for (const auto& other : domains_) nearest = std::min(nearest, other->nearest(i));
      const double reach = domains_[i]->overshoot() + 2 * division_->greatest_radius + division_->margin();
      if (!(reach <= division_->halo && nearest > reach)) return 2;
      used = std::max(used, 1 - (nearest - reach) / division_->room());
    }
    return used;
  }

  /// A step of a window, up to t.
  void run_window(double t) {
    const double end = std::min({t, now_ + length_.step(), window_begun_ + longest_});
    if (!(end > now_ || t == now_)) return run_undivided(t);  // Steps would be shorter than a rounding of the clock.
    try {
      in_domains([&](std::size_t i) { domains_[i]->run(end); });
    } catch (...) {
      gather();  // as it was at now_
      throw;
    }
    double used = 2;
    const auto all = [&](bool (Domain<Motion>::*what)() const) {
      return std::all_of(domains_.begin(), domains_.end(), [&](const auto& domain) { return (*domain.*what)(); });
    };
    if (all(&Domain<Motion>::went_through)) {
      in_domains([&](std::size_t i) { domains_[i]->compare(domains_); });
      used = halo_used();
    }
    if (used <= 1) {
      commit(end);
      stretch_ = 0;
      const double elapsed = now_ - window_begun_;
      if (length_.goes_on(elapsed, used) && now_ < window_begun_ + longest_) return;
      length_.held(elapsed, used);
      ++counters_.windows;
      return exchange();
    }
    ++counters_.windows_failed;
    constexpr std::size_t most_failures = 6;
    if (!all(&Domain<Motion>::is_divisible) || length_.failures() >= most_failures) return run_undivided(t);
    length_.failed();
    assign_bodies(*division_, store_.bodies(), now_);
    make_domains();
  }

  /// A stretch of time that no windows lead through.
  void run_undivided(double t) {
    stretch_ = std::max(stretch_, 4 * length_.seconds());
    length_ = WindowLength(length_.seconds());
    gather();
    run_whole(t);
  }

  void commit(double end) {
    std::vector<Overlap> overlaps;
    for (const auto& domain : domains_) {
      const auto of_domain = domain->overlaps();
      overlaps.insert(overlaps.end(), of_domain.begin(), of_domain.end());
    }
    // Those of bodies at rest are told by all that know both.
    std::sort(overlaps.begin(), overlaps.end(),
              [](const Overlap& a, const Overlap& b) { return std::pair(a.a, a.b) < std::pair(b.a, b.b); });
    overlaps.erase(std::unique(overlaps.begin(), overlaps.end(),
                               [](const Overlap& a, const Overlap& b) { return a.a == b.a && a.b == b.b; }),
                   overlaps.end());
    overlaps_ = std::move(overlaps);
    if (std::exchange(unstarted_, false)) store_.note_entered();
    in_domains([&](std::size_t i) { domains_[i]->commit(store_); });
    for (const auto& domain : domains_) {
      domain->commit_meetings(store_);
      counters_.overlaps += domain->told()[0], counters_.wall_contacts += domain->told()[1];
      counters_.contacts += domain->told()[2], counters_.separations += domain->told()[3];
      counters_.events_computed += domain->computed();
      counters_.bodies_owned += domain->owned(), counters_.bodies_known += domain->known();
    }
    now_ = end;
    if (!listener_) return;
    std::vector<std::vector<DomainEvent>> logs;
    for (const auto& domain : domains_) logs.push_back(domain->take_events());
    events_ = EventMerge(std::move(logs));
  }

  /// Bodies that have moved get other owners, and copies are made, corrected and dropped.
  void exchange() {
    if (++windows_since_division_ % 16 == 0 && unbalanced()) return divide_anew();
    std::vector<std::vector<BodySlot>> go(domains_.size()), come(domains_.size());
    for (std::size_t i = 0; i < domains_.size(); ++i) {
      for (const BodySlot number : domains_[i]->wrong()) go[i].push_back(number), come[i].push_back(number);
      counters_.copies_corrected += domains_[i]->wrong().size();
    }
    in_domains([&](std::size_t i) { domains_[i]->find_moves(); });
    for (const auto& domain : domains_) {
      for (const auto& move : domain->moves()) {
        const DomainMask before = division_->known[move.number];
        for (std::size_t i = 0; i < domains_.size(); ++i) {
          const bool knew = (before & domain_bit(i)) != 0, knows = (move.known & domain_bit(i)) != 0;
          if (knew == knows) continue;
          counters_.copies_made += knows;
          if (knows) {
            come[i].push_back(move.number);
          } else if (std::binary_search(domains_[i]->wrong().begin(), domains_[i]->wrong().end(), move.number)) {
            std::erase(come[i], move.number);
          } else {
            go[i].push_back(move.number);
          }
        }
        division_->owner[move.number] = move.owner;
        division_->known[move.number] = move.known;
      }
    }
    begin_window();
    in_domains([&](std::size_t i) {
      std::sort(come[i].begin(), come[i].end());
      domains_[i]->exchange(go[i], come[i], store_, overlaps_);
      domains_[i]->begin_window();
    });
  }

  void divide_anew() {
    auto division = collision::divide(store_.bodies(), now_, parallel_, threads_);
    if (!division) return gather();
    end_domains();
    *division_ = std::move(*division);
    ++counters_.divisions;
    make_domains();
  }

  bool unbalanced() const {
    std::size_t most = 0, all = 0;
    for (const auto& domain : domains_) most = std::max(most, domain->owned()), all += domain->owned();
    return most * domains_.size() > all + all / 2;
  }

  void tell_events() {
    const kds::detail::RaisedFlag telling(telling_);
    const auto& bodies = store_.bodies();
    while (!events_.empty()) {
      const DomainEvent& event = events_.take_next();
      const auto user_data = [&](BodySlot slot) { return bodies[slot].user_data; };
      if (event.kind == DomainEvent::Kind::wall) {
        listener_->wall({bodies.id_of(event.a), static_cast<int>(event.b), event.contact, user_data(event.a)});
        continue;
      }
      const PairEvent pair{bodies.id_of(event.a), bodies.id_of(event.b), event.contact, user_data(event.a),
                           user_data(event.b)};
      if (event.kind == DomainEvent::Kind::contact) listener_->contact(pair);
      if (event.kind == DomainEvent::Kind::separation) listener_->separation(pair);
      if (event.kind == DomainEvent::Kind::overlap) listener_->overlap(pair);
    }
  }

  const WorldOptions options_;
  const ParallelOptions parallel_;
  const std::size_t threads_;
  ParallelListener* listener_;
  ParallelCounters counters_;
  RelayedEvents<Motion> relayed_;
  World world_;            ///< runs the scene while it is one world; else only its bodies count
  Engine<Motion>& store_;  ///< of world_
  double now_;
  std::unique_ptr<Division> division_;
  std::vector<std::unique_ptr<Domain<Motion>>> domains_;  ///< none while the scene is one world
  std::vector<Overlap> overlaps_;  ///< pairs that overlap at now_, by numbers, while the scene is divided
  EventMerge events_;              ///< that have not been told yet
  WindowLength length_;
  double window_begun_ = 0;  ///< s
  double longest_ = 0;       ///< s: the longest that the window may be
  double stretch_ = 0;       ///< s: how long the scene is run as one world before it is divided again; 0: to the end
  std::size_t windows_since_division_ = 0;
  WorldCounters work_;     ///< of domains that there were
  bool unstarted_ = true;  ///< no body has entered
  bool telling_ = false;
};

template <class Motion>
BasicParallelWorld<Motion>::BasicParallelWorld(const WorldOptions& options, const ParallelOptions& parallel,
                                               ParallelListener* listener)
    : runner_(std::make_unique<Runner>(options, parallel, listener)) {}

template <class Motion>
BasicParallelWorld<Motion>::~BasicParallelWorld() = default;

template <class Motion>
typename BasicParallelWorld<Motion>::World& BasicParallelWorld<Motion>::whole() {
  return runner_->whole();
}

template <class Motion>
void BasicParallelWorld<Motion>::advance_to(double t) {
  runner_->advance_to(t);
}

template <class Motion>
double BasicParallelWorld<Motion>::now() const {
  return runner_->now();
}

template <class Motion>
std::size_t BasicParallelWorld<Motion>::size() const {
  return runner_->world().size();
}

template <class Motion>
const Motion& BasicParallelWorld<Motion>::motion(BodyId id) const {
  return runner_->world().motion(id);
}

template <class Motion>
std::size_t BasicParallelWorld<Motion>::domains() const {
  return runner_->domains();
}

template <class Motion>
ParallelCounters BasicParallelWorld<Motion>::counters() const {
  return runner_->counters();
}

template <class Motion>
WorldCounters BasicParallelWorld<Motion>::work() const {
  return runner_->work();
}

template <class Motion>
std::string_view BasicParallelWorld<Motion>::broad_phase() const {
  return runner_->world().broad_phase();
}

template class BasicParallelWorld<certificates::PointMotion<1>>;
template class BasicParallelWorld<certificates::PointMotion<2>>;

}  // namespace kds::collision
