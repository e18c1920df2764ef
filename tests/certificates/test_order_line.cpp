// Values that differ by a line: the quick answer is that of the general method, bit for bit.
#include "tests/certificates/quick_order.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

namespace test_order_line {
namespace {

using namespace kds;
using namespace kds::tests;

template <int Degree>
struct Pair {
  Motion<Degree> lower, upper;

  double later_start() const { return std::max(lower.start, upper.start); }
};

/// Places and rates of one size each, starts around a clock, an acceleration in common.
template <int Degree>
Pair<Degree> random_pair(Random& random, Starts starts, double place, double rate, double clock) {
  Pair<Degree> pair;
  for (auto* x : {&pair.lower, &pair.upper}) {
    x->position.c[0] = place * random.between(-2, 2);
    x->position.c[1] = rate * random.between(-2, 2);
    x->start = clock + random.between(-2, 2);
  }
  if (starts == Starts::common) pair.upper.start = pair.lower.start;
  if constexpr (Degree >= 2) pair.upper.position.c[2] = pair.lower.position.c[2] = rate * random.between(-1, 1);
  return pair;
}

}  // namespace

#define EACH_DEGREE_AND_START                                                                                      \
  ((int Degree, Starts starts), Degree, starts), (1, Starts::common), (1, Starts::different), (2, Starts::common), \
      (2, Starts::different), (3, Starts::common), (3, Starts::different)

TEMPLATE_TEST_CASE_SIG("ordinary lines swap at the quick answer", "[order]", EACH_DEGREE_AND_START) {
  const std::uint64_t seed = 190;
  CAPTURE(Degree, int(starts), seed);
  Random random(seed);
  Comparison comparison;
  int undecided = 0;
  for (int round = 0; round < 20000; ++round) {
    const auto pair = random_pair<Degree>(random, starts, 1, 1, 0);
    const double now = pair.later_start() + random.one_in(4) * random.unit();
    const double horizon = now + random.unit();
    undecided += std::isnan(Order<Degree>{pair.lower, pair.upper}.quick_failure_time(now, horizon));
    if (round % 4 == 0) comparison.ask_around(pair.lower, pair.upper, now, horizon);
  }
  comparison.report();
  CHECK(undecided <= 4);
  CHECK(comparison.undecided_together <= 4);
}

TEMPLATE_TEST_CASE_SIG("lines of all sizes and at all clocks", "[order]", EACH_DEGREE_AND_START) {
  const std::uint64_t seed = 191;
  CAPTURE(Degree, int(starts), seed);
  Random random(seed);
  Comparison comparison;
  for (int round = 0; round < 4000; ++round) {
    const int range = random.one_in(8) ? 1000 : random.one_in(3) ? 440 : 40;
    const double place = std::ldexp(1.0, random.integer(-range, range));
    const double rate = std::ldexp(1.0, random.integer(-range, range));
    const double clock = random.one_in(2) ? 0 : random.scaled(-range, range);
    const auto pair = random_pair<Degree>(random, starts, place, rate, clock);
    const double now = pair.later_start();
    comparison.ask_around(pair.lower, pair.upper, now, now + place / rate * random.unit());
  }
  comparison.report();
}

TEMPLATE_TEST_CASE_SIG("lines that meet at a double or a hair from one", "[order]", EACH_DEGREE_AND_START) {
  const std::uint64_t seed = 192;
  CAPTURE(Degree, int(starts), seed);
  Random random(seed);
  Comparison comparison;
  for (int round = 0; round < 4000; ++round) {
    // Short numbers, so that roots are doubles, powers of two among them; then one coefficient a few steps off.
    Pair<Degree> pair;
    for (auto* x : {&pair.lower, &pair.upper}) {
      x->position.c[0] = random.integer(-64, 64) / 8.0;
      x->position.c[1] = random.integer(-8, 8);
      x->start = random.integer(-8, 8) / 8.0;
    }
    if (starts == Starts::common) pair.upper.start = pair.lower.start;
    double& c = pair.upper.position.c[random.below(2)];
    for (int steps = random.integer(0, 2); steps > 0; --steps) c = random.one_in(2) ? next_up(c) : next_down(c);
    const double now = pair.later_start();
    comparison.ask_around(pair.lower, pair.upper, now, now + 4 * random.unit());
  }
  comparison.report();
}

TEMPLATE_TEST_CASE_SIG("lines that meet nearer to a double than doubles tell", "[order]", EACH_DEGREE_AND_START) {
  const std::uint64_t seed = 194;
  CAPTURE(Degree, int(starts), seed);
  Random random(seed);
  Comparison comparison;
  for (int round = 0; round < 4000; ++round) {
    // high + low = rate t exactly; then the low part is moved by 2^-2 to 2^-60 of itself, or not at all.
    const double rate = random.between(1, 4);
    const double t = random.between(0.5, 4);
    const auto [high, low] = two_product(rate, t);
    Pair<Degree> pair;
    pair.upper.position.c[0] = high;
    pair.upper.position.c[1] = -rate;
    pair.lower.position.c[0] = -low + (random.one_in(4) ? 0 : low * random.scaled(-60, -2));
    if (starts == Starts::different) pair.lower.start = -random.unit();
    comparison.ask_around(pair.lower, pair.upper, 0, 4 * random.unit());
  }
  comparison.report();
}

TEMPLATE_TEST_CASE_SIG("lines of nearly equal rates", "[order]", EACH_DEGREE_AND_START) {
  const std::uint64_t seed = 193;
  CAPTURE(Degree, int(starts), seed);
  Random random(seed);
  Comparison comparison;
  for (int round = 0; round < 4000; ++round) {
    auto pair = random_pair<Degree>(random, starts, std::ldexp(1.0, random.integer(-60, 0)), 1, 0);
    pair.upper.position.c[1] = pair.lower.position.c[1] - random.scaled(-70, -10);
    comparison.ask_around(pair.lower, pair.upper, pair.later_start(), pair.later_start() + random.scaled(-20, 40));
  }
  comparison.report();
}

#undef EACH_DEGREE_AND_START

}  // namespace test_order_line
