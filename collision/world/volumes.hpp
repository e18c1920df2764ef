// The bounding volumes of a world's bodies.
#pragma once

#include "collision/body_motion.hpp"
#include "collision/broad_phase/kdop.hpp"
#include "collision/broad_phase/kinetic_box.hpp"
#include "collision/broad_phase/swept_box.hpp"
#include "collision/motions.hpp"
#include "collision/world/bodies.hpp"
#include "collision/world/clock.hpp"
#include "collision/world/turning/turning_extents.hpp"
#include "collision/world_options.hpp"
#include "kds/events/dary_queue.hpp"

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

namespace kds::collision {

/// What the broad phase knows of each body: a kinetic box, for kinetic sweep and prune perhaps a k-DOP, and until when
/// they hold the body.
///
/// Boxes are made from shape and motion, or by a function of the caller's. From the first mesh on all have room for the
/// contact gaps of meshes (mesh_margins.hpp). Most hold their body for good.
///
/// Cost: O(1) a volume; nothing is kept of bodies whose volumes hold for good, but for k-DOPs.
template <class Motion>
class Volumes {
 public:
  using BoxFunction = typename BasicBodyDescription<Motion>::BoxFunction;
  using Box = KineticBox<Motion::degree>;

  /// Throws std::invalid_argument, naming the option, for a k-DOP that there is not.
  Volumes(const Bodies<Motion>& bodies, const WorldOptions& options, const Clock& clock);

  /// For the broad phase.
  Kdops<Motion::degree> kdops() const;

  /// A body comes. `function`: the caller's, or an empty one. Throws std::length_error, before anything is changed, if
  /// there is no room.
  void add(BodySlot slot, const BoxFunction& function);
  void remove(BodySlot slot);

  /// The first mesh comes: true if it is. Then the volumes of all bodies are others.
  bool make_room_for_meshes() { return !std::exchange(meshes_, true); }
  bool has_room_for_meshes() const { return meshes_; }

  /// Whether some body has or had a function of the caller's; and this one.
  bool any_from_callers() const { return !given_.empty(); }
  bool from_caller(BodySlot slot) const { return slot < given_.size() && given_[slot]; }
  /// A function of the caller's is making a box just now.
  bool calling() const { return calling_; }

  /// The box as it is: what the caller's function gave last, or what the motion gives.
  Box box(BodySlot slot) const { return meshes_ ? grown(slot, bare_box(slot)) : bare_box(slot); }
  /// A box for the present motion. Throws what the caller's function throws, and std::invalid_argument for a box of its
  /// that cannot be. Where there are no such functions, threads may call it at once.
  Box renew(BodySlot slot);
  /// Whether the volumes that the broad phase sees overlap just after t. `exact`: as for the broad phase.
  bool overlap(BodySlot a, BodySlot b, double t, bool exact) const;

  /// Whether a body's volume, rounded outward, meets a box at t; and what its box sweeps. Where a caller's function has
  /// not been asked yet, as the body is still to enter, it is the box around its ball.
  bool meets(BodySlot slot, const StaticBox& box, double t) const;
  StaticBox swept(BodySlot slot, double from, double until) const;

  /// Takes note of until when the body's box holds it.
  void schedule(BodySlot slot) {
    if (meshes_ || from_caller(slot)) set_end(slot);
  }
  /// When the next box has to be renewed, and whose. Precondition of next_body(): next_time() < never.
  double next_time() const { return ends_.empty() ? never : ends_.top().time; }
  BodySlot next_body() const { return ends_.top().slot; }
  void extend_horizon();

  /// As loaded: no body's volume is a caller's. Those of all bodies are scheduled with schedule().
  void become(bool room_for_meshes);

 private:
  struct Given {
    BoxFunction function;
    Box box;  ///< the last it gave
  };

  bool asked(BodySlot slot) const { return bodies_[slot].entered || !from_caller(slot); }
  Box box_or_ball(BodySlot slot) const;
  Box bare_box(BodySlot slot) const;
  bool is_round(BodySlot slot) const;
  void set_end(BodySlot slot);
  void place_extents(BodySlot slot);
  KineticSlab<Motion::degree> slab(BodySlot slot, std::size_t i, double now) const;

  // clearance.cpp: how far boxes are beyond bodies, for the contact gap of meshes
  std::array<double, std::size_t{Motion::degree} + 1> growth(BodySlot slot) const;
  Box grown(BodySlot slot, Box box) const;
  double clearance_until(BodySlot slot) const;

  const Bodies<Motion>& bodies_;
  const WorldOptions& options_;
  const Clock& clock_;
  std::vector<std::unique_ptr<Given>> given_;   ///< by body, up to the last that has had one
  std::vector<KdopDirection> directions_;       ///< beyond the axes
  std::vector<std::array<double, 2>> extents_;  ///< by body and direction
  DaryQueue<> ends_;                            ///< slots are bodies
  bool meshes_ = false;                         ///< there is or has been one
  bool calling_ = false;
};

/// Whether the volume is around the bounding sphere, which holds the body however it is turned. If not, it is around
/// the shape as it is placed, or (boxes) as it turns (turning_half_extents()).
template <class Motion>
inline bool Volumes<Motion>::is_round(BodySlot slot) const {
  return turns<Motion> || !bodies_[slot].shape || bodies_[slot].volume == BoundingVolume::sphere;
}

/// The same without room for the contact gap of meshes.
template <class Motion>
inline KineticBox<Motion::degree> Volumes<Motion>::bare_box(BodySlot slot) const {
  if (from_caller(slot)) return given_[slot]->box;
  const detail::Body<Motion>& b = bodies_[slot];
  if constexpr (turns<Motion>) {
    // The axis about which a body turns that precesses is another with each piece: its volume is round.
    if (b.shape && b.volume == BoundingVolume::shape && !b.tumbles) {
      const Eigen::Vector3d half_extents = turning_half_extents(*b.shape, bodies_.motion(slot));
      return box_around<Motion::degree>(bodies_.path(slot), -half_extents, half_extents);
    }
  }
  const bool sphere = is_round(slot);
  const Eigen::Vector3d half_extents = Eigen::Vector3d::Constant(b.bounding_radius);
  const double rounding = sphere && !options_.report_pairs ? b.bounding_radius : 0;  // of boxes those are told
  return box_around<Motion::degree>(bodies_.path(slot), sphere ? -half_extents : b.shape->low,
                                    sphere ? half_extents : b.shape->high, rounding);
}

#define KDS_DECLARE(motion) extern template class Volumes<motion>;
KDS_FOR_ALL_MOTIONS(KDS_DECLARE)
#undef KDS_DECLARE

}  // namespace kds::collision
