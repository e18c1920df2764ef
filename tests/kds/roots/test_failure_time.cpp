// Failure times by hand, at the limits of the doubles, of certificates that are not one motion; and their relatives.
#include "tests/kds/roots/check_failure_time.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <cstdint>

namespace test_failure_time {
namespace {

using namespace kds;
using namespace kds::tests;

}  // namespace

TEST_CASE("the failure time of a line is the first double not before its root", "[failure_time]") {
  CHECK(failure_time(Value<1>{{{{1, -1}}, 0}}, 0) == 1);                    // a root that is a double: fails there
  CHECK(failure_time(Value<1>{{{{1, -3}}, 0}}, 0) == 1.0 / 3.0 + 0x1p-54);  // 1/3 lies above its nearest double
  CHECK(failure_time(Value<1>{{{{1, 1}}, 0}}, 0) == never);
  CHECK(failure_time(Value<1>{{{{1, 0}}, 0}}, 0) == never);
  CHECK(failure_time(Value<1>{{{{0, 0}}, 0}}, 0) == never);
  CHECK(failure_time(Value<1>{{{{0, 1}}, 0}}, 0) == never);       // zero now, and rising
  CHECK(failure_time(Value<1>{{{{0, -1}}, 0}}, 0) == 0);          // zero now, and falling: negative at 0+
  CHECK(failure_time(Value<1>{{{{-1, 1}}, 0}}, 0) == 0);          // fails already
  CHECK(failure_time(Value<1>{{{{1, -1}}, 1e9}}, 0) == 1e9 + 1);  // written about its own start
}

TEST_CASE("a touch is no failure, a crossing of odd order is one", "[failure_time]") {
  CHECK(failure_time(Value<2>{{{{1, -2, 1}}, 0}}, 0) == never);  // (t - 1)^2
  CHECK(failure_time(Value<3>{{{{1, -3, 3, -1}}, 0}}, 0) == 1);  // -(t - 1)^3
  CHECK(failure_time(Value<4>{{{{1, -4, 6, -4, 1}}, 0}}, 0) == never);
  CHECK(failure_time(Value<3>{{{{2, -5, 4, -1}}, 0}}, 0) == 2);  // -(t - 1)^2 (t - 2): touches at 1, falls at 2
  CHECK(failure_time(Value<2>{{{{-1, 2, -1}}, 0}}, 1) == 1);     // -(t - 1)^2, asked at the touch
}

TEST_CASE("zero for ever is no failure, at any degree", "[failure_time]") {
  CHECK(failure_time(Value<1>{}, 0) == never);
  CHECK(failure_time(Value<2>{}, 1e9) == never);
  CHECK(failure_time(Value<5>{}, -3) == never);
  CHECK(failure_time(Value<0>{{{{0}}, 0}}, 0) == never);
  CHECK(failure_time(Value<0>{{{{1}}, 0}}, 0) == never);
  CHECK(failure_time(Value<0>{{{{-1}}, 0}}, 3) == 3);
}

TEST_CASE("a horizon before the clock, or no number, sees nothing", "[failure_time]") {
  const Value<1> falling{{{{-1, -1}}, 0}};
  CHECK(failure_time(falling, 1, 0.5) == never);
  CHECK(failure_time(falling, 1, std::nan("")) == never);
  CHECK(failure_time(falling, 1, 1) == 1);
}

TEST_CASE("failure times of Wilkinson's polynomials", "[failure_time]") {
  for (const double sign : {1.0, -1.0}) {
    for (const double scale : {1.0, 0.1, 1e30}) {
      std::array<double, 8> roots;
      for (std::size_t i = 0; i < roots.size(); ++i) roots[i] = static_cast<double>(i + 1) * scale;
      for (const double start : {0.0, 4.5 * scale, -1.0 * scale}) {
        const auto f = polynomial_from_roots<8>(roots, sign, start);
        for (int i = 0; i <= 9; ++i) check_around(f, i * scale);
      }
    }
  }
}

TEST_CASE("crossings that come and go between two doubles are passed over", "[failure_time]") {
  // (x - 1/4)(x - 3/4) in units of the last place: negative only between two doubles.
  const double unit = 0x1p-52;
  CHECK(check(Motion<2>{{{3 * unit * unit / 16, -unit, 1}}, 1}, 1) == never);
  // The same, and then down for good near 2.
  CHECK(check(Motion<3>{{{3 * unit * unit / 16, -unit, 1, -1}}, 1}, 1) == Approx(2));
}

TEST_CASE("a dip that starts between two doubles is seen at the next one", "[failure_time]") {
  // Rises but for a wiggle around x = 1/2 ulp, so short that the slope is positive at every double; the wiggle carries
  // f below zero at one double. In units of the last place: f' = (x - 1/8)(x - 7/8), f = x^3/3 - x^2/2 + 7x/64 + f(0).
  const double u = 0x1p-52;
  for (const double f0 : {0.0, 0.01, 0.02, 0.05, 0.06}) {
    Motion<3> f{{{3 * f0, 3 * 7.0 / 64, -1.5, 1}}, 0};
    for (std::size_t i = 0; i < 4; ++i) f.position.c[i] *= std::pow(u, 3.0 - static_cast<double>(i));
    f.start = 1;
    check(f, 0);
    check(f, 1);
    check(f, 1, 1 + 2 * u);
    f.start = 1 + 8 * u;
    check(f, 0);
    check(f, 1, 2);
  }
}

TEST_CASE("failure times at the far end of the doubles", "[failure_time]") {
  CHECK(check(Motion<2>{{{1, -1e150, 1e-200}}, 0}, 0) == Approx(1e-150));  // the vertex is beyond all doubles
  CHECK(check(Motion<2>{{{1e300, 0, -least}}, 0}, 0) == never);            // the root is: 1e312
  CHECK(check(Motion<2>{{{1e300, 0, -1e-310}}, 0}, 0) == Approx(1e305));
  CHECK(check(Motion<1>{{{1, -least}}, 0}, 0) == never);
  CHECK(check(Motion<1>{{{1e-20, -least}}, 0}, 0) == Approx(1e-20 / least));
  CHECK(check(Motion<3>{{{1e300, 0, 0, -least}}, 0}, 0) == Approx(5.87e207).epsilon(0.01));
  CHECK(check(Motion<3>{{{1e300, 0, 1e-310, -least}}, 0}, 0) < never);
  CHECK(check(Motion<4>{{{1e300, -1e-8, 0, 0, 0}}, 0}, 0) == Approx(1e308));
  CHECK(check(Motion<4>{{{1e300, -1e-9, 0, 0, 0}}, 0}, 0) == never);
  CHECK(check(Motion<3>{{{1, -0x1p716, 0, 0}}, 0}, -0x1p318) == 0x1p-716);  // beyond all doubles at now
  CHECK(check(Motion<4>{{{1, -0x1p716, 0, 0, 0}}, 0}, -0x1p318, 1) == 0x1p-716);
  CHECK(check(Motion<1>{{{largest, -1}}, 0}, 0) == largest);
  CHECK(check(Motion<1>{{{largest, -1}}, 0}, 0, next_down(largest)) == never);
  CHECK(check(Motion<1>{{{-largest, -1}}, 0}, -largest) == -largest);
  CHECK(check(Motion<1>{{{largest, -largest}}, -largest}, -largest) == next_up(-largest));
}

// --- certificates that are not one motion

namespace {

/// value - x y: coefficients that cancel when they are computed, so that every rung has to do its part.
struct LessProduct {
  static constexpr int degree = 1;
  Polynomial<1> value;
  Polynomial<1> x;
  double y;

