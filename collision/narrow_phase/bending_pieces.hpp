// The pieces of time in which two shapes are tested if one of them bends.
#pragma once

#include "certificates/point_motion.hpp"
#include "collision/vectors.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace kds::collision {

/// Pieces that follow on each other from the start of two motions on, cut where a keyframe of either is. Functions of
/// shapes and motions alone.
///
/// In a piece the two go no farther, relative to each other, than `farthest`: the tolerance of features has to be a
/// part of the size of a query that can be told from roundings. After the last keyframe the first piece lasts until the
/// two have gone as far as the smaller one is large, and each next one is twice as long, up to that limit: so boxes
/// that hold all of a piece are useful at first, and there are few pieces. So it is between keyframes that are too far
/// apart for equal parts.
///
/// Cost: O(k log k) to make for k keyframes to come; O(log k) a piece.
template <int Degree>
class BendingPieces {
 public:
  /// A stretch of time, in s.
  struct Piece {
    double begin, end;
  };

  /// `keyframes`: times, in any order; `smaller`, `farthest`: units of length; `turning`: how fast points of the two
  /// go because they turn, at most, in units of length a second.
  BendingPieces(const certificates::PointMotion<Degree>& a, const certificates::PointMotion<Degree>& b, double turning,
                std::vector<double> keyframes, double smaller, double farthest)
      : times_(std::move(keyframes)),
        a_(a),
        b_(b),
        turning_(turning),
        first_(smaller),
        farthest_(std::max(smaller, farthest)) {
    const double start = std::max(a.start, b.start);
    std::erase_if(times_, [start](double time) { return !(time > start); });
    times_.push_back(start);
    std::sort(times_.begin(), times_.end());
    times_.erase(std::unique(times_.begin(), times_.end()), times_.end());
    speed_ = speed(last());
    acceleration_ = norm(b.acceleration(last()) - a.acceleration(last()));
    doublings_ = std::clamp(std::ilogb(farthest_ / first_), 0, 1000);
  }

  double start() const { return times_.front(); }
  double last() const { return times_.back(); }  ///< keyframe, or the start
  /// Whether nothing changes from the last keyframe on.
  bool together() const { return speed_ == 0 && acceleration_ == 0; }

  /// The piece that holds t, its begin included; before the start the first one. Where the doubles of the clock are too
  /// sparse for more pieces it may be one that ends before t.
  Piece at(double t) const {
    t = std::max(t, start());
    if (t >= last()) return after_last(t);
    const auto after = std::upper_bound(times_.begin() + 1, times_.end(), t);
    const double begin = *std::prev(after), end = *after;
    const double way = (end - begin) * std::max(speed(begin), speed(end));
    if (way > most_parts * farthest_) {
      const Piece piece = growing(t, begin, speed(begin));
      return {piece.begin, std::min(piece.end, end)};
    }
    const double count = std::max(1.0, std::ceil(way / farthest_));
    const auto bound = [&](double i) {
      return i <= 0 ? begin : i >= count ? end : begin + (end - begin) * (i / count);
    };
    double i = std::clamp(std::floor((t - begin) / (end - begin) * count), 0.0, count - 1);
    while (i + 1 < count && bound(i + 1) <= t) ++i;
    while (i > 0 && bound(i) > t) --i;
    return {bound(i), bound(i + 1)};
  }

  /// How long the first piece after the last keyframe is, in s.
  double unit() const { return together() ? 1 : std::clamp(time_of(first_, speed_), 0x1p-100, 0x1p100); }

 private:
  /// The most equal parts between two keyframes. Where more are needed pieces grow instead: equal ones would be far too
  /// many in which the two, which are fast at the end, are still slow.
  static constexpr double most_parts = 0x1p20;

  double speed(double t) const { return norm(b_.velocity(t) - a_.velocity(t)) + turning_; }

  /// The least time in which the two go so far, from a speed on; how far they have gone when piece k begins.
  double time_of(double way, double speed) const {
    return way > 0 ? 2 * way / (speed + std::sqrt(speed * speed + 2 * acceleration_ * way)) : 0;
  }
  double way_at(double k) const {
    const double whole = std::ldexp(1.0, doublings_);
    return first_ * (k <= doublings_ ? std::ldexp(1.0, static_cast<int>(k)) - 1 : whole - 1 + (k - doublings_) * whole);
  }

  Piece after_last(double t) const {
    if (!together()) return growing(t, last(), speed_);
    return t - last() < unit() ? Piece{last(), last() + unit()} : Piece{t, t + unit()};
  }

  /// Of pieces that follow on each other from a keyframe on, at which the two have this speed.
  Piece growing(double t, double from, double speed) const {
    const double time = t - from;
    const double way = (speed * time + 0.5 * acceleration_ * time * time) / first_;
    const double whole = std::ldexp(1.0, doublings_);
    double k = way < whole - 1 ? std::ilogb(way + 1) : doublings_ + std::floor((way - (whole - 1)) / whole);
    const auto bound = [&](double i) { return from + time_of(way_at(i), speed); };
    while (bound(k + 1) <= t && bound(k + 2) > bound(k + 1)) ++k;
    while (k > 0 && bound(k) > t) --k;
    return {bound(k), bound(k + 1)};
  }

  std::vector<double> times_;
  const certificates::PointMotion<Degree>& a_;
  const certificates::PointMotion<Degree>& b_;
  double turning_;
  double first_, farthest_;
  double speed_, acceleration_;
  int doublings_;
};

}  // namespace kds::collision
