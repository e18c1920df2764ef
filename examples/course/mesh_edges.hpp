// The edges of a triangulation, as a page draws them.
#pragma once

#include "structures/triangle_mesh.hpp"

#include <algorithm>
#include <array>
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

}  // namespace kds::course
