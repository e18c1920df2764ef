// Worlds saved, and loaded again.
#include "collision/world/image.hpp"

#include "collision/shapes/mesh.hpp"

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>

namespace kds::collision {
namespace {

/// Options that decide events. Broad phase, window, threads and profile may be others.
template <class Archive>
void archive_options(Archive& archive, const WorldOptions& options, bool exact) {
  const auto same = [&](const char* what, auto value) {
    auto found = value;
    archive(found);
    if (found != value) {
      throw std::runtime_error(std::string("snapshot: it is of a world with other options: ") + what);
    }
  };
  same("response", static_cast<std::uint32_t>(options.response));
  same("walls", std::uint32_t{options.walls.has_value()});
  if (options.walls) {
    for (int d = 0; d < 3; ++d) same("walls", options.walls->min[d]), same("walls", options.walls->max[d]);
    same("walls.restitution", options.walls->restitution);
  }
  same("zeno.contacts", options.zeno.contacts);
  same("zeno.interval", options.zeno.interval);
  same("report_pairs", std::uint32_t{options.report_pairs});
  if (!options.report_pairs) return;
  same("broad_phase, which reports its pairs", std::uint32_t{exact});
  same("kdop, whose pairs are reported", options.kdop);
}

struct PairCollector final : PairListener {
  std::vector<std::pair<BodyId, BodyId>> pairs;
  void pair_began(BodyId a, BodyId b, double) override { pairs.emplace_back(a, b); }
  void pair_ended(BodyId a, BodyId b, double) override { std::erase(pairs, std::pair(a, b)); }
};

}  // namespace

template <int Degree>
std::vector<std::shared_ptr<const Mesh>> World<Degree>::meshes() const {
  std::vector<std::shared_ptr<const Mesh>> result;
  for (BodyId id = 0; id < bodies_.size(); ++id) {
    if (!bodies_[id].alive) continue;
    const PlacedShape placed = shape(id);
    const auto* const mesh = std::get_if<MeshShape>(&placed.shape);
    if (mesh && std::find(result.begin(), result.end(), mesh->mesh) == result.end()) result.push_back(mesh->mesh);
  }
  return result;
}

template <int Degree>
typename World<Degree>::Image World<Degree>::image() const {
  Image image;
  image.now = now_, image.clock = clock_, image.horizon = horizon_, image.has_had_meshes = meshes_,
  image.counters = counters();
  image.meshes = meshes();
  for (BodyId id = 0; id < bodies_.size(); ++id) {
    const Body& b = bodies_[id];
    auto& to = image.bodies.emplace_back();
    if (!b.alive) continue;
    if (b.extras && b.extras->box_function) {
      throw std::invalid_argument("World: body " + std::to_string(id) + " cannot be saved: it has a box function");
    }
    to.alive = true, to.entered = b.entered;
    to.placed = shape(id);
    if (const auto* const mesh = std::get_if<MeshShape>(&to.placed.shape)) {
      to.mesh = static_cast<std::uint32_t>(std::find(image.meshes.begin(), image.meshes.end(), mesh->mesh) -
                                           image.meshes.begin());
    }
    to.motion = movers_[id].motion;
    if (b.extras) to.script = b.extras->script;
    to.mass = b.mass, to.inverse_mass = b.inverse_mass, to.restitution = b.restitution;
    to.category = b.category, to.collides_with = b.collides_with, to.volume = b.volume;
    to.meetings = b.meetings, to.burst_start = b.burst_start;
    if constexpr (Degree >= 2) to.force = b.force;
  }
  for (PairSlot slot = 0; slot < pairs_.size(); ++slot) {
    if (!pairs_[slot].alive) continue;
    auto& to = image.pairs.emplace_back();
    to.pair = pairs_[slot];
    to.contact = contacts_.time(slot);
    if (slot < boxes_.slots()) to.boxes = boxes_.time(slot);
  }
  std::sort(image.pairs.begin(), image.pairs.end(),
            [](const auto& x, const auto& y) { return std::pair(x.pair.a, x.pair.b) < std::pair(y.pair.a, y.pair.b); });
  image.resting = resting_.image();
  image.free_bodies = free_bodies_, image.removed = removed_, image.removed_at = removed_at_;
  image.entering = entering_;
  image.pending = reports_.image();
  image.edits = edits_;
  return image;
}

template <int Degree>
void World<Degree>::set_shape(BodyId id, PlacedShape placed) {
  Body& b = bodies_[id];
  const auto* const ball = std::get_if<Sphere>(&placed.shape);
  b.bounding_radius = placed.bounding_radius;
  movers_[id].radius = ball ? ball->radius : Mover::no_radius;
  if (!ball || !placed.rotation.isIdentity(0)) b.shape = std::make_shared<const PlacedShape>(std::move(placed));
}

template <int Degree>
void World<Degree>::become(const Image& image) {
  now_ = image.now, clock_ = image.clock, horizon_ = image.horizon, meshes_ = image.has_had_meshes;
  idle_until_ = next_time_ = -never;
  inserting_ = false;
  edits_ = image.edits;
  free_bodies_ = image.free_bodies, removed_ = image.removed, removed_at_ = image.removed_at;
  entering_ = image.entering;
  reports_.become(image.pending);
  const std::size_t count = image.bodies.size();
  bodies_.clear(), movers_.clear(), links_.clear();
  bodies_.resize(count), movers_.resize(count);
  alive_ = 0;
  pieces_.resize(0), volumes_.resize(0), walls_.resize(0);
  pieces_.resize(count);
  for (BodyId id = 0; id < count; ++id) {
    const auto& from = image.bodies[id];
    if (!from.alive) continue;
    ++alive_;
    Body& b = bodies_[id];
    b.alive = true, b.entered = from.entered;
    set_shape(id, from.placed);
    movers_[id].motion = from.motion;
    b.mass = from.mass, b.inverse_mass = from.inverse_mass, b.restitution = from.restitution;
    b.category = from.category, b.collides_with = from.collides_with, b.volume = from.volume;
    filters_ = filters_ || b.category != default_category || ~b.collides_with != 0;
    place_extents(id);
    b.meetings = from.meetings, b.burst_start = from.burst_start;
    if constexpr (Degree >= 2) b.force = from.force;
    if (from.script.empty()) continue;
    b.extras = std::make_unique<Extras>(Extras{from.script, {}, {}});
    pieces_.set(id, from.script.back().start);
  }
  resting_.become(image.resting);
  load_pairs(image);
}

/// A broad phase of the bodies as they are now; pairs are listed as it finds them.
template <int Degree>
void World<Degree>::rebuild_broad_phase() {
  make_broad_phase();
  PairCollector found;
  std::vector<typename BroadPhase<Degree>::Entry> entries;
  std::vector<KineticBox<Degree>> boxes;
  for (BodyId id = 0; id < bodies_.size(); ++id) {
    if (!bodies_[id].entered || !collides(id)) continue;
    entries.push_back({id, nullptr});
    boxes.push_back(renewed_box(id));
    schedule_volume(id);
  }
  for (std::size_t i = 0; i < entries.size(); ++i) entries[i].box = &boxes[i];
  broad_phase_->insert(entries, now_, found);
  std::sort(found.pairs.begin(), found.pairs.end());
  for (PairSlot slot = 0; slot < pairs_.size(); ++slot) {
    const Pair& pair = pairs_[slot];
    if (!pair.alive || !pair.listed) continue;
    if (!std::binary_search(found.pairs.begin(), found.pairs.end(), std::pair(pair.a, pair.b))) {
      pair_ended(pair.a, pair.b, now_);
    }
  }
  for (const auto& [a, b] : found.pairs) {
    const PairSlot slot = find_pair(a, b);
    if (slot == no_pair || !pairs_[slot].listed) pair_began(a, b, now_);
  }
}

/// A search for an event without a limit has found none, and gone beyond all times: the clock is put back to where it
/// was. Nothing has happened since but that bounding volumes have met and parted.
template <int Degree>
void World<Degree>::go_back(double t) {
  if (now_ == t) return;
  now_ = t;
  counters_.broad_phase = counters_.broad_phase + broad_phase_->counters();
  rebuild_broad_phase();
}

/// The pairs that were known, and what has become of them in a broad phase made anew.
template <int Degree>
void World<Degree>::load_pairs(const Image& image) {
  pairs_.clear(), free_pairs_.clear(), dirty_.clear(), found_.clear();
  unlisted_ = 0;
  contacts_.resize(0), boxes_.resize(0);
  contacts_.resize(image.pairs.size());
  if (options_.report_pairs && !broad_phase_->exact()) boxes_.resize(image.pairs.size());
  for (const auto& from : image.pairs) {
    const auto slot = static_cast<PairSlot>(pairs_.size());
    Pair& pair = pairs_.emplace_back(from.pair);
    pair.alive = true, pair.dirty = false;
    pair.place_in_a = bodies_[pair.a].pairs.size;
    pair.place_in_b = bodies_[pair.b].pairs.size;
    links_.push_back(bodies_[pair.a].pairs, {pair.b, slot});
    links_.push_back(bodies_[pair.b].pairs, {pair.a, slot});
    contacts_.set(slot, from.contact);
    if (slot < boxes_.slots()) boxes_.set(slot, from.boxes);
    if (from.pair.dirty) mark_dirty(slot);
    unlisted_ += pair.listed ? 0 : 1;
  }
  for (BodyId id = 0; id < bodies_.size(); ++id) {
    if (bodies_[id].entered) schedule_wall(id);
  }
  rebuild_broad_phase();
  counters_ = image.counters;
  counters_.broad_phase = image.counters.broad_phase - broad_phase_->counters();
}

template <int Degree>
template <class Archive>
void World<Degree>::archive(Archive& archive) {
  // What has been interrupted may be loaded: then it is whole again.
  if (!Archive::loading || stepping_ || in_box_function_) require_idle("World::archive");
  archive.tag("World of degree " + std::to_string(Degree));
  archive_options(archive, options_, broad_phase_->exact());
  if constexpr (Archive::loading) {
    Image loaded;
    loaded.archive(archive, meshes());
    loaded.check(options_);
    change_or_fail([&] { become(loaded); });
    failure_ = nullptr;
  } else {
    Image saved = image();
    saved.archive(archive, {});
  }
}

template class World<1>;
template class World<2>;
template void World<1>::archive(kds::detail::Writer&);
template void World<1>::archive(kds::detail::Reader&);
template void World<2>::archive(kds::detail::Writer&);
template void World<2>::archive(kds::detail::Reader&);

}  // namespace kds::collision
