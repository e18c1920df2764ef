// Kinetic all nearest neighbours in the plane.
#pragma once

#include "certificates/plane_certificates.hpp"
#include "kds/audit.hpp"
#include "structures/delaunay.hpp"
#include "structures/nearest_change.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace kds::structures {

/// Keeps for each point of the plane another that is nearest to it; or, as NearestNeighboursRule<Path,
/// PeriodicDelaunayRule<Path>>, of a plane that repeats itself, another of which a copy is. It stands on a Delaunay
/// triangulation, in which the two are joined by an edge [Shamos75]: so each point compares the edges that it has, and
/// a certificate says of each other edge that it is not shorter than the one chosen.
///
/// Cost, besides that of the triangulation: for a point of k edges, k - 1 certificates for an event of its own, and for
/// each of its edges that comes or goes (responsive on average: k is 6 then); fewer than 6 n certificates (compact); a
/// point is in as many as it and its neighbours have edges. Each event is external: a point has another neighbour; a
/// flip may be. It reports whose neighbour is another (NearestChange), so that other rules may stand on it: of all
/// points while some share a vertex, or where there are no more than three.
///
/// While three or more points all stay on one line nothing is known (DelaunayRule::flat).
template <class Path, class Delaunay = DelaunayRule<Path>>
class NearestNeighboursRule : public StandsOn<Delaunay> {
 public:
  static constexpr const char* name = "NearestNeighbours";
  using Element = Path;
  using Change = NearestChange;
  using Pen = Repair<Path, Change>;

  /// The nearest point, any if several are; none if there is no other, or none is known. O(1), but O(n) while points
  /// share a vertex, or where there is no triangle.
  std::optional<Id> nearest(Id id) const;

  std::optional<typename Delaunay::LengthOrder> certificate(Slot slot, const MovingSet<Path>& x) const {
    if (!listed(slot) || chosen_[from(slot)] == slot) return std::nullopt;
    return order(chosen_[from(slot)], slot, x);
  }
  std::vector<Id> members(Slot slot) const { return {from(slot), to(slot), to(chosen_[from(slot)])}; }

  Effect repair(Slot slot, Pen& repair) {
    chosen_[from(slot)] = slot;
    for (const Slot other : leaving_[from(slot)]) repair.certify(other);
    repair.report({from(slot)});
    return Effect::external;
  }
  Effect follow(std::span<const EdgeChange> changes, Pen& repair);

  void insert(Id id, Pen& repair) {
    make_room(id);
    present_[id] = 1;
    tell_of(id, repair);
  }
  void remove(Id id, Pen& repair) {
    present_[id] = 0;
    tell_of(id, repair);
  }

  std::vector<NearestChange> changes_from_nothing() const {
    std::vector<NearestChange> changes;
    for (Id id = 0; id < present_.size(); ++id) {
      if (present_[id]) changes.push_back({id});
    }
    return changes;
  }

  void audit(const MovingSet<Path>& elements, double now) const;

  template <class Archive>
  void archive(Archive& archive) {
    archive(ends_, leaving_, chosen_, present_, by_edges_);
  }

 private:
  // A slot is an edge as it leaves one of its ends: twice its number, and 1 for the higher id.
  static constexpr Slot none = std::numeric_limits<Slot>::max();

  bool listed(Slot slot) const { return slot / 2 < ends_.size() && ends_[slot / 2][0] != nobody; }
  Id from(Slot slot) const { return ends_[slot / 2][slot % 2]; }
  Id to(Slot slot) const { return ends_[slot / 2][1 - slot % 2]; }
  typename Delaunay::LengthOrder order(Slot nearer, Slot farther, const MovingSet<Path>& x) const {
    return this->inner().length_order(nearer / 2, farther / 2, x);
  }
  /// False where an edge leads from a point to its own copy.
  bool joins_two(TriangulationEdges::Number edge) const {
    const auto& edges = this->inner().edges();
    return edges.contains(edge) && edges.ends(edge)[0] != edges.ends(edge)[1];
  }
  void make_room(Id id) {
    if (id < chosen_.size()) return;
    leaving_.resize(id + std::size_t{1});
    chosen_.resize(id + std::size_t{1}, none);
    present_.resize(id + std::size_t{1}, 0);
  }
  void tell_of(Id id, Pen& repair);
  void let_go(TriangulationEdges::Number edge, Pen& repair);
  void take_up(TriangulationEdges::Number edge);

  std::vector<std::array<Id, 2>> ends_;     ///< by edge, the lower id first; nobody if it is not there
  std::vector<std::vector<Slot>> leaving_;  ///< by point
  std::vector<Slot> chosen_;                ///< by point: the shortest of these
  std::vector<std::uint8_t> present_;       ///< by point
  bool by_edges_ = false;                   ///< whether the edges give all nearest neighbours
  std::vector<Id> changed_;                 ///< points whose edges have changed
};

