// The granular gas: its sums against kinetic theory that is exact, and against a count of its own.
#include "examples/jobs/granular_gas/experiments.hpp"
#include "examples/jobs/granular_gas/gas.hpp"
#include "examples/jobs/granular_gas/measures.hpp"
#include "examples/jobs/granular_gas/theory.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <vector>

namespace test_granular_gas {

using namespace granular_gas;

/// Least distance of two balls over that at contact, by minimum images of all pairs.
double nearest_pair(const Gas& gas) {
  double nearest = 1e9;
  for (std::size_t i = 0; i < gas.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      Eigen::Vector3d apart = gas.position(j) - gas.position(i);
      for (int d = 0; d < 3; ++d) apart[d] -= gas.side() * std::round(apart[d] / gas.side());
      nearest = std::min(nearest, apart.norm() / (gas.radius(i) + gas.radius(j)));
    }
  }
  return nearest;
}

TEST_CASE("granular gas: packing, momentum and temperature at the start, and no overlap later") {
  const auto ratio = GENERATE(1.0, 1.6);
  CAPTURE(ratio);
  Gas gas({.balls = 100, .packing = 0.35, .size_ratio = ratio, .seed = 3});
  REQUIRE(gas.size() == 108);
  double filled = 0;
  for (const double radius : gas.radii()) filled += 4 * 3.14159265358979 / 3 * radius * radius * radius;
  CHECK(filled / gas.volume() == Approx(0.35));
  CHECK(gas.temperature() == Approx(1));
  const auto [least, most] = std::minmax_element(gas.radii().begin(), gas.radii().end());
  CHECK(*most / *least <= ratio);
  CHECK(*most / *least >= 1 + 0.9 * (ratio - 1));
  for (double t = 0.2; t <= 2; t += 0.2) {
    gas.advance_to(t);
    CHECK(nearest_pair(gas) > 1 - 1e-12);
  }
  CHECK(gas.sums().contacts > 300);
  CHECK(gas.temperature() == Approx(1).epsilon(1e-12));
  gas.world().audit();
}

/// Errors are those of the blocks; five of them, and what equations of state are known to be off by.
TEST_CASE("granular gas: pressure and collision rate of Carnahan and Starling, and of Enskog") {
  const auto packing = GENERATE(0.1, 0.3);
  const auto ratio = GENERATE(1.0, 1.5);
  CAPTURE(packing, ratio);
  const Equilibrium gas = equilibrium({.balls = 108, .packing = packing, .size_ratio = ratio, .seed = 1}, 12'000);
  CHECK(gas.contacts == Approx(12'000).epsilon(0.1));
  CHECK(gas.temperature == Approx(1).epsilon(1e-12));
  const auto near = [](const Mean& mean, double theory) {
    CAPTURE(mean.value, mean.error, theory);
    CHECK(std::abs(mean.value - theory) < 5 * mean.error + 0.012 * theory);
    CHECK(mean.error < 0.02 * theory);
  };
  near(gas.compressibility, gas.theory_compressibility);
  near(gas.rate, gas.theory_rate);
  double far = 0;  // where balls know little of each other, and still nearer than half the side
  for (std::size_t bin = 50; bin < 75; ++bin) far += gas.radial.value(bin) / 25;
  CHECK(far == Approx(1).epsilon(0.05));
  // In the collision rate of equal balls is the contact value, and in the pressure too: one is a function of the other.
  if (ratio == 1) {
    CHECK(gas.diffusion_of_large_box == Approx(gas.simulated_diffusion).epsilon(0.1));
    CHECK(gas.contact_value == Approx(gas.theory_contact_value).epsilon(0.25));
    const double from_rate = 1 + 4 * packing * gas.theory_contact_value * gas.rate.value / gas.theory_rate;
    CHECK(gas.compressibility.value == Approx(from_rate).epsilon(0.01));
  }
}

TEST_CASE("granular gas: a sheared gas reaches a temperature, at which shear and collisions are in balance") {
  std::vector<ShearedState> states;
  const Sheared steady = sheared({.balls = 108, .packing = 0.25, .restitution = 0.8, .shear_rate = 2, .seed = 2},
                                 10'000, [&](const ShearedState& state) { states.push_back(state); });
  REQUIRE(states.size() == 100);
  const double power = 2 * steady.stress.value, error = 2 * steady.stress.error + steady.dissipation.error;
  CAPTURE(power, steady.dissipation.value, error);
  CHECK(std::abs(power - steady.dissipation.value) < 5 * error);
  CHECK(error < 0.1 * power);
  // Enskog's viscosity is that of an elastic gas with little shear.
  CHECK(steady.temperature.value == Approx(steady.theory_temperature).epsilon(0.35));
  CHECK(states.back().temperature != states.front().temperature);
}

TEST_CASE("granular gas: equations that hold for equal balls come out of those for mixtures") {
  const std::vector<double> radii(64, 0.5);
  const double packing = 0.4, volume = 64 * 3.14159265358979323846 / 6 / packing;
  const Mixture mixture(radii, volume);
  CHECK(mixture.packing == Approx(packing));
  const double p = packing;
  CHECK(mixture.compressibility() == Approx((1 + p + p * p - p * p * p) / std::pow(1 - p, 3)));
  CHECK(mixture.contact_value(1, 1) == Approx((1 - p / 2) / std::pow(1 - p, 3)));
  CHECK(enskog_rate(mixture, radii) ==
        Approx(4 * 64 / volume * std::sqrt(3.14159265358979) * mixture.contact_value(1, 1)));
}

TEST_CASE("granular gas: the mean and the error of blocks") {
  const Mean mean = mean_of({1, 2, 3, 6});
  CHECK(mean.value == 3);
  CHECK(mean.error == Approx(std::sqrt(14.0 / 12)));
}

TEST_CASE("granular gas: what cannot be run is refused") {
  const auto ignore = [](const ShearedState&) {};
  CHECK_THROWS_AS(Gas({.balls = 4}), std::invalid_argument);
  CHECK_THROWS_AS(Gas({.packing = 0}), std::invalid_argument);
  CHECK_THROWS_AS(Gas({.restitution = 1.1}), std::invalid_argument);
  CHECK_THROWS_WITH(Gas({.packing = 0.5, .size_ratio = 3}), Catch::Contains("fit on the lattice up to"));
  CHECK_THROWS_AS(equilibrium({.balls = 32, .restitution = 0.9}, 10'000), std::invalid_argument);
  CHECK_THROWS_AS(equilibrium({.balls = 32, .shear_rate = 1}, 10'000), std::invalid_argument);
  CHECK_THROWS_WITH(equilibrium({.balls = 32}, 100), Catch::Contains("collisions: must be at least"));
  CHECK_THROWS_AS(sheared({.balls = 32, .restitution = 0.9}, 10'000, ignore), std::invalid_argument);
  CHECK_THROWS_AS(sheared({.balls = 32, .shear_rate = 1}, 10'000, ignore), std::invalid_argument);
}

}  // namespace test_granular_gas
