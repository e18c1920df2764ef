// Event queue for slots in a row whose neighbours change together: a tree of minima, updated without branches.
#pragma once

#include "kds/arithmetic/lattice.hpp"
#include "kds/events/eight_times.hpp"
#include "kds/events/event_queue.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace kds {

/// The least of a row of times, and where it stands.
///
/// Slots are places in a row: insert_slot() and erase_slot() shift those behind. The least of each eight of them, a
/// cache line, is stored; four such lines are a group, whose least is stored too; four groups are a group of the next
/// level, and so on up to one. A change is stored at once and takes effect with the next settle(), which brings lines
/// and groups of the places changed since the last one up to date: for neighbours, one group on each level, log4(n / 8)
/// of them.
///
/// Made for lists whose swaps change three neighbouring slots: a heap or a calendar decides by branches that processors
/// mispredict, this queue by conditional moves, in the same few dozens of cycles whatever the times are. On the way up
/// the first of the other three of a group, which have not changed, is known before the changed one is, so that each
/// level adds one comparison to the latency of the next event.
///
/// In groups a time is stored as its place among all doubles, and "no event" as a greater number, another one for each
/// place: so only events of one time are equal, and the branch that compares ranks is hardly ever taken.
///
/// Cost: set, clear O(1); settle O(log n + distance between the first and the last place changed / 8); insert_slot,
/// erase_slot O(n) moves of memory, and all groups.
class PlaceQueue {
 public:
  void resize(std::size_t slots);
  void insert_slot(Slot place);
  void erase_slot(Slot place);
  /// As if erased and inserted at `to` with the same event.
  void move_slot(Slot from, Slot to);

  /// Precondition: not NaN, nor -infinity. Infinity clears.
  void set(Slot place, double time) {
    assert(place < size_ && time > -detail::no_event);
    times_[place] = time + 0.0;  // never -0
    touch(place, place);
  }
  /// The same for a place and those on its left and right, which must be there.
  void set_three(Slot place, double left, double middle, double right) {
    assert(place > 0 && place + std::size_t{1} < size_);
    times_[place - 1] = left + 0.0;
    times_[place] = middle + 0.0;
    times_[place + 1] = right + 0.0;
    touch(place - 1, place + 1);
  }
  void clear(Slot place) { set(place, detail::no_event); }

  bool contains(Slot place) const { return time(place) != detail::no_event; }
  double time(Slot place) const { return times_[place]; }
  std::size_t slots() const { return size_; }

  /// Number of events; counts them.
  std::size_t size() const;

  /// Among events of one time the one with the least rank(place) goes first, then the first place. Ranks of places that
  /// have not changed must not have changed either.
  template <class Rank>
  void settle(Rank&& rank);

  // Precondition of these: settle() has been called since the last change.

  bool empty() const { return top_.time == detail::no_event; }
  /// Time of the first event, infinity if there is none.
  double next_time() const { return top_.time; }
  /// Precondition: not empty.
  QueuedEvent top() const { return top_; }
  /// A slot that has probably just become one of the next few events: worth fetching into the cache.
  Slot candidate() const { return candidate_; }

 private:
  using Key = std::int64_t;
  static constexpr std::size_t line = 8;
  static constexpr std::size_t group = 4;
  static constexpr std::size_t most_levels = 16;  ///< levels of groups: Slot has 32 bits

  struct Event {
    Key key;
    Slot place;
  };
  /// By conditional moves: compilers emit a branch for two choices by one condition unless told that it cannot be
  /// predicted.
  static Event lesser(Event a, Event b) {
    Slot place = a.place;
    const Key key = std::min(a.key, b.key);
    if (__builtin_expect_with_probability(b.key < a.key, 1, 0.5)) place = b.place;
    return {key, place};
  }
  /// Four events, each the first of a line or of a group of the level below; in a cache line.
  struct alignas(64) Group {
    std::array<Key, group> keys;
    std::array<Slot, group> places;

