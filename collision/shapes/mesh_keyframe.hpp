// Keyframes of meshes that bend.
#pragma once

#include <Eigen/Core>

#include <vector>

namespace kds::collision {

/// Where the vertices of a mesh that bends are at a time, in the order of the mesh, relative to the centre of the body.
struct MeshKeyframe {
  double time;  ///< s
  std::vector<Eigen::Vector3d> positions;
};

}  // namespace kds::collision
