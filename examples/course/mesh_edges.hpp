// The edges of a triangulation, as a page draws them, and what becomes of them in an event.
#pragma once

#include "examples/course/page.hpp"
#include "structures/tetrahedron_mesh.hpp"
#include "structures/triangle_mesh.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <string>
#include <vector>

namespace kds::course {

using Edges = std::vector<std::array<Id, 2>>;

/// The edges between points, the lower id first, sorted. (The mesh is closed to a sphere by a vertex at infinity, so
/// that each half-edge has a twin; edges to that are left out.)
inline Edges edges_of(const structures::TriangleMesh& mesh) {
  Edges edges;
  for (structures::TriangleMesh::Edge h = 0; h < 3 * mesh.end_triangle(); ++h) {
    if (!mesh.in_use(h / 3) || mesh.twin(h) < h) continue;
    const Id a = mesh.origin(h), b = mesh.target(h);
    if (a != mesh.infinite && b != mesh.infinite) edges.push_back({std::min(a, b), std::max(a, b)});
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}
inline Edges edges_of(const structures::TetrahedronMesh& mesh) {
  Edges edges;
  for (std::uint32_t t = 0; t < mesh.end_tetrahedron(); ++t) {
    if (!mesh.in_use(t) || !mesh.finite(t)) continue;
    auto corners = mesh.corners(t);
    std::sort(corners.begin(), corners.end());
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t k = i + 1; k < 4; ++k) edges.push_back({corners[i], corners[k]});
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

/// The corners of the triangles, turning left.
inline std::vector<std::array<Id, 3>> triangles_of(const structures::TriangleMesh& mesh) {
  std::vector<std::array<Id, 3>> triangles;
  for (structures::TriangleMesh::Edge h = 0; h < 3 * mesh.end_triangle(); h += 3) {
    const std::array<Id, 3> corners{mesh.origin(h), mesh.origin(h + 1), mesh.origin(h + 2)};
    const bool finite = std::find(corners.begin(), corners.end(), mesh.infinite) == corners.end();
    if (mesh.in_use(h / 3) && finite) triangles.push_back(corners);
  }
  return triangles;
}

/// Which edges go and which come: in words, and the points at their ends. Nothing if none does.
struct EdgeChange {
  std::string text;         ///< "a-b goes, c-d comes"
  std::vector<Id> members;  ///< of each edge the two ends
};
inline EdgeChange change_of(const Edges& before, const Edges& after, const Page& page) {
  Edges gone, come;
  std::set_difference(before.begin(), before.end(), after.begin(), after.end(), std::back_inserter(gone));
  std::set_difference(after.begin(), after.end(), before.begin(), before.end(), std::back_inserter(come));
  EdgeChange change;
  const auto tell = [&](const Edges& edges, const char* what) {
    for (const auto& [a, b] : edges) {
      change.text += (change.text.empty() ? "" : ", ") + page.name(a) + "-" + page.name(b) + what;
      change.members.insert(change.members.end(), {a, b});
    }
  };
  tell(gone, " goes");
  tell(come, " comes");
  return change;
}

}  // namespace kds::course
