// How a kinetic sorted list checks itself, is measured, and is saved.
#pragma once

#include "structures/sorted_list.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

namespace kds::structures {

template <int Degree, class Listener, class Queue, FailureTimeSolver Solver>
requires EventQueue<Queue> || std::same_as<Queue, PlaceQueue>
void SortedList<Degree, Listener, Queue, Solver>::audit(double now) const {
  const auto fail = [](std::size_t i, const char* what) {
    throw AuditFailure("SortedList: place " + std::to_string(i) + ": " + what);
  };
  for (std::size_t i = 0; i < order_.size(); ++i) {
    const Id id = order_[i].id;
    if (position_[id] != i) fail(i, "the element's recorded position is another");
    double t = never;
    if (i + 1 < order_.size()) {
      const bool ordered = in_order(order_[i], order_[i + 1], now);
      if (!ordered && !(schedule_.time(slot(i)) <= now)) fail(i, "greater than its right neighbour");
      t = failure_time(pair(i), now, schedule_.horizon());
      if (!ordered && now == disturbed_) t = now;  // a tie to be settled, perhaps
    }
    if constexpr (!Solver::certified) continue;  // It may be wrong about times.
    if (schedule_.contains(slot(i)) != (t != never)) fail(i, "an event is missing or stands without cause");
    if (schedule_.contains(slot(i)) && schedule_.time(slot(i)) != t) fail(i, "the scheduled swap has the wrong time");
  }
}

template <int Degree, class Listener, class Queue, FailureTimeSolver Solver>
requires EventQueue<Queue> || std::same_as<Queue, PlaceQueue> Measures
SortedList<Degree, Listener, Queue, Solver>::measures()
const {
  Measures result = measures_;
  result.events = result.external = counters().events;
  result.held = pairs();
  result.most_per_element = std::min<std::uint64_t>(pairs(), 2);
  return result;
}

template <int Degree, class Listener, class Queue, FailureTimeSolver Solver>
requires EventQueue<Queue> || std::same_as<Queue, PlaceQueue>
template <class Archive>
void SortedList<Degree, Listener, Queue, Solver>::archive(Archive& archive) {
  archive.tag("SortedList of degree " + std::to_string(Degree) + (by_place ? ", events by place" : ", events by id"));
  archive(order_, position_, disturbed_, schedule_, measures_);
  if constexpr (requires { listener_.archive(archive); }) listener_.archive(archive);
  if constexpr (Archive::loading) {
    const std::size_t slots = schedule_.queue().slots();
    archive.require(slots == (by_place ? order_.size() : position_.size()), "a list has not one event for each place");
    for (std::size_t i = 0; i < order_.size(); ++i) {
      const Id id = order_[i].id;
      archive.require(id < position_.size() && position_[id] == i, "an element of a list stands at another place");
      archive.require(is_finite(order_[i].motion), "the motion of an element of a list is not finite");
    }
    const auto absentees = std::count(position_.begin(), position_.end(), absent);
    archive.require(position_.size() - static_cast<std::size_t>(absentees) == order_.size(),
                    "a list knows the place of an element that it has not");
    for (Slot event = 0; event < slots; ++event) {
      if (!schedule_.contains(event)) continue;
      archive.require((by_place || position_[event] != absent) && left_of(event) + 1 < order_.size(),
                      "a list has an event of no pair");
    }
    archive.require(!std::isnan(disturbed_), "a time is not a number");
    settle();
  }
}

}  // namespace kds::structures
