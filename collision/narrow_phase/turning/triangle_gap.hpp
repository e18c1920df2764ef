// Two triangles that turn: how long they are surely apart, three corners at a time.
#pragma once

#include "certificates/positive_parabola.hpp"
#include "collision/narrow_phase/turning/hulls.hpp"
#include "collision/narrow_phase/turning/jets.hpp"
#include "collision/narrow_phase/turning/three_vectors.hpp"
#include "collision/narrow_phase/turning/turning_view.hpp"
#include "collision/shapes/support.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace kds::collision {

/// Two triangles at the time of a view, about the origins of their bodies: how far they are apart along each of their
/// 11 directions: normals of a and b, products of their edges.
template <int Degree>
class TrianglesSeen {
 public:
  TrianglesSeen(const TurningView<Degree>& view, const TriangleHull& a, const TriangleHull& b)
      : view_(view),
        hull_a_(a),
        hull_b_(b),
        a_(turned(view.matrix_a, side_by_side(a.points))),
        b_(turned(view.matrix_b, side_by_side(b.points))),
        u_(turned(view.matrix_a, side_by_side(a.edges))),
        v_(turned(view.matrix_b, side_by_side(b.edges))) {}

  /// Calls note(k, forward, back, square) for each direction: the gaps along it, with a behind b and before it, and the
  /// square of its length.
  template <class Note>
  [[gnu::always_inline]] void every_direction(const Note& note) const {
    for (const int k : {0, 1}) {
      const Eigen::Vector3d n = normal(k);
      const FourDoubles a = dots(n, a_), b = dots(n, b_);
      const double between = dot(n, view_.way.value);
      note(k, between + least(b) - most(a), least(a) - most(b) - between, 1.0);
    }
    // Along the product of two edges both ends of either are as far: the other corner tells on which side it lies.
    const ThreeVectors other_b{last_first(b_[0]), last_first(b_[1]), last_first(b_[2])};
    for (std::size_t i = 0; i < 3; ++i) {
      const Eigen::Vector3d u = vector(u_, i), on = vector(a_, i), other = vector(a_, (i + 2) % 3);
      const ThreeVectors n{FourDoubles(u[1]) * v_[2] - FourDoubles(u[2]) * v_[1],
                           FourDoubles(u[2]) * v_[0] - FourDoubles(u[0]) * v_[2],
                           FourDoubles(u[0]) * v_[1] - FourDoubles(u[1]) * v_[0]};
      const FourDoubles square = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
      const FourDoubles on_a = dots(on, n), other_a = dots(other, n), between = dots(view_.way.value, n);
      const FourDoubles on_b = n[0] * b_[0] + n[1] * b_[1] + n[2] * b_[2];
      const FourDoubles over_b = n[0] * other_b[0] + n[1] * other_b[1] + n[2] * other_b[2];
      const FourDoubles forward = between + lesser(on_b, over_b) - greater(on_a, other_a);
      const FourDoubles back = lesser(on_a, other_a) - greater(on_b, over_b) - between;
      for (std::size_t j = 0; j < 3; ++j) note(static_cast<int>(2 + 3 * i + j), forward[j], back[j], square[j]);
    }
  }

 protected:
  Eigen::Vector3d normal(int k) const {
    return k == 0 ? view_.in_world_a(hull_a_.normals[0]) : view_.in_world_b(hull_b_.normals[0]);
  }

  static double least(const FourDoubles& x) { return std::min({x[0], x[1], x[2]}); }
  static double most(const FourDoubles& x) { return std::max({x[0], x[1], x[2]}); }
  /// Lanes 2, 0, 1, 3.
  static FourDoubles last_first(const FourDoubles& x) { return {x[2], x[0], x[1], x[3]}; }

  const TurningView<Degree>& view_;
  const TriangleHull& hull_a_;
  const TriangleHull& hull_b_;
  ThreeVectors a_, b_, u_, v_;
};

/// Along which of these directions they are farthest apart, and for how long they are apart along it, as it turns with
/// the edges or the face that it belongs to.
template <int Degree>
class TriangleGap : private TrianglesSeen<Degree> {
 public:
  TriangleGap(const TurningView<Degree>& view, const TriangleHull& a, const TriangleHull& b)
      : TrianglesSeen<Degree>(view, a, b) {
    find_widest();
  }

