// The order of two moving values: the quick answer and the careful one are one answer.
#include "certificates/order.hpp"
#include "tests/certificates/check_certificate.hpp"
#include "tests/support/exact_models.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>

namespace test_order {
namespace {

using namespace kds;
using namespace kds::tests;
using kds::certificates::Order;

template <int Degree>
std::string describe(const Motion<Degree>& lower, const Motion<Degree>& upper, double now, double horizon) {
  std::ostringstream text;
  text << std::hexfloat;
  for (const auto* motion : {&lower, &upper}) {
    text << (motion == &lower ? "lower" : "upper");
    for (const double c : motion->position.c) text << ' ' << c;
    text << " from " << motion->start << ", ";
  }
  text << "now " << now << ", horizon " << horizon;
  return text.str();
}

template <int Degree>
double check(const Motion<Degree>& lower, const Motion<Degree>& upper, double now, double horizon = never) {
  const Order<Degree> order{lower, upper};
  std::vector<oracle::Rational> c;
  double expected = never;
  if (lower.start == upper.start) {  // short numbers where they may be had
    for (std::size_t i = 0; i <= Degree; ++i) {
      c.push_back(oracle::rational(upper.position.c[i]) - oracle::rational(lower.position.c[i]));
    }
    expected = oracle::failure_time(c, oracle::rational(lower.start), now, horizon);
  } else {
    expected = oracle::failure_time(exact(upper) - exact(lower), now, horizon);
  }
  const double t = failure_time(order, now, horizon);
  if (t != expected) {
    INFO(describe(lower, upper, now, horizon));
    CHECK(t == expected);
  }
  return expected;
}

/// At the failure time, and one step from it, as clock and as horizon.
template <int Degree>
void check_around(const Motion<Degree>& lower, const Motion<Degree>& upper, double now) {
  const double t = check(lower, upper, now);
  if (t == never) return;
  for (const double near : {next_down(t), t, next_up(t)}) {
    if (near == never) continue;
    if (near >= now) check(lower, upper, now, near);
    check(lower, upper, near);
    check(upper, lower, near);
  }
}

template <int Degree>
Motion<Degree> random_value(Random& random, bool coarse) {
  Motion<Degree> motion;
  for (double& c : motion.position.c) c = coarse ? random.coarse() : random.between(-2, 2);
  motion.start = random_start(random, coarse);
  return motion;
}

}  // namespace

#define FOR_EACH_DEGREE ((int Degree), Degree), 1, 2, 3

TEMPLATE_TEST_CASE_SIG("the order of two values is the sign of their difference", "[order]", FOR_EACH_DEGREE) {
  const std::uint64_t seed = 80;
  CAPTURE(Degree, seed);
  Random random(seed);
  for (int round = 0; round < 300; ++round) {
    const bool coarse = random.one_in(2);
    const auto lower = random_value<Degree>(random, coarse);
    auto upper = random_value<Degree>(random, coarse);
    if (random.one_in(2)) upper.start = lower.start;
    if (Degree >= 2 && random.one_in(2)) upper.position.c[Degree] = lower.position.c[Degree];
    CAPTURE(round, describe(lower, upper, 0, never));
    CHECK(mistakes(Order<Degree>{lower, upper}, exact(upper) - exact(lower), random) == 0);
  }
}

TEMPLATE_TEST_CASE_SIG("swap times of values with a common start are right to the last bit", "[order]",
                       FOR_EACH_DEGREE) {
  const std::uint64_t seed = 81;
  CAPTURE(Degree, seed);
  Random random(seed);
  for (int round = 0; round < 400; ++round) {
    auto lower = random_value<Degree>(random, random.one_in(3));
    auto upper = random_value<Degree>(random, random.one_in(3));
    upper.start = lower.start = random.one_in(3) ? 1e9 + random.unit() : lower.start;
    for (std::size_t i = 2; i <= Degree; ++i) upper.position.c[i] = lower.position.c[i];  // a common gravity
    if (random.one_in(4)) {  // nearly equal rates, and a root far out
      upper.position.c[1] = lower.position.c[1] * (1 - 0x1p-50);
    }
    INFO("round " << round);
    check_around(lower, upper, lower.start);
    check_around(lower, upper, lower.start + random.between(-2, 2));
  }
}

TEMPLATE_TEST_CASE_SIG("swap times of values from the whole range of doubles", "[order]", FOR_EACH_DEGREE) {
  const std::uint64_t seed = 82;
  CAPTURE(Degree, seed);
  Random random(seed);
  for (int round = 0; round < 1500; ++round) {
    const int top = random.one_in(4) ? 1023 : 1000;
    const int bottom = random.one_in(4) ? top - 5 : -1074;
    const auto draw = [&] { return random.scaled(bottom, top); };
    Motion<Degree> lower;
    Motion<Degree> upper;
    for (std::size_t i = 0; i <= 1; ++i) {
      lower.position.c[i] = draw();
      upper.position.c[i] = random.one_in(3) ? lower.position.c[i] : draw();
    }
    lower.start = upper.start = random.one_in(2) ? 0 : draw();
    if (round % 8 == 0) upper.start = draw();
    const double now = random.one_in(3) ? lower.start : random.one_in(2) ? lower.start + draw() : draw();
    if (!std::isfinite(now)) continue;
    INFO("round " << round);
    check(lower, upper, now);
    check(lower, upper, now, std::max(now, std::abs(draw())));
  }
}

TEST_CASE("differences of rates beyond all doubles", "[order]") {
  const double largest = std::numeric_limits<double>::max();
  // They meet at 1/4; rates that differ by 2 * largest.
  const Motion<1> lower{{{0, largest}}, 0};
  const Motion<1> upper{{{largest / 2, -largest}}, 0};
  CHECK(check(lower, upper, 0) == 0.25);
  CHECK(check(lower, upper, 0.125) == 0.25);
  CHECK(check(lower, upper, 0.5) == 0.5);
  CHECK(check(upper, lower, 0.125) == 0.125);
  CHECK(check(upper, lower, 0.5) == never);
  // Places that differ by 2 * largest.
  CHECK(check(Motion<1>{{{-largest, largest}}, 0}, Motion<1>{{{largest, 0}}, 0}, 0) == 2);
}

TEST_CASE("order at t+: ties are settled by what comes next", "[order]") {
  const Motion<1> rest{{{1, 0}}, 0};
  const Motion<1> rising{{{0, 1}}, 0};
  CHECK(sign_after(Order<1>{rising, rest}, 0.5) == 1);
  CHECK(sign_after(Order<1>{rising, rest}, 1) == -1);  // equal at 1, and the lower one rises through
  CHECK(sign_after(Order<1>{rest, rising}, 1) == 1);
  CHECK(check(rising, rest, 0) == 1);
  CHECK(check(rest, rising, 1) == never);
  CHECK(check(rest, rising, 0) == 0);
}

TEST_CASE("values that touch do not swap", "[order]") {
  const Motion<2> ground{};
  const Motion<2> touching{{{1, -2, 1}}, 0};  // (t - 1)^2
  CHECK(check(ground, touching, 0) == never);
  CHECK(check(touching, ground, 0) == 0);
  CHECK(sign_after(Order<2>{ground, touching}, 1) == 1);
  CHECK(sign_after(Order<2>{touching, ground}, 1) == -1);
}

TEST_CASE("two values that are one for ever are in order both ways round", "[order]") {
  const Motion<2> a{{{0.1, 0.2, 0.3}}, 0.4};
  const Motion<2> b = a;
  CHECK(Order<2>{a, b}.vanishes());
  CHECK(sign_after(Order<2>{a, b}, 7) == 0);
  CHECK(check(a, b, 0) == never);
  CHECK(check(b, a, 0) == never);
  // At rest in one place, since different times.
  const Motion<2> c{{{0.1, 0, 0}}, 5};
  const Motion<2> d{{{0.1, 0, 0}}, -5};
  CHECK(Order<2>{c, d}.vanishes());
  CHECK(check(c, d, 0) == never);
  // The same line written about two starts: not seen at once, but found.
  const Motion<1> e{{{0, 1}}, 0};
  const Motion<1> f{{{1, 1}}, 1};
  CHECK_FALSE(Order<1>{e, f}.vanishes());
  CHECK(sign_after(Order<1>{e, f}, 3) == 0);
  CHECK(check(e, f, 3) == never);
}

TEST_CASE("equal leading coefficients from different starts do not make a line of a cubic", "[order]") {
  const Motion<3> lower{{{8, -1.25, 0.75, -2}}, 1};
  const Motion<3> upper{{{0.75, -1.25, 0.75, -2}}, -1};
  CHECK(check(lower, upper, -2) == -2);
  CHECK(check(upper, lower, -2) == never);
  // Of a parabola it does: bodies thrown up at different times.
  const Motion<2> early{{{0, 10, -5}}, 0};
  const Motion<2> late{{{0, 10, -5}}, 1};
  CHECK(check(late, early, 1) == 1.5);
}

TEMPLATE_TEST_CASE_SIG("what is said to vanish does", "[order]", FOR_EACH_DEGREE) {
  const std::uint64_t seed = 83;
  CAPTURE(Degree, seed);
  Random random(seed);
  int vanished = 0;
  for (int round = 0; round < 4000; ++round) {
    // Numbers of three values each: equal ones come up often.
    const auto draw = [&] {
      Motion<Degree> motion;
      for (double& c : motion.position.c) c = random.one_in(2) ? 0 : random.integer(0, 1);
      motion.start = random.integer(0, 1);
      return motion;
    };
    const auto lower = draw();
    const auto upper = draw();
    if (!Order<Degree>{lower, upper}.vanishes()) continue;
    ++vanished;
    CHECK((exact(upper) - exact(lower)).degree() < 0);
  }
  CHECK(vanished > 50);
}

#undef FOR_EACH_DEGREE

}  // namespace test_order
