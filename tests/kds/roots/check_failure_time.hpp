// Failure times against their definition: the first double just after which the exact sign is negative. The answer is
// found again by isolating all roots over the rationals, so that a missed crossing shows as surely as a wrong one.
#pragma once

#include "kds/roots/failure_time.hpp"
#include "tests/kds/roots/polynomial_families.hpp"
#include "tests/support/exact_failure_time.hpp"
#include "tests/support/random_numbers.hpp"
#include "tests/support/sanitized.hpp"

#include <catch2/catch.hpp>

#include <limits>
#include <sstream>
#include <string>
#include <vector>

namespace kds::tests {

inline constexpr double largest = std::numeric_limits<double>::max();
inline constexpr double least = std::numeric_limits<double>::denorm_min();

template <int Degree>
using Value = PolynomialCertificate<Degree>;

template <int Degree>
std::vector<oracle::Rational> exact(const Polynomial<Degree>& p) {
  std::vector<oracle::Rational> c;
  for (const double x : p.c) c.push_back(oracle::rational(x));
  return c;
}

template <int Degree>
double expected_failure_time(const Motion<Degree>& f, double now, double horizon = never) {
  return oracle::failure_time(exact(f.position), oracle::rational(f.start), now, horizon);
}

template <int Degree>
std::string describe(const Motion<Degree>& f, double now, double horizon) {
  std::ostringstream text;
  text << std::hexfloat << "c =";
  for (const double c : f.position.c) text << ' ' << c;
  text << ", start = " << f.start << ", now = " << now << ", horizon = " << horizon;
  return text.str();
}

/// The failure time, checked in full. Returns it, so that families can ask for more.
template <int Degree>
double check(const Motion<Degree>& f, double now, double horizon = never) {
  const double t = failure_time(Value<Degree>{f}, now, horizon);
  const double expected = expected_failure_time(f, now, horizon);
  bool right = t == expected;
  if (t != never) {
    // The definition on both sides of the answer, in other words than those of the expected answer.
    const auto sign = [&](double x) { return oracle::sign_after(exact(f.position), oracle::rational(f.start), x); };
    right = right && now <= t && t <= horizon && sign(t) < 0 && (t == now || sign(next_down(t)) >= 0);
  }
  if (!right) {
    INFO(describe(f, now, horizon));
    CHECK(t == expected);
    CHECK(right);
  }
  return t;
}

/// At the failure time itself, one step before it and one step after it, as clock and as horizon.
template <int Degree>
void check_around(const Motion<Degree>& f, double now) {
  const double t = check(f, now);
  if (t == never) return;
  for (const double near : {next_down(t), t, next_up(t)}) {
    if (near >= now && near < never) {
      check(f, now, near);
      check(f, near);
      check(f, near, next_up(near));
    }
  }
}

template <int Degree>
Motion<Degree> random_motion(Random& random) {
  Motion<Degree> f;
  for (double& c : f.position.c) c = random.between(-1, 1);
  f.start = random.between(-2, 2);
  return f;
}

template <int Degree, class Family>
void run(std::uint64_t seed, int rounds, Family&& family) {
  CAPTURE(Degree, seed);
  Random random(seed + Degree);
  for (int round = 0; round < rounds_here(rounds); ++round) {
    INFO("round " << round);
    family(random);
  }
}

}  // namespace kds::tests

/// The parameters of a test that is made for each degree. There is code of their own for degrees 1 and 2; to all others
/// sanitizers see the same code, in loops of another length.
#if KDS_SANITIZED
#define FOR_DEGREES_TO_8 ((int Degree), Degree), 1, 2, 3, 6
#define FOR_DEGREES_TO_10 FOR_DEGREES_TO_8, 10
#else
#define FOR_DEGREES_TO_8 ((int Degree), Degree), 1, 2, 3, 4, 5, 6, 7, 8
#define FOR_DEGREES_TO_10 FOR_DEGREES_TO_8, 9, 10
#endif
