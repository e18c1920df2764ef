// What must not happen by chance happens here on purpose.
#include "tests/collision/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <tuple>
#include <utility>
#include <vector>

namespace kds::collision {
namespace {

using namespace tests;

WorldOptions with(Response response, BroadPhaseKind broad_phase = BroadPhaseKind::kinetic_sap) {
  WorldOptions options;
  options.response = response;
  options.broad_phase = broad_phase;
  options.rate = 16;
  options.report_pairs = true;
  return options;
}

constexpr std::array all_methods{BroadPhaseKind::automatic, BroadPhaseKind::grid, BroadPhaseKind::kinetic_sap,
                                 BroadPhaseKind::sap, BroadPhaseKind::all_pairs};

std::size_t count(const std::vector<Event>& events, Kind kind) {
  return static_cast<std::size_t>(
      std::count_if(events.begin(), events.end(), [kind](const Event& e) { return e.kind == kind; }));
}
std::size_t count_at(const std::vector<Event>& events, double t) {
  return static_cast<std::size_t>(
      std::count_if(events.begin(), events.end(), [t](const Event& e) { return e.time() == t; }));
}
std::vector<Event> contacts_of(const std::vector<Event>& events) {
  std::vector<Event> result;
  for (const Event& e : events) {
    if (e.kind == Kind::contact) result.push_back(e);
  }
  return result;
}

/// n^3 bodies of size one on the integers.
template <int Degree>
std::vector<BodyDescription<Degree>> lattice(int n, const Shape& shape, const Vector3d& corner,
                                             const Vector3d& velocity) {
  std::vector<BodyDescription<Degree>> result;
  for (int i = 0; i < n * n * n; ++i) {
    const Vector3d cell(i % n, i / n % n, i / (n * n));
    result.push_back(body<Degree>(shape, motion<Degree>(corner + cell, velocity)));
  }
  return result;
}

template <int Degree>
std::vector<Event> run_audited(const std::vector<BodyDescription<Degree>>& bodies, const WorldOptions& options,
                               double end) {
  return run(Scene<Degree>{bodies, end}, options, {.audit = true});
}

TEST_CASE("Many ends at one value: a lattice of touching boxes or balls moves as one", "[degenerate]") {
  for (const Shape& shape : {Shape(Box{{0.5, 0.5, 0.5}}), Shape(Sphere{0.5})}) {
    for (const auto method : all_methods) {
      for (const auto response : {Response::none, Response::elastic}) {
        CHECK(run_audited(lattice<1>(4, shape, {0, 0, 0}, {1, 2, -1}), with(response, method), 10).empty());
      }
    }
  }
}

TEST_CASE("Many ends at one time: two lattices meet face to face", "[degenerate]") {
  for (const Shape& shape : {Shape(Box{{0.5, 0.5, 0.5}}), Shape(Sphere{0.5})}) {
    for (const auto method : all_methods) {
      // Left one at rest with its right faces at 2.5, right one with its left faces at 4.5, closing at 2.
      auto bodies = lattice<1>(3, shape, {0, 0, 0}, {0, 0, 0});
      for (const auto& b : lattice<1>(3, shape, {5, 0, 0}, {-2, 0, 0})) bodies.push_back(b);
      const auto passing = run_audited(bodies, with(Response::none, method), 100);
      const std::vector<Event> contacts = contacts_of(passing);
      REQUIRE(contacts.size() == 9 * 9);  // each of 9 rows: 3 by 3
      // Three fronts of nine: 1, 1.5, 2 ... and nothing between neighbouring rows, which touch all along.
      CHECK(count_at(contacts, 1) == 9);
      CHECK(count_at(contacts, 1.5) == 18);
      CHECK(count_at(contacts, 2) == 27);
      CHECK(count(passing, Kind::separation) == 81);

      // Elastic: each row is a Newton's cradle of three and three.
      const auto bouncing = run_audited(bodies, with(Response::elastic, method), 100);
      const auto hits = count(bouncing, Kind::contact);
      CHECK(hits == 9 * 9);
      for (const Event& e : bouncing) CHECK(e.time() == 1);
    }
  }
}

TEST_CASE("A touch without crossing: a ball grazes another exactly", "[degenerate]") {
  for (const auto method : all_methods) {
    for (const auto response : {Response::none, Response::elastic}) {
      const auto events =
          run_audited<1>({ball<1>(1, {0, 0, 0}), ball<1>(1, {-4, 2, 0}, {1, 0, 0})}, with(response, method), 9);
      for (const Event& e : events) CHECK(is_pair_event(e));
    }
    // An ulp nearer and they meet.
    const auto events = run_audited<1>({ball<1>(1, {0, 0, 0}), ball<1>(1, {-4, next_down(2.0), 0}, {1, 0, 0})},
                                       with(Response::none, method), 9);
    CHECK(count(events, Kind::contact) == 1);
  }
}

TEST_CASE("A touch without crossing: a thrown body reaches another at its turning point", "[degenerate]") {
  const Shape unit_ball = Sphere{1};
  const Shape unit_box = Box{{1, 1, 1}};
  const std::vector<std::pair<Shape, Shape>> shapes{
      {unit_ball, unit_ball}, {unit_box, unit_box}, {unit_box, unit_ball}, {unit_ball, unit_box}};
  for (const auto method : all_methods) {
    for (const auto& [first, second] : shapes) {
      for (const double height : {6.0, next_down(6.0)}) {
        // Rises 4 in two seconds and falls back.
        const auto thrown = body<2>(first, motion<2>({0, 0, 0}, {0, 0, 4}, {0, 0, -1}));
        const auto target = body<2>(second, motion<2>({0, 0, height}));
        const auto events = run_audited<2>({target, thrown}, with(Response::none, method), 9);
        const auto met = count(events, Kind::contact);
        CHECK(met == (height < 6 ? 1 : 0));
      }
    }
  }
}

TEST_CASE("Equal motions: bodies that touch for ever, or overlap for ever", "[degenerate]") {
  for (const auto method : all_methods) {
    for (const double distance : {2.0, 1.0, 0.0}) {
      std::vector<BodyDescription<2>> bodies;
      for (int i = 0; i < 4; ++i) bodies.push_back(box<2>({1, 1, 1}, {i * distance, 0, 0}, {1, 2, 3}, {-1, 0, 1}));
      const auto events = run_audited(bodies, with(Response::none, method), 10);
      const auto overlaps = count(events, Kind::overlap);
      CHECK(overlaps == (distance == 2 ? 0 : distance == 1 ? 3 : 6));
      for (const Event& e : events) CHECK(e.time() == 0);
    }
  }
}

TEST_CASE("A swap at time zero", "[degenerate]") {
  for (const auto method : all_methods) {
    // They touch at the start and close in, or part.
    for (const double speed : {-1.0, 1.0}) {
      const auto events = run_audited<1>({box<1>({1, 1, 1}, {0, 0, 0}), box<1>({1, 1, 1}, {2, 0, 0}, {speed, 0, 0})},
                                         with(Response::none, method), 1);
      REQUIRE(count(events, Kind::overlap) == (speed < 0 ? 1 : 0));
      CHECK(count(events, Kind::contact) == 0);
      CHECK(count_at(events, 0) == events.size());
    }
  }
}

TEST_CASE("Bodies at rest cost no event", "[degenerate]") {
  EventLog<2> log;
  World<2> world(with(Response::none), &log);
  Random random(1);
  for (int i = 0; i < 50; ++i) {
    world.add_body(ball<2>(0.5, {random.between(0, 20), random.between(0, 20), random.between(0, 20)}));
  }
  world.advance_to(0);
  const auto tests = world.counters().pair_tests;
  world.advance_to(1000);
  CHECK(world.counters().pair_tests == tests);
  CHECK(world.counters().broad_phase.swaps == 0);
  for (const Event& e : log.events) CHECK(e.time() == 0);
}

TEST_CASE("Bodies exactly coincident overlap once and part when they part", "[degenerate]") {
  for (const auto method : all_methods) {
    for (const Shape& shape : {Shape(Sphere{1}), Shape(Box{{1, 1, 1}}), Shape(MeshShape{cube(), 1})}) {
      const auto a = body<1>(shape, motion<1>({1, 2, 3}));
      const auto same = run_audited<1>({a, a, a}, with(Response::none, method), 5);
      CHECK(count(same, Kind::overlap) == 3);
      CHECK(count_at(same, 0) == same.size());
      for (const auto response : {Response::none, Response::elastic}) {
        const auto b = body<1>(shape, motion<1>({1, 2, 3}, {1, 0, 0}));
        const auto events = run_audited<1>({a, b}, with(response, method), 5);
        CHECK(count(events, Kind::overlap) == 1);
        const auto parted =
            std::find_if(events.begin(), events.end(), [](const Event& e) { return e.kind == Kind::separation; });
        REQUIRE((parted != events.end()) == (response == Response::none));
        if (parted != events.end()) CHECK(parted->time() == Approx(2).epsilon(1e-12));
      }
    }
  }
}

TEST_CASE("Meeting at a corner: boxes corner to corner", "[degenerate]") {
  for (const auto method : all_methods) {
    const auto meet = [&](const Vector3d& velocity) {
      const auto events = run_audited<1>({box<1>({1, 1, 1}, {0, 0, 0}), box<1>({1, 1, 1}, {4, 4, 4}, velocity)},
                                         with(Response::none, method), 3);
      const std::vector<Event> contacts = contacts_of(events);
      return contacts;
    };
    const auto head_on = meet({-1, -1, -1});
    REQUIRE(head_on.size() == 1);
    CHECK(head_on[0].time() == 2);
    CHECK(head_on[0].contact.point == Vector3d(1, 1, 1));
    CHECK(meet({-1, -1, 0}).empty());
    CHECK(meet({-2, -1, -1}).size() == 1);
    CHECK(meet({-2, -1, -1})[0].time() == 2);
  }
}

TEST_CASE("Meeting at a corner: three bodies at one point and time", "[degenerate]") {
  for (const auto method : all_methods) {
    // Three balls meet in a triangle, all at t = 1; exact numbers by a 3-4-5 triangle.
    std::vector<BodyDescription<1>> bodies{ball<1>(1.5, {0, 0, 0}), ball<1>(1.5, {4, 0, 0}, {-1, 0, 0}),
                                           ball<1>(1.5, {0, 4, 0}, {0, -1, 0})};
    const auto passing = run_audited(bodies, with(Response::none, method), 1);
    const std::vector<Event> contacts = contacts_of(passing);
    REQUIRE(contacts.size() == 2);
    CHECK(contacts[0].time() == 1);
    CHECK(contacts[1].time() == 1);
    const auto events = run_audited(bodies, with(Response::elastic, method), 10);
    REQUIRE(events.size() >= 2);
    CHECK(in_order_of_time(events));
    // What is at one time comes by (a, b).
    std::vector<Event> first;
    for (const Event& e : events) {
      if (e.kind == Kind::contact && e.time() == 1) first.push_back(e);
    }
    REQUIRE(first.size() == 2);
    CHECK(first[0].b == 1);
    CHECK(first[1].b == 2);
  }
}

TEST_CASE("Aligned equal cubes face to face, as boxes and as meshes", "[degenerate]") {
  for (const auto method : all_methods) {
    for (const auto response : {Response::none, Response::elastic}) {
      for (int kinds = 0; kinds < 4; ++kinds) {
        const auto shape = [&](int bit) -> Shape {
          if ((kinds & bit) != 0) return MeshShape{cube(), 1};
          return Box{{1, 1, 1}};
        };
        const auto events = run_audited<1>(
            {body<1>(shape(1), motion<1>({0, 0, 0})), body<1>(shape(2), motion<1>({4, 0, 0}, {-1, 0, 0}))},
            with(response, method), 3);
        const std::vector<Event> contacts = contacts_of(events);
        INFO("kinds " << kinds << ", response " << static_cast<int>(response));
        REQUIRE(contacts.size() == 1);
        CHECK(contacts[0].time() <= 2);
        CHECK(contacts[0].time() > 2 - 1e-12);
        CHECK((contacts[0].contact.normal - Vector3d(1, 0, 0)).norm() < 1e-12);
        CHECK(contacts[0].contact.point[0] == Approx(1));
      }
    }
  }
}

TEST_CASE("Clock at 1e9: as at 0, to the resolution of the clock", "[degenerate]") {
  constexpr double late = 1e9;
  constexpr double tick = 0x1p-23;  // s; spacing of doubles at 1e9
  for (const auto shapes : {Shapes::spheres, Shapes::boxes, Shapes::cubes}) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      INFO(name(shapes) << ", seed " << seed);
      Random random(seed);
      SceneMaker maker(random, {.shapes = shapes, .bodies = 12, .side = 8, .end_time = 4});
      auto scene = maker.scene<2>();
      const auto early_events = run(scene, with(Response::none));
      for (auto& b : scene.bodies) b.motion[0].start = late;
      for (const auto method : all_methods) {
        WorldOptions options = with(Response::none, method);
        options.start_time = late;
        auto late_events = run(scene, options);
        const auto contacts = [](const std::vector<Event>& events, double zero_time) {
          std::map<std::tuple<Kind, BodyId, BodyId>, std::vector<double>> times;
          for (const Event& e : events) {
            if (!is_pair_event(e)) times[{e.kind, e.a, e.b}].push_back(e.time() - zero_time);
          }
          return times;
        };
        const auto expected = contacts(early_events, 0);
        const auto found = contacts(late_events, late);
        REQUIRE(expected.size() >= 3);
        REQUIRE(found.size() == expected.size());
        for (const auto& [what, times] : expected) {
          const auto it = found.find(what);
          REQUIRE(it != found.end());
          REQUIRE(it->second.size() == times.size());
          for (std::size_t i = 0; i < times.size(); ++i) {
            // Meshes count as touching when they are as near as they come in four ticks; where they graze each
            // other that takes longer.
            const double early = shapes == Shapes::cubes ? 1000 * tick : 0;
            CHECK(it->second[i] >= times[i] - early);
            CHECK(it->second[i] <= times[i] + tick + early);
          }
        }
      }
    }
  }
}

