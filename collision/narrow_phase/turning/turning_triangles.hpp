// Two triangles that turn: by which ways they are apart, exactly.
#pragma once

#include "certificates/turning/edge_edge_separation.hpp"
#include "certificates/turning/normal_along_edge.hpp"
#include "certificates/turning/vertex_face_separation.hpp"
#include "collision/narrow_phase/turning/triangle_gap.hpp"
#include "collision/narrow_phase/turning/turning_hulls.hpp"
#include "kds/turning/turning_failure_time.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

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

  /// Numbers of conditions of a way, as bits.
  using Conditions = typename Base::Conditions;
  static constexpr Conditions all(int) { return 7; }

  /// Calls test(certificate) for some conditions of a way, or all, until it returns false.
  template <class Test>
  bool every_condition(int way, Conditions which, const Test& test) const {
    const Corners& p = this->hull_a_.points;
    const Corners& q = this->hull_b_.points;
    const bool forward = way % 2 != 0;
    if (way < 4) return every_corner(way, p, q, which, test);
    const auto k = static_cast<std::size_t>(way - 4) / 2;
    const std::array<Eigen::Vector3d, 2> u{p[k / 3], p[(k / 3 + 1) % 3]}, u_back{u[1], u[0]};
    const std::array<Eigen::Vector3d, 2> v{q[k % 3], q[(k % 3 + 1) % 3]}, v_back{v[1], v[0]};
    // An edge from a to b: the product has to point from b to a for EdgeEdgeSeparation.
    using certificates::EdgeEdgeSeparation, certificates::NormalAlongEdge;
    return (!(which & 1) || test(EdgeEdgeSeparation<Degree>{this->a_, this->b_, forward ? u_back : u, v})) &&
           (!(which & 2) || test(NormalAlongEdge<Degree>{this->a_, this->b_, p, forward ? v : v_back})) &&
           (!(which & 4) || test(NormalAlongEdge<Degree>{this->b_, this->a_, q, forward ? u : u_back}));
  }

  /// A time from t on until which they are apart; t where doubles do not tell, or where it would be hardly later.
  double apart_until(double t, double horizon) const { return apart_until(this->frame(t), horizon); }
  double apart_until(const TurningView<Degree>& view, double horizon) const {
    if (this->slack() > 0) return Base::apart_until(view, horizon);
    const TriangleGap<Degree> gap(view, this->hull_a_, this->hull_b_);
    return gap.width() > this->error(view) ? apart_until(gap, view, horizon) : view.time;
  }
  /// The same, or a time until which they are apart but for some roundings at first, in which they part: what has just
  /// bounced. Not of edges in the plane of the other: these may enter a solid that no triangle penetrates.
  double clear_until(const TurningView<Degree>& view, double horizon) const {
    const TriangleGap<Degree> gap(view, this->hull_a_, this->hull_b_);
    const double error = this->error(view);
    if (gap.width() > error) return apart_until(gap, view, horizon);
    if (!(gap.width() >= -error) || !view.certain) return view.time;
    const double stretch = look_ahead(view, horizon), wait = gap.parts_for(stretch);
    if (!(wait > 0)) return view.time;
    const auto [near_a, near_b] = near_planes(view);
    if (std::popcount(near_a) > 1 || std::popcount(near_b) > 1) return view.time;
    return wait > horizon - view.time ? never : after_wait(view.time, wait, stretch);
  }

  /// As gap(), but for roundings.
  double quick_gap(const TurningView<Degree>& view) const {
    return TriangleGap<Degree>(view, this->hull_a_, this->hull_b_).width();
  }

  /// As those of the base, by less work.
  double gaps(const TurningView<Degree>& view, std::array<double, std::size_t{Base::ways}>& gap) const {
    TrianglesSeen<Degree>(view, this->hull_a_, this->hull_b_)
        .every_direction([&](int k, double forward, double back, double) {
          gap[static_cast<std::size_t>(2 * k)] = back;
          gap[static_cast<std::size_t>(2 * k + 1)] = forward;
        });
    return this->error(view);
  }

  /// The conditions of a way that do not hold for certain, and are positive, for so long from now on.
  Conditions unsure(const TurningView<Degree>& view, int way, double stretch) const {
    return stretch > 0 ? unsure<Time::ahead>(view, way, stretch) : unsure<Time::now>(view, way, 0);
  }
  /// The same of a way that is open just after the time of the view: those that rise go on to hold, too.
  Conditions unsure_while_open(const TurningView<Degree>& view, int way, double stretch) const {
    return unsure<Time::while_open>(view, way, stretch);
  }

  /// How far to look ahead, s; for how much of that a condition of a way is broken for certain, all the time; whether
  /// the way is along edges that are parallel but for 2^-10.
  double stretch(const TurningView<Degree>& view, double most) const {
    return view.stretch(this->hull_a_.radius + this->hull_b_.radius, most);
  }
  double closed_wait(const TurningView<Degree>& view, int way, double stretch) const;
  bool is_thin(const TurningView<Degree>& view, int way) const {
    if (way < 4) return false;
    const auto k = static_cast<std::size_t>(way - 4) / 2;
    const Eigen::Vector3d u = view.in_world_a(this->hull_a_.edges[k / 3]);
    return !(norm(cross(u, view.in_world_b(this->hull_b_.edges[k % 3]))) > 0x1p-10);
  }

  /// Bits of the corners of b that may be in the plane of a at the time of the view, and of those of a in that of b.
  std::array<unsigned, 2> near_planes(const TurningView<Degree>& view) const {
    const auto &a = this->hull_a_, &b = this->hull_b_;
    const double error = this->error(view);
    const Eigen::Vector3d in_a = view.in_world_a(a.normals[0]), in_b = view.in_world_b(b.normals[0]);
    // Each normal and its plane are seen from the other body: then its corners need not be turned.
    const auto turned_back = [](const Eigen::Matrix3d& m, const Eigen::Vector3d& x) {
      return Eigen::Vector3d(m(0, 0) * x[0] + m(1, 0) * x[1] + m(2, 0) * x[2],
                             m(0, 1) * x[0] + m(1, 1) * x[1] + m(2, 1) * x[2],
                             m(0, 2) * x[0] + m(1, 2) * x[1] + m(2, 2) * x[2]);
    };
    const Eigen::Vector3d seen_from_b = turned_back(view.matrix_b, in_a);
    const Eigen::Vector3d seen_from_a = turned_back(view.matrix_a, in_b);
    const double plane_a = dot(a.normals[0], a.points[0]) - dot(in_a, view.way.value);
    const double plane_b = dot(b.normals[0], b.points[0]) + dot(in_b, view.way.value);
    std::array<unsigned, 2> near{};
    for (std::size_t i = 0; i < 3; ++i) {
      if (!(std::abs(dot(seen_from_b, b.points[i]) - plane_a) > error)) near[0] |= 1u << i;
      if (!(std::abs(dot(seen_from_a, a.points[i]) - plane_b) > error)) near[1] |= 1u << i;
    }
    return near;
  }

  /// Whether all of its conditions are zero at all times.
  template <class Vanishes>
  bool separates_nothing(int way, const Vanishes& vanishes) const {
    return way >= 4 && every_condition(way, Base::all(way), vanishes);
  }

  /// The first double in [t, until] just after which a corner is deeper than the slack in the plane of a way < 4, or
  /// `never`: exactly that of corners moved by so much, rounded.
  double holds_until(int way, double slack, double t, double until) const {
    const double along = way % 2 != 0 ? slack : -slack;
    Corners p = this->hull_a_.points, q = this->hull_b_.points;
    for (Eigen::Vector3d& x : p) x -= along * this->hull_a_.normals[0];
    for (Eigen::Vector3d& x : q) x += along * this->hull_b_.normals[0];
    double first = never;
    every_corner(way, way < 2 ? p : this->hull_a_.points, way < 2 ? this->hull_b_.points : q, all(way),
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
  enum class Time : std::uint8_t {
    now,        ///< just then: derivatives do not count
    ahead,      ///< for a stretch
    while_open  ///< for a stretch, of conditions that hold at its beginning
  };
  template <class Value, class Note>
  bool every_value(const TurningView<Degree>& view, int way, double stretch, const Note& note) const;
  template <Time Which>
  Conditions unsure(const TurningView<Degree>& view, int way, double stretch) const;
  /// The longest stretch that there is.
  double longest(const TurningView<Degree>& view) const {
    return this->stretch(view, std::numeric_limits<double>::max());
  }

  /// For how long of the time up to the horizon a view is good.
  double look_ahead(const TurningView<Degree>& view, double horizon) const {
    return stretch(view, (horizon - view.time) * (1 + 0x1p-40));
  }
  /// Of those between which there is a gap.
  double apart_until(const TriangleGap<Degree>& gap, const TurningView<Degree>& view, double horizon) const {
    const double stretch = look_ahead(view, horizon);
    double wait = gap.open_for(stretch);
    if (wait < stretch && view.turn_alike()) {
      wait = std::max(wait, gap.open_seen_from_a(stretch, (horizon - view.time) * (1 + 0x1p-40)));
    }
    return wait > horizon - view.time ? never : after_wait(view.time, wait, stretch);
  }

  /// Of the ways of planes.
  template <class Test>
  bool every_corner(int way, const Corners& p, const Corners& q, Conditions which, const Test& test) const {
    const bool forward = way % 2 != 0;
    if (way < 2) return every_corner(this->a_, forward ? p : turned_over(p), this->b_, q, which, test);
    return every_corner(this->b_, forward ? turned_over(q) : q, this->a_, p, which, test);
  }
  template <class Test>
  static bool every_corner(const RigidMotion& of_face, const Corners& face, const RigidMotion& of_corner,
                           const Corners& corners, Conditions which, const Test& test) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (!(which >> i & 1)) continue;
      if (!test(certificates::VertexFaceSeparation<Degree>{of_corner, of_face, corners[i], face})) return false;
    }
    return true;
  }
};

