// How elements are inserted into a kinetic sorted list, removed and given new motions.
#pragma once

#include "structures/rough_sort.hpp"
#include "structures/sorted_list.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace kds::structures {

// Before and after an edit: order_ has the elements in order at t+, position_ the place of each id, and slot i of
// schedule_ the failure time of the pair of places i and i + 1, none for the last place. An edit certifies the pairs
// whose elements it has changed or brought together, which are three at most, and then settles the queue.
//
// An edit may be made while swaps of this instant are still due (from a callback of another structure, say). The order
// is then that of the moment before, except for the element that the edit moves, and pairs that stay equal may be put
// in the wrong order, which no certificate shows: expect_disorder() notes the time, and certify() then looks for such
// pairs.

template <int Degree, SwapListener Listener>
void SortedList<Degree, Listener>::assign(std::span<const Entry> entries, double now) {
  Id greatest = 0;
  for (const Entry& entry : entries) {
    require_legal(entry.id, entry.motion);
    greatest = std::max(greatest, entry.id);
  }
  std::vector<bool> used(entries.empty() ? 0 : greatest + std::size_t{1});
  for (const Entry& entry : entries) {
    if (used[entry.id]) refuse_twice(entry.id);
    used[entry.id] = true;
  }
  for (std::size_t i = 0; i < order_.size(); ++i) {
    schedule_.clear(static_cast<Slot>(i));
    position_[order_[i].id] = absent;
  }
  if (!entries.empty()) make_room(greatest);
  schedule_.resize(entries.size());
  sort(entries, now);
  renumber(0);
  certify_all(now);
  settle();
  count_held();
}

/// Fills order_. Values in doubles, computed once each, decide where neighbours differ by more than their margins;
/// exact signs sort the runs of elements that are left, which mostly have one element.
template <int Degree, SwapListener Listener>
void SortedList<Degree, Listener>::sort(std::span<const Entry> entries, double now) {
  std::vector<RoughPlace> places(entries.size());
  double margin = 0;
  double size = 0;
  for (std::uint32_t i = 0; i < places.size(); ++i) {
    const auto rough = certificates::Order<Degree>::rough_value(entries[i].motion, now);
    places[i] = {rough.value, i};
    margin = std::max(margin, rough.margin);
    size += std::abs(rough.value);  // infinite or not a number if one is
  }
  if (size < never) sort_roughly(places);
  for (std::size_t begin = 0, end; begin < places.size(); begin = end) {
    end = begin + 1;
    while (end < places.size() && !(places[end].value - places[end - 1].value > 2 * margin && size < never)) ++end;
    if (end == begin + 1) continue;
    std::sort(places.data() + begin, places.data() + end, [&](const RoughPlace& a, const RoughPlace& b) {
      return a.entry != b.entry && in_order(entries[a.entry], entries[b.entry], now);
    });
  }
  // The vector's memory is used again, unless it is where the entries are.
  const std::less<const Entry*> before;
  LargeVector<Entry> own;
  if (!before(entries.data(), order_.data()) && before(entries.data(), order_.data() + order_.size())) {
    own.swap(order_);
  }
  order_.clear();
  order_.reserve(entries.size());
  for (const RoughPlace& place : places) order_.push_back(entries[place.entry]);
}

template <int Degree, SwapListener Listener>
void SortedList<Degree, Listener>::certify_all(double now) {
  std::size_t i = 0;
  if (now != disturbed_) {
    for (; i + 2 < order_.size(); i += 2) {
      const auto slot = static_cast<Slot>(i);
      schedule_.certify_two(slot, pair(i), slot + 1, pair(i + 1), now);
    }
  }
  for (; i < order_.size(); ++i) certify(i, now);
}

template <int Degree, SwapListener Listener>
void SortedList<Degree, Listener>::insert(Id id, const Motion<Degree>& motion, double now) {
  require_legal(id, motion);
  if (contains(id)) refuse_twice(id);
  make_room(id);
  expect_disorder(now);
  const Entry entry{motion, id};
  const auto place = std::partition_point(order_.begin(), order_.end(),
                                          [&](const Entry& other) { return in_order(other, entry, now); });
  const auto index = static_cast<std::size_t>(place - order_.begin());
  order_.insert(place, entry);
  schedule_.insert_slot(static_cast<Slot>(index));
  renumber(index);
  if (index > 0) certify(index - 1, now);
  certify(index, now);
  settle();
  count_held();
}

template <int Degree, SwapListener Listener>
void SortedList<Degree, Listener>::remove(Id id, double now) {
  require(id);
  expect_disorder(now);
  const std::size_t index = position_[id];
  schedule_.erase_slot(static_cast<Slot>(index));
  order_.erase(order_.begin() + static_cast<std::ptrdiff_t>(index));
  position_[id] = absent;
  renumber(index);
  if (index > 0) certify(index - 1, now);
  settle();
}

template <int Degree, SwapListener Listener>
void SortedList<Degree, Listener>::update(Id id, const Motion<Degree>& motion, double now) {
  require(id);
  require_finite(id, motion);
  expect_disorder(now);
  const std::size_t before = position_[id];
  std::size_t index = before;
  order_[index].motion = motion;
  while (index > 0 && !in_order(order_[index - 1], order_[index], now)) {
    exchange(--index);
    listener_.swapped(order_[index].id, order_[index + 1].id, now);
  }
  while (index + 1 < order_.size() && !in_order(order_[index], order_[index + 1], now)) {
    exchange(index++);
    listener_.swapped(order_[index - 1].id, order_[index].id, now);
  }
  // The pairs on both sides of the element, and the pair that closed up where it left. Elements it has passed keep
  // their neighbours, and a slot is the left element's, so nothing else changes.
  schedule_.move_slot(static_cast<Slot>(before), static_cast<Slot>(index));
  if (index > 0) certify(index - 1, now);
  certify(index, now);
  if (index < before) {
    certify(before, now);
  } else if (index > before && before > 0) {
    certify(before - 1, now);
  }
  settle();
}

template <int Degree, SwapListener Listener>
void SortedList<Degree, Listener>::turn_round(double now, double horizon) {
  for (Entry& entry : order_) entry.motion = reversed(entry.motion);
  schedule_.set_horizon(horizon);
  disturbed_ = now;  // The edit may have been made amidst the events of this time.
  certify_all(now);
  settle();
}

}  // namespace kds::structures
