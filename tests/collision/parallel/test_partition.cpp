#include "collision/parallel/partition.hpp"
#include "tests/collision/parallel/thread_processes.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace kds::collision::test_partition {
namespace {

using Eigen::Vector3d;
using kds::tests::Random;

constexpr double all = std::numeric_limits<double>::infinity();

std::vector<Vector3d> places(Random& random, std::size_t n, bool coarse) {
  std::vector<Vector3d> result;
  for (std::size_t i = 0; i < n; ++i) {
    Vector3d place;
    for (int d = 0; d < 3; ++d) place[d] = coarse ? random.integer(0, 3) : random.between(-5, 5);
    result.push_back(place);
  }
  return result;
}

Partition partition_of(std::vector<Vector3d> places, std::size_t cells) {
  Team alone(nullptr);
  return Partition(std::move(places), cells, alone);
}

bool contains(const StaticBox& cell, const Vector3d& place) {
  return (cell.min <= place.array()).all() && (place.array() < cell.max).all();
}

}  // namespace

TEST_CASE("Partition: each place is in one cell, the one that is named", "[parallel]") {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    Random random(seed);
    const bool coarse = random.one_in(2);
    const std::size_t wanted = 1 + random.below(20);
    const auto of = places(random, 1 + random.below(400), coarse);
    const Partition partition = partition_of(of, wanted);
    INFO("seed " << seed << ", " << of.size() << " places, " << wanted << " cells");
    REQUIRE(partition.size() >= 1);
    REQUIRE(partition.size() <= wanted);
    auto asked = places(random, 200, coarse);
    asked.insert(asked.end(), of.begin(), of.end());
    asked.push_back({1e9, -1e9, 0});
    std::vector<std::size_t> count(partition.size(), 0);
    for (const Vector3d& place : asked) {
      std::size_t holders = 0;
      for (std::size_t i = 0; i < partition.size(); ++i) holders += contains(partition.cell(i), place);
      REQUIRE(holders == 1);
      const std::size_t cell = partition.cell_of(place);
      REQUIRE(contains(partition.cell(cell), place));
      REQUIRE(outside(place, partition.cell(cell)) == 0);
      REQUIRE(inside(place, partition.cell(cell)) >= 0);
    }
    for (const Vector3d& place : of) ++count[partition.cell_of(place)];
    // Where places differ, none of the cells is much larger than its share.
    if (coarse || of.size() < 10 * wanted) continue;
    REQUIRE(partition.size() == wanted);
    for (const std::size_t bodies : count) REQUIRE(bodies <= 2 * of.size() / wanted + 2);
  }
}

TEST_CASE("Partition: the cells near a place or a box, without a look at all", "[parallel]") {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    Random random(seed);
    const bool coarse = random.one_in(2);
    const Partition partition = partition_of(places(random, 1 + random.below(400), coarse), 1 + random.below(200));
    INFO("seed " << seed << ", " << partition.size() << " cells");
    for (const Vector3d& place : places(random, 50, coarse)) {
      // Coarse numbers are often as far away as this.
      const double distance = coarse ? random.integer(0, 2) : random.between(0, 4);
      const double extent = coarse ? random.integer(0, 2) : random.between(0, 2);
      const StaticBox box{place.array() - extent, place.array() + extent};
      std::vector<std::size_t> near_place, near_box, found_place, found_box;
      for (std::size_t i = 0; i < partition.size(); ++i) {
        if (outside(place, partition.cell(i)) <= distance) near_place.push_back(i);
        if (outside(box, partition.cell(i)) <= distance) near_box.push_back(i);
      }
      partition.each_within(place, distance, [&](std::size_t cell) { found_place.push_back(cell); });
      partition.each_within(box, distance, [&](std::size_t cell) { found_box.push_back(cell); });
      REQUIRE(found_place == near_place);
      REQUIRE(found_box == near_box);
    }
    // A cell is near itself and those that it touches.
    const std::size_t cell = random.below(partition.size());
    bool itself = false;
    partition.each_within(partition.cell(cell), 0, [&](std::size_t near) { itself = itself || near == cell; });
    REQUIRE(itself);
  }
}

TEST_CASE("Partition: processes that have some places each find the cells that one has of all", "[parallel]") {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    Random random(seed);
    const bool coarse = random.one_in(3);
    const std::size_t wanted = 1 + random.below(40), processes = 1 + random.below(5);
    const auto all_places = places(random, 1 + random.below(400), coarse);
    const Partition right = partition_of(all_places, wanted);
    // The first has none, as a rule.
    std::vector<std::vector<Vector3d>> parts(processes);
    for (const Vector3d& place : all_places) parts[processes - 1 - random.below((processes + 1) / 2)].push_back(place);
    INFO("seed " << seed << ", " << right.size() << " cells, " << processes << " processes");
    std::vector<std::vector<StaticBox>> found(processes);
    tests::ThreadProcesses(processes).run([&](Processes& others) {
      Team team(&others);
      const Partition partition(parts[others.rank()], wanted, team);
      for (std::size_t i = 0; i < partition.size(); ++i) found[others.rank()].push_back(partition.cell(i));
    });
    for (const auto& cells : found) {
      REQUIRE(cells.size() == right.size());
      for (std::size_t i = 0; i < cells.size(); ++i) {
        REQUIRE((cells[i].min == right.cell(i).min).all());
        REQUIRE((cells[i].max == right.cell(i).max).all());
      }
    }
  }
}

TEST_CASE("Partition: places that coincide are not divided", "[parallel]") {
  CHECK(partition_of(std::vector<Vector3d>(10, Vector3d(1, 2, 3)), 8).size() == 1);
  std::vector<Vector3d> two(9, Vector3d::Zero());
  two.push_back({0, 1, 0});
  const Partition partition = partition_of(two, 8);
  REQUIRE(partition.size() == 2);
  CHECK(partition.cell_of({0, 0, 0}) != partition.cell_of({0, 1, 0}));
}

TEST_CASE("Partition: how far boxes are outside a cell, and how far they reach out of it", "[parallel]") {
  const StaticBox cell{{0, -all, -all}, {10, all, 4}};
  const auto box = [](double x, double z, double half) {
    return StaticBox{{x - half, -half, z - half}, {x + half, half, z + half}};
  };
  CHECK(outside(box(5, 0, 1), cell) == 0);
  CHECK(farthest_outside(box(5, 0, 1), cell) == 0);
  CHECK(outside(box(10, 0, 1), cell) == 0);
  CHECK(farthest_outside(box(10, 0, 1), cell) == 1);
  CHECK(outside(box(13, 8, 1), cell) == 3);
  CHECK(farthest_outside(box(13, 8, 1), cell) == 5);
  CHECK(outside(Vector3d(-2, 100, 5), cell) == 2);
  CHECK(inside(Vector3d(3, 100, 3), cell) == 1);
  CHECK(inside(Vector3d(-3, 100, 3), cell) == -3);
}

}  // namespace kds::collision::test_partition
