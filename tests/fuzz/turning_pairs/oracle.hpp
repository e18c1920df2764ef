// Conservative advancement of convex pieces that turn, in long doubles: an oracle that shares no code with the library.
#pragma once

#include "certificates/turning/rigid_motion.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace turning_pairs {

using Number = long double;
using Vector = std::array<Number, 3>;

/// The convex hull of points of a body, grown by a radius.
struct Piece {
  std::vector<Vector> points;
  std::vector<Vector> normals;  ///< of faces
  std::vector<Vector> edges;    ///< directions
  Number radius = 0;
  std::vector<std::array<std::size_t, 2>> segments;  ///< edges by their ends, of pieces that may be near a capsule
  bool is_half_space = false;                        ///< all that is below its only point along its only normal
  bool of_mesh = false;                              ///< a triangle of one
  /// A hull is solid to other solids, and its surface to meshes.
  enum class Counts { always, with_solids, with_meshes } counts = Counts::always;

  bool meets(const Piece& other) const {
    return counts == Counts::always || (counts == Counts::with_meshes) == other.of_mesh;
  }
};

Piece half_space_piece(const Eigen::Vector3d& normal, double offset);

Piece ball_piece(double radius);
Piece capsule_piece(double radius, double half_length);
Piece box_piece(const Eigen::Vector3d& half);
/// The corners of a polytope, the normals of its faces, and its edges by their ends.
Piece polytope_piece(const std::vector<Eigen::Vector3d>& corners, const std::vector<Eigen::Vector3d>& normals,
                     const std::vector<std::array<std::size_t, 2>>& edges);
Piece triangle_piece(const std::array<Eigen::Vector3d, 3>& corners);

/// A body: its pieces, and its motion of degree 2 at most.
struct Body {
  std::vector<Piece> pieces;
  std::array<Eigen::Vector3d, 3> path;  ///< coefficients
  double start;
  Eigen::Quaterniond orientation;
  Eigen::Vector3d angular_velocity;
};

template <int Degree>
Body body_of(const kds::certificates::RigidMotion<Degree>& motion) {
  Body body;
  for (std::size_t k = 0; k < 3; ++k) body.path[k] = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k <= Degree; ++k) body.path[k] = motion.path.coefficients[k];
  body.start = motion.path.start;
  body.orientation = motion.orientation;
  body.angular_velocity = motion.angular_velocity;
  return body;
}

enum class Verdict {
  right,
  late,       ///< the two are deeper in each other before, or at the horizon if no contact is reported
  early,      ///< they do not touch when they are said to
  undecided,  ///< it took too many steps
};

/// Whether `contact` (> horizon: none) is when two bodies first penetrate in [t0, horizon], up to the oracle's error,
/// which is 2^-50 of the lengths.
///
/// A half-space comes first.
///
/// Method. Two convex pieces are apart by the greatest of their gaps along the normals of faces and the products of
/// edges. (With a ball, also along the way to its nearest point; with a capsule, along the ways between corners, and
/// from corners to edges; with a half-space only along its normal.) Along that direction n, which stays as it is, the
/// distance of each point of b from each of a is at least g + r s - B s^2 / 2 after s, where B bounds accelerations:
/// until the first of these reaches -error they are no deeper than that, and then they are looked at again. It is a
/// proof, so nothing can be passed over; with an error that is not zero it comes to an end.
Verdict check(const Body& a, const Body& b, double t0, double horizon, double contact, int* steps);

}  // namespace turning_pairs
