// Motions: written about their own start, shifted to any epoch without loss.
#include "kds/motion.hpp"
#include "tests/support/exact_rational.hpp"
#include "tests/support/random_numbers.hpp"
#include "tests/support/same_number.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <limits>

namespace test_motion {
namespace {

using namespace kds;
using kds::tests::Random;
using oracle::Rational;
using oracle::rational;

template <int Degree>
Motion<Degree> any_motion(Random& random) {
  Motion<Degree> motion;
  const bool coarse = random.one_in(3);
  for (double& c : motion.position.c) c = coarse ? random.coarse() : random.scaled(-30, 30);
  motion.start = random.one_in(3) ? 1e9 + random.coarse() : random.scaled(-20, 20);
  return motion;
}

template <int Degree>
Rational value(const Motion<Degree>& motion, const Rational& t) {
  Rational sum = 0;
  const Rational elapsed = t - rational(motion.start);
  for (int i = Degree; i >= 0; --i) sum = sum * elapsed + rational(motion.position.c[static_cast<std::size_t>(i)]);
  return sum;
}

}  // namespace

#define FOR_EACH_DEGREE ((int Degree), Degree), 0, 1, 2, 3, 4, 6

TEMPLATE_TEST_CASE_SIG("a motion about any epoch is the same function, exactly", "[motion]", FOR_EACH_DEGREE) {
  const std::uint64_t seed = 40;
  CAPTURE(Degree, seed);
  Random random(seed);
  for (int round = 0; round < 200; ++round) {
    const auto motion = any_motion<Degree>(random);
    const double epoch = random.one_in(4) ? motion.start : random.scaled(-20, 31);
    const auto shifted = about<Exact>(motion, epoch);
    // Degree + 1 points fix a polynomial; one more for the test's own sake.
    for (int i = 0; i < Degree + 2; ++i) {
      const double x = random.integer(-9, 9) * 0.37;
      CAPTURE(round, epoch, x, motion.start);
      REQUIRE(oracle::same(shifted(Exact(x)), value(motion, rational(epoch) + rational(x))));
    }
  }
}

TEMPLATE_TEST_CASE_SIG("a motion about an epoch is contained in its balls", "[motion]", FOR_EACH_DEGREE) {
  const std::uint64_t seed = 41;
  CAPTURE(Degree, seed);
  Random random(seed);
  for (int round = 0; round < 200; ++round) {
    const auto motion = any_motion<Degree>(random);
    const auto other = any_motion<Degree>(random);
    const double epoch = random.one_in(4) ? motion.start : random.scaled(-20, 31);
    const auto check = [&](const auto& exact, const auto& balls, const auto& extended) {
      for (std::size_t i = 0; i <= Degree; ++i) {
        const Exact from_double = exact.c[i] - Exact(balls.c[i].middle);
        const Exact from_extended = exact.c[i] - Exact(extended.c[i].middle.high) - Exact(extended.c[i].middle.low);
        const Exact double_radius(balls.c[i].radius * Ball<double>::slack);
        const Exact extended_radius(extended.c[i].radius * Ball<double>::slack);
        CAPTURE(round, epoch, i);
        REQUIRE((from_double - double_radius).sign() <= 0);
        REQUIRE((from_double + double_radius).sign() >= 0);
        REQUIRE((from_extended - extended_radius).sign() <= 0);
        REQUIRE((from_extended + extended_radius).sign() >= 0);
      }
    };
    check(about<Exact>(motion, epoch), about<Ball<double>>(motion, epoch), about<Ball<DoubleDouble>>(motion, epoch));
    check(difference_about<Exact>(motion, other, epoch), difference_about<Ball<double>>(motion, other, epoch),
          difference_about<Ball<DoubleDouble>>(motion, other, epoch));
  }
}

TEMPLATE_TEST_CASE_SIG("a difference of motions is the difference of the two", "[motion]", FOR_EACH_DEGREE) {
  const std::uint64_t seed = 42;
  CAPTURE(Degree, seed);
  Random random(seed);
  for (int round = 0; round < 200; ++round) {
    const auto a = any_motion<Degree>(random);
    auto b = any_motion<Degree>(random);
    if (random.one_in(2)) b.start = a.start;  // subtracted before the shift
    const double epoch = random.scaled(-20, 31);
    const auto difference = difference_about<Exact>(a, b, epoch);
    const auto expected = about<Exact>(a, epoch) - about<Exact>(b, epoch);
    for (std::size_t i = 0; i <= Degree; ++i) {
      CAPTURE(round, epoch, i);
      REQUIRE((difference.c[i] - expected.c[i]).sign() == 0);
    }
    const auto itself = difference_about<Exact>(a, a, epoch);
    for (std::size_t i = 0; i <= Degree; ++i) REQUIRE(itself.c[i].sign() == 0);
  }
}

TEST_CASE("a motion is as accurate at clock 1e9 as at 0", "[motion]") {
  const Polynomial<2> fall{{10, -3, 4.905}};
  const Motion<2> early{fall, 0};
  const Motion<2> late{fall, 1e9};
  for (const double elapsed : {0.0, 0.125, 0.75, 2.5}) {
    CHECK(late(1e9 + elapsed) == early(elapsed));
    const auto a = about<double>(early, elapsed);
    const auto b = about<double>(late, 1e9 + elapsed);
    CHECK(a == b);
    const auto ball = about<Ball<double>>(late, 1e9 + elapsed);
    CHECK(ball.c[0].radius < 1e-13);  // written about 0 it would have lost eighteen digits
  }
}

TEST_CASE("a motion restarted at its start is itself", "[motion]") {
  const Motion<3> motion{{{0.1, 0.2, 0.3, 0.4}}, 0.7};
  CHECK(restarted(motion, 0.7) == motion);
  const auto later = restarted(motion, 1.7);
  CHECK(later.start == 1.7);
  CHECK(later.position.c[0] == Approx(0.1 + 0.2 + 0.3 + 0.4));
  CHECK(later.position.c[1] == Approx(0.2 + 2 * 0.3 + 3 * 0.4));
  CHECK(later.position.c[2] == Approx(0.3 + 3 * 0.4));
  CHECK(later.position.c[3] == 0.4);
}

TEMPLATE_TEST_CASE_SIG("a restarted motion differs by roundings", "[motion]", FOR_EACH_DEGREE) {
  const std::uint64_t seed = 43;
  CAPTURE(Degree, seed);
  Random random(seed);
  for (int round = 0; round < 200; ++round) {
    Motion<Degree> motion;
    for (double& c : motion.position.c) c = random.between(-1, 1);
    motion.start = random.between(-1, 1);
    const double t = motion.start + random.between(0, 1);
    const auto later = restarted(motion, t);
    const double at = t + random.between(0, 1);
    CAPTURE(round, t, at);
    CHECK(later(at) == Approx(motion(at)).margin(1e-13));
    CHECK(abs(value(later, rational(t)) - value(motion, rational(t))) < rational(1e-14));
  }
}

TEST_CASE("the value of a motion counts from its start", "[motion]") {
  const Motion<2> motion{{{1, 2, 3}}, 5};
  CHECK(motion(5) == 1);
  CHECK(motion(6) == 6);
  CHECK(motion(4) == 2);
  CHECK(Motion<0>{{{7}}, 1e9}(0) == 7);
}

TEST_CASE("motions that are not finite are told", "[motion]") {
  const double nan = std::nan("");
  const double infinity = std::numeric_limits<double>::infinity();
  CHECK(is_finite(Motion<2>{{{1, 2, 3}}, 4}));
  CHECK(is_finite(Motion<2>{{{std::numeric_limits<double>::max(), 0, -0.0}}, 0x1p-1074}));
  for (const double bad : {nan, infinity, -infinity}) {
    for (std::size_t i = 0; i <= 2; ++i) {
      Motion<2> motion;
      motion.position.c[i] = bad;
      CHECK_FALSE(is_finite(motion));
    }
    CHECK_FALSE(is_finite(Motion<2>{{}, bad}));
  }
}

#undef FOR_EACH_DEGREE

}  // namespace test_motion
