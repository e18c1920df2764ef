// Extents of a moving point set in given directions: bounding boxes and k-DOPs.
#pragma once

#include "certificates/direction_order.hpp"
#include "kds/audit.hpp"
#include "kds/framework/kinetic.hpp"
#include "structures/bracket.hpp"

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

/// Maintains, for each of m directions, the foremost and the hindmost of moving points: the extents that bound the set.
///
/// A binary tournament for each end of each direction. When a match's certificate fails it is played again, and so are
/// those above it as long as the winner changes. Papers: [Basch99] section 3.2; for k-DOPs that move [Coming08].
///
/// Cost for m directions: a change O(m log n), an event O(log n) certificates (responsive); an element plays in at most
/// 2 m log2 n matches (local); 2 m (n - 1) certificates (compact). External events are changes of an extreme point.
///
/// Ties: among points that stay equally far the one with the lowest id is the extreme one.
template <class Path, std::size_t Dimension>
class ExtentsRule {
 public:
  using Element = Path;
  using Direction = std::array<double, Dimension>;
  static constexpr const char* name = "Extents";

  /// Throws std::invalid_argument for no direction, or one that is zero or not finite.
  explicit ExtentsRule(std::vector<Direction> directions) : directions_(std::move(directions)) {
    if (directions_.empty()) throw std::invalid_argument("Extents: there must be a direction");
    for (const Direction& direction : directions_) {
      bool zero = true;
      for (const double x : direction) {
        if (!std::isfinite(x)) throw std::invalid_argument("Extents: a direction must be finite");
        zero = zero && x == 0;
      }
      if (zero) throw std::invalid_argument("Extents: a direction must not be zero");
    }
    brackets_.resize(2 * directions_.size());
  }

  const std::vector<Direction>& directions() const { return directions_; }

  /// The points that are farthest and least far in a direction, given by its number from 0, at t+; none if there are no
  /// points. Precondition: direction < directions().size().
  std::optional<Id> foremost(std::size_t direction) const { return winner(2 * direction); }
  std::optional<Id> hindmost(std::size_t direction) const { return winner(2 * direction + 1); }

  /// From least to greatest value of direction . point at t, rounded. Preconditions: there are points, and t is the
  /// clock or at least before the next event.
  std::array<double, 2> extent(std::size_t direction, const MovingSet<Path>& points, double t) const {
    return {value(direction, points[*hindmost(direction)], t), value(direction, points[*foremost(direction)], t)};
  }

  // A slot is a match of one of the brackets: match * 2 m + bracket.
  std::optional<certificates::DirectionOrder<Path, Dimension>> certificate(Slot slot, const MovingSet<Path>& x) const {
    const auto [match, i] = place(slot);
    if (!brackets_[i].two_play(match)) return std::nullopt;
    return in_order(x[brackets_[i].loser(match)], x[brackets_[i].winner(match)], i);
  }
  std::array<Id, 2> members(Slot slot) const {
    const auto [match, i] = place(slot);
    return {brackets_[i].loser(match), brackets_[i].winner(match)};
  }

  Effect repair(Slot slot, Repair<Path>& repair) {
    const auto [match, i] = place(slot);
    const Id before = brackets_[i].winner();
    brackets_[i].climb(match, nobody, beats(i, repair), marks(i, repair));
    return brackets_[i].winner() != before ? Effect::external : Effect::internal;
  }
  void insert(Id id, Repair<Path>& repair) { set(id, true, repair); }
  void remove(Id id, Repair<Path>& repair) { set(id, false, repair); }
  void change(Id id, Repair<Path>& repair) { set(id, true, repair); }

  void audit(const MovingSet<Path>& x, double /*now*/) const {
    for (const Bracket& bracket : brackets_) {
      bracket.audit(name);
      for (Id id = 0; id < x.end_id(); ++id) {
        if (bracket.contains(id) != x.contains(id)) throw AuditFailure("Extents: an entrant is missing or gone");
      }
    }
  }

  template <class Archive>
  void archive(Archive& archive) {
    archive(directions_, brackets_);
  }

 private:
  std::pair<std::size_t, std::size_t> place(Slot slot) const {
    return {slot / brackets_.size(), slot % brackets_.size()};
  }

  std::optional<Id> winner(std::size_t bracket) const {
    const Id id = brackets_[bracket].winner();
    return id == nobody ? std::nullopt : std::optional(id);
  }

  /// "The loser is not before the winner": even brackets ask for the foremost, odd ones for the hindmost.
  certificates::DirectionOrder<Path, Dimension> in_order(const Path& loser, const Path& winner, std::size_t i) const {
    const Direction& direction = directions_[i / 2];
    if (i % 2 == 0) return {loser, winner, direction};
    return {winner, loser, direction};
  }
  auto beats(std::size_t i, const Repair<Path>& repair) const {
    return [this, i, &repair](Id left, Id right) { return repair.sign(in_order(repair[right], repair[left], i)) >= 0; };
  }
  auto marks(std::size_t i, Repair<Path>& repair) const {
    return [this, i, &repair](std::size_t match) { repair.certify(static_cast<Slot>(match * brackets_.size() + i)); };
  }

  void set(Id id, bool present, Repair<Path>& repair) {
    for (std::size_t i = 0; i < brackets_.size(); ++i) {
      brackets_[i].reserve(id + std::size_t{1}, beats(i, repair), marks(i, repair));
      brackets_[i].set(id, present, beats(i, repair), marks(i, repair));
    }
  }

  double value(std::size_t direction, const Path& path, double t) const {
    double sum = 0;
    for (std::size_t d = 0; d < Dimension; ++d) sum += directions_[direction][d] * path.axis(static_cast<int>(d))(t);
    return sum;
  }

  std::vector<Direction> directions_;
  std::vector<Bracket> brackets_;
};

}  // namespace kds::structures
