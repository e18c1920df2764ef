// The two ways of sampling that the engine is compared with. Both report a pair at the first sample at which its shapes
// overlap and did not at the sample before.
#pragma once

#include "collision/kinetic_sweep_and_prune.hpp"
#include "tests/benchmarks/accuracy/contacts.hpp"
#include "tests/benchmarks/accuracy/static_tests.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <unordered_map>
#include <utility>
#include <vector>

namespace accuracy {

inline std::uint64_t pair_key(BodyId a, BodyId b) { return std::uint64_t{a} << 32 | b; }

/// [Paper] section 5, "pseudo-dynamic": kinetic sweep and prune knows at all times which boxes overlap; at each sample
/// these pairs are tested where they stand.
template <int Degree>
class PollingSampler final : private kds::collision::PairListener {
 public:
  using Motion = kds::certificates::PointMotion<Degree>;

  PollingSampler(const std::vector<PlacedShape>& shapes, const std::vector<Motion>& motions, double end)
      : shapes_(shapes), motions_(motions), broad_phase_(0) {
    broad_phase_.extend_horizon(0, end);
    std::vector<kds::collision::KineticBox<Degree>> boxes;
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      boxes.push_back(kds::collision::box_around(motions[i], shapes[i].low, shapes[i].high));
    }
    std::vector<typename kds::collision::BroadPhase<Degree>::Entry> entries;
    for (BodyId id = 0; id < boxes.size(); ++id) entries.push_back({id, &boxes[id]});
    broad_phase_.insert(entries, 0, *this);
  }

  void sample(double t, std::vector<Report>& reports) {
    while (broad_phase_.advance(t, *this)) {}
    for (Pair& pair : pairs_) {
      const bool now = overlap(shapes_[pair.a], shapes_[pair.b],
                               motions_[pair.b].position(t) - motions_[pair.a].position(t));
      if (now && !pair.overlaps) reports.push_back({pair.a, pair.b, t});
      pair.overlaps = now;
    }
  }

 private:
  struct Pair {
    BodyId a, b;
    bool overlaps;
  };

  void pair_began(BodyId a, BodyId b, double) override {
    places_[pair_key(a, b)] = pairs_.size();
    pairs_.push_back({a, b, false});
  }
  void pair_ended(BodyId a, BodyId b, double) override {
    const auto it = places_.find(pair_key(a, b));
    const Pair& last = pairs_.back();
    places_[pair_key(last.a, last.b)] = it->second;
    pairs_[it->second] = last;
    pairs_.pop_back();
    places_.erase(pair_key(a, b));
  }

  const std::vector<PlacedShape>& shapes_;
  const std::vector<Motion>& motions_;
  kds::collision::KineticSweepAndPrune<Degree> broad_phase_;
  std::vector<Pair> pairs_;
  std::unordered_map<std::uint64_t, std::size_t> places_;
};

/// Sweep and prune over samples: all boxes are computed anew, sorted along x by insertion (they hardly move from one
/// sample to the next), and swept once.
template <int Degree>
class DiscreteSampler {
 public:
  using Motion = kds::certificates::PointMotion<Degree>;

  DiscreteSampler(const std::vector<PlacedShape>& shapes, const std::vector<Motion>& motions)
      : shapes_(shapes), motions_(motions), places_(shapes.size()), boxes_(shapes.size()), order_(shapes.size()) {
    std::iota(order_.begin(), order_.end(), BodyId{0});
    place_all(0);
    std::sort(order_.begin(), order_.end(), [&](BodyId x, BodyId y) { return min_x(x) < min_x(y); });
  }

  void sample(double t, std::vector<Report>& reports) {
    ++samples_;
    place_all(t);
    for (std::size_t i = 1; i < order_.size(); ++i) {
      const BodyId id = order_[i];
      std::size_t j = i;
      for (; j > 0 && min_x(id) < min_x(order_[j - 1]); --j) order_[j] = order_[j - 1];
      order_[j] = id;
    }
    for (std::size_t i = 0; i < order_.size(); ++i) {
      const BodyId id = order_[i];
      const Vector3d& at = places_[id];
      boxes_[i] = {at[0] + shapes_[id].low[0], at[0] + shapes_[id].high[0], at[1] + shapes_[id].low[1],
                   at[1] + shapes_[id].high[1], at[2] + shapes_[id].low[2], at[2] + shapes_[id].high[2]};
    }
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      const Bounds x = boxes_[i];
      for (std::size_t j = i + 1; j < boxes_.size() && boxes_[j].min_x < x.max_x; ++j) {
        const Bounds& y = boxes_[j];
        // One condition without branches: which of them fails is anyone's guess.
        const bool near = (y.min_y < x.max_y) & (x.min_y < y.max_y) & (y.min_z < x.max_z) & (x.min_z < y.max_z);
        if (near) test(order_[i], order_[j], t, reports);
      }
    }
  }

 private:
  struct Bounds {
    double min_x, max_x, min_y, max_y, min_z, max_z;
  };

  double min_x(BodyId id) const { return places_[id][0] + shapes_[id].low[0]; }
  void place_all(double t) {
    for (std::size_t i = 0; i < motions_.size(); ++i) places_[i] = motions_[i].position(t);
  }
  void test(BodyId x, BodyId y, double t, std::vector<Report>& reports) {
    const auto [a, b] = std::minmax(x, y);
    if (!overlap(shapes_[a], shapes_[b], places_[b] - places_[a])) return;
    std::uint64_t& last = last_overlap_[pair_key(a, b)];
    if (last == 0 || last != samples_ - 1) reports.push_back({a, b, t});
    last = samples_;
  }

  const std::vector<PlacedShape>& shapes_;
  const std::vector<Motion>& motions_;
  std::vector<Vector3d> places_;
  std::vector<Bounds> boxes_;  // in the order of the sweep
  std::vector<BodyId> order_;
  std::uint64_t samples_ = 0;
  std::unordered_map<std::uint64_t, std::uint64_t> last_overlap_;  // number of the last sample with an overlap
};

}  // namespace accuracy
