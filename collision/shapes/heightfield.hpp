// Meshes of terrains.
#pragma once

#include "collision/shapes/mesh.hpp"

#include <cstddef>
#include <span>

namespace kds::collision {

/// The surface over a grid of places, two triangles a cell.
///
/// `heights`: z of the vertices, in units of length, row by row: heights[j * columns + i] at x = (i - (columns - 1) /
/// 2) spacing_x and y = (j - (rows - 1) / 2) spacing_y, so that the body's centre is below or above the middle. The two
/// triangles of a cell share the edge from its corner of least x and y to the opposite one, and have their fronts
/// above. Like every mesh it has no inside: what is below it may come to it from there.
///
/// Throws std::invalid_argument, in one line, if there are fewer than two rows or columns, the last row is not full, a
/// height is not finite, or a spacing is not finite and > 0; and InvalidMesh as Mesh does.
/// Cost: as that of a Mesh of 2 (rows - 1) (columns - 1) triangles.
Mesh heightfield(std::span<const double> heights, std::size_t columns, double spacing_x, double spacing_y);

}  // namespace kds::collision
