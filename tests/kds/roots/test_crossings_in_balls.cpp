// Isolation in doubles: what is claimed holds for every polynomial within the balls.
#include "kds/roots/first_crossing.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace kds::tests::test_crossings_in_balls {
namespace {

constexpr std::array<double, 6> binomials{1, 5, 10, 10, 5, 1};

/// The polynomial whose Bernstein coefficients over all x >= 0 (see first_crossing) are these.
Polynomial<5, Ball<double>> from_bernstein(const std::array<double, 6>& b, double radius) {
  Polynomial<5, Ball<double>> p;
  for (std::size_t i = 0; i < 6; ++i) p.c[i] = {b[i] * binomials[i], radius * binomials[i]};
  return p;
}

template <int Degree>
double value(const std::array<double, Degree + 1>& c, double x) {
  double sum = 0;
  for (std::size_t i = Degree + 1; i-- > 0;) sum = sum * x + c[i];
  return sum;
}

}  // namespace

TEST_CASE("several coefficients that may have either sign isolate nothing", "[first_crossing]") {
  // Within the radius lies one with the signs + - - + + -, which turns three times.
  const auto p = from_bernstein({2, 0, 0, 0, 0, -2}, 0.99);
  std::array<double, 6> hidden{1.01, -0.99, -0.99, 0.99, 0.99, -1.01};
  for (std::size_t i = 0; i < 6; ++i) hidden[i] *= binomials[i];
  REQUIRE(value<5>(hidden, 1.0 / 3) < 0);
  REQUIRE(value<5>(hidden, 3) > 0);
  CHECK(first_crossing(p, INFINITY).status != Crossing::Status::isolated);
}

TEST_CASE("one coefficient that may have either sign does no harm", "[first_crossing]") {
  const auto p = from_bernstein({2, 2, 0, -2, -2, -2}, 0.01);
  CHECK(first_crossing(p, INFINITY).status == Crossing::Status::isolated);
}

TEST_CASE("what first_crossing says of balls is true of polynomials within them", "[first_crossing]") {
  const std::uint64_t seed = 800;
  CAPTURE(seed);
  Random random(seed);
  std::array<int, 3> met{};
  for (int round = 0; round < 20000; ++round) {
    Polynomial<4, Ball<double>> p;
    const double radius = std::ldexp(1.0, random.integer(-12, -1));
    for (auto& c : p.c) c = {random.between(-1, 1), radius};
    p.c[0].middle = radius * (1 + random.unit() * 8);
    const double end = random.one_in(2) ? INFINITY : random.between(0, 3);
    const Crossing crossing = first_crossing(p, end);
    ++met[static_cast<std::size_t>(crossing.status)];
    if (crossing.status == Crossing::Status::undecided) continue;
    bool right = true;
    for (int sample = 0; sample < 8; ++sample) {
      std::array<double, 5> c;
      for (std::size_t i = 0; i < 5; ++i) {
        c[i] = p.c[i].middle + radius * (random.one_in(2) ? random.between(-1, 1) : (random.one_in(2) ? 1 : -1));
      }
      // On a grid of x = w / (1 - w): signs far from zero must be as claimed.
      int turns = 0;
      int sign = 1;
      for (double w = 1.0 / 256; w < 1; w += 1.0 / 256) {
        const double x = w / (1 - w);
        if (x > end) break;
        const double f = value<4>(c, x);
        if (std::abs(f) < 1e-9 * (1 + x * x * x * x)) continue;
        const int now = f > 0 ? 1 : -1;
        if (crossing.status == Crossing::Status::none) right = right && now > 0;
        if (crossing.status == Crossing::Status::isolated) {
          if (x <= crossing.after * (1 - 1e-12)) right = right && now > 0;
          if (x < crossing.before * (1 - 1e-12)) {
            turns += now != sign;
            sign = now;
          }
        }
      }
      right = right && turns <= 1;
    }
    CAPTURE(round);
    REQUIRE(right);
  }
  CHECK(met[0] > 1000);
  CHECK(met[1] > 300);
}

}  // namespace kds::tests::test_crossings_in_balls
