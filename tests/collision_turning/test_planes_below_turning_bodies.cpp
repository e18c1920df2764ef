// Half-spaces in worlds whose bodies turn: what falls on them bounces, comes to rest, and is asked for.
#include "collision/drawing/draw_world.hpp"
#include "collision/narrow_phase/nearest_of_shape.hpp"
#include "collision/queries/casts.hpp"
#include "collision/queries/future.hpp"
#include "collision/queries/nearest.hpp"
#include "collision/shapes/convex_hull.hpp"
#include "collision/world.hpp"
#include "kds/framework/snapshot.hpp"
#include "tests/collision/sample_meshes.hpp"
#include "tests/collision_turning/narrow_phase/turning_solids.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace test_planes_below_turning_bodies {
namespace {

using namespace kds;
using namespace kds::collision;
using certificates::RigidMotion;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using kds::tests::motion_of;
using kds::tests::Random;
using kds::tests::random_vector;
using Turning = TurningWorld<2>;
using Body = Turning::Description;

constexpr double gravity = 10;
const Vector3d zero = Vector3d::Zero();

struct Log : Turning::Listener {
  struct Event {
    const char* what;
    BodyId a, b;
    Contact contact;
    friend bool operator==(const Event& x, const Event& y) {
      return x.what == y.what && x.a == y.a && x.b == y.b && x.contact.time == y.contact.time &&
             x.contact.point == y.contact.point && x.contact.normal == y.contact.normal &&
             x.contact.feature_a == y.contact.feature_a && x.contact.feature_b == y.contact.feature_b;
    }
  };
  std::vector<Event> events;

  void note(const char* what, const PairEvent& event) { events.push_back({what, event.a, event.b, event.contact}); }
  void contact(Turning&, const PairEvent& event) override { note("contact", event); }
  void separation(Turning&, const PairEvent& event) override { note("separation", event); }
  void overlap(Turning&, const PairEvent& event) override { note("overlap", event); }
  void rests(Turning&, const PairEvent& event) override { note("rests", event); }
  void wakes(Turning&, const PairEvent& event) override { note("wakes", event); }
  void passes(Turning&, const PairEvent& event) override { note("passes", event); }

