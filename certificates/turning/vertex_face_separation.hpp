// A vertex of a body that turns beyond the plane of a face of another.
#pragma once

#include "certificates/turning/extended_pose.hpp"
#include "certificates/turning/rigid_motion.hpp"
#include "certificates/turning/turned_vector.hpp"
#include "certificates/turning/turning_terms.hpp"
#include "kds/turning/turning_certificate.hpp"

#include <array>
#include <cstddef>

namespace kds::certificates {

/// n(t) . (x(t) - p(t)) >= 0, times a positive number: the vertex x of body a is on the side of the plane of a triangle
/// of body b to which its normal n = (corner 1 - corner 0) x (corner 2 - corner 0) points, or in it.
///
/// Vertex and corners are in the coordinates of their bodies. f = N . (o_a - o_b) + X . N - n . corner 0, in capitals
/// what turns; it is multiplied by both scales (Turner). A triangle without an area gives f = 0.
template <int Degree>
struct VertexFaceSeparation {
  static constexpr int degree = Degree;
  const RigidMotion<Degree>& a;
  const RigidMotion<Degree>& b;
  Eigen::Vector3d vertex;                  ///< of a
  std::array<Eigen::Vector3d, 3> corners;  ///< of b, counter-clockwise seen from outside

  std::array<Spin, 2> spins() const { return {a.spin(), b.spin()}; }

  template <class Number, int Order>
  TurningSum<Order, Number> turning_sum(double epoch) const {
    const Turner<Number> turn_a(a);
    const Turner<Number> turn_b(b);
    const VectorOf<Number> normal =
        cross(difference_of<Number>(corners[0], corners[1]), difference_of<Number>(corners[0], corners[2]));
    const TurnedVector<Number> n = turn_b(normal);
    const auto way = way_between<Number, Order>(b.path, a.path, epoch);
    TurningSum<Order, Number> f;
    add_product(f, turn_a(vector_of<Number>(vertex)), n);
    for (std::size_t j = 0; j < 3; ++j) {
      if (!adds_nothing(n[j])) f.p[0][j] = f.p[0][j] + along(n[j] * turn_a.scale(), way);
    }
    const Number height = dot(normal, vector_of<Number>(corners[0]));
    f.p[0][0].c[0] = f.p[0][0].c[0] - height * turn_a.scale() * turn_b.scale();
    return f;
  }

  template <class Number>
  Number value_at_start(double t) const {
    const Turner<Number> turn_a(a);
    const Turner<Number> turn_b(b);
    const VectorOf<Number> normal =
        cross(difference_of<Number>(corners[0], corners[1]), difference_of<Number>(corners[0], corners[2]));
    const VectorOf<Number> n = turn_b.at_start(normal);
    return dot(turn_a.at_start(vector_of<Number>(vertex)), n) +
           turn_a.scale_at_start() * (dot(n, way_at<Number>(b.path, a.path, t)) -
                                      turn_b.scale_at_start() * dot(normal, vector_of<Number>(corners[0])));
  }

  /// Error bound, with u = 2^-53 and lengths bounded by sums of magnitudes: L1 L2 for the edges of the normal, which is
  /// known to 5 u of that and is turned; G for the vector g from the origin of b to the vertex, with its error e; B for
  /// corner 0. N . g errs by L1 L2 (e + G (r + 5 u + 3 u)), r the error of turning; n . corner 0 by L1 L2 B (5 u + 3
  /// u); the difference by u of either: 16 u is charged for each of the two.
  Ball<double> quick_value(double t) const {
    const Eigen::Vector3d first = corners[1] - corners[0];
    const Eigen::Vector3d second = corners[2] - corners[0];
    const Eigen::Vector3d normal = cross(first, second);
    const double lengths = magnitude_sum(first) * magnitude_sum(second);
    const Rotation turn_b = b.rotation(t);
    const BoundedVector x = a.position(vertex, t);
    const BoundedVector o = b.origin(t);
    const Eigen::Vector3d g = x.vector - o.vector;
    const double size = magnitude_sum(g);
    const double value = dot(turn_b(normal), g) - dot(normal, corners[0]);
    const double error = x.error + o.error + size * (turn_b.error() + 0x1p-49) + 0x1p-49 * magnitude_sum(corners[0]);
    return bounded_value(value, lengths, size + magnitude_sum(corners[0]), error);
  }

  /// The same in double-doubles, times both scales: with d in place of u.
  Ball<DoubleDouble> extended_value(double t) const {
    const ExtendedPose pose_a(a, t);
    const ExtendedPose pose_b(b, t);
    const ExtendedVector first = exact_difference(corners[0], corners[1]);
    const ExtendedVector second = exact_difference(corners[0], corners[2]);
    const ExtendedVector normal = cross(first, second);
    const ExtendedVector between = pose_a.origin() - pose_b.origin();
    const ExtendedVector g = between + pose_a(vector_of<DoubleDouble>(vertex));
    const double size = magnitude_sum(between) + magnitude_sum(vertex);
    const double error = pose_a.origin_error() + pose_b.origin_error() + pose_a.error() * magnitude_sum(vertex) +
                         size * (pose_b.error() + 16 * extended_unit) + 16 * extended_unit * magnitude_sum(corners[0]);
    return bounded_value(dot(pose_b(normal), g) - dot(normal, vector_of<DoubleDouble>(corners[0])),
                         pose_a.scale() * pose_b.scale(), magnitude_sum(first) * magnitude_sum(second),
                         size + magnitude_sum(corners[0]), error);
  }
};

}  // namespace kds::certificates
