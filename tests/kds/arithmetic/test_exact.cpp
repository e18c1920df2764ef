// Exact numbers against Boost's rationals.
#include "kds/arithmetic/exact.hpp"
#include "tests/support/random_numbers.hpp"

#include <boost/multiprecision/cpp_int.hpp>
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <vector>

namespace test_exact {
namespace {

using kds::Exact;
using kds::tests::Random;
using Fraction = boost::multiprecision::cpp_rational;

constexpr double largest = std::numeric_limits<double>::max();
constexpr double least = std::numeric_limits<double>::denorm_min();

/// One number in both arithmetics.
struct Twin {
  Exact exact;
  Fraction fraction;
};

Twin twin(double x) { return {Exact(x), Fraction(x)}; }
Twin operator+(const Twin& a, const Twin& b) { return {a.exact + b.exact, a.fraction + b.fraction}; }
Twin operator-(const Twin& a, const Twin& b) { return {a.exact - b.exact, a.fraction - b.fraction}; }
Twin operator*(const Twin& a, const Twin& b) { return {a.exact * b.exact, a.fraction * b.fraction}; }
Twin operator-(const Twin& a) { return {-a.exact, -a.fraction}; }

}  // namespace

TEST_CASE("every finite double goes into an exact number and comes back", "[exact]") {
  const std::uint64_t seed = 20;
  CAPTURE(seed);
  Random random(seed);
  std::vector<double> all{0.0, -0.0, 1, -1, 0.1, least, -least, 0x1p-1022, largest, -largest, 1e9 + 1e-7};
  for (int i = 0; i < 5000; ++i) all.push_back(random.any());
  for (const double x : all) {
    if (Exact(x).approximate() != x) CHECK(Exact(x).approximate() == x);
    const int sign = x > 0 ? 1 : x < 0 ? -1 : 0;
    if (Exact(x).sign() != sign) CHECK(Exact(x).sign() == sign);
  }
  CHECK(Exact().sign() == 0);
  CHECK(kds::sign(Exact(-3.0)) == -1);
}

TEST_CASE("exact numbers have the signs that rationals have", "[exact]") {
  const std::uint64_t seed = 21;
  CAPTURE(seed);
  Random random(seed);
  int zeros = 0;
  for (int round = 0; round < 300; ++round) {
    // Coarse numbers make sums vanish; scaled ones spread the exponents.
    std::vector<Twin> numbers;
    for (int i = 0; i < 6; ++i) numbers.push_back(twin(round % 2 ? random.coarse() : random.scaled(-300, 300)));
    for (int step = 0; step < 12; ++step) {
      const Twin& a = numbers[random.below(numbers.size())];
      const Twin& b = numbers[random.below(numbers.size())];
      Twin c;
      switch (random.below(4)) {
        case 0:
          c = a + b;
          break;
        case 1:
          c = a - b;
          break;
        case 2:
          c = -a;
          break;
        default:
          c = step < 6 ? a * b : b - a;
      }
      zeros += c.fraction.is_zero();
      if (c.exact.sign() != c.fraction.sign()) {
        CAPTURE(round, step);
        CHECK(c.exact.sign() == c.fraction.sign());
      }
      numbers.push_back(c);
    }
    // Not only the signs: the last number, minus what it should be, is nothing.
    const Twin& a = numbers[numbers.size() - 1];
    const Twin& b = numbers[numbers.size() - 2];
    CHECK((a.exact - b.exact).sign() == Fraction(a.fraction - b.fraction).sign());
    CHECK(((a.exact + b.exact) * (a.exact - b.exact) - (a.exact * a.exact - b.exact * b.exact)).sign() == 0);
  }
  CHECK(zeros > 100);
}

TEST_CASE("nothing is lost between the ends of the range", "[exact]") {
  const Exact big(1e300);
  const Exact small(1e-300);
  CHECK((big + small - big - small).sign() == 0);
  CHECK((big + small - big).sign() == 1);
  CHECK(((big + small) - big).approximate() == 1e-300);
  CHECK((big * big * small * small).approximate() == Approx(1));
  CHECK((Exact(least) * Exact(least)).sign() == 1);            // far below all doubles
  CHECK((Exact(largest) * Exact(largest) - big).sign() == 1);  // and above
  CHECK((Exact(0.1) + Exact(0.2) - Exact(0.3)).sign() == 1);   // as the doubles nearest to them have it
}

TEST_CASE("approximations are the nearest double or its neighbour", "[exact]") {
  const std::uint64_t seed = 22;
  CAPTURE(seed);
  Random random(seed);
  for (int i = 0; i < 2000; ++i) {
    const Exact x = Exact(random.scaled(-200, 200)) * Exact(random.scaled(-200, 200)) + Exact(random.scaled(-200, 200));
    const double y = x.approximate();
    const double step = std::abs(std::nextafter(y, 2 * y) - y);
    const bool near = (x - Exact(y) - Exact(step)).sign() <= 0 && (x - Exact(y) + Exact(step)).sign() >= 0;
    if (!near) {
      CAPTURE(i, y);
      CHECK(near);
    }
  }
  // -2^k - 1 as an integer of several words, the last of which is 1; and its neighbours.
  const Exact one = Exact(0x1p52 + 1) - Exact(0x1p52);
  for (const double large : {0x1p72, 0x1p73, 0x1.5d8p200}) {
    for (const Exact& little : {one, Exact(), -one}) {
      CHECK((-Exact(large) - little).approximate() == -large);
      CHECK((Exact(large) + little).approximate() == large);
    }
  }
  CHECK((Exact(largest) * Exact(2.0)).approximate() == std::numeric_limits<double>::infinity());
  CHECK((Exact(-largest) * Exact(2.0)).approximate() == -std::numeric_limits<double>::infinity());
  CHECK((Exact(least) * Exact(0.25)).approximate() == 0);
}

TEST_CASE("the absolute value of an exact number has no sign", "[exact]") {
  CHECK(absolute(Exact(-2.0)).approximate() == 2);
  CHECK(absolute(Exact(2.0)).approximate() == 2);
  CHECK(absolute(Exact(-least) + Exact(largest)).sign() == 1);
  CHECK(absolute(Exact(0.0)).sign() == 0);
}

TEST_CASE("what leaves the ring is truncated towards zero", "[exact]") {
  const std::uint64_t seed = 23;
  CAPTURE(seed);
  Random random(seed);
  // part <= magnitude < part + 2^-bits
  const auto within = [](const Exact& magnitude, const Exact& part, int bits) {
    return (magnitude - part).sign() >= 0 && (part + scaled(Exact(1.0), -bits) - magnitude).sign() > 0;
  };
  int wrong = 0;
  for (int i = 0; i < 2000; ++i) {
    const Exact a = Exact(random.scaled(-60, 60)) * Exact(random.coarse() + 0x1p-40);
    const Exact b = random.scaled(-60, 60);
    const int bits = random.integer(-40, 120);
    const Exact unit = scaled(Exact(1.0), -bits);
    const Exact part = truncated(a, bits);
    wrong += !within(absolute(a), absolute(part), bits) || (part.sign() != 0 && part.sign() != a.sign());
    const Exact ratio = absolute(truncated_quotient(a, b, bits)) * absolute(b);
    wrong += (absolute(a) - ratio).sign() < 0 || (ratio + unit * absolute(b) - absolute(a)).sign() <= 0;
    const Exact root = truncated_square_root(absolute(a), bits);
    wrong += (absolute(a) - root * root).sign() < 0 || ((root + unit) * (root + unit) - absolute(a)).sign() <= 0;
    const int n = a.magnitude_bits();
    wrong += a.sign() != 0 && !((scaled(Exact(1.0), n) - absolute(a)).sign() > 0 &&
                                (scaled(Exact(1.0), n - 1) - absolute(a)).sign() <= 0);
  }
  CHECK(wrong == 0);
  CHECK(Exact().magnitude_bits() == 0);
  CHECK(truncated(Exact(-1.75), 1) == Exact(-1.5));
  CHECK(truncated_quotient(Exact(-1.0), Exact(3.0), 2) == Exact(-0.25));
  CHECK(scaled(Exact(3.0), -2) == Exact(0.75));
}

}  // namespace test_exact
