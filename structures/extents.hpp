// Extents of a moving point set in given directions: bounding boxes and k-DOPs.
#pragma once

#include "certificates/direction_order.hpp"
#include "kds/framework/kinetic.hpp"
#include "structures/tournaments.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

namespace kds::structures {

/// The k / 2 directions of the usual k-DOPs in space: k = 6 the axes, 14 with the corners of a cube, 18 with the
/// middles of its edges, 26 with both. Not of unit length, so that they are exact. Throws std::invalid_argument for any
/// other k. Paper: [Klosowski98].
inline std::vector<std::array<double, 3>> kdop_directions(int k) {
  if (k != 6 && k != 14 && k != 18 && k != 26)
    throw std::invalid_argument("kdop_directions: k must be 6, 14, 18 or 26");
  std::vector<std::array<double, 3>> directions{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  if (k == 14 || k == 26) directions.insert(directions.end(), {{1, 1, 1}, {1, 1, -1}, {1, -1, 1}, {1, -1, -1}});
  if (k == 18 || k == 26) {
    directions.insert(directions.end(), {{1, 1, 0}, {1, -1, 0}, {1, 0, 1}, {1, 0, -1}, {0, 1, 1}, {0, 1, -1}});
  }
  return directions;
}

/// The point that is farthest at one end of a direction has become another, or has got a new motion.
struct ExtremeChange {
  std::size_t direction;  ///< its number
  bool foremost;          ///< or else the hindmost
  Id id;                  ///< nobody if there are no points

  friend bool operator==(const ExtremeChange&, const ExtremeChange&) = default;
};

/// Maintains, for each of m directions, the foremost and the hindmost of moving points: the extents that bound the set.
///
/// A binary tournament for each end of each direction. When a match's certificate fails it is played again, and so are
/// those above it as long as the winner changes. Papers: [Basch99] section 3.2; for k-DOPs that move [Coming08].
///
/// Cost for m directions: a change O(m log n), an event O(log n) certificates (responsive); an element plays in at most
/// 2 m log2 n matches (local); 2 m (n - 1) certificates (compact). External events are changes of an extreme point.
///
/// Ties: among points that stay equally far the one with the lowest id is the extreme one. It reports which points come
/// to be extreme (ExtremeChange), so that other rules may stand on it.
template <class Path, std::size_t Dimension>
class ExtentsRule : public Tournaments<ExtentsRule<Path, Dimension>, Path> {
  using Ends = Tournaments<ExtentsRule, Path>;
  using Ends::size, Ends::winner;

 public:
  using Direction = std::array<double, Dimension>;
  using Change = ExtremeChange;
  using Pen = Repair<Path, Change>;
  static constexpr const char* name = "Extents";

  /// Throws std::invalid_argument for no direction, or one that is zero or not finite.
  explicit ExtentsRule(std::vector<Direction> directions)
      : Ends(2 * directions.size()), directions_(std::move(directions)) {
    if (directions_.empty()) throw std::invalid_argument("Extents: there must be a direction");
    for (const Direction& direction : directions_) {
      bool zero = true;
      for (const double x : direction) {
        if (!std::isfinite(x)) throw std::invalid_argument("Extents: a direction must be finite");
        zero = zero && x == 0;
      }
      if (zero) throw std::invalid_argument("Extents: a direction must not be zero");
    }
  }

  const std::vector<Direction>& directions() const { return directions_; }

  /// The points that are farthest and least far in a direction, given by its number from 0, at t+; none if there are no
  /// points. Precondition: direction < directions().size().
  std::optional<Id> foremost(std::size_t direction) const { return end(2 * direction); }
  std::optional<Id> hindmost(std::size_t direction) const { return end(2 * direction + 1); }

  /// From least to greatest value of direction . point at t, rounded. Preconditions: there are points, and t is the
  /// clock or at least before the next event.
  std::array<double, 2> extent(std::size_t direction, const MovingSet<Path>& points, double t) const {
    return {value(direction, points[*hindmost(direction)], t), value(direction, points[*foremost(direction)], t)};
  }

  /// Tournament 2 d is for the foremost point of direction d, 2 d + 1 for the hindmost.
  certificates::DirectionOrder<Path, Dimension> better(Id i, Id j, std::size_t end, const MovingSet<Path>& x) const {
    const Direction& direction = directions_[end / 2];
    if (end % 2 == 0) return {x[j], x[i], direction};
    return {x[i], x[j], direction};
  }

  Effect repair(Slot slot, Pen& repair) {
    if (!this->play(slot, repair)) return Effect::internal;
    repair.report(extreme(this->tournament(slot)));
    return Effect::external;
  }
  void insert(Id id, Pen& repair) {
    for (std::size_t i = 0; i < ends(); ++i) {
      const bool was_extreme = winner(i) == id;
      this->enter(id, i, repair);
      if (was_extreme || winner(i) == id) repair.report(extreme(i));
    }
  }
  void remove(Id id, Pen& repair) {
    for (std::size_t i = 0; i < ends(); ++i) {
      const bool was_extreme = winner(i) == id;
      this->leave(id, i, repair);
      if (was_extreme) repair.report(extreme(i));
    }
  }
  void change(Id id, Pen& repair) { insert(id, repair); }

  std::vector<ExtremeChange> changes_from_nothing() const {
    std::vector<ExtremeChange> changes;
    for (std::size_t i = 0; i < ends(); ++i) {
      if (size(i) > 0) changes.push_back(extreme(i));
    }
    return changes;
  }

  void audit(const MovingSet<Path>& x, double /*now*/) const { this->audit_matches(x, ends()); }

  template <class Archive>
  void archive(Archive& archive) {
    archive(directions_);
    this->archive_matches(archive, ends());
  }

 private:
  std::size_t ends() const { return 2 * directions_.size(); }
  ExtremeChange extreme(std::size_t i) const { return {i / 2, i % 2 == 0, winner(i)}; }
  std::optional<Id> end(std::size_t i) const { return size(i) == 0 ? std::nullopt : std::optional<Id>(winner(i)); }

  double value(std::size_t direction, const Path& path, double t) const {
    double sum = 0;
    for (std::size_t d = 0; d < Dimension; ++d) sum += directions_[direction][d] * path.axis(static_cast<int>(d))(t);
    return sum;
  }

  std::vector<Direction> directions_;
};

}  // namespace kds::structures
