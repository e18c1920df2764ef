// The edges of a triangulation under numbers that they keep, and which of them come and go.
#pragma once

#include "kds/audit.hpp"
#include "kds/framework/free_numbers.hpp"
#include "structures/triangle_mesh.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace kds::structures {

/// A change of an edge of a triangulation. Edges are identified by their numbers: after points have passed through each
/// other two edges may join the same two points until the events of that time are over.
struct EdgeChange {
  enum class What : std::uint8_t { came, went, moved };  ///< moved: an end has got a new motion
  What what;
  std::uint32_t edge;      ///< number; that of one that went is given to others
  std::array<Id, 2> ends;  ///< the lower id first

  friend bool operator==(const EdgeChange&, const EdgeChange&) = default;
};

/// A triangle of a triangulation that has come, gone, or got other corners; or one of whose corners has got a new
/// motion. Triangles with the vertex at infinity are among them.
struct TriangleChange {
  std::uint32_t triangle;

  friend bool operator==(const TriangleChange&, const TriangleChange&) = default;
};

/// Numbers the edges between points: in a flip one goes and one comes, and the other four of its two triangles, whose
/// half-edges may be others, keep their numbers. Edges to infinity have none.
///
/// Cost: O(k log k) for k triangles that have changed; memory, a number a half-edge, and of each edge its ends
/// and a half-edge.
class TriangulationEdges {
 public:
  using Number = std::uint32_t;
  static constexpr Number none = std::numeric_limits<Number>::max();

  /// Numbers are below this.
  Number end() const { return static_cast<Number>(ends_.size()); }
  bool contains(Number edge) const { return edge < end() && ends_[edge][0] != nobody; }
  /// The lower id first. Precondition: contains(edge).
  const std::array<Id, 2>& ends(Number edge) const { return ends_[edge]; }
  /// The number of the edge of a half-edge; none if it leads to infinity.
  Number of(TriangleMesh::Edge half_edge) const { return of_[half_edge]; }
  /// One of an edge's two half-edges. Precondition: contains(edge).
  TriangleMesh::Edge half_edge(Number edge) const { return half_edge_[edge]; }

  /// Looks at the triangles whose corners or neighbours have changed, and calls report(EdgeChange) for each edge that
  /// went, then for each that came. A triangle may be named twice, and need not be in use any more.
  template <class Report>
  void update(const TriangleMesh& mesh, std::span<const std::uint32_t> touched, const Report& report) {
    let_go(mesh, touched);
    keep_outer(mesh, touched);
    find_gone();
    for (const TriangleMesh::Edge h : inner_) {
      const Number edge = of_[h] == none ? find_again(ends_in(mesh, h)) : none;
      if (edge == none) continue;
      of_[h] = of_[mesh.twin(h)] = edge;
      half_edge_[edge] = h;
    }
    for (const Number edge : gone_) {
      if (fate_[edge] == Fate::stays) continue;
      report(EdgeChange{EdgeChange::What::went, edge, ends_[edge]});
      ends_[edge] = {nobody, nobody};
      free_.give_back(edge);
    }
    for (const TriangleMesh::Edge h : inner_) {
      if (of_[h] != none) continue;
      const Number edge = create(ends_in(mesh, h));
      of_[h] = of_[mesh.twin(h)] = edge;
      half_edge_[edge] = h;
      report(EdgeChange{EdgeChange::What::came, edge, ends_[edge]});
    }
  }

  /// Throws AuditFailure unless the numbers are those of the mesh's edges.
  void audit(const TriangleMesh& mesh) const {
    std::size_t half_edges = 0;
    for (TriangleMesh::Edge h = 0; h < 3 * mesh.end_triangle(); ++h) {
      const bool numbered = mesh.in_use(h / 3) && ends_in(mesh, h)[1] != nobody;
      const Number edge = h < of_.size() ? of_[h] : none;
      if (numbered ? !contains(edge) || ends_[edge] != ends_in(mesh, h) || of_[mesh.twin(h)] != edge : edge != none) {
        throw AuditFailure("TriangulationEdges: half-edge " + std::to_string(h) + ": has not the number of its edge");
      }
      if (numbered && half_edge_[edge] != h && half_edge_[edge] != mesh.twin(h)) {
        throw AuditFailure("TriangulationEdges: edge " + std::to_string(edge) + ": has not a half-edge of its own");
      }
      half_edges += numbered;
    }
    if (half_edges != 2 * (ends_.size() - free_.size())) {
      throw AuditFailure("TriangulationEdges: there are edges that no triangle has");
    }
  }

