// Kinetic closest pair in the plane.
#pragma once

#include "certificates/plane_certificates.hpp"
#include "kds/audit.hpp"
#include "kds/framework/kinetic.hpp"
#include "structures/bracket.hpp"
#include "structures/delaunay.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

namespace kds::structures {

/// Keeps the two of moving points that are closest to each other.
///
/// They are joined by an edge of the Delaunay triangulation [Shamos75], so a tournament of its edges by their lengths
/// finds them: half of the certificates are those of the triangulation, half say that the loser of a match is not
/// shorter than its winner. Papers: [Guibas91]; [Basch97], which differs: it finds candidates by sorted lists and cones
/// of 60 degrees, with certificates of degree 1 and 2 in place of 4 and 2.
///
/// Cost: an event O(log n) certificates, five edges' matches at most (responsive); 5 n certificates of the
/// triangulation and 3 n matches (compact); locality is that of the triangulation, times log n. External events are
/// changes of the pair.
///
/// Points that stay in one place together are a closest pair. While three or more points all stay on one line nothing
/// is known (DelaunayRule::flat()).
template <class Path>
class ClosestPairRule {
 public:
  using Element = Path;
  static constexpr const char* name = "ClosestPair";

  /// The pair, the lower id first; none if there are fewer than two points, or if there are three or more that all stay
  /// on one line. If several pairs stay equally close it is any of them. O(1), but O(n) while points share a vertex or
  /// the triangulation is flat().
  std::optional<std::array<Id, 2>> pair() const;
  const DelaunayRule<Path>& delaunay() const { return delaunay_; }

  using Distance = certificates::DistanceOrder<Path>;
  using Triangulated = typename DelaunayRule<Path>::Choice;
  using Choice = std::variant<std::monostate, Distance, Triangulated>;

  // Even slots are those of the triangulation, odd ones the matches.
  Choice certificate(Slot slot, const MovingSet<Path>& x) const {
    if (slot % 2 == 0) return delaunay_.certificate(slot / 2, x);
    if (!bracket_.two_play(slot / 2)) return {};
    return shorter(bracket_.winner(slot / 2), bracket_.loser(slot / 2), x);
  }
  std::vector<Id> members(Slot slot) const {
    if (slot % 2 == 0) return delaunay_.members(slot / 2);
    const auto [a, b] = ends(bracket_.winner(slot / 2));
    const auto [c, d] = ends(bracket_.loser(slot / 2));
    std::vector<Id> ids{a, b, c, d};
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    return ids;
  }

  Effect repair(Slot slot, Repair<Path>& repair) {
    const auto before = pair();
    if (slot % 2 == 1) {
      bracket_.climb(slot / 2, nobody, beats(repair.elements(), repair), marks(repair));
    } else {
      within(repair, [&] { delaunay_.repair(slot / 2, repair); });
    }
    return pair() != before ? Effect::external : Effect::internal;
  }
  void build(Repair<Path>& repair) {
    present_.resize(repair.elements().end_id(), 0);
    for (const Id id : repair.elements().ids()) present_[id] = 1;
    within(repair, [&] { delaunay_.build(repair); });
  }
  void insert(Id id, Repair<Path>& repair) {
    if (id >= present_.size()) present_.resize(id + std::size_t{1}, 0);
    present_[id] = 1;
    within(repair, [&] { delaunay_.insert(id, repair); });
  }
  void remove(Id id, Repair<Path>& repair) {
    present_[id] = 0;
    within(repair, [&] { delaunay_.remove(id, repair); });
  }
  bool keeps(Id id, const Path& next, Repair<Path>& repair) { return delaunay_.keeps(id, next, repair); }
  void change(Id id, Repair<Path>& repair) {
    within(repair, [&] { delaunay_.change(id, repair); });
  }

  void audit(const MovingSet<Path>& x, double now) const {
    delaunay_.audit(x, now);
    bracket_.audit(name);
    const Edge end = 3 * delaunay_.mesh().end_triangle();
    for (Edge h = 0; h < end; ++h) {
      if (is_entrant(h) != bracket_.contains(h)) throw AuditFailure("ClosestPair: an edge is missing or gone");
    }
  }

  template <class Archive>
  void archive(Archive& archive) {
    archive(delaunay_, bracket_, present_);
  }

 private:
  using Edge = TriangleMesh::Edge;

  /// Each edge takes part as the lesser of its half-edges.
  bool is_entrant(Edge h) const {
    const TriangleMesh& mesh = delaunay_.mesh();
    return h / 3 < mesh.end_triangle() && mesh.in_use(h / 3) && h < mesh.twin(h) && mesh.origin(h) != nobody &&
           mesh.target(h) != nobody;
  }
  std::array<Id, 2> ends(Edge h) const {
    return {std::min(delaunay_.mesh().origin(h), delaunay_.mesh().target(h)),
            std::max(delaunay_.mesh().origin(h), delaunay_.mesh().target(h))};
  }
  Distance shorter(Edge h, Edge other, const MovingSet<Path>& x) const {
    const auto [a, b] = ends(h);
    const auto [c, d] = ends(other);
    return {x[a], x[b], x[c], x[d]};
  }
  auto beats(const MovingSet<Path>& x, const Repair<Path>& repair) const {
    return [this, &x, &repair](Edge left, Edge right) { return repair.sign(shorter(left, right, x)) >= 0; };
  }
  auto marks(Repair<Path>& repair) const {
    return [&repair](std::size_t match) { repair.certify(static_cast<Slot>(2 * match + 1)); };
  }

  /// Calls the triangulation, then plays the matches of the edges that it has marked again.
  template <class Do>
  void within(Repair<Path>& repair, Do&& work) {
    repair.nested(0, 2, [&] { return work(), 0; });
    std::vector<Edge> edges;
    for (std::size_t i = 0; i < repair.marked().size(); ++i) {
      const Slot slot = repair.marked()[i] / 2;
      if (repair.marked()[i] % 2 == 0 && slot % 4 != 3) edges.push_back(slot / 4 * 3 + slot % 4);
    }
    bracket_.update(
        edges, [&](Edge h) { return is_entrant(h); }, beats(repair.elements(), repair), marks(repair));
  }

  DelaunayRule<Path> delaunay_;
  Bracket bracket_;
  std::vector<std::uint8_t> present_;
};

// ---------------------------------------------------------------------------------------------------------------

template <class Path>
std::optional<std::array<Id, 2>> ClosestPairRule<Path>::pair() const {
  if (delaunay_.has_shared_vertices()) {
    for (Id id = 0; id < present_.size(); ++id) {
      const Id vertex = present_[id] ? delaunay_.vertex(id) : id;
      if (vertex != id) return std::array{std::min(id, vertex), std::max(id, vertex)};
    }
  }
  if (bracket_.winner() != Bracket::nobody) return ends(bracket_.winner());
  std::vector<Id> ids;
  for (Id id = 0; id < present_.size() && ids.size() < 3; ++id) {
    if (present_[id]) ids.push_back(id);
  }
  if (ids.size() != 2) return std::nullopt;
  return std::array{ids[0], ids[1]};
}

}  // namespace kds::structures
