#include "collision/narrow_phase/turning/turning_mesh_contact.hpp"

#include "collision/narrow_phase/turning/turning_mesh_front.hpp"
#include "collision/shapes/polytope.hpp"
#include "collision/shapes/shape_forms.hpp"

#include <optional>
#include <stdexcept>
#include <type_traits>
#include <variant>

namespace kds::collision {
namespace {

template <int Degree>
using MeshBody = typename TurningMeshContact<Degree>::Body;

/// Calls ask(search) with the search for the kind of b.
template <int Degree, class Ask>
auto with_search(const MeshBody<Degree>& a, const MeshBody<Degree>& b, const Ask& ask) {
  const MeshOfPair mesh(std::get<MeshShape>(a.shape.shape));
  const auto with = [&](const auto& side) {
    return ask(TurningMeshSearch<Degree, std::decay_t<decltype(side)>>(mesh, a.motion, side, b.motion));
  };
  if (const auto* const other = std::get_if<MeshShape>(&b.shape.shape)) return with(MeshOfPair(*other));
  if (polytope_of(b.shape.shape)) {
    const MeshShape surface = surface_of(b.shape.shape);
    return with(MeshOfPair(surface, true));
  }
  if (std::holds_alternative<Capsule>(b.shape.shape)) return with(CapsuleOfPair(b.shape.shape));
  if (const auto* const box = std::get_if<Box>(&b.shape.shape)) return with(BoxOfPair(*box));
  return with(BallOfPair(std::get<Sphere>(b.shape.shape)));
}

}  // namespace

template <int Degree>
double TurningMeshContact<Degree>::first_contact(const Body& a, const Body& b, double t0, double horizon,
                                                 ContactMode mode, FoundTouch* found) {
  if (!(t0 <= horizon)) return never;
  return with_search<Degree>(a, b, [&](const auto& search) {
    std::optional<NodePair> foremost;
    const double t = search.first_contact(t0, horizon, mode, found ? &foremost : nullptr);
    if (foremost) *found = {.time = t, .triangle_a = foremost->a, .triangle_b = foremost->b};
    return t;
  });
}

template <int Degree>
double TurningMeshContact<Degree>::apart_until(const Body& a, const Body& b, double t0, double horizon, PairMemory&) {
  if (!(t0 <= horizon)) return never;
  return balls_apart_until(a.motion, b.motion, a.shape.bounding_radius, b.shape.bounding_radius, t0, horizon);
}

template <int Degree>
bool TurningMeshContact<Degree>::in_contact(const Body& a, const Body& b, double t) {
  return with_search<Degree>(a, b, [&](const auto& search) { return search.in_contact(t); });
}

template <int Degree>
double TurningMeshContact<Degree>::first_separation(const Body& a, const Body& b, double t0, double horizon) {
  if (!(t0 <= horizon)) return never;
  return with_search<Degree>(a, b, [&](const auto& search) { return search.first_separation(t0, horizon); });
}

template <int Degree>
Contact TurningMeshContact<Degree>::contact_at(const Body& a, const Body& b, double t, const FoundTouch& found) {
  return with_search<Degree>(a, b, [&](const auto& search) -> Contact {
    const NodePair foremost{found.triangle_a, found.triangle_b};
    TurningTouch touch = search.touch_at(t, found.time == t ? &foremost : nullptr);
    if (const Polytope* const hull = polytope_of(b.shape.shape)) {
      touch.feature_b = hull->feature_of(touch.feature_b);
    }
    return {t, a.motion.path.position(t) + touch.point, touch.normal, touch.feature_a, touch.feature_b};
  });
}

#define KDS_INSTANTIATE(degree) template struct TurningMeshContact<degree>;
KDS_INSTANTIATE(1) KDS_INSTANTIATE(2)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
