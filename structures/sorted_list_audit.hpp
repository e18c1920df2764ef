// How a kinetic sorted list checks itself, is measured, and is saved.
#pragma once

#include "structures/sorted_list.hpp"

#include <algorithm>
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
  if constexpr (Archive::loading) settle();
}

}  // namespace kds::structures
