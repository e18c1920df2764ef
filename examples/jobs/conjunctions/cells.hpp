// A hash table of cubic cells.
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace conjunctions {

/// Objects in cubic cells, in a hash table that is emptied at once: entries of earlier rounds do not count.
class CellTable {
 public:
  explicit CellTable(std::size_t objects) : next_(objects) {
    std::size_t buckets = 16;
    while (buckets < 4 * objects) buckets *= 2;
    buckets_.resize(buckets);
  }

  /// Empties it; cells are so wide from now on.
  void clear(double width) {
    width_ = width;
    ++round_;
  }

  /// Calls visit(other) for those in the eight cells around a place that hold all that is within half a width, and some
  /// more whose cells share a bucket; then puts the object in its cell.
  template <class Visit>
  void visit_and_add(std::uint32_t object, const Eigen::Vector3d& place, Visit&& visit) {
    std::array<std::array<std::int64_t, 2>, 3> cells;  // its own, and the nearest beside it
    for (int d = 0; d < 3; ++d) {
      const double x = place[d] / width_;
      const auto cell = static_cast<std::int64_t>(std::floor(x));
      cells[static_cast<std::size_t>(d)] = {cell, x - std::floor(x) < 0.5 ? cell - 1 : cell + 1};
    }
    std::array<std::size_t, 8> places;  // several cells may share a bucket, which is visited once
    for (std::size_t i = 0; i < 8; ++i) {
      places[i] = bucket_of(cells[0][i & 1], cells[1][i >> 1 & 1], cells[2][i >> 2]);
      const Bucket& bucket = buckets_[places[i]];
      if (bucket.round != round_ || std::find(places.begin(), places.begin() + i, places[i]) != places.begin() + i) {
        continue;
      }
      for (std::uint32_t other = bucket.first; other != none; other = next_[other]) visit(other);
    }
    Bucket& own = buckets_[places[0]];
    next_[object] = own.round == round_ ? own.first : none;
    own = {object, round_};
  }

 private:
  static constexpr std::uint32_t none = ~0u;
  struct Bucket {
    std::uint32_t first = none;
    std::uint32_t round = 0;
  };

  std::size_t bucket_of(std::int64_t x, std::int64_t y, std::int64_t z) const {
    const auto key = static_cast<std::uint64_t>(x) * 0x9e3779b97f4a7c15 ^
                     static_cast<std::uint64_t>(y) * 0xc2b2ae3d27d4eb4f ^
                     static_cast<std::uint64_t>(z) * 0x165667b19e3779f9;
    return (key ^ key >> 32) & (buckets_.size() - 1);
  }

  double width_ = 1;
  std::vector<Bucket> buckets_;
  std::vector<std::uint32_t> next_;
  std::uint32_t round_ = 1;
};

}  // namespace conjunctions
