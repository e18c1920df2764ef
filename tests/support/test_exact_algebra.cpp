// Exact numbers and roots against cases worked out by hand and against Boost's rationals.
#include "tests/support/exact_algebra.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>
#include <vector>

namespace test_exact_algebra {
namespace {

using namespace oracle;

constexpr double infinity = std::numeric_limits<double>::infinity();

Polynomial poly(std::vector<Rational> c) { return Polynomial(std::move(c)); }

}  // namespace

TEST_CASE("doubles become rationals and come back unchanged", "[oracle]") {
  for (const double x : {0.0, 1.0, -0.1, 1e300, -1e-300, 0x1p-1074, 1.7976931348623157e308, 3.0, 1e9 + 1e-7}) {
    CHECK(approximate(rational(x)) == x);
  }
  CHECK(rational(0.75) == Rational(3, 4));
  CHECK(approximate(Rational(1, 3)) == 1.0 / 3);
  CHECK(approximate(Rational(-1, 3)) == -1.0 / 3);
  CHECK(rational(-0x1p80) == Rational(-(Integer(1) << 80)));
  CHECK_FALSE(time_end(infinity).has_value());
}

TEST_CASE("rationals agree with Boost's", "[oracle]") {
  const std::uint64_t seed = 5;
  CAPTURE(seed);
  std::mt19937_64 random(seed);
  using Reference = boost::multiprecision::cpp_rational;
  const auto same = [](const Rational& x, const Reference& y) {
    return Reference(boost::multiprecision::cpp_int(x.odd_numerator())) * denominator(y) *
               Reference(boost::multiprecision::cpp_int(Integer(1) << std::max(x.exponent(), 0))) ==
           Reference(boost::multiprecision::cpp_int(x.odd_denominator())) * numerator(y) *
               Reference(boost::multiprecision::cpp_int(Integer(1) << std::max(-x.exponent(), 0)));
  };
  for (int i = 0; i < 300; ++i) {
    const auto n = static_cast<long long>(random() % 2001) - 1000;
    const auto d = static_cast<long long>(random() % 100) + 1;
    const auto m = static_cast<long long>(random() % 2001) - 1000;
    const auto e = (static_cast<long long>(random() % 100) + 1) * (random() % 2 ? 1 : -1);
    const Rational a(n, d);
    const Rational b = Rational(m) / Rational(e);
    const Reference x(n, d);
    const Reference y = Reference(m) / Reference(e);
    CAPTURE(n, d, m, e);
    CHECK(same(a + b, x + y));
    CHECK(same(a - b, x - y));
    CHECK(same(a * b, x * y));
    if (m != 0) CHECK(same(a / b, x / y));
    CHECK((a < b) == (x < y));
    CHECK((a == b) == (x == y));
    CHECK(same(abs(a), abs(x)));
  }
}

TEST_CASE("the sign just after is that of the first derivative that is not zero", "[oracle]") {
  const Polynomial cube_at_one = poly({-1, 3, -3, 1});  // (t - 1)^3
  CHECK(cube_at_one.sign_after(1) == 1);
  CHECK((cube_at_one * Rational(-1)).sign_after(1) == -1);
  CHECK(cube_at_one.sign_after(Rational(1, 2)) == -1);
  CHECK(Polynomial().sign_after(3) == 0);
}

TEST_CASE("roots are found once each, in order, and only inside the interval", "[oracle]") {
  // (t - 1)^2 (t - 2) (t + 3) (t^2 - 2)
  const Polynomial p = poly({-1, 1}) * poly({-1, 1}) * poly({-2, 1}) * poly({3, 1}) * poly({-2, 0, 1});
  const auto all = roots(p, -10, std::nullopt);
  REQUIRE(all.size() == 5);
  CHECK(all[0].compare(-3) == 0);
  CHECK(all[2].compare(1) == 0);
  CHECK(all[4].compare(2) == 0);
  CHECK(std::abs(all[3].approximate() - std::sqrt(2.0)) < 1e-15);
  CHECK(roots(p, 1, Rational(2)).size() == 2);  // 1 is outside, 2 inside
  CHECK(roots(p, 2, std::nullopt).empty());
  CHECK(roots(poly({1, 0, 1}), -10, std::nullopt).empty());
  CHECK(roots(Polynomial(), 0, std::nullopt).empty());
  CHECK(roots(Polynomial(Rational(5)), 0, std::nullopt).empty());
}

TEST_CASE("instants compare exactly, also when equal roots come from different polynomials", "[oracle]") {
  const Instant root = roots(poly({-2, 0, 1}), 0, std::nullopt).at(0);
  const Instant same = roots(poly({-4, 0, 0, 0, 1}), 0, std::nullopt).at(0);
  const Instant third = roots(poly({-2, 0, 1}) * poly({-3, 1}), 0, std::nullopt).at(0);
  const Instant near = roots(poly({-2 - Rational(1, Integer(1) << 200), 0, 1}), 0, std::nullopt).at(0);
  CHECK(root == same);
  CHECK(third == same);
  CHECK(root < near);
  CHECK_FALSE(near < same);
  CHECK(Instant(1.5).compare(root) == 1);
  CHECK(root.compare(Instant(1.5)) == -1);
  // The double next to the square root of two lies above it.
  CHECK(root.ceiling() == std::sqrt(2.0));
  CHECK(root.approximate() == std::sqrt(2.0));
  CHECK(Instant(Rational(1, 3)).ceiling() == std::nextafter(1.0 / 3, 1.0));
  CHECK(Instant(0.25).ceiling() == 0.25);
  CHECK(Instant(Rational(Integer(1) << 1100)).ceiling() == infinity);
  // A root at zero that no bisection is sure to meet.
  CHECK(roots(poly({0, -7, 0, 3}), -1, Rational(1)).at(0).narrow().compare(0) == 0);
}

TEST_CASE("the first negative time", "[oracle]") {
  const Polynomial twice = poly({-1, 1}) * poly({-1, 1}) * poly({-2, 1}) * poly({-2, 1});
  CHECK_FALSE(first_negative(twice, 0));                                         // touches zero twice
  CHECK(first_negative(twice - Rational(1, Integer(1) << 100), 0).has_value());  // and dips below it
  CHECK(first_negative(poly({1, -1}), 0)->compare(1) == 0);
  CHECK(first_negative(poly({1, -1}), 0, Rational(1))->compare(1) == 0);
  CHECK_FALSE(first_negative(poly({1, -1}), 0, Rational(1, 2)));
  CHECK(first_negative(poly({1, -1}), 5)->compare(5) == 0);
  CHECK(first_negative(poly({0, 0, 0, -1}), 0)->compare(0) == 0);
  CHECK_FALSE(first_negative(Polynomial(), 0));
}

}  // namespace test_exact_algebra
