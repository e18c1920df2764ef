// Queries of worlds whose bodies turn.
#include "collision/queries/casts.hpp"
#include "collision/queries/future.hpp"
#include "collision/queries/nearest.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>
#include <optional>

namespace kds::collision::test_turning_queries {
namespace {

using Eigen::Vector3d;
using kds::tests::Random;
using Motion = certificates::RigidMotion<1>;

Motion motion(const Vector3d& at, const Vector3d& velocity, const Vector3d& turns) {
  Motion motion{{{at, velocity}}};
  motion.angular_velocity = turns;
  return motion;
}

BasicBodyDescription<Motion> body(const Shape& shape, const Motion& motion) {
  BasicBodyDescription<Motion> description;
  description.shape = shape;
  description.motion = {motion};
  return description;
}

struct FirstMeeting final : BasicWorldListener<Motion> {
  void contact(TurningWorld<1>&, const PairEvent& event) override { note(event); }
  void overlap(TurningWorld<1>&, const PairEvent& event) override { note(event); }
  void note(const PairEvent& event) {
    if (!met && (event.a == of || event.b == of)) met = event;
  }
  BodyId of = ~BodyId{0};
  std::optional<PairEvent> met;
};

}  // namespace

TEST_CASE("a ray meets a rod where it has turned to") {
  TurningWorld<1> world(WorldOptions{});
  const BodyId rod = world.add_body(body(Box{Vector3d(2, 0.25, 0.25)}, motion({0, 0, 0}, {0, 0, 0}, {0, 0, 1})));
  CHECK(!cast(world, Ray{{1, -4, 0}, {1, 4, 0}}, [&](BodyId id) { return id != rod; }));
  CHECK(std::abs(cast(world, Ray{{0, 4, 0}, {0, -4, 0}})->contact.time - 3.75 / 8) < 1e-12);
  world.advance_to(std::numbers::pi / 2);  // now along y
  CHECK(std::abs(cast(world, Ray{{0, 4, 0}, {0, -4, 0}})->contact.time - 2.0 / 8) < 1e-12);
  CHECK(!cast(world, Ray{{1, 4, 0}, {1, -4, 0}}));
}

TEST_CASE("a shape that turns and is in no world meets what it would meet as a body, at the same double") {
  int met = 0;
  for (std::uint64_t seed = 1; seed <= 25; ++seed) {
    INFO("seed " << seed);
    Random random(seed);
    const auto vector = [&](double size) {
      return Vector3d(random.between(-size, size), random.between(-size, size), random.between(-size, size));
    };
    const auto shape = [&]() -> Shape {
      if (random.one_in(3)) return Sphere{random.between(0.2, 0.5)};
      return Box{Vector3d(random.between(0.2, 0.8), random.between(0.2, 0.8), random.between(0.2, 0.8))};
    };
    TurningWorld<1> world(WorldOptions{});
    FirstMeeting record;
    TurningWorld<1> other(WorldOptions{}, &record);
    for (int i = 0; i < 6; ++i) {
      const Shape of_body = shape();
      const Motion moves = motion(vector(3), vector(1), vector(2));
      world.add_body(body(of_body, moves));
      other.add_body(body(of_body, moves));
    }
    world.advance_to(0.25);
    other.advance_to(0.25);
    const Shape added = shape();
    const Motion moves = motion(vector(3), vector(1), vector(2));
    const auto hit = next_contact(world, place(added, Eigen::Quaterniond::Identity()), moves, 2);
    record.of = other.add_body(body(added, moves));
    other.advance_to(2);
    REQUIRE(hit.has_value() == record.met.has_value());
    if (!hit) continue;
    ++met;
    CHECK(hit->body == (record.met->a == record.of ? record.met->b : record.met->a));
    CHECK(hit->contact.time == record.met->contact.time);
  }
  CHECK(met > 5);
}

TEST_CASE("what is nearest, where it has turned to") {
  TurningWorld<1> world(WorldOptions{});
  // Along x, then after a quarter of a turn along y: its end is at the height 4.
  const BodyId rod = world.add_body(body(Box{Vector3d(4, 0.5, 0.5)}, motion({0, 0, 0}, {0, 0, 0}, {0, 0, 1})));
  const BodyId ball = world.add_body(body(Sphere{1}, motion({6, 6, 0}, {0, 0, 0}, {0, 3, 0})));
  CHECK(nearest(world, Vector3d(0, 6, 0), 1).front().body == ball);
  world.advance_to(std::numbers::pi / 2);
  const auto near = nearest(world, Vector3d(0, 6, 0), 2);
  REQUIRE(near.size() == 2);
  CHECK(near[0].body == rod);
  CHECK(std::abs(near[0].distance - 2) < 1e-14);
  CHECK((near[0].point - Vector3d(0, 4, 0)).norm() < 1e-14);
  CHECK(near[1].body == ball);
  CHECK(std::abs(near[1].distance - 5) < 1e-14);
}

TEST_CASE("how far apart a body that turns is from another") {
  TurningWorld<1> world(WorldOptions{});
  const BodyId rod = world.add_body(body(Box{Vector3d(2, 0.5, 0.5)}, motion({0, 0, 0}, {0, 0, 0}, {0, 0, 1})));
  const BodyId ball = world.add_body(body(Sphere{1}, motion({0, 5, 0}, {0, 0, 0}, {0, 3, 0})));
  CHECK(std::abs(distance_between(world, rod, ball).distance - 3.5) < 1e-14);
  world.advance_to(std::numbers::pi / 2);
  const ShapeDistance found = distance_between(world, rod, ball);
  CHECK(std::abs(found.distance - 2) < 1e-14);
  CHECK((found.of_a - Vector3d(0, 2, 0)).cwiseAbs().maxCoeff() <= 0.5);
  CHECK((found.of_b - Vector3d(0, 4, 0)).norm() < 1e-7);
  world.remove_body(ball);
  CHECK_THROWS(distance_between(world, rod, ball));
}

}  // namespace kds::collision::test_turning_queries
