// Which gaps two moving shapes may close, and when, in plain doubles.
#pragma once

#include "certificates/point_motion.hpp"
#include "collision/narrow_phase/relative_motion.hpp"
#include "collision/narrow_phase/time_spans.hpp"
#include "kds/arithmetic/lattice.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace kds::collision {

/// The motion of b seen from a about `now`, with one bound on the error of everything that is read from it until the
/// horizon: a filter. What it says for sure is true of the motions as they are; what it does not, exact signs decide.
///
/// A *gap* is side * axis . r(tau) - reach, with |axis| <= 1 up to rounding and a reach of at most three times `size`,
/// added up of at most nine numbers. tau is the time since now.
///
/// Error bound, with u = 2^-53, M_i a bound on the coordinates of coefficient i, T the last tau and M = M_0 + M_1 T +
/// M_2 T^2. A coordinate of a coefficient is known to 8 u M_i; its product with an axis, whose 1-norm is below 1.74, to
/// 20 u M_i. A value at tau adds 7 u M; roots are those of a polynomial with coefficients off by 8 u, which is 14 u M,
/// at times off by 2 u, 4 u M. The reach is known to 33 u size, and takes part in what is rounded. That is less than
/// 60 u (M + 2 size); charged are 128 u, so that a gap that is closed by rounding alone is never taken for one that
/// stays open, nor the other way round. T is no longer than it takes for the highest term to outgrow the others, after
/// which boxes part for good (settle()); where M would be 2^20 times what it is now the filter ends in any case.
template <int Degree>
class QuickMotion {
 public:
  using Path = certificates::PointMotion<Degree>;
  /// axis . r(tau), constant first.
  using Along = std::array<double, std::size_t{Degree} + 1>;

  QuickMotion(const Path& a, const Path& b, double now, double horizon, double size);

  Along along(const Eigen::Vector3d& axis) const;

  double error() const { return error_; }
  double rate_error() const { return rate_error_; }
  double tau(double t) const { return t - now_; }
  /// A double not later than now + tau, by 2^-20 of tau: so far off a root that it is an ordinary root from there.
  double time_before(double tau) const;

  /// A double not earlier than now + tau.
  double time_after(double tau) const { return next_up(next_up(now_ + tau * (1 + 0x1p-20))); }

  /// The last tau of which anything is said; if `whole` nothing happens after it until the horizon.
  double end() const { return end_; }
  bool whole() const { return whole_; }
  /// Looks whether one side of a gap, open at the end, can only open further from there on. That makes it whole.
  void settle(const Along& p, double reach) {
    whole_ = whole_ || opens_for_good(p, 1, reach) || opens_for_good(p, -1, reach);
  }

  /// Shrinks the window, within [0, end()], to times at which the gap may be closed; false if there are none.
  bool clip(const Along& p, double side, double reach, TimeWindow& window) const;
  bool surely_closed(const Along& p, double side, double reach, double tau) const;
  /// For a gap that is closed at t: a time before which it surely stays so, t itself, or infinity.
  double closed_until(const Along& p, double side, double reach, double t) const;

  /// For a gap that may be touching now: a tau by which it has surely opened without turning, or infinity.
  double opened_by(const Along& p, double side, double reach) const;

  static double value(const Along& p, double tau) {
    if constexpr (Degree == 1) {
      return p[0] + tau * p[1];
    } else {
      return p[0] + tau * (p[1] + tau * p[2]);
    }
  }

 private:
  bool opens_for_good(const Along& p, double side, double reach) const;

  static constexpr double unit = 0x1p-46;
  static constexpr double most_growth = 0x1p20;

  std::array<Eigen::Vector3d, std::size_t{Degree} + 1> r_;
  double now_;
  double end_;
  double error_;
  double rate_error_;  ///< of the derivative of a gap now
  double bend_error_;  ///< of half its second derivative
  bool whole_;
};

// ---------------------------------------------------------------------------------------------------------------

