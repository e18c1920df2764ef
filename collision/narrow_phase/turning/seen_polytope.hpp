// A convex polytope of a body that turns: its corners, edges and faces as they are at one time, in doubles.
#pragma once

#include "collision/narrow_phase/convex_core.hpp"
#include "collision/narrow_phase/turning/pair_frame.hpp"
#include "collision/shapes/polytope.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace kds::collision {

/// A convex core in the coordinates of its body, with what is calculated of it once. A copy of its points, so that it
/// may be another, smaller one.
struct TurningPolytope {
  explicit TurningPolytope(const ConvexCore& core) : TurningPolytope(core.structure(), core.points()) {}
  TurningPolytope(const HullStructure& of_points, std::span<const Eigen::Vector3d> places) : structure(&of_points) {
    points.assign(places.begin(), places.end());
    set_directions();
  }

  /// Unit vectors. Normals of faces are known to some roundings (unit_normal()), edges to 3 of them.
  void set_directions() {
    radius = 0;
    for (const std::uint32_t i : structure->corners) radius = std::max(radius, norm(points[i]) * (1 + 0x1p-50));
    edges.clear(), normals.clear();
    for (const HullEdge& edge : structure->edges)
      edges.push_back(normalized(points[edge.ends[1]] - points[edge.ends[0]]));
    for (const std::vector<std::uint32_t>& face : structure->faces) {
      const auto [a, b, c] = spanning_corners(face);
      normals.push_back(unit_normal(points[a], points[b], points[c]));
    }
  }

  std::array<Eigen::Vector3d, 3> face(std::size_t f) const {
    const auto [a, b, c] = spanning_corners(structure->faces[f]);
    return {points[a], points[b], points[c]};
  }
  std::array<Eigen::Vector3d, 2> edge(std::size_t e) const {
    return {points[structure->edges[e].ends[0]], points[structure->edges[e].ends[1]]};
  }

  const HullStructure* structure;
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3d> edges;    ///< from the lower to the higher end
  std::vector<Eigen::Vector3d> normals;  ///< out of the faces
  double radius = 0;                     ///< no corner is farther from the origin of the body
};

/// The same in the axes of the world, about the body's origin.
struct SeenPolytope {
  SeenPolytope(const TurningPolytope& polytope, const certificates::Rotation& turn) : structure(polytope.structure) {
    std::array<Eigen::Vector3d, 3> columns;
    for (std::size_t k = 0; k < 3; ++k) columns[k] = turn(Eigen::Vector3d::Unit(static_cast<Eigen::Index>(k)));
    const auto turned = [&](const std::vector<Eigen::Vector3d>& of_body, std::vector<Eigen::Vector3d>& in_world) {
      in_world.reserve(of_body.size());
      for (const Eigen::Vector3d& x : of_body)
        in_world.push_back(x[0] * columns[0] + x[1] * columns[1] + x[2] * columns[2]);
    };
    turned(polytope.points, points);
    turned(polytope.edges, edges);
    turned(polytope.normals, normals);
  }

  const Eigen::Vector3d& farthest(const Eigen::Vector3d& along) const {
    std::uint32_t best = structure->corners.front();
    for (const std::uint32_t i : structure->corners) {
      if (dot(along, points[i]) > dot(along, points[best])) best = i;
    }
    return points[best];
  }

  /// What it covers at most along a unit vector while it turns about an axis: points keep their heights and distances
  /// about the axis.
  double revolving_reach(const Eigen::Vector3d& n, const Eigen::Vector3d& spin) const {
    const double rate = norm(spin);
    if (!(rate > 0)) return dot(n, farthest(n));
    const Eigen::Vector3d axis = spin / rate;
    const double cosine = dot(n, axis);
    const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    double reach = -never;
    for (const std::uint32_t i : structure->corners) {
      reach = std::max(reach, dot(axis, points[i]) * cosine + norm(cross(axis, points[i])) * sine);
    }
    return reach;
  }

  const HullStructure* structure;
  std::vector<Eigen::Vector3d> points, edges, normals;
};

}  // namespace kds::collision
