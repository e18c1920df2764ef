// A hash table from cells of space to the bodies in them.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace kds::collision {

/// Keeps for each cell, named by 64 bits, an unordered list of numbers.
///
/// Open addressing; the first few numbers of a cell are stored in its slot of the table, so that to look into a cell of
/// the usual size costs one cache line; further ones are in chunks. add() and remove() cost O(1) and O(numbers in the
/// cell). A cell that has become empty is forgotten when the table is next rehashed, which adding does when the table
/// is full, at amortised O(1).
///
/// Paper: [Teschner03] for hashing cells.
class CellTable {
 public:
  using Key = std::uint64_t;

  void clear();

  /// Room for so many cells without rehashing.
  void reserve(std::size_t cells);

  void add(Key cell, std::uint32_t number) {
    add(cell, number, [](std::uint32_t) {});
  }

  /// visit() and add().
  template <class Visit>
  void add(Key cell, std::uint32_t number, Visit&& visit) {
    if (4 * (taken_ + 1) > 3 * slots_.size()) grow();
    Slot& slot = slots_[find(cell)];
    if (!slot.taken) {
      slot = Slot{};
      slot.taken = true;
      slot.cell = cell;
      ++taken_;
    }
    visit_slot(slot, visit);
    if (slot.count < slot.numbers.size()) {
      slot.numbers[slot.count++] = number;
    } else {
      add_to_chunk(slot, number);
    }
  }

  /// Removes one such number, if the cell holds any.
  void remove(Key cell, std::uint32_t number);

  /// Calls visit(number) for what is in a cell.
  template <class Visit>
  void visit(Key cell, Visit&& visit) const {
    if (slots_.empty()) return;
    visit_slot(slots_[find(cell)], visit);
  }

 private:
  static constexpr std::uint32_t none = ~std::uint32_t{0};

  /// One of a cell's slots, half a cache line. Vacant if it has no key.
  struct alignas(32) Slot {
    Key cell = 0;
    std::uint32_t more = none;  ///< first of the chunks
    std::uint16_t count = 0;    ///< of the numbers here; fewer than there is room for only if there are no chunks
    bool taken = false;
    std::array<std::uint32_t, 4> numbers;
  };
  struct alignas(32) Chunk {
    std::uint32_t next = none;
    std::uint32_t count = 0;  ///< full but for the first of a cell
    std::array<std::uint32_t, 6> numbers;
  };

  /// The slot that holds a cell, or the vacant one where it would be put.
  std::size_t find(Key cell) const {
    const std::size_t mask = slots_.size() - 1;
    std::size_t i = static_cast<std::size_t>(cell * 0x9E3779B97F4A7C15u >> shift_);
    while (slots_[i].taken && slots_[i].cell != cell) i = (i + 1) & mask;
    return i;
  }

  template <class Visit>
  void visit_slot(const Slot& slot, Visit& visit) const {
    for (std::uint32_t i = 0; i < slot.count; ++i) visit(slot.numbers[i]);
    for (std::uint32_t c = slot.more; c != none; c = chunks_[c].next) {
      for (std::uint32_t i = 0; i < chunks_[c].count; ++i) visit(chunks_[c].numbers[i]);
    }
  }

  void add_to_chunk(Slot& slot, std::uint32_t number);
  void grow();
  void rehash(std::size_t slots);

  std::vector<Slot> slots_;  // a power of two
  std::vector<Chunk> chunks_;
  std::uint32_t free_chunks_ = none;
  std::size_t taken_ = 0;
  int shift_ = 63;
};

}  // namespace kds::collision
