#include "collision/parallel/domains.hpp"

#include "collision/in_parts.hpp"

#include <algorithm>
#include <bit>
#include <iterator>
#include <span>
#include <utility>

namespace kds::collision {

/// A body as its owner has it.
template <class Motion>
struct Domains<Motion>::News {
  BodySlot number;
  BodyProgress<Motion> progress;
  bool met;

  template <class Archive>
  void archive(Archive& archive) {
    archive(number, progress.motion, progress.meetings, progress.burst_start, met);
  }
};

template <class Motion>
Domains<Motion>::Domains(const WorldOptions& options, std::size_t threads, Engine<Motion>& store, Team& team)
    : options_(options), threads_(threads), store_(store), team_(team) {}

template <class Motion>
template <class Work>
void Domains<Motion>::in_each(const Work& work) {
  in_turn(domains_.size(), threads_, [&](std::size_t i) { work(*domains_[i]); });
}

template <class Motion>
bool Domains<Motion>::went_through() const {
  return std::all_of(reports_.begin(), reports_.end(), [](const auto& report) { return report.went_through(); });
}

template <class Motion>
bool Domains<Motion>::is_divisible() const {
  return std::all_of(reports_.begin(), reports_.end(), [](const auto& report) { return report.divisible; });
}

template <class Motion>
bool Domains<Motion>::has(BodySlot number) const {
  return !any() || division_->owner[number] == Division::nobody || is_here(division_->owner[number]);
}

template <class Motion>
void Domains<Motion>::begin(Division division, std::vector<Overlap> overlaps, bool logs) {
  drop();
  division_ = std::make_unique<Division>(std::move(division));
  overlaps_ = std::move(overlaps);
  logs_ = logs;
  of_process_.assign(team_.count(), 0);
  for (std::size_t i = 0; i < size(); ++i) of_process_[process_of(i)] |= domain_bit(i);
  changed_.clear();
}

template <class Motion>
std::vector<typename Domains<Motion>::Overlap> Domains<Motion>::end() {
  drop();
  division_.reset();
  return std::exchange(overlaps_, {});
}

template <class Motion>
void Domains<Motion>::drop() {
  for (const auto& domain : domains_) work_ = work_ + domain->work();
  domains_.clear();
}

template <class Motion>
void Domains<Motion>::make(double now) {
  drop();
  heard_.assign(size(), {});
  reports_.assign(size(), {});
  for (std::size_t i = 0; i < size(); ++i) {
    if (is_here(i)) domains_.push_back(std::make_unique<Domain<Motion>>(options_, *division_, i, now, logs_));
  }
  std::vector<std::vector<BodySlot>> known(size());
  for (BodySlot number = 0; number < division_->known.size(); ++number) {
    for (const auto& domain : domains_) {
      if ((division_->known[number] & domain_bit(domain->index())) != 0) known[domain->index()].push_back(number);
    }
  }
  in_each([&](Domain<Motion>& domain) {
    domain.exchange({}, known[domain.index()], store_, overlaps_);
    domain.begin_window();
  });
}

// A step.

template <class Motion>
void Domains<Motion>::run(double until) {
  in_each([&](Domain<Motion>& domain) { domain.run(until); });
  share_step();
  if (went_through()) {
    std::vector<std::span<const Change>> changes;
    for (const auto& heard : heard_) changes.push_back(heard.all());
    for (const auto& domain : domains_) changes[domain->index()] = domain->changes();
    in_each([&](Domain<Motion>& domain) { domain.compare(changes); });
  }
  share_reports();
}

/// Each process learns whether the step has gone through everywhere, and the motions that others have found for bodies
/// that it knows.
template <class Motion>
void Domains<Motion>::share_step() {
  for (const auto& domain : domains_) reports_[domain->index()] = domain->report();
  team_.exchange(
      [&](std::size_t process, auto& writer) {
        for (const auto& domain : domains_) {
          std::vector<Change> changes;
          bool divisible = domain->report().divisible, stayed = domain->report().stayed;
          for (const Change& change : domain->fresh()) {
            if (divisible && division_->owner[change.number] == domain->index() &&
                (division_->known[change.number] & of_process_[process]) != 0)
              changes.push_back(change);
          }
          writer(divisible, stayed, changes);
        }
      },
      [&](std::size_t process, auto& reader) {
        for (std::size_t i = 0; i < size(); ++i) {
          if (process_of(i) != process) continue;
          std::vector<Change> changes;
          reader(reports_[i].divisible, reports_[i].stayed, changes);
          heard_[i].append(changes);
        }
      });
}

template <class Motion>
void Domains<Motion>::share_reports() {
  for (const auto& domain : domains_) reports_[domain->index()] = domain->report();
  team_.exchange(
      [&](std::size_t, auto& writer) {
        for (const auto& domain : domains_) writer(reports_[domain->index()]);
      },
      [&](std::size_t process, auto& reader) {
        for (std::size_t i = 0; i < size(); ++i) {
          if (process_of(i) == process) reader(reports_[i]);
        }
      });
}

template <class Motion>
double Domains<Motion>::halo_used() const {
  double used = 0;
  for (std::size_t i = 0; i < size(); ++i) {
    double nearest = reports_[i].nearest_wrong;
    for (const DomainReport& other : reports_) nearest = std::min(nearest, other.nearest[i]);
    const double reach = reports_[i].overshoot + 2 * division_->greatest_radius + division_->margin();
    if (!(reach <= division_->halo && nearest > reach)) return 2;
    used = std::max(used, 1 - (nearest - reach) / division_->room());
  }
  return used;
}

template <class Motion>
void Domains<Motion>::commit() {
  overlaps_.clear();
  for (const auto& domain : domains_) {
    const auto of_domain = domain->overlaps();
    overlaps_.insert(overlaps_.end(), of_domain.begin(), of_domain.end());
  }
  sort_overlaps();
  in_each([&](Domain<Motion>& domain) { domain.commit(store_); });
  for (const auto& domain : domains_) {
    domain->commit_meetings(store_);
    if (team_.count() > 1) domain->append_changed(changed_);
  }
}

/// Those of bodies at rest are told by all that know both, and others by several processes.
template <class Motion>
void Domains<Motion>::sort_overlaps() {
  std::sort(overlaps_.begin(), overlaps_.end(),
            [](const Overlap& a, const Overlap& b) { return std::pair(a.a, a.b) < std::pair(b.a, b.b); });
  overlaps_.erase(std::unique(overlaps_.begin(), overlaps_.end(),
                              [](const Overlap& a, const Overlap& b) { return a.a == b.a && a.b == b.b; }),
                  overlaps_.end());
}

template <class Motion>
StepEvents Domains<Motion>::take_step() {
  StepEvents events{.domains = size(), .first = domains_.empty() ? 0 : domains_.front()->index()};
  for (const auto& domain : domains_) events.logs.push_back(domain->take_events());
  return events;
}

template <class Motion>
EventMerge Domains<Motion>::take_events() {
  if (!logs_) return {};
  std::vector<StepEvents> events(team_.count());
  events[team_.rank()] = take_step();
  team_.exchange(
      [&](std::size_t process, auto& writer) {
        if (process == 0) writer(events[team_.rank()].logs);
      },
      [&](std::size_t process, auto& reader) {
        if (team_.rank() == 0) reader(events[process].logs);
      });
  if (team_.rank() != 0) return {};
  std::size_t domain = 0;
  for (StepEvents& of_process : events) {
    of_process.domains = size(), of_process.first = domain;
    domain += of_process.logs.size();
  }
  return merged(std::move(events));
}

// From window to window.

template <class Motion>
void Domains<Motion>::end_window(double now) {
  std::vector<BodyMove> moves;
  for (const auto& domain : domains_) domain->append_moves(store_, now, moves);
  const std::size_t moves_here = moves.size();
  std::vector<BodyMove> others;
  team_.exchange([&](std::size_t, auto& writer) { writer(moves); },
                 [&](std::size_t, auto& reader) {
                   std::vector<BodyMove> of_process;
                   reader(of_process);
                   others.insert(others.end(), of_process.begin(), of_process.end());
                 });
  moves.insert(moves.end(), others.begin(), others.end());

  std::vector<std::vector<BodySlot>> bodies(team_.count());
  const auto is_known = [&](std::size_t process, DomainMask known) { return (known & of_process_[process]) != 0; };
  for (std::size_t i = 0; i < moves_here; ++i) {
    const DomainMask before = division_->known[moves[i].number];
    for (std::size_t process = 0; process < bodies.size(); ++process) {
      if (!is_known(process, before) && is_known(process, moves[i].known)) bodies[process].push_back(moves[i].number);
    }
  }
  note_moves(moves);
  for (const BodySlot number : changed_) {
    for (std::size_t process = 0; process < bodies.size(); ++process) {
      if (is_known(process, division_->known[number])) bodies[process].push_back(number);
    }
  }
  changed_.clear();
  tell(bodies, [&](std::size_t process, const Overlap& overlap) {
    return is_known(process, division_->known[overlap.a] & division_->known[overlap.b]);
  });
}

/// Notes who owns and knows bodies from now on, and what domains of this process are to let go and take in: copies that
/// are wrong, both.
template <class Motion>
void Domains<Motion>::note_moves(const std::vector<BodyMove>& moves) {
  go_.assign(size(), {}), come_.assign(size(), {});
  copies_made_ = 0;
  for (const auto& domain : domains_) {
    const auto wrong = domain->wrong();
    go_[domain->index()].assign(wrong.begin(), wrong.end());
    come_[domain->index()].assign(wrong.begin(), wrong.end());
  }
  for (const BodyMove& move : moves) {
    const DomainMask before = division_->known[move.number];
    copies_made_ += static_cast<std::size_t>(std::popcount(move.known & ~before));
    for (const auto& domain : domains_) {
      const std::size_t i = domain->index();
      const bool knew = (before & domain_bit(i)) != 0, knows = (move.known & domain_bit(i)) != 0;
      if (knew == knows) continue;
      if (knows) {
        come_[i].push_back(move.number);
      } else if (std::binary_search(domain->wrong().begin(), domain->wrong().end(), move.number)) {
        std::erase(come_[i], move.number);
      } else {
        go_[i].push_back(move.number);
      }
    }
    division_->owner[move.number] = move.owner;
    division_->known[move.number] = move.known;
  }
}

template <class Motion>
std::size_t Domains<Motion>::exchange() {
  for (auto& heard : heard_) heard.clear();
  in_each([&](Domain<Motion>& domain) {
    auto& come = come_[domain.index()];
    std::sort(come.begin(), come.end());
    domain.exchange(go_[domain.index()], come, store_, overlaps_);
    domain.begin_window();
  });
  return copies_made_;
}

template <class Motion>
void Domains<Motion>::share_all() {
  std::vector<std::vector<BodySlot>> bodies(team_.count());
  if (team_.count() > 1) {
    std::vector<BodySlot> here;
    for (BodySlot number = 0; number < division_->owner.size(); ++number) {
      const std::uint8_t owner = division_->owner[number];
      if (owner != Division::nobody && is_here(owner)) here.push_back(number);
    }
    bodies.assign(team_.count(), here);
  }
  tell(bodies, [](std::size_t, const Overlap&) { return true; });
}

template <class Motion>
template <class IsToKnow>
void Domains<Motion>::tell(const std::vector<std::vector<BodySlot>>& bodies, const IsToKnow& is_to_know) {
  team_.exchange(
      [&](std::size_t process, auto& writer) {
        std::vector<News> news;
        for (const BodySlot number : bodies[process])
          news.push_back({number, store_.bodies().progress(number), store_.has_met(number)});
        std::vector<Overlap> overlaps;
        std::copy_if(overlaps_.begin(), overlaps_.end(), std::back_inserter(overlaps),
                     [&](const Overlap& overlap) { return is_to_know(process, overlap); });
        writer(news, overlaps);
      },
      [&](std::size_t, auto& reader) {
        std::vector<News> news;
        std::vector<Overlap> overlaps;
        reader(news, overlaps);
        for (const News& body : news) {
          store_.go_on_from(body.number, body.progress);
          if (body.met) store_.note_meeting(body.number);
        }
        overlaps_.insert(overlaps_.end(), overlaps.begin(), overlaps.end());
      });
  sort_overlaps();
}

template <class Motion>
WorldCounters Domains<Motion>::work() const {
  WorldCounters all = work_;
  for (const auto& domain : domains_) all = all + domain->work();
  return all;
}

template class Domains<certificates::PointMotion<1>>;
template class Domains<certificates::PointMotion<2>>;

}  // namespace kds::collision
