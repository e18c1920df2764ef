// Space cut into cells, one for each of several worlds.
#pragma once

#include "collision/broad_phase/swept_box.hpp"
#include "collision/parallel/processes.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
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

/// How far outside a cell the farthest point of a box is.
inline double farthest_outside(const StaticBox& box, const StaticBox& cell) {
  return std::max({0.0, (cell.min - box.min).maxCoeff(), (box.max - cell.max).maxCoeff()});
}

/// The distance of a place in a cell from the nearest side of it, along an axis; infinite if no side is finite, and
/// negative outside.
inline double inside(const Eigen::Vector3d& place, const StaticBox& cell) {
  return std::min((place.array() - cell.min).minCoeff(), (cell.max - place.array()).minCoeff());
}

/// Cells that together are all of space, and of which each place is in one: found by halving, along the longest axis,
/// with as many places on either side as the cells there are to have, within one in 1024.
///
/// Cost: O(n log cells) to make; O(log cells) to find the cell of a place; for those near a place, that and their
/// number. Where processes have the places, they count theirs below a plane, add up, and try the next one: some ten
/// times for each halving, for all cells of a size at once.
class Partition {
 public:
  /// `places`: those of this process. Precondition: of all together at least one, all finite; cells > 0. There are
  /// fewer cells where places coincide. The same in all processes.
  Partition(std::vector<Eigen::Vector3d> places, std::size_t cells, Team& team) {
    std::vector<Cut> level{{0, cells, places.data(), places.data() + places.size()}};
    nodes_.emplace_back();
    while (!level.empty()) {
      std::erase_if(level, [](const Cut& cut) { return cut.cells < 2; });
      find_axes(level, team);
      std::erase_if(level, [](const Cut& cut) { return cut.all < 2 || !(cut.high > cut.low); });
      find_planes(level, team);
      level = halves(level);
    }
    const double all = std::numeric_limits<double>::infinity();
    number_cells(0, {Eigen::Array3d::Constant(-all), Eigen::Array3d::Constant(all)});
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

  /// A node that is to be cut.
  struct Cut {
    std::size_t node, cells;
    Eigen::Vector3d *first, *last;  ///< the places here
    std::uint64_t all = 0;          ///< places, of all processes
    int axis = 0;
    double low = 0, high = 0;                        ///< the plane is above the first, and not above the second
    Eigen::Vector3d *from = nullptr, *to = nullptr;  ///< the places here between the two
    bool found = false;                              ///< `high` it is

    std::size_t lower() const { return cells / 2; }
    /// How many places are to be below the plane.
    double wanted() const {
      return std::max(1.0,
                      std::floor(static_cast<double>(lower()) / static_cast<double>(cells) * static_cast<double>(all)));
    }
    double middle() const { return low / 2 + high / 2; }
  };

  static void find_axes(std::vector<Cut>& level, Team& team) {
    std::vector<std::uint64_t> counts;
    std::vector<double> ends;
    for (const Cut& cut : level) {
      Eigen::Array3d high = Eigen::Array3d::Constant(-std::numeric_limits<double>::infinity()), minus_low = high;
      for (const Eigen::Vector3d* place = cut.first; place != cut.last; ++place) {
        high = high.max(place->array()), minus_low = minus_low.max(-place->array());
      }
      counts.push_back(static_cast<std::uint64_t>(cut.last - cut.first));
      ends.insert(ends.end(), high.begin(), high.end());
      ends.insert(ends.end(), minus_low.begin(), minus_low.end());
    }
    team.combine(counts, ends);
    for (std::size_t i = 0; i < level.size(); ++i) {
      Cut& cut = level[i];
      const Eigen::Map<const Eigen::Array3d> high(&ends[6 * i]), minus_low(&ends[6 * i + 3]);
      (high + minus_low).maxCoeff(&cut.axis);
      cut.all = counts[i], cut.low = -minus_low[cut.axis], cut.high = high[cut.axis];
      cut.from = cut.first, cut.to = cut.last;
    }
  }

  /// By halves of the distance in which the plane must be. It ends early where places coincide.
  static void find_planes(std::vector<Cut>& level, Team& team) {
    constexpr int most_rounds = 64;
    std::vector<std::uint64_t> below(level.size());
    std::vector<Eigen::Vector3d*> middle(level.size());
    for (int round = 0; round < most_rounds; ++round) {
      bool any = false;
      for (std::size_t i = 0; i < level.size(); ++i) {
        Cut& cut = level[i];
        const double at = cut.middle();
        cut.found = cut.found || !(at > cut.low && at < cut.high);
        below[i] = 0;
        if (cut.found) continue;
        any = true;
        middle[i] = std::partition(cut.from, cut.to, [&](const Eigen::Vector3d& p) { return p[cut.axis] < at; });
        below[i] = static_cast<std::uint64_t>(middle[i] - cut.first);
      }
      if (!any) return;
      team.combine(below, {});
      for (std::size_t i = 0; i < level.size(); ++i) {
        Cut& cut = level[i];
        if (cut.found) continue;
        const double at = cut.middle(), too_many = static_cast<double>(below[i]) - cut.wanted();
        cut.found = below[i] > 0 && std::abs(too_many) <= static_cast<double>(cut.all) / 1024;
        if (cut.found || too_many > 0) {
          cut.high = at, cut.to = middle[i];
        } else {
          cut.low = at, cut.from = middle[i];
        }
      }
    }
  }

  std::vector<Cut> halves(const std::vector<Cut>& level) {
    std::vector<Cut> next;
    for (const Cut& cut : level) {
      Eigen::Vector3d* const middle =
          std::partition(cut.first, cut.last, [&](const Eigen::Vector3d& place) { return place[cut.axis] < cut.high; });
      const std::size_t low = nodes_.size();
      nodes_.resize(low + 2);
      nodes_[cut.node] = {cut.axis, cut.high, {low, low + 1}, 0};
      next.push_back({low, cut.lower(), cut.first, middle});
      next.push_back({low + 1, cut.cells - cut.lower(), middle, cut.last});
    }
    return next;
  }

  /// Those below a plane before those above it.
  void number_cells(std::size_t at, const StaticBox& box) {
    const Node node = nodes_[at];
    if (node.axis < 0) {
      nodes_[at].cell = cells_.size();
      return cells_.push_back(box);
    }
    StaticBox below = box, above = box;
    below.max[node.axis] = above.min[node.axis] = node.at;
    number_cells(node.next[0], below);
    number_cells(node.next[1], above);
  }

  std::vector<Node> nodes_;
  std::vector<StaticBox> cells_;
};

}  // namespace kds::collision
