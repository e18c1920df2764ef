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
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace kds::collision {

/// A convex core in the coordinates of its body. A copy of its points, so that it may be another, smaller one.
class TurningPolytope {
 public:
  explicit TurningPolytope(const ConvexCore& core) : TurningPolytope(core.structure(), core.points()) {}
  TurningPolytope(const HullStructure& of_points, std::span<const Eigen::Vector3d> places, bool exact = true)
      : structure(&of_points), points(places.begin(), places.end()), exact_(exact) {
    for (const std::uint32_t i : structure->corners) radius = std::max(radius, norm(points[i]) * (1 + 0x1p-50));
  }

  // Directions are calculated when they are first asked for: to prove that two are apart takes none.

  /// From the lower to the higher end; unit vectors, known to 3 roundings.
  const std::vector<Eigen::Vector3d>& edges() const {
    if (edges_.empty()) {
      for (const HullEdge& edge : structure->edges)
        edges_.push_back(normalized(points[edge.ends[1]] - points[edge.ends[0]]));
    }
    return edges_;
  }
  /// Out of the faces; unit vectors, known to some roundings (unit_normal()).
  const std::vector<Eigen::Vector3d>& normals() const {
    if (normals_.empty()) {
      for (const std::vector<std::uint32_t>& face : structure->faces) {
        const auto [a, b, c] = spanning_corners(face);
        normals_.push_back(unit_normal(points[a], points[b], points[c]));
      }
    }
    return normals_;
  }

  /// The middle of its corners, and the least that it is below a face.
  struct Middle {
    Eigen::Vector3d point;
    double below;
  };
  const Middle& middle() const {
    if (!middle_) {
      middle_ = {Eigen::Vector3d::Zero(), std::numeric_limits<double>::infinity()};
      for (const std::uint32_t i : structure->corners) middle_->point += points[i];
      middle_->point /= static_cast<double>(structure->corners.size());
      for (std::size_t f = 0; f < structure->faces.size(); ++f) {
        middle_->below = std::min(middle_->below, dot(normals()[f], points[structure->faces[f][0]] - middle_->point));
      }
    }
    return *middle_;
  }
  /// Whether all corners of a face are exactly in one plane: of a hull that was moved those of triangles are.
  bool has_exact_faces() const {
    return exact_ || std::all_of(structure->faces.begin(), structure->faces.end(),
                                 [](const std::vector<std::uint32_t>& face) { return face.size() == 3; });
  }
  /// The same, towards its middle by a part of the way there, up to roundings.
  TurningPolytope drawn_in(double part) const {
    TurningPolytope smaller(*structure, points, false);
    for (Eigen::Vector3d& x : smaller.points) x += (middle().point - x) * part;
    return smaller;
  }

  /// Three of its corners, in their order. Of quadrangles both vectors from the first one are sides.
  std::array<Eigen::Vector3d, 3> face(std::size_t f) const {
    const auto [a, b, c] = spanning_corners(structure->faces[f]);
    return {points[b], points[c], points[a]};
  }
  std::array<Eigen::Vector3d, 2> edge(std::size_t e) const {
    return {points[structure->edges[e].ends[0]], points[structure->edges[e].ends[1]]};
  }

  const HullStructure* structure;
  std::vector<Eigen::Vector3d> points;
  double radius = 0;  ///< no corner is farther from the origin of the body

 private:
  bool exact_;  ///< it is the hull that its structure is of
  mutable std::vector<Eigen::Vector3d> edges_, normals_;
  mutable std::optional<Middle> middle_;
};

/// Its points in the axes of the world, about the body's origin.
struct SeenCorners {
  SeenCorners(const TurningPolytope& polytope, const certificates::Rotation& turn)
      : structure(polytope.structure),
        axes{turn(Eigen::Vector3d::UnitX()), turn(Eigen::Vector3d::UnitY()), turn(Eigen::Vector3d::UnitZ())},
        points(seen(polytope.points)) {}

  Eigen::Vector3d seen(const Eigen::Vector3d& x) const { return x[0] * axes[0] + x[1] * axes[1] + x[2] * axes[2]; }
  std::vector<Eigen::Vector3d> seen(const std::vector<Eigen::Vector3d>& of_body) const {
    std::vector<Eigen::Vector3d> in_world(of_body.size());
    for (std::size_t i = 0; i < of_body.size(); ++i) in_world[i] = seen(of_body[i]);
    return in_world;
  }

  /// The corner that is the farthest along a direction: its number among the points.
  std::uint32_t farthest_corner(const Eigen::Vector3d& along) const {
    std::uint32_t best = structure->corners.front();
    double most = dot(along, points[best]);
    for (const std::uint32_t i : structure->corners) {
      if (const double height = dot(along, points[i]); height > most) best = i, most = height;
    }
    return best;
  }
  const Eigen::Vector3d& farthest(const Eigen::Vector3d& along) const { return points[farthest_corner(along)]; }

  /// What it covers at most along a unit vector while it turns about an axis.
  double revolving_extent(const Eigen::Vector3d& n, const Eigen::Vector3d& spin) const {
    return collision::revolving_extent(n, spin, [this](const auto& take) {
      for (const std::uint32_t i : structure->corners) take(points[i]);
    });
  }

  const HullStructure* structure;
  std::array<Eigen::Vector3d, 3> axes;  ///< those of the body
  std::vector<Eigen::Vector3d> points;
};

/// Its points and directions.
struct SeenPolytope : SeenCorners {
  SeenPolytope(const TurningPolytope& polytope, const certificates::Rotation& turn)
      : SeenCorners(polytope, turn), edges(seen(polytope.edges())), normals(seen(polytope.normals())) {}

  std::vector<Eigen::Vector3d> edges, normals;
};

}  // namespace kds::collision
