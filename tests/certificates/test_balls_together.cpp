#include "certificates/balls_together.hpp"
#include "tests/certificates/ball_approaches.hpp"

#include <catch2/catch.hpp>

#include <cmath>

namespace {

using namespace kds;
using namespace kds::tests;
using certificates::BallSeparation;
using certificates::PointMotion;
using certificates::TwoApproaches;
using Eigen::Vector3d;

template <int PathDegree>
BallSeparation<PathDegree> balls_of(const BallApproach<PathDegree>& approach) {
  return {approach.a, approach.b, approach.radius_a, approach.radius_b};
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("balls do not meet before their earliest approach, and never just where that is told",
                       "[balls_together]", ((int PathDegree), PathDegree), 1, 2) {
  const std::uint64_t seed = 103;
  CAPTURE(PathDegree, seed);
  Random random(seed);
  int decided = 0;
  int later = 0;
  int apart = 0;
  for (int round = 0; round < 60'000; ++round) {
    const int scale = random.one_in(4) ? random.integer(-300, 300) : 0;
    const BallApproach<PathDegree> approach(random, scale);
    const BallApproach<PathDegree> other(random, scale);
    const auto balls = balls_of(approach);
    const double now = approach.now;
    const double horizon = random.one_in(3) ? now + random.between(0, 1) : never;
    CAPTURE(round);
    const TwoApproaches first = certificates::earliest_approaches(balls, balls_of(other), now, horizon);
    const TwoApproaches second = certificates::earliest_approaches(balls_of(other), balls, now, horizon);
    const double earliest = first.earliest[0];
    const bool surely_apart = first.apart[0] != 0;
    // What is in the other lane, and in which this is, does not matter.
    const bool lanes_agree = std::isnan(earliest) ? std::isnan(second.earliest[1]) : earliest == second.earliest[1];
    if (!lanes_agree || surely_apart != (second.apart[1] != 0)) FAIL("lanes differ");

    const double expected = plain_first_approach(balls, now, horizon);
    if (earliest == never ? expected != never : earliest > expected || earliest < now) REQUIRE(earliest == expected);
    if (surely_apart && sign_after(PlainBalls<PathDegree>{balls}, now) <= 0) FAIL("the balls are not apart");
    decided += !std::isnan(earliest);
    later += earliest < never && expected < never;
    apart += surely_apart;
  }
  CHECK(decided > 30'000);
  CHECK(later > 1'000);
  CHECK(apart > 10'000);
}

TEST_CASE("the earliest approach of balls head on is near the meeting", "[balls_together]") {
  const PointMotion<1> rest{{Vector3d(5, 0, 0), Vector3d::Zero()}, 0};
  const PointMotion<1> coming{{Vector3d(0, 0, 0), Vector3d(1, 0, 0)}, 0};
  const PointMotion<1> leaving{{Vector3d(0, 0, 0), Vector3d(-1, 0, 0)}, 0};
  const BallSeparation<1> head_on{rest, coming, 1, 2};
  const BallSeparation<1> parting{rest, leaving, 1, 2};
  const TwoApproaches found = certificates::earliest_approaches(head_on, parting, 0.5, 10);
  CHECK(found.earliest[0] <= 2);
  CHECK(found.earliest[0] > 2 - 1e-12);
  CHECK(found.earliest[1] == never);
  CHECK(certificates::earliest_approaches(head_on, parting, 0.5, 1.5).earliest[0] == never);
}

TEST_CASE("balls that stand as seen from each other never meet", "[balls_together]") {
  const PointMotion<1> one{{Vector3d(5, 0, 0), Vector3d(1, 2, 3)}, 0};
  const PointMotion<1> other{{Vector3d(0, 0, 0), Vector3d(1, 2, 3)}, 0.25};
  const BallSeparation<1> apart{one, other, 1, 2};
  const BallSeparation<1> together{one, other, 4, 2};
  const TwoApproaches found = certificates::earliest_approaches(apart, together, 1, never);
  CHECK(found.earliest[0] == never);
  CHECK(found.earliest[1] == never);
  CHECK(found.apart[0] != 0);
  CHECK(found.apart[1] == 0);
}

TEST_CASE("balls that touch, and balls on curves that are not alike, take more care", "[balls_together]") {
  const PointMotion<2> rest{{Vector3d(2, 0, 0), Vector3d::Zero(), Vector3d::Zero()}, 0};
  const PointMotion<2> coming{{Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d::Zero()}, 0};
  const PointMotion<2> falling{{Vector3d(-9, 0, 0), Vector3d(1, 0, 0), Vector3d(0, 0, -5)}, 0};
  const TwoApproaches found = certificates::earliest_approaches(BallSeparation<2>{rest, coming, 1, 1},
                                                                BallSeparation<2>{rest, falling, 1, 1}, 0, 9);
  CHECK(std::isnan(found.earliest[0]));
  CHECK(found.apart[0] == 0);
  CHECK(std::isnan(found.earliest[1]));
  CHECK(found.apart[1] == 0);
}
