// Where a coordinate is in its period: beyond an end, or so near to one that an image is needed.
#pragma once

#include "certificates/within_limit.hpp"
#include "kds/arithmetic/lattice.hpp"
#include "kds/certificate.hpp"
#include "kds/motion.hpp"
#include "kds/roots/failure_time.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace kds::collision {

/// The ends of the box along an axis, and the distances, in units of length, at which something changes for a body.
struct Ends {
  double min, max;
  /// A body leaves the box when its centre is this far beyond an end. It comes in as far inside the other end, so that
  /// a body at an end does not go to and fro, and that roundings do not matter.
  double slack;
  /// From an end: a body that is nearer needs an image at the other end.
  double near;
  /// A body that is farther does not need it any more.
  double far() const { return near + slack; }
};

/// What a coordinate is known to be: near one end of the box, or both, or none.
struct Zone {
  bool low = false;
  bool high = false;

  friend bool operator==(const Zone&, const Zone&) = default;
};

inline Zone zone_at(double x, const Ends& ends) { return {x<ends.min + ends.near, x> ends.max - ends.near}; }

/// The values for which a zone is right.
struct Span {
  double low, high;
};

inline Span span_of(const Zone& zone, const Ends& ends) {
  Span span{ends.min - ends.slack, ends.max + ends.slack};
  if (!zone.low) span.low = ends.min + ends.near;
  if (zone.high) span.low = std::max(span.low, ends.max - ends.far());
  if (!zone.high) span.high = ends.max - ends.near;
  if (zone.low) span.high = std::min(span.high, ends.min + ends.far());
  return span;
}

/// The first double t >= now at t+ of which a coordinate is not in a span.
template <int Degree>
double exit_time(const Motion<Degree>& x, const Span& span, double now) {
  using Within = certificates::WithinLimit<Motion<Degree>>;
  const double above = failure_time(Within{x, span.high, 1}, now);
  return std::min(above, failure_time(Within{x, span.low, -1}, now, above));
}

/// A bound on the roundings of a gap: the distance, in doubles, from a place to x(t) of a motion that is straight. The
/// position is a sum of two numbers and a product of a time known to one rounding, the gap one more: at most 5 units of
/// 2^-53 of their magnitudes.
template <int Degree>
double gap_error(const Motion<Degree>& x, double moved, double place) {
  return 0x1p-49 * (std::abs(place) + std::abs(x.position.c[0]) + std::abs(moved));
}

/// A time before which that does not happen, for the cost of a quotient where the motion is straight. The quotient and
/// the sum with the clock round by one each.
template <int Degree>
double earliest_exit(const Motion<Degree>& x, const Span& span, double now) {
  for (std::size_t i = 2; i <= Degree; ++i) {
    if (x.position.c[i] != 0) return exit_time(x, span, now);
  }
  const double speed = x.position.c[1];
  if (speed == 0) return exit_time(x, span, now);
  const double moved = speed * (now - x.start);
  const double end = speed > 0 ? span.high : span.low;
  const double gap = std::abs(end - (x.position.c[0] + moved));
  const double t = now + (gap - gap_error(x, moved, end)) / std::abs(speed) * (1 - 0x1p-50);
  return std::max(now, t - 0x1p-51 * std::abs(t));
}

/// On which side a coordinate is outside of a span at t+, if it is: -1 below, 1 above.
template <int Degree>
std::optional<int> outside(const Motion<Degree>& x, const Span& span, double t) {
  if constexpr (Degree == 1) {  // most are well inside
    const double moved = x.position.c[1] * (t - x.start);
    const double place = x.position.c[0] + moved;
    if (span.high - place > gap_error(x, moved, span.high) && place - span.low > gap_error(x, moved, span.low)) {
      return std::nullopt;
    }
  }
  using Within = certificates::WithinLimit<Motion<Degree>>;
  if (sign_after(Within{x, span.high, 1}, t) < 0) return 1;
  if (sign_after(Within{x, span.low, -1}, t) < 0) return -1;
  return std::nullopt;
}

}  // namespace kds::collision
