// Which of moving points are in which of regions that move, and how many.
#pragma once

#include "kds/audit.hpp"
#include "kds/framework/elements_rule.hpp"
#include "kds/framework/free_numbers.hpp"
#include "kds/framework/kinetic.hpp"
#include "structures/moving_regions.hpp"
#include "structures/selection.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace kds::structures {

/// A point has entered a region or left it. One that stays inside while it or the region gets another motion leaves and
/// enters again, in one call.
struct InsideChange {
  enum class What : std::uint8_t { entered, left };  ///< on the border is inside
  What what;
  Id region, point;

  friend bool operator==(const InsideChange&, const InsideChange&) = default;
};

/// Keeps which points are in which regions, balls or boxes that move and grow, and how many are in each. Points are its
/// own elements; it stands on the set of regions:
///
///     Kinetic<ElementsRule<Disc>> discs(disc_set, now);
///     Kinetic<PointsInsideRule<Disc>> inside(points, discs, now);
///     Simulator simulator(now, discs, inside);
///
/// A point inside has a certificate for each side of the region. One outside has one, that it is beyond some side: when
/// that fails another side takes its place, or the point is inside (Selection). It reports who enters and who leaves
/// (InsideChange), so that other rules may stand on it.
///
/// Cost: for n points, m regions of s sides each, at most s certificates for an event (responsive), n m of them while
/// all are outside and s for each point in a region (compact, as what it answers is as large); a point is in m to s m
/// (not local in m). Events are external, except where the point stays outside and only another side proves that. So
/// counting the points in one moving rectangle takes n certificates and O(1) for a point that enters or leaves; for
/// many regions at a time this is no range tree.
template <Region R>
class PointsInsideRule : public StandsOn<ElementsRule<R>> {
 public:
  static constexpr const char* name = "PointsInside";
  using Element = typename R::Point;
  using Change = InsideChange;
  using Pen = RepairOf<PointsInsideRule>;

  /// Points on the border are inside; false for what is not there.
  bool contains(Id region, Id point) const {
    const std::uint32_t pair = find(region, point);
    return pair != none && selection_.contains(pair);
  }
  /// How many points are in a region; 0 if it is not there. O(1).
  std::size_t count(Id region) const { return region < count_.size() ? count_[region] : 0; }
  /// The points in a region, ascending. O(points).
  std::vector<Id> points_in(Id region) const {
    std::vector<Id> points;
    if (region >= pair_of_.size()) return points;
    for (Id point = 0; point < pair_of_[region].size(); ++point) {
      if (contains(region, point)) points.push_back(point);
    }
    return points;
  }

  // Slot: s times the number of a pair, and the side.
  std::optional<typename R::Side> certificate(Slot slot, const MovingSet<Element>& points) const {
    const int sign = selection_.certified(slot / R::sides, slot % R::sides);
    if (sign == 0) return std::nullopt;
    const Pair& pair = pairs_[slot / R::sides];
    return this->inner()[pair.region].side(slot % R::sides, points[pair.point], sign);
  }
  std::array<Id, 1> members(Slot slot) const { return {pairs_[slot / R::sides].point}; }

  Effect repair(Slot slot, Pen& repair) {
    const auto pair = static_cast<std::uint32_t>(slot / R::sides);
    const bool was_inside = selection_.contains(pair);
    selection_.turn(pair, slot % R::sides, is_within(pair, repair));
    mark(pair, repair);
    if (was_inside == selection_.contains(pair)) return Effect::internal;
    tell(pair, was_inside ? InsideChange::What::left : InsideChange::What::entered, repair);
    return Effect::external;
  }
  Effect follow(std::span<const ElementChange> changes, Pen& repair) {
    for (const auto& [what, region] : changes) {
      for (const Id point : repair.elements().ids()) {
        what == ElementChange::What::goes ? let_go(region, point, repair) : look(region, point, repair);
      }
    }
    return Effect::external;
  }
  void insert(Id point, Pen& repair) {
    for (const Id region : this->inner().elements().ids()) look(region, point, repair);
  }
  void remove(Id point, Pen& repair) {
    for (const Id region : this->inner().elements().ids()) let_go(region, point, repair);
  }

