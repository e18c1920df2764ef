#include "certificates/turning/rigid_motion.hpp"
#include "collision/parallel/division.hpp"

#include "collision/parallel/domain.hpp"
#include "collision/world.hpp"
#include "kds/framework/snapshot.hpp"
#include "tests/collision/event_log.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
#include <vector>

namespace kds::collision::test_division {
namespace {

using Eigen::Vector3d;
using kds::tests::Random;

/// Balls on the places of a lattice, and a plate at rest on which they lie.
Bodies<certificates::PointMotion<1>> lattice(int side) {
  Random random(4);
  Bodies<certificates::PointMotion<1>> bodies;
  const auto add = [&](const BodyDescription<1>& body) {
    const auto shape = std::make_shared<const PlacedShape>(place(body.shape, body.orientation));
    bodies.add(body, shape, body.motion[0]);
  };
  for (int i = 0; i < side * side * side; ++i) {
    const Vector3d velocity(random.between(-2, 2), random.between(-2, 2), 0);
    add(tests::ball<1>(0.25, Vector3d(i % side, i / side % side, i / side / side), velocity));
  }
  add(tests::fixed_body<1>(Box{{100, 100, 0.5}}, tests::motion<1>({0, 0, -2})));
  add(tests::fixed_body<1>(Sphere{1}, tests::motion<1>({3, 3, 3}, {1, 0, 0})));
  add(tests::fixed_body<1>(Sphere{0.125}, tests::motion<1>({3, 3, 3}, {1, 0, 0})));
  return bodies;
}

/// Of one process alone, with who owns and knows each body.
std::optional<Division> divided(const Bodies<certificates::PointMotion<1>>& bodies, double now,
                                const ParallelOptions& options, std::size_t threads) {
  Team alone(nullptr);
  std::vector<BodySlot> slots(bodies.slots());
  std::iota(slots.begin(), slots.end(), BodySlot{0});
  auto division = divide(bodies, {}, slots, now, options, threads, alone);
  std::vector<DomainIndex> knowers;
  for (const BodySlot slot : slots) {
    if (!division) break;
    const DomainIndex owner = assign_body(*division, bodies, {}, slot, now, knowers);
    division->note(slot, owner, knowers);
  }
  return division;
}

}  // namespace

TEST_CASE("Division: bodies are owned where they are, and known as far as the halo", "[parallel]") {
  const auto bodies = lattice(12);
  const auto division = divided(bodies, 0, {.domains = 4, .halo = 2}, 1);
  REQUIRE(division);
  CHECK(division->partition.size() == 4);
  CHECK(division->greatest_radius == 0.25);  // of what has an owner
  CHECK(division->halo == Approx(0.5 + 2 * 11.0 / 12).epsilon(1e-3));
  CHECK(division->greatest_speed <= 2);
  const BodySlot plate = 12 * 12 * 12, large = plate + 1, small = plate + 2;
  CHECK(division->owner_of(plate) == Division::nobody);
  CHECK(division->knowers(plate).size() == 4);
  // No other body changes how these move: the larger one is known everywhere.
  CHECK(division->owner_of(large) == Division::nobody);
  CHECK(division->knowers(large).size() == 4);
  CHECK(division->owner_of(small) != Division::nobody);
  CHECK(division->knowers(small).size() < 4);
  std::size_t copies = 0;
  for (BodySlot slot = 0; slot < plate; ++slot) {
    const Vector3d place = bodies.path(slot).position(0);
    CHECK(division->owner_of(slot) == division->partition.cell_of(place));
    for (std::size_t i = 0; i < 4; ++i) {
      const bool near = outside(place, division->partition.cell(i)) <= division->halo;
      CHECK(near == std::ranges::binary_search(division->knowers(slot), i));
      copies += near;
    }
  }
  CHECK(copies > plate);
}

TEST_CASE("Division: into many domains, whose halos reach over several cells", "[parallel]") {
  const auto bodies = lattice(12);
  const auto division = divided(bodies, 0, {.domains = 500, .halo = 1.5}, 1);
  REQUIRE(division);
  const std::size_t domains = division->partition.size();
  CHECK(domains == 500);
  std::size_t most = 0;
  for (BodySlot slot = 0; slot < 12 * 12 * 12; ++slot) {
    const Vector3d place = bodies.path(slot).position(0);
    std::vector<DomainIndex> knowers;
    for (std::size_t i = 0; i < domains; ++i) {
      if (outside(place, division->partition.cell(i)) <= division->halo) knowers.push_back(static_cast<DomainIndex>(i));
    }
    REQUIRE(std::ranges::equal(division->knowers(slot), knowers));
    REQUIRE(std::ranges::binary_search(knowers, division->owner_of(slot)));
    most = std::max(most, knowers.size());
  }
  CHECK(most > 30);
  CHECK(most < 400);
  CHECK(division->knowers(12 * 12 * 12).size() == domains);  // the plate
  CHECK(division->sets.size() < domains + 12 * 12 * 12 + 4);

  // A body may come out of its cell by a halo, into the halo of another.
  for (const std::size_t index : {0u, 137u, 499u}) {
    const Domain<certificates::PointMotion<1>> domain(WorldOptions(), *division, index, 0, false, index == 0);
    std::vector<DomainIndex> near, neighbours;
    for (std::size_t i = 0; i < domains; ++i) {
      const double distance = outside(division->partition.cell(i), division->partition.cell(index));
      if (i != index && distance <= 2 * division->halo) near.push_back(static_cast<DomainIndex>(i));
    }
    for (const NeighbourDomain& neighbour : domain.neighbours()) neighbours.push_back(neighbour.domain);
    REQUIRE(neighbours == near);
  }
}

TEST_CASE("Division: moves of bodies come out as they went in", "[parallel]") {
  const std::vector<std::vector<DomainIndex>> knowers{{3}, {}, {1, 2, 500}, {65534}};
  BodyMoves moves;
  CHECK(moves.empty());
  for (std::size_t i = 0; i < knowers.size(); ++i) {
    moves.add(static_cast<BodySlot>(10 * i), static_cast<DomainIndex>(i), knowers[i]);
  }
  BodyMoves loaded;
  restore(save(moves), loaded);
  std::size_t next = 0;
  loaded.each([&](BodySlot number, DomainIndex owner, std::span<const DomainIndex> known) {
    CHECK(number == 10 * next);
    CHECK(owner == next);
    CHECK(std::ranges::equal(known, knowers.at(next++)));
  });
  CHECK(next == knowers.size());
  moves.clear();
  CHECK(moves.empty());
}

TEST_CASE("Division: a scene has one domain where more would not pay, or places are not known", "[parallel]") {
  const auto bodies = lattice(12);
  CHECK(domains_wanted({}, 2, 19'999) == 1);
  CHECK(domains_wanted({}, 2, 20'000) == 2);
  CHECK(domains_wanted({}, 100, 10'000'000) == 100);
  CHECK(domains_wanted({}, 100'000, 10'000'000'000) == most_domains);
  CHECK(domains_wanted({.domains = 5}, 2, 10) == 5);
  CHECK(domains_wanted({.domains = 2}, 1, 20'000) == 2);
  CHECK_FALSE(divided(bodies, 0, {}, 2));  // too few bodies
  CHECK_FALSE(divided(bodies, 1e9, {.domains = 2, .halo = 1e-9}, 2));
  CHECK_FALSE(divided(Bodies<certificates::PointMotion<1>>(), 0, {.domains = 2}, 2));
}

}  // namespace kds::collision::test_division
