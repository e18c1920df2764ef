#include "kds/arithmetic/rounded_sine_cosine.hpp"

#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstdint>

namespace test_rounded_sine_cosine {

using namespace kds;
using tests::Random;

/// Of any size: the exponents are alike.
Ball<DoubleDouble> random_angle(Random& random) {
  const double high = random.between(-1, 1) * std::exp2(random.between(-70, 42));
  return {fast_two_sum(high, 0x1p-53 * high * random.between(-1, 1)), 0x1p-100 * std::abs(high)};
}

void check_same(const Ball<DoubleDouble>& angle) {
  const auto rounded = rounded_sine_cosine(angle);
  const auto of_all_bits = sine_cosine<Ball<DoubleDouble>>(angle);
  CAPTURE(angle.middle.high, angle.middle.low);
  REQUIRE(rounded.sine == of_all_bits.sine.middle.high);
  REQUIRE(rounded.cosine == of_all_bits.cosine.middle.high);
}

TEST_CASE("the sine and the cosine rounded to doubles are those of double-doubles") {
  for (const std::uint64_t seed : {1, 2, 3}) {
    Random random(seed);
    for (int i = 0; i < 20'000; ++i) check_same(random_angle(random));
  }
  for (const double angle : {0.0, 0x1p-1074, 0x1p-500, 0x1p-60, 0.785, 0.786, 1.5707963267948966, 3.14, 1e12, 1e13}) {
    check_same(angle);
    check_same(-angle);
  }
}

TEST_CASE("the sine and the cosine of angles at and between those of a table are rounded, too") {
  for (int j = -27 * 64; j <= 27 * 64; ++j) {
    const double high = j / 2048.0;  // the table has each 64th of them; half-way between two the nearest one changes
    for (const double low : {0.0, 0x1p-60 * high, -0x1p-60 * high, 0x1p-105 * high}) {
      for (const double moved : {high, std::nextafter(high, 1.0), std::nextafter(high, -1.0)}) {
        check_same({fast_two_sum(moved, low), 0x1p-100 * std::abs(high)});
      }
    }
  }
}

TEST_CASE("what is left to double-doubles is little, and the bound of the others is one") {
  Random random(1);
  int left = 0;
  constexpr int angles = 100'000;
  for (int i = 0; i < angles; ++i) {
    const double high = random.between(-0.786, 0.786);
    const DoubleDouble r = fast_two_sum(high, 0x1p-54 * high * random.between(-1, 1));
    const auto [sine, cosine] = detail::approximately_near_zero(r);
    const auto of_all_bits = detail::near_zero(r);
    REQUIRE(std::abs((sine.value - of_all_bits.sine).high) <= sine.error / 2);
    REQUIRE(std::abs((cosine.value - of_all_bits.cosine).high) <= cosine.error / 2);
    left += !(sine.rounds_surely() && cosine.rounds_surely());
  }
  CHECK(left > 0);
  CHECK(left < angles / 100);
}

}  // namespace test_rounded_sine_cosine
