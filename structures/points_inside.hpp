// Which of moving points are in which of regions that move.
#pragma once

#include "kds/audit.hpp"
#include "kds/framework/elements_rule.hpp"
#include "kds/framework/kinetic_rule.hpp"
#include "structures/moving_regions.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace kds::structures {

/// Keeps which points are in which regions, balls or boxes that move and grow. Points are its own elements; it stands on
/// the set of regions:
///
///     Kinetic<ElementsRule<Disc>> discs(disc_set, now);
///     Kinetic<PointsInsideRule<Disc>> inside(points, discs, now);
///     Simulator simulator(now, discs, inside);
///
/// A point inside has a certificate for each side of the region. One outside has one, that it is beyond some side: when
/// that fails another side takes its place, or the point is inside.
///
/// Cost: for n points, m regions of s sides each, at most s certificates for an event (responsive), n m of them while
/// all are outside and s for each point in a region (compact, as what it answers is as large); a point is in m to s m
/// (not local in m). Events are external but where a point outside passes from one side's outside to another's.
template <Region R>
class PointsInsideRule : public StandsOn<ElementsRule<R>> {
 public:
  static constexpr const char* name = "PointsInside";
  using Element = typename R::Point;
  using Pen = RepairOf<PointsInsideRule>;

  /// Points on the border are inside; false for what is not there.
  bool contains(Id region, Id point) const {
    const std::uint32_t pair = find(region, point);
    return pair != none && pairs_[pair].beyond == inside;
  }
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
    const Pair& pair = pairs_[slot / R::sides];
    const auto side = static_cast<std::uint8_t>(slot % R::sides);
    if (pair.point == nobody || (pair.beyond != inside && pair.beyond != side)) return std::nullopt;
    return this->inner()[pair.region].side(side, points[pair.point], pair.beyond == inside ? 1 : -1);
  }
  std::array<Id, 1> members(Slot slot) const { return {pairs_[slot / R::sides].point}; }

  Effect repair(Slot slot, Pen& repair) {
    Pair& pair = pairs_[slot / R::sides];
    const bool was_inside = pair.beyond == inside;
    pair.beyond = was_inside ? static_cast<std::uint8_t>(slot % R::sides) : beyond_which(pair, repair);
    mark(slot / R::sides, repair);
    return was_inside || pair.beyond == inside ? Effect::external : Effect::internal;
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

  void audit(const MovingSet<Element>& points, double /*now*/) const {
    std::size_t pairs = 0;
    for (const Id region : this->inner().elements().ids()) {
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
    archive(pairs_, free_, pair_of_);
  }

 private:
  static constexpr std::uint32_t none = nobody;
  static constexpr std::uint8_t inside = 0xFF;
  static_assert(R::sides < inside);

  struct Pair {
    Id region = nobody, point = nobody;
    std::uint8_t beyond = inside;  ///< a side that the point is beyond

    template <class Archive>
    void archive(Archive& archive) {
      archive(region, point, beyond);
    }
  };

  std::uint32_t find(Id region, Id point) const {
    return region < pair_of_.size() && point < pair_of_[region].size() ? pair_of_[region][point] : none;
  }
  std::uint8_t beyond_which(const Pair& pair, const Pen& repair) const {
    for (std::uint8_t side = 0; side < R::sides; ++side) {
      const auto holds = this->inner()[pair.region].side(side, repair[pair.point], 1);
      bool beyond = false;
      kds::detail::with_certificate(holds, [&](const auto& certificate) { beyond = repair.sign(certificate) < 0; });
      if (beyond) return side;
    }
    return inside;
  }
  static void mark(std::uint32_t pair, Pen& repair) {
    for (Slot side = 0; side < R::sides; ++side) repair.certify(static_cast<Slot>(R::sides) * pair + side);
  }

  void look(Id region, Id point, Pen& repair) {
    if (region >= pair_of_.size()) pair_of_.resize(region + std::size_t{1});
    if (point >= pair_of_[region].size()) pair_of_[region].resize(point + std::size_t{1}, none);
    std::uint32_t& pair = pair_of_[region][point];
    if (pair == none) {
      pair = free_.empty() ? static_cast<std::uint32_t>(pairs_.size()) : free_.back();
      free_.empty() ? pairs_.emplace_back() : (free_.pop_back(), pairs_[pair]);
      pairs_[pair] = {region, point, inside};
    }
    pairs_[pair].beyond = beyond_which(pairs_[pair], repair);
    mark(pair, repair);
  }
  void let_go(Id region, Id point, Pen& repair) {
    const std::uint32_t pair = find(region, point);
    if (pair == none) return;
    mark(pair, repair);
    pairs_[pair] = {};
    free_.push_back(pair);
    pair_of_[region][point] = none;
  }

  std::vector<Pair> pairs_;
  std::vector<std::uint32_t> free_;                  ///< numbers of pairs that are none any more
  std::vector<std::vector<std::uint32_t>> pair_of_;  ///< by region and point
};

}  // namespace kds::structures
