// Trees of parts: the pairs of parts that may meet are those that a look at each part finds, bit for bit.
#include "collision/narrow_phase/part_pairs.hpp"
#include "collision/shapes/part_tree.hpp"
#include "tests/collision/sample_compounds.hpp"

#include <catch2/catch.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace kds::collision::test_part_tree {
namespace {

using namespace tests;

/// Every part in one leaf, and in the boxes and balls of all groups that have it. Returns the number of its parts.
std::size_t check_group(const PartTree& tree, std::span<const PlacedShape> parts, std::uint32_t group,
                        std::vector<std::uint32_t>& seen) {
  const PartTree::Node& node = tree.nodes()[group];
  const std::size_t before = seen.size();
  if (node.is_leaf()) {
    CHECK(node.count <= PartTree::leaf_size);
    for (const std::uint32_t part : tree.parts_of(node)) seen.push_back(part);
  } else {
    check_group(tree, parts, node.first, seen);
    check_group(tree, parts, node.first + 1, seen);
  }
  bool inside = true;
  for (std::size_t i = before; i < seen.size(); ++i) {
    const PlacedShape& part = parts[seen[i]];
    const BallOfPart ball(part);
    inside = inside && (part.low.array() >= node.low.array()).all() && (part.high.array() <= node.high.array()).all() &&
             norm(ball.centre - node.centre) + ball.radius <= node.radius * (1 + 0x1p-50) &&
             norm(ball.centre) <= node.reach * (1 + 0x1p-50);
  }
  CHECK(inside);
  return seen.size() - before;
}

template <int Degree>
certificates::PointMotion<Degree> random_path(Random& random, double side) {
  certificates::PointMotion<Degree> path{};
  path.start = random.one_in(2) ? 0 : random.between(-2, 0);
  for (std::size_t i = 0; i <= Degree; ++i) {
    if (i > 0 && random.one_in(3)) continue;
    const double size = i == 0 ? side : i == 1 ? 4 : 1;
    for (int d = 0; d < 3; ++d) path.coefficients[i][d] = random.between(-size, size);
  }
  return path;
}

/// Pairs listed with trees and without them, of random compounds and other shapes. Returns how many there were.
template <int Degree>
std::size_t compare_lists(std::uint64_t seed) {
  Random random(seed);
  const Parts kinds = random.one_in(2) ? Parts::boxes : random.one_in(2) ? Parts::solids : Parts::all;
  const double side = random.between(1, 12);
  const auto turned = [&] {
    if (random.one_in(2)) return Eigen::Quaterniond(Eigen::Quaterniond::Identity());
    const double w = random.between(-1, 1), x = random.between(-1, 1), y = random.between(-1, 1);
    return unit_quaternion(w, x, y, random.between(0.1, 1));
  };
  const std::size_t count = 2 + random.below(120);
  const PlacedShape a = place(random_compound(random, kinds, count, side), turned());
  const std::size_t others = 1 + random.below(60);
  const PlacedShape b = random.one_in(2)   ? place(random_compound(random, kinds, others, 0.5 * side), turned())
                        : random.one_in(2) ? placed_ball(random.between(0.1, 2))
                                           : place(Box{{0.5, 0.25, 1}}, turned());
  const bool two = std::holds_alternative<Compound>(b.shape);
  const PlacedShape plain_a = without_tree(a), plain_b = two ? without_tree(b) : b;
  const auto path_a = random.one_in(3) ? certificates::PointMotion<Degree>{} : random_path<Degree>(random, 1);
  auto path_b = random_path<Degree>(random, side + 3);
  if (random.one_in(6)) {  // the two stand to each other
    for (std::size_t i = 1; i <= Degree; ++i) path_b.coefficients[i] = path_a.coefficients[i];
    path_b.start = path_a.start;
  }
  const double horizon = random.one_in(3) ? 100 : random.between(0, 6);
  INFO("degree " << Degree << ", seed " << seed << ", " << count << " parts");
  std::size_t listed = 0;
  const double later = random.between(0, horizon);
  const std::pair<double, double> stretches[] = {{0, horizon}, {later, later}, {later, horizon}};
  for (const auto& [now, until] : stretches) {
    const PartPairs<Degree> pairs({a, path_a}, {b, path_b}, now, until);
    const PartPairs<Degree> plain({plain_a, path_a}, {plain_b, path_b}, now, until);
    // A part of a shape that is not a compound is the shape itself.
    const auto same = [&](const ListOfPartPairs::Pair& x, const ListOfPartPairs::Pair& y) {
      return x.a == y.a && (x.b == y.b || !two) && x.from == y.from && x.until == y.until;
    };
    CHECK(std::equal(pairs.all().begin(), pairs.all().end(), plain.all().begin(), plain.all().end(), same));
    listed += plain.all().size();
  }
  return listed;
}

}  // namespace

TEST_CASE("a tree of parts has each part once, in boxes and balls that hold it", "[compound]") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Random random(seed);
    const std::size_t count = 1 + random.below(300);
    const Compound whole = random_compound(random, Parts::all, count, 5);
    INFO("seed " << seed << ", " << count << " parts");
    const PlacedShape placed = place(whole, Eigen::Quaterniond::Identity());
    REQUIRE((part_tree(placed) != nullptr) == (count > PartTree::leaf_size));
    if (!part_tree(placed)) continue;
    std::vector<std::uint32_t> seen;
    CHECK(check_group(*part_tree(placed), *placed.parts, 0, seen) == count);
    std::sort(seen.begin(), seen.end());
    for (std::uint32_t i = 0; i < count; ++i) REQUIRE(seen[i] == i);
  }
}

TEST_CASE("equal parts at one place have a tree", "[compound]") {
  const std::vector<CompoundPart> parts(100, CompoundPart{Box{{1, 1, 1}}, {3, 0, 0}});
  const PlacedShape placed = place(compound(parts), Eigen::Quaterniond::Identity());
  std::vector<std::uint32_t> seen;
  CHECK(check_group(*part_tree(placed), *placed.parts, 0, seen) == 100);
}

TEMPLATE_TEST_CASE_SIG("pairs of parts are those that a look at each part lists", "[compound]", ((int Degree), Degree),
                       1, 2, 3) {
  std::size_t listed = 0;
  for (std::uint64_t seed = 1; seed <= 120; ++seed) listed += compare_lists<Degree>(seed);
  CHECK(listed > 300);
}

}  // namespace kds::collision::test_part_tree
