// When a polynomial of the time is negative, in plain doubles.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

namespace kds::collision {

/// A stretch of time.
struct TimeWindow {
  double begin;
  double end;
};

/// At most two stretches of time [begin, end), in order. Empty ones have end = -infinity.
struct TimeSpans {
  static constexpr double infinity = std::numeric_limits<double>::infinity();

  std::array<double, 2> begin{infinity, infinity};
  std::array<double, 2> end{-infinity, -infinity};

  static TimeSpans always() { return {{-infinity, infinity}, {infinity, -infinity}}; }
  static TimeSpans between(double from, double to) {
    return from < to ? TimeSpans{{from, infinity}, {to, -infinity}} : TimeSpans{};
  }

  /// The first time >= tau inside, or infinity.
  double first_inside(double tau) const {
    if (tau < end[0]) return tau < begin[0] ? begin[0] : tau;
    if (tau < end[1]) return tau < begin[1] ? begin[1] : tau;
    return infinity;
  }

  bool contains(double tau) const { return first_inside(tau) == tau; }

  /// Where the stretch that contains tau begins and ends. Precondition: contains(tau).
  double enter(double tau) const { return tau < end[0] ? begin[0] : begin[1]; }
  double leave(double tau) const { return tau < end[0] ? end[0] : end[1]; }
};

/// The first time >= tau inside all of the spans, or infinity.
template <class Spans>
double first_inside_all(std::span<const Spans> spans, double tau) {
  for (bool moved = true; moved;) {
    moved = false;
    for (const Spans& each : spans) {
      const double next = each.first_inside(tau);
      if (!(next > tau)) continue;
      if (next == TimeSpans::infinity) return next;
      tau = next;
      moved = true;
    }
  }
  return tau;
}

/// Where the stretch of times inside all of the spans that contains tau begins and ends.
/// Precondition: first_inside_all(spans, tau) == tau.
template <class Spans>
double enter_all(std::span<const Spans> spans, double tau) {
  double begin = -TimeSpans::infinity;
  for (const Spans& each : spans) begin = std::max(begin, each.enter(tau));
  return begin;
}
template <class Spans>
double leave_all(std::span<const Spans> spans, double tau) {
  double end = TimeSpans::infinity;
  for (const Spans& each : spans) end = std::min(end, each.leave(tau));
  return end;
}

/// Roots of c0 + c1 x + c2 x^2 at which it falls and rises. No cancellation: the two terms of q have one sign. Exact
/// for the polynomial with coefficients changed by a few roundings; good for c2 = 0 too. Precondition: not both c1 and
/// c2 are 0; a negative discriminant counts as 0.
struct QuadraticRoots {
  double falling;
  double rising;
};
inline QuadraticRoots quadratic_roots(double c0, double c1, double c2) {
  const double discriminant = c1 * c1 - 4 * c2 * c0;
  const double root = discriminant > 0 ? std::sqrt(discriminant) : 0.0;
  if (c1 > 0) {
    const double q = -0.5 * (c1 + root);
    return {q / c2, c0 / q};
  }
  const double q = 0.5 * (root - c1);
  return {c0 / q, q / c2};
}

/// When c0 + c1 x < 0.
inline TimeSpans negative_spans(double c0, double c1) {
  if (c1 > 0) return TimeSpans::between(-TimeSpans::infinity, -c0 / c1);
  if (c1 < 0) return TimeSpans::between(-c0 / c1, TimeSpans::infinity);
  return c0 < 0 ? TimeSpans::always() : TimeSpans{};
}

/// When c0 + c1 x + c2 x^2 < 0 (<= 0 at the double root of a parabola that is negative elsewhere).
inline TimeSpans negative_spans(double c0, double c1, double c2) {
  if (c2 == 0) return negative_spans(c0, c1);
  if (!(c1 * c1 - 4 * c2 * c0 > 0)) return c2 > 0 ? TimeSpans{} : TimeSpans::always();
  const auto [falling, rising] = quadratic_roots(c0, c1, c2);
  if (c2 > 0) return TimeSpans::between(falling, rising);
  return {{-TimeSpans::infinity, falling}, {rising, TimeSpans::infinity}};
}

/// Shrinks the window to the hull of the times in it at which c0 + c1 x < 0; false if there are none.
inline bool clip_to_negative(double c0, double c1, TimeWindow& window) {
  const double at_begin = c0 + c1 * window.begin;
  const double at_end = c0 + c1 * window.end;
  if (at_begin >= 0) {
    if (at_end >= 0) return false;
    window.begin = std::max(window.begin, -c0 / c1);
  } else if (at_end >= 0) {
    window.end = std::min(window.end, -c0 / c1);
  }
  return window.begin <= window.end;
}

/// The same for c0 + c1 x + c2 x^2.
inline bool clip_to_negative(double c0, double c1, double c2, TimeWindow& window) {
  const double at_begin = c0 + window.begin * (c1 + window.begin * c2);
  const double at_end = c0 + window.end * (c1 + window.end * c2);
  if (at_begin < 0 && at_end < 0) return true;
  if (at_begin >= 0 && at_end >= 0) {
    // Negative only in between, around the lowest point.
    if (!(c2 > 0) || !(c1 < -2 * c2 * window.begin) || !(c1 > -2 * c2 * window.end)) return false;
    if (!(c1 * c1 - 4 * c2 * c0 > 0)) return false;
  }
  const auto [falling, rising] = quadratic_roots(c0, c1, c2);
  if (at_begin >= 0) window.begin = std::max(window.begin, falling);
  if (at_end >= 0) window.end = std::min(window.end, rising);
  return window.begin <= window.end;
}

}  // namespace kds::collision
