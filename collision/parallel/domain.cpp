#include "collision/parallel/domain.hpp"

#include "collision/motions.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace kds::collision {
namespace {

/// The options of a world of a domain.
WorldOptions for_domain(WorldOptions options, double now) {
  options.start_time = now;
  options.threads = 1;
  options.profile = false;
  options.report_pieces = true;
  return options;
}

}  // namespace

template <class Motion>
Domain<Motion>::Domain(const WorldOptions& options, const Division& division, std::size_t index, double now, bool logs,
                       bool first)
    : division_(division),
      index_(index),
      logs_(logs),
      first_(first),
      resolves_(options.response != Response::none),
      by_law_(options.law != nullptr),
      world_(for_domain(options, now), this),
      engine_(detail::EngineOf<Motion>::of(world_)) {
  engine_.transfer().islands().shared().set_owned([this](BodySlot slot) {
    return slot < known_.size() && (known_[slot].role == Role::deep || known_[slot].role == Role::followed);
  });
  // A body that has stayed in the halo of its cell, as it must, is not in that of a cell farther away. Those that are
  // known farther out, in islands, are nearer than the cells of their owners, so these are among them too.
  const Partition& partition = division.partition;
  partition.each_within(partition.cell(index), 2 * division.halo, [&](std::size_t other) {
    if (other != index) neighbours_.push_back({static_cast<DomainIndex>(other), partition.cell(other), never});
  });
}

template <class Motion>
std::size_t Domain<Motion>::place_of(BodySlot number) const {
  const auto place = std::ranges::lower_bound(slots_, number, {}, [&](BodySlot slot) { return this->number(slot); });
  return static_cast<std::size_t>(place - slots_.begin());
}

template <class Motion>
void Domain<Motion>::exchange(std::span<const BodySlot> go, std::span<const BodySlot> come,
                              const BodyStore<Motion>& store, std::span<const Overlap> overlaps) {
  if (!go.empty()) {
    std::vector<BodySlot> gone;
    std::erase_if(slots_, [&](BodySlot slot) {
      if (gone.size() == go.size() || number(slot) != go[gone.size()]) return false;
      gone.push_back(slot);
      return true;
    });
    engine_.transfer().let_go(gone);
  }
  if (come.empty()) return;
  const auto before = static_cast<std::ptrdiff_t>(slots_.size());
  std::vector<BodySlot> stored;
  stored.reserve(come.size());
  for (const BodySlot number : come) stored.push_back(store.find(number));
  const std::vector<BodySlot> taken =
      engine_.transfer().take_in(store.engine().transfer(), stored, slots_, store.ignored());
  slots_.insert(slots_.end(), taken.begin(), taken.end());
  std::inplace_merge(slots_.begin(), slots_.begin() + before, slots_.end(),
                     [&](BodySlot a, BodySlot b) { return number(a) < number(b); });
  std::vector<Overlap> here;
  const auto comes = [&](BodySlot number) { return std::binary_search(come.begin(), come.end(), number); };
  for (const Overlap& overlap : overlaps) {
    if (comes(overlap.a) || comes(overlap.b))
      here.push_back({slot_of(overlap.a), slot_of(overlap.b), overlap.passes_at});
  }
  engine_.transfer().go_on_overlapping(here);
}

