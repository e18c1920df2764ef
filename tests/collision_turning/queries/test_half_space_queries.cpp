// Half-spaces in worlds whose bodies turn: how they move, what asks for them, and what is refused.
#include "collision/drawing/draw_world.hpp"
#include "collision/queries/casts.hpp"
#include "collision/queries/future.hpp"
#include "collision/queries/nearest.hpp"
#include "collision/world.hpp"
#include "kds/framework/snapshot.hpp"
#include "tests/collision_turning/half_space_scenes.hpp"
#include "tests/support/throws.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace test_half_space_queries {
namespace {

using namespace kds;
using namespace kds::collision;
using namespace kds::tests::planes;
using kds::tests::motion_of;
using kds::tests::throws;

}  // namespace

TEST_CASE("a half-space moves and jumps, with another orientation too, and what spins meets it",
          "[turning][half_space]") {
  for (const BroadPhaseKind kind : all_methods) {
    Log log;
    Turning world({.response = Response::none, .broad_phase = kind, .rate = 16}, &log);
    const BodyId plane = world.add_body(ground());
    RigidMotion<2> spins = motion_of<2>({0, 0, 4}, zero, {0, 2, 0});
    const BodyId rod = world.add_body({.shape = Box{Vector3d(2, 0.25, 0.25)}, .motion = {spins}});
    world.advance_to(1);
    CHECK(log.events.empty());
    RigidMotion<2> rises = motion_of<2>({0, 0, 0.5}, {0, 0, 1}, zero, 1);
    world.update_motion(plane, rises);
    world.advance_to(9);
    REQUIRE(log.count("contact") >= 1);
    // The rod reaches down by 2 |sin 2 t| + |cos 2 t| / 4.
    const double met = log.events[0].contact.time;
    CHECK(std::abs((4 - 2 * std::abs(std::sin(2 * met)) - 0.25 * std::abs(std::cos(2 * met))) - (met - 0.5)) < 1e-12);
    CHECK(log.count("separation") == log.count("contact") - 1);
    // Upside down, and above it.
    RigidMotion<2> turned = motion_of<2>({0, 0, 9}, zero, zero, 9);
    turned.orientation = Quaterniond(0, 1, 0, 0);
    world.update_motion(plane, turned);
    world.advance_to(10);
    CHECK(log.count("separation") == log.count("contact"));
    RigidMotion<2> flies = motion_of<2>({0, 0, 4}, {0, 0, 1}, {0, 2, 0}, 10);
    world.update_motion(rod, flies);
    const std::size_t before = log.events.size();
    world.advance_to(16);
    REQUIRE(log.events.size() > before);
    CHECK(log.events[before].contact.normal == -Vector3d::UnitZ());
    const double rises_for = log.events[before].contact.time - 10;
    CHECK(std::abs(4 + rises_for + 2 * std::abs(std::sin(2 * rises_for)) + 0.25 * std::abs(std::cos(2 * rises_for)) -
                   9) < 1e-12);
  }
}

