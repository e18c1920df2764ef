// Event queue in buckets of time: a calendar whose days adapt to the events in it. calendar_queue_years.hpp has the
// turn of its days and years, and how it gives memory back.
#pragma once

#include "kds/events/event_queue.hpp"
#include "kds/large_vector.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace kds {

/// A calendar queue: amortised O(1) for set, clear and pop. At most `most_slots`: resize() throws std::length_error for
/// more, and then changes nothing.
///
/// Each slot that has an event has a record, which is used again when the event is over. So a slot without event takes
/// four bytes, and slots may be numbered sparsely; a record takes 36 to 52, and its rank, unless that is the slot or
/// lasts (Rank::lasts, event_queue.hpp). set() allocates where more slots have events than ever before, resize() for
/// its slots, and set() and top() where more events than ever before are on the present day, which has about one; fit()
/// gives that back.
///
/// A year begins at the earliest event and has a few days for each event; later events wait in an unsorted list, the
/// years to come. A day is an unsorted, doubly linked list of its records, so that set and clear touch a constant
/// number of words. Only the events of the present day, and any set to a time before it, stand in order, in a small
/// heap. When the last day is over, the events to come are dealt out into a new year, whose days are as long as the
/// distance between the events then nearest.
///
/// The division into days is monotone in time even as it is rounded (a subtraction and a multiplication by a positive
/// number, each monotone), so the order is exact whatever the length of a day. An unlucky distribution only costs time:
/// if the present day grows long (a burst, a cluster narrower than a day, times all equal or set backwards), the heap
/// takes O(log n) an operation, and a new year is begun once that has cost about as much as beginning one.
///
/// Paper: [Brown88]; the sorted front is from [Tang05]. Differs: days do not wrap around, so none is searched for the
/// events of this year; the present day is a heap, so bursts need no finer calendar within the calendar.
template <QueueRank Rank = SlotRank>
class CalendarQueue {
 public:
  explicit CalendarQueue(Rank rank = {}) : rank_(rank) {}

  void resize(std::size_t slots);
  void set(Slot slot, double time);
  void clear(Slot slot);
  void pop() { clear(top().slot); }
  /// Gives back the memory of records that no event needs now. Changes nothing else that can be observed. Cost: O(1) a
  /// record.
  void fit();
  QueuedEvent top() const;

  /// Calls visit(slot) for each event not later than `time`, in no particular order. Unlike top() it rearranges
  /// nothing. Cost: those events and those of a day, and of the years to come if `time` is in them.
  template <class Visit>
  void visit_until(double time, Visit&& visit) const;

  /// For callers with more memory than the caches have, who fetch ahead what later events need: calls the first of
  /// `visits` with each slot that has an event on the next day that has any, the second with those of the day after it,
  /// and so on; once a day, and not where the days between are many. Changes nothing that can be observed. Cost: those
  /// events, and O(1).
  template <class... Visits>
  void look_ahead(Visits&&... visits) const;
  /// Fetches what set() and clear() first read of a slot.
  void prefetch(Slot slot) const { __builtin_prefetch(&records_[slot]); }

  bool contains(Slot slot) const { return records_[slot] != none; }
  double time(Slot slot) const { return contains(slot) ? nodes_[records_[slot]].time : detail::no_event; }
  bool empty() const { return size_ == 0; }
  std::size_t size() const { return size_; }
  std::size_t slots() const { return records_.size(); }
  std::uint64_t operations() const { return operations_; }

 private:
  static constexpr bool has_ranks = !std::is_same_v<Rank, SlotRank>;
  static constexpr bool keeps_ranks = has_ranks && !LastingRank<Rank>;

  // These change the speed, never the order.
  static constexpr std::size_t days_per_event = 4;  ///< in a year. More make years rarer and take more memory
  static constexpr double events_per_day = 1;       ///< intended, at the beginning of the year
  static constexpr std::size_t near_part = 8;       ///< the earliest 1 / near_part of the events decide a day's length
  static constexpr std::size_t sample_size = 256;   ///< events looked at for that, at most
  static constexpr std::size_t long_day = 16;       ///< events; the cost of longer days is counted, see bill_