template <class Motion>
void Domain<Motion>::begin_window() {
  const auto& bodies = engine_.bodies();
  const StaticBox& cell = division_.partition.cell(index_);
  const double now = world_.now();
  known_.resize(bodies.slots());
  for (Known& known : known_) known.role = Role::unowned, known.changed = false;
  followed_.clear(), copies_.clear(), changes_.clear(), changed_.clear();
  report_ = {.known = world_.size()};
  bulge_ = 0;
  for (NeighbourDomain& neighbour : neighbours_) neighbour.nearest = never;
  for (BodySlot slot = 0; slot < bodies.slots(); ++slot) {
    if (!bodies.alive(slot)) continue;
    const DomainIndex owner = division_.owner_of(number(slot));
    if (owner == Division::nobody) continue;
    Known& known = known_[slot];
    if (owner != index_) {
      known.role = Role::copy;
      std::uint32_t& place = known.place;  // Mostly it is that which it was.
      if (place >= neighbours_.size() || neighbours_[place].domain != owner) {
        const auto found = std::ranges::lower_bound(neighbours_, owner, {}, &NeighbourDomain::domain);
        place = static_cast<std::uint32_t>(found - neighbours_.begin());
      }
      copies_.push_back({number(slot), place, bodies.motion(slot)});
      continue;
    }
    ++report_.owned;
    const auto& path = bodies.path(slot);
    const double bulge = bulge_of(path, now, division_.window_end);
    // What others know though it is deep, since it leans on others, may soon be known to this domain alone.
    const bool steady = !detail::has_script(bodies, engine_.parts().scripts, slot) && bulge <= division_.halo / 4 &&
                        division_.is_known_to_one(number(slot));
    if (steady && inside(path.position(now), cell) - bulge > 2 * division_.halo) {
      known.role = Role::deep;
      bulge_ = std::max(bulge_, bulge);
    } else {
      begin_to_follow(slot, now);
    }
  }
  std::sort(copies_.begin(), copies_.end(), [](const Copy& a, const Copy& b) { return a.number < b.number; });
  begin_islands();
}

template <class Motion>
void Domain<Motion>::begin_to_follow(BodySlot slot, double t) {
  known_[slot].role = Role::followed;
  known_[slot].place = static_cast<std::uint32_t>(followed_.size());
  followed_.push_back({slot, strangers_to(number(slot)), t, engine_.bodies().motion(slot)});
}

template <class Motion>
std::uint32_t Domain<Motion>::strangers_to(BodySlot number) {
  const auto [found, fresh] =
      strangers_to_.try_emplace(division_.known_to(number), static_cast<std::uint32_t>(strangers_.size()));
  if (fresh) {
    auto& strangers = strangers_.emplace_back();
    const auto knowers = division_.knowers(number);
    for (std::uint32_t place = 0; place < neighbours_.size(); ++place) {
      if (!std::ranges::binary_search(knowers, neighbours_[place].domain)) strangers.push_back(place);
    }
  }
  return found->second;
}

template <class Motion>
void Domain<Motion>::run(double until) {
  for (const BodySlot slot : changed_) known_[slot].changed = false;
  changed_.clear(), events_.clear(), fresh_.clear();
  caused_from_ = 0;
  report_.told = {};
  report_.computed = 0;
  if (!report_.divisible) return;
  const double since = world_.now();
  try {
    world_.advance_to(until);
  } catch (const std::runtime_error&) {
    report_.divisible = false;  // Perhaps of a copy that has gone wrong. If not, the scene as one world throws it too.
  } catch (...) {
    if (!by_law_) throw;
    report_.divisible = false;  // The same of what a law throws.
  }
  // What contacts of the last instants would go on as is no progress of bodies.
  if constexpr (turns<Motion>) report_.divisible = report_.divisible && engine_.parts().resting.divisible();
  if (!report_.divisible) return;
  for (const BodySlot slot : engine_.transfer().take_solved()) mark_changed(slot);
  for (Followed& body : followed_) follow(body, until);
  for (const auto& [slot, copy] : shared_copies_) follow_outside(copy, until);
  const auto& bodies = engine_.bodies();
  for (BodySlot slot = 0; slot < known_.size() && report_.stayed; ++slot) {
    if (known_[slot].role == Role::deep) report_.stayed = stays_deep(bodies.path(slot).position(until));
  }
  if constexpr (turns<Motion>) note_pieces(since);
  find_islands(until);
  sort_by_number(fresh_);
  changes_.append(fresh_);
}

/// Pieces of bodies that precess follow from their last contacts, so they are no changes that are to be compared, but
/// the store is to have the present ones.
template <class Motion>
void Domain<Motion>::note_pieces(double since) {
  const auto& bodies = engine_.bodies();
  for (BodySlot slot = 0; slot < known_.size(); ++slot) {
    if (bodies.alive(slot) && bodies.path(slot).start >= since) mark_changed(slot);
  }
}

