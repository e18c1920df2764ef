// A mesh as the surroundings of its triangles: where these may be met at all, and how well their planes are known.
#pragma once

#include "collision/narrow_phase/separating_axes.hpp"
#include "collision/shapes/mesh.hpp"
#include "collision/shapes/mesh_neighbours.hpp"
#include "collision/vectors.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace kds::collision {

/// A mesh in world orientation about the centre of its body.
struct PlacedSurface {
  PlacedSurface(const Mesh& m, double s, const Eigen::Matrix3d& r)
      : mesh(m), neighbours(m.neighbours()), scale(s), rotation(r) {}

  Eigen::Vector3d vertex(std::uint32_t index) const { return placed_vertex(rotation, scale, mesh.vertices()[index]); }
  PlacedTriangle triangle(std::uint32_t index) const {
    const auto& [a, b, c] = mesh.triangles()[index];
    return {{vertex(a), vertex(b), vertex(c)}, this, index};
  }

  const Mesh& mesh;
  const MeshNeighbours& neighbours;
  double scale;
  Eigen::Matrix3d rotation;
};

/// Whether the surface goes on in the plane of a triangle beyond an edge, or all around a corner. A triangle by itself
/// ends there.
inline bool flat_edge(const PlacedTriangle& triangle, std::size_t edge) {
  return triangle.surface && triangle.surface->neighbours.flat_edge(triangle.index, edge);
}
inline bool flat_corner(const PlacedTriangle& triangle, std::size_t corner) {
  return triangle.surface && triangle.surface->neighbours.flat_corner(triangle.index, corner);
}

/// The far corner of the triangle beyond an edge.
inline std::optional<Eigen::Vector3d> beyond(const PlacedTriangle& triangle, std::size_t edge) {
  if (!triangle.surface) return std::nullopt;
  const std::uint32_t vertex = triangle.surface->neighbours.beyond(triangle.index, edge);
  if (vertex == MeshNeighbours::none) return std::nullopt;
  return triangle.surface->vertex(vertex);
}

/// The places r with out . r < distance.
struct PlaneSide {
  Eigen::Vector3d out;  ///< unit
  double distance;
};
/// The places from which an edge is nearer than a triangle beyond it with the corner `far`, as long as they are no
/// farther than a radius from the edge: up to 64 roundings of the direction across it, which is known the less the
/// nearer the corner is to the line of the edge. `along`: unit.
inline PlaneSide nearer_to_edge(const Eigen::Vector3d& begin, const Eigen::Vector3d& along, const Eigen::Vector3d& far,
                                double radius) {
  const Eigen::Vector3d way = far - begin;
  const Eigen::Vector3d across = way - dot(way, along) * along;
  const double square = dot(across, across);
  if (!(square > 0)) return {Eigen::Vector3d::Zero(), 0};
  const double width = std::sqrt(square);
  const double rounding = 64 * 0x1p-53 * std::sqrt(dot(way, way)) / width;
  const Eigen::Vector3d out = across / width;
  return {out, dot(out, begin) + rounding * radius};
}

/// Calls visit(vertex) for the vertices to which edges lead from a corner.
template <class Visit>
void each_around(const PlacedTriangle& triangle, std::size_t corner, const Visit& visit) {
  if (!triangle.surface) return;
  const PlacedSurface& surface = *triangle.surface;
  for (const std::uint32_t i : surface.neighbours.around(surface.mesh.triangles()[triangle.index][corner])) {
    visit(surface.vertex(i));
  }
}

/// Whether nothing beside a triangle comes out farther along a direction than its outermost edge or corner, up to a
/// gap; a face is met whatever is beside it.
inline bool is_outermost(const PlacedTriangle& triangle, const Eigen::Vector3d& out, double gap) {
  if (!triangle.surface) return true;
  const double high = triangle.project(out).high;
  std::array<bool, 3> top;
  for (std::size_t i = 0; i < 3; ++i) top[i] = dot(out, triangle.vertices[i]) >= high - gap;
  if (top[0] && top[1] && top[2]) return true;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t next = (i + 1) % 3, last = (i + 2) % 3;
    if (!top[i] || top[last]) continue;
    if (top[next]) {
      const auto far = beyond(triangle, i);
      return !far || (!flat_edge(triangle, i) && dot(out, *far) <= high + gap);
    }
    bool outermost = true;
    each_around(triangle, i,
                [&](const Eigen::Vector3d& other) { outermost = outermost && dot(out, other) <= high + gap; });
    return outermost;
  }
  return true;
}

/// The sine of the angle by which the plane of a triangle may be off: its corners are rounded by 18 x 2^-53 of their
/// length (ContactGap) when they are placed, over its least height. What approaches a face by no more than that part of
/// its speed moves along it.
inline double tilt_of(const PlacedTriangle& triangle) {
  constexpr double placed = 2 * 18 * 0x1p-53;
  constexpr double most = 0x1p-20;
  const auto& v = triangle.vertices;
  double far = 0, longest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    far = std::max(far, dot(v[i], v[i]));
    const Eigen::Vector3d edge = triangle.edge(i);
    longest = std::max(longest, dot(edge, edge));
  }
  const Eigen::Vector3d area = cross(triangle.edge(0), triangle.edge(1));
  const double height = std::sqrt(dot(area, area)) / std::sqrt(longest);
  return height > 0 ? std::min(placed * std::sqrt(far) / height, most) : most;
}

}  // namespace kds::collision
