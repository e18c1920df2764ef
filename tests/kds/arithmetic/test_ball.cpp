// Balls: the exact value of an expression always lies within the radius of the middle.
#include "kds/arithmetic/ball.hpp"
#include "kds/motion.hpp"
#include "tests/support/exact_rational.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <vector>

namespace test_ball {
namespace {

using kds::Ball;
using kds::DoubleDouble;
using kds::tests::Random;
using oracle::Rational;
using oracle::rational;

constexpr double largest = std::numeric_limits<double>::max();
constexpr double least = std::numeric_limits<double>::denorm_min();

Rational exact(double x) { return rational(x); }
Rational exact(const DoubleDouble& x) { return rational(x.high) + rational(x.low); }

bool finite(const Ball<double>& a) { return std::isfinite(a.middle) && std::isfinite(a.radius); }
bool finite(const Ball<DoubleDouble>& a) {
  return std::isfinite(a.middle.high) && std::isfinite(a.middle.low) && std::isfinite(a.radius);
}

/// A ball with the number it stands for.
template <class T>
struct Known {
  Ball<T> ball;
  Rational value;
};

template <class T>
Known<T> random_step(Random& random, const std::vector<Known<T>>& numbers, double x) {
  const auto& a = numbers[random.below(numbers.size())];
  const auto& b = numbers[random.below(numbers.size())];
  switch (random.below(7)) {
    case 0:
      return {a.ball + b.ball, a.value + b.value};
    case 1:
      return {a.ball - b.ball, a.value - b.value};
    case 2:
      return {a.ball * b.ball, a.value * b.value};
    case 3:
      return {-a.ball, -a.value};
    case 4:
      return {a.ball + x, a.value + rational(x)};
    case 5:
      return {a.ball - x, a.value - rational(x)};
    default:
      return {a.ball * x, a.value * rational(x)};
  }
}

struct Tally {
  int decided = 0;
  int undecided = 0;
  int overflown = 0;
};

/// Grows expressions from random doubles and looks at every result on the way.
template <class T, class Draw>
Tally check_containment(std::uint64_t seed, int rounds, Draw&& draw) {
  CAPTURE(seed);
  Random random(seed);
  Tally tally;
  for (int round = 0; round < rounds; ++round) {
    std::vector<Known<T>> numbers;
    for (int i = 0; i < 4; ++i) {
      const double x = draw(random);
      numbers.push_back({Ball<T>(x), rational(x)});
    }
    for (int step = 0; step < 14; ++step) {
      const Known<T> next = random_step(random, numbers, draw(random));
      const int sign = certain_sign(next.ball);
      const bool sign_is_right = sign == 0 || sign == next.value.sign();
      bool contained = true;
      if (finite(next.ball)) {
        contained = abs(next.value - exact(next.ball.middle)) <= rational(next.ball.radius * Ball<T>::slack);
        if (next.ball.is_zero()) contained = contained && next.value.sign() == 0;
        if (next.value.sign() != 0) ++(sign != 0 ? tally.decided : tally.undecided);
        // Products of products of products would only make the exact numbers long.
        if (step < 8) numbers.push_back(next);
      } else {
        ++tally.overflown;
      }
      if (!sign_is_right || !contained) {
        CAPTURE(round, step, next.ball.radius, sign, next.value.sign());
        CHECK(sign_is_right);
        CHECK(contained);
      }
    }
  }
  return tally;
}

}  // namespace

TEMPLATE_TEST_CASE("a ball contains the exact value of its expression", "[ball]", double, DoubleDouble) {
  SECTION("numbers of moderate size") {
    const Tally tally = check_containment<TestType>(30, 800, [](Random& r) { return r.scaled(-20, 20); });
    CHECK(tally.decided > 8000);
    CHECK(tally.overflown == 0);
  }
  SECTION("numbers that cancel") {
    const Tally tally = check_containment<TestType>(
        31, 800, [](Random& r) { return (r.one_in(2) ? 1 : -1) * (1 + r.integer(-3, 3) * 0x1p-52); });
    CHECK(tally.decided > 2000);
  }
  SECTION("numbers of few bits, many of them zero") {
    const Tally tally = check_containment<TestType>(32, 800, [](Random& r) { return r.one_in(3) ? 0.0 : r.coarse(); });
    CHECK(tally.decided > 2000);
  }
  SECTION("numbers near the least") {
    const Tally tally = check_containment<TestType>(33, 400, [](Random& r) { return r.scaled(-1074, -1000); });
    CHECK(tally.decided > 300);
  }
  SECTION("products that underflow") {
    const Tally tally = check_containment<TestType>(34, 400, [](Random& r) { return r.scaled(-560, -400); });
    CHECK(tally.decided > 300);
    CHECK(tally.undecided > 300);
  }
  SECTION("numbers between which two parts of a product part from the range") {
    check_containment<TestType>(35, 400,
                                [](Random& r) { return r.one_in(2) ? r.scaled(-1000, -900) : r.scaled(-10, 60); });
  }
  SECTION("numbers near the largest") {
    const Tally tally = check_containment<TestType>(36, 400, [](Random& r) { return r.scaled(900, 1022); });
    CHECK(tally.overflown > 300);
  }
  SECTION("numbers from the whole range") {
    check_containment<TestType>(37, 300, [](Random& r) { return r.any(); });
  }
}

TEST_CASE("a ball decides a sign only where it excludes zero", "[ball]") {
  CHECK(certain_sign(Ball<double>(1, 0.5)) == 1);
  CHECK(certain_sign(Ball<double>(-1, 0.5)) == -1);
  CHECK(certain_sign(Ball<double>(1, 1)) == 0);
  CHECK(certain_sign(Ball<double>(1, 2)) == 0);
  CHECK(certain_sign(Ball<double>(0, 0)) == 0);
  CHECK(certain_sign(Ball<double>(least)) == 1);
  CHECK(certain_sign(Ball<double>(-largest)) == -1);
  CHECK(certain_sign(Ball<DoubleDouble>(DoubleDouble(1, 1e-20), 0.5)) == 1);
  const double nan = std::nan("");
  CHECK(certain_sign(Ball<double>(nan, 0)) == 0);
  CHECK(certain_sign(Ball<double>(1, nan)) == 0);
  CHECK(certain_sign(Ball<double>(1, std::numeric_limits<double>::infinity())) == 0);
}

TEST_CASE("doubles are exact, and the difference of two in double-doubles too", "[ball]") {
  CHECK(Ball<double>(0.1).radius == 0);
  CHECK(Ball<DoubleDouble>(0.1).radius == 0);
  const auto apart = kds::difference<Ball<DoubleDouble>>(1.0, 0x1p-80);
  CHECK(apart.radius == 0);
  CHECK(exact(apart.middle) == rational(1) - rational(0x1p-80));
  const auto rounded = kds::difference<Ball<double>>(1.0, 0x1p-80);
  CHECK(rounded.radius > 0);
}

TEST_CASE("a ball is small: its radius is a few roundings of what went in", "[ball]") {
  // Not a law, but what makes it worth having.
  Ball<double> sum(0.0);
  for (int i = 1; i <= 10; ++i) sum = sum + Ball<double>(1.0 / i) * 3.0;
  CHECK(sum.radius < 100 * 0x1p-52);
  Ball<DoubleDouble> extended(0.0);
  for (int i = 1; i <= 10; ++i) extended = extended + Ball<DoubleDouble>(1.0 / i) * 3.0;
  CHECK(extended.radius < 200 * 0x1p-101);
}

TEST_CASE("the absolute value of a ball contains that of the number", "[ball]") {
  for (const double middle : {3.0, -3.0, 1e-20, -1e-20, 0.0}) {
    for (const double radius : {0.0, 1.0}) {
      const auto ball = absolute(Ball<double>(middle, radius));
      for (const double x : {middle - radius, middle, middle + radius}) {
        CHECK(std::abs(std::abs(x) - ball.middle) <= ball.radius);
      }
    }
  }
  CHECK(absolute(Ball<DoubleDouble>(DoubleDouble(-1, 1e-20), 0)).middle.low == -1e-20);
}

}  // namespace test_ball
