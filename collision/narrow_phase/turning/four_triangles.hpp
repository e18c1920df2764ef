// Four pairs of triangles of bodies that turn: for how long they are apart, in floats.
#pragma once

#include "collision/narrow_phase/turning/four_vectors.hpp"
#include "collision/narrow_phase/turning/turning_nodes.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>

namespace kds::collision {

/// The corners of four triangles of a body, from its origin, in its axes.
using FourTriangles = std::array<std::array<Eigen::Vector3d, 3>, 4>;

/// Of each of four pairs of triangles, along which of the 11 directions that can separate them they are the farthest
/// apart at the time of a view, and for how long along that one, which turns with what it belongs to: the product of
/// two edges, of one triangle or of both.
///
/// Units and margin are those of the view (NodesView): a corner is as good as the centre of a node, and a gap has no
/// half edges besides. Edges need not be right: any vectors P and Q of at most unit length that turn with the bodies
/// make a direction P x Q, along which the corners tell a gap.
template <int Degree>
class TriangleGaps {
 public:
  TriangleGaps(const NodesView<Degree>& view, const FourTriangles& a, const FourTriangles& b) : view_(view) {
    const double scale = 1 / view.size;
    for (std::size_t i = 0; i < 3; ++i) {
      a_[i] = corners(a, i, scale);
      b_[i] = view.seen_from_a(corners(b, i, scale));
    }
    for (std::size_t i = 0; i < 3; ++i) {
      u_[i] = unit(a_[(i + 1) % 3] - a_[i]);
      v_[i] = unit(b_[(i + 1) % 3] - b_[i]);
    }
    find_widest();
  }

  /// For how much of the time ahead all corners of b are beyond all corners of a. At first what turns is followed to
  /// the end of that time, then for some times as long as that has given.
  FourFloats parts() const {
    const Direction n = direction();
    const Heights of_a = heights(n, view_.turn_a, a_), of_b = heights(n, view_.turn_b, b_);
    const FourFloats f0 = dot(n.value, view_.way_now) + of_b.least() - of_a.most() - view_.margin;
    const FourFloats way_rate = dot(n.rate, view_.way_now) + dot(n.value, view_.way_rate);
    const FourFloats half_rate = dot(n.rate, view_.way_rate);
    const FourFloats bend = dot(n.bend, view_.way_now) + half_rate + half_rate + dot(n.value, view_.way_bend) +
                            lesser(lesser(of_b.bend[0], of_b.bend[1]), of_b.bend[2]) -
                            greater(greater(of_a.bend[0], of_a.bend[1]), of_a.bend[2]);
    // The least of some linear functions is above its chord.
    const auto until = [&](FourFloats end) {
      const FourFloats chord = of_b.least_at(end) - of_b.least() - (of_a.most_at(end) - of_a.most());
      return lesser(positive_part(f0, way_rate + chord / end, bend, view_.third_of_products), end);
    };
    const FourFloats part = until(splat(1));
    const FourFloats sooner = lesser(greater(splat(4) * part, splat(0x1p-10F)), splat(1));
    return greater(part, until(sooner));
  }

 private:
  struct Direction {
    FourVectors value, rate, bend;
  };
  struct Heights {
    std::array<FourFloats, 3> value, rate, bend;

    FourFloats least() const { return lesser(lesser(value[0], value[1]), value[2]); }
    FourFloats most() const { return greater(greater(value[0], value[1]), value[2]); }
    /// After a time, but for what is bent.
    FourFloats least_at(FourFloats s) const {
      return lesser(lesser(value[0] + s * rate[0], value[1] + s * rate[1]), value[2] + s * rate[2]);
    }
    FourFloats most_at(FourFloats s) const {
      return greater(greater(value[0] + s * rate[0], value[1] + s * rate[1]), value[2] + s * rate[2]);
    }
  };

  static FourVectors corners(const FourTriangles& triangles, std::size_t i, double scale) {
    const auto scaled = [&](std::size_t k) { return lanes(Eigen::Vector3d(scale * triangles[k][i])); };
    return side_by_side(scaled(0), scaled(1), scaled(2), scaled(3));
  }
  static FourVectors unit(const FourVectors& x) {
    const FourFloats length = square_root(dot(x, x));
    return where(length > splat(0), splat(1 - 0x1p-20F) / length) * x;
  }

