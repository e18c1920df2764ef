// Pairs of oriented boxes around parts of bodies that turn: for how long they are apart, in floats, side by side.
#pragma once

#include "collision/narrow_phase/turning/float_vectors.hpp"
#include "collision/narrow_phase/turning/float_view.hpp"

namespace kds::collision::detail {

/// The gaps of as many pairs of nodes as there are lanes, along a direction each, as they go on.
///
/// Method: along a unit vector n, from a to b, their gap is n . p - sum_k h_k |n . u_k|, with the half edges of both.
/// An n . u_k = x with its rate x' is at most |x| + s (|e| - |x|) / S + s^2 / 2 max |x''| until S, e = x + S x': a
/// convex function is below its chord. So the gap stays above a cubic.
template <class Floats>
class NodeGaps {
 public:
  using Vectors = FloatVectors<Floats>;
  using Bits = BitsOf<Floats>;

  [[gnu::always_inline]] NodeGaps(const FloatView& view, const float* const* a, const float* const* b)
      : view_(view), a_(a), b_(b), turn_a_(all<Floats>(view.turn_a)), turn_b_(all<Floats>(view.turn_b)) {
    for (int k = 0; k < 3; ++k) columns_[k] = all<Floats>(view.columns[k]);
    in_a_ = all<Floats>(view.unit_a) * vectors_at<Floats>(a, NodePlaces::centre);
    in_b_ = seen_from_a(all<Floats>(view.unit_b) * vectors_at<Floats>(b, NodePlaces::centre));
    p_ = all<Floats>(view.way_now) + in_b_ - in_a_;
  }

  [[gnu::always_inline]] void find_waits(float* part, unsigned& worth_it) {
    const Widest best = widest();
    by_a_ = cross(turn_a_, in_a_);
    by_b_ = cross(turn_b_, in_b_);
    rate_ = all<Floats>(view_.way_rate) + by_b_ - by_a_;
    const Floats parts = where(best.gap > view_.margin, part_along(best));
    __builtin_memcpy(part, &parts, sizeof parts);
    worth_it = set_of_lanes(parts >= least_part());
  }

  /// Whether they are surely farther apart than a margin.
  [[gnu::always_inline]] unsigned exceed(float margin) { return set_of_lanes(widest().gap > margin + view_.margin); }

 private:
  /// Vectors in the axes of b.
  [[gnu::always_inline]] Vectors seen_from_a(const Vectors& of_b) const {
    return of_b.x * columns_[0] + of_b.y * columns_[1] + of_b.z * columns_[2];
  }
  [[gnu::always_inline]] static Floats radii(const float* const* nodes) {
    Floats radii;
    for (int i = 0; i < lanes_of_floats<Floats>; ++i) radii[i] = nodes[i][NodePlaces::radius];
    return radii;
  }
  /// The directions of their edges.
  [[gnu::always_inline]] static void read_edges(const float* const* nodes, Vectors (&edges)[3]) {
    const Vectors x = vectors_at<Floats>(nodes, NodePlaces::axes), y = vectors_at<Floats>(nodes, NodePlaces::axes + 4),
                  z = vectors_at<Floats>(nodes, NodePlaces::axes + 8);
    edges[0] = {x.x, y.x, z.x}, edges[1] = {x.y, y.y, z.y}, edges[2] = {x.z, y.z, z.z};
  }

  /// The part of the time that is worth it: until they have moved by some part of their sizes.
  [[gnu::always_inline]] Floats least_part() const {
    const Floats radius_a = view_.unit_a * radii(a_), radius_b = view_.unit_b * radii(b_) + view_.round;
    const Floats speed = square_root(dot(rate_, rate_)) + view_.angle_a * radius_a + view_.angle_b * radius_b;
    return lesser((1.0F / 18) * (radius_a + radius_b) / speed, all<Floats>(1));
  }

