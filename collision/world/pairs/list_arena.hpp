// Many short lists in one block of memory.
#pragma once

#include "kds/large_vector.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace kds::collision {

/// Lists that grow and shrink at their end, each with room for a power of two. Making one, or letting it grow, costs a
/// few instructions instead of a call of malloc(); all are freed with the arena, at once.
///
/// Room that a list has outgrown, or that is given back, is used for the next list of that size. Memory: at most twice
/// the room of all lists, and the room given back.
/// Cost: O(1), amortised where a list or the arena grows.
///
/// The arena has room for `Most` items, those not in use included; a call that would exceed it throws
/// std::length_error, and changes nothing.
template <class T, std::uint64_t Most = std::uint64_t{1} << 32>
class ListArena {
  static_assert(Most <= std::uint64_t{1} << 32, "places are numbered by 32 bits");

 public:
  /// A handle of a list; copying it does not copy the list. Spans of items are valid until the next push_back() to any
  /// list, or reserve().
  struct List {
    std::uint32_t begin = 0;
    std::uint32_t size = 0;
    std::uint32_t room = 0;

    bool empty() const { return size == 0; }
  };

  std::span<T> items(const List& list) { return {memory_.get() + list.begin, list.size}; }
  std::span<const T> items(const List& list) const { return {memory_.get() + list.begin, list.size}; }

  /// Makes room for this many more items.
  void reserve(std::size_t items) {
    if (used_ + items > room_) enlarge(used_ + items);
  }

  /// A list without room first gets some for `first_room` items, rounded up to a power of two.
  void push_back(List& list, const T& item, std::uint32_t first_room = 4) {
    if (list.size == list.room) grow(list, list.room == 0 ? std::bit_ceil(first_room) : 2 * list.room);
    memory_[list.begin + list.size++] = item;
  }

  /// Precondition: not empty.
  void pop_back(List& list) { --list.size; }

  /// Gives back its room; it is empty then.
  void free(List& list) {
    if (list.room > 0) free_[place(list.room)].push_back(list.begin);
    list = {};
  }

  /// Frees all lists; their handles are invalid from then on.
  void clear() {
    used_ = 0;
    for (auto& free : free_) free.clear();
  }

 private:
  static std::size_t place(std::uint32_t room) { return static_cast<std::size_t>(std::countr_zero(room)); }

  void grow(List& list, std::uint32_t room) {
    const std::uint32_t begin = block(room);  // before any change, since it may throw
    const std::uint32_t size = list.size;
    if (list.room > 0) {
      std::copy_n(memory_.get() + list.begin, size, memory_.get() + begin);
      free(list);
    }
    list = {begin, size, room};
  }

  /// The beginning of a block of that size.
  std::uint32_t block(std::uint32_t room) {
    if (room > 0 && !free_[place(room)].empty()) {
      auto& free = free_[place(room)];
      const std::uint32_t begin = free.back();
      free.pop_back();
      return begin;
    }
    if (room == 0 || room > Most - used_) {  // 0: twice the largest room has no number
      throw std::length_error("ListArena: its lists need more room than for " + std::to_string(Most) + " items");
    }
    const std::size_t used = used_ + room;
    if (used > room_) enlarge(std::max<std::size_t>(2 * room_, used + 16 * std::size_t{room}));
    return static_cast<std::uint32_t>(std::exchange(used_, used));
  }

  /// Memory that is not used yet is not written to.
  void enlarge(std::size_t room) {
    Memory memory(LargeAllocator<T>().allocate(room), Release{room});
    std::copy_n(memory_.get(), std::min(used_, room_), memory.get());
    memory_ = std::move(memory);
    room_ = room;
  }

  struct Release {
    std::size_t room = 0;
    void operator()(T* memory) const { LargeAllocator<T>().deallocate(memory, room); }
  };
  using Memory = std::unique_ptr<T[], Release>;

  Memory memory_;
  std::size_t room_ = 0;                             ///< in memory_
  std::size_t used_ = 0;                             ///< of it: lists and what has been given back
  std::array<std::vector<std::uint32_t>, 32> free_;  ///< beginnings, by the logarithm of their room
};

}  // namespace kds::collision
