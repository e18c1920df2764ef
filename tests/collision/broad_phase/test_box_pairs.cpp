// Pairs of boxes by sorting, against brute force.
#include "collision/broad_phase/box_pairs.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace kds::collision::test_box_pairs {
namespace {

using kds::tests::Random;
using Numbers = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

/// Boxes of extents 1 ... spread in a space of these sides, on a lattice of halves if `touching`.
std::vector<StaticBox> random_boxes(Random& random, std::size_t n, const Eigen::Array3d& sides, double spread,
                                    bool touching) {
  std::vector<StaticBox> boxes(n);
  for (StaticBox& box : boxes) {
    for (int d = 0; d < 3; ++d) {
      double low = random.between(-1, 1) * sides[d];
      double size = std::exp(random.between(0, std::log(spread)));
      if (touching) low = 0.5 * std::floor(2 * low), size = std::ceil(size);
      box.min[d] = low;
      box.max[d] = low + size;
    }
  }
  return boxes;
}

Numbers brute_force(const std::vector<StaticBox>& boxes) {
  Numbers pairs;
  for (std::uint32_t a = 0; a < boxes.size(); ++a) {
    for (std::uint32_t b = a + 1; b < boxes.size(); ++b) {
      if (boxes[a].overlaps(boxes[b])) pairs.emplace_back(a, b);
    }
  }
  return pairs;
}

Numbers sorted(std::span<const BoxPairs::Pair> pairs) {
  Numbers numbers;
  for (const auto& [a, b] : pairs) numbers.emplace_back(std::min(a, b), std::max(a, b));
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

TEST_CASE("Pairs of boxes found by sorting are all there are", "[box_pairs]") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  const Eigen::Array3d sides = GENERATE(Eigen::Array3d(9, 9, 9), Eigen::Array3d(40, 30, 0), Eigen::Array3d(600, 0, 0),
                                        Eigen::Array3d(1e9, 1e9, 1e9));
  const bool touching = GENERATE(false, true);
  CAPTURE(seed, sides.transpose(), touching);
  Random random(seed);
  const auto boxes = random_boxes(random, 1 + random.below(900), sides, 2, touching);
  BoxPairs pairs;
  REQUIRE(pairs.find(boxes));
  CHECK(sorted(pairs.pairs()) == brute_force(boxes));
  std::vector<BoxPairs::Index> order(pairs.order().begin(), pairs.order().end());
  std::sort(order.begin(), order.end());
  bool all = order.size() == boxes.size();
  for (std::size_t i = 0; i < order.size(); ++i) all = all && order[i] == i;
  CHECK(all);
}

TEST_CASE("Far from the origin boxes are told apart as exactly as by their ends", "[box_pairs]") {
  // Neighbours that touch, or are one double apart: single precision knows no difference.
  std::vector<StaticBox> boxes;
  double low = 0x1p40;
  for (int i = 0; i < 200; ++i) {
    const double high = low + 1;
    boxes.push_back({Eigen::Array3d(low, 0, 0), Eigen::Array3d(high, 1, 1)});
    low = i % 2 == 0 ? high : std::nextafter(high, 0x1p60);
  }
  BoxPairs pairs;
  REQUIRE(pairs.find(boxes));
  CHECK(pairs.pairs().size() == 100);
  CHECK(sorted(pairs.pairs()) == brute_force(boxes));
}

TEST_CASE("Boxes that sorting would be slow for are refused", "[box_pairs]") {
  Random random(5);
  BoxPairs pairs;
  CHECK(!pairs.find({}));
  auto boxes = random_boxes(random, 500, {50, 50, 50}, 1, false);
  CHECK(pairs.find(boxes));
  boxes[7].max[1] += 1e6;  // all others are in one cell with it
  CHECK(!pairs.find(boxes));
  boxes[7].max[1] = 1e308;
  boxes[7].min[1] = -1e308;
  CHECK(!pairs.find(boxes));
  CHECK(!pairs.find(std::vector<StaticBox>(300, {Eigen::Array3d::Zero(), Eigen::Array3d::Zero()})));
}

TEST_CASE("Few boxes are compared however crowded they are", "[box_pairs]") {
  Random random(6);
  auto boxes = random_boxes(random, 100, {50, 50, 50}, 1, false);
  boxes[7].max[1] += 1e6;
  BoxPairs pairs;
  REQUIRE(pairs.find(boxes));
  CHECK(sorted(pairs.pairs()) == brute_force(boxes));
  REQUIRE(pairs.find(std::vector<StaticBox>(100, {Eigen::Array3d::Zero(), Eigen::Array3d::Ones()})));
  CHECK(pairs.pairs().size() == 100 * 99 / 2);
}

TEST_CASE("Any number of threads finds the same pairs in the same order", "[box_pairs]") {
  Random random(9);
  const auto boxes = random_boxes(random, 20'000, {25, 25, 25}, 1.5, false);
  BoxPairs one, more;
  REQUIRE(one.find(boxes, 1));
  for (const std::size_t threads : {2, 3, 4}) {
    REQUIRE(more.find(boxes, threads));
    CHECK(sorted(more.pairs()) == sorted(one.pairs()));
    CHECK(std::equal(one.pairs().begin(), one.pairs().end(), more.pairs().begin(), more.pairs().end(),
                     [](const auto& p, const auto& q) { return p.a == q.a && p.b == q.b; }));
    CHECK(std::equal(one.order().begin(), one.order().end(), more.order().begin(), more.order().end()));
  }
}

}  // namespace
}  // namespace kds::collision::test_box_pairs
