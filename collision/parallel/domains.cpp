#include "collision/parallel/domains.hpp"

#include "collision/in_parts.hpp"
#include "collision/motions.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace kds::collision {

template <class Motion>
Domains<Motion>::Domains(const WorldOptions& options, std::size_t threads, Engine<Motion>& whole, Team& team)
    : options_(options), threads_(threads), store_(options, whole), team_(team) {}

template <class Motion>
template <class Work>
void Domains<Motion>::in_each(const Work& work) {
  in_turn(domains_.size(), threads_, [&](std::size_t i) { work(*domains_[i]); });
}

template <class Motion>
bool Domains<Motion>::has(BodySlot number) const {
  if (!any()) return !store_.is_part();
  if (store_.find(number) == no_body) return false;
  const DomainIndex owner = division_->owner_of(number);
  return owner == Division::nobody || is_here(owner);
}

template <class Motion>
void Domains<Motion>::drop() {
  for (const auto& domain : domains_) work_ = work_ + domain->work();
  domains_.clear();
}

template <class Motion>
void Domains<Motion>::make(double now) {
  drop();
  heard_.clear();
  first_ = (team_.rank() * size() + team_.count() - 1) / team_.count();
  for (std::size_t i = first_; i < size() && is_here(i); ++i) {
    domains_.push_back(std::make_unique<Domain<Motion>>(options_, *division_, i, now, logs_, i == first_));
  }
  std::vector<std::vector<BodySlot>> known(domains_.size());
  const auto& bodies = store_.bodies();
  for (BodySlot slot = 0; slot < bodies.slots(); ++slot) {
    if (!bodies.alive(slot)) continue;
    for (const DomainIndex domain : division_->sets[division_->known[slot]]) {
      if (is_here(domain)) known[domain - first_].push_back(bodies.number(slot));
    }
  }
  const auto overlaps = overlaps_by_domain();
  in_each([&](Domain<Motion>& domain) {
    const std::size_t i = domain.index() - first_;
    if (store_.is_part()) std::sort(known[i].begin(), known[i].end());
    domain.exchange({}, known[i], store_, overlaps[i]);
    domain.begin_window();
  });
}

// A step.

template <class Motion>
void Domains<Motion>::run(double until) {
  in_each([&](Domain<Motion>& domain) { domain.run(until); });
  const std::vector<double> nearest = share_step();
  // If one of another process has not gone through, what is found out here is of no use, and does no harm.
  if (std::all_of(domains_.begin(), domains_.end(), [](const auto& d) { return d->report().went_through(); }))
    compare();
  outcome_ = {};
  outcome_.copies_made = copies_made_;
  for (const auto& domain : domains_) {
    outcome_.add(domain->report(), halo_used(*domain, nearest[domain->index() - first_]));
  }
  outcome_.combine(team_);
}

/// Each process learns the motions that others have found for bodies that it knows. Returns, for each domain of this
/// one, how near to its cell bodies have come that it does not know.
template <class Motion>
std::vector<double> Domains<Motion>::share_step() {
  std::vector<double> nearest(domains_.size(), never);
  const auto come_near = [&](std::size_t domain, double distance) {
    double& of_domain = nearest[domain - first_];
    of_domain = std::min(of_domain, distance);
  };
  std::map<std::size_t, StepNews<Motion>> news;
  for (const auto& domain : domains_) {
    for (const NeighbourDomain& other : domain->neighbours()) {
      if (other.nearest == never) continue;
      if (is_here(other.domain)) {
        come_near(other.domain, other.nearest);
      } else {
        news[process_of(other.domain)].nearest.push_back({other.domain, other.nearest});
      }
    }
    if (team_.count() == 1 || !domain->report().divisible) continue;
    const auto index = static_cast<DomainIndex>(domain->index());
    for (const Change& change : domain->fresh()) {
      if (division_->owner_of(change.number) != index) continue;
      each_process(division_->knowers(change.number), [&](std::size_t process) { news[process].add(index, change); });
    }
  }
  Letters letters;
  for (auto& [process, of_process] : news) letters.to(process)(of_process);
  team_.exchange(std::move(letters), [&](std::size_t, auto& reader) {
    StepNews<Motion> heard;
    reader(heard);
    for (const NearestStranger& near : heard.nearest) come_near(near.domain, near.distance);
    for (std::size_t i = 0; i < heard.domains.size(); ++i) heard_[heard.domains[i]].append(heard.changes[i]);
  });
  return nearest;
}

template <class Motion>
void Domains<Motion>::compare() {
  in_each([&](Domain<Motion>& domain) {
    std::vector<std::span<const Change>> changes;
    for (const NeighbourDomain& other : domain.neighbours()) changes.push_back(changes_of(other.domain));
    domain.compare(changes);
  });
}

template <class Motion>
std::span<const MotionChange<Motion>> Domains<Motion>::changes_of(DomainIndex domain) const {
  if (is_here(domain)) return domains_[domain - first_]->changes();
  const auto heard = heard_.find(domain);
  return heard == heard_.end() ? std::span<const Change>() : heard->second.all();
}

