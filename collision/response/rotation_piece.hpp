// A stretch of turning at a constant rate in place of a body's free rotation.
#pragma once

#include "collision/response/free_rotation.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstddef>

namespace kds::collision {

/// The angular velocity, in the axes of the world, that leads from one orientation to another in a span of time, the
/// shorter way: the logarithm of the rotation between them. Quaternions of any length but 0. Off by 2^-50 rad over the
/// span.
Eigen::Vector3d rate_between(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to, double span);

/// The angle between two orientations, rad.
double angle_between(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b);

/// Turning at a constant rate to where the body is turned by itself.
struct RotationPiece {
  double end;                        ///< s; `never` if the angular velocity does not change
  Eigen::Quaterniond orientation;    ///< of the free rotation at the end, of the principal axes
  Eigen::Vector3d angular_velocity;  ///< rad/s, in the axes of the world
};

/// Greatest turn of a piece, rad.
inline constexpr double longest_turn = 1;

/// The piece that starts at t with the orientation `from`, of the principal axes, and ends in that of the free
/// rotation, which at t is `free`: orientation_at(inertia, state, t). Precondition: a body that is no top has its state
/// at t; that of a top may be of an earlier time. Throws std::runtime_error if it turns by more than longest_turn
/// between two doubles of the clock.
///
/// *How far it is off.* Let a be the greatest angular acceleration during the piece, h its span. Seen from the rotation
/// of the piece, what the body turns otherwise is a vector with second derivative a that vanishes at both ends: at most
/// a h^2 / 8 rad, halfway. Where the piece starts off the free rotation by an angle d, that is d (1 - s) more at the
/// part s of its span. A piece is so long that a h^2 / 8 is `bulge`, with an eighth to spare for what is left out here,
/// that rotations of a radian do not add up like vectors; and it turns by longest_turn at most.
RotationPiece rotation_piece(const PrincipalInertia& inertia, const RotationState& state, double t,
                             const Eigen::Quaterniond& free, const Eigen::Quaterniond& from, double bulge);

/// The last of pieces one after the other.
struct PiecesInARow {
  RotationPiece last{};
  double start;             ///< of the last, s
  Eigen::Quaterniond from;  ///< the orientation in which it starts, of the principal axes
  std::size_t count = 0;
};

/// The pieces from `start` on, up to the first that ends at t or later: those of rotation_piece(), bit for bit, where
/// each starts in the orientation of the free rotation at which the one before ends, and the first in `from`. In less
/// time than one by one. The state of a body that is no top becomes that at the start of the last; that of a top, at
/// `start` or earlier, stays. Throws as rotation_piece().
PiecesInARow pieces_until(double t, const PrincipalInertia& inertia, RotationState& state, double start,
                          const Eigen::Quaterniond& from, double bulge);

}  // namespace kds::collision
