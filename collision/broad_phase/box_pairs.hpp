// All pairs of boxes that overlap, for many boxes at once.
#pragma once

#include "collision/broad_phase/swept_box.hpp"
#include "kds/large_vector.hpp"
#include "kds/simd/four_floats.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace kds::collision {

/// Finds the pairs among many boxes of sizes that are not too different, by sorting them into cells that are larger
/// than the largest of them: boxes that overlap a box begin in its own cell or in one of the 26 around it, and each two
/// cells are compared once. The cells of a row are adjacent in memory, so a box is compared with five stretches.
///
/// Cost: O(n) for n boxes of bounded density, some 300 instructions a box; memory 44 bytes a box. Which pairs there
/// are, and their order, does not depend on the number of threads.
///
/// Source: [Ericson05] section 7.1, for uniform grids by sorting.
class BoxPairs {
 public:
  using Index = std::uint32_t;
  /// Two boxes that overlap, by their places in the list that was given.
  struct Pair {
    Index a, b;  ///< in no order
  };

  /// Finds them. False, without pairs, if the method does not suit: no boxes, unbounded boxes, or many of too different
  /// sizes or too crowded. `threads`: how many at most; 0 is as many as the machine has.
  bool find(std::span<const StaticBox> boxes, std::size_t threads = 1);

  /// In spatial order.
  std::span<const Pair> pairs() const { return pairs_; }
  /// Boxes in spatial order.
  std::span<const Index> order() const { return order_; }

 private:
  /// A box in single precision, rounded monotonically: boxes that overlap do so here too.
  struct Rough {
    Rough() {}  // the implicit one would set all to zero first

    FourFloats low, high;
  };
  static bool overlap(const Rough& a, const Rough& b);

  bool choose_cells(std::span<const StaticBox> boxes);
  bool sort(std::span<const StaticBox> boxes, std::size_t threads);
  void search(std::span<const StaticBox> boxes, std::size_t first_row, std::size_t last_row,
              LargeVector<Pair>& found) const;

  Eigen::Array3d corner_;               ///< least coordinates
  double scale_ = 0;                    ///< cells per unit
  std::array<std::size_t, 3> cells_{};  ///< along each axis
  LargeVector<Index> begin_;            ///< first place of each cell, x fastest, and the end
  LargeVector<Index> order_;
  LargeVector<Index> cell_;   ///< of each place
  LargeVector<Rough> rough_;  ///< in order
  LargeVector<Pair> pairs_;
};

}  // namespace kds::collision
