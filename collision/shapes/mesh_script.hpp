// Meshes that bend by keyframes: a shape that changes with time.
#pragma once

#include "collision/shapes/mesh.hpp"
#include "collision/shapes/mesh_keyframe.hpp"
#include "collision/shapes/surface_tree.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace kds::collision {

/// Triangles, and where their vertices are at some times; between two of these they move on straight lines, before the
/// first and after the last they stand still. Immutable, and shared by bodies. Positions are relative to the centre of
/// the body.
class MeshScript {
 public:
  using Keyframe = MeshKeyframe;

  /// What scripts that continue each other share: the triangles, and a tree made from where the vertices once were.
  struct Form {
    std::vector<Mesh::Triangle> triangles;
    std::vector<Eigen::Vector3d> positions;
    SurfaceTree tree;
  };

  /// Triangles without area are welcome. Throws InvalidMesh for a mesh that cannot be (SurfaceTree), and
  /// std::invalid_argument, naming the keyframe, if there is none, times are not finite or do not ascend, or there is
  /// not a position for each vertex, each coordinate finite and at most Mesh::largest_coordinate in magnitude.
  MeshScript(std::vector<Keyframe> keyframes, std::vector<Mesh::Triangle> triangles);
  /// The same triangles with other keyframes, and the same tree. Throws as the constructor does.
  MeshScript with(std::vector<Keyframe> keyframes) const { return {std::move(keyframes), form_}; }
  /// A script that goes on from where the vertices are at t, to other keyframes, each later than t; with none of them
  /// they stand still from then on. Keyframes before t are left out. Throws as the constructor does. Cost: O(n) a
  /// keyframe, as the tree stays.
  MeshScript continued(double t, std::vector<Keyframe> to_come) const;

  std::span<const Keyframe> keyframes() const { return keyframes_; }
  std::span<const Mesh::Triangle> triangles() const { return form_->triangles; }
  const SurfaceTree& tree() const { return form_->tree; }
  const Form& form() const { return *form_; }
  std::size_t vertices() const { return form_->positions.size(); }

  /// Of the ball about the origin that holds all vertices at all times, rounded up.
  double bounding_radius() const { return bounding_radius_; }

  /// Before the first keyframe 0, at or after the last keyframes().size(): how many are not after t.
  std::size_t keyframes_until(double t) const;
  /// The position of a vertex at t, rounded; exact at keyframes.
  Eigen::Vector3d position(std::size_t vertex, double t) const;
  /// Its velocity from t on, rounded; units of length a second.
  Eigen::Vector3d velocity(std::size_t vertex, double t) const;

 private:
  MeshScript(std::vector<Keyframe> keyframes, std::shared_ptr<const Form> form);
  void measure();

  std::vector<Keyframe> keyframes_;
  std::shared_ptr<const Form> form_;
  double bounding_radius_ = 0;
};

}  // namespace kds::collision