  // The meaning of Node::back: the record before, or the day whose first record this is, or the place in the present
  // day's heap.
  static constexpr std::uint32_t first_of_day = 1u << 30;
  static constexpr std::uint32_t in_present = 1u << 31;
  static constexpr std::uint32_t payload = first_of_day - 1;
  static constexpr std::uint32_t none = payload;

 public:
  /// 2^27 - 1, some 134 million: the days, a power of two and so up to twice as many as asked for, are numbered too.
  static constexpr std::size_t most_slots = none / (2 * days_per_event);

 private:
  struct Node {
    double time = detail::no_event;
    std::uint32_t next = none;
    std::uint32_t back = 0;
  };

  /// An entry of the present day's heap.
  struct Due {
    double time;
    Slot slot;
    std::uint32_t record;
  };

  /// The order of the queue.
  bool earlier(const Due& a, const Due& b) const {
    if (a.time != b.time) return a.time < b.time;
    if constexpr (has_ranks) {
      const auto rank_a = rank_of(a), rank_b = rank_of(b);
      if (rank_a != rank_b) return rank_a < rank_b;
    }
    return a.slot < b.slot;
  }
  RankOf<Rank> rank_of(const Due& due) const {
    if constexpr (keeps_ranks) {
      return ranks_[due.record];
    } else {
      return rank_(due.slot);
    }
  }

  void forget_all();
  std::uint32_t take_record() { return free_ != none ? std::exchange(free_, nodes_[free_].next) : add_record(); }
  std::uint32_t add_record();
  void drop(Slot slot);
  void insert(std::uint32_t record) const;
  void remove(std::uint32_t record) const;
  void link(std::uint32_t record, std::uint32_t day) const;
  void link_all(std::uint32_t first, std::uint32_t day) const;
  std::uint32_t take_day(std::uint32_t day) const;

  void push_present(std::uint32_t record) const;
  void erase_present(std::size_t place) const;
  void sift_up(std::size_t place, const Due& moved) const;
  void sift_down(std::size_t place, const Due& moved) const;
  void put(std::size_t place, const Due& due) const {
    present_[place] = due;
    nodes_[due.record].back = in_present | static_cast<std::uint32_t>(place);
  }

  void next_day() const;
  void open_day(std::uint32_t day) const;
  std::uint32_t next_busy_day() const;
  void begin_year() const;
  void end_year() const;
  double day_length(double& earliest) const;

  // Mutable: top() may open the next day or year, which changes nothing that callers can see.
  mutable LargeVector<Node> nodes_;          // by record
  mutable LargeVector<std::uint32_t> days_;  // first record of each day; days_[year_] is that of the years to come
  mutable std::vector<std::uint64_t> busy_;  // a bit for each of days_ that is not empty
  mutable LargeVector<Due> present_;         // binary heap, least first
  mutable std::uint32_t year_ = 0;           // days in this year
  mutable std::uint32_t today_ = 0;
  mutable std::uint32_t looked_ahead_ = none;  ///< the day of the last look_ahead()
  mutable double begin_ = 0;                   // time at which the year begins
  mutable double days_per_second_ = 1;         // positive and finite
  // In days since the beginning: events before tomorrow_ belong to the present day, those from year_end_ on to the
  // years to come, as all events do at first.
  mutable double tomorrow_ = -detail::no_event;
  mutable double year_end_ = -detail::no_event;
  mutable std::size_t bill_ = 0;        // cost of long days, in events; beyond the number of events a new year is begun
  LargeVector<std::uint32_t> records_;  // by slot
  LargeVector<Slot> slots_;             // by record
  LargeVector<RankOf<Rank>> ranks_;     // by record, as they were when it was set; empty for ranks that last
  std::uint32_t free_ = none;           // first of the records of no slot, linked by `next`
  std::size_t size_ = 0;
  std::uint64_t operations_ = 0;
  [[no_unique_address]] Rank rank_;
};

// ---------------------------------------------------------------------------------------------------------------

template <QueueRank Rank>
void CalendarQueue<Rank>::resize(std::size_t slots) {
  if (slots > most_slots) {
    throw std::length_error("CalendarQueue::resize: " + std::to_string(slots) + " slots, and it can have at most " +
                            std::to_string(most_slots));
  }
  if (slots == 0) return forget_all();
  for (std::size_t slot = slots; slot < records_.size(); ++slot) {
    if (contains(static_cast<Slot>(slot))) drop(static_cast<Slot>(slot));
  }
  records_.resize(slots, none);
}

