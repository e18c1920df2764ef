#include "certificates/features/positive_stretch.hpp"
#include "tests/support/exact_algebra.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

namespace test_positive_stretch {
namespace {

using namespace kds;
using namespace kds::tests;
using certificates::positive_until;

template <int Degree>
oracle::Polynomial exact(const Polynomial<Degree>& p) {
  std::vector<oracle::Rational> c;
  for (const double x : p.c) c.push_back(oracle::rational(x));
  return c;
}

/// A product of factors (x - root), some of them equal or nearly so, and a remainder without roots.
template <int Degree>
Polynomial<Degree> with_roots(Random& random) {
  Polynomial<Degree> p;
  p.c[0] = random.between(0.5, 2);
  double root = random.between(-0.5, 1.5);
  for (int i = 0; i < Degree; ++i) {
    if (random.one_in(2)) root = random.between(-0.5, 1.5);
    const double r = root + (random.one_in(3) ? random.scaled(-40, -10) : 0);
    for (std::size_t j = Degree; j > 0; --j) p.c[j] = p.c[j - 1] - r * p.c[j];
    p.c[0] *= -r;
  }
  return p;
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("a certified stretch has no root, and ends near one", "[positive_stretch]",
                       ((int Degree), Degree), 1, 2, 3, 4, 6, 8) {
  const std::uint64_t seed = 140;
  CAPTURE(Degree, seed);
  Random random(seed);
  int untrue = 0, late_start = 0, early_stop = 0, whole = 0, part = 0;
  for (int round = 0; round < 200; ++round) {
    auto p = with_roots<Degree>(random);
    const double s = random.one_in(3) ? 0 : random.unit();
    if (p(s) < 0) p = -p;
    const double margin = random.one_in(2) ? 0 : random.unit() * 1e-9;
    const double r = positive_until(p, s, margin);
    const auto f = exact(p) - oracle::Polynomial(oracle::rational(margin));
    if (r < s || r > 1) ++untrue;
    if (f(oracle::rational(s)).sign() <= 0) {
      late_start += r != s;
      continue;
    }
    whole += r == 1;
    part += r < 1;
    // Above the margin on all of [s, r]: no root there.
    untrue += !oracle::roots(f, oracle::rational(s), oracle::rational(r)).empty();
    // It stopped where p has come down to a small part of what it was, or to the rounding.
    const double rest = p(r) - margin;
    early_stop += r < 1 && rest > 0x1p-8 * (p(s) - margin) + 1e-9;
  }
  CHECK(untrue == 0);
  CHECK(late_start == 0);
  CHECK(early_stop * 30 <= part);  // not a promise: a rare one stops short of a double root
  CHECK(whole > 10);
  CHECK(part > 10);
}

}  // namespace test_positive_stretch
