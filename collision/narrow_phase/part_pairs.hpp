// Which parts of two compounds may meet, and when.
#pragma once

#include "collision/narrow_phase/mesh_margins.hpp"
#include "collision/narrow_phase/narrow_phase.hpp"
#include "collision/narrow_phase/part_groups.hpp"
#include "collision/narrow_phase/quick_motion.hpp"
#include "collision/narrow_phase/relative_motion.hpp"
#include "collision/shapes/bending_mesh.hpp"
#include "collision/shapes/half_space.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace kds::collision {

/// The numbers of the parts, in the order of those of a, then of b, in all groups of which may_meet(group of a, group
/// of b) is true.
template <class MayMeet>
std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs_in_groups(const PartGroups& a, const PartGroups& b,
                                                                     const MayMeet& may_meet) {
  const auto size = [](const PartGroups& groups, std::uint32_t group) {
    return groups.is_leaf(group) ? -1 : squared_norm(groups.node(group).high - groups.node(group).low);
  };
  std::vector<std::pair<std::uint32_t, std::uint32_t>> found, waiting{{0, 0}};
  while (!waiting.empty()) {
    const std::uint32_t of_a = waiting.back().first, of_b = waiting.back().second;
    waiting.pop_back();
    if (!may_meet(of_a, of_b)) continue;
    const double size_a = size(a, of_a), size_b = size(b, of_b);
    if (size_a < 0 && size_b < 0) {
      a.each_part(of_a, [&](std::uint32_t part_a) {
        b.each_part(of_b, [&](std::uint32_t part_b) { found.emplace_back(part_a, part_b); });
      });
    } else if (size_a >= size_b) {
      for (std::uint32_t child = 0; child < 2; ++child) waiting.emplace_back(a.first_child(of_a) + child, of_b);
    } else {
      for (std::uint32_t child = 0; child < 2; ++child) waiting.emplace_back(of_a, b.first_child(of_b) + child);
    }
  }
  std::sort(found.begin(), found.end());
  return found;
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
  /// The same, by `from`; of a list that is made piece by piece those of the last piece.
  std::vector<Pair> in_time() const {
    std::vector<Pair> sorted = pairs_;
    if (listed_before_ != -never)
      std::erase_if(sorted, [this](const Pair& pair) { return pair.from <= listed_before_; });
    std::stable_sort(sorted.begin(), sorted.end(), [](const Pair& x, const Pair& y) { return x.from < y.from; });
    return sorted;
  }

 protected:
  std::vector<Pair> pairs_;
  double listed_before_ = -never;
};

/// The pairs of parts of two bodies whose boxes may overlap at some time from now to the horizon, in the order of the
/// parts of a, then of b.
///
/// Boxes of meshes are as far apart as ContactGap reports contact, at the end of the time that is looked at. The box of
/// a mesh that bends is that around all its forms, grown by what counts as contact there. Of a half-space it is its
/// plane that boxes meet.
///
/// Where a body has a tree of parts, the boxes of groups are looked at first, grown by four times the error bound of
/// QuickMotion: what it answers of a part is true of any group that has it. So the list is the one that a look at each
/// part makes. (Degree 3 and above: but for parts whose boxes do not meet, for which bounds were too wide.) Of bodies
/// that move so little relative to each other that QuickMotion cannot tell that they part for good, each part is looked
/// at.
///
/// Cost: for each part of a, or of those groups, at most six roots of QuickMotion, and for those whose boxes meet the
/// box around all of b within the time as many for each part of b; as many for each group.
template <int Degree>
class PartPairs : public ListOfPartPairs {
 public:
  using Body = TranslatingShape<Degree>;

  PartPairs(const Body& a, const Body& b, double now, double horizon)
      : motion_(a.motion, b.motion, now, horizon, size_of(a.shape) + size_of(b.shape)) {
    for (std::size_t d = 0; d < 3; ++d) along_[d] = motion_.along(Eigen::Vector3d::Unit(static_cast<Eigen::Index>(d)));
    if (unbounded(a.shape.shape)) plane_ = PlaneOf{placed_half_space(a.shape), 1, {}};
    if (unbounded(b.shape.shape)) plane_ = PlaneOf{placed_half_space(b.shape), -1, {}};
    if (plane_) plane_->along = motion_.along(plane_->half_space.normal);
    look_beyond(a.shape, b.shape);
    if (!plane_ && (has_mesh(a.shape.shape) || has_mesh(b.shape.shape))) {
      const RelativeMotion<Degree> motion = relative_to(a.motion, b.motion);
      mesh_margin_ = quick_margin * contact_gap(motion, a.shape.bounding_radius + b.shape.bounding_radius)(
                                        std::max(now - motion.epoch, 0.0) + motion_.end());
    }
    for (const PlacedShape* const shape : {&a.shape, &b.shape}) {
      if (bends(shape->shape)) bending_margin_ += 4 * bending_tolerance * shape->bounding_radius;
    }
    const PartGroups groups_a(a.shape), groups_b(b.shape);
    whole_ = motion_.whole();
    if (groups_a.has_tree() || groups_b.has_tree()) {
      whole_ = whole_ || stand_to_each_other(a.motion, b.motion);
      if (whole_) {
        look_at_groups(groups_a, groups_b, now);
        return;
      }
    }
    for (const PlacedShape& part_a : parts_of(a.shape)) {
      Pair pair{&part_a, &b.shape, now, never};
      if (!clip(pair)) continue;
      for (const PlacedShape& part_b : parts_of(b.shape)) {
        pair = {&part_a, &part_b, now, never};
        if (clip(pair)) pairs_.push_back(pair);
      }
    }
  }

