// The two ways of sampling that the engine is compared with. Both report a pair at the first sample at which its shapes
// overlap and did not at the sample before.
#pragma once

#include "collision/broad_phase/kinetic_sweep_and_prune.hpp"
#include "tests/benchmarks/accuracy/contacts.hpp"
#include "tests/benchmarks/accuracy/static_tests.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

namespace accuracy {

using kds::collision::BodySlot;

inline std::uint64_t pair_key(BodySlot a, BodySlot b) { return std::uint64_t{a} << 32 | b; }

/// [Coming06] section 5, "pseudo-dynamic": kinetic sweep and prune knows at all times which boxes overlap; at each
/// sample these pairs are tested where they stand.
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
    for (BodySlot id = 0; id < boxes.size(); ++id) entries.push_back({id, &boxes[id]});
    broad_phase_.insert(entries, 0, *this);
  }

  void sample(double t, std::vector<Report>& reports) {
    while (broad_phase_.advance(t, *this)) {
    }
    for (Pair& pair : pairs_) {
      const bool now =
          overlap(shapes_[pair.a], shapes_[pair.b], motions_[pair.b].position(t) - motions_[pair.a].position(t));
      if (now && !pair.overlaps) reports.push_back({pair.a, pair.b, t});
      pair.overlaps = now;
    }
  }

 private:
  struct Pair {
    BodySlot a, b;
    bool overlaps;
  };

  void pair_began(BodySlot a, BodySlot b, double) override {
    places_[pair_key(a, b)] = pairs_.size();
    pairs_.push_back({a, b, false});
  }
  void pair_ended(BodySlot a, BodySlot b, double) override {
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

/// Sweep and prune over samples, [Cohen95]: three arrays of interval ends, put in order anew at each sample by
/// insertion (they hardly move in between); an exchange of a minimum with a maximum adds or drops a pair.
template <int Degree>
class DiscreteSampler {
 public:
  using Motion = kds::certificates::PointMotion<Degree>;

  DiscreteSampler(const std::vector<PlacedShape>& shapes, const std::vector<Motion>& motions)
      : shapes_(shapes), motions_(motions), places_(shapes.size()) {
    for (std::size_t i = 0; i < motions.size(); ++i) places_[i] = motions[i].position(0);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto d = static_cast<Eigen::Index>(axis);
      for (BodySlot id = 0; id < shapes.size(); ++id) {
        reach_[axis].push_back(shapes[id].low[d]);
        reach_[axis].push_back(shapes[id].high[d]);
        ends_[axis].push_back({places_[id][d] + shapes[id].low[d], 2 * id});
        ends_[axis].push_back({places_[id][d] + shapes[id].high[d], 2 * id + 1});
      }
      std::sort(ends_[axis].begin(), ends_[axis].end(), before);
    }
    std::vector<BodySlot> open;
    for (const End& end : ends_[0]) {
      const BodySlot id = end.id / 2;
      if ((end.id & 1) != 0) {
        open.erase(std::find(open.begin(), open.end(), id));
        continue;
      }
      for (const BodySlot other : open) add_if_overlap(id, other);
      open.push_back(id);
    }
  }

  void sample(double t, std::vector<Report>& reports) {
    for (std::size_t i = 0; i < motions_.size(); ++i) places_[i] = motions_[i].position(t);
    for (std::size_t axis = 0; axis < 3; ++axis) sort(axis);
    for (Pair& pair : pairs_) {
      const bool now = overlap(shapes_[pair.a], shapes_[pair.b], places_[pair.b] - places_[pair.a]);
      if (now && !pair.overlaps) reports.push_back({pair.a, pair.b, t});
      pair.overlaps = now;
    }
  }

 private:
  /// One interval end: twice the body's id, plus one for a maximum.
  struct End {
    double value;
    std::uint32_t id;
  };
  struct Pair {
    BodySlot a, b;
    bool overlaps;
  };

  static bool before(const End& a, const End& b) {
    return a.value < b.value || (a.value == b.value && (a.id & 1) > (b.id & 1));
  }

  /// New values and their order in one pass.
  void sort(std::size_t axis) {
    auto& ends = ends_[axis];
    for (std::size_t i = 0; i < ends.size(); ++i) {
      End end = ends[i];
      end.value = places_[end.id / 2][static_cast<Eigen::Index>(axis)] + reach_[axis][end.id];
      std::size_t j = i;
      for (; j > 0 && before(end, ends[j - 1]); --j) {
        ends[j] = ends[j - 1];
        passed(end.id, ends[j].id);
      }
      ends[j] = end;
    }
  }

  /// The end `left` has moved left of `right`.
  void passed(std::uint32_t left, std::uint32_t right) {
    if (((left ^ right) & 1) == 0 || left / 2 == right / 2) return;
    if ((left & 1) != 0) {
      drop(left / 2, right / 2);  // a maximum has moved left of a minimum
    } else {
      add_if_overlap(left / 2, right / 2);
    }
  }

  void add_if_overlap(BodySlot x, BodySlot y) {
    // The very sums that are sorted.
    for (int d = 0; d < 3; ++d) {
      if (!(places_[x][d] + shapes_[x].low[d] < places_[y][d] + shapes_[y].high[d])) return;
      if (!(places_[y][d] + shapes_[y].low[d] < places_[x][d] + shapes_[x].high[d])) return;
    }
    const auto [a, b] = std::minmax(x, y);
    if (places_of_pairs_.emplace(pair_key(a, b), pairs_.size()).second) pairs_.push_back({a, b, false});
  }
  void drop(BodySlot x, BodySlot y) {
    const auto it = places_of_pairs_.find(pair_key(std::min(x, y), std::max(x, y)));
    if (it == places_of_pairs_.end()) return;
    const Pair last = pairs_.back();
    places_of_pairs_[pair_key(last.a, last.b)] = it->second;
    pairs_[it->second] = last;
    pairs_.pop_back();
    places_of_pairs_.erase(it);
  }

  const std::vector<PlacedShape>& shapes_;
  const std::vector<Motion>& motions_;
  std::vector<Vector3d> places_;
  std::array<std::vector<double>, 3> reach_;  // of ends beyond the body's place
  std::array<std::vector<End>, 3> ends_;
  std::vector<Pair> pairs_;
  std::unordered_map<std::uint64_t, std::size_t> places_of_pairs_;
};

}  // namespace accuracy
