// The times at which contacts of two shapes, one of them a mesh, have to be searched.
#pragma once

#include "collision/narrow_phase/mesh_margins.hpp"
#include "collision/narrow_phase/near_spans.hpp"
#include "collision/narrow_phase/obb_descent.hpp"
#include "collision/narrow_phase/relative_motion.hpp"
#include "collision/narrow_phase/separating_axes.hpp"
#include "collision/narrow_phase/time_spans.hpp"
#include "collision/vectors.hpp"
#include "kds/arithmetic/lattice.hpp"
#include "kds/certificate.hpp"
#include "kds/roots/failure_time.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace kds::collision::detail {

/// s; contacts farther ahead than 10^60 s are not predicted. Keeps polynomials of the time from overflowing.
inline constexpr double farthest = 0x1p200;

/// The relative motion of a pair, and the times at which its bounding balls are near each other.
template <int Degree>
class PairTimes {
 public:
  PairTimes(const RelativeMotion<Degree>& motion, const ContactGap<Degree>& gap, double radii)
      : motion_(motion), gap_(gap), radii_(radii) {
    for (std::size_t i = 0; i <= Degree; ++i) margin_[i] = quick_margin * gap.c[i];
    last_ = last_time();
  }

  /// Calls run(slice) for the parts of the window in which the bounding balls are near each other, in order,
  /// until it returns true. In each the margin is about the same and the path about straight, see `slice_end`.
  template <class Run>
  void slice_by_slice(const TimeWindow& window, const Run& run) const {
    TimeWindow left{window.begin, std::min(window.end, last_)};
    if constexpr (Degree >= 2) {
      // Most that are asked are near each other, and have their answer in the first slice: then it need not be found
      // out until when they are near, which costs more than the answer.
      const Eigen::Vector3d place = place_on(motion_.coefficients, left.begin);
      if (left.begin <= left.end && dot(place, place) < 0.99 * radii_ * radii_) {
        const TimeSlice slice{left.begin, slice_end(left.begin, left.end)};
        if (run(slice) || slice.end >= left.end) return;
        left.begin = slice.end;
      }
    }
    std::array<double, std::size_t{Degree} + 1> radius = margin_;
    radius[0] += radii_;
    const auto spans = near_spans(motion_.coefficients, radius, last_);
    for (std::size_t i = 0; i < stretches(spans); ++i) {
      double begin = std::max(left.begin, spans.begin[i]);
      const double end = std::min(left.end, spans.end[i]);
      while (begin <= end) {
        const TimeSlice slice{begin, slice_end(begin, end)};
        if (run(slice)) return;
        if (slice.end >= end || !(slice.end > begin)) break;
        begin = slice.end;
      }
    }
  }

 protected:
  RelativeMotion<Degree> motion_;
  ContactGap<Degree> gap_;
  std::array<double, std::size_t{Degree} + 1> margin_;
  double radii_;
  double last_;

 private:
  static std::size_t stretches(const TimeSpans&) { return 2; }
  template <std::size_t Most>
  static std::size_t stretches(const CurveSpans<Most>& spans) {
    return spans.size;
  }

  /// A time after which there are no contacts to find; a function of shapes and motion alone. By then the bounding
  /// balls are and stay apart, or the gap has become too wide to be useful: see `widest_gap`.
  double last_time() const {
    const auto& g = gap_.c;
    const double excess = g[0] - std::max(4 * g[0], widest_gap * radii_);
    if constexpr (Degree >= 3) {
      // The time at which the gap, which only grows, has become that wide. (Bodies that part without end need no bound
      // of their own: they have ceased to be near each other.)
      std::array<double, std::size_t{Degree} + 1> room;
      for (std::size_t i = 0; i <= Degree; ++i) room[i] = -g[i];
      room[0] = -excess;
      return std::min(failure_time(PolynomialCertificate<Degree>{{{room}, 0.0}}, 0.0, farthest), farthest);
    } else if constexpr (Degree == 1) {
      return g[1] > 0 ? std::min(-excess / g[1], farthest) : farthest;
    } else {
      double last = farthest;
      if (g[1] > 0 || g[2] > 0) last = std::min(last, quadratic_roots(excess, g[1], g[2]).rising);
      // By the triangle inequality: |r2| tau^2 <= |r0| + |r1| tau + radius.
      const auto& r = motion_.coefficients;
      const double c2 = norm(r[2]) - margin_[2];
      if (!(c2 > 0)) return last;
      const auto roots = quadratic_roots(-(norm(r[0]) + radii_ + margin_[0]), -(norm(r[1]) + margin_[1]), c2);
      return std::min(roots.rising * (1 + ContactGap<Degree>::roundings), last);
    }
  }

  /// A slice ends before the margin has both doubled and grown to a large part of the shapes (which is soon only if
  /// bodies hardly move, so that the error of their speeds exceeds the speeds), and before a curved path is too far
  /// from its chord for useful box tests. At rest one slice is enough.
  double slice_end(double begin, double end) const {
    constexpr double large = 0x1p-11;  // of the gap: quick_margin times that is the margin
    constexpr double most_bend = 0x1p-3;
    const auto& r = motion_.coefficients;
    if constexpr (Degree >= 3) {
      end = std::max(std::min(end, begin + nearly_straight(begin, end - begin)), std::min(end, next_up(begin)));
    } else if constexpr (Degree == 1) {
      if (r[1].isZero(0) && gap_.c[1] == 0) return begin;
    } else {
      const double bend = norm(r[2]);
      if (bend > 0) end = std::min(end, begin + std::sqrt(4 * most_bend * radii_ / bend));
    }
    const double most = std::max(2 * gap_(begin), large * radii_);
    while (gap_(end) > most) {
      const double earlier = begin + (end - begin) / 4;
      if (!(earlier > begin)) break;
      end = earlier;
    }
    return end;
  }

  /// A time, the whole one halved a number of times, in which the terms of the path above the linear one come to no
  /// more than half of the shapes' size: as far from the chord as a parabola may be.
  double nearly_straight(double begin, double whole) const {
    std::array<double, std::size_t{Degree} + 1> size;
    for (int i = 2; i <= Degree; ++i) size[static_cast<std::size_t>(i)] = norm(motion_.coefficient(i, begin));
    const auto curve = [&](double time) {
      double sum = 0;
      for (std::size_t i = Degree; i >= 2; --i) sum = (sum + size[i]) * time;
      return sum * time;
    };
    double time = whole;
    while (time > 0 && !(curve(time) <= 0.5 * radii_)) time *= 0.5;
    return time;
  }
};

}  // namespace kds::collision::detail