/// Gives the memory back, and compares nothing: ranks may be gone with what they are ranks of.
template <QueueRank Rank>
void CalendarQueue<Rank>::forget_all() {
  const std::uint64_t operations = operations_;
  *this = CalendarQueue(rank_);
  operations_ = operations;
}

/// Not inlined, since set() rarely needs it.
template <QueueRank Rank>
[[gnu::noinline]] std::uint32_t CalendarQueue<Rank>::add_record() {
  const auto record = static_cast<std::uint32_t>(nodes_.size());
  nodes_.emplace_back();
  slots_.resize(nodes_.size());
  if constexpr (keeps_ranks) ranks_.resize(nodes_.size());
  const std::size_t days = std::bit_ceil(std::max<std::size_t>(days_per_event * nodes_.size(), 64));
  if (days + 1 <= days_.size()) return record;
  const bool used = !days_.empty();
  if (used) end_year();
  const std::uint32_t waiting = used ? take_day(year_) : none;
  days_.resize(days + 1, none);
  busy_.resize(days / 64 + 1, 0);
  link_all(waiting, year_);
  // So that events set before the next year begins do not belong to the present day.
  tomorrow_ = year_end_ = -detail::no_event;
  return record;
}

template <QueueRank Rank>
inline void CalendarQueue<Rank>::set(Slot slot, double time) {
  assert(slot < records_.size() && time > -detail::no_event);
  if (time == detail::no_event) return clear(slot);
  std::uint32_t record = records_[slot];
  if (record != none) {
    remove(record);
  } else {
    record = take_record();
    records_[slot] = record;
    slots_[record] = slot;
    ++size_;
  }
  ++operations_;
  nodes_[record].time = time;
  if constexpr (keeps_ranks) ranks_[record] = rank_(slot);
  insert(record);
}

template <QueueRank Rank>
inline void CalendarQueue<Rank>::clear(Slot slot) {
  if (!contains(slot)) return;
  ++operations_;
  drop(slot);
}

/// Precondition: contains(slot).
template <QueueRank Rank>
inline void CalendarQueue<Rank>::drop(Slot slot) {
  const std::uint32_t record = std::exchange(records_[slot], none);
  --size_;
  remove(record);
  nodes_[record].next = std::exchange(free_, record);
}

template <QueueRank Rank>
inline QueuedEvent CalendarQueue<Rank>::top() const {
  assert(!empty());
  if (present_.empty()) next_day();
  return {present_[0].time, present_[0].slot};
}

template <QueueRank Rank>
template <class Visit>
void CalendarQueue<Rank>::visit_until(double time, Visit&& visit) const {
  for (const Due& due : present_) {
    if (due.time <= time) visit(due.slot);
  }
  // Events up to then are not on later days, as the division into days is monotone.
  const double last = (time - begin_) * days_per_second_;
  for (std::size_t word = today_ / 64; word < busy_.size(); ++word) {
    for (std::uint64_t days = busy_[word]; days != 0; days &= days - 1) {
      const auto day = static_cast<std::uint32_t>(64 * word + static_cast<std::size_t>(std::countr_zero(days)));
      if (day == year_ ? last < year_end_ : last < day) return;
      for (std::uint32_t record = days_[day]; record != none; record = nodes_[record].next) {
        if (nodes_[record].time <= time) visit(slots_[record]);
      }
      if (day == year_) return;
    }
  }
}

