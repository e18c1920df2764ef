#include "collision/narrow_phase/box_and_ball.hpp"

#include "collision/degrees.hpp"

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

template <int Degree>
bool BoxAndBall<Degree>::Piece::surely_closed(std::size_t i, double t) const {
  const Quick& motion = pair_->motion_;
  const double tau = motion.tau(t);
  if (i < 6) {
    const std::size_t d = i / 2;
    if (around(d)) return true;
    return motion.surely_closed(pair_->along_[d], side(i), pair_->half_width(d, place_[d]), tau);
  }
  return quick_distance().surely_closed(tau);
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