TEST_CASE("Clock at 1e9: bounces go on and the run ends", "[degenerate]") {
  WorldOptions options = with(Response::elastic);
  options.start_time = 1e9;
  options.walls = Walls{{-5, -5, -5}, {5, 5, 5}};
  EventLog<1> log;
  World<1> world(options, &log);
  for (int i = 0; i < 8; ++i) {
    auto b = ball<1>(1, {i % 2 * 4.0 - 2, i / 2 % 2 * 4.0 - 2, i / 4 * 4.0 - 2}, {1.0 + i, 2.0 - i, 0.5 * i});
    b.motion[0].start = 1e9;
    world.add_body(b);
  }
  world.advance_to(1e9 + 20);
  world.audit();
  CHECK(log.count(Kind::contact) + log.count(Kind::wall) > 100);
  CHECK(log.count(Kind::held) == 0);
  for (BodyId id = 0; id < 8; ++id) {
    CHECK(world.motion(id).position(world.now()).cwiseAbs().maxCoeff() < 4 + 1e-5);
  }
}

TEST_CASE("Bodies of size 1e-6 next to bodies of size 1e6", "[degenerate]") {
  for (const auto method : all_methods) {
    for (const Shape& large : {Shape(Box{{1e6, 1e6, 1e6}}), Shape(Sphere{1e6})}) {
      for (const Shape& small : {Shape(Box{{1e-6, 1e-6, 1e-6}}), Shape(Sphere{1e-6})}) {
        // Specks fly at the large body and arrive at nearly the same place one after another.
        auto wall = fixed_body<1>(large, motion<1>({-1e6, 0, 0}));
        const auto events = run_audited<1>({wall, body<1>(small, motion<1>({1, 0, 0}, {-1, 0, 0})),
                                            body<1>(small, motion<1>({1 + 1e-5, 0, 0}, {-1, 0, 0}))},
                                           with(Response::elastic, method), 3);
        const std::vector<Event> contacts = contacts_of(events);
        // First at the wall, the two at each other, the second, now in front... the first at the wall again.
        REQUIRE(contacts.size() == 3);
        CHECK(contacts[0].time() == Approx(1 - 1e-6).epsilon(1e-10));
        CHECK(contacts[1].a == 1);
        CHECK(contacts[2].a == 0);
        CHECK(contacts[2].b == 1);
        CHECK(in_order_of_time(events));
      }
    }
  }
}

