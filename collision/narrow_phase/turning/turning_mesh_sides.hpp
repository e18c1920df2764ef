// What a search for contacts of a mesh that turns takes from either side: nodes, and pairs that can be asked.
#pragma once

#include "collision/narrow_phase/turning/turning_nodes.hpp"
#include "collision/narrow_phase/turning/turning_triangle_and_ball.hpp"
#include "collision/narrow_phase/turning/turning_triangle_and_box.hpp"
#include "collision/narrow_phase/turning/turning_triangle_and_capsule.hpp"
#include "collision/narrow_phase/turning/turning_triangles.hpp"
#include "collision/shapes/mesh.hpp"
#include "collision/shapes/outer_points.hpp"
#include "collision/shapes/shape.hpp"
#include "collision/shapes/solid_integrals.hpp"

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <variant>

namespace kds::collision {

/// A vertex of a mesh as a point of its body: these doubles are exact from here on.
inline Eigen::Vector3d scaled_vertex(const MeshShape& shape, std::uint32_t vertex) {
  const Eigen::Vector3d& x = shape.mesh->vertices()[vertex];
  return {shape.scale * x[0], shape.scale * x[1], shape.scale * x[2]};
}

/// A mesh with its tree.
class MeshOfPair {
 public:
  /// `solid`: it is the surface of a solid, whose triangles are counter-clockwise seen from outside.
  explicit MeshOfPair(const MeshShape& shape, bool solid = false)
      : shape_(shape),
        solid_(solid),
        nodes_(shape.mesh->tree().nodes()),
        unit_(shape.mesh->tree().unit() * shape.scale) {}

  const ObbNode& node(std::uint32_t i) const { return nodes_[i]; }
  NodeUnits units() const {
    const Lanes centre = nodes_[0].centre;
    const double radius =
        norm(Eigen::Vector3d(centre[0], centre[1], centre[2])) + static_cast<double>(nodes_[0].radius);
    return {unit_, 0, unit_ * radius * (1 + 0x1p-40)};
  }
  const OuterPoints& outer_points() const { return shape_.mesh->outer_points(); }
  bool solid() const { return solid_; }
  /// Whether it bounds a volume: its triangles turn alike, and along each edge as many to and fro. Takes O(n log n) of
  /// a mesh that has not been asked yet.
  bool is_closed() const {
    if (!closed_) closed_ = solid_ || bounds_volume(*shape_.mesh);
    return *closed_;
  }
  bool is_leaf(std::uint32_t i) const { return nodes_[i].is_leaf(); }
  std::uint32_t first_child(std::uint32_t i) const { return nodes_[i].first; }
  double radius(std::uint32_t i) const { return unit_ * static_cast<double>(nodes_[i].radius); }

  const LeafTriangle& triangle(std::uint32_t leaf) const {
    static_assert(ObbTree::leaf_size == 1);
    return shape_.mesh->tree().leaf_triangles()[nodes_[leaf].first];
  }
  std::array<Eigen::Vector3d, 3> corners(std::uint32_t leaf) const {
    const auto& vertices = triangle(leaf).vertices;
    return {scaled_vertex(shape_, vertices[0]), scaled_vertex(shape_, vertices[1]), scaled_vertex(shape_, vertices[2])};
  }

  /// The third corner of the other triangle along edge i of a triangle, between its corners i and i + 1, of a mesh that
  /// is closed; none if more than two triangles meet there. O(n).
  std::optional<Eigen::Vector3d> corner_across(std::uint32_t leaf, std::size_t i) const {
    const auto& vertices = shape_.mesh->vertices();
    const auto& of_leaf = triangle(leaf).vertices;
    const Eigen::Vector3d &from = vertices[of_leaf[i]], &to = vertices[of_leaf[(i + 1) % 3]];
    std::optional<std::uint32_t> across;
    for (const Mesh::Triangle& other : shape_.mesh->triangles()) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (vertices[other[k]] != to || vertices[other[(k + 1) % 3]] != from) continue;
        if (across) return std::nullopt;
        across = other[(k + 2) % 3];
      }
    }
    if (!across) return std::nullopt;
    return scaled_vertex(shape_, *across);
  }

  template <int Degree>
  using PairWith = TurningTriangles<Degree>;
  /// A triangle of another mesh with one of this.
  template <int Degree>
  PairWith<Degree> pair(const MeshOfPair& a, std::uint32_t leaf_a, const certificates::RigidMotion<Degree>& motion_a,
                        std::uint32_t leaf, const certificates::RigidMotion<Degree>& motion) const {
    return {motion_a, a.corners(leaf_a), motion, corners(leaf)};
  }

 private:
  static bool bounds_volume(const Mesh& mesh) {
    try {
      const SolidIntegrals& solid = mesh.solid();
      return std::abs(static_cast<double>(solid.volume)) > 2 * solid.error(mesh.triangles().size());
    } catch (const std::invalid_argument&) {
      return false;
    }
  }

  const MeshShape& shape_;
  bool solid_;
  mutable std::optional<bool> closed_;
  std::span<const ObbNode> nodes_;
  double unit_;
};

