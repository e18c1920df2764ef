// A hash table from cells of space to the boxes in them.
#pragma once

#include "kds/large_vector.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace kds::collision {

/// Stores for each cell an unordered list of numbers, each with eight small integers, its *ends*. A search finds those
/// whose ends all are at most the corresponding one of eight *limits*, and compares four numbers at once.
///
/// Cells are in buckets of one cache line, hashed row by row: neighbours along x are neighbours in memory. Only the
/// ends, if they are chosen so, distinguish cells that share a bucket; so a search may find numbers of other cells.
/// Numbers that do not fit a bucket are in further ones, chained to it.
///
/// Cost: O(1) and O(numbers in the bucket) for each function.
///
/// Paper: [Teschner03] for hashing cells. Differs: no key is compared.
class CellTable {
 public:
  /// Eight signed bytes, each from -limit to limit.
  using Ends = std::uint64_t;
  static constexpr std::int64_t limit = 126;

  /// The place where a row begins. Cells are counted from there.
  std::size_t row(std::uint64_t family, std::int64_t y, std::int64_t z) const {
    return static_cast<std::size_t>(mixed(family, y, z) >> shift_);
  }

  /// The first bucket of a cell.
  std::size_t place(std::size_t row, std::int64_t x) const {
    return (row + static_cast<std::size_t>(x)) & (buckets_.size() - 1);
  }

  /// Empties the table, and makes room for this many numbers. Places change.
  void restart(std::size_t numbers);

  std::size_t size() const { return size_; }
  /// How many buckets have been walked to numbers that were changed or removed, beyond the first of each cell.
  std::size_t walked() const { return walked_; }
  /// More numbers than this would be faster to find after a restart.
  std::size_t room() const { return buckets_.size(); }

  /// Prefetches into the cache the memory that add() will need.
  void fetch(std::size_t place) const { __builtin_prefetch(&buckets_[place], 1); }

  void add(std::size_t place, Ends ends, std::uint32_t number);

  /// Changes the ends of a number that has these ends; false if it is not there. (Without the old ends it might be
  /// confused with the same number in another cell of the bucket.)
  bool replace(std::size_t place, Ends from, Ends to, std::uint32_t number);

  /// Removes a number with these ends; false if there is none.
  bool remove(std::size_t place, Ends ends, std::uint32_t number);

  /// The numbers that a search finds. Made for one search: it allocates only if they are unusually many, and is not
  /// initialised before it is used.
  class Found {
   public:
    Found() {}  // not the implicit one, for which all might be set to zero first
    Found(const Found&) = delete;
    Found& operator=(const Found&) = delete;

    void clear() { size_ = 0; }
    std::span<const std::uint32_t> numbers() const { return {numbers_, size_}; }
    void add(std::uint32_t number) {
      *room_for(1) = number;
      ++size_;
    }

   private:
    friend CellTable;

    /// Results are written from there on; the end is set afterwards.
    std::uint32_t* room_for(std::size_t count) {
      if (size_ + count > room_) grow(count);
      return numbers_ + size_;
    }
    void end_at(const std::uint32_t* end) { size_ = static_cast<std::size_t>(end - numbers_); }
    void grow(std::size_t count);

    /// Searches of a kinetic grid find some dozens; there has to be room for 64 more than are found.
    static constexpr std::size_t usual = 256;
    std::array<std::uint32_t, usual> few_;
    std::vector<std::uint32_t> many_;
    std::uint32_t* numbers_ = few_.data();
    std::size_t size_ = 0;
    std::size_t room_ = usual;
  };

  /// A block of cells to search in, and the limits: for each axis, by cell along it, bytes that do not overlap those of
  /// other axes; the limits of a cell are all three together.
  struct Block {
    static constexpr std::size_t longest = 8;

    std::uint64_t family;
    std::array<std::int64_t, 3> low;     ///< the first cell
    std::array<std::size_t, 3> lengths;  ///< in cells
    std::array<std::array<Ends, longest>, 3> limits;
  };

  /// Appends the numbers within the limits, those of other cells in the same buckets too. Returns how many buckets it
  /// has walked beyond the first of each cell.
  std::size_t find(const Block& block, Found& found) const;

  /// A step from a cell to the next along an axis: in its row, or to another row.
  struct Step {
    std::size_t place;
    std::uint64_t row;
  };
  static Step step(std::size_t axis) {
    constexpr std::array<Step, 3> steps{{{1, 0}, {0, along_y}, {0, along_z}}};
    return steps[axis];
  }

  /// Cells of a slab across an axis, with the limits along it; and by cell along the two other axes.
  struct Slab {
    static constexpr std::size_t widest = 8;

    std::size_t place;  ///< of the first cell: the sums of the family and of the steps from cell (0, 0, 0)
    std::uint64_t row;
    Ends limit;
    std::array<Step, 2> steps;
    std::array<std::size_t, 2> lengths;  ///< in cells
    std::array<std::array<Ends, widest>, 2> limits;
  };

  /// The same for the cells of a slab. In less time than for a block where few numbers are within the limits, and in
  /// more where many are.
  std::size_t find(const Slab& slab, Found& found) const;

 private:
  /// The hash step from row to row, of which only the highest bits are used.
  static constexpr std::uint64_t along_y = 0x9E3779B97F4A7C15;
  static constexpr std::uint64_t along_z = 0xC2B2AE3D27D4EB4F;
  static std::uint64_t mixed(std::uint64_t family, std::int64_t y, std::int64_t z) {
    return family + static_cast<std::uint64_t>(y) * along_y + static_cast<std::uint64_t>(z) * along_z;
  }

  static constexpr std::uint32_t none = ~std::uint32_t{0};
  static constexpr Ends vacant = 0x7F7F7F7F7F7F7F7F;  ///< exceeds all limits
  static constexpr std::size_t most = 4;

  struct alignas(64) Bucket {
    std::array<Ends, most> ends{vacant, vacant, vacant, vacant};
    std::array<std::uint32_t, most> numbers{};
    std::uint32_t next = none;
    std::uint32_t count = 0;  ///< of a cell's buckets all are full except the second, or the only one

    /// Bit i if number i is within the limits.
    std::uint64_t within(Ends limits) const;
  };
  class Gathering;

  struct Where {
    Bucket* bucket;  ///< none if it is not there
    std::size_t i;
  };
  Where where(std::size_t place, Ends ends, std::uint32_t number);

  LargeVector<Bucket> buckets_ = LargeVector<Bucket>(1);  // a power of two
  LargeVector<Bucket> chained_;
  std::uint32_t free_ = none;
  std::size_t size_ = 0;
  std::size_t walked_ = 0;
  int shift_ = 63;
};

}  // namespace kds::collision
