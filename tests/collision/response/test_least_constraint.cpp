// Least constraint: the conditions that a solution must satisfy, and cases that are known.
#include "collision/response/least_constraint.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace kds::collision::test_least_constraint {
namespace {

using Eigen::Vector3d;
using kds::tests::Random;

struct Problem {
  std::vector<Vector3d> rates;
  std::vector<double> inverse_masses;  ///< 0: fixed
  std::vector<Touch> touches;

  void touch(std::uint32_t a, std::uint32_t b, const Vector3d& normal) {
    touches.push_back({a, b, normal, inverse_masses[a], inverse_masses[b]});
  }
  std::uint32_t body(const Vector3d& rate, double inverse_mass) {
    rates.push_back(rate);
    inverse_masses.push_back(inverse_mass);
    return static_cast<std::uint32_t>(rates.size() - 1);
  }
};

const Vector3d up(0, 0, 1);

TEST_CASE("least constraint: a body on a floor stays, exactly, whatever its mass", "[resting]") {
  for (const double inverse_mass : {1.0, 1 / 3.0, 1e-7, 1e7}) {
    Problem p;
    p.body(Vector3d::Zero(), 0);
    p.body({0.3, 0, -9.81}, inverse_mass);
    p.touch(0, 1, up);
    REQUIRE(least_constraint(p.rates, p.touches));
    CHECK(p.rates[1] == Vector3d(0.3, 0, 0));
    CHECK(p.rates[0] == Vector3d::Zero());
    CHECK(p.touches[0].push == 9.81);
  }
}

TEST_CASE("least constraint: what parts is left alone, and what is pulled off a floor", "[resting]") {
  Problem p;
  p.body({0, 0, -20}, 0);
  p.body({0, 0, -9.81}, 1);
  p.body({0, 0, -9.81}, 2);
  p.touch(0, 1, up);
  p.touch(1, 2, up);
  REQUIRE(least_constraint(p.rates, p.touches));
  CHECK(p.rates[1] == Vector3d(0, 0, -9.81));
  CHECK(p.rates[2] == Vector3d(0, 0, -9.81));
  CHECK(p.touches[0].push == 0);
}

TEST_CASE("least constraint: stacks rest exactly, pushes carry what is above", "[resting]") {
  for (const std::size_t height : {2u, 3u, 10u, 100u}) {
    Problem p;
    p.body(Vector3d::Zero(), 0);
    for (std::size_t i = 0; i < height; ++i) {
      p.body({0, 0, -9.81}, 1);
      p.touch(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(i + 1), up);
    }
    REQUIRE(least_constraint(p.rates, p.touches));
    const bool rest =
        std::all_of(p.rates.begin(), p.rates.end(), [](const Vector3d& r) { return r == Vector3d::Zero(); });
    CHECK(rest);
    // Of equal masses: the relative rate that a touch gives is twice the force over the mass; the lowest has a fixed
    // partner, so once.
    CHECK(p.touches[0].push == Approx(9.81 * static_cast<double>(height)));
    CHECK(p.touches.back().push == Approx(height == 1 ? 9.81 : 2 * 9.81));
  }
}

TEST_CASE("least constraint: a light body under a heavy one", "[resting]") {
  for (const double ratio : {10.0, 1000.0, 1e6}) {
    Problem p;
    p.body(Vector3d::Zero(), 0);
    p.body({0, 0, -10}, 1);
    p.body({0, 0, -10}, 1 / ratio);
    p.touch(0, 1, up);
    p.touch(1, 2, up);
    REQUIRE(least_constraint(p.rates, p.touches));
    CHECK(p.rates[1].norm() < 1e-9);
    CHECK(p.rates[2].norm() < 1e-9);
  }
}

TEST_CASE("least constraint: three bodies collide without rebound and keep their momentum", "[resting]") {
  Problem p;
  p.body({2, 0, 0}, 1);
  p.body({0, 1, 0}, 0.5);
  p.body({-1, 0, 0}, 1);
  p.touch(0, 1, {1, 0, 0});
  p.touch(1, 2, {1, 0, 0});
  REQUIRE(least_constraint(p.rates, p.touches));
  // All three along x with the velocity of their centre: (2 + 0 - 1) / 4.
  for (const Vector3d& r : p.rates) CHECK(r[0] == Approx(0.25));
  CHECK(p.rates[1][1] == 1);
}

TEST_CASE("least constraint: between two that close in there is no solution", "[resting]") {
  Problem p;
  p.body({0, 0, 1}, 0);
  p.body({0, 0, 0}, 1);
  p.body({0, 0, -1}, 0);
  p.touch(0, 1, up);
  p.touch(1, 2, up);
  CHECK_FALSE(least_constraint(p.rates, p.touches));
  CHECK(std::isfinite(p.rates[1][2]));
  CHECK(p.rates[0] == Vector3d(0, 0, 1));
}

TEST_CASE("least constraint: the same touch twice, and a wedge between two slopes", "[resting]") {
  Problem twice;
  twice.body(Vector3d::Zero(), 0);
  twice.body({1, 2, -3}, 1);
  twice.touch(0, 1, up);
  twice.touch(0, 1, up);
  REQUIRE(least_constraint(twice.rates, twice.touches));
  CHECK(twice.rates[1] == Vector3d(1, 2, 0));

  Problem wedge;
  wedge.body(Vector3d::Zero(), 0);
  wedge.body({0, 0.5, -3}, 1);
  wedge.touch(0, 1, Vector3d(0.6, 0, 0.8));
  wedge.touch(0, 1, Vector3d(-0.6, 0, 0.8));
  REQUIRE(least_constraint(wedge.rates, wedge.touches));
  CHECK((wedge.rates[1] - Vector3d(0, 0.5, 0)).norm() < 1e-13);
}

TEST_CASE("least constraint: random sets satisfy the conditions of the minimum", "[resting]") {
  const std::uint64_t seed = 640;
  CAPTURE(seed);
  Random random(seed);
  int pushed = 0;
  for (int round = 0; round < 300; ++round) {
    Problem p;
    const std::size_t bodies = 2 + random.below(12);
    const auto number = [&] { return random.between(-1, 1); };
    for (std::size_t i = 0; i < bodies; ++i) {
      const bool fixed = i == 0;
      p.body(fixed ? Vector3d::Zero() : Vector3d(number(), number(), number()), fixed ? 0 : random.between(0.2, 5));
    }
    // Bodies in a convex heap: all normals have a part upwards, so there is a solution.
    for (std::size_t k = 0; k < 2 * bodies; ++k) {
      const auto b = static_cast<std::uint32_t>(1 + random.below(bodies - 1));
      const auto a = static_cast<std::uint32_t>(random.below(b));
      p.touch(a, b, Vector3d(number(), number(), random.between(0.5, 2)).normalized());
    }
    const std::vector<Vector3d> before = p.rates;
    if (!least_constraint(p.rates, p.touches)) FAIL("round " << round << " has a solution");
    std::vector<Vector3d> explained = before;
    double worst = 0;
    for (const Touch& touch : p.touches) {
      const double rate = parting_rate(p.rates, touch);
      worst = std::max({worst, -rate, -touch.push, touch.push * rate});  // feasible, pushing, complementary
      const double sum = touch.inverse_mass_a + touch.inverse_mass_b;
      explained[touch.a] -= touch.push * (touch.inverse_mass_a / sum) * touch.normal;
      explained[touch.b] += touch.push * (touch.inverse_mass_b / sum) * touch.normal;
      pushed += touch.push > 0;
    }
    for (std::size_t i = 0; i < bodies; ++i) worst = std::max(worst, (explained[i] - p.rates[i]).norm());  // stationary
    if (worst > 1e-9) FAIL("round " << round << ": off by " << worst);
  }
  CHECK(pushed > 1000);
}

}  // namespace
}  // namespace kds::collision::test_least_constraint