  template <class Archive>
  void archive(Archive& archive) {
    archive(of_, ends_, half_edge_, free_);
  }

 private:
  /// The second is `nobody` if the edge leads to infinity.
  static std::array<Id, 2> ends_in(const TriangleMesh& mesh, TriangleMesh::Edge h) {
    const Id a = mesh.origin(h), b = mesh.target(h);
    return {std::min(a, b), std::max(a, b)};
  }

  /// Collects the edges that the triangles had, and takes their numbers from their half-edges.
  void let_go(const TriangleMesh& mesh, std::span<const std::uint32_t> touched) {
    old_.clear();
    of_.resize(std::max<std::size_t>(of_.size(), 3 * std::size_t{mesh.end_triangle()}), none);
    fate_.resize(ends_.size());
    for (const std::uint32_t t : touched) {
      for (TriangleMesh::Edge h = 3 * t; h < 3 * t + 3; ++h) {
        if (of_[h] == none) continue;
        fate_[of_[h]] = Fate::open;
        old_.push_back(std::exchange(of_[h], none));
      }
    }
  }

  /// Gives their numbers to the edges on the rim, whose other triangles have not changed, and collects those inside,
  /// one half-edge of each.
  void keep_outer(const TriangleMesh& mesh, std::span<const std::uint32_t> touched) {
    inner_.clear();
    for (const std::uint32_t t : touched) {
      if (t >= mesh.end_triangle() || !mesh.in_use(t)) continue;
      for (TriangleMesh::Edge h = 3 * t; h < 3 * t + 3; ++h) {
        const TriangleMesh::Edge twin = mesh.twin(h);
        if (of_[h] != none || mesh.origin(h) == TriangleMesh::infinite || mesh.target(h) == TriangleMesh::infinite) {
          continue;
        }
        if (of_[twin] != none) {
          of_[h] = of_[twin];
          half_edge_[of_[h]] = h;
          fate_[of_[h]] = Fate::stays;
        } else if (h < twin) {
          inner_.push_back(h);
        }
      }
    }
  }

  /// The old edges that are not on the rim, each once, ordered by their ends.
  void find_gone() {
    gone_.clear();
    for (const Number edge : old_) {
      if (fate_[edge] != Fate::open) continue;
      fate_[edge] = Fate::gone;
      gone_.push_back(edge);
    }
    std::sort(gone_.begin(), gone_.end(),
              [this](Number a, Number b) { return ends_[a] != ends_[b] ? ends_[a] < ends_[b] : a < b; });
  }

  /// An edge with these ends that was there before, and is still to be found. (Points that have passed through each
  /// other may be joined twice until they are repaired.)
  Number find_again(const std::array<Id, 2>& ends) {
    const auto before = [this](Number edge, const std::array<Id, 2>& other) { return ends_[edge] < other; };
    for (auto at = std::lower_bound(gone_.begin(), gone_.end(), ends, before); at != gone_.end(); ++at) {
      if (ends_[*at] != ends) break;
      if (std::exchange(fate_[*at], Fate::stays) == Fate::gone) return *at;
    }
    return none;
  }

  Number create(const std::array<Id, 2>& ends) {
    const Number edge = free_.take(end());
    if (edge == end()) {
      ends_.emplace_back();
      half_edge_.push_back(TriangleMesh::none);  // which update() sets
    }
    ends_[edge] = ends;
    return edge;
  }

  std::vector<Number> of_;  ///< of a half-edge
  std::vector<std::array<Id, 2>> ends_;
  std::vector<TriangleMesh::Edge> half_edge_;
  FreeNumbers free_;

  // While it updates:
  enum class Fate : std::uint8_t { open, stays, gone };
  std::vector<Fate> fate_;  ///< of a number in old_
  std::vector<Number> old_;
  std::vector<Number> gone_;
  std::vector<TriangleMesh::Edge> inner_;
};

}  // namespace kds::structures
