// A broad phase by itself, under random changes, held against its contract and against brute force over exact numbers.
#pragma once

#include "collision/broad_phase/broad_phase.hpp"
#include "tests/support/exact_models.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <map>
#include <memory>
#include <set>
#include <utility>
#include <vector>

namespace kds::collision::tests {

using Eigen::Vector3d;
using kds::tests::Random;

template <int Degree>
certificates::PointMotion<Degree> path(Random& random, bool coarse, double now, double side) {
  const auto number = [&](double low, double high) {
    return coarse ? random.integer(static_cast<int>(2 * low), static_cast<int>(2 * high)) * 0.5
                  : random.between(low, high);
  };
  certificates::PointMotion<Degree> result;
  result.coefficients[0] = {number(0, side), number(0, side), number(0, side)};
  result.coefficients[1] = {number(-2, 2), number(-2, 2), number(-2, 2)};
  if constexpr (Degree >= 2) {
    result.coefficients[2].setZero();
    if (random.one_in(2)) result.coefficients[2] = {number(-1, 1), number(-1, 1), number(-1, 1)};
  }
  result.start = now;
  return result;
}

/// A box that grows, at rates of its own for each side; one in four keeps its size.
template <int Degree>
KineticBox<Degree> random_box(Random& random, bool coarse, double now, double side) {
  const auto centre = path<Degree>(random, coarse, now, side);
  KineticBox<Degree> box{centre, centre};
  const bool grows = !random.one_in(4);
  for (int d = 0; d < 3; ++d) {
    const auto size = [&] { return coarse ? 0.5 * random.integer(1, 3) : random.between(0.2, 1.5); };
    box.min.coefficients[0][d] -= size();
    box.max.coefficients[0][d] += size();
    if (!grows) continue;
    const auto rate = [&] { return coarse ? 0.5 * random.integer(0, 2) : random.between(0, 1); };
    box.min.coefficients[1][d] -= rate();
    box.max.coefficients[1][d] += rate();
  }
  return box;
}

template <int Degree>
oracle::MovingBox exact(const KineticBox<Degree>& box) {
  oracle::MovingBox result;
  for (std::size_t d = 0; d < 3; ++d) {
    const auto low = box.min.axis(static_cast<int>(d));
    const auto high = box.max.axis(static_cast<int>(d));
    result.low[d] = {{low.position.c.begin(), low.position.c.end()}, low.start};
    result.high[d] = {{high.position.c.begin(), high.position.c.end()}, high.start};
  }
  return result;
}

/// Keeps what is reported and holds it against the contract.
struct ListedPairs final : PairListener {
  std::set<std::pair<BodySlot, BodySlot>> now;
  std::map<std::pair<BodySlot, BodySlot>, double> since;
  double clock = 0;
  std::size_t reports = 0;

  void pair_began(BodySlot a, BodySlot b, double t) override {
    note(a, b, t);
    REQUIRE(now.insert({a, b}).second);
    since[{a, b}] = t;
  }
  void pair_ended(BodySlot a, BodySlot b, double t) override {
    note(a, b, t);
    REQUIRE(now.erase({a, b}) == 1);
  }
  void note(BodySlot a, BodySlot b, double t) {
    REQUIRE(a < b);
    REQUIRE(t >= clock);
    clock = t;
    ++reports;
  }
};

template <int Degree>
struct Stress {
  Stress(std::uint64_t seed, bool is_coarse, std::unique_ptr<BroadPhase<Degree>> tested)
      : random(seed), coarse(is_coarse), owner(std::move(tested)), broad_phase(*owner) {
    broad_phase.extend_horizon(0, never);
  }

  void insert(std::size_t count) {
    std::vector<BodySlot> ids;
    for (BodySlot id = 0; ids.size() < count; ++id) {
      if (!boxes.contains(id)) ids.push_back(id);
    }
    std::vector<typename BroadPhase<Degree>::Entry> entries;
    for (const BodySlot id : ids) {
      boxes[id] = random_box<Degree>(random, coarse, now, side);
      entries.push_back({id, &boxes[id]});
    }
    broad_phase.insert(entries, now, pairs);
  }

  BodySlot any() { return std::next(boxes.begin(), static_cast<std::ptrdiff_t>(random.below(boxes.size())))->first; }

  void remove() {
    const BodySlot id = any();
    broad_phase.remove(id, now, pairs);
    boxes.erase(id);
    for (const auto& [a, b] : pairs.now) REQUIRE((a != id && b != id));
  }

  void update() {
    const BodySlot id = any();
    KineticBox<Degree> box = random_box<Degree>(random, coarse, now, side);
    if (!random.one_in(3)) {  // goes on from where it is
      for (auto [end, old] : {std::pair(&box.min, &boxes[id].min), std::pair(&box.max, &boxes[id].max)}) {
        end->coefficients[0] = old->position(now);
      }
      for (int d = 0; d < 3; ++d) {  // growing again, should it have shrunk to nothing
        if (!(box.min.coefficients[0][d] < box.max.coefficients[0][d])) {
          box.max.coefficients[0][d] = box.min.coefficients[0][d] + 0.5;
        }
        box.max.coefficients[1][d] = std::max(box.max.coefficients[1][d], box.min.coefficients[1][d]);
        if constexpr (Degree >= 2) box.max.coefficients[2][d] = box.min.coefficients[2][d];
      }
    }
    boxes[id] = box;
    broad_phase.update(id, box, now, pairs);
  }

  /// Everything up to t, with an audit after each event.
  void advance(double t) {
    while (broad_phase.next_time() <= t) {
      now = std::max(now, broad_phase.next_time());
      broad_phase.advance(broad_phase.next_time(), pairs);
      broad_phase.audit(now);
      ++events;
    }
    broad_phase.advance(t, pairs);
    now = t;
  }

  void compare_with_brute_force() {
    for (auto a = boxes.begin(); a != boxes.end(); ++a) {
      for (auto b = std::next(a); b != boxes.end(); ++b) {
        INFO("bodies " << a->first << " and " << b->first << " at " << now);
        const bool overlap = oracle::overlap_after(exact(a->second), exact(b->second), now);
        const bool reported = pairs.now.contains({a->first, b->first});
        if (broad_phase.exact()) {
          REQUIRE(reported == overlap);
        } else {
          REQUIRE((reported || !overlap));
        }
      }
    }
  }

  Random random;
  bool coarse;
  std::unique_ptr<BroadPhase<Degree>> owner;
  BroadPhase<Degree>& broad_phase;
  std::map<BodySlot, KineticBox<Degree>> boxes;
  ListedPairs pairs;
  double now = 0;
  double side = 12;
  std::size_t events = 0;
};

}  // namespace kds::collision::tests
