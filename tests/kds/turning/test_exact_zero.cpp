// Which sums of sines and cosines are zero, by their coefficients, against their values in a hundred digits.
#include "kds/turning/exact_zero.hpp"
#include "tests/support/random_numbers.hpp"

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace test_exact_zero {
namespace {

using namespace kds;
using kds::tests::Random;
using Real = boost::multiprecision::cpp_bin_float_100;

template <class Number>
struct Factors {
  std::array<Number, 3> a, b;  // 1, cosine, rate times sine
};

template <class Number>
std::array<Number, 3> factors(const Spin& spin, double t) {
  using std::cos, std::sin, std::sqrt;
  Number square = 0;
  for (const double v : spin.velocity) square += Number(v) * Number(v);
  const Number rate = sqrt(square);
  const Number angle = rate * (Number(t) - Number(spin.start));
  return {Number(1), Number(cos(angle)), Number(rate * sin(angle))};
}

std::array<Real, 5> two_harmonics(const Spin& spin, double t) {
  const std::array<Real, 3> once = factors<Real>(spin, t);
  return {1, once[1], once[2], 2 * once[1] * once[1] - 1, 2 * once[1] * once[2]};
}

template <class Number>
Number value(const std::array<int, 9>& p, const Factors<Number>& f) {
  Number sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      if (p[3 * i + j] != 0) sum += p[3 * i + j] * f.a[i] * f.b[j];
    }
  }
  return sum;
}

TurningCoefficients<3> exact(const std::array<int, 9>& p) {
  TurningCoefficients<3> result;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) result[i][j] = Exact(static_cast<double>(p[3 * i + j]));
  }
  return result;
}

struct Pair {
  Spin a, b;
  double t;
  bool cancels;  ///< sums with coefficients of -1, 0 and 1 are zero, and not only the one without terms
};

const std::vector<Pair> pairs{
    {{{1, 0, 0}, 0}, {{0, 1, 0}, 0}, 1.5, true},
    {{{1, 0, 0}, 0}, {{0, 1, 0}, 0}, -1.5, true},
    {{{1, 1, 0}, 0}, {{0, 1, -1}, 2.5}, 1.25, true},  // as much before as after the start
    {{{1, 0, 0}, 0}, {{0, 1, 0}, 0.75}, 1.5, true},   // twice the angle
    {{{1, 0, 0}, 0.75}, {{0, 1, 0}, 0}, 1.5, true},
    {{{1, 0, 0}, 2.25}, {{0, 1, 0}, 0}, 1.5, true},
    {{{0, 0, 1}, 0}, {{2, 0, 0}, 2}, 4, true},
    {{{2, 0, 0}, 0}, {{0, 1, 0}, 0}, 0.75, false},  // twice the angle, but coefficients would have to be 2
    {{{0.5, 0, 0}, 1}, {{1, 0, 0}, 2}, 3, true},
    {{{1, 2, 3}, 0}, {{3, 2, 1}, 0}, 1, true},
    {{{2, 4, 6}, 4}, {{3, 2, 1}, 0}, 1, false},  // six times and one time: nothing coincides
    {{{1, 0, 0}, 0}, {{1, 1, 0}, 0}, 1, false},
    {{{3, 0, 0}, 0}, {{1, 0, 0}, 0}, 1, false},
    {{{0, 0, 0}, 0}, {{1, 0, 0}, 0}, 1, true},
    {{{1, 0, 0}, 1}, {{1, 1, 0}, 0}, 1, true},
    {{{0, 0, 0}, 0}, {{0, 0, 0}, 0}, 1, true},
    {{{1, 0, 0}, 1}, {{1, 1, 0}, 1}, 1, true},
};

}  // namespace

TEST_CASE("a sum of sines is zero where its value is", "[exact_zero]") {
  const std::uint64_t seed = 340;
  CAPTURE(seed);
  Random random(seed);
  int zeros = 0;
  for (const Pair& pair : pairs) {
    const AngleRelation relation = relation_at(pair.a, pair.b, pair.t);
    const Factors<double> rough{factors<double>(pair.a, pair.t), factors<double>(pair.b, pair.t)};
    const Factors<Real> fine{factors<Real>(pair.a, pair.t), factors<Real>(pair.b, pair.t)};
    CAPTURE(pair.t, pair.a.velocity[0], pair.b.velocity[0]);
    int wrong = 0;
    int found = 0;
    for (int code = 0; code < 19683; ++code) {  // all coefficients of -1, 0 and 1, but all zero
      if (code == 9841) continue;
      std::array<int, 9> p{};
      int rest = code;
      for (int& x : p) {
        x = rest % 3 - 1;
        rest /= 3;
      }
      const bool small = std::abs(value(p, rough)) < 1e-9;
      if (!small && !random.one_in(100)) continue;
      const bool zero = abs(value(p, fine)) < Real("1e-80");
      wrong += vanishes(exact(p), relation) != zero;
      found += zero;
    }
    CHECK(wrong == 0);
    CHECK((found > 0) == pair.cancels);
    zeros += found;
  }
  CHECK(zeros > 100);
}

