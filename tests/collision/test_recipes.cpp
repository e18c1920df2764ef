// The code of docs/recipes.md: what is quoted there stands here, and is held to what the page says of it.
#include "collision/drawing/draw_world.hpp"
#include "collision/queries/casts.hpp"
#include "collision/queries/future.hpp"
#include "collision/queries/near_pairs.hpp"
#include "collision/queries/nearest.hpp"
#include "collision/response/contact_law.hpp"
#include "collision/shapes/mesh.hpp"
#include "collision/world.hpp"
#include "kds/framework/history.hpp"
#include "kds/framework/snapshot.hpp"
#include "kds/simulator.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <memory>
#include <utility>
#include <vector>

namespace test_recipes {
namespace {

using namespace kds;
using namespace kds::collision;
using Eigen::Vector3d;
using Line = certificates::PointMotion<1>;
using Path = certificates::PointMotion<2>;

TEST_CASE("recipe: remove a body in a callback") {
  constexpr std::uint32_t bullets = 2, targets = 4;
  struct Game final : WorldListener<1> {
    void contact(World<1>& world, const PairEvent& event) override {
      for (const BodyId id : {event.a, event.b}) {
        if (world.category(id) == bullets) world.remove_body(id);
      }
    }
  } game;
  World<1> world({.response = Response::elastic}, &game);
  const BodyId target = world.add_body(
      {.shape = Sphere{1}, .motion = {Line::line({9, 0, 0}, {0, 0, 0})}, .mass = 5, .category = targets});
  const BodyId bullet = world.add_body({.shape = Sphere{0.125},
                                        .motion = {Line::line({0, 0, 0}, {300, 0, 0})},
                                        .category = bullets,
                                        .collides_with = targets});
  world.advance_to(1);
  CHECK_FALSE(world.contains(bullet));
  CHECK(world.motion(target).velocity(1)[0] == Approx(100));  // the bullet's impulse is in it already
}

TEST_CASE("recipe: add bodies in a callback") {
  struct Splitting final : WorldListener<1> {
    void wall(World<1>& world, const WallEvent& event) override {
      const double now = world.now();
      const Line old = world.motion(event.body);  // a copy: references end when bodies are added or removed
      world.remove_body(event.body);
      if (old.velocity(now).norm() > 3) return;
      for (const double side : {-2, 2}) {
        const Vector3d place = old.position(now) + Vector3d(0, 0.125 * side, 0);
        world.add_body({.shape = Sphere{0.125}, .motion = {Line::line(place, {-4, side, 0}, now)}});
      }
    }
  } splitting;
  World<1> world({.walls = Walls{{0, 0, 0}, {10, 10, 10}}}, &splitting);
  world.add_body({.shape = Sphere{0.5}, .motion = {Line::line({1.5, 5, 5}, {2, 0, 0})}});
  world.advance_to(4.5);
  CHECK(world.size() == 2);
  world.advance_to(10);
  CHECK(world.size() == 0);
}

TEST_CASE("recipe: filters, changed while the world runs") {
  constexpr std::uint32_t ghosts = 2, solids = 4;
  World<1> world({.response = Response::elastic});
  const BodyId wall = world.add_body(
      {.shape = Box{{0.5, 5, 5}}, .motion = {Line::line({0, 0, 0}, {0, 0, 0})}, .fixed = true, .category = solids});
  const BodyId player = world.add_body({.shape = Sphere{0.5},
                                        .motion = {Line::line({-4, 0, 0}, {1, 0, 0})},
                                        .category = ghosts,
                                        .collides_with = ghosts});
  world.advance_to(7);  // through the wall
  world.set_filter(player, solids, solids | ghosts);
  world.update_motion(player, Line::line({3, 0, 0}, {-1, 0, 0}, 7));  // back
  world.advance_to(12);
  CHECK(world.motion(player).velocity(12)[0] == 1);  // solid now
  CHECK(world.collides_with(wall) == ~0u);
}

TEST_CASE("recipe: a sensor") {
  struct Door final : WorldListener<1> {
    std::vector<std::pair<double, bool>> open;
    void contact(World<1>&, const PairEvent& event) override { open.emplace_back(event.contact.time, true); }
    void separation(World<1>&, const PairEvent& event) override { open.emplace_back(event.contact.time, false); }
  } door;
  World<1> world({.response = Response::elastic}, &door);
  world.add_body({.shape = Box{{1, 1, 1}}, .motion = {Line::line({5, 0, 0}, {0, 0, 0})}, .sensor = true});
  world.add_body({.shape = Sphere{0.5}, .motion = {Line::line({0, 0, 0}, {1, 0, 0})}});
  world.advance_to(10);
  CHECK(door.open == std::vector<std::pair<double, bool>>{{3.5, true}, {6.5, false}});
}

TEST_CASE("recipe: a proximity alarm that follows a body") {
  struct Alarm final : WorldListener<1> {
    BodyId halo{};
    std::vector<double> rung;
    void contact(World<1>&, const PairEvent& event) override {
      if (event.a == halo || event.b == halo) rung.push_back(event.contact.time);
    }
  } alarm;
  World<1> world({.response = Response::elastic, .walls = Walls{{-5, -5, -5}, {5, 5, 5}}}, &alarm);
  const BodyId guarded = world.add_body({.shape = Sphere{0.5}, .motion = {Line::line({0, 0, 0}, {1, 0, 0})}});
  alarm.halo = world.add_body({.shape = Sphere{2}, .sensor = true, .attached_to = guarded});
  world.add_body({.shape = Sphere{0.5}, .motion = {Line::line({-4, 0, 0}, {0, 0, 0})}});
  world.advance_to(11);
  CHECK(alarm.rung == std::vector<double>{10.5});  // on the way back from the wall at x = 5, 2 + 0.5 before the other
}

TEST_CASE("recipe: a kick, and a jump") {
  World<2> world({});
  const BodyId ball =
      world.add_body({.shape = Sphere{0.5}, .motion = {Path::parabola({0, 0, 9}, {1, 0, 0}, {0, 0, -2})}, .mass = 2});
  world.advance_to(3);
  Path motion = world.free_motion(ball).restarted(world.now());
  motion.coefficients[1] += Vector3d(0, 0, 12) / world.mass(ball);  // an impulse; coefficients[2] is half of gravity
  world.update_motion(ball, motion);
  world.advance_to(4);
  CHECK(world.motion(ball).position(4) == Vector3d(4, 0, -1));
  motion.coefficients[0] = {7, 7, 7};  // and a jump: it enters anew there
  motion.start = world.now();
  world.update_motion(ball, motion);
  CHECK(world.motion(ball).position(4) == Vector3d(7, 7, 7));
}

TEST_CASE("recipe: a frame loop with a budget") {
  World<1> world({.response = Response::elastic, .walls = Walls{{0, 0, 0}, {8, 8, 8}}});
  for (int i = 0; i < 20; ++i) {
    const Vector3d place(1 + i % 5, 1 + i / 5, 4);
    world.add_body({.shape = Sphere{0.25}, .motion = {Line::line(place, {1. + i % 3, 0.5 * (i % 4), 1})}});
  }
  std::vector<Vector3d> drawn(world.size());
  int late = 0;
  for (int frame = 1; frame <= 60; ++frame) {
    const bool in_time = world.advance_for(0.004, frame / 60.);  // 4 ms of work, at the most (and one event)
    if (!in_time) ++late;                                        // the clock stands at the last event
    const double t = world.now();
    for (BodyId id = 0; id < world.size(); ++id) drawn[body_slot(id)] = world.motion(id).position(t);
  }
  CHECK(world.now() <= 1);
  CHECK((late > 0 || world.now() == 1));
  world.advance_to(1);
  int events = 0;
  while (!world.advance_for(0, 2)) ++events;
  CHECK(events > 5);
  CHECK(world.now() == 2);
}

TEST_CASE("recipe: a mesh from vertices") {
  const auto pyramid = std::make_shared<const Mesh>(
      std::vector<Vector3d>{{1, 1, 0}, {-1, 1, 0}, {-1, -1, 0}, {1, -1, 0}, {0, 0, 2}},
      std::vector<Mesh::Triangle>{{0, 2, 1}, {0, 3, 2}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}});
  World<1> world({});
  world.add_body({.shape = MeshShape{pyramid, 0.5}, .motion = {Line::line({0, 0, 0}, {0, 0, 0})}});
  world.add_body({.shape = MeshShape{pyramid}, .motion = {Line::line({0, 0, 9}, {0, 0, -1})}});
  const auto meeting = next_contact_between(world, 0, 1, 20);
  REQUIRE(meeting);
  CHECK(meeting->time == Approx(8).epsilon(1e-12));
  CHECK_THROWS_AS(Mesh({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}), InvalidMesh);
}

TEST_CASE("recipe: a room whose walls meet the shapes of bodies") {
  World<2> world({.response = Response::elastic});
  std::vector<BodyId> walls;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {  // solid is what is 5 or more from the middle
      walls.push_back(world.add_body({.shape = HalfSpace{-side * Vector3d::Unit(axis), -5},
                                      .motion = {Path::line({0, 0, 0}, {0, 0, 0})},
                                      .fixed = true}));
    }
  }
  const BodyId box = world.add_body(
      {.shape = Box{{1, 1, 2}}, .motion = {Path::parabola({0, 0, 0}, {4, 0, 0}, {0, 0, -8})}, .restitution = 0.5});
  world.advance_to(30);
  CHECK(world.resting(walls[4], box));  // on the floor, and slides to and fro
  CHECK(world.motion(box).position(30)[2] == Approx(-3));
}

