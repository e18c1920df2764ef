// Roots of double-doubles against exact squares.
#include "kds/arithmetic/exact.hpp"
#include "kds/arithmetic/square_root.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstdint>
#include <limits>

namespace test_square_root {
namespace {

using namespace kds;
using kds::tests::Random;

Exact exact(const DoubleDouble& a) { return Exact(a.high) + Exact(a.low); }
Exact square(const Exact& a) { return a * a; }

}  // namespace

TEST_CASE("the root of a double-double is within its radius", "[square_root]") {
  const std::uint64_t seed = 360;
  CAPTURE(seed);
  Random random(seed);
  int wrong = 0;
  for (int round = 0; round < 20000; ++round) {
    const double high = std::abs(random.scaled(-300, 300));
    const DoubleDouble a = fast_two_sum(high, high * random.between(-1, 1) * 0x1p-53);
    const double radius = random.one_in(2) ? 0 : high * 0x1p-70;
    const auto root = square_root(Ball<DoubleDouble>(a, radius));
    const Exact low = exact(root.middle) - Exact(root.radius);
    const Exact up = exact(root.middle) + Exact(root.radius);
    wrong += (exact(a) - Exact(radius) - square(low)).sign() < 0 || (square(up) - exact(a) - Exact(radius)).sign() < 0;
    wrong += radius == 0 && root.radius > 0x1p-101 * root.middle.high;
  }
  CHECK(wrong == 0);
}

TEST_CASE("roots of squares are exact, and what is out of range has none", "[square_root]") {
  CHECK(square_root(Ball<DoubleDouble>(DoubleDouble(169.0), 0)).middle.high == 13);
  CHECK(square_root(Ball<DoubleDouble>(0.0)).is_zero());
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (const double a : {-1.0, 1e-290, infinity, std::numeric_limits<double>::quiet_NaN()}) {
    CHECK(square_root(Ball<DoubleDouble>(DoubleDouble(a), 0)).radius == infinity);
  }
  CHECK(square_root(Ball<DoubleDouble>(DoubleDouble(1.0), 0.5)).radius == infinity);
}

}  // namespace test_square_root
