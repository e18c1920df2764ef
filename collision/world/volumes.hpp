// The bounding volumes of a world's bodies.
#pragma once

#include "collision/body_motion.hpp"
#include "collision/broad_phase/kdop.hpp"
#include "collision/broad_phase/kinetic_box.hpp"
#include "collision/broad_phase/swept_box.hpp"
#include "collision/motions.hpp"
#include "collision/shapes/bending_mesh.hpp"
#include "collision/world/bodies.hpp"
#include "collision/world/clock.hpp"
#include "collision/world/turning/turning_extents.hpp"
#include "collision/world/world_part.hpp"
#include "collision/world_options.hpp"
#include "kds/events/dary_queue.hpp"

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace kds::collision {

/// The bounding volume of each body for the broad phase, and until when it contains the body. It is a kinetic box or,
/// for kinetic sweep and prune, perhaps a k-DOP.
///
/// Boxes are made from shape and motion, or by the caller's function. As soon as there is a mesh all boxes include the
/// contact gaps of meshes (mesh_margins.hpp). Most boxes contain their body at all later times; those of meshes that
/// bend only until the next keyframe.
///
/// Cost: O(1) a volume; nothing is stored for bodies whose volumes never end, except for k-DOPs.
template <class Motion>
class Volumes {
 public:
  static constexpr Stage stage = Stage::reported;

  using BoxFunction = typename BasicBodyDescription<Motion>::BoxFunction;
  using Box = KineticBox<Motion::degree>;

  /// Throws std::invalid_argument, naming the option, for a k-DOP that does not exist.
  Volumes(const Bodies<Motion>& bodies, const WorldOptions& options, const Clock& clock);

  /// For the broad phase.
  Kdops<Motion::degree> kdops() const;

  /// Whether some volumes have ends, after which they are renewed.
  bool any_ends() const { return meshes_ || !given_.empty() || !bent_.empty(); }
  /// Whether the volume of the body, a mesh that bends, is that of the present piece of its script only.
  bool bends(BodySlot slot) const { return slot < bent_.size() && bent_[slot]; }
  std::size_t end_of_bent() const { return bent_.size(); }  ///< no slot from this on bends

  /// Adds a body. `function`: the caller's, or an empty one. Throws std::length_error, before anything is changed, if
  /// there is no room.
  void add(BodySlot slot, const BoxFunction& function);
  void remove(BodySlot slot);

  /// A mesh is added: true if it is the first. Then the volumes of all bodies change.
  bool make_room_for_meshes() { return !std::exchange(meshes_, true); }

  /// Whether any body has or had a caller's function; and whether this one has.
  bool any_from_callers() const { return !given_.empty(); }
  bool from_caller(BodySlot slot) const { return slot < given_.size() && given_[slot]; }
  /// Whether a caller's function is making a box at this moment.
  const bool& calling() const { return calling_; }

  /// The present box: the last one of the caller's function, or that of the motion.
  Box box(BodySlot slot) const { return meshes_ ? grown(slot, bare_box(slot)) : bare_box(slot); }
  /// The body has another shape, which bends.
  void shape_changed(BodySlot slot) { note_shape(slot); }
  /// A new box for the present motion. Throws what the caller's function throws, and std::invalid_argument if its box
  /// is not valid. If there are no such functions, several threads may call it at once.
  Box renew(BodySlot slot);
  /// Whether the volumes that the broad phase sees overlap just after t. `exact`: as for the broad phase. The volume of
  /// an unbounded body is all of space; that of another unbounded body does not count.
  bool overlap(BodySlot a, BodySlot b, double t, bool exact) const;

  /// Whether a body's volume, rounded outward, meets a box at t; and whether its swept AABB meets a swept one. If the
  /// caller's function has not been called yet, since the body is still to enter, the box is that around its ball. For
  /// a half-space it is tested whether the box meets the half-space itself.
  bool meets(BodySlot slot, const StaticBox& box, double t) const;
  bool meets_swept(BodySlot slot, const StaticBox& swept, double from, double until) const;

  /// Notes until when the body's box contains it.
  void schedule(BodySlot slot) {
    if (meshes_ || from_caller(slot) || bends(slot)) set_end(slot);
  }
  /// When the next box has to be renewed, and of which body. Precondition of next_body(): next_time() < never.
  double next_time() const { return ends_.empty() ? never : ends_.top().time; }
  BodySlot next_body() const { return ends_.top().slot; }
  static constexpr bool certify() { return false; }
  void extend_horizon();
  /// Throws AuditFailure unless the volume of each body in the broad phase is renewed when it ceases to contain it.
  void audit(double t) const;

  /// All that is not a function of the bodies.
  struct Image : NoImage {
    bool room_for_meshes = false;

    template <class Archive>
    void archive(Archive& archive) {
      archive(room_for_meshes);
    }
  };
  /// Throws std::invalid_argument if a body has a box function, which cannot be saved.
  Image image() const;
  /// No body's volume is a caller's. Those of all bodies are scheduled with schedule().
  void become(const Image& image);

 private:
  struct Given {
    BoxFunction function;
    Box box;  ///< the last one that the function gave
  };

  bool asked(BodySlot slot) const { return bodies_[slot].entered || !from_caller(slot); }
  Box box_or_ball(BodySlot slot) const;
  StaticBox swept(BodySlot slot, double from, double until) const;
  StaticBox swept_path(BodySlot slot, double from, double until) const;
  Box bare_box(BodySlot slot) const;
  Box rigid_box(BodySlot slot) const;
  bool is_round(BodySlot slot) const;
  double end(BodySlot slot) const;
  void set_end(BodySlot slot);
  void note_shape(BodySlot slot);
  void place_extents(BodySlot slot);
  KineticSlab<Motion::degree> slab(BodySlot slot, std::size_t i, double now) const;

  // clearance.cpp: how much larger boxes are than bodies, for the contact gap of meshes
  std::array<double, std::size_t{Motion::degree} + 1> growth(BodySlot slot) const;
  Box grown(BodySlot slot, Box box) const;
  double clearance_until(BodySlot slot) const;

  const Bodies<Motion>& bodies_;
  const WorldOptions& options_;
  const Clock& clock_;
  std::vector<std::unique_ptr<Given>> given_;       ///< by body, up to the last that has had one
  std::vector<std::optional<BendingBounds>> bent_;  ///< by body, up to the last that bends: of the present piece
  std::vector<KdopDirection> directions_;           ///< beyond the axes
  std::vector<std::array<double, 2>> extents_;      ///< by body and direction
  DaryQueue<BodyRank> ends_;                        ///< slots are bodies
  bool meshes_ = false;                             ///< there is or has been one
  bool calling_ = false;
};

/// Whether the volume is around the bounding sphere, which contains the body in every orientation. If not, it is around
/// the shape as it is placed, or (boxes and capsules) as it turns (turning_half_extents()).
template <class Motion>
inline bool Volumes<Motion>::is_round(BodySlot slot) const {
  return turns<Motion> || !bodies_[slot].shape || bodies_[slot].volume == BoundingVolume::sphere;
}

/// The same without room for the contact gap of meshes.
template <class Motion>
inline KineticBox<Motion::degree> Volumes<Motion>::bare_box(BodySlot slot) const {
  if (from_caller(slot)) return given_[slot]->box;
  if (bends(slot)) return box_around<Motion::degree>(bodies_.path(slot), bent_[slot]->low, bent_[slot]->high);
  return rigid_box(slot);
}

/// The same of a body that does not bend and whose volume is not the caller's.
template <class Motion>
inline KineticBox<Motion::degree> Volumes<Motion>::rigid_box(BodySlot slot) const {
  const detail::Body<Motion>& b = bodies_[slot];
  if constexpr (turns<Motion>) {
    // Each piece of a body that precesses has another axis, so its volume is the bounding ball. And pairs are reported
    // of the balls around hulls and meshes.
    if (b.shape && b.volume == BoundingVolume::shape && !b.tumbles &&
        !(options_.report_pairs && takes_corners(b.shape->shape))) {
      const Eigen::Vector3d half_extents = turning_half_extents(*b.shape, bodies_.motion(slot));
      return box_around<Motion::degree>(bodies_.path(slot), -half_extents, half_extents);
    }
  }
  const bool sphere = is_round(slot);
  double radius = b.bounding_radius;
  if constexpr (turns<Motion>) {
    if (b.tumbles && !options_.report_pairs) radius += path_rounding * radius;
  }
  const Eigen::Vector3d half_extents = Eigen::Vector3d::Constant(radius);
  // Not if pairs are reported: these are pairs whose boxes overlap unrounded.
  const double rounding = sphere && !options_.report_pairs ? radius : 0;
  return box_around<Motion::degree>(bodies_.path(slot), sphere ? -half_extents : b.shape->low,
                                    sphere ? half_extents : b.shape->high, rounding);
}

#define KDS_DECLARE(motion) extern template class Volumes<motion>;
KDS_FOR_ALL_MOTIONS(KDS_DECLARE)
#undef KDS_DECLARE

}  // namespace kds::collision
