// What bounding volumes reach beyond their bodies, in worlds with meshes.
#include "collision/degrees.hpp"
#include "collision/narrow_phase/mesh_margins.hpp"
#include "collision/world/volumes.hpp"

#include <algorithm>
#include <array>

namespace kds::collision {

/// By what a body's volume is grown from now on, on all sides. Meshes in the box around their shape have the least of
/// that in place already.
template <int Degree>
std::array<double, std::size_t{Degree} + 1> Volumes<Degree>::growth(BodySlot slot) const {
  std::array<double, std::size_t{Degree} + 1> growth{};
  if (!meshes_) return growth;
  const detail::Body<Degree>& b = bodies_[slot];
  const MeshClearance<Degree> clearance(bodies_.motion(slot), b.bounding_radius);
  // A caller's box is valid for as long as the caller says.
  if (from_caller(slot) || clearance.holds_until() <= clock_.now) return clearance.growing();
  const bool in_place =
      b.shape && b.volume == BoundingVolume::shape && clearance.is_least() && has_mesh(b.shape->shape);
  if (!in_place) growth[0] = clearance.constant();
  return growth;
}

/// Where there are no meshes, a volume with this box.
template <int Degree>
KineticBox<Degree> Volumes<Degree>::grown(BodySlot slot, Box box) const {
  const auto by = growth(slot);
  // Its ends are no longer as far from a ball as its radius says. (That of a mesh's volume says nothing of its gap.)
  const bool moves_alike = std::all_of(by.begin() + 1, by.end(), [](double c) { return c == 0; });
  box.rounding = bodies_.mover(slot).radius > 0 && moves_alike && box.rounding > 0 ? box.rounding + by[0] : 0;
  grow(box, by, bodies_.motion(slot).start);
  return box;
}

/// When the growth of a volume ceases to be enough.
template <int Degree>
double Volumes<Degree>::clearance_until(BodySlot slot) const {
  if (!meshes_) return never;
  const double until = MeshClearance<Degree>(bodies_.motion(slot), bodies_[slot].bounding_radius).holds_until();
  return until > clock_.now ? until : never;  // it grows already
}

#define KDS_INSTANTIATE(degree) template class Volumes<degree>;
KDS_FOR_EACH_DEGREE(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
