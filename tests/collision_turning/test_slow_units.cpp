// Scenes of bodies that turn in other units of time.
#include "collision/narrow_phase/turning/turning_contact.hpp"
#include "collision/world.hpp"
#include "tests/collision/sample_meshes.hpp"

#include <catch2/catch.hpp>

#include <cmath>
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
  bool all_numbers = true;  ///< the points and normals are

  void note(const PairEvent& event) {
    times.push_back(event.contact.time);
    all_numbers = all_numbers && event.contact.point.allFinite() && event.contact.normal.allFinite();
  }
  void contact(Turning&, const PairEvent& event) override { note(event); }
  void separation(Turning&, const PairEvent& event) override { note(event); }
  void overlap(Turning&, const PairEvent& event) override { note(event); }
};

RigidMotion<1> motion(const Vector3d& position, const Vector3d& velocity, const Vector3d& turning, double unit) {
  RigidMotion<1> result{{{position, velocity / unit}, 4 * unit}};
  result.angular_velocity = turning / unit;
  return result;
}

/// When a box and a body that it meets, which turn by some radians, touch and part: in units of time of 2^power s each.
std::vector<double> run(int power, const Shape& shape, double spin) {
  const double unit = std::ldexp(1.0, power);
  Log log;
  Turning world({.start_time = 4 * unit}, &log);
  world.add_body({.shape = shape, .motion = {motion({3, 0, 0}, {-1, 0, 0}, spin * Vector3d(0.25, 0.5, 1), unit)}});
  world.add_body({.shape = Box{Vector3d(0.5, 0.25, 0.75)},
                  .motion = {motion({0, 0.125, 3}, {0.25, 0, -1}, spin * Vector3d(0.125, -0.5, 1), unit)}});
  world.advance_to(10 * unit);
  for (double& time : log.times) time /= unit;
  return log.times;
}

}  // namespace

TEST_CASE("exact tests of bodies that turn look as many radians ahead in all units of time", "[turning]") {
  const auto ahead = [](double spin, double unit) {
    const auto turning = motion({0, 0, 0}, {1, 0, 0}, spin * Vector3d(0, 0, 1), unit);
    return time_to_look_ahead(turning, turning) / unit;
  };
  for (const int power : {-100, -30, 30, 80, 180}) CHECK(ahead(1, std::ldexp(1.0, power)) == ahead(1, 1));
  CHECK(ahead(0, 1) >= 0x1p200);
  CHECK(ahead(5e-324, 1) >= 0x1p200);
  CHECK(std::isfinite(ahead(5e-324, 1)));
}

TEST_CASE("the unit of time makes no difference to bodies that turn", "[turning]") {
  REQUIRE(time_to_look_ahead(RigidMotion<1>{}, RigidMotion<1>{}) >= 0x1p200);  // else what follows takes for ever
  for (const Shape& shape : {Shape(Box{Vector3d(1, 1, 1)}), Shape(Capsule{1, 0.5})}) {
    for (const double spin : {0.0, 1.0}) {
      INFO(kind_name(shape) << ", spin " << spin);
      const auto expected = run(0, shape, spin);
      REQUIRE(expected.size() == 2);
      for (const int power : {-100, -30, 30, 80, 180}) CHECK(run(power, shape, spin) == expected);
    }
  }
}

TEST_CASE("spins whose squares are no doubles turn nothing, and bodies that have them meet as if they had none",
          "[turning]") {
  const auto run = [](double spin) {
    const auto slow = [&](const Vector3d& position, const Vector3d& velocity, const Vector3d& axis) {
      RigidMotion<1> result{{{position, velocity}}};
      result.angular_velocity = spin * axis;
      result.orientation = {0.5, 0.25, 0.75, 0.125};
      return result;
    };
    Log log;
    Turning world({}, &log);
    world.add_body({.shape = Box{Vector3d(0.5, 1, 0.75)}, .motion = {slow({0, 0, 0}, {0, 0, 0}, {0.75, 0, 1})}});
    world.add_body({.shape = MeshShape{samples::cuboid(Vector3d(0.5, 0.25, 0.25))},
                    .motion = {slow({3, 0.125, 0}, {-1, 0, 0}, {1, 0.5, 0.25})}});
    world.add_body({.shape = Capsule{0.5, 0.5}, .motion = {slow({-3, 0.125, 0}, {1, 0, 0}, {0, 1, 0})}});
    world.add_body({.shape = MeshShape{samples::cuboid(Vector3d(0.25, 0.25, 0.25))},
                    .motion = {slow({0, 0.875, 0.25}, {0, 0, 0}, {0, 1, 1})}});
    world.add_body({.shape = HalfSpace{{0, 0, 1}, -1}, .motion = {RigidMotion<1>{}}, .fixed = true});
    world.advance_to(4);
    CHECK(log.all_numbers);
    return log.times;
  };
  const auto still = run(0);
  CHECK(still.size() == 7);
  for (const double spin : {1e-59, 1e-61, 1e-155, 1e-160, 5e-324}) {
    INFO("spin " << spin);
    const auto times = run(spin);
    REQUIRE(times.size() == still.size());
    for (std::size_t i = 0; i < times.size(); ++i) CHECK(times[i] == Approx(still[i]).epsilon(0).margin(1e-7));
    RigidMotion<1> turning;
    turning.angular_velocity = Vector3d(spin, spin, 0);
    CHECK(turning.rotation(1000).matrix().isIdentity(1e-15));
    CHECK(turning.rotation(1000).error() < 1e-13);
  }
}

}  // namespace test_slow_units
