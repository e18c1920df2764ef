// Certificates that prove that the hull of a triangulation in space goes round only once.
#pragma once

#include "structures/space_predicates.hpp"
#include "structures/tetrahedron_mesh.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <utility>
#include <vector>

namespace kds::structures {

/// Stores which way each facet of the hull faces, up or down; and for each edge of the outline, where an upper facet
/// meets a lower one, whether it leads forward or back. The hull goes round once if the outline is one closed polygon
/// of one stretch that leads forward and one that leads back: docs/triangulations-in-space.md has the proof.
///
/// Up is the direction (e^2, e, 1) with an infinitely small e > 0. So a facet faces the way of the z-coordinate of its
/// normal or, if that stays zero, of y, of x. The outline is seen along that direction, and forward is, likewise, the
/// way of x, of -z, of y. So each facet that has an area and each edge that has a length faces one way.
class HullFacings {
 public:
  using Facet = TetrahedronMesh::Facet;
  static constexpr Id infinite = TetrahedronMesh::infinite;

  /// Finds out how the facet of an infinite tetrahedron faces. O(1).
  template <class Path>
  void find(const TetrahedronMesh& mesh, std::uint32_t t, const SpacePredicates<Path>& is) {
    if (way_.size() < 4 * std::size_t{mesh.end_tetrahedron()}) way_.resize(4 * std::size_t{mesh.end_tetrahedron()}, 0);
    const Facet base = mesh.opposite(t, infinite);
    const auto [a, b, c] = mesh.facet(base);
    way_[base] = 0;
    for (const int level : {1, 2, 3}) {
      const int sign = sign_after(certificates::NormalDirection<Path>{is.x[a], is.x[b], is.x[c], 3 - level}, is.now);
      if (way_[base] == 0) way_[base] = static_cast<std::int8_t>(sign * level);
      if (sign != 0) return;
    }
  }
  /// Finds out how an edge of the hull leads, the facet of two infinite tetrahedra. Precondition: it is in the outline.
  template <class Path>
  void find_edge(const TetrahedronMesh& mesh, Facet f, const SpacePredicates<Path>& is) {
    const auto [from, to] = edge(mesh, f);
    for (const int level : {1, 2, 3}) {
      const auto& along = forward[static_cast<std::size_t>(level - 1)];
      const int sign = sign_after(certificates::DirectionOrder<Path, 3>{is.x[from], is.x[to], along}, is.now);
      way_[f] = way_[mesh.twin(f)] = static_cast<std::int8_t>(sign * level);
      if (sign != 0) return;
    }
  }

  /// The certificate that the facet of an infinite tetrahedron goes on to face the way it does.
  template <class Path>
  certificates::NormalDirection<Path> certificate(const TetrahedronMesh& mesh, std::uint32_t t,
                                                  const MovingSet<Path>& x) const {
    const Facet base = mesh.opposite(t, infinite);
    const auto [a, b, c] = mesh.facet(base);
    const bool up = way_[base] > 0;
    return {x[a], x[up ? b : c], x[up ? c : b], 3 - std::abs(way_[base])};
  }
  /// The certificate that an edge of the outline goes on to lead the way it does.
  template <class Path>
  certificates::DirectionOrder<Path, 3> edge_certificate(const TetrahedronMesh& mesh, Facet f,
                                                         const MovingSet<Path>& x) const {
    const auto [from, to] = edge(mesh, f);
    const bool leads_forward = way_[f] > 0;
    const auto level = static_cast<std::size_t>(std::abs(way_[f]));
    return {x[leads_forward ? from : to], x[leads_forward ? to : from], forward[level - 1]};
  }

  /// Whether the facet of an infinite tetrahedron faces up.
  bool up(const TetrahedronMesh& mesh, std::uint32_t t) const { return way_[mesh.opposite(t, infinite)] > 0; }
  /// Whether an edge of the hull, the facet of two infinite tetrahedra, is in the outline.
  bool in_outline(const TetrahedronMesh& mesh, Facet f) const { return up(mesh, f / 4) != up(mesh, mesh.twin(f) / 4); }
  /// What is stored of a facet or edge: the number of the coordinate that decides, with the sign of the way.
  int stored(Facet f) const { return way_[f]; }

  /// Decided by the stored directions. O(facets of the hull), no arithmetic.
  bool goes_round_once(const TetrahedronMesh& mesh) const {
    struct Edge {
      Id from, to;
      bool forward;
      bool operator<(const Edge& other) const { return from < other.from; }
    };
    std::vector<Edge> outline;
    for (const std::uint32_t t : mesh.star(infinite)) {
      if (!up(mesh, t)) continue;
      for (Facet f = 4 * t; f < 4 * t + 4; ++f) {
        if (mesh.apex(f) == infinite || !in_outline(mesh, f)) continue;
        const auto [from, to] = edge(mesh, f);
        outline.push_back({from, to, way_[f] > 0});
      }
    }
    if (outline.empty()) return false;
    std::sort(outline.begin(), outline.end());
    // One walk from edge to edge must come back to its beginning when it has seen all of them, and not before.
    std::size_t at = 0;
    int turns = 0;
    for (std::size_t step = 1; step <= outline.size(); ++step) {
      const auto next = std::lower_bound(outline.begin(), outline.end(), Edge{outline[at].to, 0, false});
      if (next == outline.end() || next->from != outline[at].to) return false;
      const auto to = static_cast<std::size_t>(next - outline.begin());
      turns += outline[at].forward != outline[to].forward;
      at = to;
      if ((at == 0) != (step == outline.size())) return false;
    }
    return turns == 2;
  }

  template <class Archive>
  void archive(Archive& archive) {
    archive(way_);
    if constexpr (Archive::loading) {
      for (const std::int8_t way : way_) archive.require(std::abs(way) <= 3, "a facet of a hull faces no way");
    }
  }

 private:
  static constexpr std::array<std::array<double, 3>, 3> forward{{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}};

  /// The ends of a hull edge, so that its upper facet is on the left if seen from above.
  std::pair<Id, Id> edge(const TetrahedronMesh& mesh, Facet f) const {
    if (!up(mesh, f / 4)) f = mesh.twin(f);
    std::array<Id, 3> corners = mesh.facet(f);
    std::rotate(corners.begin(), std::find(corners.begin(), corners.end(), infinite) + 1, corners.end());
    return {corners[1], corners[0]};
  }

  /// Of each facet: 0, or 1 to 3 for the coordinate that decides, negative for down or back.
  std::vector<std::int8_t> way_;
};

}  // namespace kds::structures
