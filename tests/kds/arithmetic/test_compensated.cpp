// Values in twice the working precision, against exact numbers: within the bound that they give, and the bound is
// tight.
#include "kds/arithmetic/compensated.hpp"
#include "kds/arithmetic/exact.hpp"
#include "kds/motion.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

namespace test_compensated {
namespace {

using namespace kds;
using kds::tests::Random;

Exact exact(const DoubleDouble& x) { return Exact(x.high) + Exact(x.low); }
Exact exact(double x) { return Exact(x); }

/// |a| <= bound.
bool within(const Exact& a, double bound) {
  const Exact size = a.sign() < 0 ? -a : a;
  return (Exact(bound) - size).sign() >= 0;
}

template <int Degree, class Coefficient>
Exact exact_value(const Polynomial<Degree, Coefficient>& p, const DoubleDouble& x) {
  Exact value;
  for (std::size_t i = Degree + 1; i-- > 0;) value = value * exact(x) + exact(p.c[i]);
  return value;
}

/// An infinite radius is none.
template <int Degree, class Coefficient>
bool bound_holds(const Polynomial<Degree, Coefficient>& p, const DoubleDouble& x) {
  const auto value = compensated_value(p, x);
  if (!(value.radius < std::numeric_limits<double>::infinity())) return false;
  return within(exact(value.middle) - exact_value(p, x), value.radius * Ball<DoubleDouble>::slack);
}

double size(double x) { return std::abs(x); }
double size(const DoubleDouble& x) { return std::abs(x.high); }

/// The radius is some roundings in double-double of the sum of magnitudes.
template <int Degree, class Coefficient>
bool bound_is_tight(const Polynomial<Degree, Coefficient>& p, const DoubleDouble& x) {
  double magnitudes = 0;
  for (std::size_t i = Degree + 1; i-- > 0;) magnitudes = magnitudes * size(x) + size(p.c[i]);
  return compensated_value(p, x).radius <=
         (Degree <= 8 ? 0x1p-95 : 21.0 * Degree * (Degree + 1) * 0x1p-106) * magnitudes;
}

}  // namespace

#define FOR_EACH_DEGREE ((int Degree), Degree), 0, 1, 2, 3, 4, 6, 8, 10, 12, 31

TEMPLATE_TEST_CASE_SIG("compensated values are within their bounds", "[compensated]", FOR_EACH_DEGREE) {
  const std::uint64_t seed = 4000;
  Random random(seed + Degree);
  int wrong = 0;
  int loose = 0;
  for (int round = 0; round < 2000; ++round) {
    Polynomial<Degree> p;
    Polynomial<Degree, DoubleDouble> fine;
    const int spread = round % 3 == 0 ? 0 : (round % 3 == 1 ? 40 : 200);
    for (std::size_t i = 0; i <= Degree; ++i) {
      p.c[i] = random.scaled(-spread, spread);
      fine.c[i] = two_sum(random.scaled(-spread, spread), random.scaled(-spread - 20, spread));
    }
    const int most = Degree <= 8 ? 38 : 320 / Degree - 2;
    const DoubleDouble x = two_sum(random.scaled(-39, most), random.one_in(2) ? 0 : random.scaled(-80, most));
    // Often next to a root, where nearly everything cancels.
    if (round % 2 == 0) p.c[0] -= Polynomial<Degree>(p)(x.high);
    wrong += !bound_holds(p, x) + !bound_holds(fine, x);
    loose += !bound_is_tight(p, x) + !bound_is_tight(fine, x);
  }
  CAPTURE(Degree, seed);
  CHECK(wrong == 0);
  CHECK(loose == 0);
}

TEST_CASE("beyond its limits a compensated value says so", "[compensated]") {
  const double infinity = std::numeric_limits<double>::infinity();
  CHECK(compensated_value(Polynomial<2>{{1, 1, 1}}, 0x1p50).radius == infinity);
  CHECK(compensated_value(Polynomial<12>{{1}}, 0x1p26).radius < infinity);
  CHECK(compensated_value(Polynomial<12>{{1}}, 0x1p27).radius == infinity);
  CHECK(compensated_value(Polynomial<2>{{0x1p-700, 0x1p-700, 0}}, 1.0).radius == infinity);
  CHECK(certain_sign(compensated_value(Polynomial<2>{{1, 0x1p1000, 0x1p1000}}, 0x1p30)) == 0);
  // Where there is no fused multiply-add the splitting overflows.
  const int sign = certain_sign(compensated_value(Polynomial<1>{{1, 0x1p1020}}, 1.0));
  CHECK((sign == 0 || sign == 1));
  CHECK(certain_sign(compensated_value(Polynomial<1>{{std::nan(""), 1}}, 1.0)) == 0);
}

TEMPLATE_TEST_CASE_SIG("differences of motions come out the same as by polynomials", "[compensated]", FOR_EACH_DEGREE) {
  const std::uint64_t seed = 4100;
  Random random(seed + Degree);
  int wrong = 0;
  for (int round = 0; round < 500; ++round) {
    Motion<Degree> a;
    Motion<Degree> b;
    for (double& c : a.position.c) c = random.between(-1, 1);
    for (double& c : b.position.c) c = random.between(-1, 1);
    a.start = random.between(-2, 2);
    b.start = random.one_in(2) ? a.start : random.between(-2, 2);
    const double t = random.between(-3, 3);
    const auto value = extended_difference(a, b, t);
    const Exact expected = difference_about<Exact>(a, b, t).c[0];
    wrong += !within(exact(value.middle) - expected, value.radius * Ball<DoubleDouble>::slack);
    wrong += !(value.radius < (Degree <= 12 ? 1e-20 : 1e-4));
  }
  CAPTURE(Degree, seed);
  CHECK(wrong == 0);
}

TEST_CASE("a shift that overflows decides nothing", "[compensated]") {
  const auto p = about<Ball<double>>(Motion<3>{{{1, 0x1p716, 0, 0}}, 0}, 0x1p318);
  CHECK(certain_sign(p.c[0]) == 0);
  CHECK(certain_sign(p.c[1]) == 1);
  const auto q = about<Ball<double>>(Motion<4>{{{1, 0, 0, 0x1p500, -0x1p700}}, 0}, 0x1p200);
  for (std::size_t i = 0; i < 3; ++i) CHECK(certain_sign(q.c[i]) == 0);
}

TEMPLATE_TEST_CASE_SIG("shifted balls contain the shifted polynomial", "[compensated]", FOR_EACH_DEGREE) {
  const std::uint64_t seed = 4200;
  Random random(seed + Degree);
  int wrong = 0;
  int loose = 0;
  for (int round = 0; round < 1000; ++round) {
    Motion<Degree> m;
    const int spread = round % 2 == 0 ? 1 : 100;
    for (double& c : m.position.c) c = random.one_in(6) ? 0 : random.scaled(-spread, spread);
    m.start = random.one_in(4) ? 0 : random.scaled(-spread, spread);
    const double epoch = random.one_in(5) ? m.start : random.scaled(-spread, spread);
    const auto found = about<Ball<double>>(m, epoch);
    const auto expected = about<Exact>(m, epoch);
    for (std::size_t i = 0; i <= Degree; ++i) {
      const double bound = found.c[i].radius * Ball<double>::slack;
      if (std::isfinite(found.c[i].middle) && std::isfinite(bound)) {
        wrong += !within(Exact(found.c[i].middle) - expected.c[i], bound);
      } else {  // a power of a high degree overflows
        wrong += Degree <= 8 || certain_sign(found.c[i]) != 0;
      }
    }
    wrong += found.c[Degree].radius != 0;  // the leading one is exact
    if (epoch == m.start) {
      for (const auto& c : found.c) loose += Degree >= 3 && c.radius != 0;
    }
  }
  CAPTURE(Degree, seed);
  CHECK(wrong == 0);
  CHECK(loose == 0);
}

#undef FOR_EACH_DEGREE

}  // namespace test_compensated
