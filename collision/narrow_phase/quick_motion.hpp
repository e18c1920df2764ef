// Which gaps between two moving shapes may close, and when, in plain doubles.
#pragma once

#include "certificates/point_motion.hpp"
#include "collision/narrow_phase/curve_spans.hpp"
#include "collision/narrow_phase/relative_motion.hpp"
#include "collision/narrow_phase/time_spans.hpp"
#include "kds/arithmetic/lattice.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace kds::collision {

/// The motion of b relative to a about `now`, with one error bound for all values computed from it until the horizon: a
/// filter. Its certain answers are true of the exact motions; where it has none, exact signs decide. It takes 0.7 of
/// the time of a RelativeMotion for lines, 0.3 for parabolas and 0.6 for cubics (docs/benchmarks.md, "Relative
/// motion").
///
/// A *gap* is side * axis . r(tau) - distance, with |axis| <= 1 up to rounding and a distance of at most three times
/// `size`, added up of at most nine numbers. tau is the time since now.
///
/// Error bound, with u = 2^-53, M_i a bound on the coordinates of coefficient i, T the last tau and M = M_0 + M_1 T +
/// M_2 T^2. A coordinate of a coefficient is known to 8 u M_i; its product with an axis, whose 1-norm is below 1.74, to
/// 20 u M_i. A value at tau adds 7 u M; roots are those of a polynomial with coefficients off by 8 u, which is 14 u M,
/// at times off by 2 u, 4 u M. The distance is known to 33 u size, and is part of the rounded sums. That is less than
/// 60 u (M + 2 size); charged are 128 u, so that a gap that is closed by rounding alone is never taken for one that
/// stays open, nor the other way round. T ends when the highest term has outgrown the others, after which boxes part
/// without end (note_parting()); where M would be 2^20 times what it is now the filter ends in any case.
///
/// Degree n = 3 to 5: M has the terms M_i T^i, and the filter ends at that growth alone. Moving a coefficient to now
/// takes a term through 5 n roundings (detail::shifted_balls() in kds/motion.hpp) and one for the difference; the axis
/// makes that 1.74 (5 n + 4) u M_i; a window is cut by Bernstein coefficients, which are good to 5 n + 8 of the sum of
/// the magnitudes (certificates::positive_until() charges that itself), and values by Horner's rule to 2 n + 1. That is
/// below 51 + 33 + 11 u (M + 2 size); charged are 256 u.
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
  /// A double earlier than now + tau by 2^-20 of tau: so far from a root that the search from there is well
  /// conditioned.
  double time_before(double tau) const;

  /// A double not earlier than now + tau.
  double time_after(double tau) const { return next_up(next_up(now_ + tau * (1 + 0x1p-20))); }

  /// The last tau for which there are answers; if `whole` nothing happens after it until the horizon.
  double end() const { return end_; }
  bool whole() const { return whole_; }
  /// Tests whether one side of a gap, open at the end, can only open further from there on. If so, `whole` becomes
  /// true.
  void note_parting(const Along& p, double distance) {
    note_opening(p, 1, distance);
    note_opening(p, -1, distance);
  }
  /// The same of one side, where the other is no gap.
  void note_opening(const Along& p, double side, double distance) {
    whole_ = whole_ || opens_for_good(p, side, distance);
  }

  /// Shrinks the window, within [0, end()], to times at which the gap may be closed; false if there are none.
  bool clip(const Along& p, double side, double distance, TimeWindow& window) const;
  bool surely_closed(const Along& p, double side, double distance, double tau) const;
  /// For a gap that is closed at t: a time before which it certainly stays closed, t itself, or infinity.
  double closed_until(const Along& p, double side, double distance, double t) const;

  /// For a gap that may be touching now: a tau by which it has certainly opened without turning, or infinity.
  double opened_by(const Along& p, double side, double distance) const;

  static double value(const Along& p, double tau) {
    if constexpr (Degree == 1) {
      return p[0] + tau * p[1];
    } else if constexpr (Degree == 2) {
      return p[0] + tau * (p[1] + tau * p[2]);
    } else {
      return derivative_at(p, 0, tau);
    }
  }

 private:
  bool opens_for_good(const Along& p, double side, double distance) const;
  void begin_curve(const Path& a, const Path& b, double horizon, double size);
  std::array<double, std::size_t{Degree} + 1> gap(const Along& p, double side, double constant) const;

  static constexpr double unit = Degree <= 2 ? 0x1p-46 : 0x1p-45;
  static constexpr double most_growth = 0x1p20;

  std::array<Eigen::Vector3d, std::size_t{Degree} + 1> r_;
  double now_;
  double end_;
  double error_;
  double rate_error_;  ///< of the derivative of a gap now
  double bend_error_;  ///< of half its second derivative
  bool whole_;
  /// Degree 3 and above: which coefficients are known to be zero.
  std::array<bool, Degree >= 3 ? std::size_t{Degree} + 1 : 0> still_;
};

