// Half-spaces in worlds: floors and walls that the shapes of bodies meet, the same with every broad phase.
#include "collision/narrow_phase/nearest_of_shape.hpp"
#include "collision/periodic/periodic_world.hpp"
#include "collision/queries/casts.hpp"
#include "collision/queries/future.hpp"
#include "collision/queries/nearest.hpp"
#include "collision/shapes/bending_mesh.hpp"
#include "collision/shapes/convex_hull.hpp"
#include "collision/shapes/mesh_script.hpp"
#include "kds/framework/snapshot.hpp"
#include "tests/collision/world/resting_scenes.hpp"
#include "tests/support/throws.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace kds::collision::test_half_space {
namespace {

using namespace tests;
using kds::tests::throws;

BodyDescription<2> half_space(const Vector3d& normal, double offset = 0, const Vector3d& at = zero) {
  return fixed_body<2>(HalfSpace{normal, offset}, motion<2>(at));
}
BodyDescription<2> ground() { return half_space(Vector3d::UnitZ()); }

std::vector<Shape> shapes() {
  return {Sphere{0.5}, Box{{0.5, 0.25, 0.75}}, Capsule{0.25, 0.5}, MeshShape{cube(), 0.5},
          convex_hull({{-0.5, -0.5, -0.5}, {0.5, -0.5, -0.5}, {0, 0.5, -0.5}, {0, 0, 0.5}})};
}

/// One of each shape above the ground.
void drop(World<2>& world, const BodyDescription<2>& floor, double restitution, const Vector3d& velocity = zero) {
  world.add_body(floor);
  double x = 0;
  for (const Shape& shape : shapes()) {
    world.add_body(bouncy(body<2>(shape, motion<2>({x, 0, 1 + x}, velocity, weight)), restitution));
    x += 3;
  }
}

bool alike(const std::vector<Event>& x, const std::vector<Event>& y) {
  return std::equal(x.begin(), x.end(), y.begin(), y.end(), [](const Event& a, const Event& b) {
    return a.kind == b.kind && a.a == b.a && a.b == b.b && a.time() == b.time() &&
           a.contact.normal == b.contact.normal && (a.contact.point - b.contact.point).norm() < 1e-9;
  });
}

/// A room of six walls, and bodies that fly about in it.
void fill_room(World<2>& world, std::uint64_t seed) {
  for (int d = 0; d < 3; ++d) {
    world.add_body(half_space(Vector3d::Unit(d), -4));
    world.add_body(half_space(-Vector3d::Unit(d), -4));
  }
  Random random(seed);
  const auto any = [&](double size) {
    const double x = random.between(-size, size), y = random.between(-size, size);
    return Vector3d(x, y, random.between(-size, size));
  };
  for (int i = 0; i < 15; ++i) {
    auto b = body<2>(shapes()[static_cast<std::size_t>(i) % 5], motion<2>(any(3), any(3)));
    const double turn = random.between(-1, 1);
    if (i % 5 != 0) b.orientation = unit_quaternion(1, turn, 0.5, -turn);
    world.add_body(b);
  }
}

}  // namespace

TEST_CASE("half-space: bodies that fall on it bounce and lie as on a box that is large enough", "[world][half_space]") {
  for (const double restitution : {1.0, 0.0}) {
    EventLog<2> on_box;
    World<2> boxes(elastic(), &on_box);
    drop(boxes, floor_box(500), restitution);
    boxes.advance_to(5);
    REQUIRE(on_box.count(Kind::contact) >= 5);
    const auto scene = [&](World<2>& world) {
      drop(world, ground(), restitution);
      world.advance_to(5);
    };
    with_all_methods(elastic(), scene, [&](World<2>& world, EventLog<2>& log) {
      if (restitution == 1) {  // A mesh meets a box early, by its margin, and a plane exactly.
        std::erase_if(log.events, [](const Event& e) { return e.b == 4; });
        auto others = on_box.events;
        std::erase_if(others, [](const Event& e) { return e.b == 4; });
        CHECK(alike(log.events, others));
      } else {
        for (BodyId id = 1; id <= 5; ++id) CHECK(at_rest(world, id));
        CHECK(world.resting(0, 4));
      }
    });
  }
}

TEST_CASE("half-space: a mesh meets it at the very double", "[world][half_space]") {
  EventLog<2> log;
  World<2> world(elastic(), &log);
  world.add_body(ground());
  world.add_body(body<2>(MeshShape{cube(), 1}, motion<2>({0, 0, 2.25}, zero, weight)));
  const PlacedShape placed = world.shape(1);
  world.advance_to(0.9);
  REQUIRE(log.events.size() == 1);
  const double lowest = placed.low[2];
  CHECK(log.events[0].time() == Approx(std::sqrt((2.25 + lowest) / 5)));
  CHECK(log.events[0].contact.normal == Vector3d::UnitZ());
}

