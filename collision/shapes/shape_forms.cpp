#include "collision/shapes/shape_forms.hpp"

#include "collision/shapes/shape_kinds.hpp"

namespace kds::collision {

std::optional<RoundedBox> rounded_box_of(const Shape& shape) {
  return ask_kind(shape, [](auto kind, const auto& each) -> std::optional<RoundedBox> {
    if constexpr (requires { kind.rounded_box(each); }) {
      return kind.rounded_box(each);
    } else {
      return std::nullopt;
    }
  });
}

double rounding_radius(const Shape& shape) {
  return ask_kind(shape, [](auto kind, const auto& each) -> double {
    if constexpr (requires { kind.rounded_box(each); }) {
      return kind.rounded_box(each).radius;
    } else {
      return 0;
    }
  });
}

const Polytope* polytope_of(const Shape& shape) {
  return std::visit(
      [](const auto& each) -> const Polytope* {
        if constexpr (requires { each.polytope; }) {
          return each.polytope.get();
        } else {
          return nullptr;
        }
      },
      shape);
}

const MeshScript* script_of(const Shape& shape) {
  const auto* const bending = std::get_if<BendingMesh>(&shape);
  return bending ? bending->script.get() : nullptr;
}

std::shared_ptr<const Mesh> triangles_of(const Shape& shape) {
  const Polytope* const polytope = polytope_of(shape);
  return polytope ? polytope->surface() : mesh_of(shape);
}

RoundedCore placed_core(const PlacedShape& shape) {
  RoundedCore core = rounded_core(shape);
  if (!ask_kind(shape.shape, [](auto kind, const auto&) { return kind.has_half_axes; })) return core;
  core.generators.clear();
  for (const Eigen::Vector3d& half : shape.half_axes) core.generators.push_back({half, 1});
  return core;
}

}  // namespace kds::collision