TEST_CASE("recipe: gravity, restitution, walls") {
  World<2> world({.walls = Walls{{-5, -5, 0}, {5, 5, 9}}});
  const Vector3d gravity(0, 0, -2);
  const BodyId ball = world.add_body(
      {.shape = Sphere{0.5}, .motion = {Path::parabola({0, 0, 1.5}, {0, 0, 0}, gravity)}, .restitution = 0.5});
  world.advance_to(1.5);  // down in 1 s, at 2; up again at 1
  CHECK(world.motion(ball).position(1.5)[2] == 0.75);
  world.advance_to(60);
  CHECK(world.resting_at_wall(ball, 4));  // -z
  CHECK(world.motion(ball).position(60)[2] == Approx(0.5));
}

TEST_CASE("recipe: rest") {
  struct Told final : WorldListener<2> {
    std::vector<double> rested;
    void rests(World<2>& world, const PairEvent&) override { rested.push_back(world.now()); }
  } told;
  World<2> world({.response = Response::elastic}, &told);
  const BodyId floor =
      world.add_body({.shape = Box{{5, 5, 1}}, .motion = {Path::line({0, 0, -1}, {0, 0, 0})}, .fixed = true});
  const BodyId crate = world.add_body({.shape = Box{{0.5, 0.5, 0.5}},
                                       .motion = {Path::parabola({0, 0, 1.5}, {0, 0, 0}, {0, 0, -2})},
                                       .restitution = 0});
  world.advance_to(60);
  CHECK(told.rested == std::vector<double>{1});
  CHECK(world.resting(floor, crate));
  std::vector<BodyId> on_floor;
  world.visit_partners(floor, [&](BodyId id) { on_floor.push_back(id); });
  CHECK(on_floor == std::vector{crate});
  CHECK(world.next_time() == never);  // what rests costs nothing
}

