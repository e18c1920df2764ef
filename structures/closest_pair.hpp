// Kinetic closest pair in the plane.
#pragma once

#include "certificates/plane_certificates.hpp"
#include "structures/champion.hpp"
#include "structures/delaunay.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace kds::structures {

/// Keeps the two of moving points that are closest to each other. It stands on a Delaunay triangulation of them:
///
///     Kinetic<DelaunayRule<Path>> triangulation(points, now);
///     Kinetic<ClosestPairRule<Path>> closest(triangulation, now);
///
/// or on a periodic one, ClosestPairRule<Path, PeriodicDelaunayRule<Path>>, in which two points are as far from each
/// other as their copies are. The two are joined by an edge of that [Shamos75], so a tournament of its edges by their
/// lengths finds them, whose certificates say that the loser of a match is not shorter than its winner. Papers:
/// [Guibas91]; [Basch97], which differs: it finds candidates by sorted lists and cones of 60 degrees, with certificates
/// of degree 1 and 2 in place of 4 and 2.
///
/// Cost, besides that of the triangulation: O(log n) certificates for an event and for a flip, which is a change of two
/// edges (responsive); 3 n matches (compact); locality is that of the triangulation, times log n. External events are
/// changes of the pair, which it reports (AnswerChange), so that other rules may stand on it.
///
/// Points that stay in one place together are a closest pair. While three or more points all stay on one line nothing
/// is known (DelaunayRule::flat()).
template <class Path, class Delaunay = DelaunayRule<Path>>
class ClosestPairRule : public ChampionRule<ClosestPairRule<Path, Delaunay>, Delaunay, typename Delaunay::LengthOrder> {
  using Base = ChampionRule<ClosestPairRule<Path, Delaunay>, Delaunay, typename Delaunay::LengthOrder>;

 public:
  static constexpr const char* name = "ClosestPair";
  using Pair = std::optional<std::array<Id, 2>>;
  using Edge = TriangulationEdges::Number;

  /// The pair, the lower id first; none if there are fewer than two points, or if there are three or more that all stay
  /// on one line. If several pairs stay equally close it is any of them.
  const Pair& pair() const { return this->answer(); }
  const Delaunay& delaunay() const { return this->inner(); }

  // What ChampionRule asks for.
  Edge candidate(const EdgeChange& change) const { return change.edge; }
  /// An edge from a point to its own copy does not.
  bool takes_part(Edge edge) const { return delaunay().edges().contains(edge) && ids(edge)[0] != ids(edge)[1]; }
  std::array<Id, 2> ids(Edge edge) const { return delaunay().edges().ends(edge); }
  typename Delaunay::LengthOrder better(Edge edge, Edge other, const MovingSet<Path>& x) const {
    return delaunay().length_order(edge, other, x);
  }
  /// O(1), but O(n) while points share a vertex or the triangulation is flat().
  Pair find_answer() const;

  /// Called for a point with a new motion too, after remove().
  void insert(Id id, typename Base::Pen& repair) {
    if (id >= present_.size()) present_.resize(id + std::size_t{1}, 0);
    present_[id] = 1;
    this->renew_answer(repair);
  }
  void remove(Id id, typename Base::Pen& repair) {
    present_[id] = 0;
    this->renew_answer(repair);
  }

  template <class Archive>
  void archive(Archive& archive) {
    Base::archive(archive);
    archive(present_);
  }

 private:
  std::vector<std::uint8_t> present_;
};

// ---------------------------------------------------------------------------------------------------------------

template <class Path, class Delaunay>
auto ClosestPairRule<Path, Delaunay>::find_answer() const -> Pair {
  if (delaunay().has_shared_vertices()) {
    for (Id id = 0; id < present_.size(); ++id) {
      const Id vertex = present_[id] ? delaunay().vertex(id) : id;
      if (vertex != id) return std::array{std::min(id, vertex), std::max(id, vertex)};
    }
  }
  if (this->champion() != Base::none) return ids(this->champion());
  std::vector<Id> ids;
  for (Id id = 0; id < present_.size() && ids.size() < 3; ++id) {
    if (present_[id]) ids.push_back(id);
  }
  if (ids.size() != 2) return std::nullopt;
  return std::array{ids[0], ids[1]};
}

}  // namespace kds::structures