TEST_CASE("half-space: bodies slide on it for ever, down a slope too", "[world][half_space]") {
  for (const Vector3d& normal : {Vector3d(0, 0, 1), Vector3d(0.6, 0, 0.8)}) {
    const auto scene = [&](World<2>& world) {
      world.add_body(half_space(normal));
      double y = 0;
      for (const Shape& shape : shapes()) {
        world.add_body(bouncy(body<2>(shape, motion<2>(2 * normal + Vector3d(0, y += 3, 0), {0.25, 0, 0}, weight)), 0));
      }
      world.advance_to(20);
    };
    with_all_methods(elastic(), scene, [&](World<2>& world, EventLog<2>&) {
      for (BodyId id = 1; id <= 5; ++id) {
        CHECK(world.resting(0, id));
        const auto path = world.motion(id);
        CHECK(std::abs(normal.dot(path.velocity(20))) < 1e-9);
        CHECK(path.velocity(20).norm() > 0.2);
        const Vector3d down = weight - normal * normal.dot(weight);
        CHECK((path.coefficients[2] - down).norm() < 1e-12);
      }
    });
  }
}

TEST_CASE("half-space: six make a room that nothing leaves, whatever the broad phase", "[world][half_space]") {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    INFO("seed " << seed);
    WorldOptions options = elastic();
    options.report_pairs = false;
    const auto scene = [&](World<2>& world) {
      fill_room(world, seed);
      for (double t = 0.5; t <= 4; t += 0.5) {
        world.advance_to(t);
        world.audit();
      }
    };
    with_all_methods(options, scene, [&](World<2>& world, EventLog<2>& log) {
      CHECK(log.count(Kind::contact) > 15);
      for (BodyId id = 6; id < 21; ++id) {
        CHECK(world.motion(id).position(world.now()).cwiseAbs().maxCoeff() < 4);
      }
    });
  }
}

TEST_CASE("half-space: what passes through it is reported, and ends with it", "[world][half_space]") {
  WorldOptions options;
  options.rate = 16;
  const auto scene = [](World<2>& world) {
    world.add_body(ground());
    world.add_body(ball<2>(1, {0, 0, 3}, {0, 0, -1}));
    world.add_body(body<2>(Box{{1, 1, 1}}, motion<2>({9, 0, -3}, {0, 0, 1})));
    world.add_body(ball<2>(1, {20, 0, 0}));
    world.advance_to(5);
    world.remove_body(0);
    world.advance_to(6);
  };
  with_all_methods(options, scene, [](World<2>&, EventLog<2>& log) {
    const auto is = [](const Event& e, Kind kind, BodyId b, double t) {
      CHECK((e.kind == kind && e.a == 0 && e.b == b && e.time() == t));
    };
    REQUIRE(log.events.size() == 6);
    is(log.events[0], Kind::overlap, 2, 0);
    is(log.events[1], Kind::overlap, 3, 0);
    is(log.events[2], Kind::contact, 1, 2);
    is(log.events[3], Kind::separation, 2, 4);
    is(log.events[4], Kind::separation, 1, 5);
    is(log.events[5], Kind::separation, 3, 5);
  });
}

TEST_CASE("half-space: filters, jumps and motions of it count at once", "[world][half_space]") {
  const auto scene = [](World<2>& world) {
    const BodyId floor = world.add_body(ground());
    const BodyId low = world.add_body(ball<2>(1, {0, 0, 5}, {0, 0, -1}));
    const BodyId high = world.add_body(ball<2>(1, {9, 0, 9}, {0, 0, -1}));
    world.advance_to(1);
    world.set_filter(floor, 1, 0);
    world.advance_to(5);  // `low` is in it
    world.set_filter(floor, 1, ~0u);
    world.advance_to(7);
    world.ignore_pair(floor, high, true);
    world.advance_to(9);
    world.ignore_pair(floor, high, false);
    world.update_motion(low, motion<2>({0, 0, 2}, {0, 0, -1}, zero, 9));  // a jump out of it
    world.update_motion(floor, motion<2>({0, 0, -9}, {0, 0, 1}, zero, 9));
    world.advance_to(30);
  };
  with_all_methods(elastic(), scene, [](World<2>&, EventLog<2>& log) {
    REQUIRE(log.events.size() >= 3);
    CHECK(log.events[0].kind == Kind::overlap);
    CHECK((log.events[0].b == 1 && log.events[0].time() == 5));
    CHECK(log.events[1].kind == Kind::contact);
    CHECK((log.events[1].b == 2 && log.events[1].time() == 13));  // z = -4: the floor as it rises
    CHECK(log.events[2].kind == Kind::contact);
    CHECK((log.events[2].b == 1 && log.events[2].time() == 14));
  });
}