TEST_CASE("Newton's cradle: the last ball leaves with the first one's speed", "[degenerate]") {
  for (const auto method : all_methods) {
    for (int in = 1; in <= 3; ++in) {
      WorldOptions options = with(Response::elastic, method);
      EventLog<1> log;
      World<1> world(options, &log);
      constexpr int n = 7;
      for (int i = 0; i < n; ++i) {
        const bool moving = i < in;
        world.add_body(ball<1>(1, {2.0 * i - (moving ? 4 : 0), 0, 0}, {moving ? 2.0 : 0.0, 0, 0}));
      }
      world.advance_to(4);
      world.audit();
      INFO(in << " in");
      for (BodyId i = 0; i < n; ++i) {
        CHECK(world.motion(i).velocity(4)[0] == (i >= n - static_cast<BodyId>(in) ? 2 : 0));
      }
      for (const Event& e : log.of(Kind::contact)) CHECK(e.time() == 2);
      CHECK(log.count(Kind::contact) == static_cast<std::size_t>(in * (n - in)));
      CHECK(log.count(Kind::held) == 0);
    }
  }
}

TEST_CASE("Sliding in exact touch is no contact", "[degenerate]") {
  for (const auto method : all_methods) {
    for (const auto response : {Response::none, Response::elastic}) {
      const auto floor = fixed_body<1>(Box{{10, 10, 1}}, motion<1>({0, 0, -1}));
      for (const auto& slider : {box<1>({1, 1, 1}, {-5, 0, 1}, {1, 0.5, 0}), ball<1>(1, {-5, 0, 1}, {1, 0.5, 0})}) {
        for (const Event& e : run_audited<1>({floor, slider}, with(response, method), 20)) CHECK(is_pair_event(e));
      }
    }
  }
}