// ---------------------------------------------------------------------------------------------------------------------

/// Calls note(number, f, doubt, bounds, to_longest) for each condition: with a value, or a jet where the time ahead
/// counts; `doubt`: by which the direction is off; bounds for the stretch, to_longest() for the longest. False where
/// these do not hold.
///
/// Each condition is n . p, or n . v, with unit vectors that turn: what exact signs are taken of, times a positive
/// number. Normals are off by the doubt of their hull, and stay so as they turn.
template <int Degree>
template <class Value, class Note>
bool TurningTriangles<Degree>::every_value(const TurningView<Degree>& view, int way, double stretch,
                                           const Note& note) const {
  constexpr bool now = std::is_same_v<Value, double>;
  using Vector = std::conditional_t<now, Eigen::Vector3d, VectorJet>;
  const auto& hull_a = this->hull_a_;
  const auto& hull_b = this->hull_b_;
  const double longest = this->longest(view);
  if (!view.certain || !(stretch <= longest)) return false;
  const auto moving = [](const Eigen::Vector3d& x, const Eigen::Vector3d& spin) -> Vector {
    if constexpr (now) {
      return x;
    } else {
      return turning(x, spin);
    }
  };
  const auto of_a = [&](const Eigen::Vector3d& x) { return moving(view.in_world_a(x), view.spin_a); };
  const auto of_b = [&](const Eigen::Vector3d& x) { return moving(view.in_world_b(x), view.spin_b); };
  const double sense = way % 2 != 0 ? 1 : -1;
  const auto bounds_for = [&](double rates, double until) {
    return TurningBounds(view, rates, hull_a.radius, hull_b.radius, until);
  };
  Vector between;
  if constexpr (now) {
    between = view.way.value;
  } else {
    between = view.way;
  }
  if (way < 4) {
    const bool face_of_a = way < 2;
    const auto& face = face_of_a ? hull_a : hull_b;
    const Vector n = sense * (face_of_a ? of_a(face.normals[0]) : of_b(face.normals[0]));
    const double rates = face_of_a ? view.rate_a : view.rate_b;
    const TurningBounds bounds = bounds_for(rates, stretch);
    const Value plane = face_of_a ? dot(n, between) - dot(n, of_a(face.points[0]))  //
                                  : dot(n, between) + dot(n, of_b(face.points[0]));
    for (std::size_t i = 0; i < 3; ++i) {
      const Value f = face_of_a ? plane + dot(n, of_b(hull_b.points[i])) : plane - dot(n, of_a(hull_a.points[i]));
      note(static_cast<int>(i), f, face.doubt, bounds, [&] { return bounds_for(rates, longest); });
    }
    return true;
  }
  const auto k = static_cast<std::size_t>(way - 4) / 2;
  const Vector u = of_a(hull_a.edges[k / 3]), v = of_b(hull_b.edges[k % 3]);
  const double rates = view.rate_a + view.rate_b;
  const Vector apart = between + of_b(hull_b.points[k % 3]) - of_a(hull_a.points[k / 3]);
  note(0, sense * dot(cross(u, v), apart), 0.0, bounds_for(rates, stretch), [&] { return bounds_for(rates, longest); });
  const TurningBounds of_directions(rates * rates * rates * (1 + 0x1p-40), PairFrame<Degree>::rounding, 1);
  const auto same = [&] { return of_directions; };
  note(1, sense * dot(of_a(hull_a.normals[0]), v), hull_a.doubt, of_directions, same);
  note(2, sense * dot(of_b(hull_b.normals[0]), u), hull_b.doubt, of_directions, same);
  return true;
}

