// Motions of rigid bodies against their definition in 330 bits.
#include "certificates/turning/rigid_motion.hpp"
#include "kds/framework/moving_set.hpp"
#include "kds/pieces.hpp"
#include "tests/certificates/turning/true_turning.hpp"
#include "tests/certificates/turning/turning_scenes.hpp"

#include <catch2/catch.hpp>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace test_rigid_motion {
namespace {

using namespace kds;
using namespace kds::tests;
using certificates::BoundedVector;
using certificates::RigidMotion;
using Eigen::Quaterniond;
using Eigen::Vector3d;

static_assert(MovingElement<RigidMotion<1>> && Reversible<RigidMotion<2>>);

/// How much of its bound the vector is off.
double share(const BoundedVector& v, const RealVector& truth) {
  return static_cast<double>(length(real(v.vector) - truth) / Real(v.error));
}

RigidMotion<1> turning_wheel() {
  RigidMotion<1> wheel{{{Vector3d(1, 2, 3), Vector3d(1, 0, 0)}, 10}};
  wheel.angular_velocity = {0, 0, 2};
  return wheel;
}

}  // namespace

TEST_CASE("a body that turns has points, directions and velocities", "[rigid_motion]") {
  const RigidMotion<1> wheel = turning_wheel();
  CHECK(wheel.start() == 10);
  CHECK(wheel.position(Vector3d(1, 0, 0), 10).vector == Vector3d(2, 2, 3));
  const double quarter = 10 + 0.78539816339744831;  // an angle of pi / 2
  CHECK((wheel.direction(Vector3d(1, 0, 0), quarter).vector - Vector3d(0, 1, 0)).norm() < 1e-14);
  CHECK((wheel.velocity(Vector3d(1, 0, 0), quarter).vector - Vector3d(-1, 0, 0)).norm() < 1e-14);
  CHECK(wheel.velocity(Vector3d(0, 0, 5), 20).vector == Vector3d(1, 0, 0));  // on the axis
  RigidMotion<1> tilted = wheel;
  tilted.angular_velocity.setZero();
  tilted.orientation = Quaterniond(2, 2, 0, 0);  // about x by a right angle, of any length
  CHECK((tilted.direction(Vector3d(0, 1, 0), 99).vector - Vector3d(0, 0, 1)).norm() < 1e-15);
}

TEMPLATE_TEST_CASE_SIG("places and velocities of bodies that turn are within their bounds", "[rigid_motion]",
                       ((int Degree), Degree), 1, 2) {
  const std::uint64_t seed = 370;
  CAPTURE(Degree, seed);
  Random random(seed);
  double greatest = 0;
  int unknown = 0;
  for (int round = 0; round < 400; ++round) {
    const bool coarse = random.one_in(4);
    const auto scene = turning_scene<Degree>(random, coarse);
    const double t = scene.time + random.between(-1, 1);
    const Vector3d point = turning_vector(random, coarse);
    if (point.isZero(0)) continue;
    TrueMotion<Degree> truth(scene.a, t);
    truth.to(Real(0));
    const BoundedVector direction = scene.a.direction(point, t);
    if (!(direction.error < 1)) {
      unknown += scene.a.angular_velocity.norm() * std::abs(t - scene.a.start()) < greatest_angle;
      continue;
    }
    greatest =
        std::max({greatest, share(direction, truth.direction(real(point))), share(scene.a.origin(t), truth.origin()),
                  share(scene.a.position(point, t), truth.position(point)),
                  share(scene.a.velocity(point, t), truth.velocity(point))});
    if (!(direction.error <= 0x1p-45 * certificates::magnitude_sum(point))) ++unknown;
  }
  CAPTURE(greatest);
  CHECK(greatest < 1);
  CHECK(greatest > 0.03);  // the bounds are no idle ones
  CHECK(unknown == 0);
}

TEST_CASE("the columns of a rotation are where it turns the axes", "[rigid_motion]") {
  const std::uint64_t seed = 372;
  CAPTURE(seed);
  Random random(seed);
  for (int round = 0; round < 400; ++round) {
    auto motion = turning_scene<1>(random, random.one_in(4)).a;
    if (random.one_in(4)) motion.orientation = Quaterniond::Identity();
    if (random.one_in(4)) motion.angular_velocity.setZero();
    const certificates::Rotation turn = motion.rotation(motion.start() + random.between(-3, 3));
    const Eigen::Matrix3d columns = turn.matrix();
    for (int k = 0; k < 3; ++k) {
      const Vector3d axis = turn(Vector3d::Unit(k));
      for (int d = 0; d < 3; ++d) {
        CAPTURE(round, k, d);
        CHECK(std::bit_cast<std::uint64_t>(columns(d, k)) == std::bit_cast<std::uint64_t>(axis[d]));
      }
    }
  }
}

