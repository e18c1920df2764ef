// Two triangles that turn: by which ways they are apart, exactly.
#pragma once

#include "certificates/turning/edge_edge_separation.hpp"
#include "certificates/turning/normal_along_edge.hpp"
#include "certificates/turning/vertex_face_separation.hpp"
#include "collision/narrow_phase/turning/turning_hulls.hpp"
#include "kds/turning/turning_failure_time.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>

namespace kds::collision {

/// The corners of a triangle in another order, so that its normal points the other way.
inline std::array<Eigen::Vector3d, 3> turned_over(const std::array<Eigen::Vector3d, 3>& corners) {
  return {corners[0], corners[2], corners[1]};
}

/// Law. Two triangles penetrate if no plane has the one on one closed side and the other on the other. So triangles
/// that touch do not, nor do such that slide on each other in one plane; two that are not in one plane penetrate if
/// and only if a point that is inside of both is.
///
/// Method. What has to be separated is the difference of the two, A - B, from 0. If they are not in parallel planes
/// that is a polyhedron whose faces are parallel to a, to b, or to an edge of each: one of these planes separates if
/// any does. If they are in parallel planes these planes separate them. So 22 *ways* are enough: all corners of one on
/// either side of the plane of the other (4 ways of 3 conditions), or a plane along an edge u of a and an edge v of b
/// (18). Of the latter, with n = u x v from a to b, the conditions are n . (q - p) >= 0 for points p, q of the two
/// edges, and that the third corner of each triangle is on its own side: N_a . v >= 0 and N_b . u >= 0, as n . (third
/// corner - p) is -N_a . v and n . (third corner - q) is N_b . u. The product of edges that are parallel at all times
/// separates nothing: all of its conditions are zero then.
template <int Degree>
class TurningTriangles : public TurningHulls<Degree, TriangleHull> {
 public:
  using Base = TurningHulls<Degree, TriangleHull>;
  using RigidMotion = certificates::RigidMotion<Degree>;
  using Corners = std::array<Eigen::Vector3d, 3>;

  TurningTriangles(const RigidMotion& a, const Corners& corners_a, const RigidMotion& b, const Corners& corners_b)
      : Base(a, triangle_hull(corners_a), b, triangle_hull(corners_b)) {}

  /// Calls test(certificate) for the conditions of a way until it returns false.
  template <class Test>
  bool every_condition(int way, typename Base::Conditions, const Test& test) const {
    const Corners& p = this->hull_a_.points;
    const Corners& q = this->hull_b_.points;
    const bool forward = way % 2 != 0;
    if (way < 4) return every_corner(way, p, q, test);
    const auto k = static_cast<std::size_t>(way - 4) / 2;
    const std::array<Eigen::Vector3d, 2> u{p[k / 3], p[(k / 3 + 1) % 3]}, u_back{u[1], u[0]};
    const std::array<Eigen::Vector3d, 2> v{q[k % 3], q[(k % 3 + 1) % 3]}, v_back{v[1], v[0]};
    // An edge from a to b: the product has to point from b to a for EdgeEdgeSeparation.
    return test(certificates::EdgeEdgeSeparation<Degree>{this->a_, this->b_, forward ? u_back : u, v}) &&
           test(certificates::NormalAlongEdge<Degree>{this->a_, this->b_, p, forward ? v : v_back}) &&
           test(certificates::NormalAlongEdge<Degree>{this->b_, this->a_, q, forward ? u : u_back});
  }

  /// Whether all of its conditions are zero at all times.
  bool separates_nothing(int way) const {
    return way >= 4 && every_condition(way, Base::all(way), [](const auto& condition) { return vanishes(condition); });
  }

  /// The first double in [t, until] just after which a corner is deeper than the slack in the plane of a way < 4, or
  /// `never`: exactly that of corners moved by so much, rounded.
  double holds_until(int way, double slack, double t, double until) const {
    const double along = way % 2 != 0 ? slack : -slack;
    Corners p = this->hull_a_.points, q = this->hull_b_.points;
    for (Eigen::Vector3d& x : p) x -= along * this->hull_a_.normals[0];
    for (Eigen::Vector3d& x : q) x += along * this->hull_b_.normals[0];
    double first = never;
    every_corner(way, way < 2 ? p : this->hull_a_.points, way < 2 ? this->hull_b_.points : q,
                 [&](const auto& condition) {
                   first = std::min(first, failure_time(condition, t, std::min(first, until)));
                   return true;
                 });
    return first;
  }

  TurningTriangles with_slack(double slack) const {
    TurningTriangles pair = *this;
    pair.set_slack(slack);
    return pair;
  }

 private:
  /// Of the ways of planes.
  template <class Test>
  bool every_corner(int way, const Corners& p, const Corners& q, const Test& test) const {
    const bool forward = way % 2 != 0;
    if (way < 2) return every_corner(this->a_, forward ? p : turned_over(p), this->b_, q, test);
    return every_corner(this->b_, forward ? turned_over(q) : q, this->a_, p, test);
  }
  template <class Test>
  static bool every_corner(const RigidMotion& of_face, const Corners& face, const RigidMotion& of_corner,
                           const Corners& corners, const Test& test) {
    for (const Eigen::Vector3d& x : corners) {
      if (!test(certificates::VertexFaceSeparation<Degree>{of_corner, of_face, x, face})) return false;
    }
    return true;
  }
};

}  // namespace kds::collision
