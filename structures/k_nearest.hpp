// Kinetic k nearest neighbours in the plane.
#pragma once

#include "certificates/plane_certificates.hpp"
#include "kds/audit.hpp"
#include "kds/framework/free_numbers.hpp"
#include "structures/nearest_change.hpp"
#include "structures/voronoi_cells.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace kds::structures {

/// Keeps for each of moving points the k others that are nearest to it, in order. It stands on Voronoi cells:
///
///     Kinetic<DelaunayRule<Path>> triangulation(points, now);
///     Kinetic<VoronoiCellsRule<Path>> cells(triangulation, now);
///     Kinetic<KNearestRule<Path>> nearest(cells, now, KNearestRule<Path>(3));
///
/// The i-th nearest to a point is a neighbour, in the triangulation, of the point itself or of one of its i - 1 nearest
/// [Dickerson92]. So for each point it is certified that its k nearest are in order, and that the neighbours of these,
/// but for the last one, and its own are not nearer than the last. For k = 1 NearestNeighboursRule
/// (nearest_neighbours.hpp) is simpler.
///
/// Cost, besides that of the triangulation: on average some 3 k certificates for a point (compact but for this factor),
/// of degree 2 for linear and 4 for quadratic paths; an event of its own looks at one point, O(k^2) signs and O(k)
/// certificates (responsive); a point whose neighbours have changed is looked at with all that have it among
/// their nearest, some k on average. Each event of its own is external, a change of a list. It reports whose list is
/// another (NearestChange), so that other rules may stand on it.
///
/// Of points that stay in one place only DelaunayRule::vertex counts, and the others have its list,
/// which is reported as that of the vertex. While all points
/// stay on one line nothing is known (DelaunayRule::flat).
template <class Path>
class KNearestRule : public StandsOn<VoronoiCellsRule<Path>> {
 public:
  static constexpr const char* name = "KNearest";
  using Element = Path;
  using Change = NearestChange;
  using Pen = Repair<Path, Change>;

  explicit KNearestRule(std::size_t count = 1) : count_(count) {}

  /// k.
  std::size_t count() const { return count_; }
  /// For another k, to be called in Kinetic::edit(): all points are looked at again.
  void set_count(std::size_t count, Pen& repair) {
    count_ = count;
    for (Id id = 0; id < lists_.size(); ++id) look(id, false, repair);
  }
  /// The nearest first; if several stay equally far they are in any order. There are fewer than k if there are not as
  /// many other points; none if there is no such point, or nothing is known. O(1).
  const std::vector<Id>& nearest(Id id) const {
    const Id vertex = this->inner().inner().vertex(id);
    return vertex < lists_.size() ? lists_[vertex].nearest : nowhere_;
  }

  // Slot: the number of a pair.
  std::optional<certificates::DistanceOrder<Path>> certificate(Slot slot, const MovingSet<Path>& x) const {
    if (slot >= pairs_.size() || pairs_[slot].nearer == nobody) return std::nullopt;
    const auto [from, to, nearer] = pairs_[slot];
    return certificates::DistanceOrder<Path>{x[from], x[nearer], x[from], x[to]};
  }
  std::array<Id, 3> members(Slot slot) const { return {pairs_[slot].from, pairs_[slot].nearer, pairs_[slot].to}; }

  Effect repair(Slot slot, Pen& repair) {
    return look(pairs_[slot].from, false, repair) ? Effect::external : Effect::internal;
  }
  Effect follow(std::span<const NeighboursChange> changes, Pen& repair) {
    looked_at_.clear();
    for (const NeighboursChange& change : changes) add_users(change.id);
    return look_at_them(false, repair) ? Effect::external : Effect::internal;
  }
  /// Nothing is left to do: the changes of its neighbours have been followed already.
  void change(Id id, Pen& repair) {
    looked_at_.clear();
    add_users(id);
    for (const Id neighbour : this->inner().neighbours(id)) add_users(neighbour);
    look_at_them(true, repair);
    repair.report({id});
    for (const Id user : lists_[id].users) repair.report({user});
  }

  std::vector<NearestChange> changes_from_nothing() const {
    std::vector<NearestChange> changes;
    for (Id id = 0; id < lists_.size(); ++id) {
      if (!lists_[id].nearest.empty()) changes.push_back({id});
    }
    return changes;
  }

  void audit(const MovingSet<Path>& elements, double now) const;

  template <class Archive>
  void archive(Archive& archive) {
    archive(count_, lists_, pairs_, free_);
  }

 private:
  /// One point compares another with the one that stands before it among its nearest, or with the last of these.
  struct Pair {
    Id from = nobody, to = nobody, nearer = nobody;  ///< nearer: nobody if there is nothing to compare

    friend bool operator==(const Pair&, const Pair&) = default;
  };
  struct List {
    std::vector<Id> nearest;
    std::vector<Slot> pairs;  ///< of this point, with all that it compares
    std::vector<Id> users;    ///< points that have it among their nearest

    template <class Archive>
    void archive(Archive& archive) {
      archive(nearest, pairs, users);
    }
  };

