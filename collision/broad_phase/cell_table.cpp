#include "collision/broad_phase/cell_table.hpp"

#include <utility>

namespace kds::collision {

void CellTable::clear() {
  std::fill(slots_.begin(), slots_.end(), Slot{});
  chunks_.clear();
  free_chunks_ = none;
  taken_ = 0;
}

void CellTable::reserve(std::size_t cells) {
  const std::size_t slots = std::bit_ceil(std::max<std::size_t>(2 * cells, 64));
  if (slots > slots_.size()) rehash(slots);
}

void CellTable::grow() {
  // Empty cells may be most of what fills the table; then it need not grow.
  std::size_t used = 1;
  for (const Slot& slot : slots_) used += slot.count > 0;
  rehash(std::bit_ceil(std::max<std::size_t>(2 * used, 64)));
}

/// Precondition: there is no more room in the slot itself.
void CellTable::add_to_chunk(Slot& slot, std::uint32_t number) {
  if (slot.more == none || chunks_[slot.more].count == chunks_[slot.more].numbers.size()) {
    std::uint32_t added = free_chunks_;
    if (added != none) {
      free_chunks_ = chunks_[added].next;
    } else {
      added = static_cast<std::uint32_t>(chunks_.size());
      chunks_.emplace_back();
    }
    chunks_[added].count = 0;
    chunks_[added].next = slot.more;
    slot.more = added;
  }
  Chunk& first = chunks_[slot.more];
  first.numbers[first.count++] = number;
}

void CellTable::remove(Key cell, std::uint32_t number) {
  if (slots_.empty()) return;
  Slot& slot = slots_[find(cell)];
  std::uint32_t* place = std::find(slot.numbers.data(), slot.numbers.data() + slot.count, number);
  if (place == slot.numbers.data() + slot.count) {
    place = nullptr;
    for (std::uint32_t c = slot.more; c != none && !place; c = chunks_[c].next) {
      std::uint32_t* const end = chunks_[c].numbers.data() + chunks_[c].count;
      std::uint32_t* const found = std::find(chunks_[c].numbers.data(), end, number);
      if (found != end) place = found;
    }
    if (!place) return;
  }
  // The last number takes its place.
  if (slot.more == none) {
    *place = slot.numbers[--slot.count];
    return;
  }
  Chunk& first = chunks_[slot.more];
  *place = first.numbers[--first.count];
  if (first.count > 0) return;
  const std::uint32_t empty = std::exchange(slot.more, first.next);
  first.next = std::exchange(free_chunks_, empty);
}

void CellTable::rehash(std::size_t slots) {
  const std::vector<Slot> before = std::exchange(slots_, std::vector<Slot>(slots));
  shift_ = 64 - std::countr_zero(slots);
  taken_ = 0;
  for (const Slot& slot : before) {
    if (slot.count == 0) continue;
    slots_[find(slot.cell)] = slot;
    ++taken_;
  }
}

}  // namespace kds::collision
