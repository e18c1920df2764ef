// A triangle and another convex hull that turn: along which directions they are apart, and for how long, in doubles.
#pragma once

#include "collision/narrow_phase/turning/hulls.hpp"
#include "collision/narrow_phase/turning/jets.hpp"
#include "collision/narrow_phase/turning/turning_view.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <tuple>

namespace kds::collision {

/// A triangle (a) and a triangle or a box (b), and the directions that may separate them: normals of a, normals of b,
/// products of an edge of a and an edge of b. Direction k, taken so that it points from b to a, is the way 2 k, and
/// from a to b the way 2 k + 1. What is exact of these ways is in TurningTriangles and TurningTriangleAndBox.
///
/// `slack`: how deep they may be in each other and still count as apart. With a slack the answers are right only up to
/// some roundings.
template <int Degree, class HullB>
class TurningHulls {
 public:
  using RigidMotion = certificates::RigidMotion<Degree>;
  static constexpr int faces = 1 + static_cast<int>(HullB::normal_count);
  static constexpr int directions = faces + 9;
  static constexpr int ways = 2 * directions;

  TurningHulls(const RigidMotion& a, const TriangleHull& hull_a, const RigidMotion& b, const HullB& hull_b)
      : a_(a), b_(b), hull_a_(hull_a), hull_b_(hull_b) {}

  // What WaysApart asks. All conditions are looked at, unless a pair says more.
  using Conditions = std::uint32_t;
  static constexpr Conditions all(int) { return ~Conditions{0}; }
  Conditions unsure(const TurningView<Degree>&, int way, double) const { return all(way); }
  static bool known_to_separate_nothing(int) { return false; }

  TurningView<Degree> frame(double t) const { return {a_, b_, t}; }

  /// How wide the gap is along each way. Of ways that cross edges it is that times the sine of their angle: conditions
  /// of a way add up to no more than its gap.
  double gaps(const TurningView<Degree>& view, std::array<double, std::size_t{ways}>& gap) const {
    gaps(Seen(*this, view), gap);
    return error(view);
  }

  /// A bound on how fast these widths change.
  double fastest(const TurningView<Degree>& view, double stretch) const {
    return view.fastest(hull_a_.radius, hull_b_.radius, stretch);
  }

  /// The widest gap at t, or less than nothing: how deep they are in each other.
  double gap(double t) const { return gap(TurningView<Degree>(a_, b_, t)); }
  double gap(const TurningView<Degree>& view) const { return widest(Seen(*this, view)).gap; }

  /// A bound on the error of a gap.
  double error(const PairFrame<Degree>& frame) const {
    if (!frame.certain) return never;
    const double lengths = norm(frame.way.value) + hull_a_.radius + hull_b_.radius;
    return frame.way_error + (PairFrame<Degree>::rounding + hull_a_.doubt + hull_b_.doubt) * lengths;
  }

  /// The gap up to roundings. Other pairs have a cheaper way to it.
  double quick_gap(const TurningView<Degree>& view) const { return gap(view); }

  /// An overlap up to this depth may come from roundings alone: four times the error of a gap. It does not count where
  /// the two do not approach.
  double roundings(const PairFrame<Degree>& frame) const { return 4 * error(frame); }

  /// A time from t on until which they are apart; t where doubles do not tell, or where it would be hardly later.
  double apart_until(double t, double horizon) const { return apart_until(TurningView<Degree>(a_, b_, t), horizon); }
  double apart_until(const TurningView<Degree>& view, double horizon) const {
    const Seen seen(*this, view);
    const Widest best = widest(seen);
    if (!(slack_ > 0 ? best.gap + slack_ > 0 : best.gap > error(view))) return view.time;
    const double stretch = view.stretch(hull_a_.radius + hull_b_.radius, (horizon - view.time) * (1 + 0x1p-40));
    const double wait = open_for(view, seen, best.way, stretch);
    if (wait > horizon - view.time) return never;
    if (slack_ > 0) return wait > least_wait * stretch ? std::max(view.time, next_down(view.time + wait)) : view.time;
    return after_wait(view.time, wait, stretch);
  }

  /// The time in which the directions of the two change by about half a radian.
  double time_of_turning() const {
    const double rates = norm(a_.angular_velocity) + norm(b_.angular_velocity);
    return rates > 0 ? 0.5 / rates : never;
  }

  /// Where the two are, in the axes of the world, each about its own body's origin.
  struct Seen {
    Seen(const TurningHulls& pair, const TurningView<Degree>& view) : way(view.way.value) {
      for (std::size_t i = 0; i < a.size(); ++i) a[i] = view.in_world_a(pair.hull_a_.points[i]);
      for (std::size_t i = 0; i < b.size(); ++i) b[i] = view.in_world_b(pair.hull_b_.points[i]);
      normal[0] = view.in_world_a(pair.hull_a_.normals[0]);
      for (std::size_t i = 0; i < HullB::normal_count; ++i) normal[1 + i] = view.in_world_b(pair.hull_b_.normals[i]);
      for (std::size_t i = 0; i < 3; ++i) {
        u[i] = view.in_world_a(pair.hull_a_.edges[i]);
        v[i] = view.in_world_b(pair.hull_b_.edges[i]);
      }
    }
    Eigen::Vector3d direction(int k) const {
      if (k < faces) return normal[static_cast<std::size_t>(k)];
      return cross(u[static_cast<std::size_t>((k - faces) / 3)], v[static_cast<std::size_t>((k - faces) % 3)]);
    }
    /// Gaps along a direction, with either sense.
    std::array<double, 2> along(const Eigen::Vector3d& n) const {
      double low_a = never, high_a = -never, low_b = never, high_b = -never;
      for (const Eigen::Vector3d& x : a) {
        const double height = dot(n, x);
        low_a = std::min(low_a, height), high_a = std::max(high_a, height);
      }
      for (const Eigen::Vector3d& x : b) {
        const double height = dot(n, x);
        low_b = std::min(low_b, height), high_b = std::max(high_b, height);
      }
      const double between = dot(n, way);
      return {low_a - high_b - between, between + low_b - high_a};
    }

