// Error-free transformations and double-double operations against exact arithmetic.
#include "kds/arithmetic/double_double.hpp"
#include "tests/support/exact_rational.hpp"
#include "tests/support/random_numbers.hpp"
#include "tests/support/sanitized.hpp"

#include <catch2/catch.hpp>

#include <cmath>

namespace test_double_double {
namespace {

using kds::DoubleDouble;
using kds::tests::Random;
using oracle::Rational;
using oracle::rational;

Rational exact(const DoubleDouble& a) { return rational(a.high) + rational(a.low); }

bool normalised(const DoubleDouble& a) { return a.high + a.low == a.high; }

/// Whether the result is the truth up to 2^-102 of it.
bool close(const DoubleDouble& result, const Rational& truth) {
  return abs(exact(result) - truth) <= abs(truth) * oracle::power_of_two(-102);
}

/// Two doubles of one size or of two; or nearly opposite, so that their sum cancels.
struct Pair {
  double a, b;
};
Pair random_pair(Random& random, int low, int high) {
  Pair pair{random.scaled(low, high), 0};
  switch (random.below(4)) {
    case 0:
      pair.b = random.scaled(low, high);
      break;
    case 1:
      pair.b = std::ldexp(pair.a, random.integer(-60, 0)) * random.between(-1, 1);
      break;
    case 2:
      pair.b = -pair.a * (1 + random.integer(-4, 4) * 0x1p-52);
      break;
    default:
      pair.b = random.coarse();
  }
  return pair;
}

DoubleDouble random_double_double(Random& random, int low, int high) {
  const double first = random.scaled(low, high);
  return kds::fast_two_sum(first, first * random.between(-1, 1) * std::ldexp(1.0, -random.integer(52, 80)));
}

struct Operands {
  DoubleDouble a, b;
};
Operands random_operands(Random& random) {
  Operands o{random_double_double(random, -60, 60), random_double_double(random, -60, 60)};
  if (random.one_in(2)) {  // cancelling
    o.b = -o.a;
    o.b.low += o.b.low * random.between(-1, 1);
    if (random.one_in(2)) o.b = kds::fast_two_sum(o.b.high * (1 + random.integer(-2, 2) * 0x1p-52), o.b.low);
  }
  if (random.one_in(8)) o.b.low = 0;
  return o;
}

}  // namespace

TEST_CASE("two_sum and two_product lose nothing", "[double_double]") {
  const std::uint64_t seed = 10;
  CAPTURE(seed);
  Random random(seed);
  for (int i = 0; i < kds::tests::rounds_here(20000); ++i) {
    const auto [a, b] = random_pair(random, -300, 300);
    INFO(std::hexfloat << a << ", " << b);
    const DoubleDouble sum = kds::two_sum(a, b);
    const DoubleDouble product = kds::two_product(a, b);
    const bool sum_is_right = sum.high == a + b && exact(sum) == rational(a) + rational(b);
    const bool product_is_right = product.high == a * b && exact(product) == rational(a) * rational(b);
    if (!sum_is_right) CHECK(sum_is_right);
    if (!product_is_right) CHECK(product_is_right);
    const bool ordered = std::abs(a) >= std::abs(b);
    const DoubleDouble fast = ordered ? kds::fast_two_sum(a, b) : kds::fast_two_sum(b, a);
    if (exact(fast) != exact(sum)) CHECK(exact(fast) == exact(sum));
  }
  SUCCEED();
}

TEST_CASE("two_sum is exact over the whole range, below the normal numbers too", "[double_double]") {
  const std::uint64_t seed = 11;
  CAPTURE(seed);
  Random random(seed);
  for (int i = 0; i < kds::tests::rounds_here(20000); ++i) {
    const double a = random.scaled(-1074, 1000);
    const double b = random.one_in(2) ? random.scaled(-1074, 1000) : random.scaled(-1074, -1000);
    const DoubleDouble sum = kds::two_sum(a, b);
    if (exact(sum) != rational(a) + rational(b)) {
      INFO(std::hexfloat << a << ", " << b);
      CHECK(exact(sum) == rational(a) + rational(b));
    }
  }
  const double least = 0x1p-1074;
  CHECK(exact(kds::two_sum(1, least)) == rational(1) + rational(least));
  CHECK(kds::two_sum(0.0, 0.0).high == 0);
}

TEST_CASE("operations on double-doubles are right to 2^-102 and keep the parts apart", "[double_double]") {
  const std::uint64_t seed = 12;
  CAPTURE(seed);
  Random random(seed);
  int cancelled = 0;
  for (int i = 0; i < kds::tests::rounds_here(20000); ++i) {
    const auto [a, b] = random_operands(random);
    const double x = random.one_in(3) ? -a.high : random.scaled(-60, 60);
    const Rational ra = exact(a);
    const Rational rb = exact(b);
    const Rational rx = rational(x);
    cancelled += abs(ra + rb) < abs(ra) * oracle::power_of_two(-40);
    INFO(std::hexfloat << a.high << " + " << a.low << ", " << b.high << " + " << b.low << ", " << x);
    const auto check = [](const char* what, const DoubleDouble& result, const Rational& truth) {
      if (close(result, truth) && normalised(result)) return;
      INFO(what);
      CHECK(close(result, truth));
      CHECK(normalised(result));
    };
    check("a + b", a + b, ra + rb);
    check("a - b", a - b, ra - rb);
    check("a b", a * b, ra * rb);
    check("a / b", a / b, ra / rb);
    check("a + x", a + x, ra + rx);
    check("a - x", a - x, ra - rx);
    check("x - a", x - a, rx - ra);
    check("a x", a * x, ra * rx);
    check("-a", -a, Rational(0) - ra);
  }
  CHECK(cancelled > kds::tests::rounds_here(1000));
}

TEST_CASE("a double is a double-double without a low part", "[double_double]") {
  const DoubleDouble a = 0.1;
  CHECK(a.high == 0.1);
  CHECK(a.low == 0);
  CHECK(static_cast<double>(a) == 0.1);
  CHECK(kds::magnitude(DoubleDouble(-2, 1e-20)) == 2);
  CHECK(kds::magnitude(-2.0) == 2);
  const DoubleDouble third = DoubleDouble(1.0) / 3.0;
  CHECK(third.low != 0);
  CHECK(close(third, Rational(1) / Rational(3)));
}

}  // namespace test_double_double
