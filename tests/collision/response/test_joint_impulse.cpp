// Impulses at several places at once: cases whose answer is known, and bodies at random.
#include "collision/response/joint_impulse.hpp"
#include "collision/vectors.hpp"
#include "tests/support/random_numbers.hpp"
#include "tests/support/random_vectors.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace test_joint_impulse {
namespace {

using namespace kds::collision;
using Eigen::Vector3d;
using kds::tests::Random;
using kds::tests::random_vector;

JointBody moving(double mass, double moment, const Vector3d& velocity, const Vector3d& spin = Vector3d::Zero()) {
  return {.mobility = Mobility::of_spherical(1 / mass, 1 / moment), .velocity = {velocity, spin}};
}

double parting(const std::vector<JointBody>& bodies, const JointPlace& at) {
  const auto& a = bodies[at.a].velocity;
  const auto& b = bodies[at.b].velocity;
  return dot(at.normal,
             b.velocity + cross(b.angular_velocity, at.arm_b) - a.velocity - cross(a.angular_velocity, at.arm_a));
}

}  // namespace

TEST_CASE("a body between two that close in goes on with both", "[joint_impulse]") {
  const Vector3d x = Vector3d::UnitX();
  std::vector<JointBody> bodies{moving(4, 1, x), moving(1, 1, Vector3d::Zero()), moving(4, 1, -x)};
  std::vector<JointPlace> places{{.a = 0, .b = 1, .normal = x, .arm_a = x, .arm_b = -x, .least = 0x1p-10},
                                 {.a = 1, .b = 2, .normal = x, .arm_a = x, .arm_b = -x, .least = 0x1p-10}};
  REQUIRE(part_jointly(bodies, places));
  for (const JointPlace& at : places) CHECK(std::abs(parting(bodies, at) - 0x1p-10) <= 0x1p-13);
  CHECK(std::abs(bodies[1].velocity.velocity[0]) < 0x1p-10);
  CHECK(std::abs(4 * bodies[0].velocity.velocity[0] + bodies[1].velocity.velocity[0] +
                 4 * bodies[2].velocity.velocity[0]) < 1e-14);
  CHECK(bodies[1].velocity.angular_velocity.isZero(0));
}

TEST_CASE("light bodies between a floor and a heavy body are parted from both", "[joint_impulse]") {
  const Vector3d z = Vector3d::UnitZ();
  constexpr double least = 0x1p-8;
  for (const double mass : {1e2, 1e3, 1e6}) {
    CAPTURE(mass);
    std::vector<JointBody> bodies{{.mobility = Mobility::fixed()}};
    std::vector<JointPlace> places;
    double momentum = 0;
    for (std::uint32_t i = 1; i <= 5; ++i) {
      const double own = i == 5 ? mass : 1, speed = i == 5 ? 4 * least : 0;
      bodies.push_back(moving(own, own, -speed * z));
      momentum -= own * speed;
      for (const double x : {-0.5, 0.5}) {
        places.push_back({.a = i - 1,
                          .b = i,
                          .normal = z,
                          .arm_a = Vector3d(x, 0, 0.5),
                          .arm_b = Vector3d(x, 0, -0.5),
                          .least = least});
      }
    }
    REQUIRE(part_jointly(bodies, places));
    double pushed = 0;
    for (const JointPlace& at : places) {
      CHECK(std::abs(parting(bodies, at) - least) <= least / 8);
      CHECK(at.push >= 0);
      if (at.a == 0) pushed += at.push;
    }
    double after = 0;
    for (std::uint32_t i = 1; i <= 5; ++i) after += (i == 5 ? mass : 1) * bodies[i].velocity.velocity[2];
    CHECK(std::abs(after - momentum - pushed) < 1e-9 * mass * least);
  }
}

TEST_CASE("what two fixed bodies close in on cannot be parted from both", "[joint_impulse]") {
  const Vector3d x = Vector3d::UnitX();
  std::vector<JointBody> bodies{{.mobility = Mobility::fixed(), .velocity = {x, Vector3d::Zero()}},
                                moving(1, 1, Vector3d::Zero()),
                                {.mobility = Mobility::fixed(), .velocity = {-x, Vector3d::Zero()}}};
  std::vector<JointPlace> places{{.a = 0, .b = 1, .normal = x, .arm_a = x, .arm_b = -x, .least = 0},
                                 {.a = 1, .b = 2, .normal = x, .arm_a = x, .arm_b = -x, .least = 0}};
  CHECK_FALSE(part_jointly(bodies, places));
  CHECK(bodies[1].velocity.velocity.isZero(0));
}

TEST_CASE("joint impulses push, keep momenta, and take no more energy than parting needs", "[joint_impulse]") {
  constexpr double least = 0x1p-8;
  int parted = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    // A row of bodies, each of which touches the next at a point near the line of the centres.
    std::vector<JointBody> bodies;
    std::vector<JointPlace> places;
    std::vector<double> masses;
    std::vector<Vector3d> centres;
    for (std::uint32_t i = 0; i < 5; ++i) {
      masses.push_back(random.between(0.25, 4));
      centres.emplace_back(2.0 * i, 0, 0);
      bodies.push_back(moving(masses[i], 0.5 * masses[i], random_vector(random, 1), random_vector(random, 1)));
      if (i == 0) continue;
      const Vector3d point = Vector3d(2.0 * i - 1, 0, 0) + random_vector(random, 0.25);
      places.push_back({.a = i - 1,
                        .b = i,
                        .normal = normalized(Vector3d::UnitX() + random_vector(random, 0.25)),
                        .arm_a = point - centres[i - 1],
                        .arm_b = point - centres[i],
                        .least = least});
    }
    struct Sums {
      double energy = 0;
      Vector3d momentum = Vector3d::Zero(), turning = Vector3d::Zero();
    };
    const auto sums = [&] {
      Sums sum;
      for (std::size_t i = 0; i < bodies.size(); ++i) {
        const Vector3d push = masses[i] * bodies[i].velocity.velocity;
        const Vector3d spin = 0.5 * masses[i] * bodies[i].velocity.angular_velocity;
        sum.momentum += push;
        sum.turning += cross(centres[i], push) + spin;
        sum.energy += 0.5 * (dot(push, bodies[i].velocity.velocity) + dot(spin, bodies[i].velocity.angular_velocity));
      }
      return sum;
    };
    const Sums before = sums();
    if (!part_jointly(bodies, places)) continue;
    ++parted;
    const Sums after = sums();
    double needed = 0;
    for (const JointPlace& at : places) {
      CHECK(at.push >= 0);
      CHECK(parting(bodies, at) >= (1 - 0x1p-3) * least);
      if (at.push > 0) CHECK(parting(bodies, at) <= (1 + 0x1p-3) * least);
      needed += at.push * (1 + 0x1p-3) * least;
    }
    CHECK((after.momentum - before.momentum).norm() < 1e-13);
    CHECK((after.turning - before.turning).norm() < 1e-12);
    CHECK(after.energy <= before.energy + needed);
  }
  CHECK(parted == 200);
}

}  // namespace test_joint_impulse
