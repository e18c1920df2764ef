// All kinds of shapes, and what they are made of.
#pragma once

#include "collision/shapes/bending_mesh.hpp"
#include "collision/shapes/box.hpp"
#include "collision/shapes/capsule.hpp"
#include "collision/shapes/compound.hpp"
#include "collision/shapes/convex_hull.hpp"
#include "collision/shapes/half_space.hpp"
#include "collision/shapes/mesh_shape.hpp"
#include "collision/shapes/rounded_box.hpp"
#include "collision/shapes/shape.hpp"
#include "collision/shapes/sphere.hpp"

#include <type_traits>
#include <variant>

namespace kds::collision {

/// Calls ask(kind, shape) with the ShapeKind of what the shape is.
template <class Ask>
auto ask_kind(const Shape& shape, const Ask& ask) {
  return std::visit([&](const auto& each) { return ask(detail::ShapeKind<std::decay_t<decltype(each)>>{}, each); },
                    shape);
}

/// What a shape is made of, by which shapes of several kinds are treated alike:
/// - a RoundedBox, where its kind has a function rounded_box(shape): balls, boxes and capsules;
/// - a Polytope, where it has a member `polytope`: convex hulls;
/// - else the shape itself: MeshShape, BendingMesh, HalfSpace or Compound.
///
/// Precondition, here and below: place() accepts the shape.
template <class Alternative>
decltype(auto) form_of(detail::ShapeKind<Alternative> kind, const Alternative& shape) {
  if constexpr (requires { kind.rounded_box(shape); }) {
    return kind.rounded_box(shape);
  } else if constexpr (requires { shape.polytope; }) {
    return (*shape.polytope);
  } else {
    return (shape);
  }
}

/// Calls ask(form) with the form of the shape.
template <class Ask>
auto ask_form(const Shape& shape, const Ask& ask) {
  return ask_kind(shape, [&](auto kind, const auto& each) { return ask(form_of(kind, each)); });
}

/// A function object of several functions, one for each form; one that takes anything is for all others.
template <class... Functions>
struct ByForm : Functions... {
  using Functions::operator()...;
};
template <class... Functions>
ByForm(Functions...) -> ByForm<Functions...>;

}  // namespace kds::collision