template <class Motion>
void Domain<Motion>::follow(Followed& body, double until) {
  const StaticBox swept = swept_place(path_of(body.motion), body.since, until);
  report_.overshoot = std::max(report_.overshoot, farthest_outside(swept, division_.partition.cell(index_)));
  for (const std::uint32_t place : strangers_[body.strangers]) {
    NeighbourDomain& other = neighbours_[place];
    other.nearest = std::min(other.nearest, outside(swept, other.cell));
  }
}

/// A copy whose fate is that of an owned body, since one leans on the other.
template <class Motion>
void Domain<Motion>::follow_outside(const Followed& body, double until) {
  const StaticBox swept = swept_place(path_of(body.motion), body.since, until);
  report_.overshoot = std::max(report_.overshoot, farthest_outside(swept, division_.partition.cell(index_)));
}

template <class Motion>
void Domain<Motion>::compare(std::span<const std::span<const Change>> all) {
  wrong_.clear();
  report_.nearest_wrong = never;
  const StaticBox& cell = division_.partition.cell(index_);
  std::vector<std::span<const Change>> of_domains(all.begin(), all.end());
  of_domains.push_back(changes_.all());
  // The changes of a body, of those of a domain, which are sorted, as the copies are.
  std::vector<std::size_t> next(of_domains.size(), 0);
  const auto changes_of = [&](BodySlot number, std::size_t place) {
    const std::span<const Change> changes = of_domains[place];
    std::size_t& last = next[place];
    while (last < changes.size() && changes[last].number < number) ++last;
    const std::size_t first = last;
    while (last < changes.size() && changes[last].number == number) ++last;
    return changes.subspan(first, last - first);
  };
  for (const auto& [number, owner, begun] : copies_) {
    const auto mine = changes_of(number, all.size());
    const auto right = changes_of(number, owner);
    std::size_t same = 0;
    while (same < std::min(mine.size(), right.size()) && same_bits(mine[same], right[same])) ++same;
    if (same == mine.size() && same == right.size()) continue;
    wrong_.push_back(number);
    const double from =
        std::min(same < mine.size() ? mine[same].time : never, same < right.size() ? right[same].time : never);
    for (const auto changes : {mine, right}) {
      const Motion* motion = same > 0 ? &mine[same - 1].motion : &begun;
      double since = from;
      for (std::size_t i = same; i <= changes.size(); ++i) {
        const double until = i < changes.size() ? changes[i].time : world_.now();
        report_.nearest_wrong =
            std::min(report_.nearest_wrong, outside(swept_place(path_of(*motion), since, until), cell));
        if (i < changes.size()) motion = &changes[i].motion, since = until;
      }
    }
  }
  report_.wrong = wrong_.size();
}

template <class Motion>
void Domain<Motion>::commit(BodyStore<Motion>& store) {
  islands_ = std::move(next_islands_);
  for (const BodySlot slot : changed_) {
    store.engine().transfer().go_on_from(store.find(number(slot)), engine_.transfer().progress(slot));
  }
}

template <class Motion>
void Domain<Motion>::commit_resting(BodyStore<Motion>& store) const {
  for (const BodySlot slot : changed_) {
    store.engine().transfer().keep_resting(store.find(number(slot)), engine_.transfer().resting(slot));
  }
}

template <class Motion>
void Domain<Motion>::append_changed(std::vector<BodySlot>& numbers) const {
  for (const BodySlot slot : changed_) {
    if (known_[slot].role != Role::unowned) numbers.push_back(number(slot));
  }
}

template <class Motion>
std::vector<typename Domain<Motion>::Overlap> Domain<Motion>::overlaps() const {
  std::vector<Overlap> all;
  for (const Overlap& overlap : engine_.transfer().overlaps()) {
    const BodySlot a = number(overlap.a), b = number(overlap.b);
    const DomainIndex of_a = division_.owner_of(a);
    const DomainIndex teller = of_a != Division::nobody ? of_a : division_.owner_of(b);
    if (teller == index_ || teller == Division::nobody) all.push_back({a, b, overlap.passes_at});
  }
  return all;
}