TEST_CASE("queries see half-spaces among bodies that turn", "[turning][half_space]") {
  Turning world(options());
  const BodyId floor = world.add_body(half_space(Vector3d::UnitX(), 1, {0, 0, 1}, Quaterniond(1, 0, -1, 0)));  // z = 2
  const BodyId rod = world.add_body(
      {.shape = Box{Vector3d(2, 0.25, 0.25)}, .motion = {motion_of<2>({0, 0, 7}, {0, 0, -1}, {0, 0, 3})}});
  world.advance_to(1);
  const auto hit = cast(world, Ray{{50, 0, 10}, {50, 0, 0}});
  REQUIRE(hit);
  CHECK(hit->body == floor);
  CHECK(std::abs(hit->contact.time - 0.8) < 1e-14);
  CHECK((hit->contact.normal + Vector3d::UnitZ()).norm() < 1e-14);
  CHECK(overlapping(world, placed_ball(1), {500, 0, 2.5}) == std::vector<BodyId>{floor});
  CHECK(overlapping(world, placed_ball(1), {500, 0, 3.5}).empty());
  const auto near = nearest(world, {3, 0, 4}, 1);
  REQUIRE(near.size() == 1);
  CHECK((near[0].body == floor && std::abs(near[0].distance - 2) < 1e-14));
  CHECK((near[0].point - Vector3d(3, 0, 2)).norm() < 1e-14);
  const auto next = next_contact_of(world, floor, 9);
  REQUIRE(next);
  CHECK(next->body == rod);
  CHECK(std::abs(next->contact.time - 4.75) < 1e-14);
  CHECK(next_contact_of(world, rod, 9)->contact.time == next->contact.time);
  CHECK(next_contact_between(world, floor, rod, 9)->time == next->contact.time);
  const PlacedShape plate = place(Box{Vector3d(1, 1, 0.125)}, Quaterniond::Identity());
  const auto bullet = next_contact(world, plate, motion_of<2>({70, 0, 4}, {0, 0, -1}, {1, 0, 0}, 1), 9);
  REQUIRE(bullet);
  CHECK(bullet->body == floor);
  const PlacedShape plane = place(HalfSpace{Vector3d::UnitZ()}, Quaterniond::Identity());
  const auto lifted = next_contact(world, plane, motion_of<2>({0, 0, 3}, {0, 0, 1}, zero, 1), 9,
                                   [&](BodyId id) { return id != floor; });
  REQUIRE(lifted);
  CHECK((lifted->body == rod && std::abs(lifted->contact.time - (1 + 2.75 / 2)) < 1e-14));
  throws(
      [&] {
        next_contact(world, plane, motion_of<2>(zero, zero, {1, 0, 0}, 1), 9);
      },
      "next_contact: motion.angular_velocity: a half-space does not turn");
  std::vector<BodyId> met;
  const auto note = [&](BodyId id) { met.push_back(id); };
  world.visit_overlapping({90, 90, 1}, {91, 91, 2}, note);
  CHECK(met == std::vector<BodyId>{floor});
  world.visit_overlapping({90, 90, 2.125}, {91, 91, 3}, note);
  CHECK(met.size() == 1);
  // A patch of the plane is drawn where it is.
  int in_plane = 0;
  draw(world, [&](const Vector3d& from, const Vector3d& to, Drawn what) {
    if (what == Drawn::fixed) in_plane += std::abs(from[2] - 2) < 1e-12 && std::abs(to[2] - 2) < 1e-12;
  });
  CHECK(in_plane == 42);
}

TEST_CASE("a half-space that would turn is refused, and changes nothing", "[turning][half_space]") {
  Turning world(options());
  const std::string what = ".angular_velocity: a half-space does not turn";
  auto spinning = ground();
  spinning.motion[0].angular_velocity = {0, 0, 1};
  throws([&] { world.add_body(spinning); }, "motion[0]" + what);
  auto later = ground();
  later.motion.push_back(motion_of<2>(zero, zero, {0, 0, 1}, 5));
  throws([&] { world.add_body(later); }, "motion[1]" + what);
  auto loose = ground();
  loose.fixed = false;
  throws([&] { world.add_body(loose); }, "fixed: a half-space has no mass: it has to be fixed");
  CHECK(world.size() == 0);
  const BodyId floor = world.add_body(ground());
  throws([&] { world.update_motion(floor, spinning.motion[0]); }, "World::update_motion: motion" + what);
  const std::vector<RigidMotion<2>> script{later.motion[1]};
  throws([&] { world.append_motion(floor, script); }, "World::append_motion: motion" + what);
  const BodyId box = world.add_body(thrown(Box{Vector3d(1, 1, 1)}, {0, 0, 5}, zero, {1, 0, 0}));
  Body gate{.shape = HalfSpace{Vector3d::UnitX(), 0}, .fixed = true, .sensor = true, .attached_to = box};
  throws([&] { world.add_body(gate); }, "attached_to: a half-space does not turn, as body 1 may");
  CHECK(world.size() == 2);
  CHECK(world.motion(floor) == ground().motion[0]);
}

}  // namespace test_half_space_queries
