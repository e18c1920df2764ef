// Checks exercise 1, the leash.
#include "examples/course/exercises/check.hpp"
#include "kds/roots/failure_time.hpp"
#include KDS_ANSWER

#include <cstdint>

using namespace kds;
using exercises::expect;
using exercises::Leash;
using exercises::Path;

namespace {

Path path(double x, double u, double a, double y, double v, double b, double start = 0) {
  return {{Polynomial<2>{{x, u, a}}, Polynomial<2>{{y, v, b}}}, start};
}

/// By their distance at t alone. Exact: all numbers here are small multiples of 1/8.
bool apart(const Leash& leash, double t) {
  const auto [x, y] = leash.dog(t);
  const auto [u, v] = leash.owner(t);
  return (x - u) * (x - u) + (y - v) * (y - v) > leash.length * leash.length;
}

void examine() {
  const Path owner = path(1, 0.5, 0, 0, 0, 0);
  const Path runs_away = path(1, 3.5, 0, 0, 4, 0);
  const double breaks = failure_time(Leash{runs_away, owner, 5}, 0);
  expect(breaks == 1, "a dog that runs away at 5 m/s, on a leash of 5 m, fails at t = 1; yours fails at ", breaks);

  // The leash is taut at t = 2, and at no other time before t = 4.
  const Path at_rest = path(0, 0, 0, 0, 0, 0), turns_round = path(1, 4, -1, 0, 0, 0);
  expect(failure_time(Leash{turns_round, at_rest, 5}, 0) > 4,
         "a dog that turns round where the leash is taut, at t = 2, does not break it");

  // Written about a late start: the polynomial is one in the time since the epoch.
  const double late = 0x1p30;
  const Path later = path(0, 3, 0, 0, 4, 0, late), there = path(0, 0, 0, 0, 0, 0, late);
  const double then = failure_time(Leash{later, there, 5}, late);
  expect(then == late + 1, "the same at t = 2^30: it fails ", then - late, " s after, not 1 s");

  std::uint32_t dice = 1;
  const auto some = [&dice](std::uint32_t most) {
    dice = dice * 1664525u + 1013904223u;
    return static_cast<double>(dice >> 16) / 65536 * most;
  };
  const auto eighths = [&](std::uint32_t most) { return static_cast<int>(8 * some(2 * most)) / 8.0 - most; };
  for (int i = 0; i < 200; ++i) {
    const Path dog = path(eighths(4), eighths(3), eighths(2), eighths(4), eighths(3), eighths(2), eighths(2));
    const Path other = path(eighths(4), eighths(3), eighths(2), eighths(4), eighths(3), eighths(2), eighths(2));
    const Leash leash{dog, other, eighths(4) + 4.125};
    for (double t = -2; t <= 4; t += 0.25) {
      // What is shorter than the leash has a positive sign, what is longer a negative one; in between is a touch.
      const bool holds = sign_after(leash, t) >= 0;
      if (apart(leash, t)) expect(!holds, "dog ", i, " is too far away at t = ", t, ", but your sign says it holds");
      const Leash shorter{dog, other, leash.length - 0.125};
      if (!apart(shorter, t)) expect(holds, "dog ", i, " is near at t = ", t, ", but your sign says it does not hold");
    }
  }
}

}  // namespace

int main() { return exercises::check("the leash breaks when it should", examine); }
