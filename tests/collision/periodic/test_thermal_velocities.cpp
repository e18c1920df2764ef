// Random velocities: their moments, and walls that give a gas their temperature.
#include "collision/periodic/periodic_world.hpp"
#include "collision/periodic/thermal_velocities.hpp"
#include "tests/collision/periodic/periodic_scenes.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstddef>
#include <numbers>

namespace test_thermal_velocities {

using namespace periodic_scenes;
using Eigen::Vector3d;

constexpr std::size_t samples = 200'000;

/// Five standard errors of the mean of samples whose variance is given.
double margin(double variance) { return 5 * std::sqrt(variance / double(samples)); }

TEST_CASE("thermal velocities: the moments of exponential numbers") {
  const auto seed = GENERATE(1u, 2u);
  CAPTURE(seed);
  ThermalVelocities random(seed);
  double mean = 0, square = 0, beyond_3 = 0;
  for (std::size_t i = 0; i < samples; ++i) {
    const double x = random.exponential();
    mean += x / double(samples), square += x * x / double(samples), beyond_3 += (x > 3) / double(samples);
  }
  CHECK(mean == Approx(1).margin(margin(1)));
  CHECK(square == Approx(2).margin(margin(20)));  // the fourth moment is 24
  CHECK(beyond_3 == Approx(std::exp(-3)).margin(margin(std::exp(-3))));
}

TEST_CASE("thermal velocities: Maxwell's distribution inside, and its flux through a plane") {
  const auto seed = GENERATE(1u, 2u);
  CAPTURE(seed);
  ThermalVelocities random(seed);
  constexpr double variance = 2.25;
  Vector3d mean = Vector3d::Zero(), square = Vector3d::Zero(), fourth = Vector3d::Zero();
  double normal = 0, normal_square = 0, along = 0;
  for (std::size_t i = 0; i < samples; ++i) {
    const Vector3d v = random.inside(variance) / 1.5;
    mean += v / double(samples);
    square += v.cwiseAbs2() / double(samples);
    fourth += v.cwiseAbs2().cwiseAbs2() / double(samples);
    const Vector3d w = random.through_plane(1, -1, variance) / 1.5;
    REQUIRE(w[1] < 0);
    normal -= w[1] / double(samples), normal_square += w[1] * w[1] / double(samples);
    along += (w[0] * w[0] + w[2] * w[2]) / double(samples);
  }
  for (int d = 0; d < 3; ++d) {
    CHECK(mean[d] == Approx(0).margin(margin(1)));
    CHECK(square[d] == Approx(1).margin(margin(2)));
    CHECK(fourth[d] == Approx(3).margin(margin(96)));
  }
  CHECK(normal == Approx(std::sqrt(std::numbers::pi / 2)).margin(margin(0.43)));
  CHECK(normal_square == Approx(2).margin(margin(4)));
  CHECK(along == Approx(2).margin(margin(4)));
}

/// Any change of these numbers changes the runs of callers. The first is the published value of SplitMix64 for this
/// seed, the others are those of an implementation in another language.
TEST_CASE("thermal velocities: the same bits everywhere") {
  CHECK(ThermalVelocities(1234567).uniform() == double(6457827717110365317u >> 11) * 0x1p-53);
  const Vector3d v = ThermalVelocities(1234567).inside(2.25);
  CHECK(v[0] == -0x1.0e6e06cff36e2p+0);
  CHECK(v[1] == -0x1.26580cf44deacp+1);
  CHECK(v[2] == -0x1.7ff9f5339aae6p+1);
}

TEST_CASE("periodic world: thermostat walls give a gas their temperature") {
  const auto seed = GENERATE(1u, 2u);
  CAPTURE(seed);
  PeriodicOptions options;
  options.max = {4, 4, 4};
  options.boundaries[0] = Boundary::walls;
  options.wall_temperatures = {2.5, 2.5, 0, 0, 0, 0};
  options.seed = seed;
  Log<1> log;
  PeriodicWorld<1> world(options, &log);
  const auto balls = random_balls<1>(30, options, seed);  // of temperature 1
  for (const auto& ball : balls) world.add_body(ball);
  double sum = 0;
  std::size_t times = 0;
  for (double t = 1; t <= 200; ++t) {
    world.advance_to(t);
    if (t <= 20) continue;
    double energy = 0;
    for (BodyId id = 0; id < 30; ++id) energy += balls[id].mass * world.velocity(id).squaredNorm() / 2;
    sum += energy / (1.5 * 30);
    ++times;
  }
  world.audit();
  CHECK(log.walls > 1000);
  // The temperature of 30 balls fluctuates by sqrt(2 / 90), 15 %; there are some hundred independent times.
  CHECK(sum / double(times) == Approx(2.5).epsilon(0.06));
}

}  // namespace test_thermal_velocities