/// The first record of a day is fetched a call before it is read.
template <QueueRank Rank>
template <class... Visits>
inline void CalendarQueue<Rank>::look_ahead(Visits&&... visits) const {
  if (std::exchange(looked_ahead_, today_) == today_) return;
  constexpr std::size_t words = 4;  // of busy_
  std::size_t word = today_ / 64;
  const std::size_t end = std::min(word + words, busy_.size());
  std::uint64_t days = word < end ? busy_[word] : 0;
  const auto first_of_next_day = [&] {
    while (days == 0 && ++word < end) days = busy_[word];
    if (word >= end) return none;
    const std::size_t day = 64 * word + static_cast<std::size_t>(std::countr_zero(days));
    days &= days - 1;
    return day < year_ ? days_[day] : none;
  };
  const auto look = [&](auto& visit) {
    const std::uint32_t first = first_of_next_day();
    for (std::uint32_t record = first; record != none; record = nodes_[record].next) visit(slots_[record]);
    return first != none;
  };
  if (!(look(visits) && ...)) return;
  if (const std::uint32_t first = first_of_next_day(); first != none) {
    __builtin_prefetch(&nodes_[first]);
    __builtin_prefetch(&slots_[first]);
  }
}

// --- where an event stands

template <QueueRank Rank>
inline void CalendarQueue<Rank>::insert(std::uint32_t record) const {
  const double day = (nodes_[record].time - begin_) * days_per_second_;
  if (day >= tomorrow_) return link(record, day < year_end_ ? static_cast<std::uint32_t>(day) : year_);
  push_present(record);
  if (present_.size() > long_day && ++bill_ > size_) {
    end_year();
    begin_year();
  }
}

template <QueueRank Rank>
inline void CalendarQueue<Rank>::remove(std::uint32_t record) const {
  const Node node = nodes_[record];
  if (node.back & in_present) return erase_present(node.back & payload);
  if (node.next != none) nodes_[node.next].back = node.back;
  if (node.back & first_of_day) {
    const std::uint32_t day = node.back & payload;
    days_[day] = node.next;
    busy_[day / 64] ^= std::uint64_t{node.next == none} << (day % 64);
  } else {
    nodes_[node.back].next = node.next;
  }
}

template <QueueRank Rank>
inline void CalendarQueue<Rank>::link(std::uint32_t record, std::uint32_t day) const {
  const std::uint32_t next = days_[day];
  nodes_[record].next = next;
  nodes_[record].back = first_of_day | day;
  if (next != none) nodes_[next].back = record;
  days_[day] = record;
  busy_[day / 64] |= std::uint64_t{1} << (day % 64);
}

template <QueueRank Rank>
void CalendarQueue<Rank>::link_all(std::uint32_t first, std::uint32_t day) const {
  for (std::uint32_t record = first; record != none;) link(std::exchange(record, nodes_[record].next), day);
}

/// Empties a day; the first of its records, which are still linked to one another.
template <QueueRank Rank>
inline std::uint32_t CalendarQueue<Rank>::take_day(std::uint32_t day) const {
  busy_[day / 64] &= ~(std::uint64_t{1} << (day % 64));
  return std::exchange(days_[day], none);
}

// --- the heap of the present day

template <QueueRank Rank>
inline void CalendarQueue<Rank>::push_present(std::uint32_t record) const {
  const Due added{nodes_[record].time, slots_[record], record};
  present_.push_back(added);
  sift_up(present_.size() - 1, added);
}

template <QueueRank Rank>
inline void CalendarQueue<Rank>::erase_present(std::size_t place) const {
  const Due last = present_.back();
  present_.pop_back();
  if (place == present_.size()) return;
  if (place > 0 && earlier(last, present_[(place - 1) / 2])) {
    sift_up(place, last);
  } else {
    sift_down(place, last);
  }
}

template <QueueRank Rank>
inline void CalendarQueue<Rank>::sift_up(std::size_t place, const Due& moved) const {
  while (place > 0) {
    const std::size_t parent = (place - 1) / 2;
    if (!earlier(moved, present_[parent])) break;
    put(place, present_[parent]);
    place = parent;
  }
  put(place, moved);
}

template <QueueRank Rank>
inline void CalendarQueue<Rank>::sift_down(std::size_t place, const Due& moved) const {
  for (;;) {
    std::size_t child = 2 * place + 1;
    if (child >= present_.size()) break;
    if (child + 1 < present_.size() && earlier(present_[child + 1], present_[child])) ++child;
    if (!earlier(present_[child], moved)) break;
    put(place, present_[child]);
    place = child;
  }
  put(place, moved);
}

}  // namespace kds

#include "kds/events/calendar_queue_years.hpp"

static_assert(kds::EventQueue<kds::CalendarQueue<>>);
