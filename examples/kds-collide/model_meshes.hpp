// Meshes for generated scenes: closed, wound outward, of bounding radius 1, the same bits on every machine.
#pragma once

#include "io/mesh_file.hpp"

namespace kds_collide {

/// [Coming06] section 5: a torus of 64 triangles.
kds::io::MeshData ring_mesh();

/// [Coming06] Figure 6, models of over 6 000 triangles. A tube about the (2, 3) torus knot; a torus with waves in both
/// directions.
kds::io::MeshData knot_mesh();
kds::io::MeshData bumpy_torus_mesh();

}  // namespace kds_collide