TEST_CASE("Resting on each other in free fall is no contact", "[degenerate]") {
  for (const auto method : all_methods) {
    for (const auto response : {Response::none, Response::elastic}) {
      const auto events = run_audited<2>(
          {box<2>({1, 1, 1}, {0, 0, 0}, {0, 0, 3}, {0, 0, -5}), box<2>({1, 1, 1}, {0, 0, 2}, {0, 0, 3}, {0, 0, -5}),
           ball<2>(1, {0, 0, 4}, {0, 0, 3}, {0, 0, -5})},
          with(response, method), 10);
      CHECK(events.empty());
    }
  }
}

TEST_CASE("A ball pressed on the floor by its weight is held, which is reported, and the run ends", "[degenerate]") {
  for (const auto method : all_methods) {
    for (const Shape& shape : {Shape(Sphere{1}), Shape(Box{{1, 1, 1}})}) {
      EventLog<2> log;
      World<2> world(with(Response::elastic, method), &log);
      world.add_body(fixed_body<2>(Box{{10, 10, 1}}, motion<2>({0, 0, -1})));
      world.add_body(body<2>(shape, motion<2>({0, 0, 1})));
      world.advance_to(0);
      world.update_motion(1, motion<2>({0, 0, 1}, {1, 0, 0}, {0, 0, -5}));
      world.advance_to(5);
      world.audit();
      CHECK(log.count(Kind::held) == 1);
      CHECK(world.counters().held == 1);
      CHECK(world.motion(1).position(5) == Vector3d(5, 0, 1));
    }
  }
}

