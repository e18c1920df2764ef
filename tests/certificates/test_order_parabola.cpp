// Values that differ by a parabola: the quick answer is that of the general method, bit for bit.
#include "tests/certificates/quick_order.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <cmath>

namespace test_order_parabola {
namespace {

using namespace kds;
using namespace kds::tests;

template <int Degree>
Motion<Degree> ordinary_value(Random& random) {
  Motion<Degree> motion;
  for (std::size_t i = 0; i <= 2; ++i) motion.position.c[i] = random.between(-2, 2);
  motion.start = random.between(-2, 2);
  return motion;
}

}  // namespace

#define EACH_DEGREE_AND_START                                                                                      \
  ((int Degree, Starts starts), Degree, starts), (2, Starts::common), (2, Starts::different), (3, Starts::common), \
      (3, Starts::different)

TEMPLATE_TEST_CASE_SIG("ordinary parabolas swap at the quick answer", "[order]", EACH_DEGREE_AND_START) {
  const std::uint64_t seed = 90;
  CAPTURE(Degree, int(starts), seed);
  Random random(seed);
  Comparison comparison;
  int first_undecided = 0;
  for (int round = 0; round < 20000; ++round) {
    const auto lower = ordinary_value<Degree>(random);
    auto upper = ordinary_value<Degree>(random);
    if (starts == Starts::common) upper.start = lower.start;
    const double now = std::max(lower.start, upper.start) + random.one_in(4) * random.unit();
    const double horizon = now + random.unit();
    first_undecided += std::isnan(Order<Degree>{lower, upper}.quick_failure_time(now, horizon));
    const double t = failure_time(CarefulOrder<Degree>{{lower, upper}}, now);
    if (t < never && t > now) {
      first_undecided += std::isnan(Order<Degree>{upper, lower}.quick_failure_time_after_turn(t, never));
    }
    if (round % 4 == 0) comparison.ask_around(lower, upper, now, horizon);
  }
  comparison.report();
  CHECK(first_undecided <= 40);
}

TEMPLATE_TEST_CASE_SIG("parabolas of all sizes", "[order]", EACH_DEGREE_AND_START) {
  const std::uint64_t seed = 91;
  CAPTURE(Degree, int(starts), seed);
  Random random(seed);
  Comparison comparison;
  int moderate_undecided = 0;
  for (int round = 0; round < 4000; ++round) {
    // Roots of a size of their own, and a clock of another; beyond the limits of the quick path now and then.
    const bool moderate = !random.one_in(4);
    const int range = moderate ? 60 : random.one_in(2) ? 250 : 900;
    const int time = random.integer(-range / 4, range / 4);
    const int length = random.integer(-range, range) / 2;
    const auto draw = [&](int power) { return std::ldexp(random.between(-2, 2), length - power * time); };
    Motion<Degree> lower;
    Motion<Degree> upper;
    for (int i = 0; i <= 2; ++i) {
      lower.position.c[i] = draw(i);
      upper.position.c[i] = draw(i);
      const int nearness = random.integer(1, 52);
      if (random.one_in(6)) upper.position.c[i] = lower.position.c[i] * (1 + std::ldexp(1.0, -nearness));
    }
    lower.start = random.one_in(3) ? 0 : std::ldexp(random.between(-2, 2), time + random.integer(-8, 8));
    upper.start = lower.start;
    if (starts == Starts::different) upper.start += std::ldexp(random.between(-2, 2), time - random.integer(0, 60));
    const double now = std::max(lower.start, upper.start) + random.one_in(2) * std::ldexp(random.unit(), time);
    const int before = comparison.undecided;
    comparison.ask_around(lower, upper, now, now + std::ldexp(random.unit(), time + random.integer(-2, 4)));
    if (moderate) moderate_undecided += comparison.undecided - before;
  }
  comparison.report();
  CAPTURE(moderate_undecided, comparison.asked);
  CHECK(moderate_undecided < comparison.asked / 4);  // horizons at the last bit of the root are not for it
}

TEMPLATE_TEST_CASE_SIG("parabolas that nearly touch", "[order]", EACH_DEGREE_AND_START) {
  const std::uint64_t seed = 92;
  CAPTURE(Degree, int(starts), seed);
  Random random(seed);
  Comparison comparison;
  int decided = 0;
  for (int round = 0; round < 4000; ++round) {
    // sign (t - x) (t - y) about some start, rounded, between two values that share the rest.
    const double x = random.between(0.1, 2);
    const int nearness = random.one_in(2) ? random.integer(0, 52) : random.integer(48, 53);
    const double y = x * (1 + std::ldexp(random.between(-2, 2), -nearness));
    const double sign = random.one_in(2) ? 1 : -1;
    Motion<Degree> lower;
    if (random.one_in(2)) lower = ordinary_value<Degree>(random);
    lower.start = random.one_in(2) ? 0 : std::ldexp(random.unit(), random.integer(-4, 30));
    Motion<Degree> upper = lower;
    const std::array<double, 3> difference{sign * x * y, -sign * (x + y), sign};
    for (std::size_t i = 0; i <= 2; ++i) upper.position.c[i] += difference[i];
    if (starts == Starts::different) upper = restarted(upper, upper.start + random.between(-1, 1));
    const double now = std::max(lower.start, upper.start);
    const int before = comparison.undecided;
    const int asked = comparison.asked;
    comparison.ask_around(lower, upper, now, now + random.between(0, 3));
    decided += comparison.asked - asked - (comparison.undecided - before);
  }
  comparison.report();
  CAPTURE(decided, comparison.asked);
  CHECK(decided > comparison.asked / 5);
}

TEMPLATE_TEST_CASE_SIG("parabolas through points of the lattice", "[order]", EACH_DEGREE_AND_START) {
  const std::uint64_t seed = 93;
  CAPTURE(Degree, int(starts), seed);
  Random random(seed);
  Comparison comparison;
  for (int round = 0; round < 4000; ++round) {
    // Numbers of a few bits: roots that are doubles, ties at now, touches, lines, equal motions.
    Motion<Degree> lower;
    Motion<Degree> upper;
    for (std::size_t i = 0; i <= 2; ++i) {
      lower.position.c[i] = random.coarse();
      upper.position.c[i] = random.coarse();
    }
    lower.start = random.integer(-2, 2);
    upper.start = starts == Starts::common ? lower.start : random.integer(-2, 2);
    const double now = std::max(lower.start, upper.start) + random.integer(0, 2);
    comparison.ask_around(lower, upper, now, now + random.integer(0, 4));
  }
  comparison.report();
}

TEMPLATE_TEST_CASE_SIG("parabolas at clocks coarser than their dips", "[order]", EACH_DEGREE_AND_START) {
  const std::uint64_t seed = 95;
  CAPTURE(Degree, int(starts), seed);
  Random random(seed);
  Comparison comparison;
  for (int round = 0; round < 8000; ++round) {
    const auto lower = [&] {
      auto motion = ordinary_value<Degree>(random);
      motion.start = std::ldexp(1 + random.unit(), random.integer(40, 60));
      return motion;
    }();
    auto upper = ordinary_value<Degree>(random);
    upper.start = lower.start;
    if (starts == Starts::different) upper.start += random.integer(-3, 3) * lower.start * 0x1p-52;
    comparison.ask_around(lower, upper, std::max(lower.start, upper.start), never);
  }
  comparison.report();
}

TEMPLATE_TEST_CASE_SIG("parabolas with a root a hair from a double", "[order]", EACH_DEGREE_AND_START) {
  const std::uint64_t seed = 94;
  CAPTURE(Degree, int(starts), seed);
  Random random(seed);
  Comparison comparison;
  for (int round = 0; round < 4000; ++round) {
    // g + r x + a x^2 with g = -(r x + a x^2), in two doubles, and a hair more or less.
    const double x = random.between(0.5, 2);
    const double r = random.between(-2, 2);
    const double a = random.between(-2, 2);
    DoubleDouble g = -(DoubleDouble(r) + DoubleDouble(x) * a) * x;
    g.low += random.between(-2, 2) * std::ldexp(1.0, -random.integer(54, 100));
    Motion<Degree> lower;
    Motion<Degree> upper;
    lower.position.c[0] = -g.low;
    upper.position.c[0] = g.high;
    upper.position.c[1] = r;
    (random.one_in(2) ? upper : lower).position.c[2] = a;
    if (lower.position.c[2] != 0) lower.position.c[2] = -a;
    if (starts == Starts::different) lower.start = random.coarse();  // it is at rest, or moves on a coarse lattice
    comparison.ask_around(lower, upper, std::max(lower.start, 0.0), 2);
  }
  comparison.report();
}

TEST_CASE("cubics that share their leading coefficient are parabolas only from a common start", "[order]") {
  const Motion<3> lower{{{0, 1, 0.5, -2}}, 1};
  const Motion<3> upper{{{0.75, -1.25, 0.75, -2}}, 1};
  CHECK_FALSE(std::isnan(Order<3>{lower, upper}.quick_failure_time(1, never)));
  const Motion<3> later{{{0.75, -1.25, 0.75, -2}}, 2};
  CHECK(std::isnan(Order<3>{lower, later}.quick_failure_time(2, never)));
}

#undef EACH_DEGREE_AND_START

}  // namespace test_order_parabola
