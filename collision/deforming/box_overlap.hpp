// When two boxes with moving sides may overlap.
#pragma once

#include "collision/deforming/moving_surface.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace kds::collision {

/// A part of a stretch of time, in s.
struct OverlapSpan {
  double begin = 0, end = 1;
};

namespace detail {

/// Not after the first s at which a polynomial with these Bernstein coefficients is >= 0; the first is negative, and
/// some other is not. The curve lies in the convex hull of its control points, which comes up to zero no earlier than
/// the first of the lines from a point below to a later one that is not: for a straight line that is the root.
///
/// Rounding: a quotient of numbers of which one is off by a rounding or two (overlap_span) and that do not cancel:
/// eight roundings at most.
template <std::size_t Count>
double rises_at(const std::array<double, Count>& gap) {
  double first = 1;
  for (std::size_t i = 0; i + 1 < Count; ++i) {
    if (gap[i] >= 0) break;  // a line from a later point crosses later than the one to this
    for (std::size_t j = i + 1; j < Count; ++j) {
      if (gap[j] < 0) continue;
      const double part = static_cast<double>(j - i) * (-gap[i] / (gap[j] - gap[i]));
      first = std::min(first, (static_cast<double>(i) + part) / (Count - 1));
    }
  }
  return first * (1 - 0x1p-49);
}

}  // namespace detail

/// Whether boxes that are widened by `widening` may overlap within the span; narrows it to when they may.
///
/// Rounding: the distance of two sides is rounded once, by u of it, and u of the sum with the widening. `widening` has
/// to be larger than what is meant by 2^-48 of it: then the sum is never below what is meant by more than a rounding of
/// what it is itself, whatever of it cancels, so that signs are right or the boxes are said to overlap.
template <int Degree>
bool overlap_span(const ControlBox<Degree>& a, const ControlBox<Degree>& b, double widening, OverlapSpan& span) {
  constexpr std::size_t count = std::size_t{Degree} + 1;
  std::array<std::array<double, count>, 6> gaps;
  bool cut = false;
  for (std::size_t d = 0; d < 3; ++d) {
    bool left = true, right = true;
    for (std::size_t i = 0; i < count; ++i) {
      gaps[d][i] = (a.max[i][d] - b.min[i][d]) + widening;
      gaps[d + 3][i] = (b.max[i][d] - a.min[i][d]) + widening;
      left = left && gaps[d][i] < 0;
      right = right && gaps[d + 3][i] < 0;
      cut = cut || gaps[d][i] < 0 || gaps[d + 3][i] < 0;
    }
    if (left || right) return false;
  }
  if (!cut) return true;
  for (const auto& gap : gaps) {
    if (gap[0] < 0) span.begin = std::max(span.begin, detail::rises_at(gap));
    if (gap[count - 1] < 0) {
      std::array<double, count> backward;
      std::reverse_copy(gap.begin(), gap.end(), backward.begin());
      span.end = std::min(span.end, 1 - detail::rises_at(backward) + 0x1p-52);  // and the rounding of the difference
    }
  }
  return span.begin <= span.end;
}

}  // namespace kds::collision
