// Static equilibrium with friction: cases whose answer is known, and forces made at random.
#include "collision/response/static_balance.hpp"
#include "collision/vectors.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstdint>
#include <vector>

namespace test_static_balance {
namespace {

using namespace kds::collision;
using Eigen::Vector3d;
using kds::tests::Random;

const Vector3d weight(0, 0, -10);

/// A body on fixed ground, at these points from its centre.
bool lies(const Vector3d& acceleration, const std::vector<Vector3d>& points, double friction,
          const Vector3d& normal = Vector3d::UnitZ()) {
  const std::vector<Load> loads{{.mass = 2, .size = 1, .acceleration = acceleration}};
  std::vector<Foothold> footholds;
  for (const Vector3d& point : points) {
    footholds.push_back(
        {.a = Foothold::fixed, .b = 0, .arm_a = {}, .arm_b = point, .normal = normal, .friction = friction});
  }
  return balanced(loads, footholds);
}

const std::vector<Vector3d> corners{{1, 1, -1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, -1}};

Vector3d direction(Random& random) {
  Vector3d v;
  do {
    for (int d = 0; d < 3; ++d) v[d] = random.between(-1, 1);
  } while (!(norm(v) > 0.1));
  return normalized(v);
}

}  // namespace

TEST_CASE("a body lies where its centre is above its support", "[balance]") {
  CHECK(lies(weight, corners, 0));
  CHECK(lies(weight, {{0, 0, -1}}, 0));
  CHECK_FALSE(lies(weight, {{0.01, 0, -1}}, 1));
  CHECK_FALSE(lies(weight, {}, 1));
  CHECK(lies(Vector3d::Zero(), {}, 0));
  for (const double edge : {0.5, 0.1, 0.01}) {
    CAPTURE(edge);
    CHECK(lies(weight, {{edge, 1, -1}, {edge, -1, -1}, {-1, 0, -1}}, 0.5));
    CHECK_FALSE(lies(weight, {{-edge, 1, -1}, {-edge, -1, -1}, {-1, 0, -1}}, 0.5));
  }
  CHECK_FALSE(lies(-weight, corners, 1));
}

TEST_CASE("a body lies on a slope that is less steep than friction allows", "[balance]") {
  const double friction = 0.5;
  for (const double slope : {0.0, 0.1, 0.4, 0.49, 0.51, 0.6, 2.0}) {
    CAPTURE(slope);
    // In all directions alike: cones are round.
    for (int k = 0; k < 8; ++k) {
      CAPTURE(k);
      const double angle = 0.3 + k;
      const Vector3d along(std::cos(angle), std::sin(angle), 0);
      CHECK(lies(weight + 10 * slope * along, corners, friction) == (slope < friction));
    }
  }
  // Across the edge that it would roll over.
  CHECK(lies(weight + Vector3d(9, 0, 0), corners, 2));
  CHECK_FALSE(lies(weight + Vector3d(11, 0, 0), corners, 2));
}

TEST_CASE("what slides is pulled in one direction alone, with all of the friction", "[balance]") {
  // A crate on ground that slides to +x below it, at a stop that pushes it to one side.
  const auto lies_at_stop = [](const Vector3d& pull, double friction, const Vector3d& pushes) {
    const std::vector<Load> loads{{.mass = 2, .size = 1, .acceleration = weight}};
    std::vector<Foothold> at;
    for (const Vector3d& point : corners) {
      at.push_back({.a = Foothold::fixed, .b = 0, .arm_a = {}, .arm_b = point, .normal = Vector3d::UnitZ()});
      at.back().friction = friction, at.back().pull = pull;
    }
    for (const double z : {-1.0, 1.0}) {
      at.push_back({.a = Foothold::fixed, .b = 0, .arm_a = {}, .arm_b = {-pushes[0], 0, z}, .normal = pushes});
    }
    return balanced(loads, at);
  };
  const Vector3d x = Vector3d::UnitX(), none = Vector3d::Zero();
  CHECK(lies_at_stop(none, 0.5, x));
  CHECK(lies_at_stop(x, 0.5, -x));
  CHECK_FALSE(lies_at_stop(x, 0.5, x));
  CHECK_FALSE(lies_at_stop(Vector3d::UnitY(), 0.5, x));
  CHECK_FALSE(lies_at_stop(-x, 0.5, -x));
  CHECK(lies_at_stop(-x, 0, x));
}

TEST_CASE("bodies hold each other", "[balance]") {
  const auto stack = [&](double offset, int high) {
    std::vector<Load> loads;
    std::vector<Foothold> footholds;
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(high); ++i) {
      loads.push_back({.mass = 1 + 0.5 * i, .size = 1, .acceleration = weight});
      const double from = i == 0 ? 0 : offset;  // each above the one before
      for (const Vector3d& corner : corners) {
        const Vector3d on_below(corner[0] > 0 ? 1 : -1 + from, corner[1], 1);
        const Vector3d on_this = on_below - Vector3d(from, 0, 2);
        footholds.push_back({.a = i == 0 ? Foothold::fixed : i - 1,
                             .b = i,
                             .arm_a = on_below,
                             .arm_b = on_this,
                             .normal = Vector3d::UnitZ(),
                             .friction = 0.5});
      }
    }
    return balanced(loads, footholds);
  };
  for (const int high : {1, 2, 5, 10}) {
    CAPTURE(high);
    CHECK(stack(0, high));
  }
  CHECK(stack(0.9, 2));
  CHECK_FALSE(stack(1.1, 2));
  // Of three equal steps that lean over by more than half of the lowest the two upper ones fall with it.
  CHECK(stack(0.5, 3));
  CHECK_FALSE(stack(0.9, 3));
}

