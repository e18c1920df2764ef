// All pairs of boxes that overlap, where many come at once.
#pragma once

#include "collision/broad_phase/swept_box.hpp"
#include "kds/simd/four_floats.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace kds::collision {

/// Finds the pairs among many boxes of sizes that are not too different, by sorting them into cells that are larger
/// than the largest of them: what a box overlaps begins in its own cell or in one of the 26 around it, and of each two
/// cells one looks into the other. In memory the cells of a row follow each other, so a box looks at five stretches.
///
/// Cost: O(n) for n boxes of bounded density, some 300 instructions a box; memory 44 bytes a box. Which pairs there
/// are, and their order, does not depend on the number of threads.
///
/// Source: [Ericson05] section 7.1, for uniform grids by sorting.
class BoxPairs {
 public:
  using Index = std::uint32_t;
  struct Pair {
    Index a, b;  ///< in no order
  };

  /// Finds them. False, and no pairs, if that would not pay: no boxes, boxes without bounds, or many that are of too
  /// different sizes or too crowded. `threads`: how many at most; 0 is as many as the machine has.
  bool find(std::span<const StaticBox> boxes, std::size_t threads = 1);

  /// In spatial order.
  const std::vector<Pair>& pairs() const { return pairs_; }
  /// Boxes in spatial order.
  std::span<const Index> order() const { return order_; }

 private:
  /// A box in single precision, rounded by a monotone rule: boxes that overlap do so here too.
  struct Rough {
    Rough() {}  // not the implicit one, for which all is set to zero first

    FourFloats low, high;
  };
  static bool overlap(const Rough& a, const Rough& b);

  bool choose_cells(std::span<const StaticBox> boxes);
  bool sort(std::span<const StaticBox> boxes, std::size_t threads);
  void search(std::span<const StaticBox> boxes, std::size_t first_row, std::size_t last_row,
              std::vector<Pair>& found) const;

  Eigen::Array3d corner_;               ///< least coordinates
  double scale_ = 0;                    ///< cells per unit
  std::array<std::size_t, 3> cells_{};  ///< along each axis
  std::vector<Index> begin_;            ///< first place of each cell, x fastest, and the end
  std::vector<Index> order_;
  std::vector<Index> cell_;   ///< of each place
  std::vector<Rough> rough_;  ///< in order
  std::vector<Pair> pairs_;
};

}  // namespace kds::collision
