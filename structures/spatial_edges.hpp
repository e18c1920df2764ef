// The edges of a triangulation in space under numbers that they keep, and which of them come and go.
#pragma once

#include "kds/audit.hpp"
#include "kds/framework/free_numbers.hpp"
#include "structures/tetrahedron_mesh.hpp"
#include "structures/triangulation_edges.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace kds::structures {

/// A tetrahedron that has come, gone, or got other corners; or one of whose corners has got a new motion. Tetrahedra
/// with the vertex at infinity are among them.
struct TetrahedronChange {
  std::uint32_t tetrahedron;

  friend bool operator==(const TetrahedronChange&, const TetrahedronChange&) = default;
};

/// Numbers the edges between points, each of which is there as long as a tetrahedron has it. Edges to infinity have no
/// number. The interface is that of TriangulationEdges, so that rules about edges work in space as they do in the
/// plane.
///
/// Cost: O(1) on average for a tetrahedron that has changed; memory, four ids a tetrahedron, and of each edge its ends,
/// a count and an entry of a hash table.
class SpatialEdges {
 public:
  using Number = TriangulationEdges::Number;
  static constexpr Number none = TriangulationEdges::none;

  /// Numbers are below this.
  Number end() const { return static_cast<Number>(ends_.size()); }
  bool contains(Number edge) const { return edge < end() && ends_[edge][0] != nobody; }
  /// The lower id first. Precondition: contains(edge).
  const std::array<Id, 2>& ends(Number edge) const { return ends_[edge]; }
  /// The edge that joins two points, none if there is none.
  Number between(Id a, Id b) const {
    const auto found = number_.find(key(a, b));
    return found == number_.end() ? none : found->second;
  }

  /// Takes up the tetrahedra that have changed, and calls report(EdgeChange) for each edge that went, then for each
  /// that came. A tetrahedron may be named twice, and need not be in use any more.
  template <class Report>
  void update(const TetrahedronMesh& mesh, std::span<const std::uint32_t> touched, const Report& report) {
    went_.clear();
    came_.clear();
    corners_.resize(std::max<std::size_t>(corners_.size(), mesh.end_tetrahedron()), without_corners);
    for (const std::uint32_t t : touched) {
      if (t >= corners_.size()) continue;  // It has come and gone since the last time.
      for_each_edge(std::exchange(corners_[t], without_corners), [this](Id a, Id b) {
        const Number edge = between(a, b);
        if (--count_[edge] == 0) went_.push_back(edge);
      });
    }
    for (const std::uint32_t t : touched) {
      if (t >= mesh.end_tetrahedron() || !mesh.in_use(t) || corners_[t] != without_corners) continue;
      corners_[t] = mesh.corners(t);
      for_each_edge(corners_[t], [this](Id a, Id b) { ++count_[find_or_create(a, b)]; });
    }
    for (const Number edge : went_) {
      if (count_[edge] > 0) continue;
      report(EdgeChange{EdgeChange::What::went, edge, ends_[edge]});
      number_.erase(key(ends_[edge][0], ends_[edge][1]));
      ends_[edge] = {nobody, nobody};
      free_.give_back(edge);
    }
    for (const Number edge : came_) report(EdgeChange{EdgeChange::What::came, edge, ends_[edge]});
  }

  /// Throws AuditFailure unless the numbers are those of the mesh's edges.
  void audit(const TetrahedronMesh& mesh) const {
    std::unordered_map<std::uint64_t, std::uint32_t> counts;
    for (std::uint32_t t = 0; t < std::max<std::size_t>(corners_.size(), mesh.end_tetrahedron()); ++t) {
      const bool in_use = t < mesh.end_tetrahedron() && mesh.in_use(t);
      if ((t < corners_.size() ? corners_[t] : without_corners) != (in_use ? mesh.corners(t) : without_corners)) {
        throw AuditFailure("SpatialEdges: tetrahedron " + std::to_string(t) + ": has other corners");
      }
      if (in_use) for_each_edge(corners_[t], [&](Id a, Id b) { ++counts[key(a, b)]; });
    }
    if (counts.size() != number_.size() || counts.size() != ends_.size() - free_.size()) {
      throw AuditFailure("SpatialEdges: there are edges that no tetrahedron has");
    }
    for (const auto& [ends, count] : counts) {
      const auto found = number_.find(ends);
      if (found == number_.end() || count_[found->second] != count ||
          key(ends_[found->second][0], ends_[found->second][1]) != ends) {
        throw AuditFailure("SpatialEdges: the edge from " + std::to_string(ends >> 32) + ": has no number of its own");
      }
    }
  }

  template <class Archive>
  void archive(Archive& archive) {
    archive(corners_, ends_, count_, free_);
    if constexpr (Archive::loading) {
      number_.clear();
      for (Number edge = 0; edge < end(); ++edge) {
        if (contains(edge)) number_[key(ends_[edge][0], ends_[edge][1])] = edge;
      }
    }
  }

 private:
  using Corners = TetrahedronMesh::Corners;
  static constexpr Corners without_corners{nobody, nobody, nobody, nobody};

  static std::uint64_t key(Id a, Id b) { return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b); }

  template <class F>
  static void for_each_edge(const Corners& corners, const F& f) {
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = i + 1; j < 4; ++j) {
        if (corners[i] != TetrahedronMesh::infinite && corners[j] != TetrahedronMesh::infinite) {
          f(corners[i], corners[j]);
        }
      }
    }
  }

  Number find_or_create(Id a, Id b) {
    const auto [entry, is_new] = number_.try_emplace(key(a, b), none);
    if (!is_new) return entry->second;
    const Number edge = free_.take(end());
    if (edge == end()) {
      ends_.emplace_back();
      count_.push_back(0);
    }
    ends_[edge] = {std::min(a, b), std::max(a, b)};
    came_.push_back(edge);
    return entry->second = edge;
  }

  std::vector<Corners> corners_;  ///< by tetrahedron, as taken up
  std::vector<std::array<Id, 2>> ends_;
  std::vector<std::uint32_t> count_;  ///< by edge: of tetrahedra that have it
  FreeNumbers free_;
  std::unordered_map<std::uint64_t, Number> number_;  ///< by ends; never gone through, so that its order is no matter

  // While it updates:
  std::vector<Number> went_;
  std::vector<Number> came_;
};

}  // namespace kds::structures