  /// All points whose lists depend on the neighbours of this one.
  void add_users(Id id) {
    if (id >= lists_.size()) lists_.resize(id + std::size_t{1});
    looked_at_.push_back(id);
    looked_at_.insert(looked_at_.end(), lists_[id].users.begin(), lists_[id].users.end());
  }
  bool look_at_them(bool all, Pen& repair) {
    std::sort(looked_at_.begin(), looked_at_.end());
    looked_at_.erase(std::unique(looked_at_.begin(), looked_at_.end()), looked_at_.end());
    bool other = false;
    for (const Id id : looked_at_) other = look(id, all, repair) || other;
    return other;
  }
  void add_neighbours(Id of, Id id, std::vector<Id>& known) const;
  std::vector<Id> find_nearest(Id id, const Pen& repair) const;
  std::vector<Pair> pairs_of(Id id, const std::vector<Id>& nearest) const;
  bool look(Id id, bool all, Pen& repair);

  std::size_t count_;
  std::vector<List> lists_;  ///< by vertex
  std::vector<Pair> pairs_;
  FreeNumbers free_;  ///< numbers of pairs that do not exist any more
  std::vector<Id> nowhere_, looked_at_;
};

// ---------------------------------------------------------------------------------------------------------------

/// Adds those that are neither the point itself nor known.
template <class Path>
void KNearestRule<Path>::add_neighbours(Id of, Id id, std::vector<Id>& known) const {
  for (const Id other : this->inner().neighbours(of)) {
    if (other != id && std::find(known.begin(), known.end(), other) == known.end()) known.push_back(other);
  }
}

template <class Path>
std::vector<Id> KNearestRule<Path>::find_nearest(Id id, const Pen& repair) const {
  std::vector<Id> ids;  // the nearest ones, and then all that may be the next
  if (count_ > 0 && this->inner().inner().vertex(id) == id) add_neighbours(id, id, ids);
  std::size_t found = 0;
  for (; found < std::min(count_, ids.size()); ++found) {
    if (found > 0) add_neighbours(ids[found - 1], id, ids);
    const auto next = ids.begin() + static_cast<std::ptrdiff_t>(found);
    std::iter_swap(
        next, std::min_element(next, ids.end(), [&](Id a, Id b) {
          return repair.sign(certificates::DistanceOrder<Path>{repair[id], repair[b], repair[id], repair[a]}) < 0;
        }));
  }
  ids.resize(found);
  return ids;
}

/// The comparisons that certify the list of a point.
template <class Path>
auto KNearestRule<Path>::pairs_of(Id id, const std::vector<Id>& nearest) const -> std::vector<Pair> {
  std::vector<Pair> pairs;
  if (nearest.empty()) return pairs;
  std::vector<Id> ids = nearest;
  add_neighbours(id, id, ids);
  for (std::size_t i = 0; i + 1 < nearest.size(); ++i) add_neighbours(nearest[i], id, ids);
  for (std::size_t i = 1; i < ids.size(); ++i) pairs.push_back({id, ids[i], ids[std::min(i, nearest.size()) - 1]});
  return pairs;
}

/// Brings the list of a point up to date, and marks the comparisons that have changed, or all of them. Returns whether
/// the list has changed.
template <class Path>
bool KNearestRule<Path>::look(Id id, bool all, Pen& repair) {
  const std::vector<Id> nearest = find_nearest(id, repair);
  for (const Id other : lists_[id].nearest) std::erase(lists_[other].users, id);
  for (const Id other : nearest) {
    if (other >= lists_.size()) lists_.resize(other + std::size_t{1});
    lists_[other].users.push_back(id);
  }
  List& list = lists_[id];
  std::vector<Pair> pairs = pairs_of(id, nearest);
  std::erase_if(list.pairs, [&](Slot slot) {
    const auto same = std::find(pairs.begin(), pairs.end(), pairs_[slot]);
    const bool goes = same == pairs.end();
    if (goes || all) repair.certify(slot);
    if (!goes) return pairs.erase(same), false;
    pairs_[slot] = {};
    free_.give_back(slot);
    return true;
  });
  for (const Pair& pair : pairs) {
    const Slot slot = free_.take(pairs_.size());
    if (slot == pairs_.size()) pairs_.emplace_back();
    pairs_[slot] = pair;
    list.pairs.push_back(slot);
    repair.certify(slot);
  }
  if (std::exchange(list.nearest, nearest) == nearest) return false;
  repair.report({id});
  return true;
}

template <class Path>
void KNearestRule<Path>::audit(const MovingSet<Path>& /*elements*/, double /*now*/) const {
  const auto require = [](bool right, Id id, const char* what) {
    if (!right) throw AuditFailure(std::string(name) + ": point " + std::to_string(id) + ": " + what);
  };
  std::size_t held = free_.size(), users = 0, listed = 0;
  for (Id id = 0; id < lists_.size(); ++id) {
    const List& list = lists_[id];
    std::vector<Pair> pairs = pairs_of(id, list.nearest);
    require(pairs.size() == list.pairs.size(), id, "compares more points than it has to, or fewer");
    for (const Slot slot : list.pairs) {
      require(std::find(pairs.begin(), pairs.end(), pairs_[slot]) != pairs.end(), id, "compares other points");
    }
    for (const Id other : list.nearest) {
      const std::vector<Id>& of = lists_[other].users;
      require(std::find(of.begin(), of.end(), id) != of.end(), other, "is not known to be listed");
    }
    held += list.pairs.size(), users += list.users.size(), listed += list.nearest.size();
    const std::size_t full = std::min(count_, this->inner().neighbours(id).size());
    require(this->inner().inner().vertex(id) != id || list.nearest.size() >= full, id, "has too short a list");
  }
  require(held == pairs_.size() && users == listed, nobody, "pairs or lists are held that no point has");
}

}  // namespace kds::structures
