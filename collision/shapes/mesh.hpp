// Triangle surfaces, immutable and shared by bodies.
#pragma once

#include "collision/shapes/obb_tree.hpp"
#include "kds/simd/two_doubles.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace kds::collision {

class MeshNeighbours;
class OuterPoints;
class SurfaceTree;
struct SolidIntegrals;

/// A mesh that cannot be used. The message names what is wrong and where.
class InvalidMesh : public std::invalid_argument {
 public:
  enum class Part : std::uint8_t { whole, vertex, triangle };  ///< what is wrong: the whole, or one

  InvalidMesh(Part part, std::size_t index, const std::string& what)
      : std::invalid_argument(what), part_(part), index_(index) {}

  Part part() const { return part_; }
  std::size_t index() const { return index_; }  ///< of the vertex or triangle, from 0

 private:
  Part part_;
  std::size_t index_;
};

/// Throws InvalidMesh if a coordinate is not finite or beyond Mesh::largest_coordinate.
void check_vertices(std::span<const Eigen::Vector3d> vertices);
/// Throws InvalidMesh if there is no triangle, an index is out of range, or a triangle names a vertex twice.
void check_triangle_indices(std::size_t vertices, std::span<const std::array<std::uint32_t, 3>> triangles);
/// Whether a mesh refuses the triangle for its form: it names a vertex twice, or its corners lie in a line, up to
/// Mesh::thinnest_sine. Precondition: finite coordinates; its indices are in range.
bool is_degenerate(std::span<const Eigen::Vector3d> vertices, const std::array<std::uint32_t, 3>& triangle);

/// Where a body's rotation and scale put a vertex of its mesh, about the body's centre. Every part of the module that
/// needs a turned vertex gets it from here, so that triangles with a common vertex agree on it bit for bit.
inline Eigen::Vector3d placed_vertex(const Eigen::Matrix3d& rotation, double scale, const Eigen::Vector3d& vertex) {
  const double x = scale * vertex[0];
  const double y = scale * vertex[1];
  const double z = scale * vertex[2];
  return {rotation(0, 0) * x + rotation(0, 1) * y + rotation(0, 2) * z,
          rotation(1, 0) * x + rotation(1, 1) * y + rotation(1, 2) * z,
          rotation(2, 0) * x + rotation(2, 1) * y + rotation(2, 2) * z};
}

/// Two vertices, coordinate by coordinate.
struct VertexPair {
  Two x, y, z;
};

/// A triangle surface with its tree of oriented boxes. Coordinates are in units of length, relative to the model's
/// origin, which is the centre of the bodies that use it. It need not be closed, connected or consistently wound.
class Mesh {
 public:
  using Triangle = std::array<std::uint32_t, 3>;  ///< indices of vertices

  /// Throws InvalidMesh if there is no triangle, a coordinate is not finite or beyond `largest_coordinate`, an index
  /// is out of range, or a triangle is degenerate: a vertex named twice, or corners in a line up to `thinnest_sine`.
  Mesh(std::vector<Eigen::Vector3d> vertices, std::vector<Triangle> triangles);

  std::span<const Eigen::Vector3d> vertices() const { return vertices_; }
  std::span<const Triangle> triangles() const { return triangles_; }
  const ObbTree& tree() const { return tree_; }
  /// The tree for contact with meshes that bend: made when it is first asked for, in O(n log n). Threads may ask at
  /// once.
  const SurfaceTree& surface_tree() const;
  /// What is beyond edges and around vertices: made when it is first asked for, in O(n log n). Threads may ask at once.
  const MeshNeighbours& neighbours() const;
  /// Volume, centre and second moments of what it bounds, by solid_integrals(), which says what it throws: made when
  /// they are first asked for. Threads may ask at once.
  const SolidIntegrals& solid() const;
  /// Points whose convex hull holds it, in the unit of tree(): made when they are first asked for. Threads may ask at
  /// once.
  const OuterPoints& outer_points() const;

  /// Radius of the ball about the origin that holds all vertices, rounded up.
  double bounding_radius() const { return bounding_radius_; }

  /// Whether some triangle has a corner so sharp that the sine of half its angle is below `sharp_half_sine`.
  bool sharp() const { return sharp_; }

  /// Length of the shortest edge, rounded.
  double shortest_edge() const { return shortest_edge_; }

  /// All vertices, placed.
  std::vector<Eigen::Vector3d> placed_vertices(const Eigen::Matrix3d& rotation, double scale) const;

  /// Corners of the axis-aligned box around the placed vertices that triangles use: tight, without margin.
  void extents(const Eigen::Matrix3d& rotation, double scale, Eigen::Vector3d& low, Eigen::Vector3d& high) const;

  /// Least and greatest direction . v of the placed vertices that triangles use, rounded: by 2^-51 of the sum of the
  /// magnitudes of its terms at most.
  std::array<double, 2> extent(const Eigen::Matrix3d& rotation, double scale, const Eigen::Vector3d& direction) const;

  /// Degenerate below: the sine of the angle at which two edges meet. 64 roundings of the cross product; a triangle
  /// so thin has no normal to speak of.
  static constexpr double thinnest_sine = 0x1p-46;
  /// Of 14.4 degrees. Contacts of meshes with sharper corners need more tests; a smaller number would have contact of
  /// corners reported from farther away (farthest_contact).
  static constexpr double sharp_half_sine = 0.125;
  /// 1.3e30: squares of products of three lengths and a speed must not overflow.
  static constexpr double largest_coordinate = 0x1p100;

 private:
  struct OnDemand;

  std::vector<Eigen::Vector3d> vertices_;
  std::vector<Triangle> triangles_;
  ObbTree tree_;
  std::vector<VertexPair> used_;  // vertices that triangles use, each once; of an odd number the last one twice
  std::shared_ptr<OnDemand> on_demand_;
  double bounding_radius_ = 0;
  double shortest_edge_ = 0;
  bool sharp_ = false;
};

}  // namespace kds::collision
