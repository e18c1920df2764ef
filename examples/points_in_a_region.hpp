// Which moving points are in a region that moves or grows: a structure in some forty lines.
#pragma once

#include "kds/framework/kinetic_rule.hpp"
#include "structures/moving_regions.hpp"
#include "structures/selection.hpp"

#include <array>
#include <cstddef>
#include <optional>

namespace kds::examples {

/// The points in one region, a moving rectangle or a growing ball (structures/moving_regions.hpp). A point inside has a
/// certificate of each side of the region; one outside has one, of a side that it is beyond. Another region at any
/// time:
///
///     structure.edit([&](auto& rule, auto& repair) { rule.change_region(region, repair); }, now);
///
/// Cost: at most one certificate a side for an event, and that many for each point. The region is no element: reverse()
/// leaves it as it is, so that afterwards it has to be changed to reversed(region).
template <structures::Region R>
struct PointsInRule {
  using Element = typename R::Point;
  static constexpr const char* name = "PointsIn";
  R region;
  structures::Selection<R::sides> inside = {};
  std::size_t count = 0;  ///< of points inside

  std::optional<typename R::Side> certificate(Slot slot, const MovingSet<Element>& points) const {
    const int sign = inside.certified(slot / R::sides, slot % R::sides);
    if (sign == 0) return std::nullopt;
    return region.side(slot % R::sides, points[slot / R::sides], sign);
  }
  std::array<Id, 1> members(Slot slot) const { return {slot / static_cast<Slot>(R::sides)}; }

  Effect repair(Slot slot, Repair<Element>& repair) {
    const bool changed = renew(members(slot)[0], repair,
                               [&](Id point, const auto& within) { inside.turn(point, slot % R::sides, within); });
    return changed ? Effect::external : Effect::internal;
  }
  void insert(Id id, Repair<Element>& repair) {
    renew(id, repair, [&](Id point, const auto& within) { inside.look(point, within); });
  }
  void remove(Id id, Repair<Element>& repair) {
    renew(id, repair, [&](Id point, const auto&) { inside.let_go(point); });
  }
  void change_region(const R& other, Repair<Element>& repair) {
    region = other;
    for (const Id id : repair.elements().ids()) insert(id, repair);
  }

  template <class Archive>
  void archive(Archive& archive) {
    archive(region, inside, count);
  }

 private:
  /// Lets `change` select the point or not, and marks its slots. Returns whether it has come in or gone out.
  template <class Change>
  bool renew(Id id, Repair<Element>& repair, const Change& change) {
    const bool before = inside.contains(id);
    change(id, [&](std::size_t side) { return repair.sign(region.side(side, repair[id], 1)) >= 0; });
    count += inside.contains(id) - before;
    for (Slot side = 0; side < R::sides; ++side) repair.certify(id * static_cast<Slot>(R::sides) + side);
    return inside.contains(id) != before;
  }
};

}  // namespace kds::examples
