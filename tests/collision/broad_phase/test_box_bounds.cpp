// Boxes with rounded edges against integers, and in the grids that make use of them.
#include "collision/broad_phase/box_bounds.hpp"
#include "collision/broad_phase/kinetic_grid.hpp"
#include "tests/collision/broad_phase/box_grid_boxes.hpp"
#include "tests/collision/broad_phase/kept_boxes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

namespace kds::collision::test_box_bounds {
namespace {

using namespace tests;
using Eigen::Array3d;
using Eigen::Vector3d;

/// A box that holds the balls of some radius about the points of another box, in integers.
struct WholeBox {
  std::array<std::int64_t, 3> low, high;
  std::int64_t radius;

  StaticBox scaled(double scale) const {
    StaticBox box;
    for (std::size_t d = 0; d < 3; ++d) {
      box.min[static_cast<int>(d)] = scale * static_cast<double>(low[d] - radius);
      box.max[static_cast<int>(d)] = scale * static_cast<double>(high[d] + radius);
    }
    return box;
  }
};

std::int64_t square_gap(const WholeBox& a, const WholeBox& b) {
  std::int64_t sum = 0;
  for (std::size_t d = 0; d < 3; ++d) {
    const std::int64_t gap = std::max<std::int64_t>({0, a.low[d] - b.high[d], b.low[d] - a.high[d]});
    sum += gap * gap;
  }
  return sum;
}

TEST_CASE("Rounded boxes overlap where a ball in one may touch a ball in the other, and hardly elsewhere",
          "[box_bounds]") {
  Random random(3);
  std::size_t missed = 0, in_vain = 0, touching = 0, only_as_boxes = 0, lanes_differ = 0;
  for (int round = 0; round < 200'000; ++round) {
    const double scale = std::ldexp(1.0, random.integer(-400, 400));
    const auto whole_box = [&] {
      WholeBox box{{}, {}, round % 8 == 0 ? 0 : random.integer(0, 7)};
      for (std::size_t d = 0; d < 3; ++d) {
        box.low[d] = random.integer(-12, 12);
        box.high[d] = box.low[d] + random.integer(0, 4);
      }
      return box;
    };
    const std::array<WholeBox, 3> boxes{whole_box(), whole_box(), whole_box()};
    std::array<BoxBounds, 3> bounds;
    std::array<float, 3> rounding;
    for (std::size_t i = 0; i < 3; ++i) {
      bounds[i] = BoxBounds(boxes[i].scaled(scale));
      rounding[i] = kept_rounding(scale * static_cast<double>(boxes[i].radius));
    }
    const unsigned overlap = BoxOverlaps(bounds[0], rounding[0], bounds[1], rounding[1]).with(bounds[2], rounding[2]);
    for (const std::size_t i : {0, 1}) {
      const bool told = (overlap >> i & 1) != 0;
      const std::int64_t sum_of_radii = boxes[i].radius + boxes[2].radius;
      const std::int64_t gap = square_gap(boxes[i], boxes[2]);
      const bool as_boxes = boxes[i].scaled(scale).overlaps(boxes[2].scaled(scale));
      missed += gap <= sum_of_radii * sum_of_radii && !told;
      // A radius that is not a usual number of single precision is kept as less.
      const bool kept = std::abs(std::log2(scale)) < 95;
      in_vain += told && (kept ? gap > sum_of_radii * sum_of_radii : !as_boxes);
      touching += gap == sum_of_radii * sum_of_radii && sum_of_radii > 0;
      only_as_boxes += as_boxes && !told;
      lanes_differ +=
          told != ((BoxOverlaps(bounds[2], rounding[2], bounds[2], rounding[2]).with(bounds[i], rounding[i]) & 2) != 0);
    }
  }
  CHECK(missed == 0);
  CHECK(in_vain == 0);
  CHECK(lanes_differ == 0);
  CHECK(touching > 1000);
  CHECK(only_as_boxes > 1000);
}

TEST_CASE("A box grid tells of just the overlaps of rounded boxes that change", "[box_grid]") {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    Random random(seed);
    constexpr BoxGrid::Id count = 60;
    BoxGrid grid;
    std::set<std::pair<BoxGrid::Id, BoxGrid::Id>> pairs;
    BoxGrid::Changes changes;
    std::size_t wrong = 0, overlapping = 0, as_boxes = 0;
    for (int round = 0; round < 1500; ++round) {
      const auto id = static_cast<BoxGrid::Id>(random.below(count));
      changes.clear();
      if (grid.contains(id) && random.one_in(8)) {
        grid.remove(id, changes);
      } else {
        // A cube whose rounding is up to half its side; often near where it was, and in other cases of another level.
        const Array3d at =
            grid.contains(id) && random.one_in(2) ? grid.box(id).min.eval() : random_box(random, 0, 3, 0).min.eval();
        const double size = seed % 2 == 0 ? random.between(0.8, 1) : std::exp(random.between(-2, 1));
        const Array3d low = at + random_box(random, 0, 0.2, 0).min;
        grid.put(id, {low, low + size}, changes, random.one_in(6) ? 0 : size * random.between(0.2, 0.5));
      }
      for (const auto other : changes.ended) wrong += pairs.erase(ordered(id, other)) != 1;
      for (const auto other : changes.began) wrong += !pairs.insert(ordered(id, other)).second;
      if (round % 10 != 0) continue;
      for (BoxGrid::Id a = 0; a < grid.end(); ++a) {
        for (BoxGrid::Id b = 0; b < a; ++b) {
          if (!grid.contains(a) || !grid.contains(b)) continue;
          wrong += grid.overlap(a, b) != pairs.contains(ordered(a, b));
          wrong += grid.overlap(a, b) != grid.overlap(b, a);
          overlapping += grid.overlap(a, b);
          as_boxes += grid.box(a).overlaps(grid.box(b));
        }
      }
    }
    INFO("seed " << seed);
    CHECK(wrong == 0);
    CHECK(overlapping > 3000);
    CHECK(overlapping < 0.95 * static_cast<double>(as_boxes));
  }
}

struct Balls final : PairListener {
  void pair_began(BodySlot a, BodySlot b, double) override { wrong += !pairs.insert({a, b}).second; }
  void pair_ended(BodySlot a, BodySlot b, double) override { wrong += pairs.erase({a, b}) != 1; }

