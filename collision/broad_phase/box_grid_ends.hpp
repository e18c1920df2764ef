// Boxes of a grid as integers, as its cells store them. Included only by the sources of BoxGrid.
#pragma once

#include "collision/broad_phase/box_grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace kds::collision {

/// Units of the lattice in a cell, a power of two. With finer units fewer boxes overlap only on the lattice; but ends
/// of a few cells have to fit a byte.
inline constexpr int lattice_bits = 5;
inline constexpr std::int64_t units_per_cell = 1 << lattice_bits;

/// Bytes 0 to 5 of CellTable::Ends are the ends (min, -max). Values out of range are cut off in the same way on both
/// sides of a comparison.
inline CellTable::Ends lattice_byte(std::int64_t value) {
  const std::int64_t bounded = std::clamp(value, -CellTable::limit, CellTable::limit);
  return static_cast<std::uint8_t>(bounded);
}

/// Bytes 6 and 7: the row, modulo 16 and 8, and its complement; this is the part of one coordinate. One of the two
/// exceeds that of any other row, so the rows of a search, of which there are fewer, are not mistaken for each other.
class RowMark {
 public:
  explicit RowMark(std::size_t d) : part_(parts[d]) {}
  CellTable::Ends of(std::int64_t cell) const {
    const CellTable::Ends mark = static_cast<CellTable::Ends>(cell) << part_.shift & part_.bits;
    return (mark | (mark ^ part_.complement) << 8) << 48;
  }

 private:
  struct Part {
    int shift;
    CellTable::Ends bits, complement;
  };
  static constexpr Part parts[]{{0, 0, 0}, {0, 0x0F, 0x0F}, {4, 0x70, 0xF0}};

  Part part_;
};

/// The limits along an axis that the ends of boxes in a cell do not exceed if they overlap [low, high] there.
class LatticeLimits {
 public:
  explicit LatticeLimits(std::size_t d) : shift_(static_cast<int>(8 * d)), mark_(d) {}
  CellTable::Ends in(std::int64_t cell, std::int64_t low, std::int64_t high) const {
    const std::int64_t corner = cell * units_per_cell;
    return (lattice_byte(high - corner) | lattice_byte(corner - low) << 24) << shift_ | mark_.of(cell);
  }

 private:
  int shift_;
  RowMark mark_;
};

/// The marks of both coordinates.
inline CellTable::Ends row_marks(std::int64_t y, std::int64_t z) {
  const auto mark = static_cast<CellTable::Ends>((y & 0xF) | (z & 0x7) << 4);
  return (mark | (mark ^ 0xFF) << 8) << 48;
}

/// A box on the lattice of a level: (min, -max), like BoxBounds.
struct BoxGrid::Ends {
  Ends() = default;
  Ends(const BoxBounds& box, double scale) {
    std::size_t i = 0;
    for (const Two& two : {box.xy, box.zx, box.yz}) {
      const Two bounded = clamped(two * scale);
      values[i++] = std::llrint(bounded[0]);
      values[i++] = std::llrint(bounded[1]);
    }
  }

  /// Monotone, with the same limit below zero as above.
  static std::int64_t on_lattice(double x) { return std::llrint(clamped(both(x))[0]); }
  static Two clamped(Two x) {
    constexpr Two farthest{0x1p61, 0x1p61};
    return greater(lesser(x, farthest), -farthest);
  }
  static std::int64_t cell_of(std::int64_t x) { return x >> lattice_bits; }

  /// The cell that a box is in.
  std::int64_t cell(std::size_t d) const { return cell_of(values[d]); }
  bool same_cell(const Ends& other) const {
    return (((values[0] ^ other.values[0]) | (values[1] ^ other.values[1]) | (values[2] ^ other.values[2])) >>
            lattice_bits) == 0;
  }
  std::size_t place(const CellTable& table, std::uint64_t family) const {
    return table.place(table.row(family, cell(1), cell(2)), cell(0));
  }

  std::int64_t span() const {
    return std::max({-values[3] - values[0], -values[4] - values[1], -values[5] - values[2]});
  }
  Ends joined(const Ends& other) const {
    Ends result;
    for (std::size_t i = 0; i < 6; ++i) result.values[i] = std::min(values[i], other.values[i]);
    return result;
  }

  /// Counted from the box's own cell: no native or guest is larger than a cell, so the ends fit a byte.
  CellTable::Ends in_cell() const {
    // Three bytes at once, modulo 256.
    const auto bytes = [&](std::size_t i) {
      const auto byte = [&](std::size_t j) { return CellTable::Ends{static_cast<std::uint8_t>(values[j])}; };
      return byte(i) | byte(i + 1) << 8 | byte(i + 2) << 16;
    };
    const CellTable::Ends low = bytes(0);
    const CellTable::Ends minus_high = bytes(3);
    constexpr CellTable::Ends within = 0x010101 * (units_per_cell - 1);
    const CellTable::Ends corner = low & ~within;
    constexpr CellTable::Ends carries = 0x7F7F7F;
    const CellTable::Ends sum = ((minus_high & carries) + (corner & carries)) ^ ((minus_high ^ corner) & ~carries);
    return (low & within) | sum << 24 | row_marks(cell(1), cell(2));
  }

  std::array<std::int64_t, 6> values;
};

}  // namespace kds::collision
