#include "certificates/positive_parabola.hpp"
#include "kds/arithmetic/exact.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstdint>

namespace kds::certificates::test_positive_parabola {
namespace {

/// With numbers of magnitudes from 2^least to 2^greatest, and small whole ones.
void check_against_exact_signs(int least, int greatest) {
  constexpr std::uint64_t seed = 1;
  tests::Random random(seed);
  int wrong = 0;
  int short_of = 0;
  int roots = 0;
  for (int i = 0; i < 100'000; ++i) {
    const bool coarse = i % 2 != 0;
    const auto number = [&] { return coarse ? random.coarse() : random.scaled(least, greatest); };
    const double c0 = std::abs(number());
    double c1 = number();
    const double c2 = random.one_in(5) ? 0 : number();
    if (random.one_in(5) && c0 * c2 > 0) c1 = -2 * std::sqrt(c0 * c2);  // a double root, nearly
    const double s = positive_for(c0, c1, c2);
    REQUIRE(s >= 0);
    if (c0 == 0) {
      wrong += s != 0;
      continue;
    }
    const auto positive_at = [&](double x) {
      return (Exact(c0) + Exact(x) * (Exact(c1) + Exact(x) * Exact(c2))).sign() > 0;
    };
    if (s == never) {
      // No root: it opens upward, and either rises or stays above.
      const bool rises = c1 >= 0 && c2 >= 0;
      const bool above = (Exact(c1) * Exact(c1) - Exact(4) * Exact(c0) * Exact(c2)).sign() < 0;
      wrong += !rises && !above;
      continue;
    }
    wrong += !positive_at(s) || !positive_at(s / 2);
    ++roots;
    // A discriminant of more than a tenth of the square of c1.
    const bool simple = (Exact(9) * Exact(c1) * Exact(c1) - Exact(40) * Exact(c0) * Exact(c2)).sign() > 0;
    short_of += simple && positive_at(s * 1.001);
  }
  INFO("seed " << seed);
  CHECK(wrong == 0);
  CHECK(short_of == 0);
  CHECK(roots > 10'000);
}

TEST_CASE("A parabola is positive for as long as is told, and not for much longer", "[positive_parabola]") {
  check_against_exact_signs(-20, 20);
}

TEST_CASE("A parabola whose products are below the range of doubles is positive for as long", "[positive_parabola]") {
  check_against_exact_signs(-1000, 0);
  check_against_exact_signs(-600, -450);
}

TEST_CASE("A parabola that is zero or too large to tell is positive for no time", "[positive_parabola]") {
  CHECK(positive_for(0, 1, 1) == 0);
  CHECK(positive_for(-1, 1, 1) == 0);
  CHECK(positive_for(NAN, 1, 1) == 0);
  CHECK(positive_for(1, 0, 0) == never);
  CHECK(positive_for(1e300, -1e300, 1e300) == 0);
}

}  // namespace
}  // namespace kds::certificates::test_positive_parabola
