// The description of a body that is added to a world.
#pragma once

#include "certificates/point_motion.hpp"
#include "collision/body_id.hpp"
#include "collision/broad_phase/kinetic_box.hpp"
#include "collision/quaternion.hpp"
#include "collision/shapes/shape.hpp"

#include <Eigen/Core>

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace kds::collision {

/// The volume that the broad phase sees.
enum class BoundingVolume : std::uint8_t {
  shape,   ///< the tightest box around the shape in its orientation
  sphere,  ///< the box around the bounding sphere: right for a shape in any orientation
};

/// The category of bodies for which none is given.
inline constexpr std::uint32_t default_category = 1;

/// Inertia of a body about its centre, mass * length^2: one moment, the same about all axes; or a tensor, in the axes
/// of the shape; or not given.
class Inertia {
 public:
  Inertia() = default;
  Inertia(double moment) : moment_(moment) {}
  Inertia(const Eigen::Matrix3d& tensor) : tensor_(tensor) {}

  double moment() const { return moment_; }  ///< 0 unless it was given
  const std::optional<Eigen::Matrix3d>& tensor() const { return tensor_; }

 private:
  double moment_ = 0;
  std::optional<Eigen::Matrix3d> tensor_;
};

/// A body to add. Numbers have to be in the range of shape.hpp: sizes and masses from 2^-205 to 2^205 (1.9e-62 to
/// 5.1e61), coefficients and starts of motions up to 2^205 in magnitude. The edges of a mesh, scaled, are at least
/// 2^-110 long, and its coordinates at most 2^100.
template <class BodyMotionType>
struct BasicBodyDescription {
  using Motion = BodyMotionType;
  /// Returns a box that contains the body from time t until the box's valid_until. It must be finite and valid_until
  /// later than t, otherwise the call that needs the box, step() or update_motion(), throws std::invalid_argument. It
  /// may look at the world but must not change it: to add, remove or move bodies, to run, save or load the world from
  /// within it throws std::logic_error. After a bad box, or an exception from the function, the world cannot be used
  /// further: all functions that would run, change, check or save it throw std::logic_error and say why. It can still
  /// be queried, and destroyed.
  using BoxFunction = std::function<KineticBox<Motion::degree>(double t, const Motion& motion)>;

  Shape shape;
  /// A unit quaternion up to 1e-6: the body's orientation, which it keeps. For bodies that turn it must not be given:
  /// their motions contain the orientation.
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  /// One or more pieces, each starting later than the one before. The first may start in the past; if it starts in the
  /// future, the body enters then.
  std::vector<Motion> motion{};
  double mass = 1;  ///< > 0, unless the body is fixed
  /// For bodies that turn: the moment about every axis through the centre, > 0, or a tensor that checked_inertia() in
  /// response/inertia.hpp accepts. If neither is given, or 0: that of a solid with the shape and mass, whose centre of
  /// mass must be at the origin of the shape, up to inertia_tolerance of its radius. If contacts move the body and its
  /// moments differ (not is_spherical()), it precesses (docs/turning.md): the angular velocity of a motion is then that
  /// at the time when the body begins the motion, and the least moment must be at least 2^-40 of the greatest.
  Inertia inertia{};
  bool fixed = false;  ///< infinite mass: no other body changes its motion
  /// In [0, 1]: the speed after a contact over that before. Of two bodies, or a body and the walls, the lower counts.
  double restitution = 1;
  /// For bodies that turn: Coulomb's coefficient, in [0, 2^205]: the tangential part of an impulse is at most this many
  /// times the normal one. Of two bodies the lower counts, so a 0 of either makes the contact smooth; walls are smooth.
  double friction = 0;
  /// For bodies that turn, in [-1, 1]; of two bodies the lower counts. The part of the slip velocity that a contact
  /// reverses, where friction suffices: 1 all (perfectly rough), 0 none (the bodies stick), -1 leaves the slip as it is
  /// (smooth). The law, and why energy never grows: response/turning_impulse.hpp.
  double tangential_restitution = 0;
  /// For bodies that turn: a length, in [0, 2^205]. What presses on such a body at a contact acts up to this far ahead
  /// of it, and so brakes how it turns against the other: with a couple of at most this length times the normal
  /// impulse. Of two bodies the lower counts. A ball with the radius R then slows down on a level floor by 5/7 of the
  /// weight times this over R, and rests where the slope is less than that quotient.
  double rolling_friction = 0;
  std::uint32_t category = default_category;  ///< bits
  std::uint32_t collides_with = ~0u;  ///< mask; a pair is tested if each one's category shares a bit with the other's
  /// Bodies of the same group, unless it is 0, do not collide with each other, whatever their masks.
  std::uint32_t group = 0;
  /// Passes through all bodies and walls, and no other body changes its motion: its contacts and separations are
  /// reported as in mode `none`, whatever the response of the world.
  bool sensor = false;
  /// A body that this one, a sensor, moves with: it has that body's motion, whatever changes it, enters with it and is
  /// removed with it; its own `motion` must be empty. It never meets that body, nor other sensors of it. So a ball of
  /// twice the radius is a proximity alarm.
  std::optional<BodyId> attached_to{};
  /// Of a mesh that bends: its contacts with itself are reported, too, as contacts and separations of the body with the
  /// same body, whatever the response of the world. They cost as much as many bodies (docs/deforming.md).
  bool self_contacts = false;
  std::uint64_t user_data = 0;  ///< the caller's own, for example an index; events carry it
  BoundingVolume volume = BoundingVolume::shape;
  BoxFunction box{};  ///< if given: the caller's own conservative boxes, instead of `volume`
};

/// A body of a World<Degree>.
template <int Degree>
using BodyDescription = BasicBodyDescription<certificates::PointMotion<Degree>>;

}  // namespace kds::collision
