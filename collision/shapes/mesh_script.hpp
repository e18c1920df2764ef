// Meshes that bend by keyframes: a shape that changes with time.
#pragma once

#include "collision/shapes/mesh.hpp"
#include "collision/shapes/surface_tree.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <span>
#include <vector>

namespace kds::collision {

/// Triangles, and where their vertices are at some times; between two of these they move on straight lines, before the
/// first and after the last they stand still. Immutable, and shared by bodies. Positions are relative to the centre of
/// the body.
class MeshScript {
 public:
  struct Keyframe {
    double time;  ///< s
    std::vector<Eigen::Vector3d> positions;
  };

  /// Triangles without area are welcome. Throws InvalidMesh for a mesh that cannot be (SurfaceTree), and
  /// std::invalid_argument, naming the keyframe, if there is none, times are not finite or do not ascend, or there is
  /// not a position for each vertex, each coordinate finite and at most Mesh::largest_coordinate in magnitude.
  MeshScript(std::vector<Keyframe> keyframes, std::vector<Mesh::Triangle> triangles);

  std::span<const Keyframe> keyframes() const { return keyframes_; }
  std::span<const Mesh::Triangle> triangles() const { return triangles_; }
  const SurfaceTree& tree() const { return tree_; }
  std::size_t vertices() const { return tree_.vertices(); }

  /// Of the ball about the origin that holds all vertices at all times, rounded up.
  double bounding_radius() const { return bounding_radius_; }

  /// Before the first keyframe 0, at or after the last keyframes().size(): how many are not after t.
  std::size_t keyframes_until(double t) const;
  /// The position of a vertex at t, rounded; exact at keyframes.
  Eigen::Vector3d position(std::size_t vertex, double t) const;
  /// Its velocity from t on, rounded; units of length a second.
  Eigen::Vector3d velocity(std::size_t vertex, double t) const;

 private:
  std::vector<Keyframe> keyframes_;
  std::vector<Mesh::Triangle> triangles_;
  SurfaceTree tree_;
  double bounding_radius_ = 0;
};

}  // namespace kds::collision
