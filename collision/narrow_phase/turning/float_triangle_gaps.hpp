// Pairs of triangles of bodies that turn: for how long they are apart, in floats, side by side.
#pragma once

#include "collision/narrow_phase/turning/float_vectors.hpp"
#include "collision/narrow_phase/turning/float_view.hpp"

namespace kds::collision::detail {

/// For as many pairs of triangles as there are lanes: along which of the 11 directions that can separate them they are
/// farthest apart at the time of a view, and for how long they are apart along that direction. It is the product of two
/// edges, of one triangle or of both, and turns with them.
///
/// Units and margin are those of the view (NodesView): a corner is as good as the centre of a node, and a gap has no
/// half edges besides. Edges need not be exact: any vectors P and Q of at most unit length that turn with the bodies
/// make a direction P x Q, along which the corners tell a gap.
template <class Floats>
class TriangleGaps {
 public:
  using Vectors = FloatVectors<Floats>;
  using Bits = BitsOf<Floats>;

  /// `first`: of the pairs.
  [[gnu::always_inline]] TriangleGaps(const FloatView& view, const TrianglesTogether& triangles, int first)
      : view_(view),
        way_now_(all<Floats>(view.way_now)),
        turn_a_(all<Floats>(view.turn_a)),
        turn_b_(all<Floats>(view.turn_b)) {
    for (int i = 0; i < 3; ++i) {
      a_[i] = corners(triangles.a[i], first);
      const Vectors of_b = corners(triangles.b[i], first);
      b_[i] = of_b.x * all<Floats>(view.columns[0]) + of_b.y * all<Floats>(view.columns[1]) +
              of_b.z * all<Floats>(view.columns[2]);
    }
    for (int i = 0; i < 3; ++i) {
      u_[i] = unit(a_[(i + 1) % 3] - a_[i]);
      v_[i] = unit(b_[(i + 1) % 3] - b_[i]);
    }
    find_widest();
  }

  /// For how much of the time ahead all corners of b are beyond all corners of a. At first what turns is followed to
  /// the end of that time, then for some times as long as that has given.
  [[gnu::always_inline]] Floats parts() const {
    const Direction n = direction();
    const Heights of_a = heights(n, turn_a_, a_), of_b = heights(n, turn_b_, b_);
    const Vectors way_rate = all<Floats>(view_.way_rate);
    const Floats least_b = least(of_b.value), most_a = most(of_a.value);
    const Floats f0 = dot(n.value, way_now_) + least_b - most_a - view_.margin;
    const Floats rate_of_way = dot(n.rate, way_now_) + dot(n.value, way_rate);
    const Floats half_rate = dot(n.rate, way_rate);
    const Floats bend = dot(n.bend, way_now_) + half_rate + half_rate + dot(n.value, all<Floats>(view_.way_bend)) +
                        least(of_b.bend) - most(of_a.bend);
    // The least of some linear functions is above its chord.
    const auto until = [&](Floats end) __attribute__((always_inline)) {
      const Floats chord = least_at(of_b, end) - least_b - (most_at(of_a, end) - most_a);
      return lesser(positive_part(f0, rate_of_way + chord / end, bend, all<Floats>(view_.third_of_products)), end);
    };
    const Floats one = all<Floats>(1), part = until(one);
    return greater(part, until(lesser(greater(4.0F * part, all<Floats>(0x1p-10F)), one)));
  }

 private:
  struct Direction {
    Vectors value, rate, bend;
  };
  /// The heights of three corners, without the way between the bodies.
  struct Heights {
    Floats value[3], rate[3], bend[3];
  };
  [[gnu::always_inline]] static Floats least(const Floats (&x)[3]) { return lesser(lesser(x[0], x[1]), x[2]); }
  [[gnu::always_inline]] static Floats most(const Floats (&x)[3]) { return greater(greater(x[0], x[1]), x[2]); }
  /// The least of them after a time, without second derivatives.
  [[gnu::always_inline]] static Floats least_at(const Heights& of, Floats s) {
    return least({of.value[0] + s * of.rate[0], of.value[1] + s * of.rate[1], of.value[2] + s * of.rate[2]});
  }
  [[gnu::always_inline]] static Floats most_at(const Heights& of, Floats s) {
    return most({of.value[0] + s * of.rate[0], of.value[1] + s * of.rate[1], of.value[2] + s * of.rate[2]});
  }

