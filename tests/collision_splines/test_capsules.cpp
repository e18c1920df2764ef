// Capsules on curves, against distances at rest in long double: apart before a contact, in contact at it, and a
// contact whenever they come nearer.
#include "collision/narrow_phase/narrow_phase.hpp"
#include "tests/collision/narrow_phase/mesh_distances.hpp"
#include "tests/collision_splines/random_curves.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdint>
#include <limits>

namespace kds::collision::test_capsules {
namespace {

using namespace tests;
using samples::Long;
using samples::Vector3l;

template <int Degree>
Vector3l place_at(const certificates::PointMotion<Degree>& path, Long t) {
  Vector3l x = path.coefficients[Degree].template cast<Long>();
  for (std::size_t i = Degree; i-- > 0;) x = x * (t - path.start) + path.coefficients[i].template cast<Long>();
  return x;
}

Vector3l half_of(const PlacedShape& shape) {
  const auto* const capsule = std::get_if<Capsule>(&shape.shape);
  if (!capsule) return Vector3l::Zero();
  return (shape.rotation * Vector3d(0, 0, capsule->half_length)).cast<Long>();
}
Long radius_of(const PlacedShape& shape) {
  if (const auto* const ball = std::get_if<Sphere>(&shape.shape)) return ball->radius;
  return std::get<Capsule>(shape.shape).radius;
}

/// Of a capsule (a) and a ball, a capsule, or the surface of a mesh.
Long gap(const PlacedShape& a, const PlacedShape& b, const Vector3l& offset) {
  const Vector3l half = half_of(a);
  const Vector3l from = -half, along = 2 * half;
  if (!std::holds_alternative<MeshShape>(b.shape)) {
    const Vector3l half_b = half_of(b);
    return samples::segment_distance(from, along, offset - half_b, 2 * half_b) - radius_of(a) - radius_of(b);
  }
  Long best = std::numeric_limits<Long>::infinity();
  for (const auto& triangle : samples::triangles_of(b)) {
    const auto t = samples::corners(triangle, offset);
    if (samples::crosses(from, half, t)) return -radius_of(a);
    best = std::min({best, samples::point_distance(from, t), samples::point_distance(half, t)});
    for (std::size_t i = 0; i < 3; ++i) {
      best = std::min(best, samples::segment_distance(from, along, t[i], t[(i + 1) % 3] - t[i]));
    }
  }
  return best - radius_of(a);
}

TEMPLATE_TEST_CASE_SIG("Curves: contacts of capsules are where the distances are", "[splines][capsule]",
                       ((int Degree), Degree), 3, 5) {
  const std::uint64_t seed = 41;
  CAPTURE(Degree, seed);
  Random random(seed);
  int met = 0;
  for (int trial = 0; trial < 600; ++trial) {
    SceneMaker maker(random, {.shapes = Shapes::turned_boxes, .side = 3});
    const PlacedShape a = place(Capsule{random.between(0.2, 0.8), random.between(0.3, 1.2)}, maker.orientation());
    const Shape others[]{Sphere{random.between(0.3, 1)}, Capsule{random.between(0.2, 0.8), random.between(0.3, 1.2)},
                         MeshShape{tetrahedron(), random.between(0.4, 1)}};
    const PlacedShape b = place(others[trial % 3], maker.orientation());
    auto path_a = maker.template path<Degree>(0);
    auto path_b = maker.template path<Degree>(0);
    bend(path_a, random, Numbers::fine);
    bend(path_b, random, Numbers::fine);
    const TranslatingShape<Degree> moving_a{a, path_a}, moving_b{b, path_b};
    const double limit = 2;
    const double t = first_contact(moving_a, moving_b, 0, limit, ContactMode::transparent);
    INFO("trial " << trial << ", contact at " << t);
    const auto gap_at = [&](Long at) { return gap(a, b, place_at(path_b, at) - place_at(path_a, at)); };
    const Long last = std::min<Long>(t, limit);
    for (int i = 0; i < 64 && t > 0; ++i) {
      INFO("sample " << i);
      REQUIRE(gap_at(last * i / 64) > 0);
    }
    if (t == never || t == 0) continue;
    ++met;
    REQUIRE(std::abs(gap_at(t)) < 1e-12L);
    const double end = first_separation(moving_a, moving_b, t, 2 * limit);
    if (end < never && !std::holds_alternative<MeshShape>(b.shape)) REQUIRE(std::abs(gap_at(end)) < 1e-12L);
  }
  CHECK(met > 20);
}

}  // namespace
}  // namespace kds::collision::test_capsules
