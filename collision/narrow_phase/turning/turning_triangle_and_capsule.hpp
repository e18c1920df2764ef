// A triangle and a capsule that turn: by which of their parts they are apart, and for how long.
#pragma once

#include "certificates/turning/rigid_motion.hpp"
#include "collision/narrow_phase/turning/turning_rounded_polytopes.hpp"
#include "collision/narrow_phase/turning/turning_view.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>

namespace kds::collision {

/// A triangle as a polytope without a volume: its two faces, and edges between them.
inline const HullStructure& structure_of_triangle() {
  static const HullStructure structure{
      {0, 1, 2}, {{{0, 1}, {0, 1}}, {{0, 2}, {1, 0}}, {{1, 2}, {0, 1}}}, {{0, 1, 2}, {0, 2, 1}}};
  return structure;
}

/// A triangle (a) and a capsule (b), with what a search among triangles asks of a pair (TurningMeshSearch).
template <int Degree>
class TurningTriangleAndCapsule : public TurningRoundedPolytopes<Degree> {
 public:
  using Base = TurningRoundedPolytopes<Degree>;
  using RigidMotion = typename Base::RigidMotion;
  using Frame = typename Base::Frame;
  using Corners = std::array<Eigen::Vector3d, 3>;

  TurningTriangleAndCapsule(const RigidMotion& a, const Corners& corners, const RigidMotion& b,
                            const ConvexCore& capsule)
      : Base(a, TurningPolytope(structure_of_triangle(), corners), b, TurningPolytope(capsule), {capsule.radius(), 0}) {
  }

  using Base::apart_until;
  double apart_until(const TurningView<Degree>& view, double horizon) const {
    const double until = Base::apart_until(view.time, horizon);
    return until > horizon ? never : until;
  }

  double gap(double t) const { return gap(this->frame(t)); }
  double gap(const TurningView<Degree>& view) const { return gap(view.time); }
  double quick_gap(const TurningView<Degree>& view) const { return gap(view); }
  double error(const PairFrame<Degree>& frame) const { return Base::error(frame); }
  /// An overlap up to this depth may come from roundings alone: four times the error of a gap. It does not count where
  /// the two do not approach.
  double roundings(const PairFrame<Degree>& frame) const { return 4 * error(frame); }

  static int shallow_plane(double, double) { return -1; }
  static double holds_until(int, double, double t, double) { return t; }

  /// The same pair with a smaller radius, but at least 2^-20 of the radius.
  TurningTriangleAndCapsule with_slack(double slack) const {
    TurningTriangleAndCapsule pair = *this;
    pair.set_radius(std::max(this->radius() - slack, 0x1p-20 * this->radius()));
    return pair;
  }

 private:
  /// Along the way between the nearest points: no more than their distance, whatever doubles have made of that way.
  double gap(const Frame& frame) const {
    const Eigen::Vector3d apart = this->way_between_nearest(frame);
    if (!(norm(apart) > 0)) return -this->radius();
    const Eigen::Vector3d n = normalized(apart);
    return dot(n, frame.way.value + frame.b.farthest(-n) - frame.a.farthest(n)) - this->radius();
  }
};

}  // namespace kds::collision