// ---------------------------------------------------------------------------------------------------------------

template <class Path, class Delaunay>
std::optional<Id> NearestNeighboursRule<Path, Delaunay>::nearest(Id id) const {
  if (id >= present_.size() || !present_[id]) return std::nullopt;
  const Delaunay& delaunay = this->inner();
  if (delaunay.has_shared_vertices()) {
    if (delaunay.vertex(id) != id) return delaunay.vertex(id);
    for (Id other = 0; other < present_.size(); ++other) {
      if (other != id && present_[other] && delaunay.vertex(other) == id) return other;
    }
  }
  if (chosen_[id] != none) return to(chosen_[id]);
  std::optional<Id> only;
  for (Id other = 0; other < present_.size(); ++other) {
    if (other == id || !present_[other]) continue;
    if (only) return std::nullopt;
    only = other;
  }
  return only;
}

/// Reports a point that has come, goes, or has a new motion; and all others where not edges alone decide whose
/// neighbour it is or has been.
template <class Path, class Delaunay>
void NearestNeighboursRule<Path, Delaunay>::tell_of(Id id, Pen& repair) {
  repair.report({id});
  const bool before = std::exchange(by_edges_, repair.elements().size() > 3 && !this->inner().has_shared_vertices());
  if (before && by_edges_) return;
  for (Id other = 0; other < present_.size(); ++other) {
    if (present_[other]) repair.report({other});
  }
}

template <class Path, class Delaunay>
void NearestNeighboursRule<Path, Delaunay>::let_go(TriangulationEdges::Number edge, Pen& repair) {
  for (const Slot slot : {2 * edge, 2 * edge + 1}) {
    if (!listed(slot)) return;
    const Id id = from(slot);
    std::erase(leaving_[id], slot);
    if (chosen_[id] == slot) chosen_[id] = none;
    changed_.push_back(id);
    repair.certify(slot);
  }
  ends_[edge] = {nobody, nobody};
}

template <class Path, class Delaunay>
void NearestNeighboursRule<Path, Delaunay>::take_up(TriangulationEdges::Number edge) {
  if (edge >= ends_.size()) ends_.resize(edge + std::size_t{1}, {nobody, nobody});
  if (listed(2 * edge)) return;
  ends_[edge] = this->inner().edges().ends(edge);
  make_room(ends_[edge][1]);
  for (const Slot slot : {2 * edge, 2 * edge + 1}) {
    leaving_[from(slot)].push_back(slot);
    changed_.push_back(from(slot));
  }
}

template <class Path, class Delaunay>
Effect NearestNeighboursRule<Path, Delaunay>::follow(std::span<const EdgeChange> changes, Pen& repair) {
  changed_.clear();
  for (const EdgeChange& change : changes) let_go(change.edge, repair);
  for (const EdgeChange& change : changes) {
    if (joins_two(change.edge)) take_up(change.edge);
  }
  std::sort(changed_.begin(), changed_.end());
  changed_.erase(std::unique(changed_.begin(), changed_.end()), changed_.end());
  for (const Id id : changed_) {
    Slot& chosen = chosen_[id];
    const Slot before = chosen;
    for (const Slot slot : leaving_[id]) {
      if (chosen == none || repair.sign(order(chosen, slot, repair.elements())) < 0) chosen = slot;
      repair.certify(slot);
    }
    if (before == none || chosen != before) repair.report({id});
  }
  return changed_.empty() ? Effect::internal : Effect::external;
}

template <class Path, class Delaunay>
void NearestNeighboursRule<Path, Delaunay>::audit(const MovingSet<Path>& /*elements*/, double /*now*/) const {
  const auto require = [](bool right, Id id, const char* what) {
    if (!right) throw AuditFailure(std::string(name) + ": point " + std::to_string(id) + ": " + what);
  };
  const auto& edges = this->inner().edges();
  for (TriangulationEdges::Number edge = 0; edge < std::max<std::size_t>(edges.end(), ends_.size()); ++edge) {
    require(joins_two(edge) == listed(2 * edge), 0, "an edge of the triangulation is missing or gone");
    if (listed(2 * edge)) require(ends_[edge] == edges.ends(edge), ends_[edge][0], "an edge has other ends");
  }
  for (Id id = 0; id < chosen_.size(); ++id) {
    require((chosen_[id] == none) == leaving_[id].empty(), id, "has no neighbour");
    for (const Slot slot : leaving_[id]) require(listed(slot) && from(slot) == id, id, "has the edge of another");
    require(chosen_[id] == none || (listed(chosen_[id]) && from(chosen_[id]) == id), id, "has another's neighbour");
  }
}

}  // namespace kds::structures