  struct Widest {
    Floats gap;
    Vectors direction;
    Bits with_a, with_b;  ///< whether the direction turns with it
  };
  /// Along axes and the line of centres.
  [[gnu::always_inline]] Widest widest() {
    read_edges(a_, u_);
    read_edges(b_, v_);
    for (Vectors& v : v_) v = seen_from_a(v);
    half_a_ = all<Floats>(view_.unit_a) * vectors_at<Floats>(a_, NodePlaces::half_extents);
    half_b_ = all<Floats>(view_.unit_b) * vectors_at<Floats>(b_, NodePlaces::half_extents);
    Vectors x[3];  // of edge i of a along those of b
    for (int i = 0; i < 3; ++i) x[i] = magnitudes(Vectors{dot(u_[i], v_[0]), dot(u_[i], v_[1]), dot(u_[i], v_[2])});
    const Vectors along_a{dot(p_, u_[0]), dot(p_, u_[1]), dot(p_, u_[2])};
    const Vectors along_b{dot(p_, v_[0]), dot(p_, v_[1]), dot(p_, v_[2])};
    const Floats distance = square_root(dot(p_, p_)), over_distance = where(distance > Floats{}, 1.0F / distance);
    const Floats widths = dot(half_a_, magnitudes(along_a)) + dot(half_b_, magnitudes(along_b));
    Widest best{distance - over_distance * widths, over_distance * p_, {}, {}};
    const auto note = [&](Floats along, Floats extent, const Vectors& axis, Bits& with, Bits& other)
        __attribute__((always_inline)) {
      const Floats gap = magnitude(along) - extent;
      const Bits wider = gap > best.gap;
      best.gap = greater(gap, best.gap);
      best.direction = where(wider, signed_by(along, axis), best.direction);
      with |= wider, other &= ~wider;
    };
    note(along_a.x, half_a_.x + dot(half_b_, x[0]), u_[0], best.with_a, best.with_b);
    note(along_a.y, half_a_.y + dot(half_b_, x[1]), u_[1], best.with_a, best.with_b);
    note(along_a.z, half_a_.z + dot(half_b_, x[2]), u_[2], best.with_a, best.with_b);
    note(along_b.x, half_b_.x + dot(half_a_, Vectors{x[0].x, x[1].x, x[2].x}), v_[0], best.with_b, best.with_a);
    note(along_b.y, half_b_.y + dot(half_a_, Vectors{x[0].y, x[1].y, x[2].y}), v_[1], best.with_b, best.with_a);
    note(along_b.z, half_b_.z + dot(half_a_, Vectors{x[0].z, x[1].z, x[2].z}), v_[2], best.with_b, best.with_a);
    best.gap -= view_.round;
    return best;
  }

  [[gnu::always_inline]] Floats part_along(const Widest& widest) const {
    const Vectors& n = widest.direction;
    const Bits turns = widest.with_a | widest.with_b;
    const Vectors turn = where(widest.with_a, turn_a_, where(widest.with_b, turn_b_));
    const Vectors turned = cross(turn, p_);
    const Vectors rate = rate_ - turned;  // as seen from n, as all that follows
    const Vectors bend = all<Floats>(view_.way_bend) + cross(turn_b_, by_b_) - cross(turn_a_, by_a_) +
                         cross(turn, turned - rate_ - rate_);
    Floats f0 = dot(n, p_) - (view_.margin + view_.round), f1 = dot(n, rate), f2 = dot(n, bend);
    const auto take = [&](const Vectors& half, const Vectors(&axes)[3], const Vectors& turn_of, Floats angle)
        __attribute__((always_inline)) {
      const Vectors across = cross(n, turn_of - turn);
      const Vectors x{dot(n, axes[0]), dot(n, axes[1]), dot(n, axes[2])};
      const Vectors end{dot(across, axes[0]), dot(across, axes[1]), dot(across, axes[2])};
      const Floats now = dot(half, magnitudes(x));
      f0 -= now;
      f1 -= dot(half, magnitudes(x + end)) - now;
      f2 -= (half.x + half.y + half.z) * angle * angle;
    };
    const Floats angle_a = all<Floats>(view_.angle_a), angle_b = all<Floats>(view_.angle_b), both = angle_a + angle_b;
    take(half_a_, u_, turn_a_, where(~widest.with_a, where(turns, both, angle_a)));
    take(half_b_, v_, turn_b_, where(~widest.with_b, where(turns, both, angle_b)));
    const Floats third = where(widest.with_a, all<Floats>(view_.third[1]),
                               where(widest.with_b, all<Floats>(view_.third[2]), all<Floats>(view_.third[0])));
    return positive_part(f0, f1, f2, third);
  }

  const FloatView& view_;
  const float* const* a_;
  const float* const* b_;
  Vectors columns_[3], turn_a_, turn_b_;  ///< of the view
  Vectors in_a_, in_b_;                   ///< from the origins of the bodies to the centres
  Vectors p_;                             ///< from the centre of a to that of b
  Vectors by_a_, by_b_, rate_;            ///< how fast the centres turn, and p changes
  Vectors u_[3], v_[3];                   ///< the axes of either
  Vectors half_a_, half_b_;
};

}  // namespace kds::collision::detail