/// How much of the halo a domain has needed: more than 1 if the step does not hold in it.
template <class Motion>
double Domains<Motion>::halo_used(const Domain<Motion>& domain, double nearest_stranger) const {
  const double nearest = std::min(domain.report().nearest_wrong, nearest_stranger);
  const double needed = domain.report().overshoot + division_->touching() + division_->margin();
  if (!(needed <= division_->halo && nearest > needed)) return 2;
  return std::max(0.0, 1 - (nearest - needed) / (division_->room() - domain.report().begun_outside));
}

template <class Motion>
void Domains<Motion>::commit(double now) {
  store_.note_passed(now);
  overlaps_.clear();
  for (const auto& domain : domains_) {
    const auto of_domain = domain->overlaps();
    overlaps_.insert(overlaps_.end(), of_domain.begin(), of_domain.end());
  }
  sort_overlaps();
  in_each([&](Domain<Motion>& domain) { domain.commit(store_); });
  for (const auto& domain : domains_) {
    domain->commit_resting(store_);
    if (team_.count() > 1) domain->append_changed(changed_);
  }
  copies_made_ = 0;
}

/// Those of bodies at rest are told by all that know both, and others by several processes, also to some that store
/// only one of the two.
template <class Motion>
void Domains<Motion>::sort_overlaps() {
  std::erase_if(overlaps_, [this](const Overlap& overlap) {
    return store_.find(overlap.a) == no_body || store_.find(overlap.b) == no_body;
  });
  std::sort(overlaps_.begin(), overlaps_.end(),
            [](const Overlap& a, const Overlap& b) { return std::pair(a.a, a.b) < std::pair(b.a, b.b); });
  overlaps_.erase(std::unique(overlaps_.begin(), overlaps_.end(),
                              [](const Overlap& a, const Overlap& b) { return a.a == b.a && a.b == b.b; }),
                  overlaps_.end());
}

/// For each domain of this process the pairs of which it knows both.
template <class Motion>
std::vector<std::vector<typename Domains<Motion>::Overlap>> Domains<Motion>::overlaps_by_domain() const {
  std::vector<std::vector<Overlap>> by_domain(domains_.size());
  std::vector<DomainIndex> both;
  for (const Overlap& overlap : overlaps_) {
    both.clear();
    std::ranges::set_intersection(division_->knowers(overlap.a), division_->knowers(overlap.b),
                                  std::back_inserter(both));
    for (const DomainIndex domain : both) {
      if (is_here(domain)) by_domain[domain - first_].push_back(overlap);
    }
  }
  return by_domain;
}

template <class Motion>
StepEvents Domains<Motion>::take_step() {
  StepEvents events{.domains = size(), .first = domains_.empty() ? 0 : first_};
  for (const auto& domain : domains_) events.logs.push_back(domain->take_events());
  return events;
}

template <class Motion>
EventMerge Domains<Motion>::take_events() {
  if (!logs_) return {};
  StepEvents mine = take_step();
  if (team_.rank() != 0) {
    Letters letters;
    const bool any = std::any_of(mine.logs.begin(), mine.logs.end(), [](const auto& log) { return !log.empty(); });
    if (any) letters.to(0)(mine.first, mine.logs);
    team_.exchange(std::move(letters), [](std::size_t, auto&) {});
    return {};
  }
  mine.logs.resize(size());  // The domains of process 0 are the first.
  team_.exchange({}, [&](std::size_t, auto& reader) {
    StepEvents heard;
    reader(heard.first, heard.logs);
    std::ranges::move(heard.logs, mine.logs.begin() + static_cast<std::ptrdiff_t>(heard.first));
  });
  return EventMerge(std::move(mine.logs));
}

// From window to window.

template <class Motion>
void Domains<Motion>::end_window(double now) {
  in_each([&](Domain<Motion>& domain) { domain.find_moves(store_, now); });
  go_.assign(domains_.size(), {}), come_.assign(domains_.size(), {});
  NewsByProcess news;
  add_moves(news);
  if (team_.count() > 1) add_progress(news);
  changed_.clear();
  exchange_news(letters_of(std::move(news)), [&](const WindowNews<Motion>& heard) { hear(heard); });
  if (team_.count() > 1) store_.forget(gone_);
  gone_.clear();
  sort_overlaps();
}

template <class Motion>
Letters Domains<Motion>::letters_of(NewsByProcess news) {
  Letters letters;
  for (auto& [process, of_process] : news) letters.to(process)(of_process);
  return letters;
}