  /// How many balls touch at a time that are no pair, or the boxes of how many overlap.
  template <class Count>
  void compare(const std::vector<KineticBox<1>>& boxes, double now, const Count& count) {
    for (BodySlot b = 0; b < boxes.size(); ++b) {
      for (BodySlot a = 0; a < b; ++a) {
        const StaticBox first = box_at(boxes[a], now);
        const StaticBox second = box_at(boxes[b], now);
        const Array3d gap = 0.5 * (first.min + first.max - second.min - second.max);
        const double radius = boxes[a].rounding + boxes[b].rounding;
        count(gap.matrix().norm() < radius * (1 - 1e-12), first.overlaps(second), pairs.contains({a, b}));
      }
    }
  }

  std::set<std::pair<BodySlot, BodySlot>> pairs;
  std::size_t wrong = 0;
};

TEST_CASE("The kinetic grid has all pairs of balls that touch, and fewer than of boxes that overlap", "[broad_phase]") {
  std::size_t touching = 0, boxes_alone = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    std::size_t missed = 0;
    const auto vector = [&](double most) {
      return Vector3d(random.between(-most, most), random.between(-most, most), random.between(-most, most));
    };
    std::vector<KineticBox<1>> boxes;
    const auto ball = [&](const Vector3d& at, double now, double radius) {
      certificates::PointMotion<1> motion;
      motion.coefficients = {at, vector(1)};
      motion.start = now;
      return box_around(motion, Vector3d::Constant(-radius), Vector3d::Constant(radius), radius);
    };
    for (int i = 0; i < 150; ++i) boxes.push_back(ball(vector(3), 0, random.between(0.2, 0.6)));
    KineticGrid<1> grid(boxes_of(boxes));
    Balls balls;
    grid.extend_horizon(0, never);
    std::vector<BroadPhase<1>::Entry> entries;
    for (BodySlot id = 0; id < boxes.size(); ++id) entries.push_back({id, &boxes[id]});
    const std::size_t first = seed % 2 == 0 ? boxes.size() : 1;  // all at once, or most into those that are there
    grid.insert(std::span(entries).first(first), 0, balls);
    grid.insert(std::span(entries).subspan(first), 0, balls);
    double now = 0;
    for (int round = 0; round < 400; ++round) {
      now += random.between(0, 0.02);
      while (grid.advance(now, balls)) {
      }
      // Struck where it is, or of another radius from now on: it may be another body.
      const auto id = static_cast<BodySlot>(random.below(boxes.size()));
      const StaticBox at = box_at(boxes[id], now);
      const double radius = random.one_in(4) ? random.between(0.2, 0.6) : boxes[id].rounding;
      Vector3d centre = (0.5 * (at.min + at.max)).matrix();
      if (centre.cwiseAbs().maxCoeff() > 3) centre = vector(3);
      boxes[id] = ball(centre, now, radius);
      grid.update(id, boxes[id], now, balls);
      balls.compare(boxes, now, [&](bool touch, bool overlap, bool pair) {
        touching += touch;
        missed += touch && !pair;
        boxes_alone += overlap && !pair;
      });
    }
    grid.audit(now);
    CHECK(balls.wrong == 0);
    CHECK(missed == 0);
  }
  CHECK(touching > 10'000);
  CHECK(boxes_alone > 1000);
}

TEST_CASE("A body that is less rounded from now on gets another fat box", "[broad_phase]") {
  // In its corner a cube reaches what a ball does not.
  certificates::PointMotion<1> motion;
  const auto box = [&](const Vector3d& at, double rounding) {
    motion.coefficients = {at, Vector3d::Zero()};
    return box_around(motion, Vector3d::Constant(-1), Vector3d::Constant(1), rounding);
  };
  const std::vector<KineticBox<1>> boxes{box({0, 0, 0}, 1), box({1.9, 1.9, 1.9}, 1)};
  const std::vector<BroadPhase<1>::Entry> entries{{0, &boxes[0]}, {1, &boxes[1]}};
  KineticGrid<1> grid(boxes_of(boxes));
  Balls balls;
  grid.insert(entries, 0, balls);
  CHECK(balls.pairs.empty());
  grid.update(0, box({0, 0, 0}, 0), 1, balls);
  grid.update(1, box({1.9, 1.9, 1.9}, 0), 1, balls);
  CHECK(balls.pairs.size() == 1);
  grid.update(1, box({1.9, 1.9, 1.9}, 1), 2, balls);
  grid.update(0, box({0, 0, 0}, 1), 2, balls);
  CHECK(balls.wrong == 0);
}

}  // namespace
}  // namespace kds::collision::test_box_bounds
