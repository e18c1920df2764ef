// Sines and cosines of every precision against those of a hundred decimal digits.
#include "kds/arithmetic/enclosed_sine_cosine.hpp"
#include "kds/arithmetic/lattice.hpp"
#include "kds/arithmetic/sine_cosine.hpp"
#include "tests/support/random_numbers.hpp"

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <catch2/catch.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace test_sine_cosine {
namespace {

using namespace kds;
using kds::tests::Random;
using Real = boost::multiprecision::cpp_bin_float_100;

Real exact(double x) { return Real(x); }
Real exact(const DoubleDouble& x) { return Real(x.high) + Real(x.low); }
Real exact(const Exact& x) {
  Real sum = 0;
  Exact rest = x;
  for (int i = 0; i < 8 && rest.sign() != 0; ++i) {
    const double part = rest.approximate();
    sum += Real(part);
    rest = rest - Exact(part);
  }
  return sum;
}

/// How much of its radius the number is off.
template <class T>
double share(const Ball<T>& ball, const Real& truth) {
  const Real error = abs(exact(ball.middle) - truth);
  if (ball.radius == 0) return error == 0 ? 0 : 2;
  return static_cast<double>(error / Real(ball.radius));
}

struct Product {
  double rate, time;
};

/// Angles of all sizes, and such as lie next to where a sine or a cosine vanishes.
std::vector<Product> random_products(Random& random, int count) {
  std::vector<Product> products;
  while (static_cast<int>(products.size()) < count) {
    Product p{random.scaled(-30, 13), random.scaled(-30, 26)};
    switch (random.below(5)) {
      case 0:
        p.time = std::floor(std::abs(random.scaled(0, 38))) * 1.5707963267948966 / p.rate;
        break;
      case 1:
        p = {random.scaled(-2, 0), random.scaled(-2, 0)};
        break;
      case 2:
        p = {random.integer(-64, 64) * 0.78539816339744831, 1 + random.integer(-2, 2) * 0x1p-52};
        break;
      default:
        break;
    }
    if (std::abs(p.rate * p.time) <= greatest_angle) products.push_back(p);
  }
  return products;
}

template <class Number>
double greatest_share(const std::vector<Product>& products) {
  double greatest = 0;
  for (const Product& p : products) {
    const auto a = sine_cosine<Number>(p.rate, p.time);
    const Real angle = Real(p.rate) * Real(p.time);
    greatest = std::max({greatest, share(a.sine, sin(angle)), share(a.cosine, cos(angle))});
  }
  return greatest;
}

}  // namespace

TEST_CASE("sines and cosines are within their radii, and these are small", "[sine_cosine]") {
  const std::uint64_t seed = 300;
  CAPTURE(seed);
  Random random(seed);
  const auto products = random_products(random, 4000);
  const double doubles = greatest_share<Ball<double>>(products);
  const double extended = greatest_share<Ball<DoubleDouble>>(products);
  CAPTURE(doubles, extended);
  CHECK(doubles < 1);
  CHECK(extended < 1);
  CHECK(doubles > 0.1);  // the bounds are no idle ones
  CHECK(extended > 0.01);
  for (const Product& p : products) {
    const auto a = sine_cosine<Ball<double>>(p.rate, p.time);
    const auto b = sine_cosine<Ball<DoubleDouble>>(p.rate, p.time);
    if (!(a.sine.radius <= 0x1p-50 && b.sine.radius <= 0x1p-99)) FAIL("large radius");
    if (!(a.cosine.radius <= 0x1p-50 && b.cosine.radius <= 0x1p-99)) FAIL("large radius");
  }
}

TEST_CASE("the sine of a small angle keeps its bits", "[sine_cosine]") {
  for (const double angle : {0x1p-10, 0x1.23456789abcdep-40, 0x1p-70, 0x1p-300, 0x1p-1060}) {
    CAPTURE(angle);
    const auto a = sine_cosine<Ball<double>>(Ball<DoubleDouble>(angle));
    const auto b = sine_cosine<Ball<DoubleDouble>>(Ball<DoubleDouble>(angle));
    CHECK(a.sine.radius <= 0x1p-51 * angle + std::numeric_limits<double>::denorm_min());
    CHECK(b.sine.radius <= 0x1p-100 * angle);
    CHECK(share(b.cosine, cos(Real(angle))) <= 1);
    if (angle > 0x1p-900) CHECK(share(b.sine, sin(Real(angle))) <= 1);
    CHECK(sine_cosine<Ball<double>>(Ball<DoubleDouble>(-angle)).sine.middle == -a.sine.middle);
  }
}

TEST_CASE("an angle of zero is exact, one without bounds undecided", "[sine_cosine]") {
  const auto zero = sine_cosine<Ball<DoubleDouble>>(0.0, 5.0);
  CHECK((zero.sine.is_zero() && zero.cosine.radius == 0 && zero.cosine.middle.high == 1));
  for (const double angle : {next_up(greatest_angle), -1e300, never, std::numeric_limits<double>::quiet_NaN()}) {
    const auto a = sine_cosine<Ball<double>>(angle, 1.0);
    CHECK((certain_sign(a.sine) == 0 && certain_sign(a.cosine) == 0 && a.sine.radius == never));
  }
  const auto lost = sine_cosine<Ball<double>>(1e-200, 1e-200);  // the product underflows
  CHECK(lost.sine.radius > 0);
  // The radius of the angle counts.
  CHECK(sine_cosine<Ball<double>>(Ball<DoubleDouble>(DoubleDouble(1.0), 0.25)).sine.radius >= 0.25);
}

TEST_CASE("sines have the same bits on every system", "[sine_cosine]") {
  Random random(301);
  std::uint64_t hash = 14695981039346656037u;  // FNV-1a, word by word
  const auto add = [&](double x) { hash = (hash ^ std::bit_cast<std::uint64_t>(x)) * 1099511628211u; };
  for (const Product& p : random_products(random, 2000)) {
    const auto a = sine_cosine<Ball<double>>(p.rate, p.time);
    const auto b = sine_cosine<Ball<DoubleDouble>>(p.rate, p.time);
    for (const double x : {a.sine.middle, a.cosine.middle, b.sine.middle.high, b.sine.middle.low, b.cosine.middle.high,
                           b.cosine.middle.low}) {
      add(x);
    }
  }
  CHECK(hash == 0x897c4baf4466c003u);
}

TEST_CASE("enclosures of sines hold them to any number of bits", "[sine_cosine]") {
  const std::uint64_t seed = 302;
  CAPTURE(seed);
  Random random(seed);
  int wrong = 0;
  for (const Product& p : random_products(random, 400)) {
    const int bits = random.integer(0, 280);
    const Exact angle = Exact(p.rate) * Exact(p.time);
    const Exact error = random.one_in(3) ? Exact(0x1p-150) : Exact(0.0);
    const auto a = enclosed_sine_cosine({angle, error}, bits);
    const Real truth = Real(p.rate) * Real(p.time) + (error.sign() > 0 ? Real(0x1p-150) : Real(0));
    const Real allowed = ldexp(Real(1), -bits) + exact(error);
    wrong += abs(exact(a.sine.middle) - sin(truth)) > exact(a.sine.radius) || exact(a.sine.radius) > allowed;
    wrong += abs(exact(a.cosine.middle) - cos(truth)) > exact(a.cosine.radius) || exact(a.cosine.radius) > allowed;
  }
  CHECK(wrong == 0);
}

TEST_CASE("a large angle, and many digits", "[sine_cosine]") {
  // 10^22 is a double. Its sine is known: -0.85220084976718880177... (an ancient test of libraries).
  const auto a = enclosed_sine_cosine(Exact(1e22), 200);
  CHECK(abs(exact(a.sine.middle) - Real("-0.8522008497671888017727058937530293683")) < Real("1e-36"));
  // More digits lie within fewer.
  const auto more = enclosed_sine_cosine(Exact(1e22), 2000);
  CHECK((more.sine.radius + scaled(Exact(-1.0), -2000)).sign() <= 0);
  CHECK((absolute(more.sine.middle - a.sine.middle) - a.sine.radius - more.sine.radius).sign() <= 0);
  const Enclosure one = more.sine * more.sine + more.cosine * more.cosine + Enclosure(Exact(-1.0));
  CHECK(certain_sign(one) == 0);
  CHECK((one.radius - scaled(Exact(1.0), -1996)).sign() < 0);
}

TEST_CASE("enclosures have signs, and roots", "[enclosure]") {
  CHECK(certain_sign(Enclosure(Exact(2.0), Exact(1.5))) == 1);
  CHECK(certain_sign(-Enclosure(Exact(2.0), Exact(1.5))) == -1);
  CHECK(certain_sign(Enclosure(Exact(2.0), Exact(2.0))) == 0);
  CHECK(enclosed_square_root(Exact(2.25), 1).radius.sign() == 0);
  CHECK(enclosed_square_root(Exact(2.25), 0).middle == Exact(1.0));
  const Enclosure root = enclosed_square_root(Exact(2.0), 300);
  const Enclosure two = root * root;
  CHECK(certain_sign(two + Enclosure(Exact(-2.0))) == 0);
  CHECK(certain_sign(two + Enclosure(Exact(-2.0) + scaled(Exact(1.0), -290))) == 1);
}

}  // namespace test_sine_cosine