  std::size_t count(const std::string& what) const {
    return static_cast<std::size_t>(
        std::count_if(events.begin(), events.end(), [&](const Event& event) { return event.what == what; }));
  }
};

WorldOptions options(BroadPhaseKind kind = BroadPhaseKind::automatic) {
  WorldOptions result{.response = Response::elastic, .broad_phase = kind};
  if (kind == BroadPhaseKind::sap) result.rate = 60;
  return result;
}

constexpr BroadPhaseKind all_methods[] = {BroadPhaseKind::automatic, BroadPhaseKind::all_pairs, BroadPhaseKind::sap,
                                          BroadPhaseKind::kinetic_sap, BroadPhaseKind::grid};

Body fixed(const Shape& shape, const Vector3d& at = zero, const Quaterniond& orientation = Quaterniond::Identity()) {
  RigidMotion<2> motion = motion_of<2>(at, zero, zero);
  motion.orientation = orientation;
  return {.shape = shape, .motion = {motion}, .fixed = true};
}
Body half_space(const Vector3d& normal, double offset = 0, const Vector3d& at = zero,
                const Quaterniond& orientation = Quaterniond::Identity()) {
  return fixed(HalfSpace{normal, offset}, at, orientation);
}
Body ground() { return half_space(Vector3d::UnitZ()); }

/// One that falls.
Body thrown(const Shape& shape, const Vector3d& at, const Vector3d& velocity, const Vector3d& spin,
            const Quaterniond& orientation = Quaterniond::Identity()) {
  RigidMotion<2> motion = motion_of<2>(at, velocity, spin);
  motion.path.coefficients[2] = Vector3d(0, 0, -gravity / 2);
  motion.orientation = orientation;
  return {.shape = shape, .motion = {motion}};
}

Quaterniond tilted(double angle, const Vector3d& axis) {
  const Vector3d v = std::sin(angle / 2) * axis.normalized();
  return {std::cos(angle / 2), v[0], v[1], v[2]};
}

/// Of a unit of mass or less; the mesh as well turns as a solid.
std::vector<Shape> shapes() {
  return {Sphere{0.5}, Box{{0.5, 0.25, 0.75}}, Capsule{0.25, 0.5}, MeshShape{samples::cuboid(Vector3d(0.5, 0.5, 0.25))},
          convex_hull({{0.5, 0.5, 0}, {-0.5, 0.5, 0}, {-0.5, -0.5, 0}, {0.5, -0.5, 0}, {0, 0, 0.5}, {0, 0, -0.5}})};
}

bool still(const Turning& world, BodyId id) {
  const auto& motion = world.motion(id);
  return motion.angular_velocity.isZero(0) && motion.path.coefficients[1].isZero(0) &&
         motion.path.coefficients[2].isZero(0);
}

/// The lowest of a body along a direction, from the origin.
double lowest(const Turning& world, BodyId id, const Vector3d& normal = Vector3d::UnitZ()) {
  const auto& motion = world.motion(id);
  const double t = world.now();
  const Shape shape = world.shape(id).shape;
  const double centre = normal.dot(motion.origin(t).vector);
  if (const auto* const ball = std::get_if<Sphere>(&shape)) return centre - ball->radius;
  if (const auto* const capsule = std::get_if<Capsule>(&shape)) {
    return centre - capsule->radius -
           capsule->half_length * std::abs(normal.dot(motion.direction(Vector3d::UnitZ(), t).vector));
  }
  std::vector<Vector3d> points;
  if (const auto* const hull = std::get_if<ConvexHull>(&shape)) {
    points.assign(hull->polytope->points().begin(), hull->polytope->points().end());
  } else if (const auto* const mesh = std::get_if<MeshShape>(&shape)) {
    points.assign(mesh->mesh->vertices().begin(), mesh->mesh->vertices().end());
  } else {
    const Vector3d& half = std::get<Box>(shape).half_extents;
    const auto corners = samples::cuboid(half);
    points.assign(corners->vertices().begin(), corners->vertices().end());
  }
  double least = never;
  for (const Vector3d& x : points) least = std::min(least, normal.dot(motion.position(x, t).vector));
  return least;
}

/// A room of six planes, turned as a whole, and bodies that spin in it.
void fill_room(Turning& world, std::uint64_t seed) {
  const Quaterniond turn(1, 0.25, -0.5, 0.125);
  for (int d = 0; d < 3; ++d) {
    for (const double side : {-1.0, 1.0}) world.add_body(half_space(side * Vector3d::Unit(d), -3, zero, turn));
  }
  Random random(seed);
  for (std::size_t i = 0; i < 10; ++i) {
    const Vector3d at = random_vector(random, 1.5), velocity = random_vector(random, 3);
    Body body = thrown(shapes()[i % 5], at, velocity, random_vector(random, 6), Quaterniond(1, velocity[0], at[1], 0.5));
    body.friction = i % 3 == 0 ? 0.25 : 0;
    body.restitution = 0.9;
    world.add_body(body);
  }
}

template <class F>
void throws(F&& f, const std::string& what) {
  INFO(what);
  try {
    f();
    FAIL("nothing was thrown");
  } catch (const std::exception& error) {
    INFO(error.what());
    CHECK(std::string(error.what()).find(what) != std::string::npos);
  }
}

}  // namespace

TEST_CASE("a half-space is a floor for what turns", "[turning][half_space]") {
  Log log;
  Turning world(options(), &log);
  const BodyId floor = world.add_body({.shape = HalfSpace{Vector3d::UnitZ(), 0},
                                       .motion = {motion_of<2>({0, 0, 0}, {0, 0, 0}, {0, 0, 0})},
                                       .fixed = true,
                                       .friction = 0.5});
  Body die = thrown(Box{Vector3d::Constant(0.5)}, {0, 0, 2}, {1, 0, 0}, {3, 2, 1});
  die.restitution = 0.25, die.friction = 0.5;
  const BodyId id = world.add_body(die);
  world.advance_to(5);
  CHECK(log.count("contact") > 3);
  CHECK(world.resting(floor, id));
  CHECK(std::abs(world.motion(id).path.position(5)[2] - 0.5) < 1e-4);
}

