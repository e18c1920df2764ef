// How a rigid body turns that nothing acts on: Euler's free rotation.
//
// The angular momentum keeps its direction in the world and the body turns under it, so the angular velocity does not
// stay the same unless the moments of inertia are equal, or the body turns about a principal axis.
#pragma once

#include "collision/response/principal_inertia.hpp"
#include "kds/arithmetic/ball.hpp"
#include "kds/arithmetic/double_double.hpp"
#include "kds/turning/spin.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <cstddef>
#include <optional>

namespace kds::collision {

/// How a body is turned at a time, and turns from then on.
struct RotationState {
  Eigen::Vector3d momentum = Eigen::Vector3d::Zero();  ///< angular, about the centre, in the axes of the world
  /// From the principal axes to those of the world; of length 1, but for roundings.
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  double time = 0;  ///< s

  friend bool operator==(const RotationState& a, const RotationState& b) {
    return a.momentum == b.momentum && a.orientation.coeffs() == b.orientation.coeffs() && a.time == b.time;
  }
};

/// How a symmetric top turns that does not turn about a principal axis: about its angular momentum, and about its axis.
struct TopSpins {
  Spin precession, own;
  Ball<DoubleDouble> precession_rate, own_rate;

  /// Where a body is turned at t that turns like this, and at the start of the spins is turned as `from` says.
  Eigen::Quaterniond carried(const Eigen::Quaterniond& from, double t) const;
};

/// In the axes of the world, rad/s. It is made with the same rounded inverse moments as inverse_inertia(): if it were
/// not, each impulse would be wrong in the same sense, and the energy of a gas would drift.
Eigen::Vector3d angular_velocity(const PrincipalInertia& inertia, const RotationState& state);
/// The angular momentum of a body with this angular velocity.
Eigen::Vector3d angular_momentum(const PrincipalInertia& inertia, const Eigen::Quaterniond& orientation,
                                 const Eigen::Vector3d& angular_velocity);
/// The inverse of the tensor of inertia in the axes of the world.
Eigen::Matrix3d inverse_inertia(const PrincipalInertia& inertia, const Eigen::Quaterniond& orientation);

/// The free rotation from a state on.
///
/// *Symmetric tops*: R(t) = exp(t [L / I1]) R(0) exp(t [s e]), with e the axis of symmetry, I1 the moment across it,
/// and s = L_e (1 / I_e - 1 / I1). That is exact up to the rounding of its numbers, however long it goes on.
///
/// *Others*: Taylor's series of Euler's equations L' = L x (L / I) in principal axes, together with those of the
/// quaternion, q' = q (L / I) / 2: the terms follow from each other by sums of products. The angular momentum in the
/// body is taken anew from that in the world where a series begins, so that its length never drifts. What is left out
/// is below 2^-58 of the orientation and of the momentum.
///
/// Both are made of + - * / and sqrt and the library's own sine and cosine, so that they are the same bits on every
/// system. Cost: 1 us a top, 0.3 to 2 us others.
class FreeRotation {
 public:
  /// The state has to be there as long as this is.
  FreeRotation(const PrincipalInertia& inertia, const RotationState& state);

  /// Expands the series of a body that is no top so far that it can be used for the next `span` s, or for less where it
  /// converges too slowly: a part of a radian at least. Of a top, keeps what all orientations need, to save that from
  /// the second on.
  void expand(double span);
  /// The time up to which the orientation is known. Of tops, and of bodies that turn about a principal axis, that is
  /// `never`.
  double valid_until() const { return valid_until_; }
  /// From the principal axes to those of the world. Precondition: t is from the state's time to valid_until().
  Eigen::Quaterniond orientation(double t) const;

  /// Whether the body turns about a principal axis, up to what roundings may have made of its angular momentum: then
  /// its angular velocity stays as it is.
  bool steady() const { return steady_; }
  /// That at the state's time, in the axes of the world, rad/s.
  Eigen::Vector3d angular_velocity() const;
  /// The rate at which the angular velocity changes, in principal axes, rad/s^2. Precondition as of orientation(); of a
  /// symmetric top t is the state's time.
  Eigen::Vector3d acceleration(double t) const;
  /// Of a symmetric top that does not turn about a principal axis. Its own spin is that as seen from where its angular
  /// velocity and momentum stay as they are; so, as the body sees it, these turn at that rate.
  TopSpins top_spins() const;

 private:
  static constexpr std::size_t most_terms = 24;

  bool in_closed_form() const { return steady_ || inertia_.symmetry >= 0; }
  double size(std::size_t term) const;

  const PrincipalInertia& inertia_;
  const RotationState& state_;
  double valid_until_;
  double rate_ = 1;                  ///< the unit of rates, a power of two, rad/s
  Eigen::Vector3d own_momentum_;     ///< at the state's time, in principal axes
  Eigen::Vector3d inverse_;          ///< of the moments
  Eigen::Vector3d inverse_moments_;  ///< in units in which momenta and rates are about 1
  bool steady_ = false;
  std::optional<TopSpins> top_spins_;
  std::size_t terms_ = 0;
  std::array<Eigen::Vector3d, most_terms + 1> momentum_;
  std::array<Eigen::Vector4d, most_terms + 1> quaternion_;  ///< as Eigen has it: x, y, z, w
};

/// The orientation at t >= state.time, however far.
Eigen::Quaterniond orientation_at(const PrincipalInertia& inertia, const RotationState& state, double t);

}  // namespace kds::collision
