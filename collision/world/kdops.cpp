// The k-DOPs of the world's bodies.
#include "collision/world.hpp"
#include "structures/extents.hpp"

#include <algorithm>
#include <stdexcept>

namespace kds::collision {

template <int Degree>
Kdops<Degree> World<Degree>::kdops() {
  const int k = options_.kdop;
  if (k == 6) return {};
  if (k != 14 && k != 18 && k != 26) throw std::invalid_argument("WorldOptions.kdop: must be 6, 14, 18 or 26");
  if (options_.broad_phase != BroadPhaseKind::kinetic_sap) {
    throw std::invalid_argument("WorldOptions.kdop: more than 6 is for kinetic sweep and prune alone");
  }
  const auto all = structures::kdop_directions(k);
  directions_.assign(all.begin() + 3, all.end());
  return {directions_, [this](BodyId id, std::size_t i, double now) { return slab(id, i, now); }};
}

/// How far a body that comes in reaches in the directions beyond the axes: that stays so, as it does not turn.
template <int Degree>
void World<Degree>::place_extents(BodyId id) {
  if (directions_.empty()) return;
  const Body& b = bodies_[id];
  extents_.resize(std::max(extents_.size(), (id + std::size_t{1}) * directions_.size()));
  for (std::size_t i = 0; i < directions_.size(); ++i) {
    const Eigen::Vector3d direction(directions_[i].data());
    auto& reach = extents_[id * directions_.size() + i];
    if (!b.shape || b.volume == BoundingVolume::sphere) {
      const double radius = b.bounding_radius * direction.norm() * (1 + 0x1p-48);
      reach = {-radius, radius};
    } else {
      reach = extent(*b.shape, direction);
    }
  }
}

/// What a body covers along a direction from now on.
template <int Degree>
KineticSlab<Degree> World<Degree>::slab(BodyId id, std::size_t i, double now) const {
  const Body& b = bodies_[id];
  const auto& [low, high] = extents_[id * directions_.size() + i];
  const bool boxes_alone = b.extras && b.extras->box_function;
  if (!boxes_alone && movers_[id].motion.start <= now) {
    return slab_around(movers_[id].motion, low, high, directions_[i]);
  }
  return slab_around(bounding_box(id), directions_[i], now);
}

/// Whether the volumes that the broad phase sees overlap at now+.
template <int Degree>
bool World<Degree>::volumes_overlap(BodyId a, BodyId b) const {
  const auto broken = [this](const kds::Motion<Degree>& left, const kds::Motion<Degree>& right) {
    return sign_after(certificates::Order<Degree>{left, right}, now_) < 0;
  };
  const BoxOverlap<Degree> boxes(bounding_box(a), bounding_box(b));
  for (const auto& side : boxes.separations()) {
    if (sign_after(side, now_) >= 0) return false;
  }
  for (std::size_t i = 0; i < directions_.size(); ++i) {
    const KineticSlab<Degree> slab_a = slab(a, i, now_);
    const KineticSlab<Degree> slab_b = slab(b, i, now_);
    if (!broken(slab_a.max, slab_b.min) || !broken(slab_b.max, slab_a.min)) return false;
  }
  return true;
}

template class World<1>;
template class World<2>;

}  // namespace kds::collision
