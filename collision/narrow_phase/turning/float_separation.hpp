// Two bodies that turn: for how long a plane surely separates all of the one from all of the other, in floats.
#pragma once

#include "collision/narrow_phase/turning/float_vectors.hpp"
#include "collision/narrow_phase/turning/float_view.hpp"

#include <cstddef>

namespace kds::collision::detail {

/// A plane between the points of two bodies whose convex hulls hold them. Its normal does not turn; it moves and
/// accelerates along it as the mean of the two points does that are nearest to it.
///
/// Paper: [Gilbert88] section II for the normal: the point of the difference of the two hulls that is nearest to the
/// origin is approached along the segments to its extreme points. Differs: a few steps, since any plane will do that is
/// not much narrower than the widest gap.
///
/// Rounding: heights of points above the plane, their rates and bends are linear in the points, so what is true of the
/// points of a body is true of all that is in their hull; the bound on third derivatives has to hold of what is in the
/// body alone. In roundings of a float, of lengths of which those of a body add up to 1 with the way to the other
/// (NodesView), or to 4.5 where points are corners of boxes around parts of it: a point is good to 1, the normal in the
/// axes of its body to 8, its products with spins to 16 and 24, and the products of three numbers to 4 more each. So a
/// height is good to 13, a rate to 21, and half of a bend to 15, 221 in all, and the way and the plane to some 20: less
/// than the 512 of the margin, which is charged on both sides of the plane.
template <class Floats>
class PlaneBetween {
 public:
  using Vectors = FloatVectors<Floats>;
  using Vector = FloatVectors<float>;

  [[gnu::always_inline]] PlaneBetween(const FloatView& view, const PointsTogether& a, const PointsTogether& b)
      : view_(view), a_(a), b_(b), way_(all<float>(view.way_now)) {
    find_normal();
  }

  /// For how much of the time ahead it surely lies between them. `loose`: null if they turn as the view tells.
  [[gnu::always_inline]] float part(const LooseTurns* loose) const {
    if (!(widest_ > 0)) return 0;
    return loose ? part_of_turns<true>(*loose) : part_of_turns<false>({});
  }

 private:
  template <bool Loose>
  [[gnu::always_inline]] float part_of_turns(const LooseTurns& loose) const {
    const Vector turn_a = all<float>(view_.turn_a), turn_b = all<float>(view_.turn_b);
    // Of n . x for points x that turn: n . (w x x) is (n x w) . x.
    const Vector rate_a = cross(n_, turn_a), rate_b = cross(n_, turn_b);
    const Heights of_a = heights(view_.unit_a, n_, rate_a, cross(rate_a, turn_a));
    const Heights of_b =
        heights(view_.unit_b, seen_from_b(n_), seen_from_b(rate_b), seen_from_b(cross(rate_b, turn_b)));
    const Vector x = point(a_, near_a_), y = point(b_, near_b_);
    const float way[3] = {dot(n_, way_), dot(n_, all<float>(view_.way_rate)), dot(n_, all<float>(view_.way_bend))};
    Floats least = all<Floats>(1);
    float plane[3];
    for (int i = 0; i < 3; ++i) plane[i] = 0.5F * (dot(of_a.along[i], x) + dot(of_b.along[i], y) + way[i]);
    if (Loose) plane[2] = 0.5F * way[2];
    plane[0] -= 0.5F * view_.round;
    const Floats third = all<Floats>(Loose ? 0 : view_.third[0]);
    const auto keep = [&](const PointsTogether& points, const Heights& of, float sense, const float(&from)[3])
        __attribute__((always_inline)) {
      const Vectors n[3] = {all<Floats>(&of.along[0].x), all<Floats>(&of.along[1].x), all<Floats>(&of.along[2].x)};
      for (int first = 0; first < points.count; first += lanes_of_floats<Floats>) {
        const Vectors p = some(points, first);
        const Floats f0 = from[0] + sense * dot(n[0], p), f1 = from[1] + sense * dot(n[1], p);
        const Floats f2 = Loose ? all<Floats>(from[2]) : from[2] + sense * dot(n[2], p);
        least = lesser(least, positive_part(f0, f1, f2, third));
      }
    };
    float beyond_a[3] = {plane[0] - view_.margin, plane[1], plane[2]};
    float beyond_b[3] = {way[0] - plane[0] - view_.round - view_.margin, way[1] - plane[1], way[2] - plane[2]};
    if (Loose) {
      beyond_a[0] -= loose.off[0], beyond_a[1] -= loose.rate[0], beyond_a[2] -= loose.bend[0];
      beyond_b[0] -= loose.off[1], beyond_b[1] -= loose.rate[1], beyond_b[2] -= loose.bend[1];
    }
    keep(a_, of_a, -1, beyond_a);
    keep(b_, of_b, 1, beyond_b);
    float part = least[0];
    for (int i = 1; i < lanes_of_floats<Floats>; ++i) part = least[i] < part ? least[i] : part;
    return part;
  }

