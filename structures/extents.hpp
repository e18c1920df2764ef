// Extents of a moving point set in given directions: bounding boxes and k-DOPs.
#pragma once

#include "certificates/direction_order.hpp"
#include "kds/audit.hpp"
#include "kds/kinetic.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace kds::structures {

/// The k / 2 directions of the usual k-DOPs in space: k = 6 the axes, 14 with the corners of a cube, 18 with the middles
/// of its edges, 26 with both. Not of unit length, so that they are exact. Paper: [Klosowski98].
inline std::vector<std::array<double, 3>> kdop_directions(int k) {
  if (k != 6 && k != 14 && k != 18 && k != 26) throw std::invalid_argument("kdop_directions: k must be 6, 14, 18 or 26");
  std::vector<std::array<double, 3>> directions{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  if (k == 14 || k == 26) directions.insert(directions.end(), {{1, 1, 1}, {1, 1, -1}, {1, -1, 1}, {1, -1, -1}});
  if (k == 18 || k == 26) {
    directions.insert(directions.end(), {{1, 1, 0}, {1, -1, 0}, {1, 0, 1}, {1, 0, -1}, {0, 1, 1}, {0, 1, -1}});
  }
  return directions;
}

/// Keeps, for each of m directions, the foremost and the hindmost of moving points: the extents that bound the set.
///
/// A binary tournament for each end of each direction, over the same entrants. When a match's certificate fails it is
/// played again, and so are those above it as long as the winner is another. Papers: [Basch99] section 3.2; for k-DOPs
/// that move [Coming06].
///
/// Cost for m directions: a change O(m log n), an event O(log n) certificates (responsive); an element plays in at most
/// 2 m log2 n matches (local); 2 m (n - 1) certificates (compact). External events are changes of an extreme point.
///
/// Ties: among points equally far for good the lowest id is the extreme one.
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
  }

  const std::vector<Direction>& directions() const { return directions_; }

  /// The points that are farthest and least far in a direction at t+; none if there are no points.
  std::optional<Id> foremost(std::size_t direction) const { return winner(2 * direction); }
  std::optional<Id> hindmost(std::size_t direction) const { return winner(2 * direction + 1); }

  /// From least to greatest value of direction . point at t, rounded. Precondition: there are points.
  std::array<double, 2> extent(std::size_t direction, const MovingSet<Path>& points, double t) const {
    return {value(direction, points[*hindmost(direction)], t), value(direction, points[*foremost(direction)], t)};
  }

  // A slot is a match of a bracket ("lane"): matches 1 .. capacity - 1 in heap order, entrant i at capacity + i.
  std::optional<certificates::DirectionOrder<Path, Dimension>> certificate(Slot slot, const MovingSet<Path>& x) const {
    const auto [node, lane] = match(slot);
    if (node == 0 || !is_played(node, lane)) return std::nullopt;
    return in_order(x[loser(node, lane)], x[winner_of(node, lane)], lane);
  }
  std::array<Id, 2> members(Slot slot) const {
    const auto [node, lane] = match(slot);
    return {loser(node, lane), winner_of(node, lane)};
  }

  Effect repair(Slot slot, Repair<Path>& repair) {
    const auto [node, lane] = match(slot);
    const Id before = winner_of(1, lane);
    climb(node, lane, nobody, repair);
    return winner_of(1, lane) != before ? Effect::external : Effect::internal;
  }

  void insert(Id id, Repair<Path>& repair) {
    if (id >= capacity_) grow(repair);
    entrants_[id] = id;
    change(id, repair);
  }
  void remove(Id id, Repair<Path>& repair) {
    entrants_[id] = nobody;
    change(id, repair);
  }
  void change(Id id, Repair<Path>& repair) {
    for (std::size_t lane = 0; lane < lanes(); ++lane) climb((capacity_ + id) / 2, lane, id, repair);
  }
  void build(Repair<Path>& repair) {
    for (const Id id : repair.elements().ids()) {
      if (id >= entrants_.size()) entrants_.resize(id + std::size_t{1}, nobody);
      entrants_[id] = id;
    }
    if (!entrants_.empty()) grow(repair);
  }

  void audit(const MovingSet<Path>& x, double now) const {
    const auto fail = [](std::size_t node, std::size_t lane, const char* what) {
      throw AuditFailure("Extents: match " + std::to_string(node) + " of bracket " + std::to_string(lane) + ": " + what);
    };
    for (Id id = 0; id < entrants_.size(); ++id) {
      if ((entrants_[id] != nobody) != x.contains(id)) fail(capacity_ + id, 0, "an entrant is missing or gone");
    }
    for (std::size_t node = 1; node < capacity_; ++node) {
      for (std::size_t lane = 0; lane < lanes(); ++lane) {
        const Id left = winner_of(2 * node, lane), right = winner_of(2 * node + 1, lane), won = winner_of(node, lane);
        if (won != left && won != right) fail(node, lane, "the winner did not play");
        if (won == nobody && left != right) fail(node, lane, "the only entrant has not won");
      }
    }
    static_cast<void>(now);
  }

  template <class Archive>
  void archive(Archive& archive) {
    archive(directions_, entrants_, winner_, capacity_);
  }

 private:
  std::size_t lanes() const { return 2 * directions_.size(); }
  std::pair<std::size_t, std::size_t> match(Slot slot) const { return {slot / lanes(), slot % lanes()}; }
  Slot slot(std::size_t node, std::size_t lane) const { return static_cast<Slot>(node * lanes() + lane); }

  std::optional<Id> winner(std::size_t lane) const {
    if (capacity_ == 0 || winner_of(1, lane) == nobody) return std::nullopt;
    return winner_of(1, lane);
  }

  Id winner_of(std::size_t node, std::size_t lane) const {
    return node < capacity_ ? winner_[node * lanes() + lane] : entrants_[node - capacity_];
  }
  Id loser(std::size_t node, std::size_t lane) const {
    const Id left = winner_of(2 * node, lane);
    return winner_of(node, lane) == left ? winner_of(2 * node + 1, lane) : left;
  }
  bool is_played(std::size_t node, std::size_t lane) const {
    return winner_of(2 * node, lane) != nobody && winner_of(2 * node + 1, lane) != nobody;
  }

  /// "The loser is not before the winner": even lanes ask for the foremost, odd ones for the hindmost.
  certificates::DirectionOrder<Path, Dimension> in_order(const Path& loser, const Path& winner, std::size_t lane) const {
    const Direction& direction = directions_[lane / 2];
    if (lane % 2 == 0) return {loser, winner, direction};
    return {winner, loser, direction};
  }

  void play(std::size_t node, std::size_t lane, Repair<Path>& repair) {
    const Id left = winner_of(2 * node, lane);
    const Id right = winner_of(2 * node + 1, lane);
    Id& won = winner_[node * lanes() + lane];
    if (left == nobody || right == nobody) {
      won = left == nobody ? right : left;
    } else {
      won = repair.sign(in_order(repair[right], repair[left], lane)) >= 0 ? left : right;
    }
    repair.certify(slot(node, lane));
  }

  /// Plays a match, and those above it while what is below them is another: the winner, or the motion of `changed`.
  void climb(std::size_t node, std::size_t lane, Id changed, Repair<Path>& repair) {
    for (; node >= 1; node /= 2) {
      const Id before = winner_of(node, lane);
      play(node, lane, repair);
      if (winner_of(node, lane) == before && before != changed && before != nobody) return;
    }
  }

  void grow(Repair<Path>& repair) {
    if (capacity_ == 0) capacity_ = 2;
    while (capacity_ < repair.elements().end_id()) capacity_ *= 2;
    entrants_.resize(capacity_, nobody);
    winner_.assign(capacity_ * lanes(), nobody);
    for (std::size_t node = capacity_ - 1; node >= 1; --node) {
      for (std::size_t lane = 0; lane < lanes(); ++lane) play(node, lane, repair);
    }
  }

  double value(std::size_t direction, const Path& path, double t) const {
    double sum = 0;
    for (std::size_t d = 0; d < Dimension; ++d) sum += directions_[direction][d] * path.axis(static_cast<int>(d))(t);
    return sum;
  }

  std::vector<Direction> directions_;
  std::vector<Id> entrants_;  ///< of an id: itself, or nobody
  std::vector<Id> winner_;    ///< of a match in a lane
  std::size_t capacity_ = 0;
};

}  // namespace kds::structures