// ---------------------------------------------------------------------------------------------------------------

template <int Degree>
QuickMotion<Degree>::QuickMotion(const Path& a, const Path& b, double now, double horizon, double size) : now_(now) {
  if constexpr (Degree >= 3) {
    begin_curve(a, b, horizon, size);
    return;
  }
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
  } else if constexpr (Degree == 2) {
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
  // Long enough for the highest term to outgrow the others along some axis of a box: see note_parting().
  const double near = greatest(r_[0]) + 2 * size;
  const double speed = greatest(r_[1]);
  double far = 16 * near / speed;
  if constexpr (Degree == 2) {
    if (most[2] > 0) far = 8 * std::max(std::sqrt(near / most[2]), speed / most[2]);
  }
  end_ = horizon - now;
  whole_ = true;
  const auto end_at = [this](double last) {
    if (end_ <= last) return;
    end_ = last;
    whole_ = false;
  };
  end_at(0x1p200);
  if (far > 0) end_at(far);
  if (most[1] > 0) end_at(most_growth * base / most[1]);
  if constexpr (Degree == 2) {
    if (most[2] > 0) end_at(std::sqrt(most_growth * base / most[2]));
    error_ = unit * (base + end_ * (most[1] + end_ * most[2]));
  } else {
    error_ = unit * (base + end_ * most[1]);
  }
  rate_error_ = unit * most[1];
  bend_error_ = Degree == 2 ? unit * most[Degree] : 0;
  if (!(end_ >= 0)) end_ = 0;  // a horizon in the past: there will be no queries
}

/// Degree 3 and above. When bodies part is not searched any earlier: the end is the horizon, or the time at which the
/// path has grown so much that its highest term dominates, or unknown.
template <int Degree>
void QuickMotion<Degree>::begin_curve(const Path& a, const Path& b, double horizon, double size) {
  const auto greatest = [](const Eigen::Vector3d& v) { return v.cwiseAbs().maxCoeff(); };
  std::array<double, std::size_t{Degree} + 1> most{};
  const double time_a = std::abs(now_ - a.start);
  const double time_b = std::abs(now_ - b.start);
  for (int d = 0; d < 3; ++d) {
    const auto of_a = taylor_shift<double>(a.axis(d).position, now_ - a.start);
    const auto of_b = taylor_shift<double>(b.axis(d).position, now_ - b.start);
    for (std::size_t i = 0; i <= Degree; ++i) r_[i][d] = of_b.c[i] - of_a.c[i];
  }
  for (std::size_t i = 0; i <= Degree; ++i) {
    double power_a = 1, power_b = 1, binomial = 1;  // of j over i
    for (std::size_t j = i; j <= Degree; ++j) {
      most[i] += binomial * (greatest(a.coefficients[j]) * power_a + greatest(b.coefficients[j]) * power_b);
      power_a *= time_a, power_b *= time_b;
      binomial = binomial * static_cast<double>(j + 1) / static_cast<double>(j + 1 - i);
    }
  }
  // Equal terms of a common start, and equal highest terms, cancel exactly.
  still_[0] = false;
  bool same = true, nothing_above = true;
  for (std::size_t i = Degree; i > 0; --i) {
    same = same && a.coefficients[i] == b.coefficients[i] && (a.start == b.start || nothing_above);
    still_[i] = same;
    if (same) most[i] = 0;
    nothing_above = nothing_above && a.coefficients[i].isZero(0) && b.coefficients[i].isZero(0);
  }
  const double base = most[0] + 2 * size;
  const auto growth = [&most](double time) {
    double sum = 0;
    for (std::size_t i = Degree; i > 0; --i) sum = (sum + most[i]) * time;
    return sum;
  };
  const double wanted = std::max(horizon - now_, 0.0);  // a horizon in the past: there will be no queries
  end_ = std::min(wanted, 0x1p200);
  while (end_ > 0 && !(growth(end_) <= most_growth * base)) end_ *= 0.5;
  whole_ = end_ == wanted;
  error_ = unit * (base + growth(end_));
  rate_error_ = unit * most[1];
  bend_error_ = unit * most[2];
}