template <class Motion>
void Domain<Motion>::find_moves(const BodyStore<Motion>& store, double t) {
  moves_.clear();
  std::vector<DomainIndex> knowers;
  for (const Followed& body : followed_) {
    if (islands_.of.contains(body.slot)) continue;
    const BodySlot moved = number(body.slot);
    const Eigen::Vector3d place = place_at(store.bodies().path(store.find(moved)), t);
    // Mostly it is deeper in the cell than any other's halo, as it was.
    if (division_.is_known_to_one(moved) && inside(place, division_.partition.cell(index_)) > division_.halo) continue;
    const auto owner = static_cast<DomainIndex>(division_.partition.cell_of(place));
    division_.find_knowers(place, 0, knowers);
    if (owner != index_ || !std::ranges::equal(knowers, division_.knowers(moved))) moves_.add(moved, owner, knowers);
  }
  for (const auto& [slot, place] : islands_.of) {
    const BodySlot moved = number(slot);
    const std::vector<DomainIndex>& to_know = islands_.knowers[place.island];
    if (place.owner != index_ || !std::ranges::equal(to_know, division_.knowers(moved)))
      moves_.add(moved, place.owner, to_know);
  }
}

/// A body has another motion, and what is attached to it.
template <class Motion>
void Domain<Motion>::changed(BodySlot slot, double t) {
  note_change(slot, t);
  const auto& attachments = engine_.bodies().attachments();
  if (attachments.empty()) return;
  for (const BodySlot sensor : attachments.sensors(slot)) note_change(sensor, t);
}

/// If this domain tells the store of it.
template <class Motion>
void Domain<Motion>::mark_changed(BodySlot slot) {
  Known& known = known_[slot];
  const bool tells = known.role == Role::unowned ? first_ : known.role != Role::copy;
  if (tells && !std::exchange(known.changed, true)) changed_.push_back(slot);
}

/// What others are to compare, and whether it has stayed where it had to.
template <class Motion>
void Domain<Motion>::note_change(BodySlot slot, double t) {
  mark_changed(slot);
  const Known& known = known_[slot];
  if (known.role == Role::unowned) return;
  const Motion& motion = engine_.bodies().motion(slot);
  if (known.role == Role::deep) {
    report_.stayed = report_.stayed && stays_deep(path_of(motion).position(t));
    // It has been deep until now, and may bend more from now on, as what ceases to rest does.
    if (!(bulge_of(path_of(motion), t, division_.window_end) <= bulge_)) begin_to_follow(slot, t);
    return;
  }
  if (known.role == Role::followed) {
    Followed& body = followed_[known.place];
    follow(body, t);
    body.since = t, body.motion = motion;
    if (division_.is_known_to_one(number(slot))) return;
  }
  if (const auto copy = shared_copies_.find(slot); copy != shared_copies_.end()) {
    follow_outside(copy->second, t);
    copy->second.since = t, copy->second.motion = motion;
  }
  fresh_.push_back(
      {number(slot), motion, t, engine_.transfer().progress(slot).turning, engine_.transfer().resting(slot)});
}

template <class Motion>
DomainIndex Domain<Motion>::owner_of(BodySlot slot) const {
  const Known& known = known_[slot];
  if (known.role == Role::unowned) return Division::nobody;
  return known.role == Role::copy ? neighbours_[known.place].domain : static_cast<DomainIndex>(index_);
}

template <class Motion>
void Domain<Motion>::piece(World&, BodyId id) {
  const BodySlot slot = body_slot(id);
  const double t = world_.now();
  const Known& known = known_[slot];
  if (known.role == Role::followed) {  // If it jumps out of the halo no shorter window would hold.
    const auto leaves = [&](const Motion& motion) {
      return outside(place_at(path_of(motion), t), division_.partition.cell(index_)) > division_.halo;
    };
    if (!leaves(followed_[known.place].motion) && leaves(engine_.bodies().motion(slot))) report_.divisible = false;
  }
  if constexpr (turns<Motion>) note_islands();  // It has left what it was about to lie on.
  changed(slot, t);
}

#define KDS_INSTANTIATE(motion) template class Domain<motion>;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
