// How bodies are added to the kinetic grid.
#include "collision/broad_phase/box_pairs.hpp"
#include "collision/broad_phase/kinetic_grid.hpp"
#include "collision/broad_phase/typical_spacing.hpp"
#include "collision/degrees.hpp"
#include "collision/in_parts.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

namespace kds::collision {
namespace {

/// Fewer bodies fit into the cache in any order.
constexpr std::size_t few = 4096;

/// The order in which many bodies are added at once: by blocks of space, along [Morton66]'s curve, so that a body's
/// neighbours and cells have just been used and are in the cache.
template <int Degree>
std::vector<BodySlot> spatial_order(std::span<const typename BroadPhase<Degree>::Entry> bodies, double now) {
  constexpr std::size_t bodies_per_block = 8;
  const auto place = [&](std::size_t i) { return box_at(*bodies[i].box, now).min; };
  Eigen::Array3d low = place(0);
  Eigen::Array3d high = low;
  for (std::size_t i = 1; i < bodies.size(); ++i) {
    const Eigen::Array3d at = place(i);
    low = low.min(at);
    high = high.max(at);
  }
  const int levels = (static_cast<int>(std::bit_width(bodies.size() / bodies_per_block)) - 1) / 3;
  const Eigen::Array3d scale = std::ldexp(1.0, levels) / (high - low);
  const double last = std::ldexp(1.0, levels) - 1;
  const auto block_of = [&](std::size_t i) {
    const Eigen::Array3d x = (place(i) - low) * scale;
    std::size_t block = 0;
    for (int d = 0; d < 3; ++d) {
      const auto along = x[d] > 0 ? static_cast<std::size_t>(std::min(x[d], last)) : 0;
      for (int bit = 0; bit < levels; ++bit) block |= (along >> bit & 1) << (3 * bit + d);
    }
    return static_cast<std::uint32_t>(block);
  };
  std::vector<std::uint32_t> blocks(bodies.size());
  std::vector<std::uint32_t> places((std::size_t{1} << 3 * levels) + 1, 0);
  for (std::size_t i = 0; i < bodies.size(); ++i) ++places[(blocks[i] = block_of(i)) + 1];
  std::partial_sum(places.begin(), places.end(), places.begin());
  std::vector<BodySlot> order(bodies.size());
  for (std::size_t i = 0; i < bodies.size(); ++i) order[places[blocks[i]]++] = bodies[i].slot;
  return order;
}

}  // namespace

/// Chooses the cells for the first bodies, of which some are given.
template <int Degree>
void KineticGrid<Degree>::prepare(std::size_t bodies, std::span<const Entry> some, double now) {
  const double among = typical_spacing(some.size(), [&](std::size_t i) { return box_at(*some[i].box, now); });
  const double spacing = among * std::cbrt(static_cast<double>(some.size()) / static_cast<double>(bodies));
  first_travel_ = tuning_.first_travel * spacing;
  for (Filter& filter : filters_) filter.travel = 0;
  fat_boxes_.choose_cells(spacing);
}

/// Of boxes that are guests of coarser levels room is not made: how many there will be nobody knows.
template <int Degree>
void KineticGrid<Degree>::reserve(BodySlot end) {
  if (end <= bodies_.size()) return;
  bodies_.resize(end);
  expiry_.resize(end);
  // A queue keeps the room that events have had.
  std::vector<BodySlot> added;
  for (BodySlot id = 0; id < end; ++id) {
    if (expiry_.contains(id)) continue;
    expiry_.set(id, 0);
    added.push_back(id);
  }
  for (const BodySlot id : added) expiry_.clear(id);
  fat_boxes_.reserve(end);
}

template <int Degree>
void KineticGrid<Degree>::expect(std::size_t bodies, BodySlot end, std::span<const Entry> some, double now) {
  // Memory is used when the bodies come.
  bodies_.reserve(end);
  fat_boxes_.expect(end);
  if (fat_boxes_.size() > 0 || some.empty()) return;
  prepare(bodies, some, now);
  expected_ = true;
}

template <int Degree>
void KineticGrid<Degree>::insert(std::span<const Entry> bodies, double now, PairListener& listener) {
  if (bodies.empty()) return;
  BodySlot end = 0;
  for (const Entry& entry : bodies) end = std::max(end, entry.slot + 1);
  if (end > bodies_.size()) {
    const std::size_t room = bodies_.empty() ? end : std::max<std::size_t>(end, 2 * bodies_.size());
    bodies_.resize(std::min(room, std::max<std::size_t>(bodies_.capacity(), end)));
    expiry_.resize(bodies_.size());
  }
  fat_boxes_.reserve(end);
  const bool expected = std::exchange(expected_, false);
  if (fat_boxes_.size() == 0 && !expected) prepare(bodies.size(), bodies, now);
  if (fat_boxes_.size() == 0) return insert_first(bodies, now, listener);
  for (const Entry& entry : bodies) {
    join_filter(entry.slot, listener);
    const double travel = filters_[bodies_[entry.slot].filter].travel;
    bodies_[entry.slot].begin(travel > 0 ? travel : first_travel_);
    const BoxSweep<Degree> sweep(*entry.box, now);
    renew(entry.slot, *entry.box, sweep, sweep.begin(), now, listener);
  }
}

/// Adds many bodies to an empty grid: first all boxes, then pairs.
template <int Degree>
void KineticGrid<Degree>::insert_first(std::span<const Entry> bodies, double now, PairListener& listener) {
  const auto made = std::make_unique_for_overwrite<StaticBox[]>(bodies.size());
  const std::span<StaticBox> boxes(made.get(), bodies.size());
  const std::size_t threads = threads_for(bodies.size(), threads_);
  counters_.box_updates += bodies.size();
  for (const Entry& entry : bodies) join_filter(entry.slot, listener);
  make_boxes(bodies, boxes, threads, now);
  cut_to_levels(bodies, boxes, now);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const BodySlot id = bodies[i].slot;
    if (bodies_[id].expiry <= horizon_) expiry_.set(id, bodies_[id].expiry);
    fat_boxes_.announce(id, boxes[i], bodies[i].box->rounding);
  }
  BoxPairs pairs;
  if (pairs.find(boxes, threads)) {
    std::vector<BodySlot> order(bodies.size());
    std::transform(pairs.order().begin(), pairs.order().end(), order.begin(),
                   [&](BoxPairs::Index i) { return bodies[i].slot; });
    fat_boxes_.enter_all(order);
    listener.pairs_to_come(pairs.pairs().size());
    const bool filters = listener.filters();
    for (const auto& [i, j] : pairs.pairs()) {
      const BodySlot a = bodies[i].slot, b = bodies[j].slot;
      if (filters && !listener.may_collide(a, b)) continue;
      if (paired(a, b)) report_pair(a, b, now, listener);
    }
    return;
  }
  const auto enter = [&](BodySlot id) {
    BoxGrid::Changes changes;
    fat_boxes_.enter(id, changes);
    report(id, changes, now, listener);
  };
  if (bodies.size() < few) {
    for (const Entry& entry : bodies) enter(entry.slot);
  } else {
    for (const BodySlot id : spatial_order<Degree>(bodies, now)) enter(id);
  }
}