TEST_CASE("recipe: a platform that is driven") {
  World<2> world({.response = Response::elastic});
  const std::vector<Path> way{Path::line({0, 0, 0}, {0, 0, 0}, 0), Path::line({0, 0, 0}, {0, 0, 0.5}, 2),
                              Path::line({0, 0, 2}, {0, 0, 0}, 6)};
  world.add_body({.shape = Box{{2, 2, 0.5}}, .motion = way, .fixed = true});  // a kinematic body: fixed, with a script
  const BodyId crate = world.add_body(
      {.shape = Box{{0.5, 0.5, 0.5}}, .motion = {Path::parabola({0, 0, 2}, {0, 0, 0}, {0, 0, -2})}, .restitution = 0});
  world.advance_to(4);
  CHECK(world.motion(crate).position(4)[2] == Approx(2));  // on top, on the way up
  world.advance_to(20);
  CHECK(world.motion(crate).position(20)[2] == Approx(3));
  CHECK(world.resting(0, crate));
}

TEST_CASE("recipe: roll back") {
  World<1> world({.response = Response::elastic});
  const BodyId left = world.add_body({.shape = Sphere{1}, .motion = {Line::line({-4, 0, 0}, {1, 0, 0})}});
  world.add_body({.shape = Sphere{1}, .motion = {Line::line({4, 0, 0}, {-1, 0, 0})}});
  world.advance_to(1);
  const Snapshot then = save(world);
  world.advance_to(5);
  const Line before = world.motion(left);
  restore(then, world);  // a late message: it had turned at t = 1
  CHECK(world.now() == 1);
  world.update_motion(left, Line::line({-3, 0, 0}, {0, 1, 0}, 1));
  world.advance_to(5);
  CHECK_FALSE(world.motion(left) == before);
  restore(then, world);
  world.advance_to(5);
  CHECK(world.motion(left) == before);  // bit for bit
}

