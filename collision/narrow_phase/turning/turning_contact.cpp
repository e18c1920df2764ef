#include "collision/narrow_phase/turning/turning_contact.hpp"

#include "collision/narrow_phase/contact_patch.hpp"
#include "collision/narrow_phase/turning/point_rates.hpp"
#include "collision/narrow_phase/turning/turning_ball_and_box.hpp"
#include "collision/narrow_phase/turning/turning_boxes.hpp"
#include "collision/narrow_phase/turning/ways_apart.hpp"
#include "collision/shapes/support.hpp"
#include "collision/vectors.hpp"

#include <algorithm>
#include <array>
#include <type_traits>
#include <variant>
#include <vector>

namespace kds::collision {
namespace {

using certificates::PointMotion;
using Eigen::Vector3d;

template <int Degree>
using Body = typename TurningContact<Degree>::Body;

double radius(const PlacedShape& shape) { return std::get<Sphere>(shape.shape).radius; }
const Vector3d& half_extents(const PlacedShape& shape) { return std::get<Box>(shape.shape).half_extents; }
bool is_ball(const PlacedShape& shape) { return std::holds_alternative<Sphere>(shape.shape); }

/// Calls ask(pair) with what WaysApart takes. Precondition: not two balls.
template <int Degree, class Ask>
auto with_ways(const Body<Degree>& a, const Body<Degree>& b, const Ask& ask) {
  if (is_ball(a.shape)) {
    return ask(TurningBallAndBox<Degree>(b.motion, half_extents(b.shape), a.motion, radius(a.shape)));
  }
  if (is_ball(b.shape)) {
    return ask(TurningBallAndBox<Degree>(a.motion, half_extents(a.shape), b.motion, radius(b.shape)));
  }
  return ask(TurningBoxes<Degree>(a.motion, half_extents(a.shape), b.motion, half_extents(b.shape)));
}

/// Two balls do not care how they turn.
template <int Degree>
TranslatingShape<Degree> ball_of(const Body<Degree>& body) {
  return {body.shape, body.motion.path};
}

/// The first double in (t, horizon] at which two bodies that overlap just after t do so more than they do then, by more
/// than what roundings of their coordinates can feign, or `never`: their contact once they are made so much smaller.
template <class Pair, int Degree>
double falls_deeper(const Pair& pair, const Body<Degree>& a, const Body<Degree>& b, double t, double horizon) {
  std::array<double, Pair::ways> gap;
  const double error = pair.gaps(pair.frame(t), gap);
  const double depth = std::max(0.0, -*std::max_element(gap.begin(), gap.end()));
  constexpr double roundings = 0x1p-46;
  const double coordinates = norm(a.motion.path.position(t)) + norm(b.motion.path.position(t)) +
                             a.shape.bounding_radius + b.shape.bounding_radius;
  // Along some directions they are then less far apart than on the sides that are made smaller.
  for (double margin = (1 + 0x1p-10) * depth + error + roundings * coordinates;; margin *= 2) {
    const auto smaller = pair.smaller(margin);
    if (!smaller) return never;
    const double deeper = WaysApart<Pair>(*smaller).first_penetration(t, horizon);
    if (deeper > t) return deeper;
  }
}

template <int Degree>
PlacedShape placed_at(const Body<Degree>& body, double t) {
  const auto q = certificates::turned_orientation(body.motion.orientation, body.motion.spin(), t);
  return place(body.shape.shape, Eigen::Quaterniond(Eigen::Vector4d(q.coeffs() / norm(q))));
}

}  // namespace

template <int Degree>
double time_to_look_ahead(const certificates::RigidMotion<Degree>& a, const certificates::RigidMotion<Degree>& b) {
  constexpr double radians = 0.5;       // 2 and 32 make no difference to speak of
  constexpr double longest = 0x1p20;  // s, of bodies that hardly turn
  const double rates = norm(a.angular_velocity) + norm(b.angular_velocity);
  return rates > 0 ? std::min(longest, radians / rates) : longest;
}

template <int Degree>
Contact TurningContact<Degree>::contact_at(const Body& a, const Body& b, double t, const FoundTouch&) {
  if (is_ball(a.shape) && is_ball(b.shape)) return collision::contact_at(ball_of<Degree>(a), ball_of<Degree>(b), t);
  const PlacedShape placed_a = placed_at<Degree>(a, t);
  const PlacedShape placed_b = placed_at<Degree>(b, t);
  Contact contact = collision::contact_at<PointMotion<Degree>>({placed_a, a.motion.path}, {placed_b, b.motion.path}, t);
  if (is_ball(a.shape) || is_ball(b.shape)) return contact;
  const PointRates<Degree> rates(a.motion, b.motion, t);
  const auto parting = [&](const Vector3d& x) { return dot(contact.normal, rates.velocity(x)); };
  if (parting(contact.point) < -rates.noise(contact.point)) return contact;
  const auto of_a = supporting_feature(placed_a, contact.normal);
  const auto of_b = supporting_feature(placed_b, -contact.normal);
  const Vector3d origin = a.motion.path.position(t);
  for (const Vector3d& corner :
       patch_corners(of_a.vertices, of_b.vertices, b.motion.path.position(t) - origin, contact.normal)) {
    const Vector3d x = origin + corner;
    if (parting(x) < parting(contact.point) && parting(x) < -rates.noise(x)) contact.point = x;
  }
  return contact;
}

template <int Degree>
double TurningContact<Degree>::first_contact(const Body& a, const Body& b, double t0, double horizon, ContactMode mode,
                                             FoundTouch*) {
  if (!(t0 <= horizon)) return never;
  if (is_ball(a.shape) && is_ball(b.shape)) {
    return collision::first_contact(ball_of<Degree>(a), ball_of<Degree>(b), t0, horizon, mode);
  }
  return with_ways<Degree>(a, b, [&](const auto& pair) {
    const WaysApart<std::decay_t<decltype(pair)>> ways(pair);
    for (double t = t0;;) {
      t = ways.first_penetration(t, horizon);
      if (t == never || mode == ContactMode::transparent) return t;
      const Contact contact = contact_at(a, b, t, {});
      const PointRates<Degree> rates(a.motion, b.motion, t);
      if (dot(contact.normal, rates.velocity(contact.point)) < -rates.noise(contact.point)) return t;
      // Mostly they have parted at once. Else next when they are deeper in each other by more than roundings, or again
      // after they have parted.
      const double soon = std::min(horizon, t + 0x1p-10 * std::min(pair.time_of_turning(), 1.0));
      if (const double parted = ways.first_parting(t, soon); parted != never) {
        t = parted;
        continue;
      }
      const double deeper = falls_deeper<std::decay_t<decltype(pair)>, Degree>(pair, a, b, t, horizon);
      t = std::min(deeper, ways.first_parting(t, std::min(deeper, horizon)));
      if (t > horizon) return never;
    }
  });
}

template <int Degree>
double TurningContact<Degree>::apart_until(const Body& a, const Body& b, double t0, double horizon, PairMemory&) {
  if (!(t0 <= horizon)) return never;
  if (is_ball(a.shape) && is_ball(b.shape)) return t0;
  return with_ways<Degree>(a, b, [&](const auto& pair) { return pair.apart_until(t0, horizon); });
}

template <int Degree>
bool TurningContact<Degree>::in_contact(const Body& a, const Body& b, double t) {
  if (is_ball(a.shape) && is_ball(b.shape)) return collision::in_contact(ball_of<Degree>(a), ball_of<Degree>(b), t);
  return with_ways<Degree>(
      a, b, [&](const auto& pair) { return WaysApart<std::decay_t<decltype(pair)>>(pair).penetrate(t); });
}

template <int Degree>
double TurningContact<Degree>::first_separation(const Body& a, const Body& b, double t0, double horizon) {
  if (!(t0 <= horizon)) return never;
  if (is_ball(a.shape) && is_ball(b.shape)) {
    return collision::first_separation(ball_of<Degree>(a), ball_of<Degree>(b), t0, horizon);
  }
  return with_ways<Degree>(
      a, b, [&](const auto& pair) { return WaysApart<std::decay_t<decltype(pair)>>(pair).first_parting(t0, horizon); });
}

#define KDS_INSTANTIATE(degree)                                                \
  template struct TurningContact<degree>;                                      \
  template double time_to_look_ahead(const certificates::RigidMotion<degree>&, \
                                     const certificates::RigidMotion<degree>&);
KDS_INSTANTIATE(1) KDS_INSTANTIATE(2)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