  /// Lists more pairs if some that meet by this time are not yet listed; else false.
  static constexpr bool list_on(double) { return false; }

 private:
  /// Whether the way between two bodies never changes.
  static bool stand_to_each_other(const certificates::PointMotion<Degree>& a,
                                  const certificates::PointMotion<Degree>& b) {
    bool curved = false;
    for (std::size_t i = 1; i <= Degree; ++i) {
      if (a.coefficients[i] != b.coefficients[i]) return false;
      curved = curved || (i >= 2 && !a.coefficients[i].isZero(0));
    }
    return !curved || a.start == b.start;
  }

  void look_at_groups(const PartGroups& a, const PartGroups& b, double now) {
    const double grown = 4 * motion_.error() + mesh_margin_ + bending_margin_;
    const auto may_meet = [&](std::uint32_t of_a, std::uint32_t of_b) {
      const auto [low_a, high_a] = a.box(of_a);
      const auto [low_b, high_b] = b.box(of_b);
      TimeWindow window{0, motion_.end()};
      return boxes_meet(low_a, high_a, low_b, high_b, grown, window);
    };
    const std::span<const PlacedShape> parts_a = parts_of(a.shape()), parts_b = parts_of(b.shape());
    const PlacedShape* last = nullptr;
    bool meets = false;  // `last` and all of b
    for (const auto& [place_a, place_b] : pairs_in_groups(a, b, may_meet)) {
      if (last != &parts_a[place_a]) {
        last = &parts_a[place_a];
        Pair with_all{last, &b.shape(), now, never};
        meets = clip(with_all);
      }
      Pair pair{last, &parts_b[place_b], now, never};
      if (meets && clip(pair)) pairs_.push_back(pair);
    }
  }

  static double size_of(const PlacedShape& shape) {
    return unbounded(shape.shape) ? std::abs(placed_half_space(shape).offset) : shape.bounding_radius;
  }

  /// Finds out whether the boxes around the bodies never meet again after the last time for which the motion has
  /// answers.
  void look_beyond(const PlacedShape& a, const PlacedShape& b) {
    if (plane_) {
      const PlacedShape& other = plane_->side > 0 ? b : a;
      motion_.note_opening(plane_->along, plane_->side, plane_->half_space.offset - lowest(other.low, other.high));
      return;
    }
    for (std::size_t d = 0; d < 3 && !motion_.whole(); ++d) {
      const auto axis = static_cast<Eigen::Index>(d);
      motion_.note_opening(along_[d], 1, a.high[axis] - b.low[axis]);
      motion_.note_opening(along_[d], -1, b.high[axis] - a.low[axis]);
    }
  }

  /// The lowest place of a box along the normal of the plane.
  double lowest(const Eigen::Vector3d& low, const Eigen::Vector3d& high) const {
    const Eigen::Vector3d& normal = plane_->half_space.normal;
    return dot(normal, 0.5 * (low + high)) - dot(normal.cwiseAbs(), 0.5 * (high - low));
  }

  /// Sets the times of a pair. False if its boxes do not meet.
  bool clip(Pair& pair) const {
    const bool mesh = has_mesh(pair.a->shape) || has_mesh(pair.b->shape);
    const double margin = (mesh ? mesh_margin_ : 0) + bending_margin_ + (plane_ ? 4 * motion_.error() : 0);
    TimeWindow window{0, motion_.end()};
    const bool meet = boxes_meet(pair.a->low, pair.a->high, pair.b->low, pair.b->high, margin, window);
    if (!meet && whole_) return false;
    pair.from = motion_.time_before(meet ? window.begin : motion_.end());
    pair.until = meet && motion_.whole() && window.end < motion_.end() ? motion_.time_after(window.end) : never;
    return true;
  }

  /// Shrinks the window to times at which two boxes, grown by a margin, may overlap; false if there are none.
  bool boxes_meet(const Eigen::Vector3d& low_a, const Eigen::Vector3d& high_a, const Eigen::Vector3d& low_b,
                  const Eigen::Vector3d& high_b, double margin, TimeWindow& window) const {
    if (plane_) {
      const double height = plane_->side > 0 ? lowest(low_b, high_b) : lowest(low_a, high_a);
      return motion_.clip(plane_->along, plane_->side, plane_->half_space.offset - height + margin, window);
    }
    bool meet = true;
    for (std::size_t d = 0; d < 3 && meet; ++d) {
      const auto axis = static_cast<Eigen::Index>(d);
      meet = motion_.clip(along_[d], 1, high_a[axis] - low_b[axis] + margin, window) &&
             motion_.clip(along_[d], -1, high_b[axis] - low_a[axis] + margin, window);
    }
    return meet;
  }

  struct PlaneOf {
    HalfSpace half_space;
    double side;  ///< 1 if it is a, -1 if it is b
    typename QuickMotion<Degree>::Along along;
  };

  QuickMotion<Degree> motion_;
  std::array<typename QuickMotion<Degree>::Along, 3> along_;
  std::optional<PlaneOf> plane_{};  ///< of a half-space, if one of the two is
  double mesh_margin_ = 0, bending_margin_ = 0;
  bool whole_ = true;  ///< what does not meet until the end of the motion's answers does not meet after it
};

}  // namespace kds::collision
