// The couple of rolling friction: how it brakes, and that it gives no energy.
#include "collision/response/turning_impulse.hpp"
#include "tests/support/random_numbers.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <catch2/catch.hpp>

#include <cstdint>

namespace test_rolling_friction {

using namespace kds::collision;
using Eigen::Vector3d;

TEST_CASE("rolling friction brakes how two bodies turn against each other, and never gives energy", "[impulse]") {
  const std::uint64_t seed = 5;
  kds::tests::Random random(seed);
  const auto vector = [&](double size) {
    Vector3d v;
    for (int d = 0; d < 3; ++d) v[d] = random.between(-size, size);
    return v;
  };
  int braked = 0, stopped = 0;
  for (int k = 0; k < 2000; ++k) {
    const auto mobility = [&] {
      if (random.one_in(3)) return Mobility::of_spherical(random.between(0.5, 2), random.between(0.5, 4));
      const Eigen::Matrix3d m = Eigen::Matrix3d(vector(1).asDiagonal()) + vector(1) * vector(1).transpose();
      return Mobility::of(random.between(0.5, 2), m * m.transpose() + 0.1 * Eigen::Matrix3d::Identity());
    };
    const Mobility of_a = random.one_in(4) ? Mobility::fixed() : mobility(), of_b = mobility();
    RigidVelocity a{vector(1), vector(3)}, b{vector(1), vector(3)};
    if (of_a.inverse_mass == 0) a = {};
    const ContactArms arms{vector(1).normalized(), vector(1), vector(1)};
    const auto energy = [&] {
      const auto turning = [](const Mobility& body, const Vector3d& spin) {
        if (body.inverse_mass == 0) return 0.0;
        if (body.spherical) return spin.squaredNorm() / body.inverse_moment;
        return spin.dot(body.inverse_inertia.inverse() * spin);
      };
      return turning(of_a, a.angular_velocity) + turning(of_b, b.angular_velocity);
    };
    const double before = energy();
    const Vector3d relative = b.angular_velocity - a.angular_velocity;
    const double most = random.between(0, 2);
    const Vector3d couple = brake_turning(a, b, of_a, of_b, arms, most);
    CHECK(couple.norm() <= most * (1 + 1e-12));
    CHECK(energy() <= before * (1 + 1e-12));
    if (couple.isZero(0)) continue;
    ++braked;
    CHECK(couple.dot(relative) < 0);
    CHECK((b.angular_velocity - a.angular_velocity).dot(relative) > -1e-12);
    stopped += couple.norm() < most * (1 - 1e-9);
    const Vector3d apart =
        b.velocity + b.angular_velocity.cross(arms.b) - a.velocity - a.angular_velocity.cross(arms.a);
    CHECK(apart.dot(arms.normal) < 0);
  }
  CHECK(braked > 500);
  CHECK(stopped > 50);
  RigidVelocity still, ball{{1, 0, 0}, {0, 2, 0}};
  const ContactArms below{Vector3d::UnitZ(), {0, 0, 0}, {0, 0, -0.5}};
  CHECK(push_for(3, Mobility::fixed(), Mobility::of_spherical(0.5, 1), below) == 6);
  CHECK(brake_turning(still, ball, Mobility::fixed(), Mobility::of_spherical(1, 1), below, 0).isZero(0));
}

}  // namespace test_rolling_friction
