// What callers have changed of bodies at one instant.
#pragma once

#include "collision/body_id.hpp"
#include "collision/world/bodies.hpp"
#include "collision/world/ignored_pairs.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace kds::collision {

/// Jumps, changes of filters and of ignored pairs at one instant, for pairs that the broad phase finds later at that
/// instant: whether such a pair begins by an edit or by motion decides how an overlap of its bodies is met. The first
/// edit of another instant makes it forget all earlier ones.
///
/// Cost: O(log n) of n edits each; O(f g) more to ask about two bodies that have had f and g different filters.
class InstantEdits {
 public:
  /// A body and a filter that it had.
  using Filtered = std::pair<BodySlot, CollisionFilter>;
  using Ignored = IgnoredPairs::Pair;

  void add_jump(BodySlot body, double now) { begin(now), jumped_.insert(body); }
  void add_filter(BodySlot body, const CollisionFilter& before, double now) {
    begin(now);
    auto& had = had_[body];
    if (std::find(had.begin(), had.end(), before) == had.end()) had.push_back(before);
  }
  void add_ignored(BodySlot a, BodySlot b, double now) { begin(now), ignored_.add(a, b); }
  /// Forgets all that was done to a body that is removed: another body may get its slot.
  void forget(BodySlot body) { jumped_.erase(body), had_.erase(body), ignored_.forget(body); }

  bool has_jumped(BodySlot body, double now) const { return at_ == now && jumped_.contains(body); }
  /// Whether two bodies, which may collide, could not at a moment of this instant: they were ignored, or one of them
  /// had another filter.
  bool has_let_collide(BodySlot a, const CollisionFilter& of_a, BodySlot b, const CollisionFilter& of_b,
                       double now) const {
    if (at_ != now || (had_.empty() && ignored_.empty())) return false;
    if (ignored_.contains(a, b)) return true;
    const std::vector<CollisionFilter>&had_a = had(a), &had_b = had(b);
    return kept_apart(of_a, had_b) || kept_apart(of_b, had_a) ||
           std::any_of(had_a.begin(), had_a.end(), [&](const auto& filter) { return kept_apart(filter, had_b); });
  }

  /// All edits at `now`, in the order of the bodies; the filters of one body in the order in which it had them.
  struct Image {
    std::vector<BodySlot> jumped;
    std::vector<Filtered> filtered;
    std::vector<Ignored> ignored;  ///< the lower slot first
  };
  Image image(double now) const {
    Image image;
    if (at_ != now) return image;
    image.jumped.assign(jumped_.begin(), jumped_.end());
    for (const auto& [body, filters] : had_) {
      for (const CollisionFilter& filter : filters) image.filtered.emplace_back(body, filter);
    }
    image.ignored = ignored_.pairs();
    return image;
  }
  void become(const Image& image, double now) {
    *this = {};
    for (const BodySlot body : image.jumped) add_jump(body, now);
    for (const auto& [body, filter] : image.filtered) add_filter(body, filter, now);
    for (const auto& [a, b] : image.ignored) add_ignored(a, b, now);
  }

 private:
  void begin(double now) {
    if (at_ != now) *this = {};
    at_ = now;
  }
  const std::vector<CollisionFilter>& had(BodySlot body) const {
    static const std::vector<CollisionFilter> none;
    const auto found = had_.find(body);
    return found == had_.end() ? none : found->second;
  }
  static bool kept_apart(const CollisionFilter& filter, const std::vector<CollisionFilter>& others) {
    return std::any_of(others.begin(), others.end(), [&](const auto& other) { return !filter.meets(other); });
  }

  double at_ = -never;
  std::set<BodySlot> jumped_;
  std::map<BodySlot, std::vector<CollisionFilter>> had_;
  IgnoredPairs ignored_;
};

}  // namespace kds::collision
