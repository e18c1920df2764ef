// Impulses keep momentum and energy, and their rounding is not biased.
#include "collision/response/impulse.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstdint>
#include <limits>

namespace test_impulse {
namespace {

using Eigen::Vector3d;
using kds::collision::change_relative_velocity;
using kds::tests::Random;
using Long = long double;
using Vector3l = Eigen::Matrix<Long, 3, 1>;

Vector3d vector(Random& random) { return {random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)}; }

TEST_CASE("The excess of a unit vector is that of long doubles", "[impulse]") {
  Random random(1);
  Long worst = 0;
  for (int i = 0; i < 1000; ++i) {
    const Vector3d n = vector(random).normalized();
    const Long excess = n.cast<Long>().squaredNorm() - 1;
    worst = std::max(worst, std::abs(excess - kds::collision::excess_of_unit(n)));
  }
  CHECK(worst < 4 * std::numeric_limits<Long>::epsilon());
  CHECK(kds::collision::excess_of_unit(Vector3d(0, 0.6, 0.8)) != 0);  // 0.6 and 0.8 are rounded
  CHECK(kds::collision::excess_of_unit(Vector3d::UnitY()) == 0);
}

TEST_CASE("Equal balls exchange velocities, a fixed body keeps its own", "[impulse]") {
  Vector3d a(2, 1, 0), b(-1, 0, 3);
  change_relative_velocity(a, b, Vector3d::UnitX(), 6, 1, 1);
  CHECK(a == Vector3d(-1, 1, 0));
  CHECK(b == Vector3d(2, 0, 3));
  change_relative_velocity(a, b, Vector3d::UnitX(), 6, 0, 0.25);
  CHECK(a == Vector3d(-1, 1, 0));
  CHECK(b == Vector3d(8, 0, 3));
  change_relative_velocity(a, b, Vector3d::UnitX(), 1, 7, 0);
  CHECK(a == Vector3d(-2, 1, 0));
  CHECK(b == Vector3d(8, 0, 3));
}

struct Sums {
  Long energy = 0, energy_square = 0, worst_energy = 0, worst_momentum = 0;
};

/// Elastic impulses between random velocities: changes of energy over the energy, of momentum over the impulse.
template <class Normal>
Sums elastic_impulses(double mass_a, double mass_b, const Normal& normal) {
  Random random(3);
  Sums sums;
  for (int i = 0; i < 200'000; ++i) {
    const Vector3d n = normal(random);
    const Vector3d a = vector(random) / std::sqrt(mass_a), b = vector(random) / std::sqrt(mass_b);
    const double approach = n.dot(b - a);
    Vector3d after_a = a, after_b = b;
    change_relative_velocity(after_a, after_b, n, -2 * approach, 1 / mass_a, 1 / mass_b);
    const auto energy = [&](const Vector3d& va, const Vector3d& vb) {
      return (mass_a * va.cast<Long>().squaredNorm() + mass_b * vb.cast<Long>().squaredNorm()) / 2;
    };
    const Long error = (energy(after_a, after_b) - energy(a, b)) / energy(a, b);
    const Vector3l change_a = mass_a * (after_a.cast<Long>() - a.cast<Long>());
    const Vector3l change_b = mass_b * (after_b.cast<Long>() - b.cast<Long>());
    sums.energy += error;
    sums.energy_square += error * error;
    sums.worst_energy = std::max(sums.worst_energy, std::abs(error));
    const Long scale = mass_a * a.norm() + mass_b * b.norm();
    sums.worst_momentum = std::max(sums.worst_momentum, (change_a + change_b).norm() / scale);
  }
  return sums;
}

TEST_CASE("Rounding of elastic impulses neither gains nor loses energy in the mean", "[impulse]") {
  // Sums of unbiased errors stay within 5 standard errors; the biases that were here once made 23 to 40 of them.
  const auto any = [](Random& random) -> Vector3d { return vector(random).normalized(); };
  // As far from the origin: differences of coordinates are multiples of 2^-26.
  const auto coarse = [](Random& random) -> Vector3d {
    Vector3d apart = vector(random).normalized() * random.between(1, 2);
    for (int d = 0; d < 3; ++d) apart[d] = std::round(apart[d] * 0x1p26) * 0x1p-26;
    return apart.normalized();
  };
  for (const double mass : {1.0, 3.0, 1e3, 1e6}) {
    for (const Sums& sums : {elastic_impulses(mass, 1, any), elastic_impulses(1, mass, coarse)}) {
      INFO("mass ratio " << mass);
      CHECK(std::abs(sums.energy) < 5 * std::sqrt(sums.energy_square));
      // Each component of the change is rounded some 12 times, so energy by 24 + 2 roundings of 2^-53, for velocities
      // of which the relative one is the greatest part; see docs/accuracy.md.
      CHECK(sums.worst_energy < 32 * 0x1p-53);
      CHECK(sums.worst_momentum < 8 * 0x1p-53);
    }
  }
}

}  // namespace

}  // namespace test_impulse
