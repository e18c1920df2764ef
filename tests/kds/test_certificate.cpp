// Signs at t+: each rung of the ladder forced, degeneracies by hand, near-degenerate input against exact rationals.
#include "kds/certificate.hpp"
#include "tests/support/exact_failure_time.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace test_certificate {
namespace {

using namespace kds;
using kds::tests::Random;

template <int Degree>
using Value = PolynomialCertificate<Degree>;

/// The example in the documentation of Certificate.
struct Above {
  static constexpr int degree = 2;
  Motion<2> x;
  template <class Number>
  auto polynomial(double epoch) const {
    return about<Number>(x, epoch) - constant<Number>(3);
  }
};
static_assert(Certificate<Above>);
static_assert(Certificate<Value<0>>);
static_assert(Certificate<Value<7>>);
static_assert(Certificate<DerivativeCertificate<Value<3>>>);
static_assert(!Certificate<Motion<2>>);

/// f and whether it says that it vanishes.
struct Talkative {
  static constexpr int degree = 1;
  bool says_zero;
  template <class Number>
  Polynomial<1, Number> polynomial(double epoch) const {
    return about<Number>(Motion<1>{{{0.1, 0}}, 0}, epoch) - about<Number>(Motion<1>{{{0.1, 0}}, 1}, epoch);
  }
  bool vanishes() const { return says_zero; }
};

// What a certificate may know of itself; tests/kds/misuse/broken_hooks.cc has what must not compile.
static_assert(TellsIfItVanishes<Value<3>> && GivesExtendedValue<Value<3>> && AnswersQuickly<Value<3>>);
static_assert(AnswersQuicklyAfterTurn<Value<3>> && !AnswersQuicklyForTwo<Value<3>> && !TellsItsNegative<Value<3>>);
static_assert(TellsIfItVanishes<Talkative> && !GivesExtendedValue<Talkative> && !AnswersQuickly<Talkative>);
static_assert(!AnswersQuicklyAfterTurn<Talkative> && !TellsIfItVanishes<Above> && detail::RightHooks<Above>::checked);

/// Members with the names of hooks, found whatever they are.
struct Overloaded {
  void vanishes();
  void vanishes(int);
};
struct Inherits : Overloaded {};
struct Final final {
  bool vanishes() { return false; }
};
class Private {
  template <class T>
  bool vanishes(T) const;
};
static_assert(detail::NamesVanishes<Overloaded> && detail::NamesVanishes<Inherits> && detail::NamesVanishes<Final>);
static_assert(detail::NamesVanishes<Private> && !detail::NamesVanishes<Above>);
static_assert(!detail::NamesQuickFailureTime<Final> && !detail::NamesQuickFailureTime<Private>);
static_assert(!TellsIfItVanishes<Overloaded> && !TellsIfItVanishes<Final> && !TellsIfItVanishes<Private>);
static_assert(!detail::NamesVanishes<int>);

/// The sign of derivative `order` at t+, over the rationals.
template <int Degree>
int expected_sign(const Motion<Degree>& f, double t, int order = 0) {
  std::vector<oracle::Rational> c;
  for (const double x : f.position.c) c.push_back(oracle::rational(x));
  for (int k = 0; k < order; ++k) {
    for (std::size_t i = 1; i < c.size(); ++i) c[i - 1] = c[i] * static_cast<int>(i);
    c.pop_back();
  }
  return oracle::sign_after(c, oracle::rational(f.start), t);
}

/// Which rungs a sign has asked for.
template <class C>
std::array<std::uint64_t, 2> rungs(const C& certificate, double t) {
  sign_counters = {};
  sign_after(certificate, t);
  return {sign_counters.extended, sign_counters.exact};
}

using Rungs = std::array<std::uint64_t, 2>;

}  // namespace

