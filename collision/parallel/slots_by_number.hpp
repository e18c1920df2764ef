// Where bodies are stored of which not all are.
#pragma once

#include "collision/body_id.hpp"

#include <cstddef>
#include <utility>
#include <vector>

namespace kds::collision {

/// The slots of bodies by their numbers: a table in which each is at the place that follows from its number, or as near
/// after it as there is room.
///
/// Cost: O(1) each. Memory: 11 to 21 bytes a body.
class SlotsByNumber {
 public:
  std::size_t size() const { return size_; }
  /// `no_body` if there is none with this number.
  BodySlot find(BodySlot number) const {
    if (table_.empty()) return no_body;
    return table_[place_of(number)].slot;
  }
  /// Precondition: there is none with this number.
  void add(BodySlot number, BodySlot slot) {
    if (4 * (size_ + 1) > 3 * table_.size()) grow();
    table_[place_of(number)] = {number, slot};
    ++size_;
  }
  /// Precondition: there is one.
  void remove(BodySlot number) {
    std::size_t free = place_of(number);
    // Those that have had to go farther because of it come nearer.
    for (std::size_t at = next(free); table_[at].slot != no_body; at = next(at)) {
      const std::size_t wanted = first_place(table_[at].number);
      if (((at - wanted) & mask()) < ((at - free) & mask())) continue;
      table_[free] = table_[at];
      free = at;
    }
    table_[free] = {};
    --size_;
  }

 private:
  struct Entry {
    BodySlot number = no_body;
    BodySlot slot = no_body;  ///< `no_body`: nothing is here
  };

  std::size_t mask() const { return table_.size() - 1; }
  std::size_t next(std::size_t place) const { return (place + 1) & mask(); }
  std::size_t first_place(BodySlot number) const { return (number * 0x9e3779b97f4a7c15u >> shift_) & mask(); }
  /// Where a number is, or is to be.
  std::size_t place_of(BodySlot number) const {
    std::size_t at = first_place(number);
    while (table_[at].slot != no_body && table_[at].number != number) at = next(at);
    return at;
  }
  void grow() {
    const std::vector<Entry> before =
        std::exchange(table_, std::vector<Entry>(table_.empty() ? 64 : 2 * table_.size()));
    shift_ = 64;
    for (std::size_t size = table_.size(); size > 1; size /= 2) --shift_;
    for (const Entry& entry : before) {
      if (entry.slot != no_body) table_[place_of(entry.number)] = entry;
    }
  }

  std::vector<Entry> table_;  ///< the size is a power of two, at least a quarter is free
  std::size_t size_ = 0;
  int shift_ = 64;  ///< the uppermost bits of a product count
};

}  // namespace kds::collision
