// Space cut into cells, one for each of several worlds.
#pragma once

#include "collision/broad_phase/swept_box.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

namespace kds::collision {

/// How far outside a cell a box is, its nearest place, along the axis in which that is farthest: 0 if they meet. Ends
/// of cells may be infinite.
inline double outside(const StaticBox& box, const StaticBox& cell) {
  return std::max({0.0, (cell.min - box.max).maxCoeff(), (box.min - cell.max).maxCoeff()});
}
inline double outside(const Eigen::Vector3d& place, const StaticBox& cell) {
  return std::max({0.0, (cell.min - place.array()).maxCoeff(), (place.array() - cell.max).maxCoeff()});
}

/// How far outside a cell a box reaches: its farthest place.
inline double reach_outside(const StaticBox& box, const StaticBox& cell) {
  return std::max({0.0, (cell.min - box.min).maxCoeff(), (box.max - cell.max).maxCoeff()});
}

/// The distance of a place in a cell from the nearest side of it, along an axis; infinite if no side is finite, and
/// negative outside.
inline double inside(const Eigen::Vector3d& place, const StaticBox& cell) {
  return std::min((place.array() - cell.min).minCoeff(), (cell.max - place.array()).minCoeff());
}

/// Cells that together are all of space, and of which each place is in one: found by halving, along the longest axis,
/// with as many places on either side as the cells there are to have. Cost: O(n log cells) to make; O(log cells) to
/// find the cell of a place; for those near a place, that and their number.
class Partition {
 public:
  /// Precondition: at least one place, all finite; cells > 0. There are fewer cells where places coincide.
  Partition(std::vector<Eigen::Vector3d> places, std::size_t cells) {
    const double all = std::numeric_limits<double>::infinity();
    cut(places.data(), places.data() + places.size(), cells,
        {Eigen::Array3d::Constant(-all), Eigen::Array3d::Constant(all)});
  }

  std::size_t size() const { return cells_.size(); }
  const StaticBox& cell(std::size_t i) const { return cells_[i]; }

  std::size_t cell_of(const Eigen::Vector3d& place) const {
    std::size_t node = 0;
    while (nodes_[node].axis >= 0) node = nodes_[node].next[place[nodes_[node].axis] < nodes_[node].at ? 0 : 1];
    return nodes_[node].cell;
  }

  /// Calls take(cell) for each cell of which a place or a box is not farther outside() than `distance`, in ascending
  /// order.
  template <class Take>
  void each_within(const Eigen::Vector3d& place, double distance, const Take& take) const {
    each_within(StaticBox{place.array(), place.array()}, distance, take);
  }
  template <class Take>
  void each_within(const StaticBox& box, double distance, const Take& take) const {
    each_within(box, distance, take, 0);
  }

 private:
  struct Node {
    int axis = -1;  ///< of a leaf
    double at = 0;
    std::size_t next[2]{};  ///< below `at`, and from it on
    std::size_t cell = 0;   ///< of a leaf
  };

  /// Each finite side of a cell is a cut above it, so all are compared on the way down.
  template <class Take>
  void each_within(const StaticBox& box, double distance, const Take& take, std::size_t at) const {
    const Node& node = nodes_[at];
    if (node.axis < 0) return take(node.cell);
    if (box.min[node.axis] - node.at <= distance) each_within(box, distance, take, node.next[0]);
    if (node.at - box.max[node.axis] <= distance) each_within(box, distance, take, node.next[1]);
  }

  std::size_t cut(Eigen::Vector3d* first, Eigen::Vector3d* last, std::size_t cells, const StaticBox& cell) {
    const std::size_t node = nodes_.size();
    nodes_.emplace_back();
    int axis = 0;
    double at = 0;
    const std::size_t lower = cells / 2;
    if (cells < 2 || !halve(first, last, static_cast<double>(lower) / static_cast<double>(cells), axis, at)) {
      nodes_[node].cell = cells_.size();
      cells_.push_back(cell);
      return node;
    }
    Eigen::Vector3d* const middle =
        std::partition(first, last, [&](const Eigen::Vector3d& place) { return place[axis] < at; });
    StaticBox below = cell, above = cell;
    below.max[axis] = above.min[axis] = at;
    const std::size_t low = cut(first, middle, lower, below);
    const std::size_t high = cut(middle, last, cells - lower, above);
    nodes_[node] = {axis, at, {low, high}, 0};
    return node;
  }

  /// Where to cut, so that this share of the places is below. False if the places coincide.
  static bool halve(Eigen::Vector3d* first, Eigen::Vector3d* last, double share, int& axis, double& at) {
    if (last - first < 2) return false;
    Eigen::Array3d low = first->array(), high = low;
    for (const Eigen::Vector3d* place = first; place != last; ++place) {
      low = low.min(place->array()), high = high.max(place->array());
    }
    if (!((high - low).maxCoeff(&axis) > 0)) return false;
    Eigen::Vector3d* const middle =
        first + std::max<std::ptrdiff_t>(1, static_cast<std::ptrdiff_t>(share * static_cast<double>(last - first)));
    const auto before = [axis](const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return a[axis] < b[axis]; };
    std::nth_element(first, middle, last, before);
    at = (*middle)[axis];
    if (at > low[axis]) return true;
    at = high[axis];  // Many are at the lowest place: the cut is just above it.
    for (const Eigen::Vector3d* place = first; place != last; ++place) {
      if ((*place)[axis] > low[axis]) at = std::min(at, (*place)[axis]);
    }
    return true;
  }

  std::vector<Node> nodes_;
  std::vector<StaticBox> cells_;
};

}  // namespace kds::collision
