// Scenes of bodies that turn in other units of time.
#include "collision/world.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstdint>
#include <tuple>
#include <vector>

namespace test_slow_units {
namespace {

using namespace kds;
using namespace kds::collision;
using certificates::RigidMotion;
using Eigen::Vector3d;
using Turning = TurningWorld<1>;

struct Log : Turning::Listener {
  std::vector<double> times;

  void contact(Turning&, const PairEvent& event) override { times.push_back(event.contact.time); }
  void separation(Turning&, const PairEvent& event) override { times.push_back(event.contact.time); }
};

/// What happens to a box and a body that it meets, which turn by some radians, where a second is 2^seconds units of
/// time: the times in seconds, and how many tests of the pair it takes.
std::tuple<std::vector<double>, std::uint64_t> run(int seconds, const Shape& shape, double spin) {
  const double unit = std::ldexp(1.0, seconds);
  const auto motion = [&](const Vector3d& position, const Vector3d& velocity, const Vector3d& turning) {
    RigidMotion<1> result{{{position, velocity / unit}, 4 * unit}};
    result.angular_velocity = spin / unit * turning;
    return result;
  };
  Log log;
  Turning world({.start_time = 4 * unit}, &log);
  world.add_body({.shape = shape, .motion = {motion({3, 0, 0}, {-1, 0, 0}, {0.25, 0.5, 1})}});
  world.add_body(
      {.shape = Box{Vector3d(0.5, 0.25, 0.75)}, .motion = {motion({0, 0.125, 3}, {0.25, 0, -1}, {0.125, -0.5, 1})}});
  world.advance_to(10 * unit);
  for (double& time : log.times) time /= unit;
  return {log.times, world.counters().pair_tests};
}

}  // namespace

TEST_CASE("the unit of time makes no difference to bodies that turn, and costs nothing", "[turning]") {
  for (const Shape& shape : {Shape(Box{Vector3d(1, 1, 1)}), Shape(Capsule{1, 0.5})}) {
    for (const double spin : {0.0, 1.0}) {
      INFO(kind_name(shape) << ", spin " << spin);
      const auto expected = run(0, shape, spin);
      REQUIRE(std::get<0>(expected).size() == 2);
      // At 2^80 a million seconds are less than the spacing of the clock; 2^30 is slow only if looks are bounded.
      for (const int seconds : {-100, -30, 30, 35, 80, 180}) CHECK(run(seconds, shape, spin) == expected);
    }
  }
}

}  // namespace test_slow_units
