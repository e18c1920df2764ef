// Bodies and pairs of the world.
#include "collision/profile.hpp"
#include "collision/world.hpp"
#include "collision/world/queue_room.hpp"
#include "kds/raised_flag.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace kds::collision {
namespace {

/// A new motion whose position differs from the old one's by more than this, relative to the coordinates and the
/// body's size, is a jump: far above what restarting a motion rounds, far below what a caller would mean as one.
constexpr double jump_tolerance = 0x1p-40;

/// Room for pairs that a body gets with its first; where there are few bodies, for all.
constexpr std::uint32_t first_pairs = 4;
constexpr std::uint32_t few_pairs = 8;

}  // namespace

template <int Degree>
const typename World<Degree>::Body& World<Degree>::body(BodyId id) const {
  if (!contains(id)) throw std::out_of_range("World: there is no body " + std::to_string(id));
  return bodies_[id];
}

template <int Degree>
typename World<Degree>::Body& World<Degree>::body(BodyId id) {
  return const_cast<Body&>(static_cast<const World&>(*this).body(id));
}

template <int Degree>
void World<Degree>::remove_body(BodyId id) {
  require_editable("World::remove_body");
  body(id);
  count_edit();
  change_or_fail([&] { take_out(id); });
}

template <int Degree>
void World<Degree>::take_out(BodyId id) {
  Body& removed = bodies_[id];
  resting_.forget(id);
  removed.alive = false;
  clear(pieces_, id);
  clear(volumes_, id);
  clear(walls_, id);
  if (removed.entered) {
    if (collides(id)) broad_phase_->remove(id, now_, *this);
  } else {
    std::erase(entering_, id);  // or the next of this id would enter in its stead
  }
  while (!removed.pairs.empty()) {  // those that overlap, or have just separated
    const PairSlot slot = links_.items(removed.pairs).back().slot;
    const Pair& pair = pairs_[slot];
    // They separate, unless it has not been told yet that they overlap.
    if (mode() == ContactMode::transparent && pair.overlapping &&
        !reports_.take_back(Reports::Kind::overlap, pair.a, pair.b)) {
      reports_.add(Reports::Kind::separation, pair.a, pair.b, contact_of(pair.a, pair.b, now_));
    }
    release_pair(slot);
  }
  links_.free(removed.pairs);
  if (!reports_.empty()) reports_.keep_of(id);
  removed = Body{};
  free_removed();
  removed_.push_back(id);
  removed_at_ = now_;
  --alive_;
}

template <int Degree>
void World<Degree>::update_motion(BodyId id, const Motion& motion) {
  require_editable("World::update_motion");
  body(id);
  if (!in_range(motion)) refuse_motion(motion, "World::update_motion: motion");
  if (motion.start > now_) {
    throw std::invalid_argument("World::update_motion: the motion starts at " + std::to_string(motion.start) +
                                ", after the clock at " + std::to_string(now_));
  }
  count_edit();
  change_or_fail([&] { give(id, motion); });
}

template <int Degree>
void World<Degree>::give(BodyId id, const Motion& motion) {
  Body& b = bodies_[id];
  if (b.extras) b.extras->script.clear();
  clear(pieces_, id);
  ++counters_.motion_updates;
  if constexpr (Degree >= 2) b.force = motion.coefficients[2];
  if (!b.entered) {
    movers_[id].motion = motion;
    if (std::find(entering_.begin(), entering_.end(), id) == entering_.end()) entering_.push_back(id);
    return;
  }
  const bool jumped = is_jump(id, motion);
  if (jumped) resting_.drop_all(id);
  set_motion(id, motion, jumped);
  resting_.disturb(id);
}

template <int Degree>
bool World<Degree>::is_jump(BodyId id, const Motion& to) const {
  const Eigen::Vector3d before = movers_[id].motion.position(now_);
  const Eigen::Vector3d after = to.position(now_);
  const double scale = before.cwiseAbs().maxCoeff() + after.cwiseAbs().maxCoeff() + bodies_[id].bounding_radius;
  return (after - before).cwiseAbs().maxCoeff() > jump_tolerance * scale;
}

