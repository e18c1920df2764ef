#include "collision/broad_phase/unlisted_axes.hpp"
#include "collision/broad_phase/unlisted_sides.hpp"

#include "certificates/conjunction.hpp"
#include "collision/degrees.hpp"
#include "kds/arithmetic/lattice.hpp"
#include "kds/audit.hpp"
#include "structures/span_ahead.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string>

namespace kds::collision {
namespace {

/// A float not above x; a NaN for a NaN.
float below(double x) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  if (x > 0x1p127) return 0x1p127f;
  if (x < -0x1p127) return -infinity;
  const auto rounded = static_cast<float>(x);
  if (!(static_cast<double>(rounded) > x)) return rounded;
  // The next float below: floats of one sign are in the order of their bits.
  if (rounded == 0) return -std::numeric_limits<float>::denorm_min();
  const auto bits = std::bit_cast<std::uint32_t>(rounded);
  return std::bit_cast<float>(rounded > 0 ? bits - 1 : bits + 1);
}

}  // namespace

template <int Degree>
void UnlistedAxes<Degree>::choose(unsigned directions, double now) {
  count_ = 0;
  more_.clear();
  for (std::size_t d = 0; d < directions_; ++d) {
    if ((directions >> d & 1) == 0) continue;
    if (d < 3 && count_ < 2) {
      axes_[count_++] = static_cast<int>(d);
    } else {
      more_.push_back(d);
    }
  }
  if (count_ == 1) axes_[1] = axes_[0];
  for (PairSlot slot = 0; slot < pairs_.size(); ++slot) queue_.clear(slot);
  pairs_.clear();
  free_.clear();
  for (auto& pairs : pairs_of_) pairs.clear();
  more_hulls_.resize(boxes_.size() * 2 * more_.size());
  for (BodySlot id = 0; id < boxes_.size(); ++id) set_hulls(id, now);
}

template <int Degree>
void UnlistedAxes<Degree>::set_hulls(BodySlot id, double now) {
  const double ahead = next_up(horizon_ - now);
  const auto span = [&](const Motion<Degree>& min, const Motion<Degree>& max) {
    const structures::Span low = structures::span_ahead(min, now, ahead);
    const structures::Span high = structures::span_ahead(max, now, ahead);
    return std::array<float, 2>{below(std::min(low.min, high.min)), -below(-std::max(low.max, high.max))};
  };
  for (std::size_t i = 0; i < 2; ++i) {
    const auto [low, high] = span(boxes_[id].min.axis(axes_[i]), boxes_[id].max.axis(axes_[i]));
    hulls_[id].ends[i] = low;
    hulls_[id].ends[i + 2] = high;
  }
  for (std::size_t i = 0; i < more_.size(); ++i) {
    const auto [low, high] = span(slab(id, more_[i]).min, slab(id, more_[i]).max);
    more_hulls_[2 * (id * more_.size() + i)] = low;
    more_hulls_[2 * (id * more_.size() + i) + 1] = high;
  }
}

template <int Degree>
auto UnlistedAxes<Degree>::hull_of(const StaticBox& box) const -> Hull {
  if (count_ == 0) return Hull::everywhere();
  return {FourFloats{below(box.min[axes_[0]]), below(box.min[axes_[1]]), -below(-box.max[axes_[0]]),
                     -below(-box.max[axes_[1]])}};
}

template <int Degree>
bool UnlistedAxes<Degree>::near_on_more(BodySlot a, BodySlot b) const {
  const float* const hulls_a = &more_hulls_[2 * a * more_.size()];
  const float* const hulls_b = &more_hulls_[2 * b * more_.size()];
  for (std::size_t i = 0; i < 2 * more_.size(); i += 2) {
    if (!(hulls_a[i + 1] >= hulls_b[i] && hulls_b[i + 1] >= hulls_a[i])) return false;
  }
  return true;
}

template <int Degree>
void UnlistedAxes<Degree>::set_box(BodySlot id, const KineticBox<Degree>& box,
                                   std::span<const KineticSlab<Degree>> slabs, double now) {
  if (id >= boxes_.size()) {
    boxes_.resize(id + 1);
    hulls_.resize(id + 1);
    pairs_of_.resize(id + 1);
    if (!slabs.empty()) {
      slabs_.resize(boxes_.size() * directions_);
      more_hulls_.resize(boxes_.size() * 2 * more_.size());
    }
  }
  boxes_[id] = box;
  if (!slabs.empty()) {
    KineticSlab<Degree>* const all = &slabs_[id * directions_];
    for (std::size_t d = 0; d < 3; ++d) all[d] = {end(id, d, false), end(id, d, true)};
    std::copy(slabs.begin(), slabs.end(), all + 3);
  }
  if (count_ > 0) set_hulls(id, now);
}

template <int Degree>
typename UnlistedAxes<Degree>::PairSlot UnlistedAxes<Degree>::find(BodySlot a, BodySlot b) const {
  const auto& fewer = pairs_of_[a].size() <= pairs_of_[b].size() ? pairs_of_[a] : pairs_of_[b];
  for (const PairSlot slot : fewer) {
    if (pairs_[slot].a == a && pairs_[slot].b == b) return slot;
  }
  return no_pair;
}

/// Time of the pair's next change, `never` if it has none before the horizon; now if its state is out of date.
template <int Degree>
double UnlistedAxes<Degree>::next_change(const Pair& pair, double now) const {
  const Sides sides(*this, pair.a, pair.b);
  return pair.overlap ? certificates::first_any_holds(now, horizon_, sides.apart(), sides.more())
                      : certificates::first_all_broken(now, horizon_, sides.apart(), sides.more());
}