    Event at(std::size_t i) const { return {keys[i], places[i]}; }
    /// The first of the other three; false where times are equal.
    bool first_without(std::size_t i, Event& first) const {
      first = at(i ^ 1);
      for (const std::size_t j : {i ^ 2, i ^ 3}) {
        const Event other = at(j);
        if (__builtin_expect(other.key == first.key, 0)) return false;
        first = lesser(first, other);
      }
      return true;
    }
    void put(std::size_t i, Event event) {
      keys[i] = event.key;
      places[i] = event.place;
    }
  };

  inline static const Key latest = lattice_index(std::numeric_limits<double>::max());
  static Key no_event(std::size_t number) { return std::numeric_limits<Key>::max() - static_cast<Key>(number); }

  static Key key_of(double time, std::size_t i) { return time < detail::no_event ? lattice_index(time) : no_event(i); }

  void touch(std::size_t first, std::size_t last) {
    first_ = std::min(first_, first);
    last_ = std::max(last_, last);
  }
  void make_groups();
  void set_top(Event event) { top_ = {event.key <= latest ? lattice_point(event.key) : detail::no_event, event.place}; }

  template <class Rank>
  static bool earlier(Event a, Event b, Rank& rank);
  /// By conditional moves.
  template <class Rank>
  static Event first_of(Event a, Event b, Rank& rank) {
    const bool second = earlier(b, a, rank);
    return {second ? b.key : a.key, second ? b.place : a.place};
  }
  template <class Rank>
  Event first_in_line(std::size_t i, Rank& rank) const;
  bool find_first_in_line(std::size_t i, Event& first) const;
  bool settle_line(std::size_t i);
  bool settle_two_lines(std::size_t first);
  template <class Rank>
  void settle_lines(std::size_t first, std::size_t last, Rank& rank);

  std::vector<double, detail::LineAllocator<double>> times_;  ///< of all places; filled up with entries without event
  /// On level 0 those of the lines, on level k + 1 those of level k; the last level has one.
  std::vector<Group> groups_;
  std::array<std::size_t, most_levels> begins_{};  ///< of levels among them
  std::size_t levels_ = 0;
  std::size_t size_ = 0;
  QueuedEvent top_;
  Slot candidate_ = 0;
  std::size_t first_ = std::numeric_limits<std::size_t>::max();  ///< of the places changed since the last settle()
  std::size_t last_ = 0;
};

// ---------------------------------------------------------------------------------------------------------------

inline void PlaceQueue::resize(std::size_t slots) {
  const std::size_t filled = (slots + line - 1) / line * line;
  const bool changed = filled != times_.size();
  times_.resize(filled, detail::no_event);
  for (std::size_t i = slots; i < std::min(size_, filled); ++i) times_[i] = detail::no_event;
  size_ = slots;
  if (changed) make_groups();
  if (slots > 0) touch(0, slots - 1);
}

inline void PlaceQueue::make_groups() {
  std::size_t count = times_.size() / line;
  groups_.clear();
  top_ = {};
  for (levels_ = 0; count > (levels_ > 0 ? 1 : 0); ++levels_) {
    count = (count + group - 1) / group;
    begins_[levels_] = groups_.size();
    Group none{};
    for (std::size_t i = 0; i < group; ++i)
      none.keys[i] = no_event((std::uint64_t{levels_ + 1} << 34) + i);  // unlike a line's
    groups_.resize(groups_.size() + count, none);
  }
}

inline void PlaceQueue::insert_slot(Slot place) {
  resize(size_ + 1);
  const auto at = times_.begin() + static_cast<std::ptrdiff_t>(place);
  const auto end = times_.begin() + static_cast<std::ptrdiff_t>(size_);
  std::move_backward(at, end - 1, end);
  *at = detail::no_event;
}

inline void PlaceQueue::erase_slot(Slot place) {
  const auto at = times_.begin() + static_cast<std::ptrdiff_t>(place);
  std::move(at + 1, times_.begin() + static_cast<std::ptrdiff_t>(size_), at);
  resize(size_ - 1);
}

