// A stretch of turning at a constant rate in place of a body's free rotation.
#pragma once

#include "collision/response/free_rotation.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstddef>
#include <optional>

namespace kds::collision {

/// The angular velocity, in the axes of the world, that leads from one orientation to another in a span of time, the
/// shorter way: the logarithm of the rotation between them. Quaternions of any length but 0. Off by 2^-50 rad over the
/// span.
Eigen::Vector3d rate_between(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to, double span);

/// The angle between two orientations, rad.
double angle_between(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b);

/// Turning at a constant rate, near a free rotation. Orientations are those of the principal axes.
struct RotationPiece {
  double end;                        ///< s; `never` if the angular velocity does not change
  Eigen::Quaterniond from;           ///< the orientation in which it starts
  Eigen::Vector3d angular_velocity;  ///< rad/s, in the axes of the world
  Eigen::Quaterniond to;             ///< that to which it leads
  /// Of a body that is no symmetric top: the orientation of the free rotation at the end.
  Eigen::Quaterniond ahead = Eigen::Quaterniond::Identity();
};

/// Greatest turn of a piece, rad.
inline constexpr double longest_turn = 1;

// How far pieces are off the free rotation. Let a be its greatest angular acceleration during a piece, h the span of
// that. Seen from the rotation of the piece, what the body turns otherwise is a vector with second derivative a: where
// it vanishes at both ends it is at most B = a h^2 / 8 rad, halfway. So a polygon whose corners are on a curve is off
// by B at most; one whose corners are outside of the curve by half of that is off by B / 2 only. So pieces *lean*: they
// begin and end turned by up to `error`, the most that they may be off, against the acceleration, and are so long that
// B is that and `error` together, or less where the acceleration changes its direction from end to end.
//
// What begins elsewhere, off by some angle d, is led to the free rotation first: by a piece for which B is error / 4,
// so that at the part s of its span it is off by no more than d (1 - s) + 4 B s (1 - s), at most d if d >= error. From
// there the next piece leads to where bodies lean; that B is error keeps it from being off by more.
//
// That rotations of t rad do not add up like vectors is charged by t^2 / 8 of B. A piece turns by longest_turn at most.

/// The piece that starts at the time of the state in the orientation `from`, of the principal axes, where a contact or
/// a caller has left the body, and ends in that of the free rotation. Throws std::runtime_error if it turns by more
/// than longest_turn between two doubles of the clock.
RotationPiece leading_piece(const PrincipalInertia& inertia, const RotationState& state, const Eigen::Quaterniond& from,
                            double error);

/// The pieces of a symmetric top that does not turn about a principal axis. Seen from where its angular momentum and
/// velocity stay as they are, they are all the same but for the first, which begins in the orientation of the state:
/// each lasts equally long, and turns about the same axis at the same rate. These are their times, and the piece that
/// leads to the free rotation. After most contacts nothing more is asked of a state: when that piece ends, another
/// state takes its place.
class TopSpans {
 public:
  /// The rotation is that from the state on, and not steady.
  TopSpans(const RotationState& state, const FreeRotation& rotation, double error);
  bool are_of(const RotationState& state) const { return state_ == state; }

  /// Whether roundings of the clock change the spans of pieces near t by less than 2^-15 of them.
  bool equal_near(double t) const { return equal_to(0x1p-36, t); }
  /// Whether a piece ends at t, or begins with the state.
  bool ends_at(double t) const;
  /// The number of the one that ends near t, counted from the state.
  double number_at(double t) const;
  double end(double number) const;

  /// The one that starts at the time of the state in another orientation.
  RotationPiece leading(const Eigen::Quaterniond& from) const;
  /// The free rotation at t.
  Eigen::Quaterniond free(double t) const { return spins_.carried(state_.orientation, t); }

 protected:
  bool equal_to(double part, double t) const;
  double longest(double bulge) const;

  RotationState state_;
  TopSpins spins_;
  double rate_, acceleration_;  ///< magnitudes
  double span_ = 0, leading_span_;
};

/// The pieces themselves: what they need is calculated once for a state.
class TopPieces : public TopSpans {
 public:
  /// `rotation` and `error` are those of the spans.
  TopPieces(const TopSpans& spans, const FreeRotation& rotation, double error);

  /// The piece that starts at t, at which one ends, or at the time of the state. Precondition: spans are equal near t.
  /// `to` is left out.
  RotationPiece piece(double t) const;

 private:
  Eigen::Quaterniond leaning_;        ///< at the time of the state
  Eigen::Vector3d angular_velocity_;  ///< of the piece that begins then
};

/// The last of pieces one after the other.
struct PiecesInARow {
  RotationPiece last;
  double start;  ///< of the last, s
  std::size_t count;
};

/// The pieces after one that ends at `start`, up to the first that ends at t or later; `before`: of that one are taken
/// `to` and `ahead`. Each leans at its end. The state follows: that of a body that is no symmetric top is at the start
/// of the last piece; that of a top stays, as its pieces are those of TopPieces, however many for the cost of one; but
/// if none of these ends at `start`, it is at that. Where roundings of the clock make their spans differ, leading
/// pieces take their place. `known`: what is known of a top's pieces, and is to be known next time; it changes no bit.
/// Throws as leading_piece().
PiecesInARow pieces_until(double t, const PrincipalInertia& inertia, RotationState& state, double start,
                          const RotationPiece& before, double error, std::optional<TopPieces>& known);

}  // namespace kds::collision
