// Where a sign changes, among the doubles: by signs alone.
#pragma once

#include "kds/arithmetic/lattice.hpp"
#include "kds/certificate.hpp"

#include <cmath>
#include <cstdint>
#include <limits>

namespace kds::detail {

/// Finds where derivative number `order` of f changes sign, on a stretch with exactly one change.
template <int Degree>
class LatticeCrossing {
 public:
  LatticeCrossing(const CertificateReference<Degree>& certificate, int order)
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

  CertificateReference<Degree> certificate_;
  std::size_t order_;
};

}  // namespace kds::detail