template <int Degree>
QuickMotion<Degree>::QuickMotion(const Path& a, const Path& b, double now, double horizon, double size) : now_(now) {
  static_assert(Degree == 1 || Degree == 2);
  const auto greatest = [](const Eigen::Vector3d& v) {
    return std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
  };
  const double elapsed_a = now - a.start;
  const double elapsed_b = now - b.start;
  const double time_a = std::abs(elapsed_a);
  const double time_b = std::abs(elapsed_b);
  const auto& ca = a.coefficients;
  const auto& cb = b.coefficients;
  std::array<double, std::size_t{Degree} + 1> most;
  const double speed_a = greatest(ca[1]);
  const double speed_b = greatest(cb[1]);
  most[0] = greatest(ca[0]) + greatest(cb[0]) + time_a * speed_a + time_b * speed_b;
  if constexpr (Degree == 1) {
    r_[0] = (cb[0] + elapsed_b * cb[1]) - (ca[0] + elapsed_a * ca[1]);
    r_[1] = cb[1] - ca[1];
    most[1] = greatest(r_[1]);
  } else {
    const Eigen::Vector3d bend_a = elapsed_a * ca[2];
    const Eigen::Vector3d bend_b = elapsed_b * cb[2];
    r_[0] = (cb[0] + elapsed_b * (cb[1] + bend_b)) - (ca[0] + elapsed_a * (ca[1] + bend_a));
    r_[1] = (cb[1] + 2 * bend_b) - (ca[1] + 2 * bend_a);
    r_[2] = cb[2] - ca[2];
    const double bends_a = greatest(bend_a);
    const double bends_b = greatest(bend_b);
    most[0] += time_a * bends_a + time_b * bends_b;
    most[1] = speed_a + speed_b + 2 * (bends_a + bends_b);
    most[2] = greatest(r_[2]);
  }
  const double base = most[0] + 2 * size;
  // Long enough for the highest term to outgrow the others along some axis of a box: see settle().
  const double near = greatest(r_[0]) + 2 * size;
  const double speed = greatest(r_[1]);
  double settled = 16 * near / speed;
  if constexpr (Degree == 2) {
    if (most[2] > 0) settled = 8 * std::max(std::sqrt(near / most[2]), speed / most[2]);
  }
  end_ = horizon - now;
  whole_ = true;
  const auto end_at = [this](double last) {
    if (end_ <= last) return;
    end_ = last;
    whole_ = false;
  };
  end_at(0x1p200);
  if (settled > 0) end_at(settled);
  if (most[1] > 0) end_at(most_growth * base / most[1]);
  if constexpr (Degree == 2) {
    if (most[2] > 0) end_at(std::sqrt(most_growth * base / most[2]));
    error_ = unit * (base + end_ * (most[1] + end_ * most[2]));
  } else {
    error_ = unit * (base + end_ * most[1]);
  }
  rate_error_ = unit * most[1];
  bend_error_ = Degree == 2 ? unit * most[Degree] : 0;
  if (!(end_ >= 0)) end_ = 0;  // a horizon that is past: nothing will be asked
}

template <int Degree>
auto QuickMotion<Degree>::along(const Eigen::Vector3d& axis) const -> Along {
  Along p;
  for (std::size_t i = 0; i <= Degree; ++i) p[i] = dot(axis, r_[i]);
  return p;
}

template <int Degree>
double QuickMotion<Degree>::time_before(double tau) const {
  if (!(tau > 0)) return now_;
  return std::max(now_, next_down(next_down(now_ + tau * (1 - 0x1p-20))));
}

template <int Degree>
bool QuickMotion<Degree>::clip(const Along& p, double side, double reach, TimeWindow& window) const {
  if constexpr (Degree == 1) {
    return clip_to_negative(side * p[0] - reach - error_, side * p[1], window);
  } else {
    return clip_to_negative(side * p[0] - reach - error_, side * p[1], side * p[2], window);
  }
}

template <int Degree>
bool QuickMotion<Degree>::surely_closed(const Along& p, double side, double reach, double tau) const {
  return tau <= end_ && side * value(p, tau) - reach < -error_;
}

template <int Degree>
bool QuickMotion<Degree>::opens_for_good(const Along& p, double side, double reach) const {
  if (!(side * value(p, end_) - reach > 2 * error_)) return false;
  if constexpr (Degree == 1) {
    return side * p[1] > rate_error_;
  } else {
    const double bend = side * p[2];
    const double rate = side * p[1] + 2 * end_ * bend;
    const bool rises = rate > 2 * (rate_error_ + end_ * bend_error_);
    return rises && (bend > bend_error_ || bend_error_ == 0);  // no error: no bend
  }
}

/// Twice the error is enough; it takes more of it, so that what follows starts from an ordinary place.
template <int Degree>
double QuickMotion<Degree>::opened_by(const Along& p, double side, double reach) const {
  if (side * p[0] - reach > error_) return TimeSpans::infinity;  // does not touch
  const double rate = side * p[1];
  const double opened = 64 * error_ / rate;
  if (!(rate > 4 * rate_error_) || !(opened < end_)) return TimeSpans::infinity;
  if constexpr (Degree == 2) {
    if (!(rate + 2 * opened * std::min(side * p[2], 0.0) > 0.5 * rate)) return TimeSpans::infinity;
  }
  return side * value(p, opened) - reach > 2 * error_ ? opened : TimeSpans::infinity;
}

template <int Degree>
double QuickMotion<Degree>::closed_until(const Along& p, double side, double reach, double t) const {
  const double c0 = side * p[0] - reach + error_;
  TimeSpans closed;
  if constexpr (Degree == 1) {
    closed = negative_spans(c0, side * p[1]);
  } else {
    closed = negative_spans(c0, side * p[1], side * p[2]);
  }
  const double from = tau(t);
  if (from > end_ || !closed.contains(from)) return t;
  const double until = closed.leave(from);
  if (until > end_ && whole_) return TimeSpans::infinity;
  return std::max(t, time_before(std::min(until, end_)));
}

}  // namespace kds::collision
