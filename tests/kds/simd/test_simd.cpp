// Lanes: each what a number alone would be, and the same bits with intrinsics and without.
#include "kds/simd/four_doubles.hpp"
#include "kds/simd/four_floats.hpp"
#include "kds/simd/portable.hpp"
#include "kds/simd/target.hpp"
#include "kds/simd/two_doubles.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace test_simd {
namespace {

using namespace kds;
using kds::tests::Random;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Any number, many of them of the kinds that comparisons treat in a way of their own; often the same twice.
double number(Random& random) {
  constexpr std::array special{0.0, -0.0, infinity, -infinity, nan, 1.0, -1.0};
  return random.one_in(2) ? special[random.below(special.size())] : random.any();
}
float small_number(Random& random) {
  const double x = number(random);
  return static_cast<float>(std::abs(x) < 1e30 || !std::isfinite(x) ? x : random.scaled(-80, 80));
}

bool same(double x, double y) { return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y); }
bool same(float x, float y) { return std::bit_cast<std::uint32_t>(x) == std::bit_cast<std::uint32_t>(y); }
bool same(Two x, Two y) { return same(x[0], y[0]) && same(x[1], y[1]); }
bool same(FourFloats x, FourFloats y) {
  return same(x[0], y[0]) && same(x[1], y[1]) && same(x[2], y[2]) && same(x[3], y[3]);
}

}  // namespace

TEST_CASE("lanes give what a number alone does", "[simd]") {
  const std::uint64_t seed = 11;
  CAPTURE(seed);
  Random random(seed);
  for (int i = 0; i < 4000; ++i) {
    const Two x{number(random), number(random)};
    const Two y{number(random), random.one_in(3) ? x[1] : number(random)};
    const FourFloats u{small_number(random), small_number(random), small_number(random), small_number(random)};
    const FourFloats v{small_number(random), small_number(random), u[2], small_number(random)};
    unsigned below = 0;
    unsigned below_of_four = 0;
    for (int lane = 0; lane < 2; ++lane) {
      CAPTURE(x[lane], y[lane]);
      REQUIRE(same(lesser(x, y)[lane], x[lane] < y[lane] ? x[lane] : y[lane]));
      REQUIRE(same(greater(x, y)[lane], x[lane] > y[lane] ? x[lane] : y[lane]));
      REQUIRE(same(magnitude(x)[lane], std::abs(x[lane])));
      if (x[lane] >= 0) REQUIRE(same(square_root(x)[lane], std::sqrt(x[lane])));
      below |= unsigned{x[lane] < y[lane]} << lane;
    }
    for (int lane = 0; lane < 4; ++lane) {
      CAPTURE(u[lane], v[lane]);
      REQUIRE(same(lesser(u, v)[lane], u[lane] < v[lane] ? u[lane] : v[lane]));
      REQUIRE(same(greater(u, v)[lane], u[lane] > v[lane] ? u[lane] : v[lane]));
      REQUIRE(same(magnitude(u)[lane], std::abs(u[lane])));
      if (u[lane] >= 0) REQUIRE(same(square_root(u)[lane], std::sqrt(u[lane])));
      REQUIRE(same(where(u < v, u, v)[lane], u[lane] < v[lane] ? u[lane] : v[lane]));
      REQUIRE(same(where(u < v, u)[lane], u[lane] < v[lane] ? u[lane] : 0.0F));
      if (!std::isnan(u[lane])) REQUIRE(same(signed_by(u, v)[lane], std::signbit(u[lane]) ? -v[lane] : v[lane]));
      below_of_four |= unsigned{u[lane] < v[lane]} << lane;
    }
    REQUIRE(set_of_two(x < y) == below);
    REQUIRE(set_of_four(u < v) == below_of_four);
    REQUIRE(all_set(u < v) == (below_of_four == 15));
  }
}