/// The moves of bodies owned here: to those that knew them or are to know them, and to those that did not know them,
/// all that is known of them too.
template <class Motion>
void Domains<Motion>::add_moves(NewsByProcess& news) {
  std::vector<DomainIndex> concerned, come;
  std::map<std::size_t, std::vector<BodySlot>> newcomers;
  for (const auto& domain : domains_) {
    domain->moves().each([&](BodySlot number, DomainIndex owner, std::span<const DomainIndex> knowers) {
      const auto before = division_->knowers(number);
      concerned.clear(), come.clear();
      std::ranges::set_union(before, knowers, std::back_inserter(concerned));
      std::ranges::set_difference(knowers, before, std::back_inserter(come));
      copies_made_ += come.size();
      const auto knew = [&](std::size_t process) {
        return std::ranges::any_of(before, [&](DomainIndex domain) { return process_of(domain) == process; });
      };
      each_process(concerned, [&](std::size_t process) { news[process].moves.add(number, owner, knowers); });
      each_process(come, [&](std::size_t process) {
        if (!knew(process)) newcomers[process].push_back(store_.find(number));
      });
      note_move(number, owner, knowers);
    });
  }
  for (const auto& [process, slots] : newcomers)
    news[process].newcomers = store_.engine().transfer().pack(slots, meshes_);
}

/// What has changed of bodies owned here, and which pairs overlap: to those that are to know of them.
template <class Motion>
void Domains<Motion>::add_progress(NewsByProcess& news) {
  std::map<std::size_t, std::vector<BodySlot>> told;
  for (const auto& [process, of_process] : news) {
    told[process] = of_process.newcomers.numbers;
    std::sort(told[process].begin(), told[process].end());
  }
  std::sort(changed_.begin(), changed_.end());
  changed_.erase(std::unique(changed_.begin(), changed_.end()), changed_.end());
  for (const BodySlot number : changed_) {
    each_process(division_->knowers(number), [&](std::size_t process) {
      if (!std::ranges::binary_search(told[process], number)) news[process].bodies.push_back(news_of(number));
    });
  }
  for (const Overlap& overlap : overlaps_) {
    // To all that know one of the two: this process may not know who is to know the other.
    const bool first_moves = division_->owner_of(overlap.a) != Division::nobody;
    each_process(division_->knowers(first_moves ? overlap.a : overlap.b),
                 [&](std::size_t process) { news[process].overlaps.push_back(overlap); });
  }
}

template <class Motion>
BodyNews<Motion> Domains<Motion>::news_of(BodySlot number) const {
  const Engine<Motion>& engine = store_.engine();
  const BodySlot slot = store_.find(number);
  return {number, engine.transfer().progress(slot), engine.transfer().kept_resting(slot)};
}

/// Notes who owns and knows a body from now on, and which domains of this process are to let it go and to take it in.
template <class Motion>
void Domains<Motion>::note_move(BodySlot number, DomainIndex owner, std::span<const DomainIndex> knowers) {
  std::vector<DomainIndex> differ;
  const auto before = division_->knowers(number);
  std::ranges::set_difference(before, knowers, std::back_inserter(differ));
  for (const DomainIndex domain : differ) {
    if (is_here(domain)) go_[domain - first_].push_back(number);
  }
  differ.clear();
  std::ranges::set_difference(knowers, before, std::back_inserter(differ));
  for (const DomainIndex domain : differ) {
    if (is_here(domain)) come_[domain - first_].push_back(number);
  }
  division_->note(number, owner, knowers);
  if (std::ranges::none_of(knowers, [this](DomainIndex domain) { return is_here(domain); })) gone_.push_back(number);
}

/// Stores bodies that no domain of this process has known.
template <class Motion>
void Domains<Motion>::take_in(const Parcel<Motion>& newcomers) {
  store_.add(newcomers);
  for (const BodySlot number : newcomers.numbers) division_->note(number, Division::nobody, {});
}

template <class Motion>
void Domains<Motion>::hear(const WindowNews<Motion>& news) {
  take_in(news.newcomers);
  news.moves.each([&](BodySlot number, DomainIndex owner, std::span<const DomainIndex> knowers) {
    note_move(number, owner, knowers);
  });
  for (const BodyNews<Motion>& body : news.bodies) {
    const BodySlot slot = store_.find(body.number);
    store_.engine().transfer().go_on_from(slot, body.progress);
    store_.engine().transfer().keep_resting(slot, body.resting);
  }
  overlaps_.insert(overlaps_.end(), news.overlaps.begin(), news.overlaps.end());
}

template <class Motion>
void Domains<Motion>::exchange() {
  heard_.clear();
  const auto overlaps = overlaps_by_domain();
  in_each([&](Domain<Motion>& domain) {
    const std::size_t i = domain.index() - first_;
    std::sort(go_[i].begin(), go_[i].end());
    // Copies that are wrong go and come again, unless they go anyway; and so does what leans on those that go.
    std::vector<BodySlot> go;
    std::ranges::set_union(domain.wrong(), go_[i], std::back_inserter(go));
    go = domain.with_islands(go);
    std::ranges::set_difference(go, go_[i], std::back_inserter(come_[i]));
    std::sort(come_[i].begin(), come_[i].end());
    domain.exchange(go, come_[i], store_, overlaps[i]);
    domain.begin_window();
  });
}

template <class Motion>
WorldCounters Domains<Motion>::work() const {
  WorldCounters all = work_;
  for (const auto& domain : domains_) all = all + domain->work();
  return all;
}

template <class Motion>
std::string_view Domains<Motion>::broad_phase() const {
  return domains_.empty() ? std::string_view() : domains_.front()->broad_phase();
}

#define KDS_INSTANTIATE(motion) template class Domains<motion>;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
