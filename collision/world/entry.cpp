// How bodies come into the world.
#include "collision/parallel.hpp"
#include "collision/profile.hpp"
#include "collision/world.hpp"
#include "collision/world/queue_room.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>

namespace kds::collision {
namespace {

template <int Degree>
void validate(const BodyDescription<Degree>& description) {
  const auto fail = [](const std::string& what) { throw std::invalid_argument(what); };
  if (description.motion.empty()) fail("motion: has no piece");
  for (std::size_t i = 0; i < description.motion.size(); ++i) {
    const auto& piece = description.motion[i];
    if (!in_range(piece)) refuse_motion(piece, "motion[" + std::to_string(i) + "]");
    if (i > 0 && !(piece.start > description.motion[i - 1].start)) {
      fail("motion[" + std::to_string(i) + "].start: pieces must be sorted by start");
    }
  }
  if (!description.fixed) require_size(description.mass, "mass");
  switch (description.volume) {
    case BoundingVolume::shape:
    case BoundingVolume::sphere:
      break;
    default:
      fail("volume: unknown");
  }
  if (!(description.restitution >= 0 && description.restitution <= 1)) fail("restitution: must be in [0, 1]");
}

}  // namespace

/// Those that were removed at an earlier time: all that has happened to them has been told.
template <int Degree>
inline void World<Degree>::free_removed() {
  if (removed_.empty() || !(removed_at_ < now_)) return;
  free_bodies_.insert(free_bodies_.end(), removed_.begin(), removed_.end());
  removed_.clear();
}

/// The number of one that is still to be described.
template <int Degree>
inline BodyId World<Degree>::new_body() {
  free_removed();
  if (!free_bodies_.empty()) {
    const BodyId id = free_bodies_.back();
    free_bodies_.pop_back();
    return id;
  }
  const auto id = static_cast<BodyId>(bodies_.size());
  bodies_.emplace_back();
  movers_.emplace_back();
  return id;
}

template <int Degree>
BodyId World<Degree>::add_body(const Description& description) {
  require_editable("World::add_body");
  validate(description);
  count_edit();
  const auto* const ball = std::get_if<Sphere>(&description.shape);
  std::shared_ptr<const PlacedShape> shape;
  if (ball && description.orientation.coeffs() == Eigen::Quaterniond::Identity().coeffs()) [[likely]] {
    require_radius(ball->radius);
  } else {
    shape = std::make_shared<const PlacedShape>(place(description.shape, description.orientation));
  }
  return change_or_fail([&] { return put(description, std::move(shape)); });
}

/// No shape is that of a ball that is not turned.
template <int Degree>
inline BodyId World<Degree>::put(const Description& description, std::shared_ptr<const PlacedShape> shape) {
  const auto* const ball = std::get_if<Sphere>(&description.shape);
  // Pieces that are over are skipped; the rest is a script.
  auto piece = description.motion.begin();
  while (std::next(piece) != description.motion.end() && std::next(piece)->start <= now_) ++piece;
  if (std::holds_alternative<MeshShape>(description.shape)) allow_for_meshes();
  const BodyId id = new_body();
  Body& added = bodies_[id];
  added.bounding_radius = shape ? shape->bounding_radius : ball->radius;
  added.shape = std::move(shape);
  added.mass = description.mass;
  added.inverse_mass = description.fixed ? 0 : 1 / description.mass;
  added.restitution = description.restitution;
  added.category = description.category;
  added.collides_with = description.collides_with;
  filters_ = filters_ || description.category != default_category || ~description.collides_with != 0;
  added.volume = description.volume;
  added.alive = true;
  movers_[id].motion = *piece;
  movers_[id].radius = ball ? ball->radius : Mover::no_radius;
  if constexpr (Degree >= 2) added.force = piece->coefficients[2];
  if (!directions_.empty()) place_extents(id);
  ++alive_;
  const bool enters_now = piece->start <= now_;
  if (enters_now) {
    entering_.push_back(id);
    ++piece;
  }
  if (description.box || piece != description.motion.end()) {
    set_extras(id, {piece, description.motion.end()}, description.box);
  }
  return id;
}

/// Pieces of motion to come, and a box function, which may be empty.
template <int Degree>
void World<Degree>::set_extras(BodyId id, std::span<const Motion> script,
                               const typename Description::BoxFunction& box_function) {
  Extras extras{{script.rbegin(), script.rend()}, box_function, {}};  // next piece last
  if (box_function) {
    make_room(volumes_, bodies_.size());
    box_functions_ = true;
  }
  make_room(pieces_, bodies_.size());
  if (!script.empty()) pieces_.set(id, script.front().start);
  bodies_[id].extras = std::make_unique<Extras>(std::move(extras));
}

template <int Degree>
void World<Degree>::reserve(std::size_t bodies) {
  require_editable("World::reserve");
  if (bodies > no_body) {
    throw std::length_error("World::reserve: " + std::to_string(bodies) + " bodies are more than there are ids");
  }
  bodies_.reserve(bodies);
  movers_.reserve(bodies);
  entering_.reserve(bodies);
  if (options_.walls && walls_.slots() < bodies) walls_.resize(bodies);
}

template <int Degree>
void World<Degree>::enter_new_bodies() {
  std::vector<BodyId> entering;
  entering.swap(entering_);
  // What is due now among the others comes first, lest it count as what the new ones bring.
  while (broad_phase_->advance(now_, *this)) {
  }
  std::vector<Entry> entries;
  entries.reserve(entering.size());
  for (const BodyId id : entering) {
    Body& b = bodies_[id];
    if (!b.alive || b.entered) continue;
    b.entered = true;
    entries.push_back({id, nullptr});
  }
  const auto boxes = std::make_unique_for_overwrite<KineticBox<Degree>[]>(entries.size());
  // The functions of callers are called by their own thread, and in order.
  const std::size_t threads = box_functions_ ? 1 : threads_for(entries.size(), options_.threads);
  in_parts(entries.size(), threads, [&](std::size_t, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      entries[i].box = new (&boxes[i]) KineticBox<Degree>(renewed_box(entries[i].id));  // not copied there
    }
  });
  const std::span<const Entry> all(entries);
  std::size_t colliding = entries.size();
  if (filters_) {
    const auto rest =
        std::stable_partition(entries.begin(), entries.end(), [&](const Entry& entry) { return collides(entry.id); });
    colliding = static_cast<std::size_t>(rest - entries.begin());
  }
  inserting_ = true;
  {
    const Stopwatch watch(profile(), Work::update);
    broad_phase_->insert(all.first(colliding), now_, *this);
  }
  inserting_ = false;
  schedule_walls(entries);
  if (!box_functions_ && !meshes_) return;
  for (const Entry& entry : entries) schedule_volume(entry.id);
}

template class World<1>;
template class World<2>;

}  // namespace kds::collision