TEST_CASE("a motion that is restarted is the same up to the rounding of its numbers", "[rigid_motion]") {
  const std::uint64_t seed = 371;
  CAPTURE(seed);
  Random random(seed);
  double greatest = 0;
  for (int round = 0; round < 300; ++round) {
    const auto scene = turning_scene<2>(random, random.one_in(4));
    const double t = scene.time + random.between(-1, 1);
    const auto next = scene.a.restarted(t);
    CHECK(next.start() == t);
    CHECK(next.angular_velocity == scene.a.angular_velocity);
    TrueMotion<2> before(scene.a, t);
    TrueMotion<2> after(next, t);
    before.to(Real(0));
    after.to(Real(0));
    for (int d = 0; d < 3; ++d) {  // twice the error of the quaternion in the angle
      const RealVector axis = real(Vector3d::Unit(d));
      greatest = std::max(greatest, static_cast<double>(length(before.direction(axis) - after.direction(axis))));
    }
  }
  CAPTURE(greatest);
  CHECK(greatest < 0x1p-46);
  const RigidMotion<1> wheel = turning_wheel();
  CHECK(wheel.restarted(10) == wheel);
  RigidMotion<1> still = wheel;
  still.angular_velocity.setZero();
  still.orientation = Quaterniond(0.3, 0.1, -7, 11);
  CHECK(still.restarted(123).orientation.coeffs() == still.orientation.coeffs());
  RigidMotion<1> fast = wheel;  // more radians than greatest_angle
  fast.angular_velocity = {0, 0, 1e12};
  TrueMotion<1> truth(fast, 11);
  truth.to(Real(0));
  const Vector3d x = fast.restarted(11).direction(Vector3d(1, 0, 0), 11).vector;
  CHECK(length(real(x) - truth.direction(real(Vector3d(1, 0, 0)))) < Real(0x1p-46));
}

TEST_CASE("motions are compared, checked and turned round in time", "[rigid_motion]") {
  const RigidMotion<1> wheel = turning_wheel();
  CHECK(wheel == turning_wheel());
  const auto differs = [&](auto change) {
    RigidMotion<1> other = wheel;
    change(other);
    return !(other == wheel);
  };
  CHECK(differs([](auto& m) { m.path.start = 9; }));
  CHECK(differs([](auto& m) { m.orientation.z() = 0.1; }));
  CHECK(differs([](auto& m) { m.angular_velocity[1] = 1; }));
  CHECK(wheel.finite());
  for (const double bad : {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
    RigidMotion<1> m = wheel;
    m.path.coefficients[1][2] = bad;
    CHECK_FALSE(m.finite());
    m = wheel;
    m.angular_velocity[0] = bad;
    CHECK_FALSE(m.finite());
    m = wheel;
    m.orientation.x() = bad;
    CHECK_FALSE(m.finite());
  }
  RigidMotion<1> none = wheel;
  none.orientation.coeffs().setZero();
  CHECK_FALSE(none.finite());
  const RigidMotion<1> back = reversed(wheel);
  CHECK(reversed(back) == wheel);
  CHECK((back.position(Vector3d(1, 2, 3), -12).vector - wheel.position(Vector3d(1, 2, 3), 12).vector).norm() < 1e-14);
}

TEST_CASE("bodies that turn take up pieces of motion", "[rigid_motion]") {
  MovingSet<RigidMotion<1>> bodies;
  const Id id = bodies.add(turning_wheel(), 10);
  Pieces<RigidMotion<1>> pieces(bodies);
  RigidMotion<1> next = turning_wheel().restarted(11);
  next.angular_velocity = {1, 0, 0};
  pieces.plan(id, 11, next, 10);
  pieces.extend_horizon(10, never);
  CHECK(pieces.next_time() == 11);
  pieces.process();
  CHECK(bodies[id] == next);
}

}  // namespace test_rigid_motion
