// The data of a query about a mesh: the mesh, the other shape of each kind, and the features by which they touch.
#pragma once

#include "collision/narrow_phase/ball_touch.hpp"
#include "collision/narrow_phase/capsule_touch.hpp"
#include "collision/narrow_phase/convex_touch.hpp"
#include "collision/narrow_phase/obb_descent.hpp"
#include "collision/narrow_phase/placed_surface.hpp"
#include "collision/narrow_phase/segment_ways.hpp"
#include "collision/narrow_phase/separating_axes.hpp"
#include "collision/shapes/feature.hpp"
#include "collision/shapes/mesh.hpp"
#include "collision/shapes/polytope.hpp"
#include "collision/shapes/shape.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <variant>
#include <vector>

namespace kds::collision::detail {

// ---- The kinds of b ------------------------------------------------------------------------------------------------

/// A mesh, or the surface of a hull, in the orientation and scale of its body.
struct PlacedMesh {
  explicit PlacedMesh(const PlacedShape& shape) : PlacedMesh(surface_of(shape.shape), shape.rotation) {}
  PlacedMesh(const MeshShape& shape, const Eigen::Matrix3d& rotation)
      : PlacedMesh(*shape.mesh, rotation, shape.scale) {}
  PlacedMesh(const Mesh& m, const Eigen::Matrix3d& rotation, double s)
      : mesh(m), surface(m, s, rotation), pose{m.tree().nodes(), s * m.tree().unit(), rotation} {}
  PlacedMesh(const PlacedMesh&) = delete;  // its triangles refer to surface
  PlacedMesh& operator=(const PlacedMesh&) = delete;

  using Part = PlacedTriangle;
  template <int Degree>
  using Touching = ConvexTouch<Degree, Part>;
  static constexpr bool solid = false;

  PlacedTriangle triangle(const LeafTriangle& leaf) const {
    const auto& [a, b, c] = leaf.vertices;
    return {{surface.vertex(a), surface.vertex(b), surface.vertex(c)}, &surface, leaf.index};
  }

  template <class Visit>
  void each(const ObbNode& leaf, const Visit& visit) const {
    for (const LeafTriangle& each : mesh.tree().leaf_triangles().subspan(leaf.first, leaf.count)) {
      visit(each.index, triangle(each));
    }
  }

  const Mesh& mesh;
  PlacedSurface surface;
  TreePose pose;
};

/// A box: a tree of one node, measured in its own radius.
struct BoxPartner {
  explicit BoxPartner(const PlacedShape& shape)
      : part{shape.half_axes, shape.rotation},
        node(node_of(std::get<Box>(shape.shape).half_extents / shape.bounding_radius)),
        pose{{&node, 1}, shape.bounding_radius, shape.rotation} {}
  BoxPartner(const BoxPartner&) = delete;  // pose refers to node
  BoxPartner& operator=(const BoxPartner&) = delete;

  using Part = PlacedBox;
  template <int Degree>
  using Touching = ConvexTouch<Degree, Part>;
  static constexpr bool solid = true;

  static ObbNode node_of(const Eigen::Vector3d& half_extents) {
    const Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
    return {{lanes(axes.row(0)), lanes(axes.row(1)), lanes(axes.row(2))}, Lanes{}, lanes(half_extents), 1, 0, 1};
  }

  template <class Visit>
  void each(const ObbNode&, const Visit& visit) const {
    visit(0u, part);
  }

  PlacedBox part;
  ObbNode node;
  TreePose pose;
};

/// A capsule: the tree uses the box around it.
struct CapsulePartner {
  explicit CapsulePartner(const PlacedShape& shape) : CapsulePartner(shape, std::get<Capsule>(shape.shape)) {}
  CapsulePartner(const CapsulePartner&) = delete;  // pose refers to node
  CapsulePartner& operator=(const CapsulePartner&) = delete;

  using Part = PlacedCapsule;
  template <int Degree>
  using Touching = CapsuleTouch<Degree>;
  static constexpr bool solid = true;

  template <class Visit>
  void each(const ObbNode&, const Visit& visit) const {
    visit(0u, part);
  }

  PlacedCapsule part;
  ObbNode node;
  TreePose pose;

 private:
  CapsulePartner(const PlacedShape& shape, const Capsule& capsule)
      : part{capsule.half_length * shape.rotation.col(2), capsule.radius},
        node(BoxPartner::node_of(Eigen::Vector3d(capsule.radius, capsule.radius, capsule.half_length + capsule.radius) /
                                 shape.bounding_radius)),
        pose{{&node, 1}, shape.bounding_radius, shape.rotation} {}
};

struct BallPartner {
  explicit BallPartner(const PlacedShape& shape) : part{std::get<Sphere>(shape.shape).radius} {}

  using Part = PlacedBall;
  template <int Degree>
  using Touching = BallTouch<Degree>;

  PlacedBall part;
};

/// The partner type of each kind of shape.
template <class Alternative>
struct PartnerOfKind;
template <>
struct PartnerOfKind<Sphere> : std::type_identity<BallPartner> {};
template <>
struct PartnerOfKind<Box> : std::type_identity<BoxPartner> {};
template <>
struct PartnerOfKind<Capsule> : std::type_identity<CapsulePartner> {};
template <>
struct PartnerOfKind<MeshShape> : std::type_identity<PlacedMesh> {};
template <>
struct PartnerOfKind<ConvexHull> : std::type_identity<PlacedMesh> {};
template <class Alternative>
using PartnerOf = typename PartnerOfKind<Alternative>::type;
/// Meshes that bend have none: they are tested by BendingContact.
template <class Alternative>
inline constexpr bool has_partner = requires {
  typename PartnerOfKind<Alternative>::type;
};

// ---- Supporting features -------------------------------------------------------------------------------------------

/// The vertices of a triangle farthest along a direction, up to `tolerance`.
struct Support {
  Feature feature;
  std::vector<Eigen::Vector3d> vertices;
};
inline Support triangle_support(const PlacedTriangle& placed, const LeafTriangle& leaf,
                                const Eigen::Vector3d& direction, double tolerance) {
  const double farthest_out = placed.project(direction).high;
  Support support;
  std::vector<std::uint32_t> names;
  for (std::size_t i = 0; i < 3; ++i) {
    if (dot(direction, placed.vertices[i]) < farthest_out - tolerance) continue;
    support.vertices.push_back(placed.vertices[i]);
    names.push_back(leaf.vertices[i]);
  }
  support.feature = names.size() == 1   ? Feature::vertex(names[0])
                    : names.size() == 2 ? Feature::edge(names[0], names[1])
                                        : Feature::face(leaf.index);
  return support;
}

/// An end of a capsule, or its side.
inline Feature capsule_feature(const NearestStretch& nearest) {
  if (nearest.high == -1) return Feature::vertex(0);
  return nearest.low == 1 ? Feature::vertex(1) : Feature::edge(0, 1);
}

inline Feature nearest_feature(const NearestPoint& nearest, const LeafTriangle& leaf) {
  if (nearest.dimension == 2) return Feature::face(leaf.index);
  const std::uint32_t first = leaf.vertices[nearest.index];
  if (nearest.dimension == 0) return Feature::vertex(first);
  return Feature::edge(first, leaf.vertices[(nearest.index + 1) % 3]);
}

}  // namespace kds::collision::detail