inline void PlaceQueue::move_slot(Slot from, Slot to) {
  if (from == to) return;
  const auto [first, last] = std::minmax(from, to);
  const auto begin = times_.begin() + static_cast<std::ptrdiff_t>(first);
  const auto end = times_.begin() + static_cast<std::ptrdiff_t>(last) + 1;
  std::rotate(begin, from < to ? begin + 1 : end - 1, end);
  touch(first, last);
}

/// Places behind the last slot have no event.
inline std::size_t PlaceQueue::size() const {
  return times_.size() - static_cast<std::size_t>(std::count(times_.begin(), times_.end(), detail::no_event));
}

template <class Rank>
[[gnu::always_inline]] inline bool PlaceQueue::earlier(Event a, Event b, Rank& rank) {
  if (__builtin_expect(a.key == b.key, 0)) {
    const auto rank_a = rank(a.place);
    const auto rank_b = rank(b.place);
    return rank_a != rank_b ? rank_a < rank_b : a.place < b.place;
  }
  return a.key < b.key;
}

template <class Rank>
[[gnu::always_inline]] inline PlaceQueue::Event PlaceQueue::first_in_line(std::size_t i, Rank& rank) const {
  const detail::LeastTime least = detail::least_of_eight(&times_[line * i]);
  Event first{key_of(least.time, i), static_cast<Slot>(line * i + least.first())};
  if (__builtin_expect(least.shared(), 0)) {
    for (std::size_t j = least.first() + 1; j < line; ++j) {
      if (least.has(j)) first = first_of(first, {first.key, static_cast<Slot>(line * i + j)}, rank);
    }
  }
  return first;
}

template <class Rank>
inline void PlaceQueue::settle(Rank&& rank) {
  if (first_ > last_ || size_ == 0) return;
  const std::size_t first = first_ / line;
  const std::size_t last = std::min(last_, size_ - 1) / line;
  first_ = std::numeric_limits<std::size_t>::max();
  last_ = 0;
  const bool settled = first == last ? settle_line(first) : last == first + 1 && settle_two_lines(first);
  if (!settled) settle_lines(first, last, rank);
}

/// False where two times are equal, so that ranks decide.
inline bool PlaceQueue::find_first_in_line(std::size_t i, Event& first) const {
  const detail::LeastTime least = detail::least_of_eight(&times_[line * i]);
  first = {key_of(least.time, i), static_cast<Slot>(line * i + least.first())};
  return !least.shared();
}

/// Updates a line and all groups above it, or two neighbouring ones; false where two times are equal, so that ranks
/// decide: then the groups are not up to date.
inline bool PlaceQueue::settle_line(std::size_t i) {
  Event event;
  if (__builtin_expect(!find_first_in_line(i, event), 0)) return false;
  for (std::size_t level = 0; level < levels_; ++level, i /= group) {
    Group& on_level = groups_[begins_[level] + i / group];
    on_level.put(i % group, event);
    candidate_ = event.place;
    Event other;
    if (__builtin_expect(!on_level.first_without(i % group, other), 0)) return false;
    if (__builtin_expect(other.key == event.key, 0)) return false;
    event = lesser(event, other);
  }
  set_top(event);
  return true;
}

inline bool PlaceQueue::settle_two_lines(std::size_t first) {
  if (first % group + 1 == group) return settle_line(first) && settle_line(first + 1);
  Event event;
  if (__builtin_expect(!find_first_in_line(first, event), 0)) return false;
  groups_[first / group].put(first % group, event);
  return settle_line(first + 1);
}

template <class Rank>
void PlaceQueue::settle_lines(std::size_t first, std::size_t last, Rank& rank) {
  for (std::size_t i = first; i <= last; ++i) groups_[i / group].put(i % group, first_in_line(i, rank));
  for (std::size_t level = 0; level < levels_; ++level) {
    first /= group;
    last /= group;
    for (std::size_t i = first; i <= last; ++i) {
      const Group& four = groups_[begins_[level] + i];
      const Event event =
          first_of(first_of(four.at(0), four.at(1), rank), first_of(four.at(2), four.at(3), rank), rank);
      if (level + 1 < levels_) {
        groups_[begins_[level + 1] + i / group].put(i % group, event);
      } else {
        set_top(event);
      }
    }
  }
}

}  // namespace kds