TEST_CASE("recipe: step back to any time") {
  World<1> world({.response = Response::elastic});
  const BodyId ball = world.add_body({.shape = Sphere{1}, .motion = {Line::line({-4, 0, 0}, {1, 0, 0})}});
  world.add_body({.shape = Sphere{1}, .motion = {Line::line({4, 0, 0}, {-1, 0, 0})}});
  Simulator<World<1>> simulator(0, world);
  History history(100, simulator);  // a snapshot every 100 events or calls
  history.advance_to(5);
  CHECK(world.motion(ball).velocity(5)[0] == -1);
  history.roll_back(2);
  CHECK(world.motion(ball).velocity(2)[0] == 1);
  history.advance_to(5);
  CHECK(world.motion(ball).velocity(5)[0] == -1);
}

TEST_CASE("recipe: ray and shape cast") {
  World<1> world({});
  const BodyId shooter = world.add_body({.shape = Sphere{0.5}, .motion = {Line::line({0, 0, 0}, {0, 0, 0})}});
  const BodyId crate = world.add_body({.shape = Box{{1, 1, 1}}, .motion = {Line::line({6, 0, 0}, {0, 0, 0})}});
  const auto others = [&](BodyId id) { return id != shooter; };
  const auto hit = cast(world, Ray{{0, 0, 0}, {10, 0, 0}}, others);
  REQUIRE(hit);
  CHECK(hit->body == crate);
  CHECK(hit->contact.time == 0.5);  // of the way
  const PlacedShape ball = place(Sphere{1}, Eigen::Quaterniond::Identity());
  CHECK(cast(world, ball, Ray{{0, 0, 0}, {10, 0, 0}}, others)->contact.time == 0.4);
  CHECK(overlapping(world, ball, {6, 1.5, 0}) == std::vector{crate});
}

TEST_CASE("recipe: will they meet, and how near do they come") {
  World<1> world({});
  const BodyId ship = world.add_body({.shape = Sphere{1}, .motion = {Line::line({0, 0, 0}, {1, 0, 0})}});
  const BodyId rock = world.add_body({.shape = Sphere{1}, .motion = {Line::line({8, 3, 0}, {-1, 0, 0})}});
  constexpr double until = 100;
  CHECK_FALSE(next_contact_between(world, ship, rock, until));  // proved
  const Approach approach = closest_approach(world, ship, rock, until);
  CHECK(approach.time == 4);
  CHECK(approach.distance == 3);  // between the centres
  const PlacedShape bullet = place(Sphere{0.25}, Eigen::Quaterniond::Identity());
  const auto hit = next_contact(world, bullet, Line::line({2, 3, 0}, {1, 0, 0}), until);  // not fired yet
  REQUIRE(hit);
  CHECK(hit->body == rock);
  CHECK(hit->contact.time == 2.375);
}

