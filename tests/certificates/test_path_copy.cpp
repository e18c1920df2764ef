// Certificates of copies of points that are displaced by whole periods, against exact numbers.
#include "certificates/path_copy.hpp"
#include "certificates/plane_certificates.hpp"
#include "certificates/plane_motion.hpp"
#include "kds/testing/random.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <cstddef>
#include <cstdint>

namespace test_path_copy {
namespace {

using namespace kds;
using certificates::InCircle;
using certificates::Orientation;
using certificates::PathCopy;
using certificates::PeriodOffset;
using certificates::Periods;
using testing::Random;
using Path = certificates::PlaneMotion<1>;
using Copy = PathCopy<Path>;

Path random_path(Random& random) {
  return {{{{{random.between(-1, 1), random.between(-1, 1)}}, {{random.between(-1, 1), random.between(-1, 1)}}}},
          random.between(-1, 1)};
}

}  // namespace

TEST_CASE("the place of a copy is its point's, displaced by exactly so many periods", "[path_copy]") {
  const std::uint64_t seed = 4200;
  CAPTURE(seed);
  Random random(seed);
  int wrong = 0;
  for (int round = 0; round < 300; ++round) {
    const Path a = random_path(random), b = random_path(random);
    const Periods periods{random.between(0.1, 3), random.between(0.1, 3) * 0x1p-60};
    const auto offset = [&] {
      const int bits = random.integer(0, 51);
      return static_cast<std::int64_t>(random.bits() >> (63 - bits)) * (random.one_in(2) ? 1 : -1);
    };
    const PeriodOffset of_a{offset(), offset()}, of_b{offset(), offset()};
    const Copy from(b, periods, of_b), to(a, periods, of_a);
    const double t = random.between(-5, 5);
    for (const int d : {0, 1}) {
      const auto periods_apart = static_cast<double>(d == 0 ? of_a.x - of_b.x : of_a.y - of_b.y);
      const Exact expected = difference_about<Exact>(a.axis(d), b.axis(d), t).c[0] +
                             Exact(periods_apart) * Exact(periods[static_cast<std::size_t>(d)]);
      const auto in_ball = [&](const Exact& middle, double radius) {
        return (absolute(middle - expected) - Exact(radius * Ball<double>::slack)).sign() <= 0;
      };
      wrong += !(difference_about<Exact>(to.axis(d), from.axis(d), t).c[0] == expected);
      const Ball<double> rough = difference_about<Ball<double>>(to.axis(d), from.axis(d), t).c[0];
      wrong += !in_ball(Exact(rough.middle), rough.radius);
      const Ball<DoubleDouble> fine = extended_difference(to.axis(d), from.axis(d), t);
      wrong += !in_ball(Exact(fine.middle.high) + Exact(fine.middle.low), fine.radius);
    }
  }
  CHECK(wrong == 0);
}

TEST_CASE("certificates of copies know their negatives, wherever the copies are counted from", "[path_copy]") {
  Random random(4300);
  const Path a = random_path(random), b = random_path(random), c = random_path(random);
  const Periods periods{0.75, 1.25};
  const auto copy = [&](const Path& path, std::int64_t x, std::int64_t y) { return Copy(path, periods, {x, y}); };
  // Two of the four are copies of one point.
  const InCircle before{copy(a, 0, 0), copy(b, 2, 1), copy(c, 1, -1), copy(a, 1, 0)};
  const InCircle exchanged{copy(b, 7, 4), copy(a, 5, 3), copy(c, 6, 2), copy(a, 6, 3)};
  CHECK(exchanged.is_negative_of(before));
  CHECK(sign_after(exchanged, 0.5) == -sign_after(before, 0.5));
  const InCircle turned{copy(b, 7, 4), copy(c, 6, 2), copy(a, 5, 3), copy(a, 6, 3)};
  CHECK_FALSE(turned.is_negative_of(before));
  CHECK(sign_after(turned, 0.5) == sign_after(before, 0.5));
  const InCircle elsewhere{copy(b, 7, 4), copy(a, 5, 3), copy(c, 6, 3), copy(a, 6, 3)};
  CHECK_FALSE(elsewhere.is_negative_of(before));
  CHECK_FALSE(before.vanishes());
  CHECK(InCircle{copy(a, 1, 1), copy(b, 0, 0), copy(c, 0, 0), copy(a, 1, 1)}.vanishes());
  const Orientation left{copy(a, 0, 0), copy(a, 1, 0), copy(a, 1, 1)};
  CHECK(sign_after(left, 0) == 1);  // half a rectangle, though all are copies of one point
  CHECK(Orientation{copy(a, 4, 2), copy(a, 3, 2), copy(a, 4, 3)}.is_negative_of(left));
  CHECK_FALSE(Orientation{copy(a, 4, 3), copy(a, 3, 2), copy(a, 4, 2)}.is_negative_of(left));
}

}  // namespace test_path_copy
