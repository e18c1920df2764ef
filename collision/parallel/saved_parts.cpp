// How a divided scene is saved in parts, one of each process, and how any number of processes go on from these.
#include "collision/motions.hpp"
#include "collision/parallel/domains.hpp"
#include "collision/parallel/saved_bodies.hpp"
#include "collision/world/bodies_image.hpp"
#include "collision/world/edits/checked_pieces.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <exception>
#include <optional>
#include <stdexcept>
#include <unordered_map>
#include <utility>

namespace kds::collision {

/// Bodies in this order, those that are attached to a body behind it: they are saved and loaded together.
template <class Motion>
std::vector<BodySlot> Domains<Motion>::with_attached(std::span<const BodySlot> slots) const {
  const Attachments& attachments = store_.bodies().attachments();
  std::vector<BodySlot> all;
  all.reserve(slots.size());
  for (const BodySlot slot : slots) {
    if (attachments.owner(slot) != no_body) continue;
    all.push_back(slot);
    const auto sensors = attachments.sensors(slot);
    all.insert(all.end(), sensors.begin(), sensors.end());
  }
  return all;
}

template <class Motion>
kds::Snapshot Domains<Motion>::save(double now, const WriteBodies& write, std::size_t bodies_in_block) {
  const Engine<Motion>& engine = store_.engine();
  const auto& bodies = engine.bodies();
  const std::vector<BodySlot> all = with_attached(answered());
  const auto meshes = store_.is_part() ? meshes_ : bodies.meshes();
  // Each pair goes with one of its bodies, if this process answers for one. Others are told by those who do, but for
  // pairs of bodies without owners.
  std::unordered_map<BodySlot, std::vector<Overlap>> with;
  std::vector<Overlap> others;
  for (const Overlap& overlap : overlaps_) {
    const bool of_a = answers_for_stored(overlap.a);
    if (of_a || answers_for_stored(overlap.b)) {
      with[of_a ? overlap.a : overlap.b].push_back(overlap);
    } else if (!any() || (division_->owner_of(overlap.a) == Division::nobody &&
                          division_->owner_of(overlap.b) == Division::nobody)) {
      others.push_back(overlap);
    }
  }
  std::array<std::uint64_t, 1> sum{0};
  std::span<const BodySlot> left = all;
  do {  // also one without bodies: each process has a part
    auto size = std::min(left.size(), bodies_in_block);
    while (size < left.size() && bodies.attachments().owner(left[size]) != no_body) ++size;
    SavedBodies<Motion> saved;
    saved.parcel = engine.transfer().pack(left.first(size), meshes);
    saved.overlaps = std::exchange(others, {});
    left = left.subspan(size);
    for (const BodySlot number : saved.parcel.numbers) {
      sum[0] += number_hash(number);
      const auto found = with.find(number);
      if (found != with.end()) saved.overlaps.insert(saved.overlaps.end(), found->second.begin(), found->second.end());
    }
    kds::detail::Writer writer;
    writer(saved);
    write(writer.take());
  } while (!left.empty());
  team_.combine(sum, {});
  if (team_.rank() > 0) return {};
  auto rest = store_.whole().image_without_bodies(now);
  rest.bodies.meshes = meshes;
  rest.bodies.elsewhere.numbers = sum[0];
  kds::detail::Writer writer;
  store_.whole().archive(writer, rest);
  return kds::Snapshot(writer.take());
}

/// Whether this process is the one that answers for a body.
template <class Motion>
bool Domains<Motion>::answers_for_stored(BodySlot number) const {
  if (store_.find(number) == no_body) return false;
  return !any() || team_.count() == 1 || answers_for(number);
}

template <class Motion>
void Domains<Motion>::load(const typename Engine<Motion>::Image& rest, const ReadBodies& read) {
  auto before = store_.begin_part(rest.now);
  std::vector<Overlap> overlaps;
  std::array<std::uint64_t, 4> found{};  // bodies, the sum of their hashes, attached pairs, bodies of ignored pairs
  std::exception_ptr failure;
  try {
    for (std::vector<char> block; read(block);) {
      SavedBodies<Motion> saved;
      saved.parcel.bodies.meshes = rest.bodies.meshes;
      kds::detail::Reader reader(block);
      reader(saved);
      kds::detail::Reader::require(reader.at_end(), "there is more in a part than bodies");
      saved.check(rest, options_);
      store_.store(saved.parcel);
      for (const BodySlot number : saved.parcel.numbers) ++found[0], found[1] += number_hash(number);
      overlaps.insert(overlaps.end(), saved.overlaps.begin(), saved.overlaps.end());
    }
    const auto here = [this](BodySlot number) { return store_.find(number) != no_body; };
    for (const auto& [sensor, owner] : rest.bodies.attached) {
      if (here(sensor) && here(owner)) check_attached(sensor, owner), ++found[2];
    }
    for (const auto& [a, b] : rest.bodies.ignored) found[3] += (here(a) ? 1u : 0u) + (here(b) ? 1u : 0u);
    for (const Overlap& overlap : overlaps) {
      if (team_.count() > 1 || (here(overlap.a) && here(overlap.b))) continue;  // Of others it is not known here.
      throw std::runtime_error("snapshot: a pair overlaps of which a body is missing");
    }
    for (const BodySlot slot : rest.bodies.free) {
      if (here(slot)) throw std::runtime_error("snapshot: a body is where none is");
    }
  } catch (...) {
    failure = std::current_exception();
  }
  const bool loaded = team_.all(!failure);
  if (loaded) team_.combine(found, {});
  const bool carried = loaded && carriers_are_there();
  const auto& elsewhere = rest.bodies.elsewhere;
  const std::array<std::uint64_t, 4> expected{elsewhere.bodies, elsewhere.numbers, rest.bodies.attached.size(),
                                              2 * rest.bodies.ignored.size()};
  if (found != expected || !carried) {
    store_.put_part(std::move(before));
    if (failure) std::rethrow_exception(failure);
    throw std::runtime_error(!loaded ? "snapshot: another process has not loaded its part"
                             : found != expected
                                 ? "snapshot: the parts have not the bodies of the scene"
                                 : "snapshot: a body rests on one that is not there, or does not rest on it");
  }
  leave();
  meshes_ = rest.bodies.meshes;
  store_.whole().become(rest);
  for (const auto& [sensor, owner] : rest.bodies.attached) {
    if (store_.find(sensor) != no_body) store_.engine().transfer().attach(store_.find(sensor), store_.find(owner));
  }
  overlaps_ = std::move(overlaps);
}

/// Whether what bodies of any process rest on is stored in one of them, and, unless it is fixed, rests on them too.
template <class Motion>
bool Domains<Motion>::carriers_are_there() {
  const auto& bodies = store_.bodies();
  std::vector<BodySlot> wanted;
  store_.each_carrier([&](BodySlot number) { wanted.push_back(number); });
  std::sort(wanted.begin(), wanted.end());
  wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
  std::array<std::uint64_t, 2> counts{wanted.size(), 0};  // of those that are wanted, and of those that are there
  std::vector<BodySlot> fixed;                            // of those that are wanted here
  const auto look = [&](const std::vector<BodySlot>& numbers, std::vector<BodySlot>& found_fixed) {
    for (const BodySlot number : numbers) {
      const BodySlot slot = store_.find(number);
      if (slot == no_body || !bodies.entered(slot)) continue;
      ++counts[1];
      if (bodies.fixed(slot)) found_fixed.push_back(number);
    }
  };
  look(wanted, fixed);
  Letters questions, answers;
  for (std::size_t process = 0; process < team_.count() && !wanted.empty(); ++process) {
    if (process != team_.rank()) questions.to(process)(wanted);
  }
  team_.exchange(std::move(questions), [&](std::size_t process, auto& reader) {
    std::vector<BodySlot> heard, found;
    reader(heard);
    look(heard, found);
    if (!found.empty()) answers.to(process)(found);
  });
  team_.exchange(std::move(answers), [&](std::size_t, auto& reader) {
    std::vector<BodySlot> heard;
    reader(heard);
    fixed.insert(fixed.end(), heard.begin(), heard.end());
  });
  std::sort(fixed.begin(), fixed.end());
  // What the first of two brings is taken away by what the second brings.
  std::array<std::uint64_t, 3> sums{counts[0], counts[1], 0};
  for (BodySlot slot = 0; slot < bodies.slots(); ++slot) {
    if (!bodies.alive(slot)) continue;
    const BodySlot self = bodies.number(slot);
    store_.engine().transfer().kept_resting(slot).each_contact(self, [&](BodySlot other, std::uint64_t what) {
      if (std::ranges::binary_search(fixed, other)) return;
      const std::uint64_t hash = number_hash(std::min(self, other)) * (number_hash(std::max(self, other)) + what);
      sums[2] += self < other ? hash : -hash;
    });
  }
  team_.combine(sums, {});
  return sums[0] == sums[1] && sums[2] == 0;
}

/// Throws std::runtime_error if a sensor of this process cannot be one that is attached to a body of this process.
template <class Motion>
void Domains<Motion>::check_attached(BodySlot sensor, BodySlot owner) const {
  const std::array slots{store_.find(sensor), store_.find(owner)};
  const auto image = store_.bodies().image_of(slots, {});
  Bodies<Motion>::Image::check_attached(sensor, image.bodies[0], image.bodies[1]);
  if (turns<Motion> && keeps_orientation(image.bodies[0].placed.shape)) {
    throw std::runtime_error("snapshot: what keeps its orientation is attached");
  }
}

template <class Motion>
void Domains<Motion>::leave() {
  drop();
  division_.reset();
  heard_.clear(), changed_.clear(), overlaps_.clear();
  copies_made_ = 0;
}

#define KDS_INSTANTIATE(motion) KDS_TEMPLATE_PART class Domains<motion>;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
