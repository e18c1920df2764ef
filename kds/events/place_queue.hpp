// Event queue for slots in a row, of which neighbours change together: a tree of minima without branches.
#pragma once

#include "kds/arithmetic/lattice.hpp"
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
/// Slots are places in a row: insert_slot() and erase_slot() shift those behind. Eight of them, a cache line, are a
/// group whose least is kept; so are eight groups, and so on up to one. A change is written down at once and counts
/// after the next settle(), which brings the groups of the places changed since the last one up to date: for
/// neighbours, one group on each level, log8(n) of them.
///
/// Made for lists whose swaps change three neighbouring slots: what a heap or a calendar decides by branches that
/// nobody can foresee, this does by conditional moves, in the same few dozens of cycles each time, whatever the times
/// are. Times are kept as their place among all doubles, and "no event" as a number of each slot's own behind them, so
/// that only events of one time are ever equal, and to look at ranks is a branch that is hardly ever taken.
///
/// Cost: set, clear O(1); settle O(log n + distance between the first and the last place changed / 8); insert_slot,
/// erase_slot O(n) moves of memory, and the groups behind.
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
    if (time == detail::no_event) return clear(place);
    keys_[0][place] = lattice_index(time);
    touch(place, place);
  }
  void clear(Slot place) {
    keys_[0][place] = no_event(place);
    touch(place, place);
  }

  bool contains(Slot place) const { return keys_[0][place] <= latest; }
  double time(Slot place) const { return time_of(keys_[0][place]); }
  std::size_t slots() const { return size_; }

  /// Number of events; counts them.
  std::size_t size() const {
    return static_cast<std::size_t>(
        std::count_if(keys_[0].begin(), keys_[0].end(), [](Key key) { return key <= latest; }));
  }

  /// Of events of one time the one with the least rank(place) goes first, then the first place. Ranks of places that
  /// have not changed must not have changed either.
  template <class Rank>
  void settle(Rank&& rank);

  /// Precondition, of these two: settled.
  bool empty() const { return size_ == 0 || keys_.back()[0] > latest; }
  /// One of the next few events, probably, which has just become one: worth fetching into the cache.
  Slot candidate() const { return candidate_; }
  QueuedEvent top() const { return {time_of(keys_.back()[0]), places_.back()[0]}; }

 private:
  using Key = std::int64_t;
  static constexpr std::size_t group = 8;

  inline static const Key latest = lattice_index(std::numeric_limits<double>::max());
  static Key no_event(std::size_t place) { return std::numeric_limits<Key>::max() - static_cast<Key>(place); }
  static double time_of(Key key) { return key <= latest ? lattice_point(key) : detail::no_event; }

  void touch(std::size_t first, std::size_t last) {
    first_ = std::min(first_, first);
    last_ = std::max(last_, last);
  }

  template <std::size_t Count, class Rank>
  static void least(const Key* keys, const Slot* places, Key& key, Slot& place, Rank& rank);

  // Level 0 are the places themselves, filled up to a multiple of eight; on level k + 1 there is the least of each
  // group of level k, and in places_ where it stands. The last has one.
  std::vector<std::vector<Key>> keys_{{}};
  std::vector<std::vector<Slot>> places_{{}};
  std::size_t size_ = 0;
  Slot candidate_ = 0;
  std::size_t first_ = std::numeric_limits<std::size_t>::max();  // of the places changed since the last settle()
  std::size_t last_ = 0;
};

// ---------------------------------------------------------------------------------------------------------------

inline void PlaceQueue::resize(std::size_t slots) {
  auto& row = keys_[0];
  const std::size_t before = std::min(slots, size_);
  std::size_t count = (slots + group - 1) / group * group;
  row.resize(count);
  places_[0].resize(count);
  for (std::size_t i = before; i < count; ++i) row[i] = no_event(i);
  for (std::size_t i = 0; i < count; ++i) places_[0][i] = static_cast<Slot>(i);
  size_ = slots;
  std::size_t levels = 1;
  while (count > 1) {
    count /= group;
    const std::size_t filled = count > 1 ? (count + group - 1) / group * group : count;
    if (levels == keys_.size()) keys_.emplace_back(), places_.emplace_back();
    keys_[levels].resize(filled);
    places_[levels].resize(filled);
    for (std::size_t i = count; i < filled; ++i) {
      keys_[levels][i] = no_event((levels << 34) + i);  // unlike those of the places
      places_[levels][i] = 0;
    }
    ++levels;
    count = filled;
  }
  keys_.resize(levels);
  places_.resize(levels);
  if (slots > 0) touch(0, slots - 1);
}

inline void PlaceQueue::insert_slot(Slot place) {
  resize(size_ + 1);
  auto& row = keys_[0];
  for (std::size_t i = size_ - 1; i > place; --i) row[i] = row[i - 1] <= latest ? row[i - 1] : no_event(i);
  row[place] = no_event(place);
}

inline void PlaceQueue::erase_slot(Slot place) {
  auto& row = keys_[0];
  for (std::size_t i = place; i + 1 < size_; ++i) row[i] = row[i + 1] <= latest ? row[i + 1] : no_event(i);
  resize(size_ - 1);
}

inline void PlaceQueue::move_slot(Slot from, Slot to) {
  if (from == to) return;
  auto& row = keys_[0];
  const Key moved = row[from];
  const std::size_t step = from < to ? 1 : std::size_t(-1);
  for (std::size_t i = from; i != to; i += step) row[i] = row[i + step] <= latest ? row[i + step] : no_event(i);
  row[to] = moved <= latest ? moved : no_event(to);
  touch(std::min(from, to), std::max(from, to));
}

/// Knock-out: the lesser of each two, and its place, by conditional moves.
template <std::size_t Count, class Rank>
inline void PlaceQueue::least(const Key* keys, const Slot* places, Key& key, Slot& place, Rank& rank) {
  if constexpr (Count == 1) {
    key = keys[0];
    place = places[0];
  } else {
    constexpr std::size_t half = Count / 2;
    Key other_key;
    Slot other_place;
    least<half>(keys, places, key, place, rank);
    least<half>(keys + half, places + half, other_key, other_place, rank);
    bool other = other_key < key;
    if (__builtin_expect(other_key == key, 0)) other = rank(other_place) < rank(place);
    key = other ? other_key : key;
    place = other ? other_place : place;
  }
}

template <class Rank>
inline void PlaceQueue::settle(Rank&& rank) {
  if (first_ > last_ || size_ == 0) return;
  std::size_t first = first_;
  std::size_t last = std::min(last_, size_ - 1);
  first_ = std::numeric_limits<std::size_t>::max();
  last_ = 0;
  for (std::size_t level = 0; level + 1 < keys_.size(); ++level) {
    candidate_ = places_[level][first];
    first /= group;
    last /= group;
    const Key* keys = keys_[level].data();
    const Slot* places = places_[level].data();
    for (std::size_t i = first; i <= last; ++i) {
      Key key;
      Slot place;
      least<group>(keys + group * i, places + group * i, key, place, rank);
      keys_[level + 1][i] = key;
      places_[level + 1][i] = place;
    }
  }
}

}  // namespace kds
