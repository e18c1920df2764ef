// Euler's free rotation, against an integrator in long double, closed forms and conservation laws.
#include "collision/response/free_rotation.hpp"

#include "kds/arithmetic/lattice.hpp"
#include "tests/collision/response/random_rotation.hpp"
#include "tests/support/random_numbers.hpp"
#include "tests/support/random_vectors.hpp"

#include <catch2/catch.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace test_free_rotation {
namespace {

using namespace kds::collision;
using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using kds::collision::tests::random_rotation;
using kds::tests::Random;
using kds::tests::random_vector;
using Long3 = Eigen::Matrix<long double, 3, 1>;
using LongQuaternion = Eigen::Quaternion<long double>;

PrincipalInertia diagonal(const Vector3d& moments) { return principal_inertia(moments.asDiagonal()); }

RotationState turning(const PrincipalInertia& inertia, const Quaterniond& orientation, const Vector3d& velocity) {
  return {angular_momentum(inertia, orientation, velocity), orientation, 0};
}

double energy(const PrincipalInertia& inertia, const RotationState& state) {
  return 0.5 * state.momentum.dot(angular_velocity(inertia, state));
}

RotationState at(const PrincipalInertia& inertia, const RotationState& state, double t) {
  return {state.momentum, orientation_at(inertia, state, t), t};
}

/// The classical method of order 4, of the quaternion alone: q' = q w / 2, where w is the angular velocity in the body
/// that follows from the angular momentum in the world.
LongQuaternion by_small_steps(const PrincipalInertia& inertia, const RotationState& state, double t, int steps) {
  const Long3 momentum = state.momentum.cast<long double>();
  const Long3 moments = inertia.moments.cast<long double>();
  using Vector = Eigen::Matrix<long double, 4, 1>;
  const auto rate = [&](const Vector& x) -> Vector {
    const LongQuaternion q(x);
    const Long3 w = (q.normalized().inverse() * momentum).cwiseQuotient(moments);
    return 0.5L * (q * LongQuaternion(0, w[0], w[1], w[2])).coeffs();
  };
  Vector x = state.orientation.coeffs().cast<long double>();
  const long double h = static_cast<long double>(t) / steps;
  for (int i = 0; i < steps; ++i) {
    const Vector a = rate(x), b = rate(x + h / 2 * a), c = rate(x + h / 2 * b), d = rate(x + h * c);
    x += h / 6 * (a + 2 * b + 2 * c + d);
  }
  return LongQuaternion(x).normalized();
}

double angle_between(const Quaterniond& a, const LongQuaternion& b) {
  return static_cast<double>(a.cast<long double>().normalized().angularDistance(b));
}

/// Moments of three kinds of bodies: any, plates, rods.
Vector3d random_moments(Random& random, std::uint64_t seed) {
  Vector3d moments(random.between(0.1, 1), random.between(0.1, 1), 0);
  moments[2] = random.between(std::abs(moments[0] - moments[1]), moments[0] + moments[1]);
  if (seed % 4 == 1) moments[2] = moments[0] + moments[1];
  if (seed % 4 == 2) moments = Vector3d(0.02, 1, random.between(0.99, 1.01));
  if (seed % 4 == 3) moments[1] = moments[0] * (1 + 1e-9);
  return moments;
}

}  // namespace

TEST_CASE("free rotation: as an integrator in long double finds it") {
  constexpr double tolerance = 1e-14;  // rad; some roundings, and what the integrator errs by
  for (std::uint64_t seed = 0; seed < 24; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    const PrincipalInertia inertia = diagonal(random_moments(random, seed));
    const RotationState state = turning(inertia, random_rotation(random), 2 * random_vector(random));
    const double t = random.between(0, seed % 4 == 2 ? 0.2 : 3);  // rods turn fast about their long axis
    CHECK(angle_between(orientation_at(inertia, state, t), by_small_steps(inertia, state, t, 12000)) < tolerance);
  }
}

TEST_CASE("free rotation: tops in closed form are what the series gives") {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    const int axis = static_cast<int>(seed % 3);
    Vector3d moments = Vector3d::Constant(random.between(0.5, 1));
    moments[axis] = random.between(0.01, 2) * moments[(axis + 1) % 3];
    const PrincipalInertia top = diagonal(moments);
    REQUIRE(top.symmetry == axis);
    PrincipalInertia other = top;
    other.symmetry = -1;  // so that the series is used
    const RotationState state = turning(top, random_rotation(random), 2 * random_vector(random));
    const double t = random.between(0, 3);
    const Quaterniond closed = orientation_at(top, state, t);
    CHECK(closed.angularDistance(orientation_at(other, state, t)) < 1e-13);
  }
}

TEST_CASE("free rotation: a top keeps its energy and its cone, however long it turns") {
  const PrincipalInertia top = diagonal(Vector3d(1, 1, 2));
  const RotationState state = turning(top, Quaterniond(0.6, 0, 0.8, 0), Vector3d(0.3, -0.5, 2));
  const double before = energy(top, state);
  const double height = state.momentum.dot(state.orientation * Vector3d::UnitZ());
  for (const double t : {1e-3, 1.0, 1e3, 1e6, 1e9, 1e12}) {
    CAPTURE(t);
    const RotationState then = at(top, state, t);
    CHECK(std::abs(energy(top, then) - before) < 4e-15 * before);
    CHECK(std::abs(then.momentum.dot(then.orientation.normalized() * Vector3d::UnitZ()) - height) < 4e-15);
  }
}