TEST_CASE("recipe: who enters a place, and who comes near whom") {
  World<1> world({});
  for (const double x : {4, 12, 8}) {
    world.add_body({.shape = Sphere{1}, .motion = {Line::line({x, 0, 0}, {-1, 0, 0})}});
  }
  const BodyId crossing = world.add_body({.shape = Sphere{1}, .motion = {Line::line({6, -6, 0}, {0, 1, 0})}});
  const PlacedShape gate = place(Box{{1, 1, 1}}, Eigen::Quaterniond::Identity());
  const auto entering = next_contacts(world, gate, Line::line({0, 0, 0}, {0, 0, 0}), 7);
  REQUIRE(entering.size() == 2);  // body 1 comes at 10
  CHECK(entering[0].contact.time == 2);
  CHECK(entering[1].contact.time == 6);
  const auto near = pairs_nearer_than(world, 3, 7);
  REQUIRE(near.size() == 2);
  CHECK(near[0].pair == BodyPair{2, crossing});
  CHECK(near[0].approach.time == 4);  // 2 * sqrt(2) from each other
  CHECK(near[1].pair == BodyPair{1, crossing});
  CHECK(near[1].approach.time == 6);  // and 0: they meet
  world.advance_to(5.5);
  CHECK(contact_pairs(world) == std::vector{BodyPair{1, crossing}});
}

TEST_CASE("recipe: what is near, and all bodies") {
  World<1> world({});
  for (const double x : {1, 4, 9, 16}) {
    world.add_body({.shape = Sphere{0.5}, .motion = {Line::line({x, 0, 0}, {0, 0, 0})}});
  }
  const auto two = nearest(world, Vector3d(10, 0, 0), 2);
  REQUIRE(two.size() == 2);
  CHECK(two[0].body == 2);
  CHECK(two[0].distance == 0.5);
  CHECK(two[1].point == Vector3d(4.5, 0, 0));
  std::vector<BodyId> all;
  world.visit_bodies([&](BodyId id) { all.push_back(id); });  // those that enter later too
  CHECK(all == std::vector<BodyId>{0, 1, 2, 3});
}

TEST_CASE("recipe: a stream of motions") {
  struct Feed final : WorldListener<1> {
    int pieces = 0;
    void piece(World<1>& world, BodyId id) override {
      const double next = world.now() + 1;
      const Vector3d there = world.motion(id).position(next);
      const Line after = Line::line(there, {1, pieces++ % 2 == 0 ? -1. : 1., 0}, next);
      world.append_motion(id, std::array{after});
    }
  } feed;
  World<1> world({.report_pieces = true}, &feed);
  const BodyId zigzag = world.add_body(
      {.shape = Sphere{0.5}, .motion = {Line::line({0, 0, 0}, {1, 1, 0}, 0), Line::line({1, 1, 0}, {1, -1, 0}, 1)}});
  world.advance_to(9.5);
  CHECK(feed.pieces == 9);  // at 1, 2, ... 9: those that start after the first
  CHECK(world.motion(zigzag).start == 9);
}

TEST_CASE("recipe: a timer") {
  struct Fuse final : WorldListener<1> {
    BodyId bomb{};
    void timer(World<1>& world, TimerId) override { world.remove_body(bomb); }
  } fuse;
  World<1> world({}, &fuse);
  fuse.bomb = world.add_body({.shape = Sphere{0.5}, .motion = {Line::line({0, 0, 0}, {1, 0, 0})}});
  const TimerId burning = world.set_timer(2.5);
  world.advance_to(2);
  CHECK(world.cancel_timer(burning));
  world.set_timer(world.now() + 3);
  world.advance_to(4);
  CHECK(world.contains(fuse.bomb));
  world.advance_to(5);
  CHECK_FALSE(world.contains(fuse.bomb));
}

TEST_CASE("recipe: data of one's own") {
  struct Character {
    int health;
  };
  struct Game final : WorldListener<1> {
    std::vector<Character> characters{{100}, {80}};
    void contact(World<1>&, const PairEvent& event) override {
      characters[event.user_data_a].health -= 10;
      characters[event.user_data_b].health -= 10;
    }
  } game;
  World<1> world({.response = Response::elastic}, &game);
  world.add_body({.shape = Sphere{1}, .motion = {Line::line({-3, 0, 0}, {1, 0, 0})}, .user_data = 1});
  world.add_body({.shape = Sphere{1}, .motion = {Line::line({3, 0, 0}, {-1, 0, 0})}, .user_data = 0});
  world.advance_to(3);
  CHECK(game.characters[0].health == 90);
  CHECK(game.characters[1].health == 70);
}

