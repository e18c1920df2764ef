// How much larger than their bodies bounding volumes are, in worlds with meshes.
#include "collision/motions.hpp"
#include "collision/narrow_phase/mesh_margins.hpp"
#include "collision/world/volumes.hpp"

#include <algorithm>
#include <array>

namespace kds::collision {

/// By how much a body's volume is grown from now on, on all sides. The boxes around the shapes of meshes include the
/// least such growth already.
template <class Motion>
std::array<double, std::size_t{Motion::degree} + 1> Volumes<Motion>::growth(BodySlot slot) const {
  std::array<double, std::size_t{Motion::degree} + 1> growth{};
  if (!meshes_) return growth;
  const detail::Body<Motion>& b = bodies_[slot];
  const MeshClearance<Motion::degree> clearance(bodies_.path(slot), b.bounding_radius);
  // A caller's box is valid as long as the caller says.
  if (from_caller(slot) || clearance.holds_until() <= clock_.now) return clearance.growing();
  const bool in_place = !is_round(slot) && clearance.is_least() && has_mesh(b.shape->shape);
  if (!in_place) growth[0] = clearance.constant();
  return growth;
}

/// A volume with this box, in a world without meshes.
template <class Motion>
KineticBox<Motion::degree> Volumes<Motion>::grown(BodySlot slot, Box box) const {
  const auto by = growth(slot);
  // Its ends are now farther from a ball than its rounding radius assumes. (That of a mesh's volume does not include
  // the gap.)
  const bool moves_alike = std::all_of(by.begin() + 1, by.end(), [](double c) { return c == 0; });
  box.rounding = bodies_.mover(slot).radius > 0 && moves_alike && box.rounding > 0 ? box.rounding + by[0] : 0;
  grow(box, by, bodies_.path(slot).start);
  return box;
}

/// When the growth of a volume ceases to be enough.
template <class Motion>
double Volumes<Motion>::clearance_until(BodySlot slot) const {
  if (!meshes_) return never;
  const double until = MeshClearance<Motion::degree>(bodies_.path(slot), bodies_[slot].bounding_radius).holds_until();
  return until > clock_.now ? until : never;  // it grows already
}

#define KDS_INSTANTIATE(motion) KDS_TEMPLATE_PART class Volumes<motion>;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