    Eigen::Vector3d way;
    std::array<Eigen::Vector3d, std::tuple_size_v<decltype(TriangleHull::points)>> a;
    std::array<Eigen::Vector3d, std::tuple_size_v<decltype(HullB::points)>> b;
    std::array<Eigen::Vector3d, static_cast<std::size_t>(faces)> normal;
    std::array<Eigen::Vector3d, 3> u, v;
  };

  /// A way in which a plane may lie between the hulls, and how far apart they are along it; negative if they overlap.
  struct Widest {
    int way = 0;
    double gap = -never;
    Eigen::Vector3d normal = Eigen::Vector3d::UnitX();  ///< unit, from a to b
  };
  /// The way of the plane along which they are the least deep in each other, if not deeper than a slack; else -1.
  int shallow_plane(double t, double slack) const {
    Widest best;
    every_gap(Seen(*this, TurningView<Degree>(a_, b_, t)), [&](const Widest& way) {
      if (way.way < 2 * faces && way.gap > best.gap) best = way;
    });
    return best.gap > -slack ? best.way : -1;
  }

  /// Calls visit({way, gap, normal}) for all ways but edges that are nearly parallel.
  template <class Visit>
  void every_gap(const Seen& seen, const Visit& visit) const {
    constexpr double least_sine = 0x1p-10;
    for (int k = 0; k < directions; ++k) {
      Eigen::Vector3d n = seen.direction(k);
      if (k >= faces) {
        const double sine = norm(n);
        if (!(sine > least_sine)) continue;
        n /= sine;
      }
      const auto gaps = seen.along(n);
      visit(Widest{2 * k, gaps[0], -n});
      visit(Widest{2 * k + 1, gaps[1], n});
    }
  }
  /// The way along which they are farthest apart, of those for which counts(way).
  template <class Counts>
  Widest widest(const Seen& seen, const Counts& counts) const {
    Widest best;
    every_gap(seen, [&](const Widest& way) {
      if (way.gap > best.gap && counts(way)) best = way;
    });
    return best;
  }
  Widest widest(const Seen& seen) const {
    return widest(seen, [](const Widest&) { return true; });
  }

 protected:
  double slack() const { return slack_; }
  void set_slack(double slack) { slack_ = slack; }

  const RigidMotion& a_;
  const RigidMotion& b_;
  TriangleHull hull_a_;
  HullB hull_b_;

 private:
  void gaps(const Seen& seen, std::array<double, std::size_t{ways}>& gap) const {
    for (int k = 0; k < directions; ++k) {
      const auto both = seen.along(seen.direction(k));
      gap[static_cast<std::size_t>(2 * k)] = both[0];
      gap[static_cast<std::size_t>(2 * k + 1)] = both[1];
    }
  }

  /// How long all points of b are beyond all points of a, along the direction of a way that turns as its faces or edges
  /// do.
  double open_for(const TurningView<Degree>& view, const Seen& seen, int way, double stretch) const {
    const int k = way / 2;
    VectorJet n;
    double rate = 0, allowed = slack_;
    if (k >= faces) {
      n = cross(turning(seen.u[static_cast<std::size_t>((k - faces) / 3)], view.spin_a),
                turning(seen.v[static_cast<std::size_t>((k - faces) % 3)], view.spin_b));
      rate = view.rate_a + view.rate_b;
      if (slack_ > 0) allowed *= norm(n.value);
    } else {
      n = turning(seen.normal[static_cast<std::size_t>(k)], k == 0 ? view.spin_a : view.spin_b);
      rate = k == 0 ? view.rate_a : view.rate_b;
    }
    if (way % 2 == 0) n = -1.0 * n;
    const TurningBounds bounds(view, rate, hull_a_.radius, hull_b_.radius, stretch);
    Jet base = dot(n, view.way);
    base.value += slack_ > 0 ? allowed : -bounds.rounding;
    std::array<Jet, std::tuple_size_v<decltype(seen.a)>> of_a;
    for (std::size_t i = 0; i < of_a.size(); ++i) of_a[i] = dot(n, turning(seen.a[i], view.spin_a));
    double wait = stretch;
    for (const Eigen::Vector3d& x : seen.b) {
      const Jet of_b = base + dot(n, turning(x, view.spin_b));
      for (const Jet& jet : of_a) wait = std::min(wait, positive_for(of_b - jet, bounds.third, wait));
    }
    return wait;
  }

  /// With a slack no exact signs take over.
  static constexpr double least_wait = 0x1p-30;

  double slack_ = 0;
};

}  // namespace kds::collision