TEST_CASE("recipe: a response of one's own") {
  struct Sticky final : ContactLaw {
    void respond(const Meeting&, Velocities& a, Velocities& b) const override { a = b = {}; }
  } sticky;
  World<1> world({.response = Response::callback, .law = &sticky});
  world.add_body({.shape = Sphere{1}, .motion = {Line::line({-3, 0, 0}, {1, 0, 0})}});
  world.add_body({.shape = Sphere{1}, .motion = {Line::line({3, 0, 0}, {-1, 0, 0})}});
  world.advance_to(9);
  CHECK(world.motion(0).position(9) == Vector3d(-1, 0, 0));
  CHECK(world.motion(1).position(9) == Vector3d(1, 0, 0));
}

TEST_CASE("recipe: two structures, one clock") {
  struct Order {
    std::vector<char> events;
  } order;
  struct Straight final : WorldListener<1> {
    Order* order;
    void contact(World<1>&, const PairEvent&) override { order->events.push_back('s'); }
  } straight;
  struct Curved final : WorldListener<2> {
    Order* order;
    void wall(World<2>&, const WallEvent&) override { order->events.push_back('c'); }
  } curved;
  straight.order = curved.order = &order;
  World<1> bullets({}, &straight);
  World<2> grenades({.walls = Walls{{-9, -9, 0}, {9, 9, 9}}}, &curved);
  Simulator<World<1>, World<2>> simulator(0, bullets, grenades);
  bullets.add_body({.shape = Sphere{1}, .motion = {Line::line({0, 0, 0}, {0, 0, 0})}});
  bullets.add_body({.shape = Sphere{1}, .motion = {Line::line({5, 0, 0}, {-2, 0, 0})}});
  grenades.add_body({.shape = Sphere{1}, .motion = {Path::parabola({0, 0, 2}, {0, 0, 0}, {0, 0, -2})}});
  simulator.advance_to(3.5);
  CHECK(order.events == std::vector{'c', 's', 'c'});  // at 1, 1.5 and 3
}

TEST_CASE("recipe: a log, and the same run again") {
  struct Log final : WorldListener<1> {
    std::vector<std::pair<double, BodyId>> lines;
    void contact(World<1>&, const PairEvent& event) override { lines.emplace_back(event.contact.time, event.b); }
  };
  const auto run = [](BroadPhaseKind method) {
    Log log;
    World<1> world({.response = Response::elastic, .broad_phase = method, .walls = Walls{{0, 0, 0}, {8, 8, 8}}}, &log);
    for (int i = 0; i < 20; ++i) {
      const Vector3d place(1 + i % 5, 1 + i / 5, 4);
      world.add_body({.shape = Sphere{0.25}, .motion = {Line::line(place, {1. + i % 3, 0.5 * (i % 4), 1})}});
    }
    world.advance_to(3);
    return log.lines;
  };
  CHECK(run(BroadPhaseKind::grid) == run(BroadPhaseKind::kinetic_sap));  // bit for bit
  CHECK(run(BroadPhaseKind::grid).size() > 10);
}

TEST_CASE("recipe: a world as lines") {
  World<1> world({});
  world.add_body({.shape = Box{{1, 1, 1}}, .motion = {Line::line({0, 0, 0}, {2, 0, 0})}});
  world.advance_to(1);
  std::vector<std::pair<Vector3d, Vector3d>> lines;  // of your renderer
  draw(world, [&](const Vector3d& from, const Vector3d& to, Drawn what) {
    if (what != Drawn::sensor) lines.emplace_back(from, to);
  });
  CHECK(lines.size() == 12);  // the edges
  CHECK(lines[0].first == Vector3d(2 - 1, -1, -1));
}

}  // namespace
}  // namespace test_recipes
