#include "collision/narrow_phase/turning/turning_contact.hpp"

#include "collision/narrow_phase/contact_patch.hpp"
#include "collision/narrow_phase/half_space_contact.hpp"
#include "collision/narrow_phase/half_space_of.hpp"
#include "collision/narrow_phase/lowest_place.hpp"
#include "collision/narrow_phase/pair_tests.hpp"
#include "collision/narrow_phase/turning/corners_of_shape.hpp"
#include "collision/narrow_phase/turning/point_rates.hpp"
#include "collision/narrow_phase/turning/remembered_signs.hpp"
#include "collision/narrow_phase/turning/turning_above_half_space.hpp"
#include "collision/narrow_phase/turning/turning_ball_and_box.hpp"
#include "collision/narrow_phase/turning/turning_ball_and_polytope.hpp"
#include "collision/narrow_phase/turning/turning_boxes.hpp"
#include "collision/narrow_phase/turning/turning_polytopes.hpp"
#include "collision/narrow_phase/turning/turning_rounded_polytopes.hpp"
#include "collision/narrow_phase/turning/ways_apart.hpp"
#include "collision/shapes/shape_forms.hpp"
#include "collision/shapes/support.hpp"
#include "collision/vectors.hpp"

#include <algorithm>
#include <optional>
#include <type_traits>
#include <variant>
#include <vector>

