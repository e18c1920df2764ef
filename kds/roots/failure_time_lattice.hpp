// Failure times by exact signs alone: slow, and never at a loss.
#pragma once

#include "kds/arithmetic/lattice.hpp"
#include "kds/certificate.hpp"

#include <cmath>
#include <cstdint>
#include <limits>

namespace kds {

namespace detail {

/// Finds where derivative number `order` of f changes sign, on a stretch with exactly one change.
template <class C>
class LatticeCrossing {
 public:
  LatticeCrossing(const C& certificate, int order)
      : certificate_(certificate), order_(static_cast<std::size_t>(order)) {}

  /// The first double in (below, above] whose sign is that of `above`. Precondition: the sign at `below` differs, and
  /// there is one change between. `guess` may be anything.
  double operator()(double below, double above, int sign_above, double guess) const {
    int without_progress = 0;
    double candidate = guess;
    while (next_up(below) < above) {
      const std::uint64_t width = lattice_distance(below, above);
      if (!(candidate > below)) candidate = next_up(below);
      if (!(candidate < above)) candidate = next_down(above);
      if (without_progress > 2) {
        candidate = lattice_middle(below, above);
        without_progress = 0;
      }
      const Step step = evaluate(candidate);
      if (step.sign == sign_above) {
        above = candidate;
      } else {
        below = candidate;
      }
      if (lattice_distance(below, above) > width / 2) ++without_progress;
      // The first double not before Newton's root; once that is known to be past the root, the one before it.
      candidate = step.newton;
      if (candidate == above) candidate = next_down(above);
    }
    return above;
  }

 private:
  struct Step {
    int sign;
    double newton;
  };

  Step evaluate(double t) const {
    ++sign_counters.extended;
    const auto f = certificate_.template polynomial<Ball<DoubleDouble>>(t);
    const auto& value = f.c[order_];
    int s = certain_sign(value);
    if (s == 0) s = exact_sign_after(certificate_, t, static_cast<int>(order_));
    const DoubleDouble slope = f.c[order_ + 1].middle * static_cast<double>(order_ + 1);
    const DoubleDouble root = -value.middle / slope + t;
    return {s, root.low > 0 ? next_up(root.high) : root.high};
  }

  const C& certificate_;
  std::size_t order_;
};

/// f > 0 just after now, linear and falling. The first double in (now, horizon] not before the root, from a guess that
/// is usually it or the one before.
template <class C>
double first_past_linear_root(const C& certificate, double now, double guess, double horizon) {
  if (!(guess <= horizon) || guess == never) guess = horizon < never ? horizon : std::numeric_limits<double>::max();
  if (extended_sign_after(certificate, guess, 0) < 0) {
    const double before = next_down(guess);
    if (!(before > now) || extended_sign_after(certificate, before, 0) >= 0) return guess;
    return LatticeCrossing<C>(certificate, 0)(now, before, -1, before);
  }
  const double after = next_up(guess);
  if (!(after <= horizon) || after == never) return never;
  if (extended_sign_after(certificate, after, 0) < 0) return after;
  const double end = horizon < never ? horizon : std::numeric_limits<double>::max();
  if (extended_sign_after(certificate, end, 0) >= 0) return never;
  return LatticeCrossing<C>(certificate, 0)(after, end, -1, after);
}

}  // namespace detail

}  // namespace kds