  /// What heights of points, their rates and bends are products with.
  struct Heights {
    Vector along[3];
  };
  [[gnu::always_inline]] static Heights heights(float unit, const Vector& n, const Vector& rate, const Vector& bend) {
    return {{unit * n, unit * rate, unit * bend}};
  }

  [[gnu::always_inline]] static Vectors some(const PointsTogether& points, int first) {
    Vectors p;
    __builtin_memcpy(&p.x, points.x + first, sizeof p.x);
    __builtin_memcpy(&p.y, points.y + first, sizeof p.y);
    __builtin_memcpy(&p.z, points.z + first, sizeof p.z);
    return p;
  }
  [[gnu::always_inline]] static Vector point(const PointsTogether& points, int place) {
    return {points.x[place], points.y[place], points.z[place]};
  }
  /// A vector in the axes of a, in those of b, and back.
  [[gnu::always_inline]] Vector seen_from_b(const Vector& v) const {
    return {dot(v, column(0)), dot(v, column(1)), dot(v, column(2))};
  }
  [[gnu::always_inline]] Vector seen_from_a(const Vector& v) const {
    return v.x * column(0) + v.y * column(1) + v.z * column(2);
  }
  [[gnu::always_inline]] Vector column(int k) const { return all<float>(view_.columns[k]); }

  struct Farthest {
    float height;
    int place;  ///< of the first one
  };
  [[gnu::always_inline]] static Farthest farthest(const PointsTogether& points, const Vector& along) {
    constexpr int lanes = lanes_of_floats<Floats>;
    const Vectors n = all<Floats>(&along.x);
    Floats heights[std::size_t{most_outer_points} / std::size_t{lanes}], best = all<Floats>(-0x1p100F);
    for (int first = 0; first < points.count; first += lanes) {
      heights[first / lanes] = dot(n, some(points, first));
      best = greater(best, heights[first / lanes]);
    }
    float most = best[0];
    for (int i = 1; i < lanes; ++i) most = best[i] > most ? best[i] : most;
    for (int first = 0; first < points.count; first += lanes) {
      const unsigned there = set_of_lanes(heights[first / lanes] == all<Floats>(most));
      if (there != 0) return {most, first + __builtin_ctz(there)};
    }
    return {most, 0};
  }

  [[gnu::always_inline]] static float length_of(const Vector& v) { return square_root(all<Floats>(dot(v, v)))[0]; }

  [[gnu::always_inline]] void find_normal() {
    constexpr int most_steps = 8;
    constexpr float enough = 0.5F;  // of the widest gap
    Vector v = way_;
    float distance = 0x1p100F;  // the hulls are no farther apart
    for (int step = 0; step < most_steps; ++step) {
      const float length = length_of(v);
      if (!(length > view_.margin)) return;
      const Vector in_b = seen_from_b(v);
      const Farthest p = farthest(a_, v), q = farthest(b_, -1.0F * in_b);
      const float gap = (dot(way_, v) - view_.unit_b * q.height - view_.unit_a * p.height) / length - view_.round;
      if (gap > 2 * view_.margin && gap > widest_) {
        widest_ = gap;
        n_ = ((1 - 0x1p-20F) / length) * v;
        near_a_ = p.place, near_b_ = q.place;
      }
      const Vector w = way_ + view_.unit_b * seen_from_a(point(b_, q.place)) - view_.unit_a * point(a_, p.place);
      const Vector d = w - v;
      const float square = dot(d, d), towards = -dot(v, d);
      if (step == 0 || towards >= square) {
        v = w;
      } else if (towards > 0) {
        v = v + (towards / square) * d;
      }
      const float nearer = length_of(v) - view_.round;
      distance = nearer < distance ? nearer : distance;
      if (widest_ >= enough * distance) return;
    }
  }

  const FloatView& view_;
  const PointsTogether& a_;
  const PointsTogether& b_;
  Vector way_;
  float widest_ = 0;  ///< how far they are apart along the normal; 0 if none has been found
  Vector n_{};        ///< the normal, from a to b, in the axes of a
  int near_a_ = 0, near_b_ = 0;
};

}  // namespace kds::collision::detail
