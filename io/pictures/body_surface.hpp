// The surfaces of bodies in pictures: triangles.
#pragma once

#include "collision/shapes/mesh_script.hpp"
#include "collision/shapes/shape.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <tuple>
#include <vector>

namespace kds::io {

/// Triangles; normals where the surface is round.
struct Surface {
  std::vector<float> places, normals;    ///< three numbers a vertex
  std::vector<std::uint32_t> triangles;  ///< three vertices each, counter-clockwise from outside
};

/// How finely what is round is drawn.
struct Roundness {
  int around = 24;  ///< sides
  int quarter = 6;  ///< rings from the equator to a pole
};

/// A surface of a shape that is neither a compound nor a half-space (compound_surface.hpp, half_space_patch.hpp), nor
/// bends: in units of surface_scale(), so bodies with the same surface_key() have the same surface.
Surface surface_of(const kds::collision::Shape& shape, const Roundness& roundness = {});
/// Of a mesh that bends, at its first keyframe.
Surface surface_of(const kds::collision::MeshScript& script);

using SurfaceKey = std::tuple<std::size_t, const void*, double>;
SurfaceKey surface_key(const kds::collision::Shape& shape);

/// What the coordinates of a surface are multiplied by.
Eigen::Vector3d surface_scale(const kds::collision::Shape& shape);

void append_floats(std::vector<float>& to, const Eigen::Vector3d& v);

}  // namespace kds::io
