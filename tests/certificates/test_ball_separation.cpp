#include "certificates/ball_separation.hpp"
#include "tests/certificates/ball_approaches.hpp"
#include "tests/certificates/check_certificate.hpp"
#include "tests/support/exact_oracle.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace test_ball_separation {
namespace {

using namespace kds;
using namespace kds::tests;
using certificates::BallSeparation;
using certificates::PointMotion;
using Eigen::Vector3d;

template <int PathDegree>
oracle::Polynomial expected(const BallSeparation<PathDegree>& balls) {
  const auto a = exact(balls.a);
  const auto b = exact(balls.b);
  const auto sum_of_radii = exact(balls.radius_a) + exact(balls.radius_b);
  oracle::Polynomial f = oracle::Polynomial() - sum_of_radii * sum_of_radii;
  for (std::size_t d = 0; d < 3; ++d) f = f + (b[d] - a[d]) * (b[d] - a[d]);
  return f;
}

template <int PathDegree>
oracle::Body body(const PointMotion<PathDegree>& path, double radius) {
  oracle::Piece piece{path.start, {}};
  for (const auto& c : path.coefficients) piece.coefficients.push_back({c[0], c[1], c[2]});
  return {oracle::Sphere{radius}, {piece}};
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("balls are apart while their centres are farther than the radii", "[ball_separation]",
                       ((int PathDegree), PathDegree), 1, 2, 3, 5) {
  const std::uint64_t seed = 100;
  CAPTURE(PathDegree, seed);
  Random random(seed);
  for (int round = 0; round < 150; ++round) {
    const bool coarse = random.one_in(2);
    const double start = random_start(random, coarse);
    const auto a = random_path<PathDegree>(random, coarse, start);
    const auto b = random_path<PathDegree>(random, coarse, random.one_in(2) ? start : random_start(random, coarse));
    const double radius_a = coarse ? random.integer(1, 4) / 4.0 : random.between(0.01, 1);
    const double radius_b = coarse ? random.integer(1, 4) / 4.0 : random.between(0.01, 1);
    const BallSeparation<PathDegree> balls{a, b, radius_a, radius_b};
    CAPTURE(round);
    CHECK(mistakes(balls, expected(balls), random) == 0);
  }
}

TEMPLATE_TEST_CASE_SIG("balls begin to penetrate when the oracle's spheres do", "[ball_separation]",
                       ((int PathDegree), PathDegree), 1, 2, 3, 5) {
  const std::uint64_t seed = 101;
  CAPTURE(PathDegree, seed);
  Random random(seed);
  int met = 0;
  for (int round = 0; round < 100; ++round) {
    const auto a = random_path<PathDegree>(random, false, 0);
    auto b = random_path<PathDegree>(random, false, 0);
    b.coefficients[0] *= 4;
    b.coefficients[1] =
        a.coefficients[1] + (a.coefficients[0] - b.coefficients[0]) / 2 + random_point(random, false) / 4;
    for (std::size_t i = 2; i <= PathDegree; ++i) {
      b.coefficients[i] = a.coefficients[i] + random_point(random, false) / 8;
    }
    const BallSeparation<PathDegree> balls{a, b, 0.5, 0.75};
    const auto contact = oracle::first_contact(body(a, 0.5), body(b, 0.75), 0, 4);
    const double t = failure_time(balls, 0, 4);
    CAPTURE(round);
    REQUIRE(contact.has_value() == (t != never));
    if (contact) CHECK(t == contact->ceiling());
    met += contact && t > 0;
  }
  CHECK(met > 5);
}

TEST_CASE("balls that graze do not penetrate", "[ball_separation]") {
  const PointMotion<1> rest{{Vector3d(0, 2, 0), Vector3d::Zero()}, 0};
  const PointMotion<1> passing{{Vector3d(-3, 0, 0), Vector3d(1, 0, 0)}, 0};
  CHECK(failure_time(BallSeparation<1>{rest, passing, 1, 1}, 0) == never);
  CHECK(failure_time(BallSeparation<1>{rest, passing, 1, next_up(1)}, 0) < 3);
  CHECK(failure_time(BallSeparation<1>{rest, passing, 1, next_down(1)}, 0) == never);
}

TEST_CASE("balls head on meet where they must", "[ball_separation]") {
  const PointMotion<1> rest{{Vector3d(5, 0, 0), Vector3d::Zero()}, 0};
  const PointMotion<1> coming{{Vector3d(0, 0, 0), Vector3d(1, 0, 0)}, 0};
  CHECK(failure_time(BallSeparation<1>{rest, coming, 1, 2}, 0) == 2);
  CHECK(failure_time(BallSeparation<1>{rest, coming, 1, 2}, 2) == 2);
  CHECK(failure_time(BallSeparation<1>{rest, coming, 1, 2}, 8) == never);  // touching, and leaving
  CHECK(recovery_time(BallSeparation<1>{rest, coming, 1, 2}, 3) == 8);
}

TEST_CASE("balls that move together and touch never penetrate", "[ball_separation]") {
  const PointMotion<2> a{{Vector3d(0, 0, 0), Vector3d(1, 2, 3), Vector3d(0, 0, -5)}, 0};
  const PointMotion<2> b{{Vector3d(0, 0, 2), Vector3d(1, 2, 3), Vector3d(0, 0, -5)}, 0};
  CHECK(sign_after(BallSeparation<2>{a, b, 1, 1}, 3) == 0);
  CHECK(failure_time(BallSeparation<2>{a, b, 1, 1}, 0) == never);
  CHECK(failure_time(BallSeparation<2>{a, b, 1, next_up(1)}, 0) == 0);
}

TEMPLATE_TEST_CASE_SIG("quick answers about balls are the ones that exact signs give", "[ball_separation]",
                       ((int PathDegree), PathDegree), 1, 2) {
  const std::uint64_t seed = 102;
  CAPTURE(PathDegree, seed);
  Random random(seed);
  int decided = 0;
  for (int round = 0; round < 60'000; ++round) {
    const BallApproach<PathDegree> approach(random, random.one_in(4) ? random.integer(-300, 300) : 0);
    const BallSeparation<PathDegree> balls{approach.a, approach.b, approach.radius_a, approach.radius_b};
    const PlainBalls<PathDegree> plain{balls};
    const double now = approach.now;
    const double horizon = random.one_in(3) ? now + random.between(0, 1) : never;
    CAPTURE(round);

    const double expected_failure = failure_time(plain, now, horizon);
    const double quick = balls.quick_failure_time(now, horizon);
    decided += !std::isnan(quick);
    if (!std::isnan(quick) && quick != expected_failure) REQUIRE(quick == expected_failure);

    const double expected = plain_first_approach(balls, now, horizon);
    const double found = balls.first_approach(now, horizon);
    if (found != expected) REQUIRE(found == expected);
  }
  CHECK(decided > 30'000);
}

TEMPLATE_TEST_CASE_SIG("balls do not meet before a plane between them is sure to be gone", "[ball_separation]",
                       ((int PathDegree), PathDegree), 1, 2, 3) {
  const std::uint64_t seed = 104;
  CAPTURE(PathDegree, seed);
  Random random(seed);
  int late = 0;
  int told = 0;
  int near = 0;
  for (int round = 0; round < 20'000; ++round) {
    BallApproach<std::min(PathDegree, 2)> approach(random, random.integer(-20, 20));
    PointMotion<PathDegree> a, b;
    for (auto [to, from] : {std::pair(&a, &approach.a), std::pair(&b, &approach.b)}) {
      to->start = from->start;
      to->coefficients.fill(Vector3d::Zero());
      std::copy(from->coefficients.begin(), from->coefficients.end(), to->coefficients.begin());
    }
    // Accelerations that differ.
    if (PathDegree >= 2 && random.one_in(2)) b.coefficients[std::min(PathDegree, 2)] *= random.between(-2, 2);
    const BallSeparation<PathDegree> balls{a, b, approach.radius_a, approach.radius_b};
    const double until = balls.apart_until(approach.now);
    const double meets = balls.first_approach(approach.now, never);
    REQUIRE(until >= approach.now);
    late += until > meets;
    told += until > approach.now;
    near += meets < never && until - approach.now > 0.9 * (meets - approach.now);
  }
  CHECK(late == 0);
  CHECK(told > (PathDegree <= 2 ? 5000 : -1));
  CHECK(near > (PathDegree <= 2 ? 500 : -1));
}

TEMPLATE_TEST_CASE_SIG("a plane that stays between two balls is right, and found where they keep away",
                       "[ball_separation]", ((int PathDegree), PathDegree), 1, 3, 5) {
  const std::uint64_t seed = 105;
  CAPTURE(PathDegree, seed);
  Random random(seed);
  int between = 0, meet = 0, far = 0, missed = 0;
  for (int round = 0; round < 5'000; ++round) {
    const double scale = std::ldexp(1.0, static_cast<int>(random.integer(-30, 30)));
    PointMotion<PathDegree> a, b;
    const double from = random.between(-2, 2);
    const double to = from + random.between(0, 2);
    for (auto* ball : {&a, &b}) {
      ball->start = from - random.between(0, 1);
      double size = scale;
      for (auto& c : ball->coefficients) {
        c = size * Vector3d(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
        size /= 4;
      }
    }
    const BallSeparation<PathDegree> balls{a, b, scale * random.between(0, 0.5), scale * random.between(0, 0.5)};
    const bool found = balls.plane_between(from, to);
    const bool meets = failure_time(balls, from, to) != never;
    if (found) REQUIRE_FALSE(meets);
    between += found;
    meet += meets;
    double least = never;
    for (int i = 0; i <= 64; ++i) {
      const double t = from + (to - from) * i / 64;
      least = std::min(least, (b.position(t) - a.position(t)).norm());
    }
    if (least < 1.5 * scale + balls.radius_a + balls.radius_b) continue;
    ++far;
    missed += !found;
  }
  CHECK(meet > 300);
  CHECK(between > 500);
  CHECK(far > 20);
  CHECK(missed <= far / 10);
}

}  // namespace test_ball_separation
