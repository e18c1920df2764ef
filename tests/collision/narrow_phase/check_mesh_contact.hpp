// Meshes against brute force over all pairs of triangles, and against static distances: for paths of any degree.
#pragma once

#include "collision/narrow_phase/ball_touch.hpp"
#include "collision/narrow_phase/convex_touch.hpp"
#include "tests/collision/narrow_phase/mesh_distances.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <variant>

namespace kds::collision::samples {

inline constexpr double infinity = std::numeric_limits<double>::infinity();

/// Every pair's own object for a and b; `visit(i, j, touch)`.
template <int Degree, class Visit>
void every_touch(const PlacedShape& a, const PlacedShape& b, const RelativeMotion<Degree>& motion, const Visit& visit) {
  const auto gap = contact_gap(motion, a.bounding_radius + b.bounding_radius);
  const auto of_a = triangles_of(a);
  const auto sharp = [](const PlacedShape& shape) { return std::get<MeshShape>(shape.shape).mesh->sharp(); };
  if (const auto* ball = std::get_if<Sphere>(&b.shape)) {
    // The same horizon is not known here: not degree 2, for which it is where the search for roots begins.
    for (std::uint32_t i = 0; i < of_a.size(); ++i) {
      visit(i, 0u, BallTouch<Degree>(of_a[i], PlacedBall{ball->radius}, motion, gap, sharp(a), 0x1p200, {0, 0x1p200}));
    }
  } else if (std::holds_alternative<Box>(b.shape)) {
    const PlacedBox box{b.half_axes, b.rotation};
    for (std::uint32_t i = 0; i < of_a.size(); ++i) {
      visit(i, 0u, ConvexTouch<Degree, PlacedBox>(of_a[i], box, motion, gap, false));
    }
  } else {
    const auto of_b = triangles_of(b);
    for (std::uint32_t i = 0; i < of_a.size(); ++i) {
      for (std::uint32_t j = 0; j < of_b.size(); ++j) {
        const bool both_sharp = sharp(a) && sharp(b);
        visit(i, j, ConvexTouch<Degree, PlacedTriangle>(of_a[i], of_b[j], motion, gap, both_sharp));
      }
    }
  }
}

/// The first contact at or after tau0 by looking at every pair.
template <int Degree>
std::optional<MeshTouch> brute_force(const PlacedShape& a, const PlacedShape& b, const RelativeMotion<Degree>& motion,
                                     double tau0, ContactMode mode) {
  std::optional<MeshTouch> best;
  every_touch(a, b, motion, [&](std::uint32_t i, std::uint32_t j, const auto& touch) {
    double tau = touch.first_inside(tau0);
    while (mode == ContactMode::resolved && tau < infinity && !touch.approaching(tau)) {
      tau = touch.turning(tau, touch.leave(tau));
      if (tau < infinity) tau = touch.first_inside(tau);
    }
    if (tau < infinity && (!best || tau < best->tau)) best = {tau, i, j};
  });
  return best;
}

/// The first time at or after tau at which no pair touches.
template <int Degree>
double brute_force_free(const PlacedShape& a, const PlacedShape& b, const RelativeMotion<Degree>& motion, double tau) {
  for (bool moved = true; moved && tau < infinity;) {
    moved = false;
    every_touch(a, b, motion, [&](std::uint32_t, std::uint32_t, const auto& touch) {
      if (tau == infinity || touch.first_inside(tau) != tau) return;
      tau = touch.leave(tau);
      moved = true;
    });
  }
  return tau;
}

template <int Degree>
void against_brute_force(std::uint64_t seed, int trials) {
  INFO("seed " << seed << ", degree " << Degree);
  Random random(seed);
  int met = 0;
  for (int trial = 0; trial < trials; ++trial) {
    const PlacedShape a = random_shape(random, static_cast<int>(random.below(3)));
    const PlacedShape b = random_shape(random, static_cast<int>(random.below(Degree != 2 ? 5 : 4)));
    auto motion = encounter<Degree>(random, random.uniform(0.5, 3), 1.5);
    if (trial % 10 == 0) motion.coefficients[0] *= 0.1;  // begins in contact, as a rule
    const MeshPair<Degree> pair(a, b, motion);
    for (const ContactMode mode : {ContactMode::transparent, ContactMode::resolved}) {
      const double tau0 = trial % 3 == 0 ? random.uniform(0, 1) : 0.0;
      INFO("trial " << trial << ", kind " << b.shape.index() << ", tau0 " << tau0);
      const auto found = pair.first_contact(tau0, infinity, mode);
      const auto expected = brute_force(a, b, motion, tau0, mode);
      REQUIRE(found.has_value() == expected.has_value());
      if (!found) continue;
      ++met;
      REQUIRE(found->tau == expected->tau);
      REQUIRE(found->triangle_a == expected->triangle_a);
      REQUIRE(found->triangle_b == expected->triangle_b);
      if (mode == ContactMode::transparent) {
        REQUIRE(pair.touching(found->tau));
        const double free = pair.first_free_time(found->tau, infinity);
        REQUIRE(free == brute_force_free(a, b, motion, found->tau));
        if (free < infinity) REQUIRE_FALSE(pair.touching(free));
        if (found->tau > tau0) REQUIRE_FALSE(pair.touching(std::nextafter(found->tau, 0)));
      }
    }
  }
  CHECK(met > trials / 2);
}

/// Before the contact that is reported the surfaces are apart, and at it they are nearer than a few gaps: sampled with
/// static distances. If none is reported they are apart at all times.
template <int Degree>
void against_distances(std::uint64_t seed, int trials) {
  INFO("seed " << seed << ", degree " << Degree);
  Random random(seed);
  int met = 0;
  for (int trial = 0; trial < trials; ++trial) {
    INFO("trial " << trial);
    const PlacedShape a = random_shape(random, 1 + static_cast<int>(random.below(2)));
    const int kind = static_cast<int>(random.below(3));
    const PlacedShape b = random_shape(random, kind == 2 ? 4 : 1 + kind);
    const auto motion = encounter<Degree>(random, 3, 1.5);
    const MeshPair<Degree> pair(a, b, motion);
    const double radii = a.bounding_radius + b.bounding_radius;
    const auto found = pair.first_contact(0, 2, ContactMode::transparent);
    const int samples = 40;
    const Long last = found ? found->tau : 2.0;
    for (int i = 0; i < samples; ++i) {
      const Long tau = last * i / samples;
      const Vector3l place = exact_place(motion, tau);
      if (place.norm() > radii) continue;
      REQUIRE(distance(a, b, place) > 0);
    }
    if (!found) continue;
    ++met;
    const double gap = contact_gap(motion, radii)(found->tau);
    const Long at_contact = distance(a, b, exact_place<Degree>(motion, found->tau));
    REQUIRE(at_contact <= 20 * gap);
    // Never late: up to 2^-40 before there is something between them.
    REQUIRE(distance(a, b, exact_place<Degree>(motion, found->tau * (1 - 0x1p-40L))) > 0);
    // And soon after, unless it grazes, they penetrate: the contact is true.
    const auto where = pair.where(found->tau);
    const double speed = -where.normal.dot(motion.velocity(found->tau));
    if (speed > 0.1) REQUIRE(distance(a, b, exact_place<Degree>(motion, found->tau + 20 * gap / speed)) <= 0);
    // The point lies on both surfaces.
    const auto of_a = triangles_of(a);
    Long off = infinity;
    for (const auto& t : of_a)
      off = std::min(off, point_distance(where.point.template cast<Long>(), corners(t, Vector3l::Zero())));
    REQUIRE(off <= 1e-12L);
  }
  CHECK(met > trials / 4);
}

}  // namespace kds::collision::samples