TEST_CASE("what spins bounces off a half-space as off a box that is large enough", "[turning][half_space]") {
  for (const double friction : {0.0, 0.5}) {
    const auto run = [&](const Body& floor, Log& log) {
      Turning world(options(), &log);
      Body below = floor;
      below.friction = friction;
      world.add_body(below);
      double x = 0;
      for (const Shape& shape : shapes()) {
        Body body = thrown(shape, {x, 0, 2}, {0.5, 0.25, 0}, {2, 1, -3}, Quaterniond(1, 0.5, 0.25, -0.125));
        body.friction = friction;
        world.add_body(body);
        x += 4;
      }
      world.advance_to(1.25);
    };
    Log on_plane, on_box;
    run(ground(), on_plane);
    run(fixed(Box{Vector3d(64, 64, 4)}, {0, 0, -4}), on_box);
    REQUIRE(on_plane.events.size() == on_box.events.size());
    CHECK(on_plane.count("contact") > 5);
    std::array<bool, 6> met{};
    for (std::size_t i = 0; i < on_plane.events.size(); ++i) {
      const auto &x = on_plane.events[i], &y = on_box.events[i];
      CAPTURE(friction, i, x.b, x.contact.time);
      CHECK((x.what == y.what && x.a == y.a && x.b == y.b));
      if (!std::exchange(met[x.b], true)) CHECK(x.contact.time == y.contact.time);
      CHECK(std::abs(x.contact.time - y.contact.time) < 1e-9);
      CHECK((x.contact.point - y.contact.point).norm() < 1e-9);
      CHECK(x.contact.normal == Vector3d::UnitZ());
      CHECK((y.contact.normal - x.contact.normal).norm() < 1e-9);
    }
  }
}

TEST_CASE("a body that bounces off half-spaces keeps its energy", "[turning][half_space]") {
  for (const Shape& shape : shapes()) {
    CAPTURE(kind_name(shape));
    Log log;
    WorldOptions exact = options();
    exact.shortest_flight = 1e-12;
    Turning world(exact, &log);
    world.add_body(ground());
    world.add_body(half_space(Vector3d(0.6, 0, 0.8), -1));
    world.add_body(half_space(Vector3d(-0.6, 0, 0.8), -1));
    world.add_body(half_space(Vector3d(0, 0.6, 0.8), -1));
    world.add_body(half_space(Vector3d(0, -0.6, 0.8), -1));
    const BodyId id = world.add_body(thrown(shape, {0.1, 0.2, 2}, {1, 0, 0}, {3, 2, 1}));
    const auto energy = [&] {
      const FreeTurning turning = world.free_turning(id);
      const auto& path = world.motion(id).path;
      return gravity * path.position(world.now())[2] + path.velocity(world.now()).squaredNorm() / 2 +
             turning.angular_momentum.dot(turning.angular_velocity) / 2;
    };
    const double before = energy();
    world.advance_to(30);
    CHECK(log.count("contact") > 25);
    CHECK(log.count("passes") == 0);
    CHECK(world.counters().orientation_resets == 0);
    CHECK(std::abs(energy() / before - 1) < 1e-12);
    CHECK(lowest(world, id) > -1e-12);
  }
}

