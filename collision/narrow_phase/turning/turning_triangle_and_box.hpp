// A triangle and a box that turn: by which ways they are apart, exactly.
#pragma once

#include "certificates/turning/edge_edge_separation.hpp"
#include "certificates/turning/normal_along_edge.hpp"
#include "certificates/turning/vertex_face_separation.hpp"
#include "collision/narrow_phase/turning/turning_hulls.hpp"
#include "collision/narrow_phase/turning/turning_triangles.hpp"
#include "kds/turning/turning_failure_time.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>

namespace kds::collision {

/// A triangle (a) penetrates a solid box (b) if no plane has the one on one closed side and the other on the other: if
/// a point inside of the triangle is inside of the box. They are apart by one of 26 ways (see TurningTriangles): all
/// corners of the box on either side of the triangle's plane, all corners of the triangle beyond a face of the box, or
/// a plane along an edge of the triangle and an axis of the box: then all four edges along that axis are beyond the
/// edge, and the third corner is not.
template <int Degree>
class TurningTriangleAndBox : public TurningHulls<Degree, BoxHull> {
 public:
  using Base = TurningHulls<Degree, BoxHull>;
  using RigidMotion = certificates::RigidMotion<Degree>;
  using Corners = std::array<Eigen::Vector3d, 3>;

  TurningTriangleAndBox(const RigidMotion& a, const Corners& corners, const RigidMotion& b, const Eigen::Vector3d& half)
      : Base(a, triangle_hull(corners), b, box_hull(half)) {}

  /// Calls test(certificate) for the conditions of a way until it returns false.
  template <class Test>
  bool every_condition(int way, typename Base::Conditions, const Test& test) const {
    const Corners& p = this->hull_a_.points;
    const auto& corners = this->hull_b_.points;
    const bool forward = way % 2 != 0;
    if (way < 8) return every_corner(way, 0, test);
    const auto k = static_cast<std::size_t>(way - 8) / 2;
    const std::size_t axis = k % 3;
    const std::array<Eigen::Vector3d, 2> u{p[k / 3], p[(k / 3 + 1) % 3]}, u_back{u[1], u[0]};
    const std::size_t bit = std::size_t{1} << axis;
    const std::array<Eigen::Vector3d, 2> v{corners[0], corners[bit]}, v_back{v[1], v[0]};
    if (!test(certificates::NormalAlongEdge<Degree>{this->a_, this->b_, p, forward ? v : v_back})) return false;
    for (std::size_t i = 0; i < 8; ++i) {
      if (i & bit) continue;
      const std::array<Eigen::Vector3d, 2> edge{corners[i], corners[i | bit]};
      if (!test(certificates::EdgeEdgeSeparation<Degree>{this->a_, this->b_, forward ? u_back : u, edge})) return false;
    }
    return true;
  }

  /// Whether all of its conditions are zero at all times.
  template <class Vanishes>
  bool separates_nothing(int way, const Vanishes& vanishes) const {
    return way >= 8 && every_condition(way, Base::all(way), vanishes);
  }

  /// The first double in [t, until] just after which a corner is deeper than the slack in the plane of a way < 8, or
  /// `never`: exactly that of a plane moved by so much, rounded.
  double holds_until(int way, double slack, double t, double until) const {
    double first = never;
    every_corner(way, slack, [&](const auto& condition) {
      first = std::min(first, failure_time(condition, t, std::min(first, until)));
      return true;
    });
    return first;
  }

  TurningTriangleAndBox with_slack(double slack) const {
    TurningTriangleAndBox pair = *this;
    pair.set_slack(slack);
    return pair;
  }

 private:
  /// Of the ways of planes, which are moved by `slack` to let more through.
  template <class Test>
  bool every_corner(int way, double slack, const Test& test) const {
    const bool forward = way % 2 != 0;
    if (way < 2) {
      Corners face = forward ? this->hull_a_.points : turned_over(this->hull_a_.points);
      if (slack > 0) {
        for (Eigen::Vector3d& x : face) x -= (forward ? slack : -slack) * this->hull_a_.normals[0];
      }
      for (const Eigen::Vector3d& x : this->hull_b_.points) {
        if (!test(certificates::VertexFaceSeparation<Degree>{this->b_, this->a_, x, face})) return false;
      }
      return true;
    }
    // From a to b along the axis: the triangle is beyond the lower face.
    const auto axis = static_cast<std::size_t>(way - 2) / 2;
    Corners face = box_face(axis, !forward);
    if (slack > 0) {
      for (Eigen::Vector3d& x : face) x += (forward ? slack : -slack) * this->hull_b_.normals[axis];
    }
    for (const Eigen::Vector3d& x : this->hull_a_.points) {
      if (!test(certificates::VertexFaceSeparation<Degree>{this->a_, this->b_, x, face})) return false;
    }
    return true;
  }

  /// Three corners of a face, counter-clockwise from outside.
  Corners box_face(std::size_t axis, bool upper) const {
    const std::size_t base = upper ? std::size_t{1} << axis : 0;
    const std::size_t first = std::size_t{1} << (axis + (upper ? 1 : 2)) % 3;
    const std::size_t second = std::size_t{1} << (axis + (upper ? 2 : 1)) % 3;
    const auto& corners = this->hull_b_.points;
    return {corners[base], corners[base | first], corners[base | second]};
  }
};

}  // namespace kds::collision
