// How a calendar queue goes on to its next day and to another year, and how it gives memory back.
#pragma once

#include "kds/events/calendar_queue.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

namespace kds {

/// Opens the next day that has an event. Precondition: the present day is empty, the queue is not.
template <QueueRank Rank>
void CalendarQueue<Rank>::next_day() const {
  if (bill_ > size_) end_year();
  const std::uint32_t day = next_busy_day();
  if (day == year_) return begin_year();
  open_day(day);
  if (present_.size() > long_day) bill_ += present_.size();
}

template <QueueRank Rank>
void CalendarQueue<Rank>::open_day(std::uint32_t day) const {
  today_ = day;
  tomorrow_ = day + 1.0;
  for (std::uint32_t record = take_day(day); record != none;) push_present(std::exchange(record, nodes_[record].next));
}

/// The next day with events, or year_ (the years to come) if there is none. Precondition: the queue is not empty.
template <QueueRank Rank>
inline std::uint32_t CalendarQueue<Rank>::next_busy_day() const {
  std::size_t word = today_ / 64;
  while (busy_[word] == 0) ++word;  // the bits of days gone by are clear
  return static_cast<std::uint32_t>(64 * word + static_cast<std::size_t>(std::countr_zero(busy_[word])));
}

/// Sends all events, of the present day too, to the years to come.
template <QueueRank Rank>
void CalendarQueue<Rank>::end_year() const {
  for (const Due& due : present_) link(due.record, year_);
  present_.clear();
  if (size_ == 0) return;
  for (std::uint32_t day = next_busy_day(); day != year_; day = next_busy_day()) {
    today_ = day;
    link_all(take_day(day), year_);
  }
}

/// Deals the events of the years to come, which are all there are, out into a year, and opens its first day.
template <QueueRank Rank>
void CalendarQueue<Rank>::begin_year() const {
  const double length = day_length(begin_);
  days_per_second_ = std::clamp(1 / length, std::numeric_limits<double>::min(), std::numeric_limits<double>::max());
  std::uint32_t record = take_day(year_);
  const std::size_t days = std::bit_ceil(std::max<std::size_t>(days_per_event * size_, 64));
  year_ = static_cast<std::uint32_t>(std::min(days, days_.size() - 1));
  tomorrow_ = 0;
  year_end_ = year_;
  bill_ = 0;
  while (record != none) insert(std::exchange(record, nodes_[record].next));
  open_day(0);
}

/// How long a day should be for the events of the years to come; finds the earliest on the way.
template <QueueRank Rank>
double CalendarQueue<Rank>::day_length(double& earliest) const {
  std::array<double, sample_size> sample;
  const std::size_t stride = (size_ + sample_size - 1) / sample_size;
  std::size_t seen = 0;
  earliest = detail::no_event;
  for (std::uint32_t record = days_[year_]; record != none; record = nodes_[record].next, ++seen) {
    const double time = nodes_[record].time;
    earliest = std::min(earliest, time);
    if (seen % stride == 0) sample[seen / stride] = time;
  }
  const auto begin = sample.begin();
  const auto end = begin + static_cast<std::ptrdiff_t>((seen + stride - 1) / stride);
  std::sort(begin, end);
  // So many events that one burst at the beginning does not decide the length.
  const auto near = std::max(begin + (end - begin - 1) / static_cast<std::ptrdiff_t>(near_part),
                             std::upper_bound(begin, end, earliest));
  if (near == end) return 1;  // the sample is all at one time
  const double events = static_cast<double>(near - begin + 1) * static_cast<double>(stride);
  return events_per_day * (*near - earliest) / events;
}

template <QueueRank Rank>
void CalendarQueue<Rank>::fit() {
  CalendarQueue fitted(rank_);
  fitted.nodes_.reserve(size_), fitted.slots_.reserve(size_);
  if constexpr (keeps_ranks) fitted.ranks_.reserve(size_);
  fitted.records_.swap(records_);
  for (std::uint32_t record = 0; record < nodes_.size(); ++record) {
    const Slot slot = slots_[record];
    // A record of no slot; no new record has this number yet.
    if (fitted.records_[slot] != record) continue;
    fitted.records_[slot] = none;
    fitted.set(slot, nodes_[record].time);
    if constexpr (keeps_ranks) fitted.ranks_[fitted.records_[slot]] = ranks_[record];
  }
  fitted.operations_ = operations_;
  *this = std::move(fitted);
}

}  // namespace kds