  /// The widest gap; less than nothing if there is none.
  double width() const { return width_; }

  /// How long all corners of b are beyond all corners of a, along the direction of the widest gap.
  double open_for(double stretch) const {
    const Corners corners = this->corners(direction(), stretch);
    const auto &of_a = corners.of_a, &of_b = corners.of_b;
    // The pair of corners that is nearest is mostly the one that meets first, and then the others need one value each.
    std::size_t near_a = 0, near_b = 0;
    for (std::size_t i = 1; i < 3; ++i) {
      if (of_a.value[i] > of_a.value[near_a]) near_a = i;
      if (of_b.value[i] < of_b.value[near_b]) near_b = i;
    }
    double wait = positive_for(corners.gap(near_a, near_b), corners.bounds.third, stretch);
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        wait = std::min(wait, positive_for(corners.gap(i, j), corners.bounds.third, wait));
      }
    }
    return wait;
  }

  /// The same where the widest gap is zero but for roundings: how long they are apart, but for some roundings of that
  /// time at first, in which they may penetrate by roundings, and then part all the while: each corner of b that may be
  /// where they touch moves away from each such corner of a. 0 if that is not known.
  ///
  /// Of two such corners let f be the gap, at least -e at first, r a bound from below on f' at first, and f(x) >= -e +
  /// x g(x) with g(x) = r + bend x / 2 - third x^2 / 6. While g > r / 8, f > 0 from 8 e / r on; and until then f' > r /
  /// 2, which is asked, too. The points that the two share then are as combinations of such corners of a, and of b, so
  /// that they part at least that fast.
  double parts_for(double stretch) const {
    constexpr double least_sine = 0x1p-4;   // of edges: the unit vector across both is off by no more than is charged
    constexpr double least_part = 0x1p-20;  // of the speeds: what parts as slowly may not do so in other roundings
    constexpr double near = 4 * parallel_sine;  // of the radii: farther corners are none of those that touch
    const VectorJet n = direction();
    if (!(norm(n.value) >= least_sine)) return 0;
    const Corners corners = this->corners(n, stretch);
    const TurningBounds& bounds = corners.bounds;
    const double touching = near * (hull_a_.radius + hull_b_.radius);
    const double slowest = least_part * (norm(view_.way.rate) + view_.rate_a * hull_a_.radius +  //
                                         view_.rate_b * hull_b_.radius);
    double wait = stretch, parted = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        const Jet f = corners.gap(i, j);
        if (f.value > touching) {
          wait = std::min(wait, positive_for(f, bounds.third, wait));
          continue;
        }
        const double rate = f.rate - bounds.rate_rounding, bend = f.bend - bounds.bend_rounding;
        if (!(rate > slowest)) return 0;
        const double x = 8 * std::max(0.0, -f.value) / rate;
        if (!(x * (std::max(0.0, -bend) + 0.5 * bounds.third * x) < 0.5 * rate)) return 0;
        parted = std::max(parted, x);
        wait = std::min(wait, positive_for({0.875 * rate, 0.5 * bend, -bounds.third / 3}, 0, wait));
      }
    }
    return wait > parted ? wait : 0;
  }

  /// The same, along a direction that stays as it is in a: for bodies that turn nearly alike, of which open_for() does
  /// not know that one hardly moves as the other sees it. `all`: what there is to look at.
  ///
  /// Seen from a, which turns with the rate W, the way w has the velocity d = w' - W x w and the acceleration e = w'' -
  /// 2 W x w' + W x (W x w), of which |e'| <= 2 |W| |w''| + |W|^2 |w'|. With V the difference of the two rates, a point
  /// x of b has besides V x x and at most |V| (|W| + |W_b|) |x|. Roundings: those of PairFrame, of each of these.
  double open_seen_from_a(double stretch, double all) const {
    constexpr double rounding = PairFrame<Degree>::rounding;
    const VectorJet& way = view_.way;
    const Eigen::Vector3d &spin = view_.spin_a, apart = view_.spin_b - spin;
    const double rate = view_.rate_a, rates = rate + view_.rate_b, radius = hull_b_.radius;
    const double speed = norm(way.rate) + view_.rate_error, bend = norm(way.bend), far = norm(way.value);
    const double until = speed > 0 || bend > 0 ? stretch : all;
    const double slower = norm(apart) + 0x1p-50 * rates;

    const Eigen::Vector3d centre = cross(spin, way.value);
    const Eigen::Vector3d acceleration = way.bend - 2 * cross(spin, way.rate) + cross(spin, centre);
    const double change = speed > 0 || bend > 0 ? until * rate * (2 * bend + rate * (speed + until * bend)) : 0;
    const double most = norm(acceleration) + change + slower * rates * radius +
                        rounding * (bend + rate * (2 * speed + rate * far)) +
                        rate * (2 * view_.rate_error + rate * view_.way_error);
    const double error_of_rate =
        rounding * (speed + rate * far + rates * radius) + view_.rate_error + rate * view_.way_error;
    const double error_of_value = rounding * (far + hull_a_.radius + radius) + view_.way_error;

    const Eigen::Vector3d n = direction().value;
    const double nearest = Seen::most(dots(n, a_)) + error_of_value;
    const double along = dot(n, way.rate - centre) - error_of_rate;
    const FourDoubles places = dots(n, b_), rates_of_b = dots(cross(n, apart), b_);
    double wait = until;
    for (std::size_t i = 0; i < 3; ++i) {
      const double gap = dot(n, way.value) + places[i] - nearest;
      wait = std::min(wait, certificates::positive_for(gap, along + rates_of_b[i], -0.5 * (1 + 0x1p-30) * most));
    }
    return wait;
  }

 private:
  using Seen = TrianglesSeen<Degree>;
  using Seen::a_, Seen::b_, Seen::hull_a_, Seen::hull_b_, Seen::normal, Seen::u_, Seen::v_, Seen::view_;

  struct Jets {
    FourDoubles value, rate, bend;
  };

  /// Of n . x for points x that turn: n . (w x x) is (n x w) . x.
  static Jets jets(const VectorJet& n, const Eigen::Vector3d& w, const ThreeVectors& points) {
    const Eigen::Vector3d once = cross(n.value, w);
    const Eigen::Vector3d first = n.rate + once;
    const Eigen::Vector3d second = n.bend + cross(n.rate + first, w);
    return {dots(n.value, points), dots(first, points), dots(second, points)};
  }

  /// What tells how far each corner of b is beyond each of a, along a vector that turns, less what roundings make of
  /// it.
  struct Corners {
    TurningBounds bounds;  ///< for a stretch
    Jet base;
    Jets of_a, of_b;
    Jet gap(std::size_t i, std::size_t j) const {
      return {base.value + of_b.value[j] - of_a.value[i], base.rate + of_b.rate[j] - of_a.rate[i],
              base.bend + of_b.bend[j] - of_a.bend[i]};
    }
  };
  Corners corners(const VectorJet& n, double stretch) const {
    const double rate = k_ == 0 ? view_.rate_a : (k_ == 1 ? view_.rate_b : view_.rate_a + view_.rate_b);
    const TurningBounds bounds(view_, rate, hull_a_.radius, hull_b_.radius, stretch);
    Jet base = dot(n, view_.way);
    base.value -= bounds.rounding;
    return {bounds, base, jets(n, view_.spin_a, a_), jets(n, view_.spin_b, b_)};
  }

  void find_widest() {
    constexpr double least_square = 0x1p-20;  // of sines: edges that are nearly parallel make no direction
    this->every_direction([&](int k, double forward, double back, double square) {
      const double gap = std::max(forward, back);
      if (k >= 2) {
        if (!(square > least_square) || (width_ > 0 && !(gap > 0 && gap * gap > width_ * width_ * square))) return;
      }
      const double width = k < 2 ? gap : gap / std::sqrt(square);
      if (width > width_) width_ = width, k_ = k, sense_ = forward >= back ? 1 : -1;
    });
  }

  /// From a to b.
  VectorJet direction() const {
    if (k_ < 2) return sense_ * turning(normal(k_), k_ == 0 ? view_.spin_a : view_.spin_b);
    const auto k = static_cast<std::size_t>(k_ - 2);
    return sense_ * cross(turning(vector(u_, k / 3), view_.spin_a), turning(vector(v_, k % 3), view_.spin_b));
  }

  double width_ = -never;
  int k_ = 0;         ///< the direction of the widest gap
  double sense_ = 1;  ///< 1 if it points from a to b
};

}  // namespace kds::collision
