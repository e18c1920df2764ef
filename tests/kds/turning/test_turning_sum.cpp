// Sums of polynomials times sines and cosines: their derivatives, and the turns that they are made of.
#include "kds/arithmetic/lattice.hpp"
#include "kds/turning/turning_sum.hpp"
#include "tests/support/random_numbers.hpp"

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <catch2/catch.hpp>

#include <cmath>
#include <cstdint>

namespace test_turning_sum {
namespace {

using namespace kds;
using kds::tests::Random;
using Real = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<100>, boost::multiprecision::et_off>;

Real exact(const Ball<double>& x) { return Real(x.middle); }
Real exact(const Ball<DoubleDouble>& x) { return Real(x.middle.high) + Real(x.middle.low); }

Real rate_of(const Spin& spin) {
  Real square = 0;
  for (const double v : spin.velocity) square += Real(v) * Real(v);
  return sqrt(square);
}

SpinAngle<Real> true_turn(const Spin& spin, const Real& t) {
  const Real rate = rate_of(spin);
  const Real angle = rate * (t - Real(spin.start));
  return {cos(angle), rate * sin(angle)};
}

/// f at epoch + elapsed.
template <int Degree, int Harmonics>
Real value(const TurningSum<Degree, Real, Harmonics>& f, const Spin& a, const Spin& b, double epoch,
           const Real& elapsed) {
  TurningSum<0, Real, Harmonics> now;
  for (std::size_t i = 0; i < f.size; ++i) {
    for (std::size_t j = 0; j < f.size; ++j) now.p[i][j].c[0] = f.p[i][j](elapsed);
  }
  return value_at_epoch(now, true_turn(a, Real(epoch) + elapsed), true_turn(b, Real(epoch) + elapsed));
}

Spin random_spin(Random& random) {
  Spin spin{{random.between(-2, 2), random.between(-2, 2), random.between(-2, 2)}, random.between(-5, 5)};
  if (random.one_in(6)) spin.velocity = {0, 0, 0};
  return spin;
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("the derivative of a turning sum is what it grows by", "[turning_sum]",
                       ((int Harmonics), Harmonics), 1, 2, 3) {
  const std::uint64_t seed = 350;
  CAPTURE(seed);
  Random random(seed);
  for (int round = 0; round < 30; ++round) {
    const Spin a = random_spin(random);
    const Spin b = random_spin(random);
    TurningSum<2, Real, Harmonics> f;
    for (auto& row : f.p) {
      for (auto& p : row) p.c = {Real(random.between(-1, 1)), Real(random.between(-1, 1)), Real(random.between(-1, 1))};
    }
    const auto g = derivative(f, Real(rate_of(a) * rate_of(a)), Real(rate_of(b) * rate_of(b)));
    const double t = random.between(-2, 2);
    const Real h("1e-30");
    const Real growth = (value(f, a, b, t, h) - value(f, a, b, t, -h)) / (2 * h);
    CHECK(abs(growth - value(g, a, b, t, Real(0))) < Real("1e-50"));
  }
}

TEST_CASE("products of turning sums have the products of their values", "[turning_sum]") {
  const std::uint64_t seed = 352;
  CAPTURE(seed);
  Random random(seed);
  for (int round = 0; round < 30; ++round) {
    const Spin a = random_spin(random);
    const Spin b = random_spin(random);
    TurningSum<2, Real> f, g;
    for (auto* sum : {&f, &g}) {
      for (auto& row : sum->p) {
        for (auto& p : row) {
          if (!random.one_in(3)) p.c = {Real(random.between(-1, 1)), Real(random.between(-1, 1)), Real(1)};
        }
      }
    }
    const Real squared_rate_a = rate_of(a) * rate_of(a), squared_rate_b = rate_of(b) * rate_of(b);
    TurningSum<4, Real, 2> product;
    add_product(product, f, g, squared_rate_a, squared_rate_b);
    const double t = random.between(-2, 2), later = random.between(-1, 1);
    CHECK(abs(value(product, a, b, t, Real(later)) - value(f, a, b, t, Real(later)) * value(g, a, b, t, Real(later))) <
          Real("1e-80"));
    TurningSum<1, Real, 3> cut;  // of a product with one of two harmonics, up to the first order
    add_product(cut, product, f, squared_rate_a, squared_rate_b);
    const Real whole = value(product, a, b, t, Real(0)) * value(f, a, b, t, Real(0));
    CHECK(abs(value(cut, a, b, t, Real(0)) - whole) < Real("1e-80"));
  }
}

TEST_CASE("turns are within their bounds, for rates and starts of all sizes", "[spin]") {
  const std::uint64_t seed = 351;
  CAPTURE(seed);
  Random random(seed);
  int wrong = 0;
  int wide = 0;
  const auto outside = [](const auto& ball, const Real& truth) { return abs(exact(ball) - truth) > Real(ball.radius); };
  for (int round = 0; round < 300; ++round) {
    Spin spin = random_spin(random);
    const double factor = std::pow(10.0, random.between(-9, 4));
    for (double& v : spin.velocity) v *= factor;
    if (random.one_in(3)) spin.start -= random.one_in(2) ? 1e6 : 1e9;
    const double t = random.between(-1, 1);
    const SpinAngle<Real> truth = true_turn(spin, Real(t));
    const auto a = spin.turn<Ball<double>>(t);
    const auto b = spin.turn<Ball<DoubleDouble>>(t);
    wrong += outside(a.cosine, truth.cosine) || outside(a.rate_sine, truth.rate_sine);
    wrong += outside(b.cosine, truth.cosine) || outside(b.rate_sine, truth.rate_sine);
    wrong += abs(exact(spin.rate()) - rate_of(spin)) > Real(spin.rate().radius);
    const bool in_range = rate_of(spin) * abs(Real(t) - Real(spin.start)) < greatest_angle;
    wide += in_range && !(a.cosine.radius < 0x1p-49 && b.cosine.radius < 0x1p-58);
    wrong += !in_range && a.cosine.radius < 1;
    const SpinAngle<Enclosure> c = spin.enclosed_turn(t, 150);
    const double cosine = c.cosine.middle.approximate();
    const double rate_sine = c.rate_sine.middle.approximate();
    wrong += abs(Real(cosine) - truth.cosine) > Real(0x1p-52);
    wrong += abs(Real(rate_sine) - truth.rate_sine) > Real(0x1p-52) * rate_of(spin);
    wrong += (c.cosine.radius - scaled(Exact(1.0), -149)).sign() > 0;
  }
  CHECK(wrong == 0);
  CHECK(wide == 0);
}

TEST_CASE("a spin that is still, and one at its start, are exact", "[spin]") {
  const auto still = Spin{{0, 0, 0}, 3}.turn<Ball<double>>(7);
  CHECK((still.cosine.radius == 0 && still.cosine.middle == 1 && still.rate_sine.is_zero()));
  const auto begun = Spin{{1, 2, 3}, 7}.turn<Ball<DoubleDouble>>(7);
  CHECK((begun.cosine.radius == 0 && begun.cosine.middle.high == 1 && begun.rate_sine.is_zero()));
  CHECK(Spin{{3, 4, 12}, 0}.squared_rate<Exact>() == Exact(169.0));
  CHECK(Spin{{3, 4, 12}, 0}.rate().middle.high == 13);
  CHECK(Spin{{1e-250, 0, 0}, 0}.rate().radius == never);  // nothing is said of it in doubles
}

}  // namespace test_turning_sum
