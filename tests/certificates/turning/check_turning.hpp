// Signs of turning certificates against the truth: anywhere, and at the doubles around their roots.
#pragma once

#include "kds/arithmetic/lattice.hpp"
#include "kds/turning/turning_certificate.hpp"
#include "tests/certificates/turning/true_turning.hpp"
#include "tests/support/random_numbers.hpp"

#include <cmath>
#include <cstdint>
#include <cstdio>

namespace kds::tests {

/// What the ladder did.
struct LadderTally {
  std::uint64_t cases = 0, wrong = 0, zeros_throughout = 0;
  TurningSignCounters rungs;

  void print(const char* what, std::uint64_t seed) const {
    std::printf(
        "%s, seed %llu: %llu signs, %llu wrong; asked for double-doubles %llu, exact %llu (zero %llu), "
        "enclosures %llu; zero throughout %llu\n",
        what, static_cast<unsigned long long>(seed), static_cast<unsigned long long>(cases),
        static_cast<unsigned long long>(wrong), static_cast<unsigned long long>(rungs.extended),
        static_cast<unsigned long long>(rungs.exact), static_cast<unsigned long long>(rungs.zeros),
        static_cast<unsigned long long>(rungs.enclosed), static_cast<unsigned long long>(zeros_throughout));
  }
};

/// The double at which the sign differs from that of the one before, between t0 and t1, which have different ones.
template <class Certificate>
double change_of_sign(const Certificate& f, double t0, double t1) {
  const int before = sign_after(f, t0);
  while (next_up(t0) < t1) {
    const double middle = lattice_middle(t0, t1);
    (sign_after(f, middle) == before ? t0 : t1) = middle;
  }
  return t1;
}

/// Compares the signs at t and three doubles on either side, at the times and just after them.
template <class Certificate>
void compare_around(const Certificate& f, double t, LadderTally& tally) {
  TrueSigns<Certificate> truth(f, t);
  for (int step = -3; step <= 3; ++step) {
    // Next to zero doubles are so dense that the truth would need more digits.
    const double time = std::abs(t) > 1e-25 ? lattice_point(lattice_index(t) + step) : t + step * 0x1p-50;
    const int expected = truth.at(time);
    tally.wrong += kds::sign_at(f, time) != expected;
    ++tally.cases;
    if (expected != 0 && step != 0) continue;
    tally.wrong += sign_after(f, time) != truth.after(time);
    tally.wrong += kds::sign_at(f, time, 1) != truth.derivative_at(time);
    tally.cases += 2;
  }
}

/// Of one certificate: at its time, and around the changes of sign that eight samples show, at most two.
template <class Certificate>
void compare(const Certificate& f, double time, double span, LadderTally& tally) {
  const TurningSignCounters before = turning_sign_counters;
  TrueSigns<Certificate> truth(f, time);
  const int expected = truth.after(time);
  tally.wrong += sign_after(f, time) != expected;
  ++tally.cases;
  const bool zero = vanishes(f);
  tally.zeros_throughout += zero;
  tally.wrong += zero && expected != 0;
  if (expected == 0) compare_around(f, time, tally);
  int changes = 0;
  double t0 = time;
  for (int i = 1; i <= 8 && changes < 2; ++i) {
    const double t1 = time + i * span;
    if (sign_after(f, t0) * sign_after(f, t1) < 0) {
      compare_around(f, change_of_sign(f, t0, t1), tally);
      ++changes;
    }
    t0 = t1;
  }
  tally.rungs.extended += turning_sign_counters.extended - before.extended;
  tally.rungs.exact += turning_sign_counters.exact - before.exact;
  tally.rungs.zeros += turning_sign_counters.zeros - before.zeros;
  tally.rungs.enclosed += turning_sign_counters.enclosed - before.enclosed;
}

}  // namespace kds::tests
