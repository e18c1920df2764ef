// Whether a time is the first at which a gap is closed, by sampling a function that says how wide it is.
#pragma once

#include "kds/arithmetic/lattice.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace kds::tests {

struct FirstTimeVerdict {
  bool missed = false;  ///< it is closed, by more than the tolerance, before
  bool wrong = false;   ///< it is neither closed nor about to be there
};

/// `gap(t)`: known to `tolerance`. Least gaps between samples are searched for by the golden section.
template <class Gap>
FirstTimeVerdict check_first_time(const Gap& gap, double t0, double horizon, double found, double tolerance,
                                  int samples) {
  FirstTimeVerdict verdict;
  if (found == t0) return {false, gap(t0) > tolerance};
  const double until = std::min(found, horizon);
  const auto at = [&](double i) { return t0 + (until - t0) * i / samples; };
  std::vector<double> width;
  for (int i = 0; i <= samples; ++i) width.push_back(gap(at(i)));
  for (std::size_t k = 1; k + 1 < width.size(); ++k) {
    verdict.missed = verdict.missed || width[k] < -tolerance;
    if (width[k] > width[k - 1] || width[k] > width[k + 1]) continue;
    double low = at(static_cast<double>(k) - 1), high = at(static_cast<double>(k) + 1);
    for (int round = 0; round < 40; ++round) {
      const double left = low + (high - low) * 0.382, right = low + (high - low) * 0.618;
      if (gap(left) < gap(right)) {
        high = right;
      } else {
        low = left;
      }
    }
    verdict.missed = verdict.missed || gap(low) < -tolerance;
  }
  if (found != never) verdict.wrong = std::abs(gap(found)) > tolerance;
  return verdict;
}

}  // namespace kds::tests