namespace kds::collision {
namespace {

using certificates::PointMotion;
using Eigen::Vector3d;

template <int Degree>
using Body = typename TurningContact<Degree>::Body;

double radius(const PlacedShape& shape) { return ball_radius(shape.shape); }
const Vector3d& half_extents(const PlacedShape& shape) { return std::get<Box>(shape.shape).half_extents; }
/// The box that a shape is, in the coordinates of its body.
std::optional<AlignedBox> box_of(const PlacedShape& shape) {
  if (const auto* const box = std::get_if<Box>(&shape.shape)) return AlignedBox{-box->half_extents, box->half_extents};
  const Polytope* const hull = polytope_of(shape.shape);
  return hull ? hull->box() : std::nullopt;
}
bool is_ball(const PlacedShape& shape) { return ball_radius(shape.shape) > 0; }
bool is_box(const PlacedShape& shape) { return std::holds_alternative<Box>(shape.shape); }

/// Calls ask(pair) with what WaysApart takes. Precondition: turning counts for the pair; a half-space comes first, or
/// else a hull, or else a capsule.
template <int Degree, class Ask>
auto with_ways(const Body<Degree>& a, const Body<Degree>& b, const Ask& ask) {
  if (unbounded(a.shape.shape)) {
    const auto with = [&]<class Corners>(Corners corners) {
      const HalfSpace plane = half_space_of(a.shape, a.motion);
      return ask(TurningAboveHalfSpace<Degree, Corners>(plane, a.motion.path, std::move(corners), b.motion));
    };
    if (const auto* const mesh = std::get_if<MeshShape>(&b.shape.shape)) return with(CornersOfMesh(*mesh));
    return with(CornersOfSolid(b.shape.shape));
  }
  const auto box_a = box_of(a.shape), box_b = box_of(b.shape);
  if (box_a && box_b) return ask(TurningBoxes<Degree>(a.motion, *box_a, b.motion, *box_b));
  if (!is_ball(a.shape) && !is_box(a.shape)) {
    const ConvexCore core(a.shape.shape);
    if (is_ball(b.shape)) return ask(TurningBallAndPolytope<Degree>(a.motion, core, b.motion, radius(b.shape)));
    const ConvexCore other(b.shape.shape);
    if (core.radius() > 0 || other.radius() > 0) {
      return ask(TurningRoundedPolytopes<Degree>(a.motion, core, b.motion, other));
    }
    return ask(TurningPolytopes<Degree>(a.motion, core, b.motion, other));
  }
  if (is_ball(a.shape)) {
    return ask(TurningBallAndBox<Degree>(b.motion, half_extents(b.shape), a.motion, radius(a.shape)));
  }
  return ask(TurningBallAndBox<Degree>(a.motion, half_extents(a.shape), b.motion, radius(b.shape)));
}

/// The body as it is at t, in doubles. The orientation of a half-space is the same at all times.
template <int Degree>
PlacedShape placed_at(const Body<Degree>& body, double t) {
  const auto q = certificates::turned_orientation(body.motion.orientation, body.motion.spin(), t);
  return place(body.shape.shape, Eigen::Quaterniond(Eigen::Vector4d(q.coeffs() / norm(q))));
}

/// Calls ask(a, b) with a ball, and a ball or a half-space that comes first, as bodies that do not turn.
template <int Degree, class Ask>
auto without_turning(const Body<Degree>& a, const Body<Degree>& b, const Ask& ask) {
  using Still = TranslatingShape<Degree>;
  const Still ball{b.shape, b.motion.path};
  if (is_ball(a.shape)) return ask(Still{a.shape, a.motion.path}, ball);
  const PlacedShape plane = placed_at<Degree>(a, a.motion.start());
  return ask(Still{plane, a.motion.path}, ball);
}

/// Whether a body keeps the orientation in which its shape is given, exactly.
template <int Degree>
bool stands_as_given(const Body<Degree>& body) {
  const auto& motion = body.motion;
  return motion.angular_velocity.isZero(0) && motion.orientation.vec().isZero(0) &&
         body.shape.rotation == Eigen::Matrix3d::Identity();
}

/// Whether both are solids and stand as they are given. Their contacts are those of bodies that do not turn, the same
/// doubles: nothing is rounded in placing such shapes, and the two laws are one then.
template <int Degree>
bool both_stand(const Body<Degree>& a, const Body<Degree>& b) {
  const auto is_solid = [](const Shape& shape) { return !concave(shape) && !unbounded(shape); };
  return is_solid(a.shape.shape) && is_solid(b.shape.shape) && stands_as_given<Degree>(a) && stands_as_given<Degree>(b);
}

/// Calls ask(a, b) with two bodies that stand as they are given, as bodies that do not turn.
template <int Degree, class Ask>
auto as_they_stand(const Body<Degree>& a, const Body<Degree>& b, const Ask& ask) {
  using Still = TranslatingShape<Degree>;
  return ask(Still{a.shape, a.motion.path}, Still{b.shape, b.motion.path});
}

/// The first double in (t, horizon] at which two bodies that overlap just after t do so more than they do then, by more
/// than a part of their coordinates, or `never`. It is found as the contact of one body with the other made smaller.
template <class Pair, int Degree>
double falls_deeper(const Pair& pair, const Body<Degree>& a, const Body<Degree>& b, double t, double horizon,
                    double part) {
  double coordinates = norm(a.motion.path.position(t)) + norm(b.motion.path.position(t)) + b.shape.bounding_radius;
  if (!unbounded(a.shape.shape)) coordinates += a.shape.bounding_radius;
  // In proportion to the depth it may not be: what sinks a little deeper with each contact would sink ever faster.
  const double depth = pair.depth(t);
  double deeper = never;
  for (double more = part * coordinates;; more *= 2) {  // until the smaller pair is apart for certain
    const auto smaller = pair.smaller(depth + more);
    if (!smaller) break;
    const WaysApart<Pair> ways(*smaller);
    deeper = ways.first_penetration(t, horizon, true);
    if (deeper > t) break;
    deeper = never;
  }
  return std::max(deeper, next_up(t));
}

/// The same of bodies of which one may be a hull that is a box: it is made smaller as all hulls are, which is not how
/// boxes are.
template <class Pair, int Degree>
double bodies_fall_deeper(const Pair& pair, const Body<Degree>& a, const Body<Degree>& b, double t, double horizon,
                          double part) {
  if constexpr (std::is_same_v<Pair, TurningBoxes<Degree>>) {
    const auto is_hull = [](const Body<Degree>& body) { return polytope_of(body.shape.shape) != nullptr; };
    if (is_hull(a) || is_hull(b)) {
      const TurningPolytopes<Degree> hulls(a.motion, ConvexCore(a.shape.shape), b.motion, ConvexCore(b.shape.shape));
      return falls_deeper<TurningPolytopes<Degree>, Degree>(hulls, a, b, t, horizon, part);
    }
  }
  return falls_deeper<Pair, Degree>(pair, a, b, t, horizon, part);
}

/// Of a half-space (a). The middle of what is lowest of b, or where that does not approach but another corner of it
/// does, the one that approaches fastest.
template <int Degree>
Contact contact_with_half_space(const Body<Degree>& a, const Body<Degree>& b, double t) {
  const PlacedShape plane = placed_at<Degree>(a, t);
  PlacedShape placed = b.shape;
  if (concave(b.shape.shape)) {  // Of a mesh its bounds, which would cost a look at all of it, are not asked for.
    placed.rotation = b.motion.rotation(t).matrix();
  } else {
    placed = placed_at<Degree>(b, t);
  }
  Contact contact = half_space_contact<Degree>({plane, a.motion.path}, {placed, b.motion.path}, t);
  const PointRates<Degree> rates(a.motion, b.motion, t);
  const auto parting = [&](const Vector3d& x) { return dot(contact.normal, rates.velocity(x)); };
  if (is_ball(b.shape) || parting(contact.point) < -rates.noise(contact.point)) return contact;
  const Vector3d origin = b.motion.path.position(t);
  for (const Vector3d& corner : lowest_feature(placed, contact.normal).vertices) {
    const Vector3d x = origin + corner;
    if (parting(x) < parting(contact.point) && parting(x) < -rates.noise(x)) contact.point = x;
  }
  return contact;
}

}  // namespace

template <int Degree>
double time_to_look_ahead(const certificates::RigidMotion<Degree>& a, const certificates::RigidMotion<Degree>& b) {
  constexpr double radians = 0.25;  // Motions mostly change before the bodies have turned farther.
  // Bodies that do not turn, or hardly, are looked at until the end of the clock: a shorter time would be a unit of
  // time, and scenes that are slow in it would be looked at without end.
  constexpr double longest = largest_magnitude;
  const double rates = norm(a.angular_velocity) + norm(b.angular_velocity);
  return rates > 0 ? std::min(longest, radians / rates) : longest;
}

template <int Degree>
Contact TurningContact<Degree>::contact_at(const Body& a, const Body& b, double t, const FoundTouch&) {
  if (unbounded(a.shape.shape)) return contact_with_half_space<Degree>(a, b, t);
  if (is_ball(a.shape) && is_ball(b.shape)) {
    return without_turning<Degree>(a, b, [&](const auto& x, const auto& y) { return collision::contact_at(x, y, t); });
  }
  if (both_stand<Degree>(a, b)) {
    return as_they_stand<Degree>(a, b, [&](const auto& x, const auto& y) { return collision::contact_at(x, y, t); });
  }
  const PlacedShape placed_a = placed_at<Degree>(a, t);
  const PlacedShape placed_b = placed_at<Degree>(b, t);
  Contact contact = collision::contact_at<PointMotion<Degree>>({placed_a, a.motion.path}, {placed_b, b.motion.path}, t);
  if (is_ball(a.shape) || is_ball(b.shape)) return contact;
  if (a.motion.spin().still() && b.motion.spin().still()) return contact;  // all points move alike
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

namespace {

/// Whether two bodies that meet at t approach there, faster than by roundings.
template <int Degree>
bool approach_at(const Body<Degree>& a, const Body<Degree>& b, double t) {
  const Contact contact = TurningContact<Degree>::contact_at(a, b, t, {});
  const PointRates<Degree> rates(a.motion, b.motion, t);
  return dot(contact.normal, rates.velocity(contact.point)) < -rates.noise(contact.point);
}

/// Of two bodies that penetrate just after t and do not approach.
struct Overlap {
  double parts;   ///< when they part; or `never`, if they are deeper in each other before
  double deeper;  ///< when they are deeper in each other by more than a part of their coordinates, or `never`
};
template <class Ways, class Pair, int Degree>
Overlap overlap_from(const Ways& ways, const Pair& pair, const Body<Degree>& a, const Body<Degree>& b, double t,
                     double horizon, double part) {
  // Mostly they have parted at once.
  double parts = ways.first_parting(t, std::min(horizon, t + 0x1p-10 * std::min(pair.time_of_turning(), 1.0)));
  const double deeper = bodies_fall_deeper<Pair, Degree>(pair, a, b, t, std::min(parts, horizon), part);
  if (parts == never) parts = ways.first_parting(t, std::min(deeper, horizon));
  return {parts, deeper};
}

/// How long two bodies that do not penetrate just after t surely stay apart, as an estimate of their first contact;
/// none where doubles do not tell.
template <class Ways>
std::optional<ContactEstimate> apart_for_a_while(const Ways& ways, double t, double horizon) {
  if constexpr (Ways::follows_open_ways) {
    const double until = ways.open_until(t, horizon);
    if (until > horizon) return ContactEstimate{never, true};
    if (until > t) return ContactEstimate{until, false};
  }
  return std::nullopt;
}

/// The first contact in [t, horizon] of two bodies that penetrate just after t, or `never`. Those that do not approach
/// are looked at next when they are deeper in each other by more than roundings, then by twice as much each time, so
/// that there is an end, or again after they have parted. `estimate`: an earlier time will do.
template <class Ways, class Pair, int Degree>
ContactEstimate first_approach(const Ways& ways, const Pair& pair, const Body<Degree>& a, const Body<Degree>& b,
                               double t, double horizon, bool estimate) {
  constexpr double roundings = 0x1p-46;
  double part = roundings;
  while (t <= horizon && !approach_at<Degree>(a, b, t)) {
    const Overlap overlap = overlap_from<Ways, Pair, Degree>(ways, pair, a, b, t, horizon, part);
    if (!(overlap.parts < overlap.deeper)) {
      t = overlap.deeper;
      part *= 2;
      continue;
    }
    part = roundings;
    if (estimate) {
      if (const auto found = apart_for_a_while(ways, overlap.parts, horizon)) return *found;
    }
    t = ways.first_penetration(overlap.parts, horizon);
  }
  return {t <= horizon ? t : never, true};
}

/// The first contact in [t0, horizon] of two bodies that stand as they are given; none where they overlap at t0, or
/// begin to do so without approaching faster than by roundings, which is judged otherwise where bodies turn.
template <int Degree>
std::optional<double> contact_of_standing(const Body<Degree>& a, const Body<Degree>& b, double t0, double horizon,
                                          ContactMode mode) {
  const double first = as_they_stand<Degree>(a, b, [&](const auto& x, const auto& y) {
    return collision::first_contact(x, y, t0, horizon, ContactMode::transparent);
  });
  const bool counts =
      first == never || mode == ContactMode::transparent || (first > t0 && approach_at<Degree>(a, b, first));
  return counts ? std::optional(first) : std::nullopt;
}

/// The first contact in [t0, horizon], or with `estimate` an earlier time, of bodies that doubles have not proved apart
/// just after t0. Bodies that overlap without a contact are followed from the beginning of their motions; so that
/// repeated calls cost no more than twice as much as one, they are also followed equally far ahead of t0, up to
/// `farthest`.
template <int Degree>
ContactEstimate contact_from(const Body<Degree>& a, const Body<Degree>& b, double t0, double horizon, double farthest,
                             ContactMode mode, bool estimate) {
  if (both_stand<Degree>(a, b)) {
    if (const auto contact = contact_of_standing<Degree>(a, b, t0, horizon, mode)) return {*contact, true};
  }
  return with_ways<Degree>(a, b, [&](const auto& pair) -> ContactEstimate {
    using Pair = std::decay_t<decltype(pair)>;
    using Ways = WaysApart<Pair, RememberedSigns&>;
    RememberedSigns signs;
    const Ways ways(pair, signs);
    if (estimate) {
      if (const auto found = apart_for_a_while(ways, t0, horizon)) return *found;
    }
    const double first = ways.first_penetration(t0, horizon, estimate);
    if (first == never || mode == ContactMode::transparent) return {first, true};
    if (first == t0) {
      // Whether an overlap at t0 counts as a contact is decided by following both from the beginning of these motions,
      // so that the answer does not depend on when it is asked for.
      const double begun = std::max(a.motion.start(), b.motion.start());
      if (begun < t0 && ways.penetrate(next_down(t0))) {
        const double met = ways.first_penetration(begun, t0);
        const double far = std::max(horizon, std::min(farthest, t0 + (t0 - begun)));
        const auto contact = first_approach<Ways, Pair, Degree>(ways, pair, a, b, met, far, false);
        if (contact.time == never && far > horizon) return ContactEstimate{far < farthest ? far : never, false};
        if (contact.time >= t0) return contact;
      }
    }
    return first_approach<Ways, Pair, Degree>(ways, pair, a, b, first, horizon, estimate);
  });
}

}  // namespace

template <int Degree>
double TurningContact<Degree>::first_contact(const Body& a, const Body& b, double t0, double horizon, ContactMode mode,
                                             FoundTouch*) {
  if (!(t0 <= horizon)) return never;
  if (!turning_counts(a.shape, b.shape)) {
    return without_turning<Degree>(
        a, b, [&](const auto& x, const auto& y) { return collision::first_contact(x, y, t0, horizon, mode); });
  }
  return contact_from<Degree>(a, b, t0, horizon, horizon, mode, false).time;
}

/// Exact tests far ahead are mostly not needed, since the motions change before. So for bodies that have just met it is
/// only proved that they stay apart for a while.
template <int Degree>
ContactEstimate TurningContact<Degree>::estimated_contact(const Body& a, const Body& b, double t0, double horizon,
                                                          double farthest, ContactMode mode, bool earlier) {
  if (!(t0 <= horizon)) return {never, true};
  if (!turning_counts(a.shape, b.shape)) return {first_contact(a, b, t0, horizon, mode, nullptr), true};
  return contact_from<Degree>(a, b, t0, horizon, farthest, mode, earlier);
}

template <int Degree>
double TurningContact<Degree>::apart_until(const Body& a, const Body& b, double t0, double horizon,
                                           PairMemory& memory) {
  if (!(t0 <= horizon)) return never;
  if (!turning_counts(a.shape, b.shape)) return t0;
  if (both_stand<Degree>(a, b)) {
    return as_they_stand<Degree>(a, b, [&](const auto& x, const auto& y) {
      return pair_tests<certificates::PointMotion<Degree>>(x.shape, y.shape).apart_until(x, y, t0, horizon, memory);
    });
  }
  return with_ways<Degree>(a, b, [&](const auto& pair) { return pair.apart_until(t0, horizon); });
}

template <int Degree>
bool TurningContact<Degree>::in_contact(const Body& a, const Body& b, double t) {
  if (!turning_counts(a.shape, b.shape)) {
    return without_turning<Degree>(a, b, [&](const auto& x, const auto& y) { return collision::in_contact(x, y, t); });
  }
  if (both_stand<Degree>(a, b)) {
    return as_they_stand<Degree>(a, b, [&](const auto& x, const auto& y) { return collision::in_contact(x, y, t); });
  }
  return with_ways<Degree>(
      a, b, [&](const auto& pair) { return WaysApart<std::decay_t<decltype(pair)>>(pair).penetrate(t); });
}

template <int Degree>
double TurningContact<Degree>::first_separation(const Body& a, const Body& b, double t0, double horizon) {
  if (!(t0 <= horizon)) return never;
  if (!turning_counts(a.shape, b.shape)) {
    return without_turning<Degree>(
        a, b, [&](const auto& x, const auto& y) { return collision::first_separation(x, y, t0, horizon); });
  }
  if (both_stand<Degree>(a, b)) {
    return as_they_stand<Degree>(
        a, b, [&](const auto& x, const auto& y) { return collision::first_separation(x, y, t0, horizon); });
  }
  return with_ways<Degree>(a, b, [&](const auto& pair) {
    RememberedSigns signs;
    return WaysApart<std::decay_t<decltype(pair)>, RememberedSigns&>(pair, signs).first_parting(t0, horizon);
  });
}

#define KDS_INSTANTIATE(degree)                                                \
  template struct TurningContact<degree>;                                      \
  template double time_to_look_ahead(const certificates::RigidMotion<degree>&, \
                                     const certificates::RigidMotion<degree>&);
KDS_INSTANTIATE(1) KDS_INSTANTIATE(2)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
