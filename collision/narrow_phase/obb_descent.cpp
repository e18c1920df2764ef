#include "collision/narrow_phase/obb_descent.hpp"

#include "collision/degrees.hpp"
#include "collision/vectors.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace kds::collision {
namespace {

/// Squared speeds below this are left to the other tests: near underflow quotients are not accurate to a few roundings.
constexpr float slowest = 0x1p-100F;

/// The next float is never below the number.
float rounded_up(double x) { return static_cast<float>(x * (1 + 0x1p-22)); }

/// Intersects, lane by lane, the times at which |p0 + p1 s| < half_width with those so far.
struct Clip {
  Lanes begin;
  Lanes end;

  void add(Lanes p0, Lanes p1, Lanes half_width) {
    // Without speed the quotients are infinite, with the signs that say "always" or "never"; 0/0 says "always".
    const Lanes inverse = splat(1) / p1;
    const Lanes x = (-half_width - p0) * inverse;
    const Lanes y = (half_width - p0) * inverse;
    begin = greater(lesser(x, y), begin);
    end = lesser(greater(x, y), end);
  }

  /// Shrinks the window to the intersection of all lanes; false if that is empty.
  bool gather(StepWindow& window) const {
    window.begin = highest(begin);
    window.end = lowest(end);
    return window.begin <= window.end;
  }
};

/// A path over a window as a straight line, and how far the path may be from it.
template <int Degree>
struct Chord {
  Lanes p0;
  Lanes p1;
  float deviation;
};
template <int Degree>
Chord<Degree> chord(const std::array<Lanes, std::size_t{Degree} + 1>& path, float bend, const StepWindow& window) {
  if constexpr (Degree == 1) {
    return {path[0], path[1], 0};
  } else if constexpr (Degree >= 3) {
    const float length = window.end - window.begin;
    const Lanes middle = splat(0.5F * (window.begin + window.end));
    Lanes place = path[Degree];
    Lanes speed{};
    for (std::size_t i = Degree; i-- > 0;) {
      speed = speed * middle + place;
      place = place * middle + path[i];
    }
    return {place - speed * middle, speed, bend * (length * length * 0.25F)};
  } else {
    const float length = window.end - window.begin;
    return {path[0] - path[2] * splat(window.begin * window.end), path[1] + path[2] * splat(window.begin + window.end),
            bend * (length * length * 0.25F)};
  }
}

/// The vector along the axes whose coordinates are the rows.
Lanes along(const std::array<Lanes, 3>& axes, float x, float y, float z) {
  return axes[0] * splat(x) + axes[1] * splat(y) + axes[2] * splat(z);
}

}  // namespace

template <int Degree>
SliceMotion<Degree>::SliceMotion(const RelativeMotion<Degree>& motion, const ContactGap<Degree>& gap,
                                 const TimeSlice& slice, double size_of_pair)
    : size(size_of_pair), margin(rounding + rounded_up(quick_margin * gap(slice.end) / size_of_pair)), bend(0) {
  r[0] = motion.position(slice.begin) / size;
  r[1] = motion.velocity(slice.begin) * (slice.length() / size);
  if constexpr (Degree >= 3) {
    double power = slice.length();
    double most_bend = 0;
    for (int i = 2; i <= Degree; ++i) {
      power *= slice.length();
      Eigen::Vector3d& c = r[static_cast<std::size_t>(i)] = motion.coefficient(i, slice.begin) * (power / size);
      most_bend += 0.5 * i * (i - 1) * norm(c);
    }
    bend = rounded_up(most_bend);
  } else if constexpr (Degree == 2) {
    r[2] = motion.coefficients[2] * (slice.length() * slice.length() / size);
    bend = rounded_up(norm(r[2]));
  }
}

template <int Degree>
BoxPairTest<Degree>::BoxPairTest(const TreePose& a, const TreePose& b, const SliceMotion<Degree>& motion)
    : unit_a_(static_cast<float>(a.unit / motion.size)),
      unit_b_(static_cast<float>(b.unit / motion.size)),
      margin_(motion.margin),
      bend_(motion.bend) {
  const Eigen::Matrix3d turn = a.rotation.transpose() * b.rotation;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j)
      turn_[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = static_cast<float>(turn(i, j));
  }
  for (std::size_t i = 0; i <= Degree; ++i) motion_[i] = (a.rotation.transpose() * motion.r[i]).template cast<float>();
}

template <int Degree>
auto BoxPairTest<Degree>::frame(const ObbNode& a) const -> Frame {
  Frame frame;
  for (std::size_t k = 0; k < 3; ++k) frame.turn[k] = along(a.axes, turn_[0][k], turn_[1][k], turn_[2][k]);
  const auto& r = motion_;
  frame.motion[0] =
      along(a.axes, r[0][0] - unit_a_ * a.centre[0], r[0][1] - unit_a_ * a.centre[1], r[0][2] - unit_a_ * a.centre[2]);
  for (std::size_t i = 1; i <= Degree; ++i) frame.motion[i] = along(a.axes, r[i][0], r[i][1], r[i][2]);
  frame.half_extents = splat(unit_a_) * a.half_extents;
  return frame;
}