template <int Degree>
void World<Degree>::set_motion(BodyId id, const Motion& motion, bool jumped) {
  const Stopwatch watch(profile(), Work::update);
  Body& b = bodies_[id];
  movers_[id].motion = motion;
  for (const Link& link : links_.items(b.pairs)) {  // while the broad phase is at work
    __builtin_prefetch(&pairs_[link.slot], 1);
    __builtin_prefetch(&movers_[link.other]);
  }
  inserting_ = jumped && mode() == ContactMode::resolved;
  if (collides(id)) broad_phase_->update(id, renewed_box(id), now_, *this);
  for (const Link& link : links_.items(b.pairs)) mark_dirty(link.slot);
  if (inserting_) {
    for (const Link& link : links_.items(b.pairs)) pairs_[link.slot].fresh = true;
    inserting_ = false;
  }
  schedule_wall(id);
  schedule_volume(id);
}

/// The bounding volume as it is: what the caller's function gave last, or what the motion gives.
template <int Degree>
inline KineticBox<Degree> World<Degree>::bounding_box(BodyId id) const {
  if (meshes_) return grown(id, bare_box(id));
  return bare_box(id);
}

/// The same without room for the contact gap of meshes.
template <int Degree>
inline KineticBox<Degree> World<Degree>::bare_box(BodyId id) const {
  const Body& b = bodies_[id];
  if (b.extras && b.extras->box_function) return b.extras->box;
  const bool sphere = !b.shape || b.volume == BoundingVolume::sphere;
  const Eigen::Vector3d reach = Eigen::Vector3d::Constant(b.bounding_radius);
  const double rounding = sphere && !options_.report_pairs ? b.bounding_radius : 0;  // of boxes those are told
  return box_around<Degree>(movers_[id].motion, sphere ? -reach : b.shape->low, sphere ? reach : b.shape->high,
                            rounding);
}

/// A bounding volume for the present motion.
template <int Degree>
KineticBox<Degree> World<Degree>::renewed_box(BodyId id) {
  Extras* const extras = bodies_[id].extras.get();
  if (extras && extras->box_function) {
    const KineticBox<Degree> box = [&] {
      const kds::detail::RaisedFlag calling(in_box_function_);
      return extras->box_function(now_, movers_[id].motion);
    }();
    if (!box.min.finite() || !box.max.finite()) {
      throw std::invalid_argument("BodyDescription.box: returned a box that is not finite");
    }
    if (!(box.valid_until > now_)) {
      throw std::invalid_argument("BodyDescription.box: returned a box whose validity has ended");
    }
    extras->box = box;
  }
  return bounding_box(id);
}

template <int Degree>
void World<Degree>::schedule_volume(BodyId id) {
  const Extras* const extras = bodies_[id].extras.get();
  const bool box_function = extras && extras->box_function;
  if (!box_function && !meshes_) return;
  const double until = box_function ? extras->box.valid_until : clearance_until(id);
  if (until <= horizon_ && until < never) {
    make_room(volumes_, bodies_.size());
    volumes_.set(id, until);
  } else {
    clear(volumes_, id);
  }
}

/// Room for them and some more, if they are the first.
template <int Degree>
void World<Degree>::pairs_to_come(std::size_t pairs) {
  if (!pairs_.empty()) return;
  const std::size_t room = pairs + pairs / 4;
  pairs_.reserve(room);
  dirty_.reserve(room);
  make_room(contacts_, room);
  links_.reserve(2 * first_pairs * pairs);
}

template <int Degree>
void World<Degree>::pair_began(BodyId a, BodyId b, double t) {
  const Stopwatch watch(profile(), Work::prune);
  now_ = t;
  if (!may_collide(a, b)) return;
  const PairSlot overlapping = unlisted_ > 0 ? find_pair(a, b) : no_pair;
  if (overlapping != no_pair) --unlisted_;
  const PairSlot slot = overlapping != no_pair ? overlapping : new_pair(a, b);
  Pair& pair = pairs_[slot];
  pair.listed = true;
  pair.fresh = pair.fresh || inserting_;
  ++counters_.pairs_begun;
  mark_dirty(slot);
  if (options_.report_pairs && broad_phase_->exact()) reports_.add_volumes(true, a, b, now_);
}