  template <class Number>
  Polynomial<1, Number> polynomial(double epoch) const {
    return about<Number>(Motion<1>{value, 0}, epoch) - about<Number>(Motion<1>{x, 0}, epoch) * y;
  }
};

oracle::Polynomial exact(const LessProduct& f) {
  const auto motion = [](const Polynomial<1>& p) { return oracle::Polynomial::motion({p.c[0], p.c[1]}, 0); };
  return motion(f.value) - motion(f.x) * oracle::Polynomial(oracle::rational(f.y));
}

}  // namespace

TEST_CASE("failure times of a slope that cancels in doubles and in double-doubles", "[failure_time]") {
  const std::uint64_t seed = 1200;
  CAPTURE(seed);
  Random random(seed);
  for (int round = 0; round < 3000; ++round) {
    LessProduct f;
    f.y = 1 + random.integer(0, 9) * 0x1p-52;
    f.x.c[1] = 1 + random.integer(0, 9) * 0x1p-52;
    f.value.c[1] = f.y * f.x.c[1];  // the slope that is left is a rounding error, or zero
    f.x.c[0] = random.one_in(2) ? 0 : random.between(-1, 1);
    f.value.c[0] = f.x.c[0] * f.y + (random.one_in(2) ? random.scaled(-108, -50) : random.scaled(-50, 10));
    const double now = random.between(-2, 2);
    const double t = failure_time(f, now);
    const double expected = oracle::failure_time(exact(f), now);
    if (t != expected) {
      INFO("round " << round << std::hexfloat << ": value " << f.value.c[0] << ' ' << f.value.c[1] << ", x " << f.x.c[0]
                    << ' ' << f.x.c[1] << ", y " << f.y << ", now " << now);
      CHECK(t == expected);
    }
  }
}

TEST_CASE("a slope that underflows in doubles has its root where it is", "[failure_time]") {
  LessProduct f;
  f.x = {{0, 1e-200}};
  f.y = 1e-200;
  f.value = {{1e-150, 0}};
  CHECK(failure_time(f, 0) == oracle::failure_time(exact(f), 0));
  CHECK(failure_time(f, 0) == Approx(1e250));
  f.value = {{1e-50, 0}};
  CHECK(failure_time(f, 0) == never);
}

// --- the relatives of failure_time

TEMPLATE_TEST_CASE_SIG("recovery is the failure of the negated certificate", "[failure_time]", FOR_DEGREES_TO_8) {
  run<Degree>(1300, 40, [](Random& random) {
    const auto f = random_motion<Degree>(random);
    const double now = random.between(-2, 2);
    const Motion<Degree> negated{-f.position, f.start};
    CHECK(recovery_time(Value<Degree>{f}, now) == expected_failure_time(negated, now));
    CHECK(recovery_time(Value<Degree>{f}, now, now + 1) == expected_failure_time(negated, now, now + 1));
  });
  CHECK(recovery_time(Value<Degree>{}, 0) == never);
}

TEMPLATE_TEST_CASE_SIG("after a turn from - to + the next failure is found without asking for the sign there",
                       "[failure_time]", FOR_DEGREES_TO_8) {
  run<Degree>(1400, 40, [](Random& random) {
    Motion<Degree> f;
    if (random.one_in(2)) {
      f = random_motion<Degree>(random);
    } else {
      std::array<double, Degree> roots;
      for (double& root : roots) root = random.integer(-2, 2);
      f = polynomial_from_roots<Degree>(roots, random.one_in(2) ? 1 : -1, 0);
    }
    const double turn = expected_failure_time(Motion<Degree>{-f.position, f.start}, -3);
    if (turn == never || turn == -3) return;
    INFO(describe(f, turn, never));
    CHECK(failure_time_after_turn(Value<Degree>{f}, turn) == expected_failure_time(f, turn));
    CHECK(failure_time_after_turn(Value<Degree>{f}, turn, turn + 0.5) == expected_failure_time(f, turn, turn + 0.5));
  });
}

TEMPLATE_TEST_CASE_SIG("what is known to be positive now may be falling", "[failure_time]", FOR_DEGREES_TO_8) {
  run<Degree>(1450, 40, [](Random& random) {
    const Motion<Degree> f = random_motion<Degree>(random);
    const double now = random.coarse();
    if (sign_after(Value<Degree>{f}, now) <= 0) return;
    INFO(describe(f, now, never));
    CHECK(failure_time_after_turn(Value<Degree>{f}, now) == expected_failure_time(f, now));
    CHECK(failure_time_after_turn(Value<Degree>{f}, now, now + 2) == expected_failure_time(f, now, now + 2));
  });
  CHECK(failure_time_after_turn(Value<Degree>{{{{1, -0.5}}, 0}}, 1) == 2);
}

TEST_CASE("f with its sign turned has all signs turned", "[failure_time]") {
  const Value<2> f{{{{1, -3, 1}}, 0.5}};
  const Negated<Value<2>> turned{f};
  for (const double t : {0.5, 1.0, 2.0, 5.0}) CHECK(sign_after(turned, t) == -sign_after(f, t));
  const Value<2> zero;
  CHECK(Negated<Value<2>>{zero}.vanishes());
  CHECK_FALSE(turned.vanishes());
}

}  // namespace test_failure_time
