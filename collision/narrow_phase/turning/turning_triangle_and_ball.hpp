// A triangle that turns and a ball: which part of the triangle the ball is away from, and for how long.
#pragma once

#include "certificates/turning/ball_triangle_separation.hpp"
#include "certificates/turning/rigid_motion.hpp"
#include "collision/narrow_phase/turning/hulls.hpp"
#include "collision/narrow_phase/turning/turning_view.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace kds::collision {

/// A triangle (a) and a ball (b) are apart while the centre is no nearer to the triangle than the radius: to its plane
/// (2 *ways*, by the side), or to the line of an edge where the centre is on the far side of it (3), or to a corner
/// where both edges lead away from it (3). Where one of these holds, the half space, the half plane or the wedge that
/// holds the triangle is no nearer; and whichever part of the triangle is the nearest, its way holds if they are apart.
template <int Degree>
class TurningTriangleAndBall {
 public:
  using RigidMotion = certificates::RigidMotion<Degree>;
  using Corners = std::array<Eigen::Vector3d, 3>;
  static constexpr int ways = 8;

  TurningTriangleAndBall(const RigidMotion& a, const Corners& corners, const RigidMotion& b, double radius)
      : a_(a), b_(b), hull_(triangle_hull(corners)), radius_(radius) {}

  // What WaysApart asks. Conditions are few, and all are looked at.
  using Conditions = std::uint32_t;
  static constexpr Conditions all(int) { return ~Conditions{0}; }
  Conditions unsure(const TurningView<Degree>&, int way, double) const { return all(way); }
  static bool known_to_separate_nothing(int) { return false; }
  template <class Vanishes>
  static bool separates_nothing(int, const Vanishes&) {
    return false;
  }

  TurningView<Degree> frame(double t) const { return {a_, b_, t}; }
  double fastest(const TurningView<Degree>& view, double stretch) const {
    return view.fastest(hull_.radius, 0, stretch);
  }

  template <class Test>
  bool every_condition(int way, Conditions, const Test& test) const {
    const certificates::TrianglePart part = part_of(way);
    const certificates::detail::BallAndTriangle<Degree> pair{b_.path, a_, hull_.points, part};
    for (std::size_t i = 0; i < (part.kind == certificates::TrianglePart::Kind::corner ? 2 : 1); ++i) {
      if (!test(certificates::CentreBeyondPart<Degree>{pair, i})) return false;
    }
    return test(certificates::BallBeyondPart<Degree>{pair, {radius_, 0}});
  }

  double gaps(const TurningView<Degree>& view, std::array<double, ways>& gap) const {
    using Kind = certificates::TrianglePart::Kind;
    const Seen seen(*this, view);
    for (int way = 0; way < ways; ++way) {
      const certificates::TrianglePart part = part_of(way);
      const std::size_t k = part.number;
      double& width = gap[static_cast<std::size_t>(way)];
      if (part.kind == Kind::face) {
        width = (k == 0 ? 1 : -1) * dot(seen.normal, seen.centre - seen.corners[0]) - radius_;
      } else if (part.kind == Kind::edge) {
        const Eigen::Vector3d d = seen.centre - seen.corners[k];
        width = std::min(dot(cross(seen.edges[k], seen.normal), d), norm(cross(seen.edges[k], d)) - radius_);
      } else {
        const Eigen::Vector3d d = seen.centre - seen.corners[k];
        width = std::min({-dot(seen.edges[k], d), dot(seen.edges[(k + 2) % 3], d), norm(d) - radius_});
      }
    }
    return error(view);
  }

  double gap(double t) const { return gap(TurningView<Degree>(a_, b_, t)); }
  double gap(const TurningView<Degree>& view) const { return norm(Seen(*this, view).apart()) - radius_; }
  double quick_gap(const TurningView<Degree>& view) const { return gap(view); }

  double error(const PairFrame<Degree>& frame) const {
    if (!frame.certain) return never;
    const double lengths = norm(frame.way.value) + hull_.radius + radius_;
    return 4 * frame.way_error + (PairFrame<Degree>::rounding + hull_.doubt) * lengths;
  }

  /// An overlap up to this depth may come from roundings alone: four times the error of a gap. It does not count where
  /// the two do not approach.
  double roundings(const PairFrame<Degree>& frame) const { return 4 * error(frame); }