TEST_CASE("the sign just after t is that of the first derivative that is not zero", "[certificate]") {
  CHECK(sign_after(Value<1>{{{{1, -1}}, 0}}, 0) == 1);
  CHECK(sign_after(Value<1>{{{{1, -1}}, 0}}, 1) == -1);
  CHECK(sign_after(Value<1>{{{{-1, 1}}, 0}}, 1) == 1);
  CHECK(sign_after(Value<2>{{{{1, -2, 1}}, 0}}, 1) == 1);      // (t - 1)^2: a touch from above
  CHECK(sign_after(Value<2>{{{{-1, 2, -1}}, 0}}, 1) == -1);    // from below
  CHECK(sign_after(Value<3>{{{{-1, 3, -3, 1}}, 0}}, 1) == 1);  // (t - 1)^3
  CHECK(sign_after(Value<3>{{{{1, -3, 3, -1}}, 0}}, 1) == -1);
  CHECK(sign_after(Value<4>{{{{0, 0, 0, 0, -1e-300}}, 7}}, 7) == -1);
  CHECK(sign_after(Value<0>{{{{-2}}, 0}}, 5) == -1);
  CHECK(sign_after(Value<2>{{{{0, 0, 1}}, 1e9}}, 1e9) == 1);
}

TEST_CASE("the sign is zero only for the zero polynomial", "[certificate]") {
  CHECK(sign_after(Value<0>{}, 0) == 0);
  CHECK(sign_after(Value<2>{}, 1e9) == 0);
  CHECK(sign_after(Value<6>{{{}, 3}}, -4) == 0);
  CHECK(sign_after(Value<2>{{{{0, 0x1p-1074, 0}}, 0}}, 0) == 1);
  // Also where it does not know: two equal constants, written about different starts.
  CHECK(sign_after(Talkative{false}, 3) == 0);
}

TEST_CASE("a certificate that says it vanishes is not computed", "[certificate]") {
  CHECK(rungs(Talkative{true}, 3)[1] == 0);
  CHECK(sign_after(Talkative{true}, 3) == 0);
}

TEST_CASE("the ladder: doubles decide what is clear", "[certificate]") {
  CHECK(rungs(Value<2>{{{{1, 2, 3}}, 0}}, 0.1) == Rungs{0, 0});
  CHECK(rungs(Value<2>{{{{1, -2, 1 + 1e-10}}, 0}}, 1) == Rungs{0, 0});
}

TEST_CASE("the ladder: double-doubles decide what doubles round away", "[certificate]") {
  const Value<2> h{{{{0x1p-70, 1, -1}}, 0}};  // h(1) = 2^-70
  CHECK(rungs(h, 1) == Rungs{1, 0});
  CHECK(sign_after(h, 1) == 1);
  CHECK(sign_after(Value<2>{{{{-0x1p-70, 1, -1}}, 0}}, 1) == -1);
}

TEST_CASE("the ladder: exact numbers decide what double-doubles round away, and zeros", "[certificate]") {
  const Value<3> beyond{{{{0x1p-200, 1, -2, 1}}, 0}};  // f(1) = 2^-200
  CHECK(rungs(beyond, 1) == Rungs{1, 1});
  CHECK(sign_after(beyond, 1) == 1);
  CHECK(sign_after(Value<3>{{{{-0x1p-200, 1, -2, 1}}, 0}}, 1) == -1);
  const Value<2> touch{{{{1, -2, 1}}, 0}};
  CHECK(rungs(touch, 1) == Rungs{1, 1});
  CHECK(sign_after(touch, 1) == 1);
}

TEST_CASE("overflow and underflow climb the ladder and come out right", "[certificate]") {
  const double largest = std::numeric_limits<double>::max();
  CHECK(sign_after(Value<1>{{{{largest, -largest}}, 0}}, 1.5) == -1);
  CHECK(sign_after(Value<1>{{{{-largest, largest}}, 0}}, 1.5) == 1);
  CHECK(sign_after(Value<2>{{{{-largest, 0, 1e10}}, 0}}, 1e300) == 1);
  CHECK(sign_after(Value<1>{{{{1, 1}}, -largest}}, largest) == 1);  // an elapsed time beyond all doubles
  CHECK(sign_after(Value<1>{{{{1, -1}}, -largest}}, largest) == -1);
  CHECK(sign_after(Value<2>{{{{0, 0, 1e-300}}, 0}}, 1e-200) == 1);  // 1e-700
  CHECK(sign_after(Value<2>{{{{0, -1e-300, 0}}, 0}}, 1e-200) == -1);
  CHECK(sign_after(Value<2>{{{{0, -1e-300, 1e-99}}, 0}}, 1e-200) == 1);  // 9e-500
}