TEST_CASE("Bounces that pile up are held at the contact that the policy names", "[degenerate]") {
  for (const auto method : all_methods) {
    for (const Shape& shape : {Shape(Sphere{1}), Shape(Box{{1, 1, 1}})}) {
      EventLog<1> log;
      WorldOptions options = with(Response::elastic, method);
      options.zeno = {.contacts = 10, .interval = 100};
      World<1> world(options, &log);
      world.add_body(fixed_body<1>(Box{{1, 90, 90}}, motion<1>({-3, 0, 0})));
      world.add_body(fixed_body<1>(Box{{1, 90, 90}}, motion<1>({3, 0, 0})));
      world.add_body(body<1>(shape, motion<1>({0, 0, 0}, {2, 1, 0})));  // to and fro in a second
      world.advance_to(50);
      CHECK(log.count(Kind::contact) == 11);
      REQUIRE(log.count(Kind::held) == 1);
      CHECK(log.of(Kind::held)[0].time() == 10.5);
      CHECK(world.motion(2).velocity(50) == Vector3d(0, 1, 0));
    }
  }
}

TEST_CASE("A ball between two fixed bodies that close in: the run ends", "[degenerate]") {
  for (const auto method : all_methods) {
    for (const Shape& shape : {Shape(Sphere{1}), Shape(Box{{1, 1, 1}})}) {
      EventLog<1> log;
      WorldOptions options = with(Response::elastic, method);
      options.zeno.interval = 1e-6;  // collapses soon
      World<1> world(options, &log);
      world.add_body(fixed_body<1>(Box{{1, 5, 5}}, motion<1>({-4, 0, 0}, {1, 0, 0})));
      world.add_body(fixed_body<1>(Box{{1, 5, 5}}, motion<1>({4, 0, 0}, {-1, 0, 0})));
      world.add_body(body<1>(shape, motion<1>({0.25, 0, 0}, {1, 0, 0})));
      world.advance_to(10);
      world.audit();
      CHECK(log.count(Kind::held) > 0);
      CHECK(log.count(Kind::contact) > 100);
      CHECK(log.count(Kind::contact) < 100000);
      CHECK(in_order_of_time(log.events));
    }
  }
}

TEST_CASE("A body crushed between a wall and a fixed body: the run ends", "[degenerate]") {
  for (const auto method : all_methods) {
    EventLog<1> log;
    WorldOptions options = with(Response::elastic, method);
    options.walls = Walls{{-5, -5, -5}, {5, 5, 5}};
    options.zeno.interval = 1e-6;
    World<1> world(options, &log);
    auto piston = fixed_body<1>(Box{{1, 1, 1}}, motion<1>({0, 0, 0}, {-1, 0, 0}));
    world.add_body(piston);
    world.add_body(ball<1>(0.5, {-3, 0, 0}, {-1, 0, 0}));
    world.advance_to(4.25);
    world.audit();
    CHECK(world.counters().held > 0);
    CHECK(log.count(Kind::contact) < 100000);
  }
}

}  // namespace
}  // namespace kds::collision
