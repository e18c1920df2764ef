// Taylor models of sums of sines and cosines: what they say holds the truth, and is as narrow as it should be.
#include "kds/turning/precise_turning_model.hpp"
#include "kds/turning/turning_expansion.hpp"
#include "tests/kds/turning/written_sum.hpp"
#include "tests/support/random_numbers.hpp"
#include "tests/support/sanitized.hpp"

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace test_turning_expansion {
namespace {

using namespace kds;
using namespace kds::tests;
using Real = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<100>, boost::multiprecision::et_off>;

/// Rates and starts of all sizes, coefficients of some size about a time of their own.
template <int Degree, int Harmonics>
WrittenSum<Degree, Harmonics> random_sum(Random& random, double rate) {
  WrittenSum<Degree, Harmonics> f;
  for (Spin& spin : f.spin) {
    for (double& v : spin.velocity) v = rate * random.between(-1, 1);
    if (random.one_in(6)) spin.velocity = {};
    spin.start = random.one_in(3) ? -1e6 / rate : random.between(-5, 5) / rate;
  }
  if (random.one_in(4)) f.spin[1] = f.spin[0];
  const double start = random.between(-5, 5) / rate;
  for (std::size_t i = 0; i < f.size; ++i) {
    for (std::size_t j = 0; j < f.size; ++j) {
      if (random.one_in(4)) continue;
      double scale = (is_sine(i) ? 1 / rate : 1) * (is_sine(j) ? 1 / rate : 1);
      f.p[i][j].start = start;
      for (double& c : f.p[i][j].position.c) {
        c = scale * random.between(-1, 1);
        scale *= rate;
      }
    }
  }
  return f;
}

/// The greatest share of its bound that a polynomial is off, and the greatest bound relative to 1.
struct Widths {
  double share = 0, bound = 0;

  void take(const Ball<double>& said, const Real& truth) {
    const Real error = abs(Real(said.middle) - truth);
    share = std::max(share, said.radius > 0 ? static_cast<double>(error / Real(said.radius)) : error > 0 ? 9.0 : 0.0);
    bound = std::max(bound, said.radius);
  }
};

/// Values of f and its slope at times m + rho x.
template <class Model, class Certificate>
void compare(const Model& model, const Certificate& f, double m, double rho, Random& random, Widths& values,
             Widths& slopes, int& wrong) {
  for (const double x : {-1.0, 0.0, 1.0, random.between(-1, 1)}) {
    const Real t = Real(m) + Real(rho) * Real(x);
    const Real h = Real(rho) * Real("1e-40");
    const Real value = f.template value<Real>(t);
    const Real slope = (f.template value<Real>(t + h) - f.template value<Real>(t - h)) / Real("2e-40");
    values.take(model.derivative(0, x), value);
    slopes.take(model.derivative(1, x), slope);
    for (int n = 0; n < 2; ++n) {
      const Real& truth = n == 0 ? value : slope;
      if (const int s = model.certain_sign(n)) wrong += truth.sign() != s || Real(model.least_size(n)) > abs(truth);
      wrong += Real(model.size(n)) < abs(truth);
    }
  }
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("expansions hold the truth", "[turning_expansion]",
                       ((int Degree, int Harmonics), Degree, Harmonics), (1, 1), (2, 1), (1, 2), (2, 2)) {
  const std::uint64_t seed = 360 + Degree + 10 * Harmonics;
  CAPTURE(Degree, Harmonics, seed);
  Random random(seed);
  Widths doubles, double_slopes, extended, extended_slopes, exact, exact_slopes;
  int wrong = 0;
  for (int round = 0; round < kds::tests::rounds_here(Harmonics == 1 ? 200 : 30); ++round) {
    const double rate = random.one_in(2) ? 1 : std::pow(10.0, random.between(-9, 4));
    const auto f = random_sum<Degree, Harmonics>(random, rate);
    const double m = random.between(-5, 5) / rate;
    const double sum = Harmonics * (kds::detail::rate_bound(f.spin[0]) + kds::detail::rate_bound(f.spin[1]));
    const double rho = 0.5 / (sum > 0 ? sum : rate) * std::pow(2.0, random.integer(-8, 0));
    const kds::detail::TurningExpansion<Degree, Harmonics> expansion(f, 1, m + random.between(-5, 5) / rate);
    compare(expansion.about(m, rho), f, m, rho, random, doubles, double_slopes, wrong);
    if (expansion.outweighs(m, rho * 40)) {
      for (int i = 0; i < 20; ++i) wrong += f.template value<Real>(Real(m + rho * random.between(-40, 40))).sign() <= 0;
    }
    int exponent = 0;
    std::frexp(rho, &exponent);
    const double unit = std::ldexp(1.0, exponent - 1);
    constexpr int usual = kds::detail::usual_order<decltype(f)>, whole = kds::detail::whole_order<decltype(f)>;
    const auto fine = kds::detail::precise_turning_model<Ball<DoubleDouble>, usual>(f, 1, m, exponent - 1);
    compare(fine, f, m, unit, random, extended, extended_slopes, wrong);
    // It is multiplied by a power of two, which brings its derivatives below 1.
    const auto check_scaled = [&](auto finest, Random& points) {
      const double ratio = fine.c[1] / finest.c[1];
      const int scale = static_cast<int>(std::lround(std::log2(ratio)));
      wrong += std::abs(std::ldexp(ratio, -scale) - 1) > 1e-6;
      for (auto* numbers : {&finest.c, &finest.error}) {
        for (double& x : *numbers) x = std::ldexp(x, scale);
      }
      finest.next = std::ldexp(finest.next, scale);
      compare(finest, f, m, unit, points, exact, exact_slopes, wrong);
    };
    Random same_points = random;
    check_scaled(kds::detail::precise_turning_model<Exact, usual>(f, 1, m, exponent - 1, 160), same_points);
    check_scaled(kds::detail::precise_turning_model<Exact, whole>(f, 1, m, exponent - 1, 160), random);
  }
  CHECK(wrong == 0);
  for (const Widths* widths : {&doubles, &double_slopes, &extended, &extended_slopes, &exact, &exact_slopes}) {
    CAPTURE(widths->share, widths->bound);
    CHECK(widths->share < 1);
    CHECK(widths->share > 0.00001);
  }
  CHECK(doubles.bound < 1e-7);
  CHECK(extended.bound < 1e-11);
}

TEST_CASE("bounds of rates are above them, whatever their size", "[turning_expansion]") {
  for (const double size : {0x1p-1074, 1e-310, 1e-160, 1.0, 1e160, 1e307}) {
    const Spin spin{{3 * size, -4 * size, 12 * size}, 0};
    CHECK(kds::detail::rate_bound(spin) >= 13 * size);
    CHECK(kds::detail::rate_bound(spin) <= 13 * size * (1 + 1e-13) + 0x1p-1072);
  }
  CHECK(kds::detail::rate_bound(Spin{}) == 0);
}

}  // namespace test_turning_expansion
