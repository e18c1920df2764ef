// How a kinetic sorted list checks itself, is measured, and is saved.
#pragma once

#include "structures/sorted_list.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

namespace kds::structures {

/// The proof of the state: every pair of neighbours is in order at t+, or a swap of it is due; the failure time of each
/// pair within the horizon is in the slot of its left element's place, and nothing else is scheduled; and position_ is
/// the inverse of order_. At the time of a change amidst events, a pair that stays equal may stand in the wrong order
/// until its event, which is due at once.
template <int Degree, SwapListener Listener>
void SortedList<Degree, Listener>::audit(double now) const {
  const auto fail = [](std::size_t i, const char* what) {
    throw AuditFailure("SortedList: place " + std::to_string(i) + ": " + what);
  };
  for (std::size_t i = 0; i < order_.size(); ++i) {
    const auto slot = static_cast<Slot>(i);
    if (position_[order_[i].id] != i) fail(i, "the element's recorded position is another");
    double t = never;
    if (i + 1 < order_.size()) {
      const bool ordered = in_order(order_[i], order_[i + 1], now);
      if (!ordered && !(schedule_.time(slot) <= now)) fail(i, "greater than its right neighbour");
      t = failure_time(pair(i), now, schedule_.horizon());
      if (!ordered && now == disturbed_) t = now;  // perhaps two that stay equal, whose swap is due
    }
    if (schedule_.contains(slot) != (t != never)) fail(i, "an event is missing or stands without cause");
    if (schedule_.contains(slot) && schedule_.time(slot) != t) fail(i, "the scheduled swap has the wrong time");
  }
}

template <int Degree, SwapListener Listener>
Measures SortedList<Degree, Listener>::measures() const {
  Measures result = measures_;
  result.events = result.external = counters().events;
  result.held = pairs();
  result.most_per_element = std::min<std::uint64_t>(pairs(), 2);
  return result;
}

/// Loading checks all that the list relies on except that it is in order: audit() does that.
template <int Degree, SwapListener Listener>
template <class Archive>
void SortedList<Degree, Listener>::archive(Archive& archive) {
  archive.tag("SortedList of degree " + std::to_string(Degree));
  archive(order_, position_, disturbed_, schedule_, measures_);
  static_assert(ArchivedBy<Listener, Archive> || !kds::detail::NamesArchive<Listener>,
                "swap listener: `archive` must be `template <class Archive> void archive(Archive&)`");
  if constexpr (ArchivedBy<Listener, Archive>) listener_.archive(archive);
  if constexpr (Archive::loading) {
    const std::size_t slots = schedule_.queue().slots();
    archive.require(slots == order_.size(), "a list has not one event for each place");
    for (std::size_t i = 0; i < order_.size(); ++i) {
      const Id id = order_[i].id;
      archive.require(id < position_.size() && position_[id] == i, "an element of a list stands at another place");
      archive.require(is_finite(order_[i].motion), "the motion of an element of a list is not finite");
    }
    const auto absentees = std::count(position_.begin(), position_.end(), absent);
    archive.require(position_.size() - static_cast<std::size_t>(absentees) == order_.size(),
                    "a list knows the place of an element that it has not");
    for (Slot event = 0; event < slots; ++event) {
      archive.require(!schedule_.contains(event) || event + std::size_t{1} < slots, "a list has an event of no pair");
    }
    archive.require(!std::isnan(disturbed_), "a time is not a number");
    settle();
  }
}

}  // namespace kds::structures