template <int Degree>
bool BoxPairTest<Degree>::operator()(const Frame& a, const ObbNode& b, StepWindow& window) const {
  const Lanes ha = a.half_extents;
  const Lanes hb = splat(unit_b_) * b.half_extents;
  const Lanes centre = splat(unit_b_) * b.centre;
  std::array<Lanes, std::size_t{Degree} + 1> path = a.motion;
  path[0] += along(a.turn, centre[0], centre[1], centre[2]);
  // Row i: axis i of a along the axes of b.
  std::array<Lanes, 3> turn;
  std::array<Lanes, 3> size;
  for (std::size_t i = 0; i < 3; ++i) {
    turn[i] = along(b.axes, a.turn[0][i], a.turn[1][i], a.turn[2][i]);
    size[i] = magnitude(turn[i]);
  }
  Clip clip{splat(window.begin), splat(window.end)};

  auto r = chord<Degree>(path, bend_, window);
  clip.add(r.p0, r.p1, ha + sums(size[0] * hb, size[1] * hb, size[2] * hb) + splat(margin_ + r.deviation));
  if (!clip.gather(window)) return false;
  if constexpr (Degree >= 2) r = chord<Degree>(path, bend_, window);

  const Lanes margin = splat(margin_ + r.deviation);
  clip.add(along(turn, r.p0[0], r.p0[1], r.p0[2]), along(turn, r.p1[0], r.p1[1], r.p1[2]),
           hb + along(size, ha[0], ha[1], ha[2]) + margin);
  if (!clip.gather(window)) return false;

  // Axis i of a times each axis of b; j and k are the other axes of a.
  const Lanes hb_next = next_lanes(hb);
  const Lanes hb_last = last_lanes(hb);
  const auto add_products = [&](std::size_t i, std::size_t j, std::size_t k) {
    const Lanes half_width =
        splat(ha[j]) * size[k] + splat(ha[k]) * size[j] + hb_next * last_lanes(size[i]) + hb_last * next_lanes(size[i]);
    clip.add(splat(r.p0[k]) * turn[j] - splat(r.p0[j]) * turn[k], splat(r.p1[k]) * turn[j] - splat(r.p1[j]) * turn[k],
             half_width + margin);
  };
  add_products(0, 1, 2);
  add_products(1, 2, 0);
  add_products(2, 0, 1);
  return clip.gather(window);
}

template <int Degree>
BoxBallTest<Degree>::BoxBallTest(const TreePose& a, double radius, const SliceMotion<Degree>& motion)
    : unit_(static_cast<float>(a.unit / motion.size)),
      radius_(rounded_up(radius / motion.size)),
      margin_(motion.margin),
      bend_(motion.bend) {
  for (std::size_t i = 0; i <= Degree; ++i) motion_[i] = (a.rotation.transpose() * motion.r[i]).template cast<float>();
}

template <int Degree>
bool BoxBallTest<Degree>::operator()(const ObbNode& a, StepWindow& window) const {
  std::array<Lanes, std::size_t{Degree} + 1> path;
  for (std::size_t i = 0; i <= Degree; ++i) path[i] = Lanes{motion_[i][0], motion_[i][1], motion_[i][2], 0};
  path[0] -= splat(unit_) * a.centre;

  // The balls: from their nearest approach, whose distance is computed from the place itself.
  auto r = chord<Degree>(path, bend_, window);
  const Lanes squares = sums(r.p1 * r.p1, r.p0 * r.p1, Lanes{});
  if (squares[0] > slowest) {
    const float nearest = -squares[1] / squares[0];
    const Lanes place = r.p0 + r.p1 * splat(nearest);
    const float distance = std::sqrt(sums(place * place, Lanes{}, Lanes{})[0]);
    const float half_width = radius_ + unit_ * a.radius + margin_ + r.deviation;
    if (distance >= half_width) return false;
    const float half = std::sqrt((half_width - distance) * (half_width + distance) / squares[0]);
    window.begin = std::max(window.begin, nearest - half);
    window.end = std::min(window.end, nearest + half);
    if (!(window.begin <= window.end)) return false;
    if constexpr (Degree >= 2) r = chord<Degree>(path, bend_, window);
  }

  Clip clip{splat(window.begin), splat(window.end)};
  clip.add(along(a.axes, r.p0[0], r.p0[1], r.p0[2]), along(a.axes, r.p1[0], r.p1[1], r.p1[2]),
           splat(unit_) * a.half_extents + splat(radius_ + margin_ + r.deviation));
  return clip.gather(window);
}

#define KDS_INSTANTIATE(degree)        \
  template struct SliceMotion<degree>; \
  template class BoxPairTest<degree>;  \
  template class BoxBallTest<degree>;
KDS_FOR_EACH_DEGREE(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
