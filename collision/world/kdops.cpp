// The k-DOPs of the world's bodies.
#include "collision/broad_phase/swept_box.hpp"
#include "collision/vectors.hpp"
#include "collision/world.hpp"
#include "structures/extents.hpp"

#include <algorithm>
#include <stdexcept>

namespace kds::collision {
namespace {

/// Whether two boxes overlap, rounded as they say, by more than what is rounded here can feign.
template <int Degree>
bool surely_overlap_rounded(const KineticBox<Degree>& a, const KineticBox<Degree>& b, double now) {
  const double radius = a.rounding + b.rounding;
  const StaticBox box_a = box_at(a, now);
  const StaticBox box_b = box_at(b, now);
  const double coordinates = std::max(box_a.min.abs().max(box_a.max.abs()).maxCoeff(), radius);
  const Eigen::Array3d gap = ((box_a.min - box_b.max).max(box_b.min - box_a.max) + radius).max(0);
  return radius == 0 || norm(gap.matrix()) < radius * (1 - 0x1p-18) - 0x1p-44 * coordinates;
}

}  // namespace

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
      const double radius = b.bounding_radius * norm(direction) * (1 + 0x1p-48);
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
    KineticSlab<Degree> slab = slab_around(movers_[id].motion, low, high, directions_[i]);
    if (!meshes_) return slab;
    const auto by = growth(id);
    const double length = norm(Eigen::Vector3d(directions_[i].data())) * (1 + 0x1p-48);
    for (std::size_t k = 0; k <= Degree; ++k) {
      slab.min.position.c[k] -= by[k] * length;
      slab.max.position.c[k] += by[k] * length;
    }
    return slab;
  }
  return slab_around(bounding_box(id), directions_[i], now);
}

/// Whether the volumes that the broad phase sees overlap at t+.
template <int Degree>
bool World<Degree>::volumes_overlap(BodyId a, BodyId b, double t) const {
  const auto broken = [t](const kds::Motion<Degree>& left, const kds::Motion<Degree>& right) {
    return sign_after(certificates::Order<Degree>{left, right}, t) < 0;
  };
  const KineticBox<Degree> box_a = bounding_box(a);
  const KineticBox<Degree> box_b = bounding_box(b);
  const BoxOverlap<Degree> boxes(box_a, box_b);
  for (const auto& side : boxes.separations()) {
    if (sign_after(side, t) >= 0) return false;
  }
  if (!broad_phase_->exact() && !surely_overlap_rounded(box_a, box_b, t)) return false;
  for (std::size_t i = 0; i < directions_.size(); ++i) {
    const KineticSlab<Degree> slab_a = slab(a, i, t);
    const KineticSlab<Degree> slab_b = slab(b, i, t);
    if (!broken(slab_a.max, slab_b.min) || !broken(slab_b.max, slab_a.min)) return false;
  }
  return true;
}

template class World<1>;
template class World<2>;

}  // namespace kds::collision
