#include "collision/narrow_phase/compound_contact.hpp"

#include "collision/narrow_phase/bending_contact.hpp"
#include "collision/narrow_phase/pair_tests.hpp"
#include "collision/narrow_phase/part_pairs.hpp"
#include "collision/narrow_phase/piecewise_contact.hpp"
#include "collision/narrow_phase/surface_gap.hpp"
#include "kds/arithmetic/lattice.hpp"

#include <algorithm>
#include <optional>

namespace kds::collision {
namespace {

template <int Degree>
using Body = TranslatingShape<Degree>;

/// Two parts, with the motions of their bodies, and their tests.
template <int Degree>
struct PartTests {
  PartTests(const Body<Degree>& body_a, const Body<Degree>& body_b, const PlacedShape& part_a,
            const PlacedShape& part_b)
      : a{part_a, body_a.motion},
        b{part_b, body_b.motion},
        tests(pair_tests<certificates::PointMotion<Degree>>(part_a, part_b)) {}

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

  /// Whether they approach where they touch, the surface of a mesh that bends with its own velocity.
  bool approach(const Contact& contact) const {
    if (!bends(a.shape.shape) && !bends(b.shape.shape)) return approaching(contact, a, b);
    const auto velocity = [&](const Body<Degree>& body, const Feature& feature) -> Eigen::Vector3d {
      const Eigen::Vector3d point = contact.point - body.motion.position(contact.time);
      return body.motion.velocity(contact.time) +
             surface_rate(body.shape, feature, point, contact.normal, contact.time).velocity;
    };
    return dot(contact.normal, velocity(b, contact.feature_b) - velocity(a, contact.feature_a)) < 0;
  }

  /// How far they are apart, or how little they overlap, along the normal of a contact.
  double gap(const Contact& contact) const {
    if (bends(a.shape.shape) || bends(b.shape.shape)) return 0;
    return gap_along(a, b, contact.normal, contact.time);
  }

  Body<Degree> a, b;
  const PairTests<certificates::PointMotion<Degree>>& tests;
};

/// Of two that do not touch: by the parts that are nearest to each other, the first of several.
template <int Degree>
Contact nearest_contact(const Body<Degree>& a, const Body<Degree>& b, double t) {
  std::optional<Contact> nearest;
  double least = never;
  for (const PlacedShape& part_a : parts_of(a.shape)) {
    for (const PlacedShape& part_b : parts_of(b.shape)) {
      const PartTests<Degree> parts(a, b, part_a, part_b);
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

template <int Degree>
double CompoundContact<Degree>::first_contact(const Body& a, const Body& b, double t0, double horizon, ContactMode mode,
                                              FoundTouch*) {
  if (!(t0 <= horizon)) return never;
  double first = never;
  for (const auto& pair : PartPairs<Degree>(a, b, t0, horizon).in_time()) {
    const double end = std::min(first, horizon);
    if (pair.from > end) break;
    first = std::min(first, PartTests<Degree>(a, b, *pair.a, *pair.b).first_contact(t0, end, mode));
  }
  return first;
}

template <int Degree>
double CompoundContact<Degree>::apart_until(const Body& a, const Body& b, double t0, double horizon, PairMemory&) {
  if (!(t0 <= horizon)) return never;
  double first = never;
  for (const auto& pair : PartPairs<Degree>(a, b, t0, horizon).in_time()) {
    if (first == t0 || pair.from >= first || pair.from > horizon) break;
    const double apart = PartTests<Degree>(a, b, *pair.a, *pair.b).apart_until(t0, horizon);
    first = std::min(first, std::max(apart, pair.from));
  }
  return first;
}

template <int Degree>
bool CompoundContact<Degree>::in_contact(const Body& a, const Body& b, double t) {
  const PartPairs<Degree> pairs(a, b, t, t);
  return std::any_of(pairs.all().begin(), pairs.all().end(), [&](const auto& pair) {
    return PartTests<Degree>(a, b, *pair.a, *pair.b).in_contact(t);
  });
}

/// Where the contact of two parts ends others may be in contact: repeat until none is.
template <int Degree>
double CompoundContact<Degree>::first_separation(const Body& a, const Body& b, double t0, double horizon) {
  if (!(t0 <= horizon)) return never;
  const PartPairs<Degree> pairs(a, b, t0, horizon);
  double t = t0;
  for (bool moved = true; moved && t != never;) {
    moved = false;
    for (const auto& pair : pairs.all()) {
      if (t < pair.from || t > pair.until) continue;
      const PartTests<Degree> parts(a, b, *pair.a, *pair.b);
      if (!parts.in_contact(t)) continue;
      t = parts.first_separation(t, horizon);
      moved = true;
      if (t == never) break;
    }
  }
  return t;
}

template <int Degree>
Contact CompoundContact<Degree>::contact_at(const Body& a, const Body& b, double t, const FoundTouch&) {
  std::optional<Contact> touching;
  const PartPairs<Degree> pairs(a, b, t, t);
  for (const auto& pair : pairs.all()) {
    const PartTests<Degree> parts(a, b, *pair.a, *pair.b);
    if (!parts.in_contact(t)) continue;
    const Contact contact = parts.contact_at(t);
    if (parts.approach(contact)) return contact;
    if (!touching) touching = contact;
  }
  if (touching) return *touching;
  const double before = next_down(t);
  const PartPairs<Degree> pairs_before(a, b, before, before);
  for (const auto& pair : pairs_before.all()) {
    const PartTests<Degree> parts(a, b, *pair.a, *pair.b);
    if (parts.in_contact(before)) return parts.contact_at(t);
  }
  return nearest_contact(a, b, t);
}

#define KDS_INSTANTIATE(degree) template struct CompoundContact<degree>;
KDS_FOR_EACH_DEGREE(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
