// When gaps are all closed: exact signs where a filter in doubles does not decide.
#pragma once

#include "kds/roots/failure_time.hpp"

#include <algorithm>
#include <cstddef>

namespace kds::collision {

/// See below.
template <class Gaps>
bool find_more(const Gaps& gaps, double from, double until) {
  if constexpr (requires { gaps.find_more(from, until); }) {
    return gaps.find_more(from, until);
  } else {
    return false;
  }
}

/// A set of certificates that hold while a gap is open, with a filter that decides most of their signs cheaply.
///
/// `surely_closed(i, t)`: certificate i is broken just after t; false means undecided. `closed_until(i, t)`: if it is
/// broken just after t, a time not before t up to which it stays broken, or `never` if it always does. `opened_by(i)`:
/// if it may touch at the start, a time by which it has certainly opened without closing in between, or `never`.
/// `failure_time(i, t, horizon)`, `recovery_time(i, t, horizon)`, `closed(i, t)`: exact.
///
/// Perhaps not all certificates are known at first: then `find_more(from, until)` makes those known that are not surely
/// closed all the time between two times, or where one of them is open some of these, and says whether there were any.
///
/// The answers below are those of certificates/conjunction.hpp, bit for bit, whatever the filter decides.
template <class Gaps>
bool all_closed(const Gaps& gaps, double t) {
  std::size_t i = 0;
  do {
    for (; i < gaps.size(); ++i) {
      if (!gaps.surely_closed(i, t) && !gaps.closed(i, t)) return false;
    }
  } while (find_more(gaps, t, t));
  return true;
}

/// The first double t in [now, horizon] just after which all gaps are closed, or `never`.
template <class Gaps>
double first_all_closed(const Gaps& gaps, double now, double horizon) {
  double t = now;
  std::size_t just_closed = gaps.size();
  for (bool moved = true; moved;) {
    moved = false;
    for (std::size_t i = 0; i < gaps.size(); ++i) {
      if (i == just_closed || gaps.surely_closed(i, t)) continue;
      const double failure = gaps.failure_time(i, t, horizon);
      if (failure == never) return never;
      if (failure == t) continue;
      t = failure;
      just_closed = i;
      moved = true;
    }
    moved = moved || find_more(gaps, t, t);
  }
  return t;
}

/// If just after the start all gaps are certainly closed except one, which may touch there and only opens: a time by
/// which it has opened while the others have stayed closed; otherwise the start. If all gaps are closed at the start,
/// which then is by rounding, that state ends once before this time, when the one opens, and does not return.
template <class Gaps>
double opened_after_touch(const Gaps& gaps, double start) {
  find_more(gaps, start, start);
  for (;;) {
    std::size_t touching = gaps.size();
    for (std::size_t i = 0; i < gaps.size(); ++i) {
      if (gaps.surely_closed(i, start)) continue;
      if (touching != gaps.size()) return start;
      touching = i;
    }
    if (touching == gaps.size()) return start;
    const double opened = gaps.opened_by(touching);
    if (opened == never) return start;
    for (std::size_t i = 0; i < gaps.size(); ++i) {
      if (i != touching && !(gaps.closed_until(i, start) > opened)) return start;
    }
    if (!find_more(gaps, start, opened)) return opened;
  }
}

/// The first double t in [now, horizon] just after which some gap is open, or `never`. The one that is expected to open
/// first is tested first; most others then need no test.
template <class Gaps>
double first_any_open(const Gaps& gaps, double now, double horizon) {
  find_more(gaps, now, now);
  double first = never;
  for (std::size_t known = 0;;) {
    std::size_t earliest = gaps.size();
    double least = first;
    for (std::size_t i = known; i < gaps.size(); ++i) {
      const double until = gaps.closed_until(i, now);
      if (until < least) {
        least = until;
        earliest = i;
      }
    }
    if (earliest != gaps.size()) first = std::min(first, gaps.recovery_time(earliest, now, std::min(first, horizon)));
    for (std::size_t i = known; i < gaps.size(); ++i) {
      if (i == earliest) continue;
      const double until = gaps.closed_until(i, now);
      if (until >= first || until > horizon) continue;
      first = std::min(first, gaps.recovery_time(i, now, std::min(first, horizon)));
    }
    known = gaps.size();
    if (!find_more(gaps, now, std::min(first, horizon))) return first;
  }
}

}  // namespace kds::collision
