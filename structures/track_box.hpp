// Bounding boxes of tracks that grow, for a tree of them.
#pragma once

#include "certificates/plane_motion.hpp"
#include "structures/tree_box.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

namespace kds::structures {

/// A growing box that contains the tracks of some paths of degree 1 at all times: each of its sides moves as fast as
/// the fastest of them, from when the first of them begins. `until` is the last time, in s, for which the box may be
/// asked: `never` for all times, `at_no_time` for none.
///
/// Roundings: one of each of a difference, a product and a sum, 2^-53 of the numbers each, one of the margin; 2^-50 of
/// the numbers covers them, and 2^-1000 underflow.
struct TrackBox {
  static constexpr double at_no_time = -std::numeric_limits<double>::infinity();

  std::array<double, 2> min{}, max{};  ///< of the beginnings, in units of length
  std::array<double, 2> down{}, up{};  ///< how fast it grows, down <= 0 <= up, in units of length a second
  double since = 0;                    ///< s
  double until = at_no_time;           ///< s

  static TrackBox of(const certificates::PlaneMotion<1>& path, double until) {
    TrackBox box;
    for (std::size_t d = 0; d < 2; ++d) {
      const auto& c = path.coordinate[d].c;
      box.min[d] = box.max[d] = c[0];
      box.down[d] = std::min(c[1], 0.0);
      box.up[d] = std::max(c[1], 0.0);
    }
    box.since = path.start;
    box.until = until;
    return box;
  }

  /// The tracks up to a time, which may be infinite.
  TreeBox<2> at(double t) const {
    const double elapsed = std::max(t - since, 0.0);
    TreeBox<2> box;
    for (std::size_t d = 0; d < 2; ++d) {
      const auto margin = [](double place, double way) {
        return 0x1p-50 * (std::max(place, -place) + std::max(way, -way)) + 0x1p-1000;
      };
      const double low = down[d] == 0 ? 0 : down[d] * elapsed, high = up[d] == 0 ? 0 : up[d] * elapsed;
      box.min[d] = min[d] + low - margin(min[d], low);
      box.max[d] = max[d] + high + margin(max[d], high);
    }
    return box;
  }
  /// The same tracks, which stop growing at a time.
  TrackBox stopped_at(double t) const {
    const TreeBox<2> box = at(t);
    return {box.min, box.max, {}, {}, since, at_no_time};
  }

  /// Whether one of the tracks may come to a place up to a time.
  struct Place {
    TreeBox<2> box;
    double time;
  };
  bool overlaps(const Place& place) const { return at(place.time).overlaps(place.box); }
  /// Whether one of the tracks may come to a track of the other box up to `until`.
  bool overlaps(const TrackBox& other) const { return until != at_no_time && at(until).overlaps(other.at(until)); }
  bool contains(const TrackBox& other) const {
    bool all = since <= other.since && other.until <= until;
    for (std::size_t d = 0; d < 2; ++d) {
      all = all && min[d] <= other.min[d] && other.max[d] <= max[d] && down[d] <= other.down[d] && other.up[d] <= up[d];
    }
    return all;
  }
  /// For building trees: half the circumference at the beginning, since all boxes grow at about the same rate.
  double surface() const { return max[0] - min[0] + (max[1] - min[1]); }

  friend bool operator==(const TrackBox&, const TrackBox&) = default;
  friend TrackBox hull(const TrackBox& a, const TrackBox& b) {
    TrackBox both;
    for (std::size_t d = 0; d < 2; ++d) {
      both.min[d] = std::min(a.min[d], b.min[d]);
      both.max[d] = std::max(a.max[d], b.max[d]);
      both.down[d] = std::min(a.down[d], b.down[d]);
      both.up[d] = std::max(a.up[d], b.up[d]);
    }
    both.since = std::min(a.since, b.since);
    both.until = std::max(a.until, b.until);
    return both;
  }
};

}  // namespace kds::structures
