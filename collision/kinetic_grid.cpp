#include "collision/kinetic_grid.hpp"

#include "kds/audit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace kds::collision {
namespace {

constexpr double largest = std::numeric_limits<double>::max();

/// A body's reach over its size when it comes, if nothing is known of the others; and at most, and over their spacing.
constexpr double usual_reach = 1;
constexpr double most_first_reach = 2;
constexpr double reach_per_spacing = 0.25;

/// Less would have a body renewed ever so often among many that touch it anyway.
constexpr double least_reach = 0.125;

/// An old fat box is kept if it lasts this share of a new one's lifetime.
constexpr double kept_share = 0.25;

/// Bodies take so large a share of all before a coarser level is begun just for their reach.
constexpr std::uint64_t share_for_level = 8;

template <int Degree>
double greatest_speed(const certificates::PointMotion<Degree>& motion, double t) {
  return motion.velocity(t).cwiseAbs().maxCoeff();
}

/// The reach, over their sizes, that suits bodies which are spread evenly over the box around them.
double reach_for(std::span<const StaticBox> boxes) {
  if (boxes.empty()) return usual_reach;
  StaticBox all = boxes.front();
  double sizes = 0;
  for (const StaticBox& box : boxes) {
    all.min = all.min.min(box.min);
    all.max = all.max.max(box.max);
    sizes += box.extent();
  }
  const auto count = static_cast<double>(boxes.size());
  const double size = sizes / count;
  const double spacing = std::cbrt((all.max - all.min).max(size).prod() / count);
  const double reach = reach_per_spacing * spacing / size;
  return std::isfinite(reach) ? std::clamp(reach, least_reach, most_first_reach) : usual_reach;
}

StaticBox whole_space() {
  return {Eigen::Array3d::Constant(-largest), Eigen::Array3d::Constant(largest)};
}

}  // namespace

/// Seconds until a box has moved by its reach; `never` if it is at rest.
template <int Degree>
double KineticGrid<Degree>::lifetime(const Body& body, double size, double now) {
  const KineticBox<Degree>& box = body.box;
  const double length = body.reach * size;
  const double speed = std::max(greatest_speed(box.min, now), greatest_speed(box.max, now));
  double time = speed > 0 ? length / speed : never;
  if constexpr (Degree >= 2) {
    const double bend = std::max(box.min.coefficients[2].cwiseAbs().maxCoeff(), box.max.coefficients[2].cwiseAbs().maxCoeff());
    if (bend > 0) time = std::min(time, std::sqrt(length / bend));
  }
  return time;
}

template <int Degree>
auto KineticGrid<Degree>::fat_box(BodyId id, const StaticBox& present, double now) -> FatBox {
  Body& body = bodies_[id];
  body.fattened = now;
  const double size = present.extent();
  double time = lifetime(body, size, now);
  if (time == never) return {present, never};
  for (;;) {
    // Where the clock is coarse, a box lasts until its next tick at least.
    double expiry = std::max(now + time, next_up(now));
    if (expiry > largest) return {whole_space(), never};
    StaticBox box = swept_box(body.box, now, expiry);
    double extent = box.extent();
    if (!(extent <= largest)) return {whole_space(), never};
    ++counters_.certificates;
    // One that is just too large for a level is better cut than in the next.
    const double cell = 0.5 * BoxGrid::cell_for(extent);
    if (extent < 1.5 * cell && size < 0.75 * cell) {
      time *= 0.999 * (cell - size) / (extent - size);
      expiry = std::max(now + time, next_up(now));
      box = swept_box(body.box, now, expiry);
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
  }
}

/// A box that has lasted its time: it costs about as much as two pairs, so at one or two pairs a renewal, those begun by
/// others' renewals included, a longer reach and a shorter one would both cost more (found by measuring, for packings
/// from 0.01 to 0.25). One that the body leaves early, since its motion has changed, was too long.
template <int Degree>
void KineticGrid<Degree>::adapt_reach(BodyId id, double now) {
  Body& body = bodies_[id];
  if (body.expiry <= now) {
    switch (body.begun) {
      case 0: body.reach = std::min(1.4 * body.reach, 0x1p100); break;
      case 1: body.reach *= 1.15; break;
      case 2: break;
      default: body.reach = std::max((body.begun < 8 ? 0.8 : 0.5) * body.reach, least_reach);
    }
  } else if (now - body.fattened < 0.5 * (body.expiry - body.fattened)) {
    body.reach = std::max(0.8 * body.reach, least_reach);
  }
  body.begun = 0;
}

template <int Degree>
void KineticGrid<Degree>::report(BodyId id, double now, PairListener& listener) {
  for (const BodyId other : changes_.ended) listener.pair_ended(std::min(id, other), std::max(id, other), now);
  for (const BodyId other : changes_.began) {
    ++bodies_[id].begun;
    ++bodies_[other].begun;
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
  fat_boxes_.reserve(fat_boxes_.size() + bodies.size());
  std::vector<StaticBox> present;
  present.reserve(bodies.size());
  for (const Entry& entry : bodies) {
    present.push_back(swept_box(*entry.box, now, now));
  }
  if (fat_boxes_.size() == 0) first_reach_ = reach_for(present);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    bodies_[bodies[i].id] = {*bodies[i].box, first_reach_, now, never, 0};
    fat_boxes_.expect(present[i].extent() * (1 + first_reach_));
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) renew(bodies[i].id, present[i], now, listener);
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
  // The old fat box will often do for a while.
  const StaticBox present = swept_box(box, now, now);
  const StaticBox fat = fat_boxes_.box(id);
  if (fat.contains(present)) {
    const double time = lifetime(body, present.extent(), now);
    if (time == never) return set_expiry(id, never);
    const double expiry = now + kept_share * time;
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
