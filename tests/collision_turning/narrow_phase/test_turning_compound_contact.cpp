// Compounds that turn: they meet when the first of their parts does, whatever the other is.
#include "collision/narrow_phase/narrow_phase.hpp"
#include "collision/narrow_phase/part_pairs.hpp"
#include "collision/narrow_phase/turning/turning_part_pairs.hpp"
#include "collision/shapes/compound.hpp"
#include "collision/shapes/convex_hull.hpp"
#include "tests/collision/sample_meshes.hpp"
#include "tests/collision_turning/narrow_phase/check_meetings.hpp"
#include "tests/collision_turning/narrow_phase/turning_solids.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <variant>
#include <vector>

namespace test_turning_compound_contact {
namespace {

using namespace kds;
using namespace kds::collision;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using kds::tests::first_meeting;
using kds::tests::motion_of;
using kds::tests::Random;
using kds::tests::random_hull;
using kds::tests::random_vector;

template <int Degree>
using Solid = kds::tests::TurningSolid<Degree>;

const Vector3d zero = Vector3d::Zero();

Shape random_part(Random& random) {
  if (random.one_in(4)) return MeshShape{samples::cuboid({0.3, 0.5, random.one_in(2) ? 0.5 : 0.1})};
  if (random.one_in(2)) return random_hull(random);
  return Box{Vector3d(random.between(0.1, 0.6), 0.25, random.between(0.02, 0.6))};
}

/// Parts within a cube, or some far from the centre about which they turn.
Compound random_compound(Random& random) {
  for (;;) {
    std::vector<CompoundPart> parts;
    const int count = 1 + static_cast<int>(random.below(4));
    for (int i = 0; i < count; ++i) {
      parts.push_back({random_part(random), random_vector(random, random.one_in(5) ? 6 : 1)});
      if (random.one_in(2)) parts.back().orientation = Quaterniond(1, random.between(-1, 1), 0.5, 0.25).normalized();
    }
    try {
      return compound(parts);
    } catch (const InvalidCompound&) {  // flat, where coordinates are rounded
    }
  }
}

Shape random_other(Random& random) {
  switch (random.below(6)) {
    case 0:
      return Sphere{random.between(0.2, 1)};
    case 1:
      return Box{Vector3d(0.5, random.between(0.1, 1), 0.5)};
    case 2:
      return Capsule{random.between(0.1, 0.5), 0.5};
    case 3:
      return random_hull(random);
    case 4:
      return MeshShape{samples::torus(5, 3)};
    default:
      return random_compound(random);
  }
}

template <int Degree>
using Pair = MovingShape<certificates::RigidMotion<Degree>>;

/// Calls ask(part of a, part of b), as bodies of their own with the same motions.
template <int Degree, class Ask>
void each_pair(const Solid<Degree>& a, const Solid<Degree>& b, const Ask& ask) {
  for (const PlacedShape& x : parts_of(a.placed)) {
    for (const PlacedShape& y : parts_of(b.placed)) ask(Pair<Degree>{x, a.motion}, Pair<Degree>{y, b.motion});
  }
}

template <int Degree>
double first_of_parts(const Solid<Degree>& a, const Solid<Degree>& b, double t0, double horizon) {
  double first = never;
  each_pair(a, b, [&](const auto& x, const auto& y) {
    first = std::min(first, first_contact(x, y, t0, horizon, ContactMode::transparent));
  });
  return first;
}

template <int Degree>
void check_pair(const Solid<Degree>& a, const Solid<Degree>& b, double horizon, int& meetings) {
  const double found = first_meeting(a, b, 0, horizon);
  CHECK(found == first_of_parts(a, b, 0, horizon));
  CHECK(found == first_meeting(b, a, 0, horizon));
  PairMemory memory;
  CHECK(estimated_first_contact(a.body(), b.body(), 0, horizon, ContactMode::transparent, memory).time <= found);
  if (found == never) return;
  ++meetings;
  CHECK(in_contact(a.body(), b.body(), found));
  if (found > 0) CHECK_FALSE(in_contact(a.body(), b.body(), next_down(found)));
  // The contact is that of the first parts that penetrate and approach, or of the first that penetrate.
  const Contact contact = contact_at(a.body(), b.body(), found);
  bool any = false;
  each_pair(a, b, [&](const auto& x, const auto& y) {
    if (!in_contact(x, y, found)) return;
    const Contact of_parts = contact_at(x, y, found);
    any = any || (of_parts.point == contact.point && of_parts.normal == contact.normal &&
                  of_parts.feature_a == contact.feature_a && of_parts.feature_b == contact.feature_b);
  });
  CHECK(any);
  const Contact swapped = contact_at(b.body(), a.body(), found);
  CHECK(swapped.time == contact.time);
  const double parted = first_separation(a.body(), b.body(), found, horizon);
  if (parted == never) return;
  each_pair(a, b, [&](const auto& x, const auto& y) { CHECK_FALSE(in_contact(x, y, parted)); });
}

template <int Degree>
void check_pairs(std::uint64_t seed, int pairs) {
  Random random(seed);
  int meetings = 0;
  for (int i = 0; i < pairs; ++i) {
    const double rate = std::pow(10.0, random.between(-2, 2));
    const Shape shape = random_compound(random), other = random_other(random);
    const auto [a, b] = kds::tests::random_solids<Degree>(random, rate, shape, other);
    INFO("seed " << seed << ", pair " << i << ", with a " << kind_name(b.shape) << ", rate " << rate);
    check_pair(a, b, std::min(2.0, 60 / rate), meetings);
  }
  CHECK(meetings > pairs / 8);
}

}  // namespace

TEST_CASE("turning compounds meet when the first of their parts does", "[narrow-phase][turning][compound]") {
  check_pairs<1>(1, 60);
  check_pairs<2>(2, 60);
}

TEST_CASE("turning compounds: parts that are left out do not meet", "[narrow-phase][turning][compound]") {
  Random random(11);
  std::size_t all = 0, left = 0;
  for (int i = 0; i < 60; ++i) {
    const double rate = std::pow(10.0, random.between(-2, 2)), horizon = std::min(0.5, 20 / rate);
    const Shape shape = random_compound(random), other = random_compound(random);
    const auto [a, b] = kds::tests::random_solids<2>(random, rate, shape, other);
    INFO("pair " << i << ", rate " << rate);
    const TurningPartPairs<2> pairs(a.body(), b.body(), 0, horizon);
    each_pair(a, b, [&](const auto& x, const auto& y) {
      ++all;
      const auto it = std::find_if(pairs.all().begin(), pairs.all().end(),
                                   [&](const auto& pair) { return pair.a == &x.shape && pair.b == &y.shape; });
      const bool there = it != pairs.all().end();
      left += there;
      const double found = first_contact(x, y, 0, horizon, ContactMode::transparent);
      CHECK((there ? it->from <= found : found == never));
    });
  }
  CHECK(2 * left < all);
}

TEST_CASE("turning compounds: a box cut in two meets as the whole one does, to the bit",
          "[narrow-phase][turning][compound]") {
  Random random(3);
  int meetings = 0;
  for (int i = 0; i < 180; ++i) {
    const Vector3d half(1, 0.5, random.one_in(2) ? 0.5 : 0.25);
    const double cut = random.one_in(2) ? 0 : 0.5;  // all these numbers are exact
    const std::vector<CompoundPart> parts{{Box{{(1 + cut) / 2, half[1], half[2]}}, {(cut - 1) / 2, 0, 0}},
                                          {Box{{(1 - cut) / 2, half[1], half[2]}}, {(cut + 1) / 2, 0, 0}}};
    const double rate = std::pow(10.0, random.between(-1, 2));
    Shape other = random_other(random);
    if (std::holds_alternative<MeshShape>(other) || std::holds_alternative<Compound>(other)) other = Box{half};
    if (random.one_in(5)) other = HalfSpace{Vector3d(1, 2, 2).normalized(), 0.25};
    auto [whole, b] = kds::tests::random_solids<2>(random, rate, Box{half}, other);
    if (unbounded(other)) b.motion.angular_velocity = Vector3d::Zero();
    const Solid<2> in_two{compound(parts), whole.motion};
    INFO("pair " << i << ", with a " << kind_name(b.shape) << ", rate " << rate);
    const double horizon = std::min(2.0, 60 / rate);
    const double found = first_meeting(whole, b, 0, horizon);
    CHECK(first_meeting(in_two, b, 0, horizon) == found);
    meetings += found > 0 && found != never;
    if (found == never) continue;
    CHECK(first_separation(in_two.body(), b.body(), found, horizon) ==
          first_separation(whole.body(), b.body(), found, horizon));
  }
  CHECK(meetings > 30);
}

TEST_CASE("turning compounds: hooks in each other meet as meshes of the same boxes do",
          "[narrow-phase][turning][compound]") {
  // Three sides of a square; the two hold each other like links of a chain.
  const std::vector<CompoundPart> hook{{Box{{0.125, 1, 0.125}}, {-0.875, 0, 0}},
                                       {Box{{0.875, 0.125, 0.125}}, {0.125, 0.875, 0}},
                                       {Box{{0.875, 0.125, 0.125}}, {0.125, -0.875, 0}}};
  std::vector<Vector3d> vertices;
  std::vector<Mesh::Triangle> triangles;
  for (const CompoundPart& part : hook) {
    const auto box = samples::cuboid(std::get<Box>(part.shape).half_extents);
    const auto first = static_cast<std::uint32_t>(vertices.size());
    for (const Vector3d& x : box->vertices()) vertices.push_back(x + part.position);
    for (const auto& [i, j, k] : box->triangles()) triangles.push_back({i + first, j + first, k + first});
  }
  const Shape parts = compound(hook), mesh = MeshShape{std::make_shared<const Mesh>(vertices, triangles)};
  Random random(5);
  int meetings = 0;
  for (int i = 0; i < 40; ++i) {
    const double rate = std::pow(10.0, random.between(-1, 1.5));
    auto motion_a = motion_of<2>(zero, random_vector(random, 0.5), random_vector(random, rate));
    auto motion_b = motion_of<2>({0.9, random.between(-0.3, 0.3), random.between(-0.3, 0.3)},
                                 random_vector(random, 0.5), random_vector(random, rate));
    motion_b.orientation = Quaterniond(0, 0, 1, 1);  // its opening the other way, in a plane across
    INFO("pair " << i << ", rate " << rate);
    const Solid<2> a{parts, motion_a}, b{parts, motion_b}, mesh_a{mesh, motion_a}, mesh_b{mesh, motion_b};
    const double found = first_meeting(a, b, 0, 2);
    CHECK(found == first_meeting(mesh_a, mesh_b, 0, 2));
    meetings += found > 0 && found != never;
  }
  CHECK(meetings > 20);
}

TEST_CASE("turning compounds: parts far from the centre, fast", "[narrow-phase][turning][compound]") {
  // A box on an arm of the length 100, which reaches a small ball when it has turned by nearly a radian.
  const std::vector<CompoundPart> arm{{Box{{0.5, 0.5, 0.5}}, {100, 0, 0}}, {Box{{0.1, 0.1, 0.1}}}};
  for (const double rate : {0.01, 1.0, 100.0}) {
    const Solid<1> a{compound(arm), motion_of<1>(zero, zero, {0, 0, rate})};
    const double angle = 1, corner = std::asin(0.005);  // of the face that leads
    const Vector3d at(100 * std::cos(angle), 100 * std::sin(angle), 0);
    const Solid<1> point{Sphere{1e-9}, motion_of<1>(at, zero, zero)};
    const double found = first_meeting(a, point, 0, 4 / rate);
    INFO("rate " << rate);
    CHECK(std::abs(found * rate - (angle - corner)) < 1e-6);
    const Solid<1> beside{Sphere{1e-9}, motion_of<1>(at * 0.994, zero, zero)};
    CHECK(first_meeting(a, beside, 0, 50 / rate) == never);
  }
}

}  // namespace test_turning_compound_contact