  [[gnu::always_inline]] static Vectors corners(const float (&triangles)[most_together][4], int first) {
    const float* rows[lanes_of_floats<Floats>];
    for (int i = 0; i < lanes_of_floats<Floats>; ++i) rows[i] = triangles[first + i];
    return vectors_at<Floats>(rows, 0);
  }
  [[gnu::always_inline]] static Vectors unit(const Vectors& x) {
    const Floats length = square_root(dot(x, x));
    return where(length > Floats{}, (1 - 0x1p-20F) / length) * x;
  }

  /// Of n . x for points x that turn: n . (w x x) is (n x w) . x.
  [[gnu::always_inline]] static Heights heights(const Direction& n, const Vectors& w, const Vectors (&points)[3]) {
    const Vectors first = n.rate + cross(n.value, w);
    const Vectors second = n.bend + cross(n.rate + first, w);
    Heights of;
    for (int i = 0; i < 3; ++i) {
      of.value[i] = dot(n.value, points[i]), of.rate[i] = dot(first, points[i]), of.bend[i] = dot(second, points[i]);
    }
    return of;
  }

  /// Along the products of an edge of either, and of two edges of one.
  [[gnu::always_inline]] void find_widest() {
    constexpr float least_sine = 0x1p-6F;  // edges that are nearly parallel make no direction
    Floats widest = all<Floats>(-0x1p100F);
    const auto note = [&](const Vectors& n, int first, int second, Floats low_a, Floats high_a, Floats low_b,
                          Floats high_b) __attribute__((always_inline)) {
      const Floats sine = square_root(dot(n, n)), between = dot(n, way_now_);
      const Floats forward = between + low_b - high_a, back = low_a - high_b - between;
      const Floats gap = greater(forward, back) / sine;
      const Bits wider = (gap > widest) & (sine > least_sine);
      widest = where(wider, gap, widest);
      first_ = (wider & first) | (~wider & first_);
      second_ = (wider & second) | (~wider & second_);
      sense_ = where(wider, forward - back, sense_);
    };
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        // Both ends of either edge are as far: the other corner tells on which side its triangle lies.
        const Vectors n = cross(u_[i], v_[j]);
        const Floats on_a = dot(n, a_[i]), other_a = dot(n, a_[(i + 2) % 3]);
        const Floats on_b = dot(n, b_[j]), other_b = dot(n, b_[(j + 2) % 3]);
        note(n, i, j, lesser(on_a, other_a), greater(on_a, other_a), lesser(on_b, other_b), greater(on_b, other_b));
      }
    }
    const auto note_face = [&](const Vectors& n, int of) __attribute__((always_inline)) {
      const Floats of_a[3] = {dot(n, a_[0]), dot(n, a_[1]), dot(n, a_[2])};
      const Floats of_b[3] = {dot(n, b_[0]), dot(n, b_[1]), dot(n, b_[2])};
      note(n, of, of, least(of_a), most(of_a), least(of_b), most(of_b));
    };
    note_face(cross(u_[0], u_[1]), face_a);
    note_face(cross(v_[0], v_[1]), face_b);
  }

  /// From a to b.
  [[gnu::always_inline]] Direction direction() const {
    const Bits of_a = first_ == face_a, of_b = first_ == face_b;
    Vectors p = where<Floats>(first_ == 1, u_[1], where<Floats>(first_ == 2, u_[2], u_[0]));
    Vectors q = where<Floats>(second_ == 1, v_[1], where<Floats>(second_ == 2, v_[2], v_[0]));
    p = where(of_b, v_[0], p);
    q = where(of_a, u_[1], where(of_b, v_[1], q));
    const Vectors turn_p = where(of_b, turn_b_, turn_a_), turn_q = where(of_a, turn_a_, turn_b_);
    p = signed_by(sense_, p);
    const Vectors p1 = cross(turn_p, p), q1 = cross(turn_q, q), both = cross(p1, q1);
    return {cross(p, q), cross(p1, q) + cross(p, q1),
            cross(cross(turn_p, p1), q) + both + both + cross(p, cross(turn_q, q1))};
  }

  static constexpr int face_a = 3, face_b = 4;

  const FloatView& view_;
  Vectors way_now_, turn_a_, turn_b_;
  Vectors a_[3], b_[3], u_[3], v_[3];  ///< corners and edges in the axes of a, about the origin of their body
  Bits first_{}, second_{};            ///< the direction of the widest gap: the edges whose product it is, or a face
  Floats sense_ = all<Floats>(1);      ///< negative if it points from b to a
};

}  // namespace kds::collision::detail
