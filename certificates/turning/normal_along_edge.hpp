// How the plane of a face of a body that turns leans towards an edge of another.
#pragma once

#include "certificates/turning/extended_pose.hpp"
#include "certificates/turning/rigid_motion.hpp"
#include "certificates/turning/turned_vector.hpp"
#include "certificates/turning/turning_terms.hpp"
#include "kds/turning/turning_certificate.hpp"

#include <array>
#include <cstddef>

namespace kds::certificates {

/// N(t) . v(t) >= 0, times a positive number: N = (corner 1 - corner 0) x (corner 2 - corner 0) is the normal of a
/// triangle of body a, v the direction of an edge of body b. Zero while the edge is parallel to the plane.
///
/// With the edge u from corner 0 to corner 1, N . v is -(u x v) . (corner 2 - corner 0): on which side of the edge the
/// triangle is, seen along the product of both edges. Where the bodies are does not matter, so that the polynomials are
/// constants; they are written as of degree 1. It is multiplied by both scales (Turner).
template <int Degree>
struct NormalAlongEdge {
  static constexpr int degree = 1;
  const RigidMotion<Degree>& a;
  const RigidMotion<Degree>& b;
  std::array<Eigen::Vector3d, 3> corners;  ///< of a
  std::array<Eigen::Vector3d, 2> edge;     ///< of b: from, to

  std::array<Spin, 2> spins() const { return {a.spin(), b.spin()}; }

  template <class Number, int Order>
  TurningSum<Order, Number> turning_sum(double) const {
    const VectorOf<Number> normal =
        cross(difference_of<Number>(corners[0], corners[1]), difference_of<Number>(corners[0], corners[2]));
    TurningSum<Order, Number> f;
    add_product(f, Turner<Number>(a)(normal), Turner<Number>(b)(difference_of<Number>(edge[0], edge[1])));
    return f;
  }

  template <class Number>
  Number value_at_start(double) const {
    const VectorOf<Number> normal =
        cross(difference_of<Number>(corners[0], corners[1]), difference_of<Number>(corners[0], corners[2]));
    return dot(Turner<Number>(a).at_start(normal), Turner<Number>(b).at_start(difference_of<Number>(edge[0], edge[1])));
  }

  /// Error bound, with u = 2^-53 and lengths bounded by sums of magnitudes, L1, L2 of the edges of the normal and L of
  /// the edge: the normal is known to 5 u L1 L2, the edge to u L; both are turned with the errors r1, r2, and their
  /// product errs by 3 u: L1 L2 L (r1 + r2 + 9 u), and products of two errors; 16 u is charged.
  Ball<double> quick_value(double t) const {
    const Rotation turn_a = a.rotation(t);
    const Rotation turn_b = b.rotation(t);
    const Eigen::Vector3d first = corners[1] - corners[0];
    const Eigen::Vector3d second = corners[2] - corners[0];
    const Eigen::Vector3d v = edge[1] - edge[0];
    const double size = magnitude_sum(v);
    return bounded_value(dot(turn_a(cross(first, second)), turn_b(v)), magnitude_sum(first) * magnitude_sum(second),
                         size, size * (turn_a.error() + turn_b.error() + 0x1p-49));
  }

  /// The same in double-doubles, times both scales: with d in place of u.
  Ball<DoubleDouble> extended_value(double t) const {
    const ExtendedPose pose_a(a, t);
    const ExtendedPose pose_b(b, t);
    const ExtendedVector first = exact_difference(corners[0], corners[1]);
    const ExtendedVector second = exact_difference(corners[0], corners[2]);
    const ExtendedVector v = exact_difference(edge[0], edge[1]);
    const double size = magnitude_sum(v);
    return bounded_value(dot(pose_a(cross(first, second)), pose_b(v)), pose_a.scale() * pose_b.scale(),
                         magnitude_sum(first) * magnitude_sum(second), size,
                         size * (pose_a.error() + pose_b.error() + 16 * extended_unit));
  }
};

}  // namespace kds::certificates