  double apart_until(double t, double horizon) const { return apart_until(TurningView<Degree>(a_, b_, t), horizon); }
  double apart_until(const TurningView<Degree>& view, double horizon) const {
    const Seen seen(*this, view);
    const Eigen::Vector3d apart = seen.apart();
    const double distance = norm(apart);
    if (!(distance - radius_ > error(view))) return view.time;
    // The direction from the nearest point, with which it turns.
    const VectorJet n = turning(apart / distance, view.spin_a);
    const double stretch = view.stretch(hull_.radius + radius_, (horizon - view.time) * (1 + 0x1p-40));
    const TurningBounds bounds(view, view.rate_a, 0, 0, stretch);  // the spin of the ball does not matter
    double farthest = -never;
    for (const Eigen::Vector3d& x : seen.corners) farthest = std::max(farthest, dot(n.value, x));
    Jet f = dot(n, view.way);
    f.value -= farthest + radius_ + PairFrame<Degree>::rounding * (hull_.radius + radius_) + bounds.rounding;
    const double wait = positive_for(f, bounds.third, stretch);
    if (wait > horizon - view.time) return never;
    if (slack_) return wait > 0x1p-30 * stretch ? std::max(view.time, next_down(view.time + wait)) : view.time;
    return after_wait(view.time, wait, stretch);
  }

  static int shallow_plane(double, double) { return -1; }
  static double holds_until(int, double, double t, double) { return t; }

  double time_of_turning() const {
    const double rate = norm(a_.angular_velocity);
    return rate > 0 ? 0.5 / rate : never;
  }

  /// The same pair with a smaller ball; one that is hardly there if nothing of it is left.
  TurningTriangleAndBall with_slack(double slack) const {
    TurningTriangleAndBall pair = *this;
    pair.radius_ = std::max(radius_ - slack, 0x1p-20 * radius_);
    pair.slack_ = true;
    return pair;
  }

  /// Where the two are in the axes of the world, about the origin of the triangle's body.
  struct Seen {
    Seen(const TurningTriangleAndBall& pair, const TurningView<Degree>& view)
        : centre(view.way.value), normal(view.in_world_a(pair.hull_.normals[0])) {
      for (std::size_t i = 0; i < 3; ++i) {
        corners[i] = view.in_world_a(pair.hull_.points[i]);
        edges[i] = view.in_world_a(pair.hull_.edges[i]);
      }
    }
    /// The way from the nearest point of the triangle to the centre.
    Eigen::Vector3d apart() const { return centre - nearest(); }
    /// Of the triangle; `part`: 0 to 2 corners, 3 to 5 edges, 6 the face.
    Eigen::Vector3d nearest(int* part = nullptr) const;

    Eigen::Vector3d centre, normal;
    std::array<Eigen::Vector3d, 3> corners, edges;
  };

 private:
  static certificates::TrianglePart part_of(int way) {
    using Kind = certificates::TrianglePart::Kind;
    const auto number = static_cast<std::size_t>(way);
    if (way < 2) return {Kind::face, number};
    if (way < 5) return {Kind::edge, number - 2};
    return {Kind::corner, number - 5};
  }

  const RigidMotion& a_;
  const RigidMotion& b_;
  TriangleHull hull_;
  double radius_;
  bool slack_ = false;  ///< then no exact signs take over where doubles get on slowly
};

template <int Degree>
Eigen::Vector3d TurningTriangleAndBall<Degree>::Seen::nearest(int* part) const {
  int found = 6;
  Eigen::Vector3d best = centre - normal * dot(normal, centre - corners[0]);
  double least = never;
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::Vector3d d = centre - corners[k];
    if (dot(cross(edges[k], normal), d) <= 0) continue;  // not beyond this edge
    const double length = norm(corners[(k + 1) % 3] - corners[k]);
    const double along = std::clamp(dot(edges[k], d), 0.0, length);
    const Eigen::Vector3d x = corners[k] + edges[k] * along;
    const double distance = norm(centre - x);
    if (!(distance < least)) continue;
    least = distance;
    best = x;
    found = along <= 0        ? static_cast<int>(k)
            : along >= length ? static_cast<int>((k + 1) % 3)
                              : static_cast<int>(3 + k);
  }
  if (part) *part = found;
  return best;
}

}  // namespace kds::collision
