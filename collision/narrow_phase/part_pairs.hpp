// Which parts of two compounds may meet, and when.
#pragma once

#include "collision/narrow_phase/mesh_margins.hpp"
#include "collision/narrow_phase/narrow_phase.hpp"
#include "collision/narrow_phase/quick_motion.hpp"
#include "collision/narrow_phase/relative_motion.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace kds::collision {

/// The parts of a compound; any other shape is its own only part.
inline std::span<const PlacedShape> parts_of(const PlacedShape& shape) {
  if (shape.parts) return *shape.parts;
  return {&shape, 1};
}

/// Pairs of parts that may meet, and from when to when.
class ListOfPartPairs {
 public:
  /// Two parts that may meet in a stretch of time.
  struct Pair {
    const PlacedShape* a;
    const PlacedShape* b;
    double from;   ///< on the clock: not in contact before
    double until;  ///< nor after
  };

  /// In the order of the parts of a, then of b.
  std::span<const Pair> all() const& { return pairs_; }
  std::span<const Pair> all() const&& = delete;  // it refers to this
  /// The same, by `from`.
  std::vector<Pair> in_time() const {
    std::vector<Pair> sorted = pairs_;
    std::stable_sort(sorted.begin(), sorted.end(), [](const Pair& x, const Pair& y) { return x.from < y.from; });
    return sorted;
  }

 protected:
  std::vector<Pair> pairs_;
};

/// The pairs of parts of two bodies whose boxes may overlap at some time from now to the horizon, in the order of the
/// parts of a, then of b.
///
/// Boxes of meshes are as far apart as ContactGap reports contact, at the end of the time that is looked at.
/// Half-spaces and meshes that bend are not looked at: they may meet each part at all times.
///
/// Cost: for each part of a at most six roots of QuickMotion, and for those whose boxes meet the box around all of b
/// within the time as many for each part of b.
template <int Degree>
class PartPairs : public ListOfPartPairs {
 public:
  using Body = TranslatingShape<Degree>;

  PartPairs(const Body& a, const Body& b, double now, double horizon)
      : motion_(a.motion, b.motion, now, horizon, sizes(a.shape, b.shape)) {
    const bool boxes =
        !unbounded(a.shape.shape) && !unbounded(b.shape.shape) && !bends(a.shape.shape) && !bends(b.shape.shape);
    for (std::size_t d = 0; d < 3; ++d) along_[d] = motion_.along(Eigen::Vector3d::Unit(static_cast<Eigen::Index>(d)));
    if (boxes) look_beyond(a.shape, b.shape);
    if (boxes && (has_mesh(a.shape.shape) || has_mesh(b.shape.shape))) {
      const RelativeMotion<Degree> motion = relative_to(a.motion, b.motion);
      mesh_margin_ = quick_margin * contact_gap(motion, a.shape.bounding_radius + b.shape.bounding_radius)(
                                        std::max(now - motion.epoch, 0.0) + motion_.end());
    }
    for (const PlacedShape& part_a : parts_of(a.shape)) {
      Pair pair{&part_a, &b.shape, now, never};
      if (boxes && !clip(pair)) continue;
      for (const PlacedShape& part_b : parts_of(b.shape)) {
        pair = {&part_a, &part_b, now, never};
        if (!boxes || clip(pair)) pairs_.push_back(pair);
      }
    }
  }

 private:
  static double sizes(const PlacedShape& a, const PlacedShape& b) {
    return (unbounded(a.shape) ? 0 : a.bounding_radius) + (unbounded(b.shape) ? 0 : b.bounding_radius);
  }

  /// Finds out whether the boxes around the bodies never meet again after the last time for which the motion has
  /// answers.
  void look_beyond(const PlacedShape& a, const PlacedShape& b) {
    for (std::size_t d = 0; d < 3 && !motion_.whole(); ++d) {
      const auto axis = static_cast<Eigen::Index>(d);
      motion_.note_opening(along_[d], 1, a.high[axis] - b.low[axis]);
      motion_.note_opening(along_[d], -1, b.high[axis] - a.low[axis]);
    }
  }

  /// Sets the times of a pair. False if its boxes do not meet.
  bool clip(Pair& pair) const {
    const bool mesh = has_mesh(pair.a->shape) || has_mesh(pair.b->shape);
    const double margin = mesh ? mesh_margin_ : 0;
    TimeWindow window{0, motion_.end()};
    bool meet = true;
    for (std::size_t d = 0; d < 3 && meet; ++d) {
      const auto axis = static_cast<Eigen::Index>(d);
      meet = motion_.clip(along_[d], 1, pair.a->high[axis] - pair.b->low[axis] + margin, window) &&
             motion_.clip(along_[d], -1, pair.b->high[axis] - pair.a->low[axis] + margin, window);
    }
    if (!meet && motion_.whole()) return false;
    pair.from = motion_.time_before(meet ? window.begin : motion_.end());
    pair.until = meet && motion_.whole() && window.end < motion_.end() ? motion_.time_after(window.end) : never;
    return true;
  }

  QuickMotion<Degree> motion_;
  std::array<typename QuickMotion<Degree>::Along, 3> along_;
  double mesh_margin_ = 0;
};

}  // namespace kds::collision
