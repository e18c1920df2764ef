#include "collision/world/pairs/pairs.hpp"

#include "certificates/ball_separation.hpp"
#include "collision/motions.hpp"
#include "collision/shapes/bending_mesh.hpp"
#include "collision/world/queue_room.hpp"
#include "kds/audit.hpp"

#include <algorithm>
#include <string>

namespace kds::collision {

template <class Motion>
Pairs<Motion>::Pairs(const Bodies<Motion>& bodies, const Volumes<Motion>& volumes, Resting& resting, Reports& reports,
                     const WorldOptions& options, Clock& clock, WorldCounters& counters, Profile* profile)
    : bodies_(bodies),
      volumes_(volumes),
      resting_(resting),
      reports_(reports),
      options_(options),
      clock_(clock),
      counters_(counters),
      profile_(profile),
      contacts_(detail::PairRank{&pairs_, &bodies.keys()}),
      boxes_(detail::PairRank{&pairs_, &bodies.keys()}) {}

/// Reserves room for these pairs and some more, if they are the first.
template <class Motion>
void Pairs<Motion>::pairs_to_come(std::size_t pairs) {
  if (pairs_.empty()) make_room_for(pairs + pairs / 4);
}

template <class Motion>
void Pairs<Motion>::reserve(std::size_t bodies) {
  of_.reserve(bodies);
  make_room_for(bodies + bodies / 4);
}

template <class Motion>
void Pairs<Motion>::make_room_for(std::size_t pairs) {
  if (pairs <= pairs_.capacity()) return;
  const std::size_t more = pairs - pairs_.size();
  pairs_.reserve(pairs);
  dirty_.reserve(pairs);
  make_room(contacts_, pairs);
  links_.reserve(2 * first_pairs * more);
}

/// Pairs with an unbounded body are listed by Unbounded, not by the broad phase.
template <class Motion>
bool Pairs<Motion>::visit_pairs(BodySlot body, SlotVisitor visit) const {
  for (const Link& link : links(body)) {
    if (pairs_[link.slot].listed && !bodies_.unbounded(link.other)) visit(link.other);
  }
  return true;
}

template <class Motion>
void Pairs<Motion>::pair_began(BodySlot a, BodySlot b, double t) {
  const Stopwatch watch(profile_, Work::prune);
  clock_.now = t;
  if (bodies_.filters() && !bodies_.may_collide(a, b)) return;
  const Slot overlapping = unlisted_ > 0 ? find(a, b) : none;
  if (overlapping != none) --unlisted_;
  const Slot slot = overlapping != none ? overlapping : add(a, b);
  Pair& pair = pairs_[slot];
  pair.listed = true;
  // A pair that overlaps is known, and its jumps too (motion_changed), however often filters change at this instant.
  if (overlapping == none) {
    const bool jumps = begin_ == Begin::jumping || edits_.has_jumped(a, t) || edits_.has_jumped(b, t);
    pair.fresh = begin_ == Begin::entering || newly_allowed(a, b) || (jumps && mode(a, b) == ContactMode::resolved);
  }
  ++counters_.pairs_begun;
  mark_dirty(slot);
  if (!options_.report_pairs) return;
  pair.boxes_overlap = !exact_ && unbounded(pair);
  if (exact_ || pair.boxes_overlap) report_boxes(true, pair.a, pair.b);
}

template <class Motion>
inline typename Pairs<Motion>::Slot Pairs<Motion>::add(BodySlot a, BodySlot b) {
  if (bodies_.before(b, a)) std::swap(a, b);
  Slot slot;
  if (free_.empty()) {
    slot = static_cast<Slot>(pairs_.size());
    if (pairs_.capacity() == 0) pairs_.reserve(first_slots), dirty_.reserve(first_slots);
    pairs_.emplace_back();
    make_room(contacts_, pairs_.size());
    if (follows_boxes_) make_room(boxes_, pairs_.size());
  } else {
    slot = free_.back();
    free_.pop_back();
  }
  Pair& pair = pairs_[slot];
  pair = Pair{};
  pair.a = a;
  pair.b = b;
  pair.alive = true;
  link(slot, bodies_.size() <= few_pairs + 1 ? few_pairs : first_pairs);
  return slot;
}

/// Adds a pair to the lists of its bodies.
template <class Motion>
inline void Pairs<Motion>::link(Slot slot, std::uint32_t first_room) {
  Pair& pair = pairs_[slot];
  if (of_.size() <= std::max(pair.a, pair.b)) of_.resize(bodies_.slots());
  pair.place_in_a = of_[pair.a].size;
  pair.place_in_b = of_[pair.b].size;
  links_.push_back(of_[pair.a], {pair.b, slot}, first_room);
  links_.push_back(of_[pair.b], {pair.a, slot}, first_room);
}

template <class Motion>
void Pairs<Motion>::pair_ended(BodySlot a, BodySlot b, double t) {
  const Stopwatch watch(profile_, Work::prune);
  clock_.now = t;
  const Slot slot = find(a, b);
  if (slot == none) return;  // filtered
  unlist(slot);
  if (pairs_[slot].overlapping) {
    mark_dirty(slot);
  } else {
    release(slot);
  }
}

template <class Motion>
void Pairs<Motion>::list_anew(std::span<const std::pair<BodySlot, BodySlot>> listed) {
  for (Slot slot = 0; slot < pairs_.size(); ++slot) {
    const Pair& pair = pairs_[slot];
    if (!pair.alive || !pair.listed) continue;
    if (!std::binary_search(listed.begin(), listed.end(), IgnoredPairs::pair(pair.a, pair.b))) {
      pair_ended(pair.a, pair.b, clock_.now);
    }
  }
  for (const auto& [a, b] : listed) {
    if (!this->listed(a, b)) pair_began(a, b, clock_.now);
  }
}

/// The broad phase does not list the pair any more.
template <class Motion>
void Pairs<Motion>::unlist(Slot slot) {
  Pair& pair = pairs_[slot];
  if (options_.report_pairs && (exact_ || pair.boxes_overlap)) report_boxes(false, pair.a, pair.b);
  pair.boxes_overlap = false;
  pair.listed = false;
  ++unlisted_;
  if (slot < boxes_.slots()) boxes_.clear(slot);
}

template <class Motion>
typename Pairs<Motion>::Slot Pairs<Motion>::find(BodySlot a, BodySlot b) const {
  const auto of_a = links(a);
  const auto of_b = links(b);
  const bool from_a = of_a.size() <= of_b.size();
  const BodySlot other = from_a ? b : a;
  for (const Link& link : from_a ? of_a : of_b) {
    if (link.other == other) return link.slot;
  }
  return none;
}

/// Precondition: it is not listed.
template <class Motion>
void Pairs<Motion>::release(Slot slot) {
  Pair& pair = pairs_[slot];
  // The last entry of each body's list takes the place of the one removed.
  for (const BodySlot id : {pair.a, pair.b}) {
    const auto of_body = links_.items(of_[id]);
    const std::uint32_t place = id == pair.a ? pair.place_in_a : pair.place_in_b;
    const Link moved = of_body.back();
    of_body[place] = moved;
    links_.pop_back(of_[id]);
    Pair& other = pairs_[moved.slot];
    (id == other.a ? other.place_in_a : other.place_in_b) = place;
  }
  contacts_.clear(slot);
  --unlisted_;
  pair.alive = false;
  free_.push_back(slot);
}

template <class Motion>
double Pairs<Motion>::balls_apart_until(Slot slot, double larger) const {
  const Pair& pair = pairs_[slot];
  const auto bent = [this](BodySlot body) { return bodies_[body].shape && bends(bodies_[body].shape->shape); };
  if (pair.fresh || pair.overlapping || unbounded(pair) || bent(pair.a) || bent(pair.b)) return clock_.now;
  using Balls = certificates::BallSeparation<Motion::degree>;
  const auto radius = [&](BodySlot body) { return (1 + larger) * bodies_[body].bounding_radius; };
  return Balls{bodies_.path(pair.a), bodies_.path(pair.b), radius(pair.a), radius(pair.b)}.apart_until(clock_.now);
}

template <class Motion>
void Pairs<Motion>::box_changed(BodySlot id) {
  if (!follows_boxes_) return;  // the broad phase finds anew when it meets others
  for (const Link& link : links(id)) mark_dirty(link.slot);
}

template <class Motion>
void Pairs<Motion>::changed(BodySlot a, BodySlot b) {
  const Slot slot = find(a, b);
  if (slot != none) mark_dirty(slot);
}

template <class Motion>
void Pairs<Motion>::go_on_overlapping(BodySlot a, BodySlot b, double passes_at) {
  Slot slot = find(a, b);
  if (slot == none) {
    slot = add(a, b);
    ++unlisted_;
  }
  Pair& pair = pairs_[slot];
  pair.overlapping = true;
  pair.fresh = false;
  pair.passes_at = passes_at;
  mark_dirty(slot);
}

/// Ends a pair that overlaps, or has just separated, and that the broad phase has ended: the two separate, unless their
/// overlap has not been reported yet.
template <class Motion>
void Pairs<Motion>::end(Slot slot) {
  const Pair& pair = pairs_[slot];
  if (mode(pair.a, pair.b) == ContactMode::transparent && pair.overlapping &&
      !reports_.take_back(Reports::Kind::overlap, bodies_.id_of(pair.a), bodies_.id_of(pair.b))) {
    reports_.add(Reports::Kind::separation, bodies_.id_of(pair.a), bodies_.id_of(pair.b),
                 contact(pair.a, pair.b, clock_.now));
  }
  release(slot);
}

template <class Motion>
void Pairs<Motion>::remove(BodySlot id) {
  while (!links(id).empty()) end(links(id).back().slot);
  if (id < of_.size()) links_.free(of_[id]);
  edits_.forget(id);
}

template <class Motion>
void Pairs<Motion>::filter_changed(BodySlot id, const CollisionFilter& before) {
  edits_.add_filter(id, before, clock_.now);
  end_filtered(id);
}

template <class Motion>
void Pairs<Motion>::ignoring_changed(BodySlot a, BodySlot b) {
  edits_.add_ignored(a, b, clock_.now);
  end_filtered(a);
}

template <class Motion>
void Pairs<Motion>::end_filtered(BodySlot id) {
  std::vector<Slot> over;
  for (const Link& link : links(id)) {
    if (!bodies_.may_collide(id, link.other)) over.push_back(link.slot);
  }
  for (const Slot slot : over) end(slot);
}

template <class Motion>
void Pairs<Motion>::visit_overlapped(BodySlot id, SlotVisitor visit) const {
  for (const Link& link : links(id)) {
    if (pairs_[link.slot].overlapping && mode(id, link.other) == ContactMode::transparent) visit(link.other);
  }
}

template <class Motion>
void Pairs<Motion>::extend_horizon() {
  for (Slot slot = 0; slot < pairs_.size(); ++slot) {
    const bool boxes_known = slot >= boxes_.slots() || boxes_.contains(slot);
    if (pairs_[slot].alive && !(contacts_.contains(slot) && boxes_known)) mark_dirty(slot);
  }
}

template <class Motion>
bool Pairs<Motion>::overlapping(BodySlot a, BodySlot b) const {
  const Slot slot = find(a, b);
  return slot != none && pairs_[slot].overlapping;
}

template <class Motion>
bool Pairs<Motion>::listed(BodySlot a, BodySlot b) const {
  const Slot slot = find(a, b);
  return slot != none && pairs_[slot].listed;
}

/// Does not make the shapes of balls.
template <class Motion>
Contact Pairs<Motion>::contact(BodySlot a, BodySlot b, double t, const FoundTouch& found) const {
  const auto& of_a = bodies_.mover(a);
  const auto& of_b = bodies_.mover(b);
  if (of_a.radius > 0 && of_b.radius > 0) {
    return ball_contact_at(of_a.motion, of_b.motion, of_a.radius, t);
  }
  if constexpr (!turns<Motion>) {
    if (resting_.find(a, b) != Resting::none) return resting_.contact_at(a, b, t, found);
  }
  return contact_at(bodies_.moving(a), bodies_.moving(b), t, found);
}

template <class Motion>
void Pairs<Motion>::audit(double t) const {
  std::size_t unlisted = 0;
  for (Slot slot = 0; slot < pairs_.size(); ++slot) {
    const Pair& pair = pairs_[slot];
    if (!pair.alive) continue;
    const auto fail = [&](const char* what) {
      throw AuditFailure("World: bodies " + std::to_string(bodies_.id_of(pair.a)) + " and " +
                         std::to_string(bodies_.id_of(pair.b)) + ": " + what);
    };
    unlisted += pair.listed ? 0 : 1;
    if (!pair.overlapping && !pair.listed) fail("a pair that neither overlaps nor is listed");
    if (!pair.overlapping || pair.passes_at == t || contacts_.time(slot) <= t) continue;
    if (!in_contact(bodies_.moving(pair.a), bodies_.moving(pair.b), t)) {
      fail("they count as overlapping, and do not penetrate");
    }
  }
  if (unlisted != unlisted_) throw AuditFailure("World: pairs that are not listed are miscounted");
}

#define KDS_INSTANTIATE(motion) template class Pairs<motion>;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
