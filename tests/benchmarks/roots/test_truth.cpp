// The truth of the root benchmark: roots known by hand, and a second exact method that shares nothing but the numbers.
#include "tests/benchmarks/roots/families.hpp"
#include "tests/benchmarks/roots/truth.hpp"
#include "tests/support/exact_failure_time.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace test_truth {
namespace {

using namespace bench_roots;

constexpr double infinity = std::numeric_limits<double>::infinity();

std::string described(const Family& family, const Coefficients& c) {
  std::ostringstream text;
  text << family.name << std::hexfloat;
  for (const double x : c) text << ' ' << x;
  return text.str();
}

/// The first double just after which the polynomial is negative, as the truth tells it.
double first_double(const Truth& truth, double horizon) {
  const int i = truth.first_failure(horizon);
  if (i == -1) return infinity;
  return i == Truth::root_at_now ? 0 : truth.roots[static_cast<std::size_t>(i)].ceiling();
}

}  // namespace

TEST_CASE("truth: roots known by hand", "[roots]") {
  const Truth cubic = exact_truth(Coefficients{6, -11, 6, -1});  // -(t - 1)(t - 2)(t - 3)
  REQUIRE(cubic.roots.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(cubic.roots[i].high == static_cast<double>(i) + 1);
    CHECK(cubic.roots[i].low == 0);
    CHECK(cubic.roots[i].falling() == (i != 1));
  }
  CHECK(cubic.sign_after_now == 1);

  const Truth third = exact_truth(Coefficients{1, -3});
  REQUIRE(third.roots.size() == 1);
  CHECK(third.roots[0].high == 1.0 / 3);
  CHECK(third.roots[0].low == Approx(std::ldexp(1.0, -54) / 3).epsilon(1e-12));  // 1/3 = its double + 2^-54 / 3
  CHECK(third.roots[0].compare(1.0 / 3) == 1);
  CHECK(third.roots[0].ceiling() == std::nextafter(1.0 / 3, 1));

  const Truth root_of_two = exact_truth(Coefficients{2, 0, -1});
  REQUIRE(root_of_two.roots.size() == 1);
  CHECK(root_of_two.roots[0].high == std::sqrt(2.0));
  CHECK(root_of_two.roots[0].low == Approx(-9.667293313452913e-17).epsilon(1e-12));

  const Truth touch = exact_truth(Coefficients{2, -5, 4, -1});  // -(t - 1)^2 (t - 2)
  REQUIRE(touch.roots.size() == 2);
  CHECK(touch.first_failure(infinity) == 1);
  CHECK(touch.first_failure(2) == 1);
  CHECK(touch.first_failure(std::nextafter(2, 0)) == -1);
}

TEST_CASE("truth: at now, and the ends of the doubles", "[roots]") {
  CHECK(exact_truth(Coefficients{-1, 1}).first_failure(0) == Truth::root_at_now);
  CHECK(exact_truth(Coefficients{0, -1}).first_failure(0) == Truth::root_at_now);
  CHECK(exact_truth(Coefficients{0, 1}).first_failure(infinity) == -1);
  CHECK(exact_truth(Coefficients{0, 0, 0}).first_failure(infinity) == -1);
  CHECK(exact_truth(Coefficients{0, 0, 0}).sign_after_now == 0);
  CHECK(exact_truth(Coefficients{1, -0x1p-1074}).first_failure(infinity) == -1);  // beyond the largest double
  const Truth least = exact_truth(Coefficients{0x1p-1074, -4});
  REQUIRE(least.roots.size() == 1);
  CHECK(least.roots[0].ceiling() == 0x1p-1074);
  const Truth largest = exact_truth(Coefficients{0x1.fffffffffffffp1023, -1, 0});
  REQUIRE(largest.roots.size() == 1);
  CHECK(largest.roots[0].high == 0x1.fffffffffffffp1023);
  CHECK_THROWS_AS(exact_truth(Coefficients{1, infinity}), std::invalid_argument);
}

TEST_CASE("truth: a dip between two neighbouring doubles is not seen", "[roots]") {
  Truth narrow;
  narrow.sign_after_now = 1;
  narrow.roots = {{1, 0x1p-55, 1, -1}, {1, 0x1p-54, -1, 1}, {2, 0, 1, -1}};
  CHECK_FALSE(narrow.seen(0));
  CHECK(narrow.first_failure(infinity) == 2);
  CHECK(narrow.first_failure(1.5) == -1);
  narrow.roots[1] = {1 + 0x1p-52, 0x1p-60, -1, 1};  // now 1 + 2^-52 sees it
  CHECK(narrow.seen(0));
  CHECK(narrow.first_failure(infinity) == 0);
}

TEST_CASE("truth: agrees with a search over the doubles, in every family", "[roots]") {
  const std::uint64_t seed = 7;
  CAPTURE(seed);
  std::string wrong;
  int failures = 0;
  for (int degree = 1; degree <= 8; ++degree) {
    for (const Family& family : families()) {
      if (degree < family.least_degree) continue;
      kds::tests::Random random(seed + static_cast<std::uint64_t>(degree));
      for (int round = 0; round < 3; ++round) {
        const Coefficients c = family.draw(random, degree);
        const Truth truth = exact_truth(c);
        std::vector<oracle::Rational> exact;
        for (const double x : c) exact.push_back(oracle::rational(x));
        for (const double horizon : {infinity, 1.0}) {
          const double expected = oracle::failure_time(exact, 0, 0, horizon);
          failures += expected < infinity;
          if (first_double(truth, horizon) != expected) wrong += described(family, c) + '\n';
        }
      }
    }
  }
  CHECK(wrong == "");
  CHECK(failures > 200);
}

TEST_CASE("families are what they say", "[roots]") {
  const std::uint64_t seed = 11;
  CAPTURE(seed);
  for (const Family& family : families()) {
    CAPTURE(family.name);
    for (int degree = family.least_degree; degree <= 8; ++degree) {
      kds::tests::Random random(seed);
      for (int i = 0; i < 5; ++i) {
        const Coefficients c = family.draw(random, degree);
        REQUIRE(c.size() == static_cast<std::size_t>(degree) + 1);
        const Truth truth = exact_truth(c);
        const std::string name = family.name;
        std::size_t touches = 0;
        for (const ExactRoot& root : truth.roots) touches += root.high > 0 && root.before == root.after;
        if (name == "double" && degree == 2) REQUIRE(touches == 1);
        if (name == "triple" && degree == 3) REQUIRE((truth.roots.size() == 1 && touches == 0));
        if (name == "no-roots") REQUIRE(truth.roots.empty());
        if (name == "at-now") REQUIRE(truth.roots.at(0).high == 0);
        if (name == "after-now") REQUIRE(truth.roots.at(0).high < 1e-5);
      }
    }
  }
}

}  // namespace test_truth
