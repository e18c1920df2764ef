#include "collision/broad_phase/kinetic_grid.hpp"

#include "kds/audit.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

namespace kds::collision {
namespace {

constexpr double largest = std::numeric_limits<double>::max();

/// A body's reach when it comes, over the spacing of bodies.
constexpr double reach_per_spacing = 0.25;

/// At most: such that a box of this reach on both sides still has an extent.
constexpr double greatest_reach = 0x1p1020;

/// At least, over its size: less would have it renewed ever so often among others that touch it anyway.
constexpr double least_reach = 0.125;

/// At least, over its coordinates: boxes without extent have a reach too, which then adapts.
constexpr double least_part_of_coordinates = 0x1p-40;
constexpr double least_reach_at_all = 0x1p-500;

/// An old fat box is kept if it lasts this share of a new one's lifetime.
template <int Degree>
constexpr double kept_share = Degree == 1 ? 0.15 : 0.25;

/// A body is *jostled* if its motion changes in most of its boxes: each in which it does counts 1, up to a bound, each in
/// which it does not takes back 2. Only bodies on straight paths are: of these it is told when they leave a box.
constexpr int jostled_at = 3;
constexpr int jostled_most = 6;

/// For one that is, a pair that begins costs as much as so many tests; and what was spent on both within a box, in tests,
/// that a longer reach would pay, or a shorter one (found by measuring; the minimum is flat).
constexpr std::uint32_t tests_per_pair = 8;
constexpr std::uint32_t little_spent = 40, much_spent = 60;

/// Fewer bodies fit into the cache in any order.
constexpr std::size_t few = 4096;

/// Bodies take so large a share of all before a coarser level is begun just for their reach.
constexpr std::uint64_t share_for_level = 8;

template <int Degree>
double greatest_speed(const certificates::PointMotion<Degree>& motion, double t) {
  return motion.velocity(t).cwiseAbs().maxCoeff();
}

/// Distance between neighbours if bodies are spread evenly over the box that holds the middle half of them on each axis;
/// told from some of them. What is far out, up to a quarter on each side, makes no difference.
template <int Degree>
double typical_spacing(std::span<const typename BroadPhase<Degree>::Entry> bodies, double now) {
  constexpr std::size_t sample = 256;
  const std::size_t step = std::max<std::size_t>(bodies.size() / sample, 1);
  std::array<std::vector<double>, 3> places;
  double size = 0;
  for (auto& place : places) place.reserve(bodies.size() / step + 1);
  for (std::size_t i = 0; i < bodies.size(); i += step) {
    const StaticBox box = swept_box(*bodies[i].box, now, now);
    size += box.extent();
    for (std::size_t d = 0; d < 3; ++d) places[d].push_back(box.min[static_cast<Eigen::Index>(d)]);
  }
  size /= static_cast<double>(places[0].size());
  double volume = 1;
  for (auto& place : places) {
    const auto quarter = place.begin() + static_cast<std::ptrdiff_t>(place.size() / 4);
    const auto three_quarters = place.begin() + static_cast<std::ptrdiff_t>(place.size() * 3 / 4);
    std::nth_element(place.begin(), quarter, place.end());
    const double low = *quarter;
    std::nth_element(quarter, three_quarters, place.end());
    volume *= std::max(2 * (*three_quarters - low), size);
  }
  const double spacing = std::cbrt(volume / static_cast<double>(bodies.size()));
  return std::isfinite(spacing) ? spacing : size;
}

/// The order in which to put in many bodies that come at once: by blocks of space, along [Morton66]'s curve, so that
/// what a body meets, and the cells it is in, have just been used and are in the cache.
template <int Degree>
std::vector<BodyId> spatial_order(std::span<const typename BroadPhase<Degree>::Entry> bodies, double now) {
  constexpr std::size_t bodies_per_block = 8;
  const auto place = [&](std::size_t i) { return swept_box(*bodies[i].box, now, now).min; };
  Eigen::Array3d low = place(0);
  Eigen::Array3d high = low;
  for (std::size_t i = 1; i < bodies.size(); ++i) {
    const Eigen::Array3d at = place(i);
    low = low.min(at);
    high = high.max(at);
  }
  const int levels = (std::bit_width(bodies.size() / bodies_per_block) - 1) / 3;
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
  std::vector<BodyId> order(bodies.size());
  for (std::size_t i = 0; i < bodies.size(); ++i) order[places[blocks[i]]++] = bodies[i].id;
  return order;
}

/// Seconds until a box on a straight path leaves a fat one that holds it now, or a little less; 0 where that is not told.
template <int Degree>
double exit_time(const KineticBox<Degree>& box, const StaticBox& present, const StaticBox& fat) {
  if constexpr (Degree > 1) return 0;
  double time = never;
  for (int d = 0; d < 3; ++d) {
    const double down = box.min.coefficients[1][d];
    const double up = box.max.coefficients[1][d];
    if (down < 0) time = std::min(time, (fat.min[d] - present.min[d]) / down);
    if (up > 0) time = std::min(time, (fat.max[d] - present.max[d]) / up);
  }
  return time * (1 - 0x1p-20);
}

StaticBox whole_space() {
  return {Eigen::Array3d::Constant(-largest), Eigen::Array3d::Constant(largest)};
}

}  // namespace

/// Seconds until a box has moved by its reach, `never` if it is at rest; exact for straight paths, up to rounding.
template <int Degree>
double KineticGrid<Degree>::lifetime(const Body& body, double now) {
  const KineticBox<Degree>& box = body.box;
  const double speed = std::max(greatest_speed(box.min, now), greatest_speed(box.max, now));
  double time = speed > 0 ? std::min(body.reach / speed, largest) : never;
  if constexpr (Degree >= 2) {
    const double bend = box.min.coefficients[2].cwiseAbs().cwiseMax(box.max.coefficients[2].cwiseAbs()).maxCoeff();
    if (bend > 0) time = std::min(time, std::sqrt(body.reach / bend));
  }
  return time;
}

template <int Degree>
auto KineticGrid<Degree>::fat_box(BodyId id, const StaticBox& present, double now) -> FatBox {
  Body& body = bodies_[id];
  body.fattened = now;
  const double size = present.extent();
  const double coordinates = present.min.abs().max(present.max.abs()).maxCoeff();
  body.reach = std::max({body.reach, least_reach * size, least_part_of_coordinates * coordinates, least_reach_at_all});
  double time = lifetime(body, now);
  if (time == never) return {present, never};
  // Where a jostled body will go nobody knows; a margin of more than its size would be mostly in vain.
  double margin = body.jostled >= jostled_at && body.reach <= 0.5 * size ? body.reach : 0;
  const auto swept = [&](double expiry) {
    const StaticBox box = swept_box(body.box, now, expiry);
    if (margin == 0) return box;
    return StaticBox{box.min.min(present.min - margin), box.max.max(present.max + margin)};
  };
  for (;;) {
    // Where the clock is coarse, a box lasts until its next tick at least.
    double expiry = std::max(now + time, next_up(now));
    if (expiry > largest) return {whole_space(), never};
    StaticBox box = swept(expiry);
    double extent = box.extent();
    if (!(extent <= largest)) return {whole_space(), never};
    ++counters_.certificates;
    // One that is just too large for a level is better cut than in the next.
    const double room_below = 0.5 * BoxGrid::room_for(extent);
    if (extent < 1.5 * room_below && size < 0.75 * room_below) {
      const double cut = 0.999 * (room_below - size) / (extent - size);
      time *= cut;
      margin *= cut;
      expiry = std::max(now + time, next_up(now));
      box = swept(expiry);
      extent = box.extent();
    }
    // A coarser level costs all bodies something, so it takes many to begin one; until then boxes are cut to fit.
    const double room = fat_boxes_.coarsest() - size;
    if (extent - size <= room || room < 0.25 * size || expiry == next_up(now)) return {box, expiry};
    if (++wishes_ * share_for_level > fat_boxes_.size()) {
      wishes_ = 0;
      return {box, expiry};
    }
    body.reach *= 0.75;
    time *= 0.75;
    margin *= 0.75;
  }
}

/// The reach of a jostled body is what makes its renewals cost about what pairs and their tests do. Of others, a box
/// that has lasted its time: it costs about as much as two pairs, so at one or two pairs a renewal, those begun by
/// others' renewals included, a longer reach and a shorter one would both cost more (found by measuring, for packings
/// from 0.01 to 0.25). One that the body leaves early, since its motion has changed, was too long.
template <int Degree>
void KineticGrid<Degree>::adapt_reach(BodyId id, double now) {
  Body& body = bodies_[id];
  const bool lasted = body.expiry <= now;
  if (body.jostled >= jostled_at) {
    const std::uint32_t spent = tests_per_pair * body.begun + body.tests;
    if (spent < little_spent) body.reach = std::min(1.1 * body.reach, greatest_reach);
    if (spent > much_spent) body.reach *= 0.9;
  } else if (lasted) {
    switch (body.begun) {
      case 0: body.reach = std::min(1.4 * body.reach, greatest_reach); break;
      case 1: body.reach = std::min(1.15 * body.reach, greatest_reach); break;
      case 2: break;
      default: body.reach *= body.begun < 8 ? 0.8 : 0.5;
    }
  } else if (now - body.fattened < 0.5 * (body.expiry - body.fattened)) {
    body.reach *= 0.8;
  }
  if (Degree == 1 && body.changes > 0) {
    body.jostled = std::min(body.jostled + 1, jostled_most);
  } else {
    body.jostled = std::max(body.jostled - 2, 0);
  }
  body.begun = 0;
  body.changes = 0;
  body.tests = 0;
}

/// In the order of bodies, whatever cells they were found in.
template <int Degree>
void KineticGrid<Degree>::report(BodyId id, double now, PairListener& listener) {
  if (changes_.ended.size() > 1) std::sort(changes_.ended.begin(), changes_.ended.end());
  if (changes_.began.size() > 1) std::sort(changes_.began.begin(), changes_.began.end());
  for (const BodyId other : changes_.ended) {
    --bodies_[id].partners;
    --bodies_[other].partners;
    listener.pair_ended(std::min(id, other), std::max(id, other), now);
  }
  for (const BodyId other : changes_.began) {
    ++bodies_[id].begun;
    ++bodies_[other].begun;
    ++bodies_[id].partners;
    ++bodies_[other].partners;
    listener.pair_began(std::min(id, other), std::max(id, other), now);
  }
}

template <int Degree>
void KineticGrid<Degree>::set_expiry(BodyId id, double expiry) {
  bodies_[id].expiry = expiry;
  expiry_.set(id, expiry <= horizon_ ? expiry : never);
}

template <int Degree>
void KineticGrid<Degree>::extend_horizon(double, double horizon) {
  horizon_ = horizon;
  visit([&](BodyId id, const KineticBox<Degree>&) { set_expiry(id, bodies_[id].expiry); });
}

template <int Degree>
void KineticGrid<Degree>::renew(BodyId id, const StaticBox& present, double now, PairListener& listener) {
  ++counters_.box_updates;
  const FatBox fat = fat_box(id, present, now);
  set_expiry(id, fat.expiry);
  changes_.clear();
  fat_boxes_.put(id, fat.box, changes_);
  report(id, now, listener);
}

template <int Degree>
void KineticGrid<Degree>::insert(std::span<const Entry> bodies, double now, PairListener& listener) {
  BodyId end = 0;
  for (const Entry& entry : bodies) end = std::max(end, entry.id + 1);
  if (end > bodies_.size()) {
    const std::size_t room = bodies_.empty() ? end : std::max<std::size_t>(end, 2 * bodies_.size());
    bodies_.resize(room);
    expiry_.resize(room);
  }
  fat_boxes_.reserve(end);
  if (fat_boxes_.size() == 0 && !bodies.empty()) first_reach_ = reach_per_spacing * typical_spacing<Degree>(bodies, now);
  if (fat_boxes_.size() > 0 || bodies.size() < few) {
    for (const Entry& entry : bodies) {
      bodies_[entry.id] = {*entry.box, first_reach_, now, never, 0};
      renew(entry.id, swept_box(*entry.box, now, now), now, listener);
    }
    return;
  }
  for (const Entry& entry : bodies) {
    bodies_[entry.id] = {*entry.box, first_reach_, now, never, 0};
    ++counters_.box_updates;
    const FatBox fat = fat_box(entry.id, swept_box(*entry.box, now, now), now);
    set_expiry(entry.id, fat.expiry);
    fat_boxes_.announce(entry.id, fat.box);
  }
  for (const BodyId id : spatial_order<Degree>(bodies, now)) {
    changes_.clear();
    fat_boxes_.enter(id, changes_);
    report(id, now, listener);
  }
}

template <int Degree>
void KineticGrid<Degree>::remove(BodyId id, double now, PairListener& listener) {
  changes_.clear();
  fat_boxes_.remove(id, changes_);
  expiry_.clear(id);
  report(id, now, listener);
}

template <int Degree>
void KineticGrid<Degree>::update(BodyId id, const KineticBox<Degree>& box, double now, PairListener& listener) {
  Body& body = bodies_[id];
  body.box = box;
  ++body.changes;
  body.tests += body.partners;
  // The old fat box will often do for a while.
  const StaticBox present = swept_box(box, now, now);
  const StaticBox fat = fat_boxes_.box(id);
  if (fat.contains(present)) {
    const double time = lifetime(body, now);
    if (time == never) return set_expiry(id, never);
    double expiry = now + kept_share<Degree> * time;
    expiry = std::max(expiry, now + exit_time(box, present, fat));
    if (expiry > now && expiry <= largest && fat.contains(swept_box(box, now, expiry))) {
      ++counters_.certificates;
      return set_expiry(id, expiry);
    }
  }
  adapt_reach(id, now);
  renew(id, present, now, listener);
}

template <int Degree>
bool KineticGrid<Degree>::advance(double limit, PairListener& listener) {
  while (!expiry_.empty()) {
    const auto [time, id] = expiry_.top();
    if (time > limit) return false;
    adapt_reach(id, time);
    renew(id, swept_box(bodies_[id].box, time, time), time, listener);
    if (!changes_.began.empty() || !changes_.ended.empty()) return true;
  }
  return false;
}

template <int Degree>
void KineticGrid<Degree>::audit(double now) const {
  for (BodyId id = 0; id < fat_boxes_.end(); ++id) {
    if (!fat_boxes_.contains(id)) continue;
    if (bodies_[id].expiry <= now) continue;  // due
    const StaticBox present = swept_box(bodies_[id].box, now, now);
    // The margins of rounding differ from those of the whole span.
    const double slack = 0x1p-45 * std::max(present.min.abs().maxCoeff(), present.max.abs().maxCoeff());
    StaticBox inner = present;
    inner.min += slack;
    inner.max -= slack;
    if (!fat_boxes_.box(id).contains(inner)) {
      throw AuditFailure("KineticGrid: body " + std::to_string(id) + " is outside its fat box");
    }
  }
}

template class KineticGrid<1>;
template class KineticGrid<2>;

}  // namespace kds::collision
