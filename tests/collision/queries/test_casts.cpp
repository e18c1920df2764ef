// Rays and shapes through worlds: against formulas, against worlds in which what is cast is a body, and at corners.
#include "collision/queries/casts.hpp"

#include "collision/shapes/convex_hull.hpp"
#include "collision/shapes/mesh_script.hpp"
#include "tests/collision/queries/sample_bodies.hpp"
#include "tests/collision/sample_meshes.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <vector>

namespace kds::collision::test_casts {
namespace {

using Eigen::Vector3d;
using samples::body;
using samples::Random;
using samples::random_shape;

/// Contacts of one body in a world where all pass through each other: the first of each other body, by time.
struct FirstMeetings final : WorldListener<1> {
  void contact(World<1>&, const PairEvent& event) override { note(event); }
  void overlap(World<1>&, const PairEvent& event) override { note(event); }
  void note(const PairEvent& event) {
    if (event.a != of && event.b != of) return;
    const BodyId other = event.a == of ? event.b : event.a;
    for (const Hit& hit : met) {
      if (hit.body == other) return;
    }
    met.push_back({other, event.contact});
  }
  BodyId of = ~BodyId{0};
  std::vector<Hit> met;
};

}  // namespace

TEST_CASE("a ray meets a ball where the formula says, also one that has flown there") {
  World<1> world(WorldOptions{});
  const BodyId ball = world.add_body(body(Sphere{0.5}, {3, 0, 0}, {1, 0, 0}));
  world.advance_to(2);
  const auto hit = cast(world, Ray{{0, 0.3, 0}, {10, 0.3, 0}});
  REQUIRE(hit);
  CHECK(hit->body == ball);
  CHECK(hit->contact.time == Approx(0.46).epsilon(1e-14));  // 5 - 0.4 of 10
  CHECK((hit->contact.point - Vector3d(4.6, 0.3, 0)).norm() < 1e-13);
  CHECK((hit->contact.normal - Vector3d(0.8, -0.6, 0)).norm() < 1e-13);
  CHECK(!cast(world, Ray{{0, 0.6, 0}, {10, 0.6, 0}}));
  CHECK(!cast(world, Ray{{0, 0.3, 0}, {4, 0.3, 0}}));
  CHECK(cast(world, Ray{{5.1, 0, 0}, {5.1, 0, 0}})->contact.time == 0);  // no way at all, from inside
  CHECK(!cast(world, Ray{{0, 0.3, 0}, {10, 0.3, 0}}, [&](BodyId id) { return id != ball; }));
}

TEST_CASE("what is cast meets the bodies that it would meet as a body, at the same doubles") {
  const std::uint64_t seed = GENERATE(range(1, 25));
  INFO("seed " << seed);
  Random random(seed);
  const auto ring = samples::torus(8, 4);
  World<1> world(WorldOptions{});
  FirstMeetings record;
  World<1> moving(WorldOptions{}, &record);
  const std::uint32_t bodies = 2 + random.below(40);
  for (std::uint32_t i = 0; i < bodies; ++i) {
    const Shape shape = random_shape(random, ring);
    const Vector3d at = random.vector(4);
    const auto standing = body(shape, at, Vector3d::Zero(), random.orientation());
    world.add_body(standing);
    moving.add_body(standing);
  }
  const Ray way{random.vector(5), random.vector(5)};
  const Shape shape = random_shape(random, ring);
  const Eigen::Quaterniond orientation = random.orientation();
  record.of = moving.add_body(body(shape, way.from, way.to - way.from, orientation));
  moving.advance_to(1);

  const PlacedShape placed = place(shape, orientation);
  const auto all = cast_all(world, placed, way);
  REQUIRE(all.size() == record.met.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    CHECK(all[i].body == record.met[i].body);
    CHECK(all[i].contact.time == record.met[i].contact.time);
  }
  const auto first = cast(world, placed, way);
  REQUIRE(first.has_value() == !all.empty());
  if (first) {
    CHECK(first->body == all[0].body);
    CHECK(first->contact.time == all[0].contact.time);
  }
  // Where it begins, it overlaps those that it meets at 0.
  std::vector<BodyId> at_start;
  for (const Hit& hit : all) {
    if (hit.contact.time == 0) at_start.push_back(hit.body);
  }
  const auto found = overlapping(world, placed, way.from);
  CHECK(std::is_permutation(found.begin(), found.end(), at_start.begin(), at_start.end()));
}

TEST_CASE("rays meet boxes and meshes of boxes where slabs say") {
  const std::uint64_t seed = GENERATE(range(1, 9));
  INFO("seed " << seed);
  Random random(seed);
  const Vector3d half(random.uniform(0.2, 1), random.uniform(0.2, 1), random.uniform(0.2, 1));
  std::vector<Vector3d> corners;
  for (int i = 0; i < 8; ++i) {
    corners.emplace_back(i & 1 ? half[0] : -half[0], i & 2 ? half[1] : -half[1], i & 4 ? half[2] : -half[2]);
  }
  const auto mesh = std::make_shared<const Mesh>(corners, std::vector<Mesh::Triangle>{{0, 2, 1},
                                                                                      {1, 2, 3},
                                                                                      {4, 5, 6},
                                                                                      {5, 7, 6},
                                                                                      {0, 1, 4},
                                                                                      {1, 5, 4},
                                                                                      {2, 6, 3},
                                                                                      {3, 6, 7},
                                                                                      {0, 4, 2},
                                                                                      {2, 4, 6},
                                                                                      {1, 3, 5},
                                                                                      {3, 7, 5}});
  const Shape shape = seed % 2 == 0 ? Shape{Box{half}} : Shape{MeshShape{mesh, 1}};
  World<1> world(WorldOptions{});
  const Vector3d at = random.vector(1);
  world.add_body(body(shape, at));
  int met = 0;
  for (int i = 0; i < 300; ++i) {
    const Ray ray{at + 3 * random.direction(), at + random.vector(2)};
    double enter = 0;
    double leave = 1;
    for (int d = 0; d < 3; ++d) {
      const double way = ray.to[d] - ray.from[d];
      const double a = (at[d] - half[d] - ray.from[d]) / way;
      const double b = (at[d] + half[d] - ray.from[d]) / way;
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    if (std::abs(leave - enter) < 1e-6 || std::abs(enter - 1) < 1e-6) continue;
    const auto hit = cast(world, ray);
    REQUIRE(hit.has_value() == (enter < leave));
    if (!hit) continue;
    ++met;
    CHECK(std::abs(hit->contact.time - enter) < 1e-7);  // of meshes there is a margin
  }
  CHECK(met > 20);
}

TEST_CASE("the first hit along many pieces is the first of all hits, with every broad phase") {
  Random random(7);
  for (const NamedBroadPhase& way : broad_phases) {
    WorldOptions options;
    options.broad_phase = way.kind;
    if (way.kind == BroadPhaseKind::sap) options.rate = 3;
    World<1> world(options);
    for (int i = 0; i < 3000; ++i) {
      auto ball = body(Sphere{random.uniform(0.02, 0.2)}, random.vector(5), random.vector(1));
      if (i % 10 == 0) ball.collides_with = 0;  // found all the same
      world.add_body(ball);
    }
    world.advance_to(0.5);
    int met = 0;
    for (int i = 0; i < 100; ++i) {
      const Ray ray{random.vector(6), random.vector(6)};
      const auto all = cast_all(world, ray);
      const auto first = cast(world, ray);
      REQUIRE(first.has_value() == !all.empty());
      if (!first) continue;
      ++met;
      CHECK(first->body == all[0].body);
      CHECK(first->contact.time == all[0].contact.time);
    }
    CHECK(met > 50);
  }
}

TEST_CASE("a ray meets a mesh that bends where it is now") {
  std::vector<MeshScript::Keyframe> keyframes{{0, {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}},
                                              {2, {{-1, -1, 4}, {1, -1, 4}, {0, 1, 4}}}};
  World<1> world(WorldOptions{});
  world.add_body(body(
      BendingMesh{std::make_shared<const MeshScript>(keyframes, std::vector<Mesh::Triangle>{{0, 1, 2}})}, {0, 0, 1}));
  world.advance_to(1);
  const auto hit = cast(world, Ray{{0, 0, 8}, {0, 0, 0}});
  REQUIRE(hit);
  CHECK(std::abs(hit->contact.time - 5.0 / 8) < 1e-6);
}

TEST_CASE("casts refuse what is not finite") {
  World<1> world(WorldOptions{});
  world.add_body(body(Sphere{1}, {0, 0, 0}));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(cast(world, Ray{{0, 0, nan}, {0, 0, 0}}), std::invalid_argument);
  CHECK_THROWS_AS(cast_all(world, Ray{{0, 0, 0}, {0, 1e300, 0}}), std::invalid_argument);
  CHECK_THROWS_AS(overlapping(world, place(Sphere{1}, Eigen::Quaterniond::Identity()), {nan, 0, 0}),
                  std::invalid_argument);
}

}  // namespace kds::collision::test_casts