template <int Degree>
inline typename World<Degree>::PairSlot World<Degree>::new_pair(BodyId a, BodyId b) {
  Body& body_a = bodies_[a];
  Body& body_b = bodies_[b];
  PairSlot slot;
  if (free_pairs_.empty()) {
    slot = static_cast<PairSlot>(pairs_.size());
    if (pairs_.capacity() == 0) pairs_.reserve(first_slots), dirty_.reserve(first_slots);
    pairs_.emplace_back();
    make_room(contacts_, pairs_.size());
    if (options_.report_pairs && !broad_phase_->exact()) make_room(boxes_, pairs_.size());
  } else {
    slot = free_pairs_.back();
    free_pairs_.pop_back();
  }
  Pair& pair = pairs_[slot];
  pair = Pair{};
  pair.a = a;
  pair.b = b;
  pair.place_in_a = body_a.pairs.size;
  pair.place_in_b = body_b.pairs.size;
  pair.alive = true;
  const std::uint32_t first_room = alive_ <= few_pairs + 1 ? few_pairs : first_pairs;
  links_.push_back(body_a.pairs, {b, slot}, first_room);
  links_.push_back(body_b.pairs, {a, slot}, first_room);
  return slot;
}

template <int Degree>
void World<Degree>::pair_ended(BodyId a, BodyId b, double t) {
  const Stopwatch watch(profile(), Work::prune);
  now_ = t;
  const PairSlot slot = find_pair(a, b);
  if (slot == no_pair) return;  // filtered
  unlist(slot);
  if (pairs_[slot].overlapping) {
    mark_dirty(slot);
  } else {
    release_pair(slot);
  }
}

/// The broad phase does not list the pair any more.
template <int Degree>
void World<Degree>::unlist(PairSlot slot) {
  Pair& pair = pairs_[slot];
  if (options_.report_pairs && (broad_phase_->exact() || pair.boxes_overlap))
    reports_.add_volumes(false, pair.a, pair.b, now_);
  pair.boxes_overlap = false;
  pair.listed = false;
  ++unlisted_;
  if (slot < boxes_.slots()) boxes_.clear(slot);
}

template <int Degree>
typename World<Degree>::PairSlot World<Degree>::find_pair(BodyId a, BodyId b) const {
  const bool from_a = bodies_[a].pairs.size <= bodies_[b].pairs.size;
  const BodyId other = from_a ? b : a;
  for (const Link& link : links_.items(bodies_[from_a ? a : b].pairs)) {
    if (link.other == other) return link.slot;
  }
  return no_pair;
}

/// Precondition: it is not listed.
template <int Degree>
void World<Degree>::release_pair(PairSlot slot) {
  Pair& pair = pairs_[slot];
  // Each body's list closes up with its last entry.
  for (const BodyId id : {pair.a, pair.b}) {
    const auto links = links_.items(bodies_[id].pairs);
    const std::uint32_t place = id == pair.a ? pair.place_in_a : pair.place_in_b;
    const Link moved = links.back();
    links[place] = moved;
    links_.pop_back(bodies_[id].pairs);
    (id < moved.other ? pairs_[moved.slot].place_in_a : pairs_[moved.slot].place_in_b) = place;
  }
  contacts_.clear(slot);
  --unlisted_;
  pair.alive = false;
  free_pairs_.push_back(slot);
}

/// Lets a pair pass until it has separated, and at this time whatever else happens, even if its boxes do not overlap
/// just now.
template <int Degree>
void World<Degree>::let_pass(BodyId a, BodyId b) {
  PairSlot slot = find_pair(a, b);
  if (slot == no_pair) {
    slot = new_pair(a, b);
    ++unlisted_;
  }
  Pair& pair = pairs_[slot];
  pair.overlapping = true;
  pair.fresh = false;
  pair.passes_at = now_;
  mark_dirty(slot);
}

template <int Degree>
void World<Degree>::mark_dirty(PairSlot slot) {
  if (pairs_[slot].dirty) return;
  pairs_[slot].dirty = true;
  dirty_.push_back(slot);
}

template <int Degree>
bool World<Degree>::touching(BodyId a, BodyId b) const {
  body(a), body(b);
  if (a > b) std::swap(a, b);
  const PairSlot slot = find_pair(a, b);
  return slot != no_pair && mode() == ContactMode::transparent && pairs_[slot].overlapping;
}

template class World<1>;
template class World<2>;

}  // namespace kds::collision
