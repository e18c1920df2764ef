#include "certificates/plane_motion.hpp"
#include "certificates/point_motion.hpp"
#include "tests/certificates/check_certificate.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <new>

namespace test_point_motion {
namespace {

using namespace kds;
using namespace kds::tests;
using certificates::PlaneMotion;
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
  check([&] { return new (&memory) Path; }, 0);
  check([&] { return new (&memory) Path{}; }, 0);
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

namespace {

/// Off a value, in each coordinate: of a derivative of a path at t, exactly.
template <int Degree>
double off(const PointMotion<Degree>& path, int order, double t, const Vector3d& value) {
  double most = 0;
  for (int d = 0; d < 3; ++d) {
    auto p = exact(path)[static_cast<std::size_t>(d)];
    for (int i = 0; i < order; ++i) p = p.derivative();
    most = std::max(most, std::abs(oracle::approximate(p(oracle::rational(t)) - oracle::rational(value[d]))));
  }
  return most;
}

double size(const Vector3d& v) { return v.cwiseAbs().maxCoeff(); }

}  // namespace

TEST_CASE("cubic pieces go where they are told, at the velocities that they are told", "[point_motion]") {
  const std::uint64_t seed = 92;
  CAPTURE(seed);
  Random random(seed);
  const auto vector = [&random](int scale) {
    const double x = random.scaled(-scale, scale), y = random.scaled(-scale, scale), z = random.scaled(-scale, scale);
    return Vector3d(x, y, z);
  };
  for (int round = 0; round < 300; ++round) {
    CAPTURE(round);
    const Vector3d p0 = vector(8), v0 = vector(8), a0 = vector(8), p1 = vector(8), v1 = vector(8), a1 = vector(8);
    const double t0 = random.scaled(-4, 4);
    const double t1 = t0 + std::abs(random.scaled(-6, 4));
    const double T = t1 - t0;
    const auto cubic = PointMotion<3>::cubic(p0, v0, p1, v1, t0, t1);
    const double of_cubic = 0x1p-48 * (size(p0) + size(p1) + T * (size(v0) + size(v1)));
    CHECK(cubic.start == t0);
    CHECK(cubic.position(t0) == p0);
    CHECK(cubic.velocity(t0) == v0);
    CHECK(off(cubic, 0, t1, p1) < of_cubic);
    CHECK(off(cubic, 1, t1, v1) < 3 * of_cubic / T);
    CHECK((cubic.position(t1) - p1).cwiseAbs().maxCoeff() < of_cubic);
    const auto same = PointMotion<5>::cubic(p0, v0, p1, v1, t0, t1);
    for (std::size_t i = 0; i <= 3; ++i) CHECK(same.coefficients[i] == cubic.coefficients[i]);
    CHECK(same.coefficients[4].isZero(0));
    const auto quintic = PointMotion<5>::quintic(p0, v0, a0, p1, v1, a1, t0, t1);
    const double of_quintic =
        0x1p-45 * (size(p0) + size(p1) + T * (size(v0) + size(v1)) + T * T * (size(a0) + size(a1)));
    CHECK(quintic.position(t0) == p0);
    CHECK(quintic.velocity(t0) == v0);
    CHECK(quintic.acceleration(t0) == a0);
    CHECK(off(quintic, 0, t1, p1) < of_quintic);
    CHECK(off(quintic, 1, t1, v1) < 5 * of_quintic / T);
    CHECK(off(quintic, 2, t1, a1) < 20 * of_quintic / (T * T));
    // In the plane the same coordinates.
    const auto flat = [](const Vector3d& v) { return std::array{v[0], v[1]}; };
    const auto on_plane = PlaneMotion<3>::cubic(flat(p0), flat(v0), flat(p1), flat(v1), t0, t1);
    const auto bent = PlaneMotion<5>::quintic(flat(p0), flat(v0), flat(a0), flat(p1), flat(v1), flat(a1), t0, t1);
    for (int d = 0; d < 2; ++d) {
      CHECK(on_plane.axis(d) == cubic.axis(d));
      CHECK(bent.axis(d) == quintic.axis(d));
    }
  }
  // What doubles hold is exact: half a second, halves of lengths.
  const auto swing = PointMotion<3>::cubic({0, 0, 0}, {0, 0, 0}, {2, 0, 1}, {0, 0, 0}, 1, 3);
  CHECK(swing ==
        PointMotion<3>{{Vector3d(0, 0, 0), Vector3d(0, 0, 0), Vector3d(1.5, 0, 0.75), Vector3d(-0.5, 0, -0.25)}, 1});
}

TEST_CASE("a piece of a trajectory lasts some time, and is finite", "[point_motion]") {
  const Vector3d o = Vector3d::Zero();
  const Vector3d far = Vector3d::Constant(1e300);
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double end : {1.0, 0.5, infinity, std::nan("")}) {
    CHECK_THROWS_WITH(PointMotion<3>::cubic(o, o, o, o, 1, end), Catch::StartsWith("PointMotion::cubic: from 1 to "));
    CHECK_THROWS_WITH(PointMotion<5>::quintic(o, o, o, o, o, o, 1, end), Catch::StartsWith("PointMotion::quintic"));
  }
  CHECK_THROWS_WITH(PointMotion<3>::cubic(o, far, o, far, 0, 1e30), "PointMotion::cubic: a coefficient is not finite");
  CHECK_THROWS_WITH(PlaneMotion<3>::cubic({}, {}, {}, {}, 1, 1), Catch::StartsWith("PlaneMotion::cubic: from 1 to "));
  CHECK_THROWS_WITH(PlaneMotion<5>::quintic({}, {infinity, 0}, {}, {}, {}, {}, 0, 1),
                    "PlaneMotion::quintic: a coefficient is not finite");
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

}  // namespace test_point_motion
