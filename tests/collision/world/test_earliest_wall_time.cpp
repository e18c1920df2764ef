// Lower bounds on the times at which balls leave through walls.
#include "certificates/wall_separation.hpp"
#include "collision/world/earliest_wall_time.hpp"
#include "kds/roots/failure_time.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdint>

namespace kds::collision::test_earliest_wall_time {
namespace {

using Motion = certificates::PointMotion<1>;

/// Exactly, over all walls that it approaches.
double first_leaving(const Motion& motion, double radius, const Walls& walls, double now) {
  double first = never;
  for (int axis = 0; axis < 3; ++axis) {
    const double speed = motion.coefficients[1][axis];
    if (speed == 0) continue;
    const double out = speed > 0 ? 1 : -1;
    const double plane = speed > 0 ? walls.max[axis] : walls.min[axis];
    first = std::min(first, failure_time(certificates::WallSeparation<1>{motion.axis(axis), plane, radius, out}, now));
  }
  return first;
}

TEST_CASE("No ball leaves through a wall before the earliest time told", "[walls]") {
  constexpr std::uint64_t seed = 1;
  tests::Random random(seed);
  int late = 0;
  int different = 0;
  int never_told = 0;
  Motion previous{{Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones()}, 0};
  for (int i = 0; i < 20'000; ++i) {
    const bool coarse = i % 2 != 0;
    const auto number = [&] { return coarse ? random.coarse() : random.scaled(-30, 10); };
    Motion motion;
    for (int d = 0; d < 3; ++d) {
      motion.coefficients[0][d] = number();
      motion.coefficients[1][d] = random.one_in(3) ? 0 : number();
    }
    motion.start = number();
    const Walls walls{Eigen::Vector3d::Constant(-16), Eigen::Vector3d(16, 17, random.between(15, 18))};
    const double radius = std::abs(number());
    const double now = motion.start + std::abs(number());
    const double told = earliest_wall_time_of_all(motion, radius, walls, now);
    double least = never;
    for (int wall = 0; wall < 6; ++wall) {
      least = std::min(least, earliest_wall_time(motion, radius, walls, wall, now));
    }
    different += told != least;
    const auto [as_first, before] = earliest_wall_times_of_all({&motion, &previous}, Two{radius, 1}, walls, now);
    const auto [after, as_second] = earliest_wall_times_of_all({&previous, &motion}, Two{1, radius}, walls, now);
    different += as_first != told || as_second != told || before != after;
    previous = motion;
    never_told += told == never;
    late += told > first_leaving(motion, radius, walls, now);
  }
  INFO("seed " << seed);
  CHECK(different == 0);
  CHECK(late == 0);
  CHECK(never_told > 100);
}

TEST_CASE("No ball on a parabola leaves through a wall before the earliest time told", "[walls]") {
  constexpr std::uint64_t seed = 2;
  tests::Random random(seed);
  int late = 0;
  int told = 0;
  int near = 0;
  for (int i = 0; i < 20'000; ++i) {
    const bool coarse = i % 2 != 0;
    const auto number = [&] { return coarse ? random.coarse() : random.scaled(-20, 4); };
    certificates::PointMotion<2> motion;
    for (auto& coefficient : motion.coefficients) {
      for (int d = 0; d < 3; ++d) coefficient[d] = random.one_in(3) ? 0 : number();
    }
    motion.start = number();
    const Walls walls{Eigen::Vector3d::Constant(-16), Eigen::Vector3d(16, 17, random.between(15, 18))};
    const double radius = std::abs(number());
    const double now = motion.start + std::abs(number());
    for (int wall = 0; wall < 6; ++wall) {
      const int axis = wall / 2;
      const double out = wall % 2 != 0 ? 1 : -1;
      const double plane = out > 0 ? walls.max[axis] : walls.min[axis];
      const double earliest = earliest_wall_time(motion, radius, walls, wall, now);
      const double leaves = failure_time(certificates::WallSeparation<2>{motion.axis(axis), plane, radius, out}, now);
      REQUIRE(earliest >= now);
      late += earliest > leaves;
      told += earliest > now;
      near += leaves < never && earliest - now > 0.99 * (leaves - now);
    }
  }
  INFO("seed " << seed);
  CHECK(late == 0);
  CHECK(told > 10'000);
  CHECK(near > 10'000);
}

TEST_CASE("What does not move, and walls that are nowhere, are left out", "[walls]") {
  const Motion motion{{Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(0, -1, 1)}, 0};
  const Walls walls{Eigen::Vector3d(2, -8, -9), Eigen::Vector3d(0, 8, never)};
  CHECK(earliest_wall_time_of_all(motion, 1, walls, 0) == Approx(9));
  const Motion away{{Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(0, 0, 1)}, 0};
  CHECK(earliest_wall_time_of_all(away, 1, walls, 0) == never);
}

}  // namespace
}  // namespace kds::collision::test_earliest_wall_time
