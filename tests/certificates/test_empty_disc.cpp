// Certificates of the smallest discs that contain two or three points of the plane.
#include "certificates/empty_disc.hpp"
#include "certificates/plane_motion.hpp"
#include "tests/certificates/check_certificate.hpp"

#include <catch2/catch.hpp>

#include <array>

namespace test_empty_disc {
namespace {

using namespace kds;
using namespace kds::tests;
using certificates::BoundedPoint;
using certificates::CircleRadius;
using certificates::OutsideDisc;
using certificates::PairRadius;
using certificates::PlaneMotion;

template <int Degree>
PlaneMotion<Degree> random_plane_path(Random& random, bool coarse) {
  const auto path = random_path<Degree>(random, coarse, random_start(random, coarse));
  return {{path.axis(0).position, path.axis(1).position}, path.start};
}

using ExactPoint = std::array<oracle::Polynomial, 2>;
template <int Degree>
ExactPoint exact(const PlaneMotion<Degree>& path) {
  return {kds::tests::exact(path.axis(0)), kds::tests::exact(path.axis(1))};
}
oracle::Polynomial squared_distance(const ExactPoint& p, const ExactPoint& q) {
  return (p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1]);
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("certificates of empty discs are the polynomials they say they are", "[plane]",
                       ((int Degree), Degree), 1, 2) {
  const std::uint64_t seed = 170;
  CAPTURE(Degree, seed);
  Random random(seed);
  using Path = PlaneMotion<Degree>;
  int wrong_outside = 0, wrong_pair = 0, wrong_circle = 0;
  for (int round = 0; round < (Degree == 1 ? 30 : 8); ++round) {
    const bool coarse = random.one_in(2);
    const auto a = random_plane_path<Degree>(random, coarse), b = random_plane_path<Degree>(random, coarse),
               c = random.one_in(8) ? a : random_plane_path<Degree>(random, coarse);
    const double radius = coarse ? random.integer(0, 6) / 2.0 : random.between(0, 2);
    const double sign = random.one_in(2) ? 1 : -1;
    const ExactPoint p = exact(a), q = exact(b), r = exact(c);
    const oracle::Polynomial signed_one = kds::tests::exact(sign), two = kds::tests::exact(2.0);
    const auto ab = squared_distance(p, q), bc = squared_distance(q, r), ca = squared_distance(r, p);
    // Twice the scalar product by the law of cosines; the area by the formula of Heron. Other ways than the
    // certificates' own.
    wrong_outside += mistakes(OutsideDisc<Path>{a, b, c, sign},
                              signed_one * kds::tests::exact(0.5) * (bc + ca - ab), random);
    const auto diameter = kds::tests::exact(radius) * kds::tests::exact(radius) * two * two;
    wrong_pair += mistakes(PairRadius<Path>{a, b, radius, sign}, signed_one * (diameter - ab), random);
    const auto four_areas = two * (ab * bc + bc * ca + ca * ab) - (ab * ab + bc * bc + ca * ca);  // (2 D)^2
    wrong_circle += mistakes(
        CircleRadius<Path>{a, b, c, radius, sign},
        signed_one * (kds::tests::exact(radius) * kds::tests::exact(radius) * four_areas - ab * bc * ca), random);
  }
  CHECK(wrong_outside == 0);
  CHECK(wrong_pair == 0);
  CHECK(wrong_circle == 0);
}

TEST_CASE("certificates of empty discs have the right signs", "[plane]") {
  const auto at = [](double x, double y) { return PlaneMotion<1>{{{{{x, 0}}, {{y, 0}}}}, 0}; };
  const auto a = at(-1, 0), b = at(1, 0), inside = at(0.5, 0.5), outside = at(0, 2), on = at(0, 1);
  using Outside = OutsideDisc<PlaneMotion<1>>;
  CHECK(sign_after(Outside{a, b, outside, 1}, 0) == 1);
  CHECK(sign_after(Outside{a, b, outside, -1}, 0) == -1);
  CHECK(sign_after(Outside{a, b, inside, 1}, 0) == -1);
  CHECK(sign_after(Outside{a, b, on, 1}, 0) == 0);
  CHECK(sign_after(PairRadius<PlaneMotion<1>>{a, b, 1, 1}, 0) == 0);
  CHECK(sign_after(PairRadius<PlaneMotion<1>>{a, b, 0.9, 1}, 0) == -1);
  CHECK(sign_after(CircleRadius<PlaneMotion<1>>{a, b, outside, 1.25, 1}, 0) == 0);  // 3-4-5
  CHECK(sign_after(CircleRadius<PlaneMotion<1>>{a, b, outside, 1.2, 1}, 0) == -1);
  CHECK(sign_after(CircleRadius<PlaneMotion<1>>{a, b, outside, 1.2, -1}, 0) == 1);
  CHECK(sign_after(CircleRadius<PlaneMotion<1>>{b, outside, a, 1.3, 1}, 0) == 1);
}

TEST_CASE("certificates of empty discs of samples fail no later than those of the points", "[plane]") {
  const std::uint64_t seed = 171;
  CAPTURE(seed);
  Random random(seed);
  int late = 0, ends = 0;
  for (int round = 0; round < 200; ++round) {
    std::array<BoundedPoint, 3> samples;
    std::array<PlaneMotion<1>, 3> truth;  // one of the motions that the samples allow: at full speed
    for (std::size_t i = 0; i < 3; ++i) {
      const double start = -random.unit(), x = random.between(-1, 1), y = random.between(-1, 1);
      const double speed = random.between(0, 0.2);
      samples[i] = {{x, y}, speed, start};
      truth[i] = {{{{{x, random.one_in(2) ? speed : -speed}}, {{y, random.one_in(2) ? speed : -speed}}}}, start};
    }
    const auto& [p, q, r] = samples;
    const auto& [a, b, c] = truth;
    const auto check = [&](const auto& sampled, const auto& real) {
      if (exact_sign(sampled, 0) <= 0) return;
      const double promised = failure_time(Conservative<std::remove_cvref_t<decltype(sampled)>>{sampled}, 0);
      late += promised > failure_time(real, 0);
      ends += promised > 0 && promised < never;
    };
    for (const double sign : {1.0, -1.0}) {
      check(OutsideDisc<BoundedPoint>{p, q, r, sign}, OutsideDisc<PlaneMotion<1>>{a, b, c, sign});
      check(PairRadius<BoundedPoint>{p, q, 0.6, sign}, PairRadius<PlaneMotion<1>>{a, b, 0.6, sign});
      check(CircleRadius<BoundedPoint>{p, q, r, 0.8, sign}, CircleRadius<PlaneMotion<1>>{a, b, c, 0.8, sign});
    }
  }
  CHECK(late == 0);
  CHECK(ends > 200);
}

}  // namespace test_empty_disc
