// Meshes of several kinds: closed and open, thin, folded, and with many triangles on one edge.
#pragma once

#include "collision/shapes/compound.hpp"
#include "collision/shapes/mesh.hpp"

#include <memory>
#include <vector>

namespace kds::fuzz {

/// Vertices and triangles, before they are a mesh.
struct Surface {
  const char* name;
  std::vector<Eigen::Vector3d> vertices;
  std::vector<collision::Mesh::Triangle> triangles;
};

const std::vector<Surface>& sample_surfaces();
/// One mesh of each, shared by all bodies.
const std::vector<std::shared_ptr<const collision::Mesh>>& sample_meshes();

/// The corners of a box without one of them.
std::vector<Eigen::Vector3d> cut_box(const Eigen::Vector3d& half_extents);

/// A plate below and one on the left, of a box with these half extents, which share their edge.
std::vector<collision::CompoundPart> angle(const Eigen::Vector3d& half_extents);

}  // namespace kds::fuzz
