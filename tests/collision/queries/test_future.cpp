// What will meet what: the same times as the world's own contacts.
#include "collision/queries/future.hpp"

#include "collision/queries/near_pairs.hpp"
#include "collision/queries/nearest.hpp"
#include "collision/shapes/mesh_script.hpp"
#include "tests/collision/sample_meshes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <vector>

namespace kds::collision::test_future {
namespace {

using Catch::Matchers::Contains;
using Eigen::Vector3d;
using samples::Random;

template <int Degree>
BodyDescription<Degree> body(const Shape& shape, const certificates::PointMotion<Degree>& motion) {
  BodyDescription<Degree> description;
  description.shape = shape;
  description.motion = {motion};
  return description;
}

template <int Degree>
certificates::PointMotion<Degree> random_motion(Random& random, double start) {
  certificates::PointMotion<Degree> motion{};
  motion.coefficients[0] = random.vector(2);
  for (std::size_t i = 1; i <= Degree; ++i) motion.coefficients[i] = random.vector(1);
  motion.start = start;
  return motion;
}

Shape random_shape(Random& random) {
  if (random.below(2) == 0) return Sphere{random.uniform(0.1, 0.5)};
  return Box{Vector3d(random.uniform(0.1, 0.5), random.uniform(0.1, 0.5), random.uniform(0.1, 0.5))};
}

/// The first contact of a body.
template <int Degree>
struct FirstMeeting final : WorldListener<Degree> {
  void contact(World<Degree>&, const PairEvent& event) override { note(event); }
  void overlap(World<Degree>&, const PairEvent& event) override { note(event); }
  void note(const PairEvent& event) {
    if (!met && (event.a == of || event.b == of)) met = event;
  }
  BodyId of = ~BodyId{0};
  std::optional<PairEvent> met;
};

template <int Degree>
void require_same_as_world(std::uint64_t seed, int& met) {
  Random random(seed);
  World<Degree> world(WorldOptions{});
  FirstMeeting<Degree> record;
  World<Degree> other(WorldOptions{}, &record);
  for (int i = 0; i < 12; ++i) {
    const auto description = body<Degree>(random_shape(random), random_motion<Degree>(random, 0));
    world.add_body(description);
    other.add_body(description);
  }
  world.advance_to(0.25);
  other.advance_to(0.25);
  const Shape shape = random_shape(random);
  const auto motion = random_motion<Degree>(random, random.uniform(0, 0.25));
  const auto hit = next_contact(world, place(shape, Eigen::Quaterniond::Identity()), motion, 3);
  const BodyId added = other.add_body(body<Degree>(shape, motion));
  record.of = added;
  // The same of what has become a body.
  const auto of_body = next_contact_of(other, added, 3, {}, ContactMode::transparent);
  other.advance_to(3);
  REQUIRE(hit.has_value() == record.met.has_value());
  REQUIRE(of_body.has_value() == hit.has_value());
  if (!hit) return;
  ++met;
  CHECK(hit->body == (record.met->a == added ? record.met->b : record.met->a));
  CHECK(hit->contact.time == record.met->contact.time);
  CHECK(of_body->body == hit->body);
  CHECK(of_body->contact.time == hit->contact.time);
}

}  // namespace

TEST_CASE("a shape that is in no world meets what it would meet as a body, at the same double") {
  int met = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    INFO("seed " << seed);
    require_same_as_world<1>(seed, met);
    require_same_as_world<2>(seed, met);
  }
  CHECK(met > 40);
}

TEST_CASE("two balls that have bounced off each other do not meet again, and will meet a third") {
  WorldOptions options;
  options.response = Response::elastic;
  World<1> world(options);
  const auto ball = [&](double x, double v) {
    return world.add_body(body<1>(Sphere{0.5}, {{Vector3d(x, 0, 0), Vector3d(v, 0, 0)}}));
  };
  const BodyId a = ball(0, 1);
  const BodyId b = ball(3, -1);
  const BodyId wall = ball(10, 0);
  CHECK(next_contact_between(world, a, b, 10)->time == 1);
  CHECK(next_contact_of(world, wall, 10)->body == a);  // as if b were not in the way of a: by the motions of now
  CHECK(next_contact_of(world, wall, 10, [&](BodyId id) { return id != a; }) == std::nullopt);
  world.advance_to(1);
  CHECK(!next_contact_between(world, a, b, 100));
  const auto next = next_contact_of(world, b, 100);
  REQUIRE(next);
  CHECK(next->body == wall);
  CHECK(next->contact.time == 8);  // from 2 at 1 by 7
}

