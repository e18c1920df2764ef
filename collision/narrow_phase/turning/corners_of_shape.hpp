// The corners of a shape for searches of some of them: of a solid one by one, of a mesh down its tree.
#pragma once

#include "collision/narrow_phase/convex_core.hpp"
#include "collision/narrow_phase/turning/turning_mesh_sides.hpp"
#include "collision/shapes/mesh.hpp"
#include "collision/shapes/obb_tree.hpp"
#include "collision/shapes/shape.hpp"
#include "collision/vectors.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <variant>
#include <vector>

namespace kds::collision {

/// A box in the coordinates of a body that holds some of its corners.
struct BoxOfCorners {
  Eigen::Vector3d centre;
  std::array<Eigen::Vector3d, 3> half;  ///< half edges
  double radius;                        ///< of the ball about the centre that holds them too
  double rounding;                      ///< by which box and ball may have to be larger to do so
};

/// The corners of a box, a capsule's segment or a hull: so few that all of them are looked at.
class CornersOfSolid {
 public:
  explicit CornersOfSolid(const Shape& shape) {
    const ConvexCore core(shape);
    grown_by_ = core.radius();
    for (const std::uint32_t i : core.structure().corners) points_.push_back(core.points()[i]);
    for (const Eigen::Vector3d& x : points_) radius_ = std::max(radius_, norm(x) * (1 + 0x1p-50));
  }

  static constexpr bool many = false;
  const Eigen::Vector3d& operator[](std::uint32_t corner) const { return points_[corner]; }
  double radius() const { return radius_; }      ///< no corner is farther from the origin of the body
  double grown_by() const { return grown_by_; }  ///< the radius of the balls about the corners, which a capsule has

  /// Calls take(corner) for each corner, boxes of lower rank first, except for corners in boxes whose rank(box) is not
  /// below limit() when their turn comes.
  template <class Rank, class Limit, class Take>
  void search(const Rank&, const Limit&, const Take& take) const {
    for (std::uint32_t i = 0; i < points_.size(); ++i) take(i);
  }

  /// How far along a direction a corner comes at most while the body turns about an axis, both of unit length and in
  /// the coordinates of the body at one time: points keep their heights and distances about the axis.
  double revolving_extent(const Eigen::Vector3d& along, const Eigen::Vector3d& axis) const {
    const double cosine = dot(along, axis);
    const double sine = norm(cross(along, axis));
    double extent = -radius_;
    for (const Eigen::Vector3d& x : points_) {
      extent = std::max(extent, dot(axis, x) * cosine + norm(cross(axis, x)) * sine);
    }
    return extent;
  }

 private:
  std::vector<Eigen::Vector3d> points_;
  double radius_ = 0, grown_by_ = 0;
};

/// The vertices of the triangles of a mesh. Refers to it.
class CornersOfMesh {
 public:
  explicit CornersOfMesh(const MeshShape& shape)
      : shape_(shape),
        tree_(shape.mesh->tree()),
        unit_(tree_.unit() * shape.scale),
        radius_(shape.mesh->bounding_radius() * shape.scale * (1 + 0x1p-48)) {}

  static constexpr bool many = true;
  Eigen::Vector3d operator[](std::uint32_t corner) const { return scaled_vertex(shape_, corner); }
  double radius() const { return radius_; }
  static double grown_by() { return 0; }

  /// As that of CornersOfSolid. A corner is taken once for each triangle that has it.
  template <class Rank, class Limit, class Take>
  void search(const Rank& rank, const Limit& limit, const Take& take) const {
    const auto ranked = [&](std::uint32_t i) { return std::pair(rank(box_of(tree_.nodes()[i])), i); };
    std::vector<std::pair<double, std::uint32_t>> waiting{ranked(0)};
    while (!waiting.empty()) {
      const auto [least, index] = waiting.back();
      waiting.pop_back();
      if (!(least < limit())) continue;
      const ObbNode& node = tree_.nodes()[index];
      if (node.is_leaf()) {
        for (const LeafTriangle& triangle : tree_.leaf_triangles().subspan(node.first, node.count)) {
          for (const std::uint32_t vertex : triangle.vertices) take(vertex);
        }
        continue;
      }
      std::pair left = ranked(node.first), right = ranked(node.first + 1);
      if (left.first < right.first) std::swap(left, right);
      waiting.push_back(left), waiting.push_back(right);
    }
  }

  /// That of the ball around the mesh.
  double revolving_extent(const Eigen::Vector3d&, const Eigen::Vector3d&) const { return radius_; }

 private:
  /// Axes of nodes are orthonormal to some units of 2^-24.
  BoxOfCorners box_of(const ObbNode& node) const {
    constexpr double of_floats = 0x1p-18;
    BoxOfCorners box;
    double size = static_cast<double>(node.radius);
    for (std::size_t k = 0; k < 3; ++k) {
      const double half = static_cast<double>(node.half_extents[k]);
      for (std::size_t d = 0; d < 3; ++d) {
        box.half[k][static_cast<Eigen::Index>(d)] = unit_ * half * static_cast<double>(node.axes[d][k]);
      }
      const double centre = static_cast<double>(node.centre[k]);
      box.centre[static_cast<Eigen::Index>(k)] = unit_ * centre;
      size += std::abs(centre) + half;
    }
    box.radius = unit_ * static_cast<double>(node.radius);
    box.rounding = unit_ * of_floats * size;
    return box;
  }

  const MeshShape& shape_;
  const ObbTree& tree_;
  double unit_, radius_;
};

}  // namespace kds::collision
