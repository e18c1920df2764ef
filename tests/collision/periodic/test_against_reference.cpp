// The contacts of a periodic world against a simulation that tests all pairs with all copies near them.
#include "collision/periodic/periodic_world.hpp"
#include "tests/collision/periodic/periodic_scenes.hpp"
#include "tests/collision/periodic/reference_gas.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace test_against_reference {

using namespace periodic_scenes;

/// The next contacts, each with the copy of b as it is where nothing is wrapped.
struct Contacts final : PeriodicListener<1> {
  std::vector<PeriodicEvent> events;
  void contact(PeriodicWorld<1>& world, const PeriodicEvent& event) override {
    events.push_back(event);
    events.back().offset = event.offset + world.crossings(event.a) + -world.crossings(event.b);
  }
};

reference::Gas reference_of(const PeriodicWorld<1>& world, const std::vector<BodyDescription<1>>& balls) {
  std::vector<reference::Ball> copies;
  for (std::size_t i = 0; i < balls.size(); ++i) {
    const Offset crossings = world.crossings(i);
    const Eigen::Vector3d x = world.position(i), v = world.velocity(i) + world.lattice().velocity(crossings);
    // The displacement in long doubles: rounded to doubles it would be worse than the library's own places.
    const auto& lattice = world.lattice();
    reference::Vector place;
    for (std::size_t d = 0; d < 3; ++d) {
      place[d] = static_cast<long double>(x[int(d)]) +
                 static_cast<long double>(crossings[d]) * static_cast<long double>(lattice.period(int(d)));
    }
    place[0] += static_cast<long double>(crossings[1]) * static_cast<long double>(lattice.sliding()) *
                static_cast<long double>(world.now());
    copies.push_back(
        {place, {v[0], v[1], v[2]}, std::get<Sphere>(balls[i].shape).radius, balls[i].mass, balls[i].restitution});
  }
  const auto& lattice = world.lattice();
  return reference::Gas(std::move(copies), {lattice.period(0), lattice.period(1), lattice.period(2)}, lattice.sliding(),
                        world.now());
}

/// Rounding errors grow some tenfold with each contact of a ball, so the reference starts anew from the state of the
/// world every few contacts; in between the two must agree within `tolerance`, s.
void compare(const PeriodicOptions& options, const std::vector<BodyDescription<1>>& balls, std::size_t rounds,
             std::size_t contacts_a_round) {
  constexpr double tolerance = 1e-8;
  Contacts told;
  PeriodicWorld<1> world(options, &told);
  for (const auto& ball : balls) world.add_body(ball);
  std::size_t across = 0;
  for (std::size_t round = 0; round < rounds; ++round) {
    reference::Gas gas = reference_of(world, balls);
    told.events.clear();
    for (std::size_t i = 0; i < contacts_a_round; ++i) {
      const reference::Meeting expected = gas.next();
      while (told.events.size() <= i) REQUIRE(world.step(world.now() + 100));
      const PeriodicEvent& found = told.events[i];
      CAPTURE(round, i, expected.a, expected.b, found.a, found.b, double(expected.time), found.contact.time);
      REQUIRE((found.a == expected.a && found.b == expected.b));
      REQUIRE(found.offset == Offset{expected.copy[0], expected.copy[1], expected.copy[2]});
      REQUIRE(std::abs(found.contact.time - double(expected.time)) < tolerance);
      REQUIRE(std::abs(found.impulse - double(expected.impulse)) < tolerance * 100);
      across += found.offset != Offset{};
    }
    world.audit();
  }
  CHECK(across > 0);
}

TEST_CASE("periodic world: the contacts of a reference that tests all pairs and copies") {
  const auto seed = GENERATE(1u, 2u, 3u);
  const auto shear = GENERATE(0.0, 0.7, -3.0);
  CAPTURE(seed, shear);
  PeriodicOptions options;
  options.min = {-1, 0.5, -2};
  options.max = {2.3, 4, 2};
  options.shear_rate = shear;
  // Inelastic gases need heating, or they collapse: those at rest are elastic.
  compare(options, random_balls<1>(20, options, seed, shear == 0 ? 1 : 0.9), 12, 20);
}

TEST_CASE("periodic world: a thin box, in which a ball meets several copies of another") {
  const auto seed = GENERATE(1u, 2u);
  const auto shear = GENERATE(0.0, 1.0);
  CAPTURE(seed, shear);
  PeriodicOptions options;
  options.max = {1.3, 1.1, 6};
  options.shear_rate = shear;
  compare(options, random_balls<1>(4, options, seed), 20, 8);
}

TEST_CASE("periodic world: periodic along one axis or two, open along the others") {
  const auto axes = GENERATE(1u, 2u, 3u, 5u, 6u);  // bits
  CAPTURE(axes);
  PeriodicOptions options;
  options.max = {3, 3.5, 4};
  for (std::size_t d = 0; d < 3; ++d) options.boundaries[d] = axes >> d & 1 ? Boundary::periodic : Boundary::open;
  auto balls = random_balls<1>(20, options, axes);
  // They would fly apart: each moves along the periodic axes alone, until contacts turn it.
  for (auto& ball : balls) {
    for (int d = 0; d < 3; ++d) {
      if (!(axes >> d & 1)) ball.motion[0].coefficients[1][d] *= 0x1p-6;
    }
  }
  compare(options, balls, 2, 8);
}

}  // namespace test_against_reference
