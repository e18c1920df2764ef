// How processes come to store their parts of a scene, and all of it again.
#include "collision/motions.hpp"
#include "collision/parallel/domains.hpp"
#include "collision/world/bodies_image.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>

namespace kds::collision {
namespace {

/// So many bodies are sent at once: letters of some ten megabytes at most, however many bodies there are.
constexpr std::size_t bodies_at_once = std::size_t{1} << 15;

}  // namespace

template <class Motion>
void Domains<Motion>::add_shares(std::size_t count,
                                 const std::function<BasicBodyDescription<Motion>(std::size_t)>& body, double now) {
  std::vector<std::uint64_t> counts(team_.count(), 0);
  counts[team_.rank()] = count;
  team_.combine(counts, {});
  const auto mine = counts.begin() + static_cast<std::ptrdiff_t>(team_.rank());
  const std::uint64_t first = std::accumulate(counts.begin(), mine, std::uint64_t{0});
  const std::uint64_t all = std::accumulate(mine, counts.end(), first);
  if (all >= no_body) {
    throw std::length_error("ParallelWorld::add_shares: " + std::to_string(all) +
                            " bodies are more than there are slots");
  }
  if (team_.count() > 1) store_.begin_part(now);
  for (std::size_t i = 0; i < count; ++i) {
    const BasicBodyDescription<Motion> description = body(i);
    const auto refuse = [&](const char* what) {
      throw std::invalid_argument("ParallelWorld::add_shares: body " + std::to_string(first + i) + ": " + what +
                                  ": add_body() in all processes");
    };
    if (description.box) refuse("has a box function");
    if (description.attached_to) refuse("is attached to another");
    store_.engine().edits().add_body(description);
  }
  if (team_.count() == 1) return;
  store_.number_from(static_cast<BodySlot>(first));
  store_.whole().transfer().lend(all);
  share_meshes();
}

/// All processes know all meshes, in the same order. One that several have is there as often, but stored once.
template <class Motion>
void Domains<Motion>::share_meshes() {
  using Image = typename Bodies<Motion>::Image;
  Image mine;
  mine.meshes = store_.bodies().meshes();
  Letters letters;
  for (std::size_t process = 0; process < team_.count(); ++process) {
    if (process != team_.rank() && !mine.meshes.empty()) mine.archive(letters.to(process), {});
  }
  std::map<std::size_t, Image> by_process;
  auto known = mine.meshes;
  by_process[team_.rank()] = std::move(mine);
  team_.exchange(std::move(letters), [&](std::size_t process, auto& reader) {
    Image& heard = by_process[process];
    heard.archive(reader, known);
    known.insert(known.end(), heard.meshes.begin(), heard.meshes.end());
  });
  meshes_.clear();
  for (const auto& [process, heard] : by_process) {
    meshes_.insert(meshes_.end(), heard.meshes.begin(), heard.meshes.end());
  }
}

/// Whether this process answers for a body that it stores: a domain of its owns it, or, where nobody does, is the first
/// that knows it.
template <class Motion>
bool Domains<Motion>::answers_for(BodySlot number) const {
  const DomainIndex owner = division_->owner_of(number);
  return is_here(owner != Division::nobody ? owner : division_->knowers(number).front());
}

template <class Motion>
std::vector<BodySlot> Domains<Motion>::answered() const {
  const auto& bodies = store_.bodies();
  const std::size_t slots = bodies.slots(), rank = team_.rank(), count = team_.count();
  std::vector<BodySlot> all;
  // Where each has all of them, by numbers.
  std::size_t first = 0, last = slots;
  if (!store_.is_part()) first = slots * rank / count, last = slots * (rank + 1) / count;
  for (auto slot = static_cast<BodySlot>(first); slot < last; ++slot) {
    if (bodies.alive(slot) && (!any() || count == 1 || answers_for(bodies.number(slot)))) all.push_back(slot);
  }
  return all;
}

/// How many times all processes send bodies, so that each can send all that it is to.
template <class Motion>
std::uint64_t Domains<Motion>::rounds_of(std::size_t bodies, std::size_t at_once) {
  std::array<double, 1> most{static_cast<double>((bodies + at_once - 1) / at_once)};
  team_.combine({}, most);
  return static_cast<std::uint64_t>(most[0]);
}

template <class Motion>
void Domains<Motion>::begin(Division division, std::span<const BodySlot> answered, std::vector<Overlap> overlaps,
                            bool logs, double now) {
  drop();
  islands_are_known_ = true;
  const bool whole = !store_.is_part();
  division_ = std::make_unique<Division>(std::move(division));
  logs_ = logs;
  changed_.clear();
  if (team_.count() == 1) {
    const Engine<Motion>& engine = store_.engine();
    find_islands(engine, now);
    std::vector<DomainIndex> knowers;
    for (const BodySlot slot : answered) {
      const DomainIndex owner = assign(engine, slot, now, knowers);
      division_->note(slot, owner, knowers);
    }
    overlaps_ = std::move(overlaps);
    know_islands_.clear();
    return;
  }
  if (whole) meshes_ = store_.bodies().meshes();
  const auto before = store_.begin_part(now);
  Engine<Motion>& from = before ? before->engine() : store_.whole();
  division_->slots = store_.slots();
  know_islands_.clear();
  if (whole) find_islands(from, now);
  send_bodies(from, answered, now);
  send_overlaps(from, answered, std::move(overlaps), now);
  know_islands_.clear();
  if (whole) store_.whole().transfer().lend();
}

/// Bodies that lean on each other are known to the same domains: to all that are to know one of them. Precondition:
/// slots are numbers.
template <class Motion>
void Domains<Motion>::find_islands(const Engine<Motion>& from, double now) {
  know_islands_.clear();
  const auto& bodies = from.bodies();
  std::vector<char> seen(bodies.slots());
  std::vector<DomainIndex> all;
  std::vector<Eigen::Vector3d> places;
  for (BodySlot first = 0; first < bodies.slots(); ++first) {
    if (!bodies.alive(first) || bodies.fixed(first) || std::exchange(seen[first], 1)) continue;
    std::vector<BodySlot> island{first};
    for (std::size_t i = 0; i < island.size(); ++i) {
      from.transfer().kept_resting(island[i]).each_other(island[i], [&](BodySlot other) {
        if (!bodies.fixed(other) && !std::exchange(seen[other], 1)) island.push_back(other);
      });
    }
    if (island.size() == 1) continue;
    places.clear();
    for (const BodySlot slot : island) places.push_back(place_at(bodies.path(slot), now));
    if (!division_->find_knowers(places, all)) {  // Its bodies go to their owners, from where they are gathered again.
      islands_are_known_ = false;
      continue;
    }
    for (const BodySlot slot : island) {
      know_islands_[slot] = all;
      for (const BodySlot sensor : bodies.attachments().sensors(slot)) know_islands_[sensor] = all;
    }
  }
}

/// As assign_body(), but that a domain knows islands as a whole.
template <class Motion>
DomainIndex Domains<Motion>::assign(const Engine<Motion>& from, BodySlot slot, double now,
                                    std::vector<DomainIndex>& knowers) const {
  const DomainIndex owner = assign_body(*division_, from.bodies(), from.parts().scripts, slot, now, knowers);
  const auto found = know_islands_.find(slot);
  if (found != know_islands_.end()) knowers = found->second;
  return owner;
}

template <class Motion>
bool Domains<Motion>::any_islands() const {
  bool any = false;
  store_.each_carrier([&](BodySlot number) {
    const BodySlot slot = store_.find(number);
    any = any || slot == no_body || !store_.bodies().fixed(slot);
  });
  return any;
}

template <class Motion>
bool Domains<Motion>::carriers_are_known() const {
  bool known = islands_are_known_;
  store_.each_carrier([&](BodySlot number) {
    const BodySlot slot = store_.find(number);
    known =
        known && slot != no_body && (!store_.bodies().fixed(slot) || division_->owner_of(number) == Division::nobody);
  });
  return known;
}

/// Each goes to the processes whose domains are to know it.
template <class Motion>
void Domains<Motion>::send_bodies(Engine<Motion>& from, std::span<const BodySlot> answered, double now) {
  std::vector<DomainIndex> knowers;
  for (std::uint64_t left = rounds_of(answered.size(), bodies_at_once); left > 0; --left) {
    NewsByProcess news;
    std::map<std::size_t, std::vector<BodySlot>> slots;
    const auto sent = answered.first(std::min(answered.size(), bodies_at_once));
    answered = answered.subspan(sent.size());
    for (const BodySlot slot : sent) {
      const DomainIndex owner = assign(from, slot, now, knowers);
      const auto add = [&](std::size_t process) {
        slots[process].push_back(slot);
        news[process].moves.add(from.bodies().number(slot), owner, knowers);
      };
      each_process(knowers, add);
      if (std::ranges::any_of(knowers, [this](DomainIndex domain) { return is_here(domain); })) add(team_.rank());
    }
    for (const auto& [process, of_process] : slots) news[process].newcomers = from.transfer().pack(of_process, meshes_);
    const auto hear = [&](const WindowNews<Motion>& heard) {
      store_.add(heard.newcomers);
      heard.moves.each([&](BodySlot number, DomainIndex owner, std::span<const DomainIndex> known) {
        division_->note(number, owner, known);
      });
    };
    const auto own = news.extract(team_.rank());
    if (own) hear(own.mapped());
    exchange_news(letters_of(std::move(news)), hear);
  }
}

/// Each goes to the processes whose domains are to know one of the two, since which are to know both is not known here.
template <class Motion>
void Domains<Motion>::send_overlaps(Engine<Motion>& from, std::span<const BodySlot> answered,
                                    std::vector<Overlap> overlaps, double now) {
  std::map<BodySlot, BodySlot> slots;  // by number, of those that overlap
  for (const Overlap& overlap : overlaps) slots[overlap.a] = slots[overlap.b] = no_body;
  for (const BodySlot slot : answered) {
    if (slots.empty()) break;
    const auto found = slots.find(from.bodies().number(slot));
    if (found != slots.end()) found->second = slot;
  }
  const bool of_whole = &from == &store_.whole();
  NewsByProcess news;
  std::vector<DomainIndex> knowers;
  for (const Overlap& overlap : overlaps) {
    const BodySlot slot = slots[overlap.a] != no_body ? slots[overlap.a] : slots[overlap.b];
    if (slot == no_body) {
      // Of one world all processes have all pairs. Of a part it is one of bodies that stand, known here and answered
      // for elsewhere: no other process may have it.
      for (std::size_t process = 0; process < team_.count() && !of_whole; ++process) {
        if (process != team_.rank()) news[process].overlaps.push_back(overlap);
      }
      continue;
    }
    assign(from, slot, now, knowers);
    each_process(knowers, [&](std::size_t process) { news[process].overlaps.push_back(overlap); });
  }
  overlaps_ = std::move(overlaps);
  exchange_news(letters_of(std::move(news)), [&](const WindowNews<Motion>& heard) {
    overlaps_.insert(overlaps_.end(), heard.overlaps.begin(), heard.overlaps.end());
  });
  sort_overlaps();
}

template <class Motion>
std::vector<typename Domains<Motion>::Overlap> Domains<Motion>::end() {
  drop();
  if (store_.is_part()) {
    const std::vector<BodySlot> all = answered();
    std::span<const BodySlot> left = all;
    const std::size_t at_once = std::max<std::size_t>(1, bodies_at_once / team_.count());
    store_.whole().transfer().take_back();
    for (std::uint64_t rounds = rounds_of(all.size(), at_once); rounds > 0; --rounds) {
      const auto sent = left.first(std::min(left.size(), at_once));
      left = left.subspan(sent.size());
      WindowNews<Motion> mine;
      mine.newcomers = store_.engine().transfer().pack(sent, meshes_);
      if (rounds == 1) mine.overlaps = overlaps_;
      store_.whole().transfer().put_back(mine.newcomers);
      Letters letters;
      for (std::size_t process = 0; process < team_.count(); ++process) {
        if (process != team_.rank()) letters.to(process)(mine);
      }
      exchange_news(std::move(letters), [&](const WindowNews<Motion>& heard) {
        store_.whole().transfer().put_back(heard.newcomers);
        overlaps_.insert(overlaps_.end(), heard.overlaps.begin(), heard.overlaps.end());
      });
    }
    store_.put_part(nullptr);
    sort_overlaps();
  }
  division_.reset();
  return std::exchange(overlaps_, {});
}

#define KDS_INSTANTIATE(motion) KDS_TEMPLATE_PART class Domains<motion>;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