TEST_CASE("loads that forces within cones make are held, whatever the footholds", "[balance]") {
  const std::uint64_t seed = 3;
  CAPTURE(seed);
  Random random(seed);
  int held = 0;
  for (int i = 0; i < 300; ++i) {
    CAPTURE(i);
    const std::uint32_t bodies = 1 + static_cast<std::uint32_t>(i % 4);
    std::vector<Load> loads(bodies);
    for (Load& load : loads) load = {random.between(0.5, 2), random.between(0.5, 2), Vector3d::Zero()};
    std::vector<Vector3d> turns(bodies, Vector3d::Zero());
    std::vector<Foothold> footholds;
    const auto add = [&](std::uint32_t a, std::uint32_t b, const Vector3d& force, const Foothold& at) {
      if (a != Foothold::fixed) loads[a].acceleration += force / loads[a].mass, turns[a] += cross(at.arm_a, force);
      loads[b].acceleration -= force / loads[b].mass, turns[b] -= cross(at.arm_b, force);
      footholds.push_back(at);
    };
    for (std::uint32_t b = 0; b < bodies; ++b) {
      for (int k = 0; k < 6; ++k) {
        const Vector3d arm = direction(random) * loads[b].size;
        Foothold at{.a = b == 0 || k == 0 ? Foothold::fixed : b - 1,
                    .b = b,
                    .arm_a = direction(random),
                    .arm_b = arm,
                    .normal = direction(random),
                    .friction = random.between(0.3, 1)};
        Vector3d across = cross(at.normal, direction(random));
        across *= random.between(0, 0.7) * at.friction / norm(across);
        add(at.a, b, random.between(0.2, 2) * (at.normal + across), at);
      }
      // Their torques, too, are to be balanced: by a couple of forces at two more footholds.
      for (std::size_t d = 0; d < 3; ++d) {
        const double torque = turns[b][static_cast<Eigen::Index>(d)];
        const Vector3d arm = Vector3d::Unit(static_cast<Eigen::Index>((d + 1) % 3));
        const Vector3d force = torque / 2 * Vector3d::Unit(static_cast<Eigen::Index>((d + 2) % 3));
        for (const double sign : {1.0, -1.0}) {
          const Vector3d normal = force[static_cast<Eigen::Index>((d + 2) % 3)] * sign > 0
                                      ? Vector3d(Vector3d::Unit(static_cast<Eigen::Index>((d + 2) % 3)))
                                      : Vector3d(-Vector3d::Unit(static_cast<Eigen::Index>((d + 2) % 3)));
          add(Foothold::fixed, b, sign * force,
              {.a = Foothold::fixed, .b = b, .arm_a = {}, .arm_b = sign * arm, .normal = normal, .friction = 0.3});
        }
      }
    }
    held += balanced(loads, footholds);
  }
  CHECK(held >= 295);  // `false` is allowed at the limits of friction.
}

TEST_CASE("what cannot be held is told of each body", "[balance]") {
  // One on four corners, one in the air.
  const std::vector<Load> loads{{.mass = 2, .size = 1, .acceleration = weight}, {.acceleration = weight}};
  std::vector<Foothold> footholds;
  for (const Vector3d& point : corners) {
    footholds.push_back(
        {.a = Foothold::fixed, .b = 0, .arm_a = {}, .arm_b = point, .normal = Vector3d::UnitZ(), .friction = 0.5});
  }
  std::vector<double> left;
  CHECK_FALSE(balanced(loads, footholds, &left));
  REQUIRE(left.size() == 2);
  CHECK(left[0] <= balance_rounding);
  CHECK(left[1] == 1);
}

TEST_CASE("impacts that support takes move nothing", "[balance]") {
  // A box on four corners, and another in the midst of its top; both of mass 2 and with a moment of 1.
  const auto run = [](const Vector3d& impulse, const Vector3d& arm, double friction) {
    std::vector<StruckBody> bodies(2, {.mobility = Mobility::of_spherical(0.5, 1), .size = 2, .still_speed = 0.02});
    bodies[1].velocity = {0.5 * impulse, cross(arm, impulse)};
    std::vector<Foothold> footholds;
    for (const Vector3d& point : corners) {
      footholds.push_back({Foothold::fixed, 0, {}, point, Vector3d::UnitZ(), friction});
      const Vector3d half = 0.5 * point;
      footholds.push_back({0, 1, {half[0], half[1], 1}, half, Vector3d::UnitZ(), friction});
    }
    const auto energy = [&] {
      double sum = 0;
      for (const StruckBody& body : bodies) {
        sum += squared_norm(body.velocity.velocity) + squared_norm(body.velocity.angular_velocity) / 2;
      }
      return sum;
    };
    const double before = energy();
    const bool taken = takes_impact(bodies, footholds);
    CHECK(energy() <= before);
    if (!taken) CHECK_FALSE((bodies[0].still() && bodies[1].still()));
    return taken;
  };
  CHECK(run({0, 0, -100}, {0, 0, 0.5}, 0));
  CHECK(run({0, 0, -100}, {0.25, 0.25, 0.5}, 0));
  CHECK_FALSE(run({0, 0, -100}, {1, 0, 0.5}, 0.5));  // beyond the edge: it tips
  CHECK_FALSE(run({0, 0, 1}, {0, 0, -0.5}, 0.5));    // and is lifted
  CHECK_FALSE(run({1, 0, 0}, {0, 0, -0.5}, 0.5));    // or slides, for nothing presses it down
  CHECK(run({0.02, 0, 0}, {0, 0, 0}, 0));            // at 1 cm/s, which counts as nothing
  CHECK(run({10, 0, -100}, {0, 0, -0.5}, 0.5));
  CHECK_FALSE(run({10, 0, -100}, {0, 0, -0.5}, 0));
}

}  // namespace test_static_balance