TEST_CASE("intrinsics and what is portable give the same bits", "[simd]") {
  const std::uint64_t seed = 12;
  CAPTURE(seed);
  Random random(seed);
  std::array<int, 9> shared{};
  std::array<int, 5> within{};
  for (int i = 0; i < 4000; ++i) {
    const Two x{number(random), number(random)};
    const Two y{number(random), number(random)};
    const FourFloats u{small_number(random), small_number(random), small_number(random), small_number(random)};
    const FourFloats v{small_number(random), small_number(random), small_number(random), small_number(random)};
    REQUIRE(same(simd::target::lesser(x, y), simd::portable::lesser(x, y)));
    REQUIRE(same(simd::target::greater(x, y), simd::portable::greater(x, y)));
    REQUIRE(same(simd::target::lesser(u, v), simd::portable::lesser(u, v)));
    REQUIRE(same(simd::target::greater(u, v), simd::portable::greater(u, v)));
    REQUIRE(simd::target::set_of_two(x < y) == simd::portable::set_of_two(x < y));
    REQUIRE(simd::target::set_of_four(u <= v) == simd::portable::set_of_four(u <= v));
    const FourFloats lengths = magnitude(u);
    if (all_set(lengths >= splat(0))) {
      REQUIRE(same(simd::target::square_root(lengths), simd::portable::square_root(lengths)));
    }
    const Two positive = magnitude(x);
    if (positive[0] >= 0 && positive[1] >= 0) {
      REQUIRE(same(simd::target::square_root(positive), simd::portable::square_root(positive)));
    }

    alignas(64) std::array<double, 8> times;
    const bool coarse = random.one_in(2);
    for (double& time : times) time = random.one_in(8) ? infinity : coarse ? random.integer(0, 3) : random.unit();
    const LeastOfEight least = simd::target::least_of_eight(times.data());
    const LeastOfEight expected = simd::portable::least_of_eight(times.data());
    REQUIRE(same(least.value, expected.value));
    REQUIRE(least.who == expected.who);
    ++shared[static_cast<std::size_t>(std::popcount(least.who) / 2)];

    alignas(16) std::array<EightBytes, 4> ends;
    const auto bytes = [&](int low, int high) {
      EightBytes all = 0;
      for (int byte = 0; byte < 8; ++byte) {
        all |= EightBytes{static_cast<std::uint8_t>(random.integer(low, high))} << 8 * byte;
      }
      return all;
    };
    for (EightBytes& end : ends) end = random.one_in(2) ? bytes(-126, 57) : bytes(-126, 126);
    const EightBytes limits = bytes(55, 126);
    REQUIRE(simd::target::within_limits(ends.data(), limits) == simd::portable::within_limits(ends.data(), limits));
    ++within[static_cast<std::size_t>(std::popcount(simd::portable::within_limits(ends.data(), limits)))];
  }
  CHECK(shared[1] > 100);
  CHECK(shared[2] > 100);
  for (int count = 0; count < 4; ++count) CHECK(within[static_cast<std::size_t>(count)] > 50);
}

TEST_CASE("four doubles in two registers are four doubles", "[simd]") {
  const std::uint64_t seed = 13;
  CAPTURE(seed);
  Random random(seed);
  for (int i = 0; i < 1000; ++i) {
    std::array<double, 4> a, b;
    for (double& x : a) x = random.coarse();
    for (double& x : b) x = random.coarse();
    const FourDoubles x(a[0], a[1], a[2], a[3]);
    const FourDoubles y(b[0], b[1], b[2], b[3]);
    for (std::size_t lane = 0; lane < 4; ++lane) {
      REQUIRE((x + y)[lane] == a[lane] + b[lane]);
      REQUIRE((x - y)[lane] == a[lane] - b[lane]);
      REQUIRE((x * y)[lane] == a[lane] * b[lane]);
      REQUIRE((-x)[lane] == -a[lane]);
      REQUIRE(magnitude(x)[lane] == std::abs(a[lane]));
      REQUIRE(next(x)[lane] == a[(lane + 1) % 4]);
      REQUIRE(where_greater(x, y, x + y, x - y)[lane] == (a[lane] > b[lane] ? a[lane] + b[lane] : a[lane] - b[lane]));
    }
    REQUIRE(sum_of(x) == a[0] + a[1] + a[2] + a[3]);  // exact, so that their order does not matter
    REQUIRE(lowest(x) == *std::min_element(a.begin(), a.end()));
    REQUIRE(highest(x) == *std::max_element(a.begin(), a.end()));
    const FourFloats f{static_cast<float>(a[0]), static_cast<float>(a[1]), static_cast<float>(a[2]),
                       static_cast<float>(a[3])};
    REQUIRE(static_cast<double>(lowest(f)) == lowest(x));
    REQUIRE(static_cast<double>(highest(f)) == highest(x));
  }
}

}  // namespace test_simd
