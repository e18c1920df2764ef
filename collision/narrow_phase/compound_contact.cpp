#include "collision/narrow_phase/compound_contact.hpp"

#include "certificates/turning/rigid_motion.hpp"
#include "collision/body_motion.hpp"
#include "collision/narrow_phase/pair_tests.hpp"
#include "collision/narrow_phase/part_pairs.hpp"
#include "collision/narrow_phase/piecewise_contact.hpp"
#include "collision/narrow_phase/surface_gap.hpp"
#include "collision/narrow_phase/surface_rate.hpp"
#include "collision/narrow_phase/turning/point_rates.hpp"
#include "collision/narrow_phase/turning/turning_part_pairs.hpp"
#include "collision/vectors.hpp"
#include "kds/arithmetic/lattice.hpp"

#include <algorithm>
#include <optional>
#include <type_traits>

namespace kds::collision {
namespace {

using Eigen::Vector3d;

template <class Motion>
using PairsOf = std::conditional_t<turns<Motion>, TurningPartPairs<Motion::degree>, PartPairs<Motion::degree>>;

/// Whether two parts approach where they touch, the surface of a mesh that bends with its own velocity.
template <int Degree>
bool parts_approach(const TranslatingShape<Degree>& a, const TranslatingShape<Degree>& b, const Contact& contact) {
  if (!bends(a.shape.shape) && !bends(b.shape.shape)) return approaching(contact, a, b);
  const Vector3d velocity_a = a.motion.velocity(contact.time) + surface_rate(a, contact, true).velocity;
  const Vector3d velocity_b = b.motion.velocity(contact.time) + surface_rate(b, contact, false).velocity;
  return dot(contact.normal, velocity_b - velocity_a) < 0;
}
/// The same for bodies that turn: whether they approach faster than by roundings.
template <int Degree>
bool parts_approach(const MovingShape<certificates::RigidMotion<Degree>>& a,
                    const MovingShape<certificates::RigidMotion<Degree>>& b, const Contact& contact) {
  const PointRates<Degree> rates(a.motion, b.motion, contact.time);
  const Vector3d of_surfaces = surface_rate(b, contact, false).velocity - surface_rate(a, contact, true).velocity;
  return dot(contact.normal, rates.velocity(contact.point) + of_surfaces) < -rates.noise(contact.point);
}

/// How far two parts are apart, or how little they overlap, along the normal of a contact.
template <int Degree>
double parts_gap(const TranslatingShape<Degree>& a, const TranslatingShape<Degree>& b, const Contact& contact) {
  if (bends(a.shape.shape) || bends(b.shape.shape)) return 0;
  return gap_along(a, b, contact.normal, contact.time);
}
template <int Degree>
double parts_gap(const MovingShape<certificates::RigidMotion<Degree>>& a,
                 const MovingShape<certificates::RigidMotion<Degree>>& b, const Contact& contact) {
  if (bends(a.shape.shape) || bends(b.shape.shape)) return 0;
  const auto placed = [&](const MovingShape<certificates::RigidMotion<Degree>>& body) {
    const Eigen::Quaterniond q = body.motion.restarted(contact.time).orientation;
    return place(body.shape.shape, Eigen::Quaterniond(Eigen::Vector4d(q.coeffs() / norm(q))));
  };
  const PlacedShape placed_a = placed(a), placed_b = placed(b);
  return gap_along<Degree>({placed_a, a.motion.path}, {placed_b, b.motion.path}, contact.normal, contact.time);
}

/// Two parts, with the motions of their bodies, and their tests.
template <class Motion>
struct PartTests {
  using Body = MovingShape<Motion>;

  PartTests(const Body& body_a, const Body& body_b, const PlacedShape& part_a, const PlacedShape& part_b)
      : a{part_a, body_a.motion}, b{part_b, body_b.motion}, tests(pair_tests<Motion>(part_a, part_b)) {}

  double first_contact(double t0, double horizon, ContactMode mode) const {
    return tests.first_contact(a, b, t0, horizon, mode, nullptr);
  }
  double apart_until(double t0, double horizon) const {
    PairMemory memory;
    return tests.apart_until(a, b, t0, horizon, memory);
  }
  bool in_contact(double t) const { return tests.in_contact(a, b, t); }
  double first_separation(double t, double horizon) const { return tests.first_separation(a, b, t, horizon); }
  Contact contact_at(double t) const { return tests.contact_at(a, b, t, {}); }

