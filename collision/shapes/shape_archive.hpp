// Placed shapes in snapshots.
#pragma once

#include "collision/shapes/shape.hpp"
#include "collision/shapes/shape_kinds.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <variant>

namespace kds::collision {

/// Writes or reads a placed shape. Of a mesh, `mesh` is the number among `meshes`, which are written apart.
/// What is read may be no shape that place() makes: see is_placed().
template <class Archive>
void archive_shape(Archive& archive, PlacedShape& placed, std::uint32_t& mesh,
                   std::span<const std::shared_ptr<const Mesh>> meshes) {
  std::uint32_t kind = static_cast<std::uint32_t>(placed.shape.index());
  archive(kind);
  if constexpr (Archive::loading) {
    constexpr std::size_t kinds = std::variant_size_v<Shape>;
    if (kind >= kinds) throw std::runtime_error("snapshot: a shape is of an unknown kind");
    [&]<std::size_t... I>(std::index_sequence<I...>) { ((kind == I ? void(placed.shape.emplace<I>()) : void()), ...); }
    (std::make_index_sequence<kinds>{});
  }
  std::visit(
      [&](auto& shape) {
        using Kind = detail::ShapeKind<std::decay_t<decltype(shape)>>;
        Kind::archive(archive, shape, placed, detail::NumberedMeshes{meshes, mesh});
      },
      placed.shape);
  for (double& entry : placed.rotation.reshaped()) archive(entry);
  detail::archive_vector(archive, placed.low), detail::archive_vector(archive, placed.high);
  archive(placed.bounding_radius);
  if constexpr (Archive::loading) detail::place_parts(placed);
}

}  // namespace kds::collision
