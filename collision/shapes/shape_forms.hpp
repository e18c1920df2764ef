// What a shape is made of, asked one by one; shape_kinds.hpp tells it by calling a function.
#pragma once

#include "collision/shapes/rounded_box.hpp"
#include "collision/shapes/rounded_core.hpp"
#include "collision/shapes/shape.hpp"

#include <memory>
#include <optional>

namespace kds::collision {

/// Of a ball, a box or a capsule; else nothing.
std::optional<RoundedBox> rounded_box_of(const Shape& shape);
/// The radius by which a rounded box is grown; 0 of other shapes.
double rounding_radius(const Shape& shape);
/// Of a hull; else null.
const Polytope* polytope_of(const Shape& shape);
/// Of a mesh that bends; else null.
const MeshScript* script_of(const Shape& shape);
/// The mesh of a MeshShape, without its scale, or the surface of a hull; else null.
std::shared_ptr<const Mesh> triangles_of(const Shape& shape);

/// As rounded_core(), but of a box with the half edges that it has where it is placed, which are rounded.
RoundedCore placed_core(const PlacedShape& shape);

}  // namespace kds::collision