  bool approach(const Contact& contact) const { return parts_approach(a, b, contact); }
  double gap(const Contact& contact) const { return parts_gap(a, b, contact); }

  Body a, b;
  const PairTests<Motion>& tests;
};

/// Of two that do not touch: by the parts that are nearest to each other, the first of several.
template <class Motion>
Contact nearest_contact(const MovingShape<Motion>& a, const MovingShape<Motion>& b, double t) {
  std::optional<Contact> nearest;
  double least = never;
  for (const PlacedShape& part_a : parts_of(a.shape)) {
    for (const PlacedShape& part_b : parts_of(b.shape)) {
      const PartTests<Motion> parts(a, b, part_a, part_b);
      const Contact contact = parts.contact_at(t);
      const double gap = parts.gap(contact);
      if (nearest && !(gap < least)) continue;
      nearest = contact;
      least = gap;
    }
  }
  return *nearest;
}

}  // namespace

template <class Motion>
double CompoundContact<Motion>::first_contact(const Body& a, const Body& b, double t0, double horizon, ContactMode mode,
                                              FoundTouch*) {
  if (!(t0 <= horizon)) return never;
  double first = never;
  PairsOf<Motion> pairs(a, b, t0, horizon);
  do {
    for (const auto& pair : pairs.in_time()) {
      const double end = std::min(first, horizon);
      if (pair.from > end) break;
      const double start = turns<Motion> ? pair.from : t0;
      first = std::min(first, PartTests<Motion>(a, b, *pair.a, *pair.b).first_contact(start, end, mode));
    }
  } while (pairs.list_on(first));
  return first;
}

template <class Motion>
double CompoundContact<Motion>::apart_until(const Body& a, const Body& b, double t0, double horizon, PairMemory&) {
  if (!(t0 <= horizon)) return never;
  double first = never;
  PairsOf<Motion> pairs(a, b, t0, horizon);
  do {
    for (const auto& pair : pairs.in_time()) {
      if (first == t0 || pair.from >= first || pair.from > horizon) break;
      const double start = turns<Motion> ? pair.from : t0;
      const double apart = PartTests<Motion>(a, b, *pair.a, *pair.b).apart_until(start, horizon);
      first = std::min(first, std::max(apart, pair.from));
    }
  } while (pairs.list_on(first));
  return first;
}

template <class Motion>
bool CompoundContact<Motion>::in_contact(const Body& a, const Body& b, double t) {
  const PairsOf<Motion> pairs(a, b, t, t);
  return std::any_of(pairs.all().begin(), pairs.all().end(),
                     [&](const auto& pair) { return PartTests<Motion>(a, b, *pair.a, *pair.b).in_contact(t); });
}

/// Where the contact of two parts ends others may be in contact: repeat until none is.
template <class Motion>
double CompoundContact<Motion>::first_separation(const Body& a, const Body& b, double t0, double horizon) {
  if (!(t0 <= horizon)) return never;
  PairsOf<Motion> pairs(a, b, t0, horizon);
  double t = t0;
  for (bool moved = true; moved && t != never;) {
    moved = pairs.list_on(t);
    for (const auto& pair : pairs.all()) {
      if (t < pair.from || t > pair.until) continue;
      const PartTests<Motion> parts(a, b, *pair.a, *pair.b);
      if (!parts.in_contact(t)) continue;
      t = parts.first_separation(t, horizon);
      moved = true;
      if (t == never) break;
    }
  }
  return t;
}

template <class Motion>
Contact CompoundContact<Motion>::contact_at(const Body& a, const Body& b, double t, const FoundTouch&) {
  std::optional<Contact> touching;
  const PairsOf<Motion> pairs(a, b, t, t);
  for (const auto& pair : pairs.all()) {
    const PartTests<Motion> parts(a, b, *pair.a, *pair.b);
    if (!parts.in_contact(t)) continue;
    const Contact contact = parts.contact_at(t);
    if (parts.approach(contact)) return contact;
    if (!touching) touching = contact;
  }
  if (touching) return *touching;
  const double before = next_down(t);
  const PairsOf<Motion> pairs_before(a, b, before, before);
  for (const auto& pair : pairs_before.all()) {
    const PartTests<Motion> parts(a, b, *pair.a, *pair.b);
    if (parts.in_contact(before)) return parts.contact_at(t);
  }
  return nearest_contact(a, b, t);
}

#define KDS_INSTANTIATE(motion) template struct CompoundContact<motion>;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