  /// Of n . x for points x that turn: n . (w x x) is (n x w) . x.
  static Heights heights(const Direction& n, const FourVectors& w, const std::array<FourVectors, 3>& points) {
    const FourVectors first = n.rate + cross(n.value, w);
    const FourVectors second = n.bend + cross(n.rate + first, w);
    Heights of;
    for (std::size_t i = 0; i < 3; ++i) {
      of.value[i] = dot(n.value, points[i]), of.rate[i] = dot(first, points[i]), of.bend[i] = dot(second, points[i]);
    }
    return of;
  }

  /// Direction 3 i + j is u_i x v_j; 9 is u_0 x u_1, and 10 v_0 x v_1.
  void find_widest() {
    const FourFloats least_sine = splat(0x1p-6F);  // edges that are nearly parallel make no direction
    FourFloats widest = splat(-0x1p100F);
    const auto note = [&](const FourVectors& n, int k, FourFloats low_a, FourFloats high_a, FourFloats low_b,
                          FourFloats high_b) {
      const FourFloats sine = square_root(dot(n, n)), between = dot(n, view_.way_now);
      const FourFloats forward = between + low_b - high_a, back = low_a - high_b - between;
      const FourFloats gap = greater(forward, back) / sine;
      const FourFloatsBits wider = (gap > widest) & (sine > least_sine);
      widest = where(wider, gap, widest);
      direction_ = (wider & k) | (~wider & direction_);
      sense_ = where(wider, where(forward >= back, splat(1), splat(-1)), sense_);
    };
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        // Both ends of either edge are as far: the other corner tells on which side its triangle lies.
        const FourVectors n = cross(u_[i], v_[j]);
        const FourFloats on_a = dot(n, a_[i]), other_a = dot(n, a_[(i + 2) % 3]);
        const FourFloats on_b = dot(n, b_[j]), other_b = dot(n, b_[(j + 2) % 3]);
        note(n, static_cast<int>(3 * i + j), lesser(on_a, other_a), greater(on_a, other_a), lesser(on_b, other_b),
             greater(on_b, other_b));
      }
    }
    for (const int k : {9, 10}) {
      const FourVectors n = k == 9 ? cross(u_[0], u_[1]) : cross(v_[0], v_[1]);
      std::array<FourFloats, 3> of_a, of_b;
      for (std::size_t i = 0; i < 3; ++i) of_a[i] = dot(n, a_[i]), of_b[i] = dot(n, b_[i]);
      note(n, k, lesser(lesser(of_a[0], of_a[1]), of_a[2]), greater(greater(of_a[0], of_a[1]), of_a[2]),
           lesser(lesser(of_b[0], of_b[1]), of_b[2]), greater(greater(of_b[0], of_b[1]), of_b[2]));
    }
  }

  /// From a to b.
  Direction direction() const {
    FourVectors p{}, q{}, turn_p{}, turn_q{};
    const auto put = [](FourVectors& to, int lane, const FourVectors& from) {
      to.x[lane] = from.x[lane], to.y[lane] = from.y[lane], to.z[lane] = from.z[lane];
    };
    for (int lane = 0; lane < 4; ++lane) {
      const auto k = static_cast<std::size_t>(direction_[lane]);
      put(p, lane, k < 9 ? u_[k / 3] : (k == 9 ? u_[0] : v_[0]));
      put(q, lane, k < 9 ? v_[k % 3] : (k == 9 ? u_[1] : v_[1]));
    }
    const FourFloatsBits of_a = direction_ == 9, of_b = direction_ == 10;
    turn_p = where(of_b, view_.turn_b, view_.turn_a);
    turn_q = where(of_a, view_.turn_a, view_.turn_b);
    p = sense_ * p;
    const FourVectors p1 = cross(turn_p, p), q1 = cross(turn_q, q), both = cross(p1, q1);
    return {cross(p, q), cross(p1, q) + cross(p, q1),
            cross(cross(turn_p, p1), q) + both + both + cross(p, cross(turn_q, q1))};
  }

  const NodesView<Degree>& view_;
  std::array<FourVectors, 3> a_, b_, u_, v_;  ///< corners and edges in the axes of a, about the origin of their body
  FourFloatsBits direction_{};                ///< the one of the widest gap
  FourFloats sense_ = splat(1);               ///< 1 if it points from a to b, else -1
};

}  // namespace kds::collision
