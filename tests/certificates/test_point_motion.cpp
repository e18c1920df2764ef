#include "certificates/point_motion.hpp"
#include "tests/certificates/check_certificate.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <new>

namespace {

using namespace kds;
using namespace kds::tests;
using certificates::PointMotion;
using certificates::relative_motion;
using Eigen::Vector3d;

const PointMotion<2> throw_of_a_ball{{Vector3d(1, 2, 3), Vector3d(4, 0, 8), Vector3d(0, 0, -5)}, 10};

}  // namespace

TEST_CASE("a point has position, velocity and acceleration", "[point_motion]") {
  CHECK(throw_of_a_ball.position(10) == Vector3d(1, 2, 3));
  CHECK(throw_of_a_ball.position(12) == Vector3d(9, 2, -1));
  CHECK(throw_of_a_ball.velocity(10) == Vector3d(4, 0, 8));
  CHECK(throw_of_a_ball.velocity(12) == Vector3d(4, 0, -12));
  CHECK(throw_of_a_ball.acceleration(10) == Vector3d(0, 0, -10));  // twice the coefficient
  CHECK(throw_of_a_ball.acceleration(15) == Vector3d(0, 0, -10));
  const PointMotion<1> straight{{Vector3d(1, 0, 0), Vector3d(0, 1, 0)}, 0};
  CHECK(straight.position(3) == Vector3d(1, 3, 0));
  CHECK(straight.velocity(3) == Vector3d(0, 1, 0));
  CHECK(straight.acceleration(3) == Vector3d(0, 0, 0));
  const PointMotion<3> jerk{{Vector3d(0, 0, 0), Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(2, 0, 0)}, 0};
  CHECK(jerk.velocity(2) == Vector3d(4 + 24, 0, 0));
  CHECK(jerk.acceleration(2) == Vector3d(2 + 24, 0, 0));
}

TEST_CASE("coefficients that are left out are zero, whatever was in memory", "[point_motion]") {
  using Path = PointMotion<3>;
  alignas(Path) std::array<unsigned char, sizeof(Path)> memory;
  const std::array<Vector3d, 4> given{Vector3d(1, 2, 3), Vector3d(4, 5, 6), Vector3d(7, 8, 9), Vector3d(0.5, 0, 1)};
  const auto check = [&](auto&& make, std::size_t count) {
    memory.fill(0x41);  // some two millions in every double
    const Path* const path = make();
    for (std::size_t i = 0; i < 4; ++i) {
      CHECK(path->coefficients[i] == (i < count ? given[i] : Vector3d(Vector3d::Zero())));
    }
    CHECK(path->start == 0);
  };
  check([&] { return new (&memory) Path{{given[0]}}; }, 1);
  check([&] { return new (&memory) Path{{given[0], given[1]}}; }, 2);
  check([&] { return new (&memory) Path{{given[0], given[1], given[2]}, 0}; }, 3);
  check([&] { return new (&memory) Path{{given[0], given[1], given[2], given[3]}, 0}; }, 4);
  check([&] { return new (&memory) Path{.coefficients = {{1, 2, 3}, {4, 5, 6}}}; }, 2);
  Path path{{given[3], given[3], given[3], given[3]}, 0};
  path.coefficients = {given[0], Vector3d::Zero()};
  CHECK(path == Path{{given[0]}});
}

TEST_CASE("lines and parabolas by position, velocity and acceleration at a time", "[point_motion]") {
  const auto line = PointMotion<2>::line({1, 2, 3}, {4, 5, 6}, 7);
  CHECK(line.position(7) == Vector3d(1, 2, 3));
  CHECK(line.velocity(9) == Vector3d(4, 5, 6));
  CHECK(line.acceleration(9) == Vector3d(0, 0, 0));
  CHECK(PointMotion<1>::line({1, 2, 3}, {4, 5, 6}) == PointMotion<1>{{Vector3d(1, 2, 3), Vector3d(4, 5, 6)}, 0});
  const auto thrown = PointMotion<2>::parabola({1, 2, 3}, {4, 0, 8}, {0, 0, -10}, 10);
  CHECK(thrown == throw_of_a_ball);
  CHECK(thrown.acceleration(12) == Vector3d(0, 0, -10));
}

TEST_CASE("an axis of a path is the motion of one coordinate", "[point_motion]") {
  const Motion<2> z = throw_of_a_ball.axis(2);
  CHECK(z == Motion<2>{{{3, 8, -5}}, 10});
  for (int d = 0; d < 3; ++d) CHECK(throw_of_a_ball.axis(d)(11.5) == throw_of_a_ball.position(11.5)[d]);
}

TEST_CASE("a path restarted is the same path up to rounding", "[point_motion]") {
  CHECK(throw_of_a_ball.restarted(10) == throw_of_a_ball);
  const auto later = throw_of_a_ball.restarted(12);
  CHECK(later == PointMotion<2>{{Vector3d(9, 2, -1), Vector3d(4, 0, -12), Vector3d(0, 0, -5)}, 12});
  const std::uint64_t seed = 90;
  CAPTURE(seed);
  Random random(seed);
  for (int round = 0; round < 100; ++round) {
    const auto path = random_path<2>(random, false, random_start(random, false));
    const double t = random_time(random);
    const auto again = path.restarted(t);
    CAPTURE(round, t);
    CHECK(again.start == t);
    CHECK(again.position(t) == path.position(t));
    const double at = random_time(random);
    CHECK((again.position(at) - path.position(at)).norm() < 1e-12);
    CHECK((again.velocity(at) - path.velocity(at)).norm() < 1e-12);
  }
}

TEST_CASE("paths that are not finite are told", "[point_motion]") {
  CHECK(throw_of_a_ball.finite());
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    for (std::size_t i = 0; i <= 2; ++i) {
      for (int d = 0; d < 3; ++d) {
        auto path = throw_of_a_ball;
        path.coefficients[i][d] = bad;
        CHECK_FALSE(path.finite());
      }
    }
    auto path = throw_of_a_ball;
    path.start = bad;
    CHECK_FALSE(path.finite());
  }
}

TEST_CASE("paths are equal number by number", "[point_motion]") {
  auto other = throw_of_a_ball;
  CHECK(other == throw_of_a_ball);
  other.start = 11;
  CHECK_FALSE(other == throw_of_a_ball);
  other = throw_of_a_ball;
  other.coefficients[2][1] = 1e-300;
  CHECK_FALSE(other == throw_of_a_ball);
}

TEMPLATE_TEST_CASE_SIG("a relative motion is b less a, exactly", "[point_motion]", ((int Degree), Degree), 1, 2) {
  const std::uint64_t seed = 91;
  CAPTURE(Degree, seed);
  Random random(seed);
  for (int round = 0; round < 200; ++round) {
    const bool coarse = random.one_in(2);
    const double start = random_start(random, coarse);
    const auto a = random_path<Degree>(random, coarse, start);
    const auto b = random_path<Degree>(random, coarse, random.one_in(2) ? start : random_start(random, coarse));
    const auto path_a = exact(a);
    const auto path_b = exact(b);
    const double epoch = random_time(random);
    const auto r = relative_motion<Exact>(a, b, epoch);
    for (std::size_t d = 0; d < 3; ++d) {
      for (const double x : {-1.5, 0.0, 0.7, 3.0}) {
        const oracle::Rational t = oracle::rational(epoch) + oracle::rational(x);
        CAPTURE(round, d, x);
        REQUIRE(oracle::same(r[d](Exact(x)), path_b[d](t) - path_a[d](t)));
      }
    }
  }
}
