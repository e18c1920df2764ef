#include "collision/world/volumes.hpp"

#include "collision/broad_phase/box_overlap.hpp"
#include "collision/broad_phase/swept_box.hpp"
#include "collision/motions.hpp"
#include "collision/narrow_phase/half_space_of.hpp"
#include "collision/narrow_phase/kept_rotation.hpp"
#include "collision/vectors.hpp"
#include "collision/world/queue_room.hpp"
#include "kds/audit.hpp"
#include "kds/raised_flag.hpp"
#include "structures/extents.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace kds::collision {
namespace {

std::vector<KdopDirection> directions_of(const WorldOptions& options) {
  const int k = options.kdop;
  if (k == 6) return {};
  if (k != 14 && k != 18 && k != 26) throw std::invalid_argument("WorldOptions.kdop: must be 6, 14, 18 or 26");
  if (options.broad_phase != BroadPhaseKind::kinetic_sap) {
    throw std::invalid_argument("WorldOptions.kdop: more than 6 is for kinetic sweep and prune alone");
  }
  const auto all = structures::kdop_directions(k);
  return {all.begin() + 3, all.end()};
}

/// The half-space of a body that is one, in world orientation.
template <class Motion>
HalfSpace half_space(const Bodies<Motion>& bodies, BodySlot slot) {
  return half_space_of(*bodies[slot].shape, bodies.motion(slot));
}

/// Whether a half-space, with its centre somewhere in a box, may have a point of another box: rounded outward. Either
/// box may be infinite.
bool reaches(const HalfSpace& plane, const StaticBox& centre, const StaticBox& box) {
  double lowest = -plane.offset, size = std::abs(plane.offset);
  for (int d = 0; d < 3; ++d) {
    const double n = plane.normal[d];
    if (n == 0) continue;
    const double least = n > 0 ? box.min[d] - centre.max[d] : box.max[d] - centre.min[d];
    lowest += n * least;
    size += std::abs(n) * (std::abs(n > 0 ? centre.max[d] : centre.min[d]) + std::abs(least));
  }
  constexpr double roundings = 0x1p-48;
  return !(lowest > roundings * size);
}

/// Whether two boxes overlap, with their rounded edges, by more than the rounding errors of this test.
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

template <class Motion>
Volumes<Motion>::Volumes(const Bodies<Motion>& bodies, const WorldOptions& options, const Clock& clock)
    : bodies_(bodies),
      options_(options),
      clock_(clock),
      directions_(directions_of(options)),
      ends_(BodyRank{&bodies.keys()}) {}

template <class Motion>
Kdops<Motion::degree> Volumes<Motion>::kdops() const {
  if (directions_.empty()) return {};
  return {directions_, [this](BodySlot slot, std::size_t i, double now) { return slab(slot, i, now); }};
}

template <class Motion>
void Volumes<Motion>::add(BodySlot slot, const BoxFunction& function) {
  if (!function) return note_shape(slot);
  if (!directions_.empty()) place_extents(slot);
  make_room(ends_, bodies_.slots());
  if (given_.size() <= slot) given_.resize(slot + std::size_t{1});
  given_[slot] = std::make_unique<Given>(Given{function, {}});
}

/// Computes the bounds of a body that is new, has another shape, or begins the next piece of its script. Its volume is
/// not the caller's.
template <class Motion>
void Volumes<Motion>::note_shape(BodySlot slot) {
  if (bodies_.unbounded(slot)) return;
  const detail::Body<Motion>& b = bodies_[slot];
  if (b.shape && collision::bends(b.shape->shape) && b.volume == BoundingVolume::shape && !from_caller(slot)) {
    if (bent_.size() <= slot) bent_.resize(slot + std::size_t{1});
    bent_[slot] = bending_bounds(*b.shape, kept_rotation(*b.shape, bodies_.motion(slot)), clock_.now);
  }
  if (!directions_.empty()) place_extents(slot);
}

template <class Motion>
void Volumes<Motion>::remove(BodySlot slot) {
  clear(ends_, slot);
  if (bends(slot)) bent_[slot].reset();
  if (from_caller(slot)) given_[slot] = nullptr;
}

template <class Motion>
KineticBox<Motion::degree> Volumes<Motion>::renew(BodySlot slot) {
  if (!any_ends()) [[likely]]
    return rigid_box(slot);
  if (bends(slot)) note_shape(slot);
  if (!from_caller(slot)) return box(slot);
  const Box made = [&] {
    const kds::detail::RaisedFlag calling(calling_);
    return given_[slot]->function(clock_.now, bodies_.motion(slot));
  }();
  if (!made.min.finite() || !made.max.finite()) {
    throw std::invalid_argument("BodyDescription.box: returned a box that is not finite");
  }
  if (!(made.valid_until > clock_.now)) {
    throw std::invalid_argument("BodyDescription.box: returned a box whose validity has ended");
  }
  given_[slot]->box = made;
  return box(slot);
}

/// Until when the present volume contains the body; `never` if that is after the horizon.
template <class Motion>
double Volumes<Motion>::end(BodySlot slot) const {
  double until = from_caller(slot) ? given_[slot]->box.valid_until : clearance_until(slot);
  if (bends(slot)) until = std::min(until, bent_[slot]->until);
  return until <= clock_.horizon ? until : never;
}

template <class Motion>
void Volumes<Motion>::set_end(BodySlot slot) {
  if (bodies_.unbounded(slot)) return;
  const double until = end(slot);
  if (until < never) {
    make_room(ends_, bodies_.slots());
    ends_.set(slot, until);
  } else {
    clear(ends_, slot);
  }
}

template <class Motion>
void Volumes<Motion>::extend_horizon() {
  if (!any_ends()) return;
  for (BodySlot slot = 0; slot < bodies_.slots(); ++slot) {
    if (bodies_[slot].entered) schedule(slot);
  }
}

template <class Motion>
void Volumes<Motion>::audit(double t) const {
  if (next_time() < t) throw AuditFailure("World: a bounding volume should have been renewed");
  for (BodySlot slot = 0; slot < bodies_.slots() && any_ends(); ++slot) {
    if (!bodies_[slot].entered || !bodies_.in_broad_phase(slot)) continue;
    if (bodies_.left_alone(slot)) continue;  // Its box is of a piece that has passed.
    if ((slot < ends_.slots() ? ends_.time(slot) : never) == end(slot)) continue;
    throw AuditFailure("World: body " + std::to_string(bodies_.id_of(slot)) +
                       ": the end of its bounding volume is not in the queue");
  }
}

template <class Motion>
typename Volumes<Motion>::Image Volumes<Motion>::image() const {
  for (BodySlot slot = 0; slot < given_.size(); ++slot) {
    if (!given_[slot]) continue;
    throw std::invalid_argument("World: body " + std::to_string(bodies_.id_of(slot)) +
                                " cannot be saved: it has a box function");
  }
  Image image;
  image.room_for_meshes = meshes_;
  return image;
}

template <class Motion>
void Volumes<Motion>::become(const Image& image) {
  meshes_ = image.room_for_meshes;
  given_.clear();
  bent_.clear();
  ends_.resize(0);
  for (BodySlot slot = 0; slot < bodies_.slots(); ++slot) {
    if (bodies_.alive(slot)) note_shape(slot);
  }
}

/// The extents of a body in the directions beyond the axes: unless it bends they do not change, since it does not turn
/// or its volume is round.
template <class Motion>
void Volumes<Motion>::place_extents(BodySlot slot) {
  const detail::Body<Motion>& b = bodies_[slot];
  extents_.resize(std::max(extents_.size(), (slot + std::size_t{1}) * directions_.size()));
  for (std::size_t i = 0; i < directions_.size(); ++i) {
    const Eigen::Vector3d direction(directions_[i].data());
    auto& half_extents = extents_[slot * directions_.size() + i];
    if (is_round(slot)) {
      const double radius = b.bounding_radius * norm(direction) * (1 + 0x1p-48);
      half_extents = {-radius, radius};
    } else {
      half_extents =
          bends(slot) ? bending_extent(*b.shape, kept_rotation(*b.shape, bodies_.motion(slot)), direction, clock_.now)
                      : extent(*b.shape, direction);
    }
  }
}

/// The slab of a body along a direction from now on.
template <class Motion>
KineticSlab<Motion::degree> Volumes<Motion>::slab(BodySlot slot, std::size_t i, double now) const {
  const auto& [low, high] = extents_[slot * directions_.size() + i];
  if (!from_caller(slot) && bodies_.path(slot).start <= now) {
    KineticSlab<Motion::degree> slab = slab_around(bodies_.path(slot), low, high, directions_[i]);
    if (!meshes_) return slab;
    const auto by = growth(slot);
    const double length = norm(Eigen::Vector3d(directions_[i].data())) * (1 + 0x1p-48);
    for (std::size_t k = 0; k <= Motion::degree; ++k) {
      slab.min.position.c[k] -= by[k] * length;
      slab.max.position.c[k] += by[k] * length;
    }
    return slab;
  }
  return slab_around(box(slot), directions_[i], now);
}

template <class Motion>
bool Volumes<Motion>::overlap(BodySlot a, BodySlot b, double t, bool exact) const {
  if (bodies_.unbounded(a) || bodies_.unbounded(b)) return !(bodies_.unbounded(a) && bodies_.unbounded(b));
  const auto broken = [t](const kds::Motion<Motion::degree>& left, const kds::Motion<Motion::degree>& right) {
    return sign_after(certificates::Order<Motion::degree>{left, right}, t) < 0;
  };
  const Box box_a = box(a);
  const Box box_b = box(b);
  const BoxOverlap<Motion::degree> boxes(box_a, box_b);
  for (const auto& side : boxes.separations()) {
    if (sign_after(side, t) >= 0) return false;
  }
  if (!exact && !surely_overlap_rounded(box_a, box_b, t)) return false;
  for (std::size_t i = 0; i < directions_.size(); ++i) {
    const KineticSlab<Motion::degree> slab_a = slab(a, i, t);
    const KineticSlab<Motion::degree> slab_b = slab(b, i, t);
    if (!broken(slab_a.max, slab_b.min) || !broken(slab_b.max, slab_a.min)) return false;
  }
  return true;
}

template <class Motion>
KineticBox<Motion::degree> Volumes<Motion>::box_or_ball(BodySlot slot) const {
  if (asked(slot)) return box(slot);
  const Eigen::Vector3d half_extents = Eigen::Vector3d::Constant(bodies_[slot].bounding_radius);
  return box_around<Motion::degree>(bodies_.path(slot), -half_extents, half_extents);
}

template <class Motion>
bool Volumes<Motion>::meets(BodySlot slot, const StaticBox& box, double t) const {
  if (bodies_.unbounded(slot)) return reaches(half_space(bodies_, slot), swept_path(slot, t, t), box);
  if (!box_at(box_or_ball(slot), t).overlaps(box)) return false;
  for (std::size_t i = 0; i < directions_.size() && asked(slot); ++i) {
    const auto [low, high] = slab_at(slab(slot, i, t), t);
    const auto [from, to] = span_along(directions_[i], box);
    if (low > to || from > high) return false;
  }
  return true;
}

template <class Motion>
StaticBox Volumes<Motion>::swept(BodySlot slot, double from, double until) const {
  if (!bends(slot)) return bounded_swept_box(box_or_ball(slot), from, until);
  // Around all keyframes.
  const PlacedShape& shape = *bodies_[slot].shape;
  Eigen::Vector3d low = shape.low, high = shape.high;
  if constexpr (turns<Motion>) {  // in any orientation
    high = Eigen::Vector3d::Constant(shape.bounding_radius);
    low = -high;
  }
  return bounded_swept_box(grown(slot, box_around<Motion::degree>(bodies_.path(slot), low, high)), from, until);
}

/// Of its centre.
template <class Motion>
StaticBox Volumes<Motion>::swept_path(BodySlot slot, double from, double until) const {
  const Eigen::Vector3d none = Eigen::Vector3d::Zero();
  return bounded_swept_box(box_around<Motion::degree>(bodies_.path(slot), none, none), from, until);
}

template <class Motion>
bool Volumes<Motion>::meets_swept(BodySlot slot, const StaticBox& swept, double from, double until) const {
  if (bodies_.unbounded(slot)) return reaches(half_space(bodies_, slot), swept_path(slot, from, until), swept);
  return this->swept(slot, from, until).overlaps(swept);
}

#define KDS_INSTANTIATE(motion) template class Volumes<motion>;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