#define FOR_EACH_DEGREE ((int Degree), Degree), 1, 2, 3, 4, 5, 6

TEMPLATE_TEST_CASE_SIG("signs of nearly degenerate polynomials are those over the rationals", "[certificate]",
                       FOR_EACH_DEGREE) {
  const std::uint64_t seed = 50;
  CAPTURE(Degree, seed);
  Random random(seed);
  sign_counters = {};
  for (int round = 0; round < 400; ++round) {
    // A product of linear factors with roots on a coarse grid, and then a hair's breadth off.
    Motion<Degree> f;
    f.start = random.one_in(2) ? 0 : random.coarse();
    f.position.c[0] = random.one_in(2) ? 1 : -1;
    std::array<double, Degree> roots;
    for (std::size_t n = 0; n < Degree; ++n) {
      roots[n] = n > 0 && random.one_in(2) ? roots[0] : random.coarse();
      const double root = roots[n] - f.start;
      for (std::size_t i = n + 1; i > 0; --i) f.position.c[i] = f.position.c[i - 1] - root * f.position.c[i];
      f.position.c[0] *= -root;
    }
    if (random.one_in(2)) {
      double& c = f.position.c[random.below(Degree + 1)];
      c += c * random.integer(-2, 2) * 0x1p-52;
    }
    if (random.one_in(3)) f.position.c[0] += random.scaled(-120, -50);
    const double root = roots[0];
    for (const double t : {root, std::nextafter(root, 100), std::nextafter(root, -100), root + 1e-9, random.coarse()}) {
      for (int order = 0; order <= Degree; ++order) {
        const int expected = expected_sign(f, t, order);
        const int found = sign_after(Value<Degree>{f}, t, order);
        if (found != expected) {
          CAPTURE(round, t, order, f.position.c, f.start);
          CHECK(found == expected);
        }
      }
    }
  }
  // All rungs have been used.
  CHECK(sign_counters.extended > 100);
  CHECK(sign_counters.exact > 100);
  CHECK(sign_counters.exact <= sign_counters.extended);
}

TEMPLATE_TEST_CASE_SIG("the derivative of a certificate has the signs of its derivative", "[certificate]",
                       FOR_EACH_DEGREE) {
  const std::uint64_t seed = 51;
  CAPTURE(Degree, seed);
  Random random(seed);
  for (int round = 0; round < 100; ++round) {
    Motion<Degree> f;
    for (double& c : f.position.c) c = random.one_in(2) ? random.coarse() : random.between(-1, 1);
    f.start = random.coarse();
    const DerivativeCertificate<Value<Degree>> slope{{f}};
    for (const double t : {f.start, random.coarse(), random.between(-2, 2)}) {
      CAPTURE(round, t);
      CHECK(sign_after(slope, t) == expected_sign(f, t, 1));
      CHECK(sign_after(slope, t) == sign_after(Value<Degree>{f}, t, 1));
    }
  }
}

TEST_CASE("a certificate of one's own is a formula", "[certificate]") {
  const Above above{{{{5, 0, -2}}, 0}};
  CHECK(sign_after(above, 0) == 1);
  CHECK(sign_after(above, 1) == -1);  // 5 - 2 = 3, and falling
  CHECK(sign_after(above, -1) == 1);  // 3, and rising
}

TEST_CASE("the polynomial of a certificate does not depend on the epoch", "[certificate]") {
  const Value<3> f{{{{0.1, -0.7, 0.3, 1.9}}, 0.25}};
  for (const double epoch : {0.0, -3.0, 1e9}) {
    const auto p = f.polynomial<Exact>(epoch);
    const auto q = f.polynomial<Exact>(0.5);
    const double t = 4.125;
    CHECK((p(Exact(t) - Exact(epoch)) - q(Exact(t) - Exact(0.5))).sign() == 0);
  }
}

#undef FOR_EACH_DEGREE

}  // namespace test_certificate