/// Of a condition f that holds just after the time of the view: f(x) >= x (f' + f'' x / 2 - third x^2 / 6). The errors
/// of f' and f'' are such that times the longest stretch L that there is, and its square, they are no more than those
/// of f: so f' is off by e / L, and f'' by 2 e / L^2, 3 e / L in all, where e is what f may be off by until L.
template <int Degree>
template <typename TurningTriangles<Degree>::Time Which>
auto TurningTriangles<Degree>::unsure(const TurningView<Degree>& view, int way, double stretch) const -> Conditions {
  constexpr bool now = Which == Time::now;
  using Value = std::conditional_t<now, double, Jet>;
  Conditions unsure = 0;
  const auto note = [&](int number, const Value& f, double doubt, const TurningBounds& bounds, const auto& to_longest) {
    const double less = bounds.rounding + doubt * bounds.lengths;
    bool sure = false;
    if constexpr (now) {
      sure = f > less;
    } else {
      sure = f.value > less && positive_for({f.value - less, f.rate, f.bend}, bounds.third, stretch) >= stretch;
      if (Which == Time::while_open && !sure && f.rate > 0) {
        const TurningBounds most = to_longest();
        const double error = most.rounding + doubt * most.lengths;
        const Jet slope{f.rate - 3 * error / longest(view), 0.5 * f.bend, -bounds.third / 3};
        sure = slope.value > 0 && positive_for(slope, 0, stretch) >= stretch;
      }
    }
    if (!sure) unsure |= Conditions{1} << number;
  };
  return every_value<Value>(view, way, stretch, note) ? unsure : all(way);
}

template <int Degree>
double TurningTriangles<Degree>::closed_wait(const TurningView<Degree>& view, int way, double stretch) const {
  double wait = 0;
  every_value<Jet>(view, way, stretch, [&](int, const Jet& f, double doubt, const TurningBounds& bounds, const auto&) {
    const double more = bounds.rounding + doubt * bounds.lengths;
    const Jet broken{-(f.value + more), -f.rate, -f.bend};
    if (broken.value > 0) wait = std::max(wait, positive_for(broken, bounds.third, stretch));
  });
  return wait;
}

}  // namespace kds::collision
