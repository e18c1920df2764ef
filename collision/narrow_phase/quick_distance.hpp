// When a moving point is near a point, line or plane, in plain doubles.
#pragma once

#include "certificates/features/positive_stretch.hpp"
#include "collision/narrow_phase/quick_motion.hpp"
#include "collision/narrow_phase/time_spans.hpp"
#include "kds/polynomial.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

namespace kds::collision {

/// The gap "sum of y^2 - r^2" for up to three coordinates y, each known to the error of a QuickMotion: the answers of
/// its filter for gaps along axes, for a distance. Where the filter does not decide, exact signs do.
template <int Degree>
class QuickDistance {
 public:
  using Quick = QuickMotion<Degree>;
  using Along = typename Quick::Along;

  QuickDistance() = default;
  QuickDistance(const Quick& motion, double radius) : motion_(&motion), radius_(radius) {}

  void add(const Along& y) { y_[size_++] = y; }
  std::size_t size() const { return size_; }

  /// Shrinks the window to times at which no coordinate alone is greater than the radius; false if there are none.
  bool clip(TimeWindow& window) const {
    const auto all = coordinates();
    return std::all_of(all.begin(), all.end(), [&](const Along& y) {
      return motion_->clip(y, 1, radius_, window) && motion_->clip(y, -1, radius_, window);
    });
  }

  /// Moves the begin of a window, in seconds from now, to a time before which the gap is surely open; false if it is so
  /// at all times in the window up to `until`. If the motion is known for a part of these only, it begins where that
  /// ends.
  bool cut_until(TimeWindow& window, double until) const {
    if (cut(window, std::min(window.end, motion_->tau(until) * (1 + 0x1p-40)))) return true;
    if (motion_->whole() || motion_->tau(until) <= motion_->end()) return false;
    window = {motion_->end(), motion_->end()};
    return true;
  }

  bool surely_closed(double tau) const {
    double farthest = 0;
    for (const Along& y : coordinates()) {
      const double most = std::abs(Quick::value(y, tau)) + motion_->error();
      farthest += most * most;
    }
    return tau <= motion_->end() && farthest < radius_ * radius_;
  }

  /// As QuickMotion::opened_by().
  double opened_by() const;

 private:
  bool cut(TimeWindow& window, double end) const;
  std::span<const Along> coordinates() const { return {y_.data(), size_}; }

  const Quick* motion_ = nullptr;
  double radius_ = 0;
  std::array<Along, 3> y_;
  std::size_t size_ = 0;
};

// ---------------------------------------------------------------------------------------------------------------

/// As cut_until(), up to `end` in seconds from now.
///
/// Error bound: coordinates y are known to the filter's error e, which has room for the roundings of shifting them; of
/// size Y, their squares are off by 2 Y e + e^2 and a few roundings of Y^2.
template <int Degree>
bool QuickDistance<Degree>::cut(TimeWindow& window, double end) const {
  const double begin = std::min(window.begin, end);
  const double length = end - begin;
  const double e = motion_->error();
  Polynomial<2 * Degree> f;
  f.c[0] = -radius_ * radius_;
  double margin = 0x1p-48 * radius_ * radius_;
  for (const Along& each : coordinates()) {
    Polynomial<Degree> y = taylor_shift<double>(Polynomial<Degree>{each}, begin);
    double power = length;
    for (std::size_t i = 1; i <= Degree; ++i, power *= length) y.c[i] *= power;
    const double size = certificates::norm(y);
    f = f + square(y);
    margin += (2 * size + e) * e + 0x1p-48 * size * size;
  }
  const double free = certificates::positive_until(f, 0.0, margin);
  if (free >= 1) return false;
  window.begin = begin + free * length * (1 - 0x1p-40);
  return true;
}

/// For f = sum y^2 - r^2. f is known to E = sum (2 |y| e + e^2) and f' = 2 sum y y' to four times less than it is; in
/// the short time until f has grown by more than 47 E its second derivative, below `bend`, reduces that by no more than
/// a quarter.
template <int Degree>
double QuickDistance<Degree>::opened_by() const {
  const double e = motion_->error();
  double f = -radius_ * radius_, error = 0, rate = 0, rate_error = 0;
  for (const Along& y : coordinates()) {
    f += y[0] * y[0];
    error += (2 * std::abs(y[0]) + e) * e;
    rate += 2 * y[0] * y[1];
    rate_error += 2 * ((std::abs(y[0]) + e) * motion_->rate_error() + std::abs(y[1]) * e);
  }
  const double opened = 64 * error / rate;
  if (f > error || !(rate > 4 * rate_error) || !(opened < motion_->end())) return TimeSpans::infinity;
  double bend = 0;
  for (const Along& y : coordinates()) {
    double speed = 0, acceleration = 0;  // the greatest until then
    for (std::size_t i = Degree; i >= 1; --i) {
      speed = speed * opened + static_cast<double>(i) * std::abs(y[i]);
      if (i >= 2) acceleration = acceleration * opened + static_cast<double>(i * (i - 1)) * std::abs(y[i]);
    }
    bend += 2 * (speed * speed + (std::abs(y[0]) + speed * opened) * acceleration);
  }
  return bend * opened < 0.25 * rate ? opened : TimeSpans::infinity;
}

}  // namespace kds::collision
