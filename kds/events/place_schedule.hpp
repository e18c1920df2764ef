// The certificates of neighbours in a row, and the times at which they fail.
#pragma once

#include "kds/events/place_queue.hpp"
#include "kds/events/schedule.hpp"

#include <cmath>
#include <limits>
#include <utility>

namespace kds {

/// A Schedule whose slots are places in a row: that of the certificate between the elements at places i and i + 1 is i.
///
/// Laws: (1) settle() comes after each change, before the next event is asked for (see PlaceQueue); (2) a failure time
/// is that of failure_time(), however it is computed, so certifying two or three places together changes only the cost.
class PlaceSchedule : public Schedule<PlaceQueue> {
 public:
  // See PlaceQueue.
  void insert_slot(Slot place) { queue_.insert_slot(place); }
  void erase_slot(Slot place) { queue_.erase_slot(place); }
  void move_slot(Slot from, Slot to) { queue_.move_slot(from, to); }
  template <class Rank>
  void settle(Rank&& rank) {
    queue_.settle(rank);
  }

  /// After a swap: the certificate at `middle` is positive just after now, those on its left and right are new.
  template <Certificate C>
  void certify_three(Slot middle, const C& left, const C& turned, const C& right, double now) {
    counters_.certificates += 3;
    const TwoTimes times = failure_times(left, right, now);
    queue_.set_three(middle, times.first, failure_time_after_turn(turned, now, horizon()), times.second);
  }

  /// Certifies two new certificates.
  template <Certificate C>
  void certify_two(Slot first, const C& a, Slot second, const C& b, double now) {
    counters_.certificates += 2;
    const TwoTimes times = failure_times(a, b, now);
    set(first, times.first);
    set(second, times.second);
  }

 private:
  template <Certificate C>
  TwoTimes failure_times(const C& a, const C& b, double now) const {
    static_assert(detail::RightHooks<C>::checked);
    constexpr double undecided = std::numeric_limits<double>::quiet_NaN();
    TwoTimes times{undecided, undecided};
    if constexpr (AnswersQuicklyForTwo<C>) {
      if (now <= horizon()) times = C::quick_failure_times(a, b, now, horizon());
    }
    times.first = completed(times.first, a, now);
    times.second = completed(times.second, b, now);
    return times;
  }

  /// The quick answer, or where there is none that of failure_time().
  template <Certificate C>
  double completed(double quick, const C& certificate, double now) const {
    if (__builtin_expect(std::isnan(quick), 0)) return failure_time(certificate, now, horizon());
    detail::check_failure_time<detail::Hook::quick_failure_times>("quick_failure_times", certificate, quick, now,
                                                                  horizon());
    return quick;
  }
};

}  // namespace kds