TEST_CASE("sums of two harmonics are zero where their values are", "[exact_zero]") {
  const std::uint64_t seed = 341;
  CAPTURE(seed);
  Random random(seed);
  int wrong = 0, zeros = 0, others = 0;
  for (int round = 0; round < 1000; ++round) {
    // |a| : |b| = m : n, with the same sign or not, and with starts of their own.
    const int m = random.integer(1, 5), n = random.integer(1, 5);
    const double t = random.one_in(2) ? 1 : -1;
    Spin a{{static_cast<double>(m), 0, 0}, 0}, b{{0, static_cast<double>(n), 0}, 0};
    if (random.one_in(3)) b.start = 2 * t;  // as much before as after its start
    if (random.one_in(8)) a.velocity = {0, 0, 0};
    if (random.one_in(8)) b.start = t;
    const bool related = !random.one_in(4);
    if (!related) b.velocity[2] = 1;
    const std::array<std::array<Real, 5>, 2> fine{two_harmonics(a, t), two_harmonics(b, t)};
    // Sums that vanish where multiples of the angles agree, and else do not.
    TurningCoefficients<5> p;
    Real sum = 0;
    const auto add = [&](std::size_t i, std::size_t j, double c) {
      p[i][j] = p[i][j] + Exact(c);
      sum += c * fine[0][i] * fine[1][j];
    };
    const auto cosine = [&] { return static_cast<std::size_t>(2 * random.integer(1, 2) - 1); };
    const std::size_t k = cosine(), l = cosine(), other = cosine();
    const double c = random.integer(1, 3), sense = random.one_in(2) ? 1 : -1;
    switch (random.integer(0, 2)) {
      case 0:
        add(k, 0, c), add(0, l, -c);
        break;
      case 1:
        add(k + 1, 0, c * n), add(0, l + 1, sense * c * m);
        break;
      default:
        add(k, l, c * m * n), add(k + 1, l + 1, sense * c), add(random.one_in(2) ? 0 : other, 0, -c * m * n);
    }
    const bool zero = abs(sum) < Real("1e-80");
    wrong += vanishes(p, relation_at(a, b, t, 2)) != zero;
    (zero ? zeros : others) += 1;
  }
  CHECK(wrong == 0);
  CHECK((zeros > 50 && others > 50));
}

TEST_CASE("relations of angles are told from what is next to them", "[exact_zero]") {
  const Spin a{{1, 0, 0}, 0};
  const Spin b{{0, 1, 0}, 0};
  CHECK(relation_at(a, b, 1).first_multiple == 1);
  CHECK(relation_at(a, Spin{{0, 1 + 0x1p-52, 0}, 0}, 1).first_multiple == 0);
  CHECK(relation_at(a, Spin{{0, 1, 0x1p-500}, 0}, 1).first_multiple == 0);  // the rate is no double
  CHECK(relation_at(a, Spin{{0, 0, 2}, 0}, 1).second_multiple == 2);
  CHECK(relation_at(a, Spin{{0, 0, 3}, 0}, 1).second_multiple == 0);
  CHECK(relation_at(a, Spin{{0, 0, 3}, 0}, 1, 2).second_multiple == 3);
  CHECK(relation_at(a, Spin{{0, 0, 0.75}, 0}, 1, 2).first_multiple == 4);
  CHECK(relation_at(a, Spin{{0, 0, 5}, 0}, 1, 2).second_multiple == 0);
  CHECK(relation_at(a, b, 0).first_zero);
  CHECK(relation_at(Spin{{3, 4, 0}, 0}, Spin{{0, 0, 5}, 0}, 1).first_multiple == 1);
  // At all times: started apart nothing is related, though it is at one time.
  const Spin later{{0, 1, 0}, 2};
  CHECK(relation_at(a, later, 1).first_multiple == 1);
  CHECK(relation_throughout(a, later).first_multiple == 0);
  CHECK(relation_throughout(a, b).first_multiple == 1);
  CHECK_FALSE(relation_throughout(a, b).first_zero);
}

}  // namespace test_exact_zero