/// The boxes of many bodies: they do not depend on each other.
template <int Degree>
void KineticGrid<Degree>::make_boxes(std::span<const Entry> bodies, std::span<StaticBox> boxes, std::size_t threads,
                                     double now) {
  std::vector<std::uint64_t> certificates(threads, 0);
  in_parts(bodies.size(), threads, [&](std::size_t part, std::size_t first, std::size_t last) {
    std::uint64_t tries = 0;
    for (std::size_t i = first; i < last; ++i) {
      Body& body = bodies_[bodies[i].slot];
      body.begin(first_travel_);
      tries += fit(body, *bodies[i].box, boxes[i], now, std::numeric_limits<double>::max());
    }
    certificates[part] = tries;
  });
  for (const std::uint64_t tries : certificates) counters_.certificates += tries;
}

/// If only a few would use a level, and just for their travel, their boxes are cut to fit the next level that more use.
template <int Degree>
void KineticGrid<Degree>::cut_to_levels(std::span<const Entry> bodies, std::span<StaticBox> boxes, double now) {
  double least = boxes[0].extent();
  double most = least;
  for (const StaticBox& box : boxes) {
    least = std::min(least, box.extent());
    most = std::max(most, box.extent());
  }
  if (fat_boxes_.room_for(least) == fat_boxes_.room_for(most)) return;
  std::vector<double> extents;
  extents.reserve(boxes.size());
  for (const StaticBox& box : boxes) extents.push_back(box.extent());
  const auto last = extents.end() - 1 - static_cast<std::ptrdiff_t>(boxes.size() / tuning_.share_for_level);
  std::nth_element(extents.begin(), last, extents.end());
  const double coarsest = fat_boxes_.room_for(*last);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    Body& body = bodies_[bodies[i].slot];
    if (!(boxes[i].extent() > coarsest) || body.expiry == never) continue;
    counters_.certificates += fit(body, *bodies[i].box, boxes[i], now, coarsest);
  }
}

#define KDS_INSTANTIATE(degree) KDS_TEMPLATE_PART class KineticGrid<degree>;
KDS_FOR_EACH_DEGREE(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