TEST_CASE("what will happen is refused for times that are none and motions that have not begun") {
  World<1> world(WorldOptions{});
  const BodyId a = world.add_body(body<1>(Sphere{1}, {{Vector3d(0, 0, 0)}}));
  world.advance_to(5);
  const PlacedShape ball = place(Sphere{1}, Eigen::Quaterniond::Identity());
  certificates::PointMotion<1> motion{{Vector3d(0, 0, 9), Vector3d(0, 0, -1)}, 5};
  CHECK(next_contact(world, ball, motion, 20)->contact.time == 12);
  CHECK_THROWS_AS(next_contact(world, ball, motion, 4), std::invalid_argument);
  CHECK_THROWS_AS(next_contact(world, ball, motion, never), std::invalid_argument);
  CHECK_THROWS_AS(next_contact_between(world, a, a, 6), std::invalid_argument);
  CHECK_THROWS(next_contact_between(world, a, a + 1, 6));
  motion.start = 6;
  CHECK_THROWS_AS(next_contact(world, ball, motion, 20), std::invalid_argument);
  motion.start = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(next_contact(world, ball, motion, 20), std::invalid_argument);
}

TEST_CASE("the closest approach of two centres: of lines by the formula, of others not missed by samples") {
  double least = never;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    INFO("seed " << seed);
    Random random(seed);
    World<2> world(WorldOptions{});
    const bool lines = seed % 2 == 0;
    certificates::PointMotion<2> motion[2];
    for (auto& m : motion) {
      m = random_motion<2>(random, 0);
      if (lines) m.coefficients[2].setZero();
    }
    const BodyId a = world.add_body(body<2>(Sphere{0.1}, motion[0]));
    const BodyId b = world.add_body(body<2>(Box{Vector3d(0.1, 0.2, 0.3)}, motion[1]));
    world.advance_to(0.125);
    const auto nearest = closest_approach(world, a, b, 4);
    const auto distance = [&](double t) { return (motion[1].position(t) - motion[0].position(t)).norm(); };
    CHECK(nearest.time >= 0.125);
    CHECK(nearest.time <= 4);
    CHECK(nearest.distance == Approx(distance(nearest.time)).epsilon(1e-14));
    for (int i = 0; i <= 1000; ++i) CHECK(distance(0.125 + i * (4 - 0.125) / 1000) >= nearest.distance - 1e-12);
    if (lines) {
      const Vector3d d = motion[1].coefficients[0] - motion[0].coefficients[0];
      const Vector3d v = motion[1].coefficients[1] - motion[0].coefficients[1];
      CHECK(nearest.time == Approx(std::clamp(-d.dot(v) / v.squaredNorm(), 0.125, 4.0)).epsilon(1e-10));
    }
    least = std::min(least, nearest.distance);
  }
  CHECK(least < 0.5);
}

TEST_CASE("the closest approach of centres that keep their distance is at once") {
  World<1> world(WorldOptions{});
  const BodyId a = world.add_body(body<1>(Sphere{1}, {{Vector3d(0, 0, 0), Vector3d(1, 2, 3)}}));
  const BodyId b = world.add_body(body<1>(Sphere{1}, {{Vector3d(5, 0, 0), Vector3d(1, 2, 3)}}));
  const BodyId c = world.add_body(body<1>(Sphere{1}, {{Vector3d(5, 0, 0), Vector3d(0, 2, 3)}}));
  world.advance_to(1);
  CHECK(closest_approach(world, a, b, 9).time == 1);
  CHECK(closest_approach(world, a, b, 9).distance == 5);
  CHECK(closest_approach(world, a, c, 3).time == 3);
  CHECK(closest_approach(world, a, c, 9).time == 5);
  CHECK(closest_approach(world, a, c, 9).distance == 0);
  CHECK_THROWS_AS(closest_approach(world, a, b, 0.5), std::invalid_argument);
  CHECK_THROWS_AS(closest_approach(world.motion(a), world.motion(b), 2.0, 1.0), std::invalid_argument);
  CHECK_THROWS_AS(closest_approach(world.motion(a), world.motion(b), 2.0, never), std::invalid_argument);
}