TEST_CASE("half-space: a sensor reports who passes, and a pair begins when both are there", "[world][half_space]") {
  WorldOptions options = elastic();
  options.report_pairs = true;
  const auto scene = [](World<2>& world) {
    auto gate = half_space(Vector3d::UnitX());
    gate.sensor = true;
    world.add_body(gate);
    world.add_body(half_space(-Vector3d::UnitX(), -5));  // no pair with the first
    auto late = ball<2>(1, {4, 0, 0}, {-1, 0, 0});
    late.motion[0].start = 2;
    world.add_body(late);
    world.advance_to(12);
    world.remove_body(0);
    world.advance_to(13);
  };
  with_all_methods(options, scene, [](World<2>&, EventLog<2>& log) {
    std::vector<std::string> told;
    for (const Event& e : log.events) {
      told.push_back(std::string(name(e.kind)) + " " + std::to_string(e.a) + " " + std::to_string(e.b) + " " +
                     std::to_string(static_cast<int>(e.time())));
    }
    CHECK(told == std::vector<std::string>{"pair_began 0 2 2", "pair_began 1 2 2", "contact 0 2 5", "pair_ended 0 2 12",
                                           "separation 0 2 12"});
  });
}

TEST_CASE("half-space: a world with some is saved and goes on as it would have", "[world][half_space]") {
  for (const auto method : all_methods) {
    EventLog<2> log;
    World<2> world(elastic(method), &log);
    fill_room(world, 9);
    world.advance_to(1);
    const Snapshot saved = save(world);
    const std::size_t before = log.events.size();
    world.advance_to(4);
    EventLog<2> again;
    World<2> other(elastic(BroadPhaseKind::grid), &again);
    restore(saved, other);
    other.audit();
    other.advance_to(4);
    const std::vector<Event> rest(log.events.begin() + static_cast<std::ptrdiff_t>(before), log.events.end());
    CHECK(rest.size() > 5);
    CHECK((again.events == rest));
  }
}

TEST_CASE("half-space: queries see it", "[world][half_space]") {
  World<2> world(elastic());
  const BodyId floor = world.add_body(half_space(Vector3d::UnitZ(), 1, {0, 0, 1}));  // z = 2
  const BodyId ball_id = world.add_body(ball<2>(1, {0, 0, 6}, {0, 0, -1}));
  world.advance_to(1);
  const auto hit = cast(world, Ray{{50, 0, 10}, {50, 0, 0}});
  REQUIRE(hit);
  CHECK(hit->body == floor);
  CHECK(hit->contact.time == 0.8);
  CHECK(hit->contact.normal == -Vector3d::UnitZ());
  const auto all = cast_all(world, placed_ball(1), {{0, 0, 20}, {0, 0, 0}});
  REQUIRE(all.size() == 2);
  CHECK((all[0].body == ball_id && all[1].body == floor && std::abs(all[1].contact.time - 0.85) < 1e-15));
  CHECK(overlapping(world, placed_ball(1), {500, 0, 2.5}) == std::vector<BodyId>{floor});
  CHECK(overlapping(world, placed_ball(1), {500, 0, 3.5}).empty());
  const auto near = nearest(world, {3, 0, 4}, 1);
  REQUIRE(near.size() == 1);
  CHECK((near[0].body == floor && near[0].distance == 2 && near[0].point == Vector3d(3, 0, 2)));
  const auto next = next_contact_of(world, floor, 9);
  REQUIRE(next);
  CHECK((next->body == ball_id && next->contact.time == 3));
  CHECK(next_contact_of(world, ball_id, 9)->contact.time == 3);
  CHECK(next_contact_between(world, floor, ball_id, 9)->time == 3);
  const auto bullet = next_contact(world, placed_ball(1), motion<2>({70, 0, 4}, {0, 0, -1}, zero, 1), 9);
  REQUIRE(bullet);
  CHECK((bullet->body == floor && bullet->contact.time == 2));
  std::vector<BodyId> met;
  const auto note = [&](BodyId id) { met.push_back(id); };
  world.visit_overlapping({90, 90, 1}, {91, 91, 2}, note);
  CHECK(met == std::vector<BodyId>{floor});
  world.visit_overlapping({90, 90, 2.125}, {91, 91, 3}, note);
  CHECK(met.size() == 1);
  throws(
      [&] {
        cast(world, place(HalfSpace{Vector3d::UnitX()}, Eigen::Quaterniond::Identity()), {zero, zero});
      },
      "a half-space cannot be cast");
}

TEST_CASE("half-space: what cannot be is refused, and changes nothing", "[world][half_space]") {
  World<2> world(elastic());
  auto loose = ground();
  loose.fixed = false;
  throws([&] { world.add_body(loose); }, "fixed: a half-space has no mass: it has to be fixed");
  auto boxed = ground();
  boxed.box = [](double, const auto&) { return KineticBox<2>{}; };
  throws([&] { world.add_body(boxed); }, "box: a half-space has no bounding box");
  auto round = ground();
  round.volume = BoundingVolume::sphere;
  throws([&] { world.add_body(round); }, "volume: a half-space has no bounding sphere");
  throws([&] { world.add_body(half_space({1, 1, 1})); }, "normal: must be of unit length");
  CHECK(world.size() == 0);
}

}  // namespace kds::collision::test_half_space
