// What bounding volumes reach beyond their bodies, in worlds with meshes.
#include "collision/world.hpp"
#include "collision/world/queue_room.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <variant>

namespace kds::collision {

/// From the first mesh on all volumes have room for contact gaps: those of bodies that are there already get it now.
template <int Degree>
void World<Degree>::allow_for_meshes() {
  if (std::exchange(meshes_, true)) return;
  for (BodyId id = 0; id < bodies_.size(); ++id) {
    if (bodies_[id].entered) update_volume(id, bounding_box(id));
  }
}

/// Makes known a volume that is another though nothing has moved.
template <int Degree>
void World<Degree>::update_volume(BodyId id, const KineticBox<Degree>& box) {
  if (collides(id)) broad_phase_->update(id, box, now_, *this);
  if (options_.report_pairs && !broad_phase_->exact()) {  // when its box meets others is to be found anew
    for (const Link& link : links_.items(bodies_[id].pairs)) mark_dirty(link.slot);
  }
  schedule_volume(id);
}

/// By what a body's volume is grown from now on, on all sides. Meshes in the box around their shape have the least of
/// that in place already.
template <int Degree>
std::array<double, std::size_t{Degree} + 1> World<Degree>::growth(BodyId id) const {
  std::array<double, std::size_t{Degree} + 1> growth{};
  if (!meshes_) return growth;
  const Body& b = bodies_[id];
  const MeshClearance<Degree> clearance(movers_[id].motion, b.bounding_radius);
  const bool box_function = b.extras && b.extras->box_function;  // valid for as long as the caller says
  if (box_function || clearance.holds_until() <= now_) return clearance.growing();
  const bool in_place = b.shape && b.volume == BoundingVolume::shape && clearance.is_least() &&
                        std::holds_alternative<MeshShape>(b.shape->shape);
  if (!in_place) growth[0] = clearance.constant();
  return growth;
}

/// Where there are no meshes, a volume with this box.
template <int Degree>
KineticBox<Degree> World<Degree>::grown(BodyId id, KineticBox<Degree> box) const {
  const auto by = growth(id);
  // Its ends are no longer as far from a ball as its radius says. (That of a mesh's volume says nothing of its gap.)
  const bool moves_alike = std::all_of(by.begin() + 1, by.end(), [](double c) { return c == 0; });
  box.rounding = movers_[id].radius > 0 && moves_alike && box.rounding > 0 ? box.rounding + by[0] : 0;
  grow(box, by, movers_[id].motion.start);
  return box;
}

/// When the growth of a volume ceases to be enough.
template <int Degree>
double World<Degree>::clearance_until(BodyId id) const {
  if (!meshes_) return never;
  const double until = MeshClearance<Degree>(movers_[id].motion, bodies_[id].bounding_radius).holds_until();
  return until > now_ ? until : never;  // it grows already
}

template class World<1>;
template class World<2>;

}  // namespace kds::collision
