// Certificates of points in the plane: orientation, in-circle, order along a direction, order of distances.
#include "certificates/direction_order.hpp"
#include "certificates/distance_order.hpp"
#include "certificates/in_circle.hpp"
#include "certificates/orientation.hpp"
#include "certificates/plane_motion.hpp"
#include "tests/certificates/check_certificate.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace test_plane_certificates {
namespace {

using namespace kds;
using namespace kds::tests;
using certificates::BoundedPoint;
using certificates::DirectionOrder;
using certificates::DistanceOrder;
using certificates::InCircle;
using certificates::Orientation;
using certificates::PlaneMotion;

template <int Degree>
PlaneMotion<Degree> random_plane_path(Random& random, bool coarse, double start) {
  const auto path = random_path<Degree>(random, coarse, start);
  return {{path.axis(0).position, path.axis(1).position}, start};
}

using ExactPoint = std::array<oracle::Polynomial, 2>;
template <int Degree>
ExactPoint exact(const PlaneMotion<Degree>& path) {
  return {kds::tests::exact(path.axis(0)), kds::tests::exact(path.axis(1))};
}
oracle::Polynomial lift(const ExactPoint& p) { return p[0] * p[0] + p[1] * p[1]; }
oracle::Polynomial minor(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c) {
  return a[0] * b[1] - a[1] * b[0] + b[0] * c[1] - b[1] * c[0] + c[0] * a[1] - c[1] * a[0];
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("plane certificates are the polynomials they say they are", "[plane]", ((int Degree), Degree), 1,
                       2) {
  const std::uint64_t seed = 150;
  CAPTURE(Degree, seed);
  Random random(seed);
  int wrong_orientation = 0, wrong_circle = 0, wrong_direction = 0, wrong_distance = 0;
  for (int round = 0; round < (Degree == 1 ? 40 : 12); ++round) {
    const bool coarse = random.one_in(2);
    const double start = random_start(random, coarse);
    const auto path = [&] {
      return random_plane_path<Degree>(random, coarse, random.one_in(2) ? start : random_start(random, coarse));
    };
    const auto a = path(), b = path(), c = path(), d = random.one_in(8) ? a : path();
    const ExactPoint p = exact(a), q = exact(b), r = exact(c), s = exact(d);
    wrong_orientation += mistakes(Orientation<PlaneMotion<Degree>>{a, b, c}, minor(p, q, r), random);
    // By the last column of the determinant with ones: another way than the certificate's.
    const auto circle =
        lift(s) * minor(p, q, r) - lift(r) * minor(p, q, s) + lift(q) * minor(p, r, s) - lift(p) * minor(q, r, s);
    wrong_circle += mistakes(InCircle<PlaneMotion<Degree>>{a, b, c, d}, circle, random);
    const std::array<double, 2> direction{random.between(-1, 1), coarse ? 0.0 : random.between(-1, 1)};
    const oracle::Polynomial x(oracle::rational(direction[0])), y(oracle::rational(direction[1]));
    wrong_direction += mistakes(DirectionOrder<PlaneMotion<Degree>, 2>{a, b, direction},
                                x * (q[0] - p[0]) + y * (q[1] - p[1]), random);
    const auto distance = [](const ExactPoint& u, const ExactPoint& v) {
      return (u[0] - v[0]) * (u[0] - v[0]) + (u[1] - v[1]) * (u[1] - v[1]);
    };
    wrong_distance += mistakes(DistanceOrder<PlaneMotion<Degree>>{a, b, c, d}, distance(r, s) - distance(p, q), random);
  }
  CHECK(wrong_orientation == 0);
  CHECK(wrong_circle == 0);
  CHECK(wrong_direction == 0);
  CHECK(wrong_distance == 0);
}

TEST_CASE("orientation and in-circle have the symmetries they state", "[plane]") {
  const std::uint64_t seed = 160;
  CAPTURE(seed);
  Random random(seed);
  using Path = PlaneMotion<1>;
  int wrong = 0;
  for (int round = 0; round < 200; ++round) {
    const bool coarse = random.one_in(2);
    const Path a = random_plane_path<1>(random, coarse, 0), b = random_plane_path<1>(random, coarse, 0),
               c = random_plane_path<1>(random, coarse, 1), d = random_plane_path<1>(random, coarse, -1);
    const double t = random_time(random);
    const int left = sign_after(Orientation<Path>{a, b, c}, t);
    wrong += left != sign_after(Orientation<Path>{b, c, a}, t) || left != -sign_after(Orientation<Path>{b, a, c}, t);
    const int outside = sign_after(InCircle<Path>{a, b, c, d}, t);
    wrong +=
        outside != sign_after(InCircle<Path>{b, a, d, c}, t) || outside != sign_after(InCircle<Path>{c, d, a, b}, t);
    wrong +=
        outside != sign_after(InCircle<Path>{b, c, a, d}, t) || outside != -sign_after(InCircle<Path>{b, a, c, d}, t);
  }
  CHECK(wrong == 0);
}

TEST_CASE("failure times of in-circle tests of cubics are right, and need no search by exact signs", "[plane]") {
  const std::uint64_t seed = 165;
  CAPTURE(seed);
  Random random(seed);
  using Path = PlaneMotion<3>;
  int wrong = 0, failures = 0;
  std::uint64_t searches = 0;
  for (int round = 0; round < 2000; ++round) {
    // Points near each other: roots near now, and far ones by the speeds.
    std::array<Path, 4> paths;
    for (Path& path : paths) {
      for (auto& coordinate : path.coordinate) {
        coordinate.c = {random.unit() / 8, random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
      }
    }
    const auto& [a, b, c, d] = paths;
    const InCircle<Path> outside{a, b, c, d};
    const double horizon = random.one_in(2) ? never : random.between(0, 2);
    sign_counters = {};
    const double t = failure_time(outside, 0, horizon);
    searches += sign_counters.searches;
    failures += t > 0 && t < never;
    wrong += t != detail::failure_time_by_signs(CertificateReference(outside), 0, horizon);
  }
  CHECK(wrong == 0);
  CHECK(failures > 500);
  CHECK(searches <= 1);
}

TEST_CASE("a point enters a circle, three points come to one line", "[plane]") {
  const auto at = [](double x, double y, double speed = 0) { return PlaneMotion<1>{{{{{x, speed}}, {{y, 0}}}}, 0}; };
  const auto a = at(1, 0), b = at(0, 1), c = at(-1, 0);
  const auto d = at(-3, 0, 0.5), e = at(-3, 1, 1);
  CHECK(failure_time(InCircle<PlaneMotion<1>>{a, b, c, d}, 0) == 4);      // through c
  CHECK(recovery_time(InCircle<PlaneMotion<1>>{a, b, c, d}, 5) == 8);     // out of it through a
  CHECK(failure_time(InCircle<PlaneMotion<1>>{a, b, c, e}, 0) == never);  // touches it at b
  CHECK(failure_time(Orientation<PlaneMotion<1>>{a, b, e}, 0) == 3);      // through b
  CHECK(failure_time(InCircle<PlaneMotion<1>>{a, b, c, a}, 0) == never);
}

TEST_CASE("certificates of sampled points never fail late", "[plane][bounded]") {
  const std::uint64_t seed = 170;
  CAPTURE(seed);
  Random random(seed);
  int late = 0, wrong_sign = 0, ends = 0, tight = 0;
  for (int round = 0; round < 400; ++round) {
    std::array<BoundedPoint, 4> samples;
    std::array<PlaneMotion<1>, 4> truth;  // one of the motions that the samples allow: at full speed
    for (std::size_t i = 0; i < 4; ++i) {
      const double start = -random.unit(), x = random.between(-1, 1), y = random.between(-1, 1);
      const double speed = random.between(0, 0.2);
      samples[i] = {{x, y}, speed, start};
      truth[i] = {{{{{x, random.one_in(2) ? speed : -speed}}, {{y, random.one_in(2) ? speed : -speed}}}}, start};
    }
    const auto& [p, q, r, s] = samples;
    const auto& [a, b, c, d] = truth;
    const auto check = [&](const auto& sampled, const auto& real) {
      const double promised = failure_time(Conservative<std::remove_cvref_t<decltype(sampled)>>{sampled}, 0);
      const double real_failure = failure_time(real, 0);
      late += exact_sign(sampled, 0) > 0 && promised > real_failure;
      ends += promised > 0 && promised < never;
      wrong_sign += exact_sign(sampled, 0) <= 0 && promised != 0;
      tight += promised == real_failure && promised > 0;
    };
    check(Orientation<BoundedPoint>{p, q, r}, Orientation<PlaneMotion<1>>{a, b, c});
    check(InCircle<BoundedPoint>{p, q, r, s}, InCircle<PlaneMotion<1>>{a, b, c, d});
    const std::array<double, 2> x{1, 0};
    check(DirectionOrder<BoundedPoint, 2>{p, q, x}, DirectionOrder<PlaneMotion<1>, 2>{a, b, x});
    check(DistanceOrder<BoundedPoint>{p, q, r, s}, DistanceOrder<PlaneMotion<1>>{a, b, c, d});
  }
  CHECK(late == 0);
  CHECK(wrong_sign == 0);
  CHECK(ends > 400);
  CHECK(tight > 20);  // In one dimension, towards each other at full speed, the bound is reached.
}

}  // namespace test_plane_certificates
