// The definition of an event time, word by word, over exact numbers.
#pragma once

#include "tests/support/exact_algebra.hpp"

#include <algorithm>
#include <limits>

namespace oracle {

/// The first double t in [now, horizon] just after which the condition holds; infinity if there is none.
///
/// It isolates all stretches in which the condition holds and takes the first one that owns a double: a stretch that
/// ends before the next double is never seen by a clock made of doubles.
inline double first_double(const Condition& condition, double now, double horizon) {
  for (const Stretch& stretch : stretches(condition, rational(now), time_end(horizon))) {
    const double t = stretch.begin.ceiling();
    if (!(t <= std::min(horizon, std::numeric_limits<double>::max()))) break;
    if (!stretch.end || stretch.end->compare(rational(t)) > 0) return t;
  }
  return std::numeric_limits<double>::infinity();
}

/// The first double t in [now, horizon] just after which p < 0; infinity if there is none.
inline double failure_time(const Polynomial& p, double now,
                           double horizon = std::numeric_limits<double>::infinity()) {
  return first_double({{p}, [&](const Rational& t) { return p(t) < 0; }}, now, horizon);
}

}  // namespace oracle
