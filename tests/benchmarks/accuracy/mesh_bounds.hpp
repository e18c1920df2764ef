// How early contacts of meshes are, against exact arithmetic and against the bound that the library states.
#pragma once

#include "collision/narrow_phase/mesh_contact.hpp"
#include "collision/narrow_phase/relative_motion.hpp"
#include "tests/benchmarks/accuracy/encounters.hpp"
#include "tests/benchmarks/accuracy/exact_mesh.hpp"

#include <algorithm>
#include <cmath>

namespace accuracy {

struct EarlyContacts {
  int contacts = 0;
  int missed = 0;            ///< the surfaces meet, and no contact was reported
  int near_misses = 0;       ///< reported, and the surfaces never meet: they pass within the gap
  int late = 0;              ///< the surfaces meet before the reported time
  double most_of_gap = 0;    ///< the distance at the report over the contact gap; the library says at most 1
  double gap_over_size = 0;  ///< the greatest contact gap over the bodies' radii
  double most_seconds = 0;   ///< how much before the exact time
  double most_of_bound = 0;  ///< that over gap / closing speed along the axis: 1 where the bound is reached
};

/// A contact of two meshes. Paths of degree 2 have no exact time here: the distance is looked at instead.
template <int Degree>
void compare(const Encounter<Degree>& e, const Setting& s, EarlyContacts& errors) {
  using namespace kds::collision;
  const PlacedShape a = place(e.a.shape, e.a.orientation);
  const PlacedShape b = place(e.b.shape, e.b.orientation);
  const auto& motion_a = e.a.motion[0];
  const auto& motion_b = e.b.motion[0];
  const double limit = s.clock + 4 * e.duration;
  const double t = first_contact(TranslatingShape<Degree>{a, motion_a}, TranslatingShape<Degree>{b, motion_b}, s.clock,
                                 limit, ContactMode::transparent);
  if (t == s.clock) return;
  const ExactMesh exact_a(e.a), exact_b(e.b);
  std::optional<Rational> root;
  if constexpr (Degree == 1) {
    root = first_touch(exact_a, exact_b, motion_a, motion_b, s.clock);
    if (root && oracle::rational(limit) < *root) root.reset();
    errors.missed += root && t == kds::never;
    errors.near_misses += !root && t != kds::never;
  }
  if (t == kds::never) return;
  ++errors.contacts;
  const auto motion = relative_to(motion_a, motion_b);
  const double gap = contact_gap(motion, a.bounding_radius + b.bounding_radius)(t - motion.epoch);
  const Real apart = separation(exact_a, exact_b, motion_a, motion_b, t);
  errors.most_of_gap = std::max(errors.most_of_gap, static_cast<double>(apart / gap));
  errors.gap_over_size = std::max(errors.gap_over_size, gap / (a.bounding_radius + b.bounding_radius));
  bool late = apart <= 0;
  if (root) {
    late = late || *root < oracle::rational(t);
    const double early = oracle::approximate(*root - oracle::rational(t));
    const Contact where = contact_at(TranslatingShape<Degree>{a, motion_a}, TranslatingShape<Degree>{b, motion_b}, t);
    const double closing = -where.normal.dot(motion_b.velocity(t) - motion_a.velocity(t));
    errors.most_seconds = std::max(errors.most_seconds, early);
    if (closing > 0) errors.most_of_bound = std::max(errors.most_of_bound, early * closing / gap);
  } else if (Degree == 2) {
    constexpr int looks = 50;
    for (int i = 1; i < looks && !late; ++i) {
      const double before = s.clock + (t - s.clock) * i / looks;
      late = separation(exact_a, exact_b, motion_a, motion_b, before) <= 0;
    }
  }
  errors.late += late;
}

}  // namespace accuracy
