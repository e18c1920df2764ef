// The boxes of a bounding-volume tree.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace kds::structures {

/// The product of closed intervals [min[d], max[d]]; boxes that touch overlap. Ends may be infinite, but not NaNs.
template <std::size_t Dimension>
struct TreeBox {
  std::array<double, Dimension> min{};
  std::array<double, Dimension> max{};

  bool overlaps(const TreeBox& other) const {
    for (std::size_t d = 0; d < Dimension; ++d) {
      if (!(min[d] <= other.max[d] && other.min[d] <= max[d])) return false;
    }
    return true;
  }
  bool contains(const TreeBox& other) const {
    for (std::size_t d = 0; d < Dimension; ++d) {
      if (!(min[d] <= other.min[d] && other.max[d] <= max[d])) return false;
    }
    return true;
  }
  /// Half of its surface in space, half of its circumference in the plane, its length on the line: the chance that
  /// another box overlaps with it is about proportional to that [Goldsmith87].
  double surface() const {
    double sum = 0;
    for (std::size_t left_out = 0; left_out < Dimension; ++left_out) {
      double product = 1;
      for (std::size_t d = 0; d < Dimension; ++d) {
        if (d != left_out || Dimension == 1) product *= max[d] - min[d];
      }
      sum += product;
    }
    return sum;
  }
  friend bool operator==(const TreeBox&, const TreeBox&) = default;
};

template <std::size_t Dimension>
TreeBox<Dimension> hull(const TreeBox<Dimension>& a, const TreeBox<Dimension>& b) {
  TreeBox<Dimension> both;
  for (std::size_t d = 0; d < Dimension; ++d) {
    both.min[d] = std::min(a.min[d], b.min[d]);
    both.max[d] = std::max(a.max[d], b.max[d]);
  }
  return both;
}

}  // namespace kds::structures