template <int Degree>
bool UnlistedAxes<Degree>::add(BodySlot a, BodySlot b, double now) {
  const Sides sides(*this, a, b);
  if (sides.stay_apart(now, horizon_)) return false;
  ++counters_.certificates;
  double next = certificates::first_all_broken(now, horizon_, sides.apart(), sides.more());
  if (next == never) return false;
  const bool overlap = next == now;
  if (overlap) next = certificates::first_any_holds(now, horizon_, sides.apart(), sides.more());
  PairSlot slot;
  if (free_.empty()) {
    slot = static_cast<PairSlot>(pairs_.size());
    pairs_.emplace_back();
    if (queue_.slots() < pairs_.size()) queue_.resize(2 * pairs_.size());
  } else {
    slot = free_.back();
    free_.pop_back();
  }
  pairs_[slot] = {a, b, overlap, true};
  pairs_of_[a].push_back(slot);
  pairs_of_[b].push_back(slot);
  queue_.set(slot, next);
  return overlap;
}

template <int Degree>
void UnlistedAxes<Degree>::remove(PairSlot slot) {
  queue_.clear(slot);
  pairs_[slot].alive = false;
  for (const BodySlot id : {pairs_[slot].a, pairs_[slot].b}) {
    auto& pairs = pairs_of_[id];
    const auto it = std::find(pairs.begin(), pairs.end(), slot);
    if (it == pairs.end()) continue;
    *it = pairs.back();
    pairs.pop_back();
  }
  free_.push_back(slot);
}

template <int Degree>
bool UnlistedAxes<Degree>::drop(BodySlot a, BodySlot b) {
  const PairSlot slot = find(a, b);
  if (slot == no_pair) return false;
  const bool overlap = pairs_[slot].overlap;
  remove(slot);
  return overlap;
}

template <int Degree>
void UnlistedAxes<Degree>::look_farther(BodySlot a, BodySlot b, double now) {
  if (!near(a, b)) return;
  const PairSlot slot = find(a, b);
  if (slot == no_pair) {
    add(a, b, now);
  } else if (!queue_.contains(slot)) {
    ++counters_.certificates;
    queue_.set(slot, next_change(pairs_[slot], now));
  }
}

template <int Degree>
void UnlistedAxes<Degree>::forget_pairs(BodySlot id, std::vector<BodySlot>& partners) {
  while (!pairs_of_[id].empty()) {
    const PairSlot slot = pairs_of_[id].back();
    const Pair& pair = pairs_[slot];
    if (pair.overlap) partners.push_back(pair.a == id ? pair.b : pair.a);
    remove(slot);
  }
}

template <int Degree>
bool UnlistedAxes<Degree>::overlap(BodySlot a, BodySlot b) const {
  const PairSlot slot = find(std::min(a, b), std::max(a, b));
  return slot != no_pair && pairs_[slot].overlap;
}

template <int Degree>
void UnlistedAxes<Degree>::process() {
  const auto [time, slot] = queue_.top();
  Pair& pair = pairs_[slot];
  pair.overlap = !pair.overlap;
  ++counters_.events;
  ++counters_.certificates;
  changes_->push_back({pair.a, pair.b, pair.overlap});
  const double next = next_change(pair, time);
  if (next == never && !pair.overlap) {
    remove(slot);
  } else {
    queue_.set(slot, next);
  }
}

template <int Degree>
void UnlistedAxes<Degree>::extend_horizon(double now, double horizon) {
  const bool extended = horizon > horizon_;
  horizon_ = horizon;
  if (count_ == 0) return;
  for (BodySlot id = 0; id < boxes_.size(); ++id) set_hulls(id, now);
  if (extended) return;
  for (PairSlot slot = 0; slot < pairs_.size(); ++slot) {
    if (!pairs_[slot].alive || queue_.time(slot) <= horizon_) continue;
    if (pairs_[slot].overlap) {
      queue_.clear(slot);
    } else {
      remove(slot);
    }
  }
}

template <int Degree>
void UnlistedAxes<Degree>::audit(double now) const {
  for (PairSlot slot = 0; slot < pairs_.size(); ++slot) {
    const Pair& pair = pairs_[slot];
    if (!pair.alive || queue_.time(slot) <= now) continue;
    if (queue_.time(slot) != next_change(pair, now)) {
      throw AuditFailure("UnlistedAxes: bodies " + std::to_string(pair.a) + " and " + std::to_string(pair.b) +
                         ": the scheduled change has the wrong time");
    }
  }
}

template <int Degree>
void UnlistedAxes<Degree>::audit_pair(BodySlot a, BodySlot b, double now) const {
  const PairSlot slot = find(a, b);
  const bool known = slot != no_pair;
  if (known && queue_.time(slot) <= now) return;
  const Sides sides(*this, a, b);
  const double next = certificates::first_all_broken(now, horizon_, sides.apart(), sides.more());
  const bool overlap = known && pairs_[slot].overlap;
  if (overlap != (next == now) || (!overlap && known != (next != never))) {
    throw AuditFailure("UnlistedAxes: bodies " + std::to_string(a) + " and " + std::to_string(b) +
                       ": overlap, or will, and that is not known, or the other way round");
  }
}

#define KDS_INSTANTIATE(degree) template class UnlistedAxes<degree>;
KDS_FOR_EACH_DEGREE(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
