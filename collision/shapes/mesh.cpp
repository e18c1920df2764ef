#include "collision/shapes/mesh.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace kds::collision {
namespace {

using Eigen::Vector3d;

void check_vertices(std::span<const Vector3d> vertices) {
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (!vertices[i].allFinite()) {
      throw InvalidMesh(InvalidMesh::Part::vertex, i, "vertex " + std::to_string(i) + ": must be finite");
    }
    if (vertices[i].cwiseAbs().maxCoeff() > Mesh::largest_coordinate) {
      throw InvalidMesh(InvalidMesh::Part::vertex, i, "vertex " + std::to_string(i) + ": is beyond 2^100");
    }
  }
}

/// Whether the corners lie in a line, as far as doubles tell. Scaled first, so that tiny triangles do not underflow.
bool in_a_line(const Vector3d& p, const Vector3d& q, const Vector3d& r) {
  Vector3d u = q - p;
  Vector3d v = r - p;
  Vector3d w = r - q;
  const double size = std::max({u.cwiseAbs().maxCoeff(), v.cwiseAbs().maxCoeff(), w.cwiseAbs().maxCoeff()});
  if (!(size > 0)) return true;
  u /= size;
  v /= size;
  w /= size;
  // The angle between the two longest edges is the smallest one: the sine that counts.
  const double longest = std::max({u.norm(), v.norm(), w.norm()});
  return u.cross(v).norm() <= Mesh::thinnest_sine * longest * longest;
}

void check_triangles(std::span<const Vector3d> vertices, std::span<const Mesh::Triangle> triangles) {
  if (triangles.empty()) throw InvalidMesh(InvalidMesh::Part::whole, 0, "mesh: has no triangles");
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const auto& [a, b, c] = triangles[i];
    const std::string name = "triangle " + std::to_string(i);
    for (const std::uint32_t index : triangles[i]) {
      if (index >= vertices.size()) {
        throw InvalidMesh(InvalidMesh::Part::triangle, i,
                          name + ": vertex " + std::to_string(index) + " does not exist, there are " +
                              std::to_string(vertices.size()));
      }
    }
    if (a == b || b == c || c == a) {
      throw InvalidMesh(InvalidMesh::Part::triangle, i, name + ": names a vertex twice");
    }
    if (in_a_line(vertices[a], vertices[b], vertices[c])) {
      throw InvalidMesh(InvalidMesh::Part::triangle, i, name + ": is degenerate, its corners lie in a line");
    }
  }
}

/// Runs before the tree is built from the same arrays.
std::vector<Mesh::Triangle> checked(std::span<const Vector3d> vertices, std::vector<Mesh::Triangle> triangles) {
  check_vertices(vertices);
  check_triangles(vertices, triangles);
  return triangles;
}

}  // namespace

Mesh::Mesh(std::vector<Vector3d> vertices, std::vector<Triangle> triangles)
    : vertices_(std::move(vertices)),
      triangles_(checked(vertices_, std::move(triangles))),
      tree_(vertices_, triangles_) {
  for (const Vector3d& v : vertices_) bounding_radius_ = std::max(bounding_radius_, v.norm());
  bounding_radius_ *= 1 + 0x1p-50;  // three roundings of the norm, upward
  std::vector<bool> used(vertices_.size());
  for (const Triangle& triangle : triangles_) {
    for (const std::uint32_t index : triangle) {
      if (!used[index]) used_.push_back(index);
      used[index] = true;
    }
  }
}

std::vector<Vector3d> Mesh::placed_vertices(const Eigen::Matrix3d& rotation, double scale) const {
  std::vector<Vector3d> placed;
  placed.reserve(vertices_.size());
  for (const Vector3d& v : vertices_) placed.push_back(placed_vertex(rotation, scale, v));
  return placed;
}

void Mesh::extents(const Eigen::Matrix3d& rotation, double scale, Vector3d& low, Vector3d& high) const {
  low.setConstant(std::numeric_limits<double>::infinity());
  high = -low;
  for (const std::uint32_t index : used_) {
    const Vector3d v = placed_vertex(rotation, scale, vertices_[index]);
    low = low.cwiseMin(v);
    high = high.cwiseMax(v);
  }
}

std::array<double, 2> Mesh::extent(const Eigen::Matrix3d& rotation, double scale, const Vector3d& direction) const {
  std::array<double, 2> ends{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const std::uint32_t index : used_) {
    const double along = direction.dot(placed_vertex(rotation, scale, vertices_[index]));
    ends = {std::min(ends[0], along), std::max(ends[1], along)};
  }
  return ends;
}

}  // namespace kds::collision
