#include "collision/narrow_phase/box_and_ball.hpp"

#include "certificates/features/positive_stretch.hpp"
#include "collision/degrees.hpp"
#include "kds/polynomial.hpp"

namespace kds::collision {

template <int Degree>
BoxAndBall<Degree>::BoxAndBall(const Body& box, const Body& ball, double now, double horizon)
    : box_(box),
      ball_(ball),
      half_(std::get<Box>(box.shape.shape).half_extents),
      radius_(std::get<Sphere>(ball.shape.shape).radius),
      motion_(box.motion, ball.motion, now, horizon, box.shape.bounding_radius + radius_) {
  TimeWindow hull{0, motion_.end()};
  const auto clip = [this](std::size_t d, Place place, TimeWindow& window) {
    const Along p = from_middle(d, place);
    const double half_width_there = half_width(d, place);
    return motion_.clip(p, 1, half_width_there, window) && motion_.clip(p, -1, half_width_there, window);
  };
  for (std::size_t d = 0; d < 3; ++d) {
    axes_[d] = box.shape.rotation.col(static_cast<int>(d));
    along_[d] = motion_.along(axes_[d]);
    motion_.note_parting(along_[d], half_width(d, grown));
  }
  for (std::size_t d = 0; d < 3; ++d) {
    if (clip(d, grown, hull)) continue;
    apart_ = motion_.whole();
    if (apart_) return;
    hull = after_end();
  }
  for (std::size_t d = 0; d < 3; ++d) {
    windows_[d][grown] = hull;
    for (const Place place : {between, around_low, around_high}) {
      windows_[d][place] = hull;
      if (!clip(d, place, windows_[d][place])) windows_[d][place] = {1, 0};
    }
  }
}

/// Applies the distance from the edge or vertex; false if the centre is not in the piece by a time.
///
/// Error bound: coordinates y are known to the filter's error e, which has room for the roundings of shifting them; of
/// size Y, their squares are off by 2 Y e + e^2 and a few roundings of Y^2.
template <int Degree>
bool BoxAndBall<Degree>::Piece::cut(double until) {
  if (!curved_) return true;
  const Quick& motion = pair_->motion_;
  const bool unknown = !motion.whole() && motion.tau(until) > motion.end();
  const double end = std::min(window_.end, motion.tau(until) * (1 + 0x1p-40));
  const double begin = std::min(window_.begin, end);
  const double length = end - begin;
  const double e = motion.error();
  Polynomial<2 * Degree> f;
  f.c[0] = -pair_->radius_ * pair_->radius_;
  double margin = 0x1p-48 * pair_->radius_ * pair_->radius_;
  for (std::size_t d = 0; d < 3; ++d) {
    if (!around(d)) continue;
    Polynomial<Degree> y = taylor_shift<double>(Polynomial<Degree>{pair_->from_middle(d, place_[d])}, begin);
    double power = 1;
    for (std::size_t i = 1; i <= Degree; ++i) y.c[i] *= power *= length;
    const double size = certificates::norm(y);
    f = f + square(y);
    margin += (2 * size + e) * e + 0x1p-48 * size * size;
  }
  const double free = certificates::positive_until(f, 0.0, margin);
  if (free >= 1) {
    if (unknown) window_ = pair_->after_end();
    return unknown;
  }
  window_.begin = begin + free * length * (1 - 0x1p-40);
  return true;
}

/// As QuickMotion::opened_by(), for f = sum y^2 - r^2. f is known to E = sum (2 |y| e + e^2) and f' = 2 sum y y' to
/// four times less than it is; in the short time until f has grown by more than 47 E its second derivative, below
/// `bend`, reduces that by no more than a quarter.
template <int Degree>
double BoxAndBall<Degree>::Piece::distance_opened_by() const {
  const double e = pair_->motion_.error();
  double f = -pair_->radius_ * pair_->radius_, error = 0, rate = 0, rate_error = 0;
  for (std::size_t d = 0; d < 3; ++d) {
    if (!around(d)) continue;
    const Along y = pair_->from_middle(d, place_[d]);
    f += y[0] * y[0];
    error += (2 * std::abs(y[0]) + e) * e;
    rate += 2 * y[0] * y[1];
    rate_error += 2 * ((std::abs(y[0]) + e) * pair_->motion_.rate_error() + std::abs(y[1]) * e);
  }
  const double opened = 64 * error / rate;
  if (f > error || !(rate > 4 * rate_error) || !(opened < pair_->motion_.end())) return TimeSpans::infinity;
  double bend = 0;
  for (std::size_t d = 0; d < 3; ++d) {
    if (!around(d)) continue;
    const Along y = pair_->from_middle(d, place_[d]);
    double acceleration = Degree == 2 ? 2 * std::abs(y[Degree]) : 0;
    if constexpr (Degree >= 3) {  // at most, until it has opened
      for (std::size_t i = Degree; i >= 2; --i) {
        acceleration = acceleration * opened + static_cast<double>(i * (i - 1)) * std::abs(y[i]);
      }
    }
    const double speed = std::abs(y[1]) + acceleration * opened;
    bend += 2 * (speed * speed + (std::abs(y[0]) + speed * opened) * acceleration);
  }
  return bend * opened < 0.25 * rate ? opened : TimeSpans::infinity;
}

template <int Degree>
bool BoxAndBall<Degree>::Piece::surely_closed(std::size_t i, double t) const {
  const Quick& motion = pair_->motion_;
  const double tau = motion.tau(t);
  if (i < 6) {
    const std::size_t d = i / 2;
    if (around(d)) return true;
    return motion.surely_closed(pair_->along_[d], side(i), pair_->half_width(d, place_[d]), tau);
  }
  double farthest = 0;
  for (std::size_t d = 0; d < 3; ++d) {
    if (!around(d)) continue;
    const double most = std::abs(Quick::value(pair_->from_middle(d, place_[d]), tau)) + motion.error();
    farthest += most * most;
  }
  return tau <= motion.end() && farthest < pair_->radius_ * pair_->radius_;
}

template <int Degree>
double BoxAndBall<Degree>::Piece::closed_until(std::size_t i, double t) const {
  const std::size_t d = i / 2;
  if (i == 6) return t;
  if (around(d)) return TimeSpans::infinity;
  const double half_width = pair_->half_width(d, place_[d]);
  return pair_->motion_.closed_until(pair_->along_[d], side(i), half_width, t);
}

#define KDS_INSTANTIATE(degree) template class BoxAndBall<degree>;
KDS_FOR_EACH_DEGREE(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