/// A shape that is a single leaf.
class SolidSide {
 public:
  bool is_leaf(std::uint32_t) const { return true; }
  std::uint32_t first_child(std::uint32_t) const { return 0; }
  double radius(std::uint32_t) const { return 0; }  // it is not to be split
};

/// A box.
class BoxOfPair : public SolidSide {
 public:
  explicit BoxOfPair(const Box& box) : half_(box.half_extents), node_(box_node(half_)) {
    const Eigen::Vector3d half(node_.half_extents[0], node_.half_extents[1], node_.half_extents[2]);
    for (int signs = 0; signs < 8; ++signs) {
      outer_points_.add(
          {signs & 1 ? half[0] : -half[0], signs & 2 ? half[1] : -half[1], signs & 4 ? half[2] : -half[2]});
    }
  }

  const ObbNode& node(std::uint32_t) const { return node_; }
  NodeUnits units() const { return box_units(half_); }
  const OuterPoints& outer_points() const { return outer_points_; }

  template <int Degree>
  using PairWith = TurningTriangleAndBox<Degree>;
  template <int Degree>
  PairWith<Degree> pair(const MeshOfPair& a, std::uint32_t leaf_a, const certificates::RigidMotion<Degree>& motion_a,
                        std::uint32_t, const certificates::RigidMotion<Degree>& motion) const {
    return {motion_a, a.corners(leaf_a), motion, half_};
  }

 private:
  Eigen::Vector3d half_;
  ObbNode node_;
  OuterPoints outer_points_;
};

/// A ball.
class BallOfPair : public SolidSide {
 public:
  explicit BallOfPair(const Sphere& ball) : radius_(ball.radius), node_(box_node(Eigen::Vector3d::Zero())) {
    outer_points_.add(Eigen::Vector3d::Zero());
  }

  const ObbNode& node(std::uint32_t) const { return node_; }
  NodeUnits units() const { return {0, radius_, radius_}; }
  const OuterPoints& outer_points() const { return outer_points_; }

  template <int Degree>
  using PairWith = TurningTriangleAndBall<Degree>;
  template <int Degree>
  PairWith<Degree> pair(const MeshOfPair& a, std::uint32_t leaf_a, const certificates::RigidMotion<Degree>& motion_a,
                        std::uint32_t, const certificates::RigidMotion<Degree>& motion) const {
    return {motion_a, a.corners(leaf_a), motion, radius_};
  }

 private:
  double radius_;
  ObbNode node_;
  OuterPoints outer_points_;
};

/// A capsule.
class CapsuleOfPair : public SolidSide {
 public:
  /// Refers to it.
  explicit CapsuleOfPair(const Shape& capsule)
      : capsule_(std::get<Capsule>(capsule)),
        core_(capsule),
        node_(box_node(Eigen::Vector3d(0, 0, capsule_.half_length))) {
    for (const double end : {-1, 1}) outer_points_.add(Eigen::Vector3d(0, 0, end));
  }

  const ObbNode& node(std::uint32_t) const { return node_; }
  NodeUnits units() const {
    const double radius = (capsule_.half_length + capsule_.radius) * (1 + 0x1p-50);
    return {capsule_.half_length, capsule_.radius, radius};
  }
  const OuterPoints& outer_points() const { return outer_points_; }
  const Capsule& capsule() const { return capsule_; }

  template <int Degree>
  using PairWith = TurningTriangleAndCapsule<Degree>;
  template <int Degree>
  PairWith<Degree> pair(const MeshOfPair& a, std::uint32_t leaf_a, const certificates::RigidMotion<Degree>& motion_a,
                        std::uint32_t, const certificates::RigidMotion<Degree>& motion) const {
    return {motion_a, a.corners(leaf_a), motion, core_};
  }

 private:
  Capsule capsule_;
  ConvexCore core_;
  ObbNode node_;
  OuterPoints outer_points_;
};

}  // namespace kds::collision
