// Edges of two bodies that turn: on which side of each other their lines pass.
#pragma once

#include "certificates/turning/extended_pose.hpp"
#include "certificates/turning/rigid_motion.hpp"
#include "certificates/turning/turned_vector.hpp"
#include "certificates/turning/turning_terms.hpp"
#include "kds/turning/turning_certificate.hpp"

#include <array>
#include <cstddef>

namespace kds::certificates {

/// (u(t) x v(t)) . (x(t) - y(t)) >= 0, times a positive number: u and v are the directions of an edge of body a and of
/// one of body b, x and y points on them. Zero means coplanar: the lines meet or are parallel. With the ends of one
/// edge exchanged the sign is the other.
///
/// The ends are in the coordinates of their bodies. With the moments m = x0 x x1 of the edges about the origins o of
/// their bodies [Plücker1865] f = U . (V x (o_a - o_b)) + M_a . V + U . M_b, in capitals what turns: each term is
/// linear in what turns with a and in what turns with b. It is multiplied by both scales (Turner).
template <int Degree>
struct EdgeEdgeSeparation {
  static constexpr int degree = Degree;
  const RigidMotion<Degree>& a;
  const RigidMotion<Degree>& b;
  std::array<Eigen::Vector3d, 2> edge_a;  ///< from, to
  std::array<Eigen::Vector3d, 2> edge_b;

  std::array<Spin, 2> spins() const { return {a.spin(), b.spin()}; }

  template <class Number, int Order>
  TurningSum<Order, Number> turning_sum(double epoch) const {
    const Turner<Number> turn_a(a);
    const Turner<Number> turn_b(b);
    const TurnedVector<Number> u = turn_a(difference_of<Number>(edge_a[0], edge_a[1]));
    const TurnedVector<Number> v = turn_b(difference_of<Number>(edge_b[0], edge_b[1]));
    const auto way = way_between<Number, Order>(b.path, a.path, epoch);
    TurningSum<Order, Number> f;
    add_product(f, turn_a(moment<Number>(edge_a)), v);
    add_product(f, u, turn_b(moment<Number>(edge_b)));
    for (std::size_t j = 0; j < 3; ++j) {
      for (std::size_t i = 0; i < 3; ++i) f.p[i][j] = f.p[i][j] + along(cross(u[i], v[j]), way);
    }
    return f;
  }

  template <class Number>
  Number value_at_start(double t) const {
    const Turner<Number> turn_a(a);
    const Turner<Number> turn_b(b);
    const VectorOf<Number> u = turn_a.at_start(difference_of<Number>(edge_a[0], edge_a[1]));
    const VectorOf<Number> v = turn_b.at_start(difference_of<Number>(edge_b[0], edge_b[1]));
    return dot(turn_a.at_start(moment<Number>(edge_a)), v) + dot(u, turn_b.at_start(moment<Number>(edge_b))) +
           dot(cross(u, v), way_at<Number>(b.path, a.path, t));
  }

  /// Error bound, with u = 2^-53 and lengths bounded by sums of magnitudes: L1, L2 for the edges, known to u, and
  /// turned with the errors r1, r2; their product errs by L1 L2 (r1 + r2 + 5 u) at most; G for the vector g between the
  /// points, with its error e: in all L1 L2 (e + G (r1 + r2 + 8 u + u)), and products of two errors; 16 u and 2^-500
  /// for underflow are charged.
  Ball<double> quick_value(double t) const {
    const Rotation turn_a = a.rotation(t);
    const Rotation turn_b = b.rotation(t);
    const Eigen::Vector3d u = edge_a[1] - edge_a[0];
    const Eigen::Vector3d v = edge_b[1] - edge_b[0];
    const BoundedVector o_a = a.origin(t);
    const BoundedVector o_b = b.origin(t);
    const Eigen::Vector3d x = turn_a(edge_a[0]);
    const Eigen::Vector3d y = turn_b(edge_b[0]);
    const Eigen::Vector3d between = o_a.vector - o_b.vector;
    const Eigen::Vector3d ends = x - y;
    const Eigen::Vector3d g = between + ends;
    const double size = magnitude_sum(between) + magnitude_sum(ends);
    const double value = dot(cross(turn_a(u), turn_b(v)), g);
    const double error = o_a.error + o_b.error + turn_a.error() * magnitude_sum(edge_a[0]) +
                         turn_b.error() * magnitude_sum(edge_b[0]) + size * (turn_a.error() + turn_b.error() + 0x1p-49);
    return bounded_value(value, magnitude_sum(u) * magnitude_sum(v), size, error);
  }

  /// The same in double-doubles, times both scales: with d in place of u, and edges that are exact.
  Ball<DoubleDouble> extended_value(double t) const {
    const ExtendedPose pose_a(a, t);
    const ExtendedPose pose_b(b, t);
    const ExtendedVector u = exact_difference(edge_a[0], edge_a[1]);
    const ExtendedVector v = exact_difference(edge_b[0], edge_b[1]);
    const ExtendedVector ends = pose_a(vector_of<DoubleDouble>(edge_a[0])) - pose_b(vector_of<DoubleDouble>(edge_b[0]));
    const ExtendedVector between = pose_a.origin() - pose_b.origin();
    const double turns = pose_a.error() + pose_b.error();
    const double size = magnitude_sum(between) + magnitude_sum(ends);
    const double error = pose_a.origin_error() + pose_b.origin_error() + pose_a.error() * magnitude_sum(edge_a[0]) +
                         pose_b.error() * magnitude_sum(edge_b[0]) + size * (turns + 16 * extended_unit);
    return bounded_value(dot(cross(pose_a(u), pose_b(v)), between + ends), pose_a.scale() * pose_b.scale(),
                         magnitude_sum(u) * magnitude_sum(v), size, error);
  }

 private:
  template <class Number>
  static VectorOf<Number> moment(const std::array<Eigen::Vector3d, 2>& edge) {
    return cross(vector_of<Number>(edge[0]), vector_of<Number>(edge[1]));
  }
};

}  // namespace kds::certificates
