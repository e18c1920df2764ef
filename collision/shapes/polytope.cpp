#include "collision/shapes/polytope.hpp"

#include "collision/precise_vector.hpp"
#include "collision/vectors.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace kds::collision {
namespace {

using Eigen::Vector3d;

std::vector<Vector3d> checked(std::vector<Vector3d> points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::string name = "point " + std::to_string(i) + ": ";
    if (!points[i].allFinite()) throw InvalidHull(name + "must be finite", i);
    if (points[i].cwiseAbs().maxCoeff() > Mesh::largest_coordinate) throw InvalidHull(name + "is beyond 2^100", i);
  }
  if (points.size() < 4)
    throw InvalidHull("has " + std::to_string(points.size()) + " points; a solid takes at least 4");
  return points;
}

/// What Polytope::box() tells.
std::optional<AlignedBox> box_of(std::span<const Vector3d> points, const std::vector<std::uint32_t>& corners) {
  if (corners.size() != 8) return std::nullopt;
  AlignedBox box{points[corners[0]], points[corners[0]]};
  for (const std::uint32_t i : corners) {
    box.low = box.low.cwiseMin(points[i]);
    box.high = box.high.cwiseMax(points[i]);
  }
  for (const std::uint32_t i : corners) {
    for (int d = 0; d < 3; ++d) {
      if (points[i][d] != box.low[d] && points[i][d] != box.high[d]) return std::nullopt;
    }
  }
  return box;  // of which all eight corners are there, as no two points are the same corner
}

}  // namespace

std::array<std::uint32_t, 3> spanning_corners(std::span<const std::uint32_t> face) {
  return {face[0], face[face.size() / 3], face[2 * face.size() / 3]};
}

MeshShape surface_of(const Shape& shape) {
  if (const auto* const hull = std::get_if<ConvexHull>(&shape)) return {hull->polytope->surface(), 1};
  return std::get<MeshShape>(shape);
}

Vector3d unit_normal(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  return normalized(cross(precise_difference(b, a), precise_difference(c, a)).rounded());
}

Polytope::Polytope(std::vector<Vector3d> points)
    : points_(checked(std::move(points))), structure_(structure_of_hull(points_)) {
  std::vector<Mesh::Triangle> triangles;
  for (std::uint32_t f = 0; f < structure_.faces.size(); ++f) {
    const std::vector<std::uint32_t>& face = structure_.faces[f];
    for (std::size_t k = 2; k < face.size(); ++k) {
      triangles.push_back({face[0], face[k - 1], face[k]});
      face_of_.push_back(f);
    }
  }
  const auto of_triangles = triangles;
  try {
    surface_ = std::make_shared<const Mesh>(points_, std::move(triangles));
  } catch (const InvalidMesh& error) {
    const auto& [a, b, c] = of_triangles.at(error.index());
    throw InvalidHull("points " + std::to_string(a) + ", " + std::to_string(b) + " and " + std::to_string(c) +
                      " make a part of the surface, and lie in a line but for roundings");
  }
  for (const std::uint32_t i : structure_.corners) bounding_radius_ = std::max(bounding_radius_, norm(points_[i]));
  for (const std::vector<std::uint32_t>& face : structure_.faces) {
    const auto [a, b, c] = spanning_corners(face);
    normals_.push_back(unit_normal(points_[a], points_[b], points_[c]));
  }
  bounding_radius_ *= 1 + 0x1p-50;  // three roundings of the norm, upward
  box_ = box_of(points_, structure_.corners);
}

Feature Polytope::feature_of(const Feature& of_surface) const {
  if (of_surface.kind == Feature::Kind::face) return Feature::face(face_of_[of_surface.first]);
  if (of_surface.kind != Feature::Kind::edge) return of_surface;
  const std::array<std::uint32_t, 2> ends{of_surface.first, of_surface.second};
  const auto is_it = [&](const HullEdge& edge) { return edge.ends == ends; };
  if (std::any_of(structure_.edges.begin(), structure_.edges.end(), is_it)) return of_surface;
  std::uint32_t face = 0;
  while (!is_part_of(of_surface, Feature::face(face))) ++face;
  return Feature::face(face);
}

bool Polytope::is_part_of(const Feature& feature, const Feature& face) const {
  if (face.kind != Feature::Kind::face || feature.kind == Feature::Kind::face) return false;
  const std::vector<std::uint32_t>& corners = structure_.faces[face.first];
  const auto has = [&](std::uint32_t i) { return std::find(corners.begin(), corners.end(), i) != corners.end(); };
  return has(feature.first) && (feature.kind == Feature::Kind::vertex || has(feature.second));
}

}  // namespace kds::collision
