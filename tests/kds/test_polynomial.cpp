#include "kds/arithmetic/exact.hpp"
#include "kds/motion.hpp"
#include "kds/polynomial.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

namespace test_polynomial {
namespace {

using kds::Exact;
using kds::Polynomial;
using kds::tests::Random;

/// Small integers: all arithmetic on them is exact in doubles, so that the laws of rings hold to the bit.
template <int Degree>
Polynomial<Degree> random_polynomial(Random& random) {
  Polynomial<Degree> p;
  for (double& c : p.c) c = random.integer(-20, 20);
  return p;
}

template <int A, int B>
void check_ring_laws(Random& random) {
  const auto p = random_polynomial<A>(random);
  const auto q = random_polynomial<B>(random);
  const double x = random.integer(-6, 6);
  const double factor = random.integer(-6, 6);
  CAPTURE(A, B, p.c, q.c, x, factor);
  CHECK((p + q)(x) == p(x) + q(x));
  CHECK((p - q)(x) == p(x) - q(x));
  CHECK((p * q)(x) == p(x) * q(x));
  CHECK((p * factor)(x) == p(x) * factor);
  CHECK((-p)(x) == -p(x));
  CHECK(p + q == q + p);
  CHECK(p * q == q * p);
  CHECK(p - q == -(q - p));
  static_assert(decltype(p + q)::degree == (A < B ? B : A));
  static_assert(decltype(p - q)::degree == (A < B ? B : A));
  static_assert(decltype(p * q)::degree == A + B);
  if constexpr (A >= 1 && B >= 1) CHECK(derivative(p * q) == derivative(p) * q + p * derivative(q));
}

}  // namespace

TEST_CASE("the value of a polynomial is the sum of its terms", "[polynomial]") {
  CHECK(Polynomial<0>{{7}}(1e300) == 7);
  CHECK(Polynomial<1>{{7, 2}}(-3) == 1);
  CHECK(Polynomial<3>{{1, -2, 3, -4}}(2) == 1 - 4 + 12 - 32);
  CHECK(Polynomial<3>{{1, -2, 3, -4}}(0) == 1);
  CHECK(Polynomial<4>{{1, 1, 0, 0, 0}}(5) == 6);  // leading coefficients may be zero
  CHECK(Polynomial<2>{}(3) == 0);
}

TEST_CASE("polynomials are computed by the compiler too", "[polynomial]") {
  constexpr Polynomial<1> line{{1, 2}};
  constexpr Polynomial<2> parabola = line * line - Polynomial<0>{{3}};
  static_assert(parabola(2.0) == 22);
  static_assert(derivative(parabola) == Polynomial<1>{{4, 8}});
  static_assert(derivative(Polynomial<1>{{5, 3}}) == Polynomial<0>{{3}});
  SUCCEED();
}

TEST_CASE("polynomials of all degrees form a ring, and differentiation obeys the product rule", "[polynomial]") {
  const std::uint64_t seed = 1;
  CAPTURE(seed);
  Random random(seed);
  for (int round = 0; round < 50; ++round) {
    check_ring_laws<0, 0>(random);
    check_ring_laws<0, 3>(random);
    check_ring_laws<1, 1>(random);
    check_ring_laws<1, 2>(random);
    check_ring_laws<2, 1>(random);
    check_ring_laws<2, 2>(random);
    check_ring_laws<4, 3>(random);
  }
}

TEST_CASE("one formula runs in any number type", "[polynomial]") {
  // (1 + 2^-60)^2 - 1 vanishes in doubles, not in exact numbers.
  const double tiny = 0x1p-60;
  const Polynomial<1> p{{1, tiny}};
  CHECK((p * p)(1.0) == 1);
  const auto exact = taylor_shift<Exact>(p, Exact(0.0));
  const auto square = (exact * exact)(Exact(1.0));
  CHECK((square - Exact(1.0)).sign() > 0);
  CHECK((square - Exact(1 + 2 * tiny)).sign() > 0);
}

}  // namespace test_polynomial
