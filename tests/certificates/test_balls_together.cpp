#include "certificates/balls_together.hpp"
#include "tests/certificates/ball_approaches.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

namespace test_balls_together {
namespace {

using namespace kds;
using namespace kds::tests;
using certificates::BallSeparation;
using certificates::BallsTogether;
using certificates::MovingBall;
using certificates::PointMotion;
using Eigen::Vector3d;
using Times = std::array<double, 4>;

template <int PathDegree>
struct PairOfBalls {
  MovingBall<PathDegree> a, b;
};

template <int PathDegree>
using FourPairs = std::array<PairOfBalls<PathDegree>, 4>;

template <int PathDegree>
Times earliest_approaches(const FourPairs<PathDegree>& pairs, double now, double horizon) {
  BallsTogether<PathDegree> together;
  for (std::size_t k = 0; k < 4; ++k) together.put(k, pairs[k].a, pairs[k].b);
  Times times;
  together.earliest_approaches(now, horizon, times.data());
  return times;
}

/// The same in registers of two, whatever the processor has.
template <int PathDegree>
Times earliest_by_two(const FourPairs<PathDegree>& pairs, double now, double horizon) {
  certificates::detail::FourPairs numbers;
  for (std::size_t k = 0; k < 4; ++k) {
    numbers.a[k] = reinterpret_cast<const std::byte*>(&pairs[k].a);
    numbers.b[k] = reinterpret_cast<const std::byte*>(&pairs[k].b);
  }
  Times times;
  certificates::detail::find_approaches_by_two<PathDegree>(numbers, now, horizon, times.data());
  return times;
}

bool same(double x, double y) { return std::isnan(x) ? std::isnan(y) : lattice_index(x) == lattice_index(y); }

/// Lines that rest, come or leave along x.
PointMotion<1> on_x(double place, double velocity) { return {{Vector3d(place, 0, 0), Vector3d(velocity, 0, 0)}, 0}; }

}  // namespace

TEMPLATE_TEST_CASE_SIG("balls do not meet before their earliest approach, and never just where that is told",
                       "[balls_together]", ((int PathDegree), PathDegree), 1, 2) {
  const std::uint64_t seed = 103;
  CAPTURE(PathDegree, seed);
  Random random(seed);
  int decided = 0;
  int later = 0;
  int apart = 0;
  int parting = 0;
  for (int round = 0; round < 20'000; ++round) {
    CAPTURE(round);
    const int scale = random.one_in(4) ? random.integer(-300, 300) : 0;
    FourPairs<PathDegree> pairs;
    double now = 0;
    for (auto& [a, b] : pairs) {
      const BallApproach<PathDegree> approach(random, scale);
      a = {approach.a, approach.radius_a};
      b = {approach.b, approach.radius_b};
      now = approach.now;
    }
    const double horizon = random.one_in(3) ? now + random.between(0, 1) : never;
    const Times earliest = earliest_approaches(pairs, now, horizon);
    const Times by_two = earliest_by_two(pairs, now, horizon);
    for (std::size_t k = 0; k < 4; ++k) {
      if (!same(earliest[k], by_two[k])) FAIL("registers of two and of four differ");
      const auto& [a, b] = pairs[k];
      const BallSeparation<PathDegree> balls{a.motion, b.motion, a.radius, b.radius};
      const double expected = plain_first_approach(balls, now, horizon);
      if (std::isnan(earliest[k])) continue;
      ++decided;
      const bool no_meeting = std::abs(earliest[k]) == never;
      if (no_meeting ? expected != never : earliest[k] > expected || earliest[k] < now) {
        REQUIRE(earliest[k] == expected);
      }
      later += !no_meeting && expected < never;
      parting += earliest[k] == -never;
      if (earliest[k] == -never) continue;
      ++apart;
      if (sign_after(PlainBalls<PathDegree>{balls}, now) <= 0) FAIL("the balls are not apart");
    }
  }
  CHECK(decided > 40'000);
  CHECK(later > 1'000);
  CHECK(apart > 13'000);
  CHECK(parting > 1'000);
}

TEST_CASE("a pair's earliest approach does not depend on its place nor on the other pairs", "[balls_together]") {
  const std::uint64_t seed = 104;
  CAPTURE(seed);
  Random random(seed);
  for (int round = 0; round < 1'000; ++round) {
    CAPTURE(round);
    FourPairs<2> pairs;
    double now = 0;
    for (auto& [a, b] : pairs) {
      const BallApproach<2> approach(random, 0);
      a = {approach.a, approach.radius_a};
      b = {approach.b, approach.radius_b};
      now = approach.now;
    }
    const Times times = earliest_approaches(pairs, now, never);
    FourPairs<2> turned{pairs[1], pairs[2], pairs[3], pairs[0]};
    const Times of_turned = earliest_approaches(turned, now, never);
    for (std::size_t k = 0; k < 4; ++k) {
      if (!same(of_turned[k], times[(k + 1) % 4])) FAIL("places differ");
    }
  }
}

TEST_CASE("the earliest approach of balls head on is near the meeting", "[balls_together]") {
  const PairOfBalls<1> head_on{{on_x(5, 0), 1}, {on_x(0, 1), 2}};
  const PairOfBalls<1> parting{{on_x(5, 0), 1}, {on_x(0, -1), 2}};
  const PairOfBalls<1> parting_overlapped{{on_x(1, 0), 1}, {on_x(0, -1), 2}};
  const PairOfBalls<1> overlapped{{on_x(1, 0), 1}, {on_x(0, 1), 2}};
  const FourPairs<1> pairs{head_on, parting, parting_overlapped, overlapped};
  const Times found = earliest_approaches(pairs, 0.5, 10);
  CHECK(found[0] <= 2);
  CHECK(found[0] > 2 - 1e-12);
  CHECK(found[1] == never);
  CHECK(found[2] == -never);
  CHECK(std::isnan(found[3]));
  CHECK(earliest_approaches(pairs, 0.5, 1.5)[0] == never);
}

TEST_CASE("balls that stand as seen from each other never meet", "[balls_together]") {
  const PointMotion<1> one{{Vector3d(5, 0, 0), Vector3d(1, 2, 3)}, 0};
  const PointMotion<1> other{{Vector3d(0, 0, 0), Vector3d(1, 2, 3)}, 0.25};
  const PairOfBalls<1> apart{{one, 1}, {other, 2}};
  const PairOfBalls<1> together{{one, 4}, {other, 2}};
  const Times found = earliest_approaches<1>({apart, together, together, apart}, 1, never);
  CHECK(found[0] == never);
  CHECK(found[1] == -never);
  CHECK(found[2] == -never);
  CHECK(found[3] == never);
}

TEST_CASE("balls that touch, balls on curves that are not alike, and what is no ball take more care",
          "[balls_together]") {
  const PointMotion<2> rest{{Vector3d(2, 0, 0), Vector3d::Zero(), Vector3d::Zero()}, 0};
  const PointMotion<2> coming{{Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d::Zero()}, 0};
  const PointMotion<2> falling{{Vector3d(-9, 0, 0), Vector3d(1, 0, 0), Vector3d(0, 0, -5)}, 0};
  const PairOfBalls<2> touching{{rest, 1}, {coming, 1}};
  const PairOfBalls<2> curved{{rest, 1}, {falling, 1}};
  const PairOfBalls<2> no_ball{{rest}, {coming, 1}};
  const PointMotion<2> falling_away{{Vector3d(-20, 0, 0), Vector3d(-1, 0, 0), Vector3d(0, 0, -5)}, 0};
  const PairOfBalls<2> alike{{falling, 1}, {falling_away, 1}};
  const Times found = earliest_approaches<2>({touching, curved, no_ball, alike}, 0, 9);
  CHECK(std::isnan(found[0]));
  CHECK(std::isnan(found[1]));
  CHECK(std::isnan(found[2]));
  CHECK(found[3] == never);
}

}  // namespace test_balls_together