  std::vector<InsideChange> changes_from_nothing() const {
    std::vector<InsideChange> changes;
    for (std::uint32_t pair = 0; pair < pairs_.size(); ++pair) {
      if (!selection_.contains(pair)) continue;
      changes.push_back({InsideChange::What::entered, pairs_[pair].region, pairs_[pair].point});
    }
    return changes;
  }

  void audit(const MovingSet<Element>& points, double /*now*/) const {
    std::size_t pairs = 0;
    for (const Id region : this->inner().elements().ids()) {
      if (count(region) != points_in(region).size()) {
        throw AuditFailure(std::string(name) + ": region " + std::to_string(region) + ": has not as many points");
      }
      for (const Id point : points.ids()) {
        const std::uint32_t pair = find(region, point);
        if (pair == none || pairs_[pair].region != region || pairs_[pair].point != point) {
          throw AuditFailure(std::string(name) + ": point " + std::to_string(point) + " and region " +
                             std::to_string(region) + " are no pair");
        }
        ++pairs;
      }
    }
    if (pairs + free_.size() != pairs_.size()) throw AuditFailure(std::string(name) + ": there are other pairs");
  }

  template <class Archive>
  void archive(Archive& archive) {
    archive(pairs_, selection_, count_, free_, pair_of_);
  }

 private:
  static constexpr std::uint32_t none = nobody;

  struct Pair {
    Id region = nobody, point = nobody;
  };

  std::uint32_t find(Id region, Id point) const {
    return region < pair_of_.size() && point < pair_of_[region].size() ? pair_of_[region][point] : none;
  }
  auto is_within(std::uint32_t pair, const Pen& repair) const {
    return [this, pair, &repair](std::size_t i) {
      return repair.sign(this->inner()[pairs_[pair].region].side(i, repair[pairs_[pair].point], 1)) >= 0;
    };
  }
  void tell(std::uint32_t pair, InsideChange::What what, Pen& repair) {
    const auto [region, point] = pairs_[pair];
    if (region >= count_.size()) count_.resize(region + std::size_t{1}, 0);
    what == InsideChange::What::entered ? ++count_[region] : --count_[region];
    repair.report({what, region, point});
  }
  static void mark(std::uint32_t pair, Pen& repair) {
    for (Slot side = 0; side < R::sides; ++side) repair.certify(static_cast<Slot>(R::sides) * pair + side);
  }

  void look(Id region, Id point, Pen& repair) {
    if (region >= pair_of_.size()) pair_of_.resize(region + std::size_t{1});
    if (point >= pair_of_[region].size()) pair_of_[region].resize(point + std::size_t{1}, none);
    std::uint32_t& pair = pair_of_[region][point];
    if (pair == none) {
      pair = free_.take(pairs_.size());
      if (pair == pairs_.size()) pairs_.emplace_back();
      pairs_[pair] = {region, point};
    }
    if (selection_.contains(pair)) tell(pair, InsideChange::What::left, repair);
    selection_.look(pair, is_within(pair, repair));
    if (selection_.contains(pair)) tell(pair, InsideChange::What::entered, repair);
    mark(pair, repair);
  }
  void let_go(Id region, Id point, Pen& repair) {
    const std::uint32_t pair = find(region, point);
    if (pair == none) return;
    mark(pair, repair);
    if (selection_.contains(pair)) tell(pair, InsideChange::What::left, repair);
    selection_.let_go(pair);
    pairs_[pair] = {};
    free_.give_back(pair);
    pair_of_[region][point] = none;
  }

  std::vector<Pair> pairs_;
  Selection<R::sides> selection_;                    ///< pairs whose point is inside
  std::vector<std::uint32_t> count_;                 ///< of points, by region
  FreeNumbers free_;                                 ///< numbers of pairs
  std::vector<std::vector<std::uint32_t>> pair_of_;  ///< by region and point
};

}  // namespace kds::structures