TEST_CASE("bodies that enter later are not there, neither of a pair nor for others") {
  World<1> world(WorldOptions{});
  const BodyId a = world.add_body(body<1>(Sphere{1}, {{Vector3d(0, 0, 0)}}));
  const BodyId b = world.add_body(body<1>(Sphere{1}, {{Vector3d(3, 0, 0), Vector3d(1, 0, 0)}, 5}));
  world.advance_to(1);
  CHECK(!next_contact_between(world, a, b, 4));
  CHECK(!next_contact_of(world, b, 4));
  CHECK(!next_contact_of(world, a, 4));
  // Their paths reach back to before they enter: the two would be nearest, and overlap, at 2.
  CHECK_THROWS_WITH(closest_approach(world, a, b, 4), Contains("body 1 enters later, at 5"));
  CHECK_THROWS_WITH(closest_approach(world, b, a, 4), Contains("body 1 enters later, at 5"));
  CHECK_THROWS_WITH(distance_between(world, a, b), Contains("body 1 enters later, at 5"));
  CHECK(pairs_nearer_than(world, 9, 4).empty());
  world.advance_to(5);
  CHECK(closest_approach(world, a, b, 6).distance == 3);
  CHECK(distance_between(world, a, b).distance == 1);
}

TEST_CASE("a shape passes a mesh within the margin of its contacts: met as in a world") {
  struct Log final : WorldListener<1> {
    void contact(World<1>&, const PairEvent& event) override { time = std::min(time, event.contact.time); }
    double time = never;
  };
  for (const double start : {0.0, 1e9}) {
    for (const double gap : {1e-9, 5e-7}) {
      INFO("start " << start << ", gap " << gap);
      const MeshShape cube{samples::cuboid(), 1};
      const certificates::PointMotion<1> still{{Vector3d(0, 0, 0)}, start};
      const certificates::PointMotion<1> fly{{Vector3d(-8, 0.1, 2 + gap), Vector3d(1, 0, 0)}, start};
      Log log;
      WorldOptions options;
      options.start_time = start;
      World<1> world(options, &log), other(options);
      world.add_body(body<1>(cube, still));
      world.add_body(body<1>(Sphere{1}, fly));
      world.advance_to(start + 16);
      other.add_body(body<1>(cube, still));
      const auto hit = next_contact(other, place(Sphere{1}, Eigen::Quaterniond::Identity()), fly, start + 16);
      CHECK((hit ? hit->contact.time : never) == log.time);
    }
  }
}

TEST_CASE("queries take only what place() has made, and motions that a world takes") {
  World<1> world(WorldOptions{});
  world.add_body(body<1>(Sphere{1}, {{Vector3d(0, 0, 0)}}));
  const certificates::PointMotion<1> motion{{Vector3d(3, 0, 0), Vector3d(-1, 0, 0)}};
  for (const Shape& shape : {Shape{Sphere{1}}, Shape{MeshShape{}}, Shape{Sphere{-1}}}) {
    PlacedShape never_placed;
    never_placed.shape = shape;
    CHECK_THROWS_AS(next_contact(world, never_placed, motion, 5), std::invalid_argument);
  }
  const PlacedShape ball = place(Sphere{1}, Eigen::Quaterniond::Identity());
  CHECK_THROWS_AS(next_contact(world, ball, {{Vector3d(1e300, 0, 0)}}, 5), std::invalid_argument);
  CHECK(next_contact(world, ball, motion, 5)->contact.time == 1);
}

TEST_CASE("at a late clock, with coarse doubles, a ball that has gone through a sheet has no further meeting with it") {
  constexpr double start = 1e9;
  const std::vector<Vector3d> below{{-3, -3, 0}, {3, -3, 0}, {0, 4, 0}};
  std::vector<Vector3d> above = below;
  for (Vector3d& position : above) position[2] += 0.1;
  const auto script = std::make_shared<const MeshScript>(
      std::vector<MeshScript::Keyframe>{{start, below}, {start + 2, above}}, std::vector<Mesh::Triangle>{{0, 1, 2}});
  WorldOptions options;
  options.start_time = start;
  World<2> world(options);
  const BodyId sheet = world.add_body(body<2>(BendingMesh{script}, {{Vector3d(0, 0, 0)}, start}));
  const BodyId ball = world.add_body(
      body<2>(Sphere{0.3}, {{Vector3d(0.1, 0.2, 0.6), Vector3d(0.1, 0.3, -3), Vector3d(0, 0.1, 0)}, start}));
  CHECK(next_contact_between(world, sheet, ball, start + 20)->time - start == Approx(0.1).margin(0.02));
  world.advance_to(start + 0.8);
  CHECK(!next_contact_between(world, sheet, ball, start + 20));
}

}  // namespace kds::collision::test_future