TEST_CASE("free rotation: a body that turns about its intermediate axis flips over, and back") {
  const PrincipalInertia inertia = diagonal(Vector3d(1, 2, 3));
  const RotationState start = turning(inertia, Quaterniond::Identity(), Vector3d(1e-6, 1, 0));
  const double before = energy(inertia, start);
  int flips = 0;
  bool upright = true;
  RotationState state = start;
  for (int i = 1; i <= 4000; ++i) {
    state.orientation = orientation_at(inertia, state, 0.05 * i);
    state.time = 0.05 * i;
    const double along = (state.orientation.normalized().inverse() * state.momentum)[1] / state.momentum.norm();
    if (upright ? along < -0.99 : along > 0.99) upright = !upright, ++flips;
    REQUIRE(std::abs(energy(inertia, state) - before) < 1e-13 * before);
  }
  // A quarter of its period is K(k) / rate, where the complement of the modulus is about the disturbance: from
  // K = ln(4 / k'), and rate = w sqrt((I2 - I1) (I3 - I2) / (I1 I3)) = 0.577, half a period is 2 (14 ... 15) / 0.577.
  CHECK(flips == 4);
}

TEST_CASE("free rotation: units of time and mass change no bit") {
  Random random(5);
  const Vector3d moments(0.7, 0.9, 1.1);
  const Quaterniond orientation = random_rotation(random);
  const Vector3d velocity(0.4, -0.3, 0.8);
  const auto turned = [&](int of_mass, int of_time) {
    const PrincipalInertia inertia = diagonal(std::ldexp(1.0, of_mass) * moments);
    const RotationState state = turning(inertia, orientation, std::ldexp(1.0, -of_time) * velocity);
    return orientation_at(inertia, state, std::ldexp(0.8125, of_time));
  };
  const Quaterniond expected = turned(0, 0);
  for (const int of_mass : {-600, -3, 600}) {
    for (const int of_time : {-190, -1, 7, 190}) {
      CAPTURE(of_mass, of_time);
      CHECK(turned(of_mass, of_time).coeffs() == expected.coeffs());
    }
  }
}

TEST_CASE("free rotation: about a principal axis, or not at all, nothing changes for good") {
  for (const Vector3d& moments :
       {Vector3d(1, 2, 3), Vector3d(1, 1, 2), Vector3d(1e-6, 1, 1), Vector3d(2, 1, 1 + 1e-12)}) {
    const PrincipalInertia inertia = diagonal(moments);
    for (const Vector3d& velocity :
         {Vector3d(0, 0, 0), Vector3d(3, 0, 0), Vector3d(0, -2, 0), Vector3d(0, 0, 1e-300), Vector3d(0, 0, 1e60)}) {
      const RotationState state = turning(inertia, Quaterniond::Identity(), velocity);
      const FreeRotation rotation(inertia, state);
      CHECK(rotation.steady());
      CHECK(rotation.valid_until() == kds::never);
      CHECK(angular_velocity(inertia, state) == velocity);
    }
  }
  const PrincipalInertia nearly = diagonal(Vector3d(1, 1, 1 + 1e-12));
  CHECK_FALSE(FreeRotation(nearly, turning(nearly, Quaterniond::Identity(), Vector3d(1, 1, 1))).steady());
}

TEST_CASE("free rotation: velocities and impulses are made with the same inverse moments") {
  const std::uint64_t seed = 11;
  CAPTURE(seed);
  Random random(seed);
  const Quaterniond upright = Quaterniond::Identity();
  int unlike = 0;
  for (int round = 0; round < 1000; ++round) {
    const PrincipalInertia inertia = diagonal({random.between(0.5, 1), random.between(0.5, 1), random.between(0.5, 1)});
    const RotationState state{random_vector(random), upright, 0};
    unlike +=
        angular_velocity(inertia, state) != inverse_inertia(inertia, upright).diagonal().cwiseProduct(state.momentum);
  }
  CHECK(unlike == 0);
}

TEST_CASE("free rotation: extreme bodies keep their energy") {
  for (const Vector3d& moments :
       {Vector3d(1, 1, 1 + 1e-12), Vector3d(1, 1, 2), Vector3d(1, 1 + 1e-9, 2), Vector3d(1e-6, 1, 1),
        Vector3d(1e-6, 1, 1 + 5e-7), Vector3d(0.3, 0.7, 1), Vector3d(0.4, 0.6, 1)}) {
    CAPTURE(moments);
    const PrincipalInertia inertia = diagonal(moments);
    RotationState state = turning(inertia, Quaterniond(0.5, 0.5, -0.5, 0.5), Vector3d(0.3, -0.8, 0.52));
    const double before = energy(inertia, state);
    for (int i = 0; i < 1000; ++i) {
      state.orientation = orientation_at(inertia, state, state.time + 0.1);
      state.time += 0.1;
    }
    // 1000 steps, or as many as the series makes of them, of some 2^-52 each, at random.
    CHECK(std::abs(energy(inertia, state) - before) < 1e-13 * before);
    CHECK(std::abs(state.orientation.norm() - 1) < 1e-13);
  }
}

}  // namespace test_free_rotation