TEST_CASE("six half-spaces make a room that nothing leaves that spins, whatever the broad phase, over snapshots too",
          "[turning][half_space]") {
  for (const std::uint64_t seed : {1, 2}) {
    CAPTURE(seed);
    std::vector<Log::Event> expected;
    for (const BroadPhaseKind kind : all_methods) {
      for (const bool saves : {false, true}) {
        if (saves && kind != BroadPhaseKind::grid) continue;
        CAPTURE(static_cast<int>(kind), saves);
        Log log;
        auto world = std::make_unique<Turning>(options(kind), &log);
        fill_room(*world, seed);
        for (double t = 0.25; t <= 1.5; t += 0.25) {
          world->advance_to(t);
          world->audit();
          if (!saves) continue;
          const Snapshot saved = save(*world);
          world = std::make_unique<Turning>(options(kind), &log);
          restore(saved, *world);
        }
        if (expected.empty()) expected = log.events;
        CHECK(log.count("contact") > 20);
        CHECK((log.events == expected));
        const Quaterniond turn = Quaterniond(1, 0.25, -0.5, 0.125).normalized();
        for (BodyId id = 6; id < 16; ++id) {
          for (int d = 0; d < 6; ++d) {
            CHECK(lowest(*world, id, turn * ((d % 2 == 0 ? 1 : -1) * Vector3d::Unit(d / 2))) > -3 - 1e-9);
          }
        }
      }
    }
  }
}

TEST_CASE("what is thrown on a half-space comes to rest on it, and wakes without it", "[turning][half_space][rest]") {
  Log log;
  auto world = std::make_unique<Turning>(options(), &log);
  Body floor = ground();
  floor.friction = 0.5;
  world->add_body(floor);
  double x = 0;
  for (const Shape& shape : {shapes()[1], shapes()[3], shapes()[4], Shape(Box{Vector3d::Constant(0.5)})}) {
    Body body = thrown(shape, {x, 0, 1}, {0.25, 0, 0}, {2, 1, 0.5}, Quaterniond(1, 0.5, 0.25, 0));
    body.restitution = 0.25, body.friction = 0.5;
    world->add_body(body);
    x += 3;
  }
  world->advance_to(6);
  const Snapshot saved = save(*world);
  world = std::make_unique<Turning>(options(BroadPhaseKind::grid), &log);
  restore(saved, *world);
  world->audit();
  const std::size_t contacts = log.count("contact");
  world->advance_to(60);
  CHECK(log.count("contact") == contacts);
  CHECK(log.count("passes") == 0);
  for (BodyId id = 1; id <= 4; ++id) {
    CAPTURE(id);
    CHECK(world->resting(0, id));
    CHECK(still(*world, id));
    CHECK(std::abs(lowest(*world, id)) < 1e-4);
  }
  world->remove_body(0);
  world->advance_to(61);
  CHECK(log.count("wakes") >= 4);
  for (BodyId id = 1; id <= 4; ++id) CHECK(lowest(*world, id) < -4);
}

TEST_CASE("a box rests on a slope of a half-space if its friction allows", "[turning][half_space][rest]") {
  for (const double degrees : {20, 28}) {  // friction 0.5: up to 26.6
    CAPTURE(degrees);
    const Quaterniond slope = tilted(degrees * 3.14159265358979323846 / 180, {0.25, 1, 0});
    const Vector3d up = slope * Vector3d::UnitZ();
    Log log;
    Turning world(options(), &log);
    Body below = half_space(Vector3d::UnitZ(), 1, zero, slope);
    below.friction = 0.5;
    world.add_body(below);
    Body box = thrown(Box{Vector3d(0.5, 0.5, 0.25)}, 1.26 * up, zero, zero, slope);
    box.restitution = 0.25, box.friction = 0.5;
    const BodyId id = world.add_body(box);
    world.advance_to(1);
    CHECK(world.resting(0, id) == (degrees < 26));
    CHECK(still(world, id) == (degrees < 26));
  }
}

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
    CHECK(std::abs(4 + rises_for + 2 * std::abs(std::sin(2 * rises_for)) +
                   0.25 * std::abs(std::cos(2 * rises_for)) - 9) < 1e-12);
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
  throws([&] { next_contact(world, plane, motion_of<2>(zero, zero, {1, 0, 0}, 1), 9); },
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

}  // namespace test_planes_below_turning_bodies
