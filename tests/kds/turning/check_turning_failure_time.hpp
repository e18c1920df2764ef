// Failure times of turning certificates against their definition: signs at many doubles, and around all low values.
#pragma once

#include "kds/arithmetic/lattice.hpp"
#include "kds/turning/turning_failure_time.hpp"
#include "tests/support/random_numbers.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace kds::tests {

/// The least value of a function near the middle one of three times, the value there being the lowest: by golden
/// sections.
template <class Value>
long double time_of_least(const Value& value, long double low, long double high) {
  constexpr long double golden = 0.61803398874989484820L;
  long double a = high - golden * (high - low), b = low + golden * (high - low);
  long double fa = value(a), fb = value(b);
  for (int i = 0; i < 100; ++i) {
    if (fa < fb) {
      high = std::exchange(b, a);
      fb = fa;
      a = high - golden * (high - low);
      fa = value(a);
    } else {
      low = std::exchange(a, b);
      fa = fb;
      b = low + golden * (high - low);
      fb = value(b);
    }
  }
  return (low + high) / 2;
}

/// How often `t`, said to be the first double in [now, horizon] just after which side * f < 0, is refuted: by its own
/// sign or that of the double before, or by one that is negative earlier, among samples and the doubles around the
/// least values between them.
template <class Certificate, class Value>
int refutations(const Certificate& f, const Value& value, int side, double now, double horizon, double t, int samples) {
  int wrong = 0;
  const auto negative = [&](double time) { return side * sign_after(f, time) < 0; };
  if (t != never) {
    wrong += !(now <= t && t <= horizon) || !negative(t);
    if (t == now) return wrong;
    wrong += negative(next_down(t));
  }
  const double stop = t == never ? horizon : next_down(t);
  const auto signed_value = [&](long double time) { return side * value(time); };
  std::vector<double> times;
  for (int i = 0; i <= samples; ++i) {
    times.push_back(std::clamp(now + (stop - now) * (static_cast<double>(i) / samples), now, stop));
  }
  for (const double time : times) wrong += negative(time);
  for (std::size_t i = 1; i + 1 < times.size(); ++i) {
    const long double here = signed_value(times[i]);
    if (here > signed_value(times[i - 1]) || here > signed_value(times[i + 1])) continue;
    const double least = static_cast<double>(time_of_least(signed_value, times[i - 1], times[i + 1]));
    for (int step = -8; step <= 8; ++step) {
      const double time = lattice_point(lattice_index(least) + step);
      if (time >= now && time <= stop) wrong += negative(time);
    }
  }
  return wrong;
}

}  // namespace kds::tests
