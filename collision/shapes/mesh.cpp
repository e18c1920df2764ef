#include "collision/shapes/mesh.hpp"

#include "collision/shapes/mesh_neighbours.hpp"
#include "collision/shapes/outer_points.hpp"
#include "collision/shapes/solid_integrals.hpp"
#include "collision/shapes/surface_tree.hpp"
#include "collision/vectors.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <mutex>
#include <optional>
#include <utility>

namespace kds::collision {
namespace {

using Eigen::Vector3d;

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
  const double longest = std::max({norm(u), norm(v), norm(w)});
  return norm(cross(u, v)) <= Mesh::thinnest_sine * longest * longest;
}

void check_triangles(std::span<const Vector3d> vertices, std::span<const Mesh::Triangle> triangles) {
  check_triangle_indices(vertices.size(), triangles);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const auto& [a, b, c] = triangles[i];
    if (in_a_line(vertices[a], vertices[b], vertices[c])) {
      throw InvalidMesh(InvalidMesh::Part::triangle, i,
                        "triangle " + std::to_string(i) + ": is degenerate, its corners lie in a line");
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

void check_triangle_indices(std::size_t vertices, std::span<const Mesh::Triangle> triangles) {
  if (triangles.empty()) throw InvalidMesh(InvalidMesh::Part::whole, 0, "mesh: has no triangles");
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const auto& [a, b, c] = triangles[i];
    const std::string name = "triangle " + std::to_string(i);
    for (const std::uint32_t index : triangles[i]) {
      if (index >= vertices) {
        throw InvalidMesh(
            InvalidMesh::Part::triangle, i,
            name + ": vertex " + std::to_string(index) + " does not exist, there are " + std::to_string(vertices));
      }
    }
    if (a == b || b == c || c == a) {
      throw InvalidMesh(InvalidMesh::Part::triangle, i, name + ": names a vertex twice");
    }
  }
}

bool is_degenerate(std::span<const Vector3d> vertices, const Mesh::Triangle& triangle) {
  const auto& [a, b, c] = triangle;
  return a == b || b == c || c == a || in_a_line(vertices[a], vertices[b], vertices[c]);
}

/// What is made when it is first asked for.
struct Mesh::OnDemand {
  template <class T>
  struct Made {
    std::once_flag flag;
    std::optional<T> value;
    std::exception_ptr refused;  // kept, since not all systems can call_once() anew what has thrown

    template <class Make>
    const T& get(const Make& make) {
      std::call_once(flag, [&] {
        try {
          make(value);
        } catch (...) {
          refused = std::current_exception();
        }
      });
      if (refused) std::rethrow_exception(refused);
      return *value;
    }
  };
  Made<SurfaceTree> surface_tree;
  Made<MeshNeighbours> neighbours;
  Made<SolidIntegrals> solid;
  Made<OuterPoints> outer_points;
};

Mesh::Mesh(std::vector<Vector3d> vertices, std::vector<Triangle> triangles)
    : vertices_(std::move(vertices)),
      triangles_(checked(vertices_, std::move(triangles))),
      tree_(vertices_, triangles_),
      on_demand_(std::make_shared<OnDemand>()) {
  for (const Vector3d& v : vertices_) bounding_radius_ = std::max(bounding_radius_, norm(v));
  bounding_radius_ *= 1 + 0x1p-50;  // three roundings of the norm, upward
  shortest_edge_ = std::numeric_limits<double>::infinity();
  for (const auto& [a, b, c] : triangles_) {
    const auto corner = [&](std::uint32_t at, std::uint32_t next, std::uint32_t last) {
      const Vector3d u = vertices_[next] - vertices_[at];
      const Vector3d v = vertices_[last] - vertices_[at];
      shortest_edge_ = std::min(shortest_edge_, u.stableNorm());
      // The cosine is 1 - 2 sine^2 of the half angle.
      const double cosine = u.stableNormalized().dot(v.stableNormalized());
      sharp_ = sharp_ || !(cosine < 1 - 2 * sharp_half_sine * sharp_half_sine);
    };
    corner(a, b, c), corner(b, c, a), corner(c, a, b);
  }
  std::vector<bool> used(vertices_.size());
  std::size_t count = 0;
  for (const Triangle& triangle : triangles_) {
    for (const std::uint32_t index : triangle) {
      if (used[index]) continue;
      used[index] = true;
      const Vector3d& v = vertices_[index];
      if (count++ % 2 == 0) {
        used_.push_back({both(v[0]), both(v[1]), both(v[2])});
      } else {
        used_.back().x[1] = v[0], used_.back().y[1] = v[1], used_.back().z[1] = v[2];
      }
    }
  }
  used_.shrink_to_fit();
}

const SurfaceTree& Mesh::surface_tree() const {
  return on_demand_->surface_tree.get([this](auto& tree) { tree.emplace(vertices_, triangles_); });
}

const MeshNeighbours& Mesh::neighbours() const {
  return on_demand_->neighbours.get([this](auto& neighbours) { neighbours.emplace(vertices_, triangles_); });
}

const SolidIntegrals& Mesh::solid() const {
  return on_demand_->solid.get([this](auto& solid) { solid = solid_integrals(vertices_, triangles_); });
}

const OuterPoints& Mesh::outer_points() const {
  return on_demand_->outer_points.get([this](auto& points) { points = collision::outer_points(tree_, vertices_); });
}

std::vector<Vector3d> Mesh::placed_vertices(const Eigen::Matrix3d& rotation, double scale) const {
  std::vector<Vector3d> placed;
  placed.reserve(vertices_.size());
  for (const Vector3d& v : vertices_) placed.push_back(placed_vertex(rotation, scale, v));
  return placed;
}

/// Two vertices at a time, in the arithmetic of placed_vertex.
void Mesh::extents(const Eigen::Matrix3d& rotation, double scale, Vector3d& low, Vector3d& high) const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::array<Two, 3> least, most;
  least.fill(both(infinity));
  most.fill(both(-infinity));
  std::array<std::array<Two, 3>, 3> turn;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      turn[i][j] = both(rotation(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)));
    }
  }
  for (const VertexPair& pair : used_) {
    const Two x = both(scale) * pair.x;
    const Two y = both(scale) * pair.y;
    const Two z = both(scale) * pair.z;
    for (std::size_t i = 0; i < 3; ++i) {
      const Two v = turn[i][0] * x + turn[i][1] * y + turn[i][2] * z;
      least[i] = v < least[i] ? v : least[i];
      most[i] = v > most[i] ? v : most[i];
    }
  }
  for (std::size_t i = 0; i < 3; ++i) {
    low[static_cast<Eigen::Index>(i)] = std::min(least[i][0], least[i][1]);
    high[static_cast<Eigen::Index>(i)] = std::max(most[i][0], most[i][1]);
  }
}

std::array<double, 2> Mesh::extent(const Eigen::Matrix3d& rotation, double scale, const Vector3d& direction) const {
  std::array<double, 2> ends{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const VertexPair& pair : used_) {
    for (int i = 0; i < 2; ++i) {
      const double along = dot(direction, placed_vertex(rotation, scale, {pair.x[i], pair.y[i], pair.z[i]}));
      ends = {std::min(ends[0], along), std::max(ends[1], along)};
    }
  }
  return ends;
}

}  // namespace kds::collision
