// Polygons of mesh files, cut into triangles.
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace kds::io {

/// The triangles of a polygon that is given by its corners, numbers of vertices, as it goes around: none of them
/// overlap, and their areas add up to the area of the polygon. They have its corners and go around as it does.
///
/// Corners may be concave, on a straight line or repeated. The polygon may touch itself, also along edges, which it
/// then goes along in both directions: so a polygon with holes is one whose holes are each connected with its outline
/// by such an edge (a keyhole). One that is not flat is judged by its projection along the axis in which it is widest;
/// a strictly convex one with four corners is cut along its shorter diagonal. All decisions about sides are by exact
/// signs.
///
/// A polygon without area, which comes back along all its edges or has fewer than three corners, gives one triangle
/// without area (collision::is_degenerate), so that it is counted with others of that kind (leave_out_degenerate() in
/// mesh_file.hpp).
///
/// Nothing for a polygon that crosses itself, or goes around more than once: there are no such triangles. Precondition:
/// it has a corner, and the vertices are finite. Cost: ears are cut off, each found by comparison with all edges that
/// are left: O(n^2) for ordinary outlines of n corners, O(n^3) at worst.
std::optional<std::vector<std::array<std::uint32_t, 3>>> cut_into_triangles(std::span<const Eigen::Vector3d> vertices,
                                                                            std::span<const std::uint32_t> polygon);

/// The triangles of the first corner with each two others that follow each other: a surface with the edges of the
/// polygon, whatever it is. Precondition: it has three corners.
std::vector<std::array<std::uint32_t, 3>> fan(std::span<const std::uint32_t> polygon);

}  // namespace kds::io