/// side * axis . r - distance, without its distance, as a polynomial of the time, with another constant.
template <int Degree>
auto QuickMotion<Degree>::gap(const Along& p, double side, double constant) const -> Along {
  Along gap;
  for (std::size_t i = 0; i <= Degree; ++i) gap[i] = side * p[i];
  gap[0] += constant;
  return gap;
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
bool QuickMotion<Degree>::clip(const Along& p, double side, double distance, TimeWindow& window) const {
  if constexpr (Degree == 1) {
    return clip_to_negative(side * p[0] - distance - error_, side * p[1], window);
  } else if constexpr (Degree >= 3) {
    return clip_to_negative(gap(p, side, -distance - error_), window);
  } else {
    return clip_to_negative(side * p[0] - distance - error_, side * p[1], side * p[2], window);
  }
}

template <int Degree>
bool QuickMotion<Degree>::surely_closed(const Along& p, double side, double distance, double tau) const {
  return tau <= end_ && side * value(p, tau) - distance < -error_;
}

template <int Degree>
bool QuickMotion<Degree>::opens_for_good(const Along& p, double side, double distance) const {
  if (!(side * value(p, end_) - distance > 2 * error_)) return false;
  if constexpr (Degree == 1) {
    return side * p[1] > rate_error_;
  } else if constexpr (Degree >= 3) {
    // All derivatives at the end have the sign of opening. A coefficient there is a sum of at most 10 of those now,
    // with binomials up to 10, each times its power of the end within the error.
    double power = 1;
    for (int order = 1; order <= Degree; ++order) {
      power *= end_ / order;
      if (still_[static_cast<std::size_t>(order)]) return order > 1;
      if (!(side * derivative_at(p, order, end_) * power > 32 * error_)) return false;
    }
    return true;
  } else {
    const double bend = side * p[2];
    const double rate = side * p[1] + 2 * end_ * bend;
    const bool rises = rate > 2 * (rate_error_ + end_ * bend_error_);
    return rises && (bend > bend_error_ || bend_error_ == 0);  // no error means no bend
  }
}

/// Twice the error would be enough; more is taken, so that the next search is well conditioned.
template <int Degree>
double QuickMotion<Degree>::opened_by(const Along& p, double side, double distance) const {
  if (side * p[0] - distance > error_) return TimeSpans::infinity;  // does not touch
  const double rate = side * p[1];
  const double opened = 64 * error_ / rate;
  if (!(rate > 4 * rate_error_) || !(opened < end_)) return TimeSpans::infinity;
  if constexpr (Degree >= 3) {
    double slowed = 0;
    for (std::size_t i = Degree; i >= 2; --i) {
      slowed = (slowed + static_cast<double>(i) * std::min(side * p[i], 0.0)) * opened;
    }
    if (!(rate + slowed > 0.5 * rate)) return TimeSpans::infinity;
  }
  if constexpr (Degree == 2) {
    if (!(rate + 2 * opened * std::min(side * p[2], 0.0) > 0.5 * rate)) return TimeSpans::infinity;
  }
  return side * value(p, opened) - distance > 2 * error_ ? opened : TimeSpans::infinity;
}

template <int Degree>
double QuickMotion<Degree>::closed_until(const Along& p, double side, double distance, double t) const {
  if constexpr (Degree >= 3) {
    // As far as the gap plus its error is below zero.
    const double from = tau(t);
    const double length = end_ - from;
    if (!(from >= 0 && length >= 0)) return t;
    auto opposite = taylor_shift<double>(Polynomial<Degree>{gap(p, -side, distance - error_)}, from);
    double factor = 1;
    for (double& c : opposite.c) {
      c *= factor;
      factor *= length;
    }
    const double closed = certificates::positive_until(opposite, 0.0, 0.0);
    if (closed >= 1 && whole_) return TimeSpans::infinity;
    return std::max(t, time_before(from + closed * length * (1 - 0x1p-40)));
  }
  const double c0 = side * p[0] - distance + error_;
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
