// The interface of the world: time, bodies that come and go, filters, response, walls, errors.
#include "tests/collision/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace kds::collision {
namespace {

using namespace tests;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

WorldOptions with(Response response) {
  WorldOptions options;
  options.response = response;
  return options;
}

/// Two unit balls that meet at t = 1 and, in mode none, part at t = 3.
template <int Degree = 1>
std::vector<BodyDescription<Degree>> two_balls() {
  return {ball<Degree>(1, {0, 0, 0}), ball<Degree>(1, {4, 0, 0}, {-2, 0, 0})};
}

TEST_CASE("An empty world and a world of one body run", "[world]") {
  for (const auto response : {Response::none, Response::elastic}) {
    World<1> world(with(response));
    world.advance_to(1);
    CHECK(world.now() == 1);
    CHECK_FALSE(world.step());
    CHECK(world.size() == 0);
    const BodyId id = world.add_body(ball<1>(1, {0, 0, 0}, {1, 0, 0}));
    CHECK(world.size() == 1);
    CHECK(world.contains(id));
    world.advance_to(5);
    CHECK_FALSE(world.step());
    CHECK(world.motion(id).position(5) == Vector3d(5, 0, 0));
    world.audit();
    world.remove_body(id);
    CHECK(world.size() == 0);
    CHECK_FALSE(world.contains(id));
    world.advance_to(6);
  }
}

TEST_CASE("Time passes up to a time, event by event, or for a budget", "[world]") {
  EventLog<1> log;
  World<1> world({}, &log);
  for (const auto& b : two_balls()) world.add_body(b);

  SECTION("up to a time, inclusive") {
    world.advance_to(std::nextafter(1.0, 0.0));
    CHECK(log.events.empty());
    world.advance_to(1);
    REQUIRE(log.count(Kind::contact) == 1);
    CHECK(log.events[0].time() == 1);
    CHECK(log.events[0].contact.point == Vector3d(1, 0, 0));
    CHECK(log.events[0].contact.normal == Vector3d(1, 0, 0));
    CHECK(world.touching(0, 1));
    world.advance_to(1);
    CHECK(log.events.size() == 1);
    world.advance_to(10);
    REQUIRE(log.count(Kind::separation) == 1);
    CHECK(log.events[1].time() == 3);
    CHECK_FALSE(world.touching(1, 0));
    CHECK(world.now() == 10);
  }
  SECTION("event by event, without a limit") {
    int steps = 0;
    while (world.step()) {
      ++steps;
      REQUIRE(steps < 100);
    }
    CHECK(log.count(Kind::contact) == 1);
    CHECK(log.count(Kind::separation) == 1);
  }
  SECTION("event by event, with a limit") {
    while (world.step(2)) CHECK(world.now() <= 2);
    CHECK(world.now() == 2);
    CHECK(log.events.size() == 1);
  }
  SECTION("for a budget") {
    int calls = 1;
    while (!world.advance_for(0, 10)) REQUIRE(++calls < 100);  // at least one event each time
    CHECK(calls > 1);
    CHECK(world.now() == 10);
    CHECK(log.events.size() == 2);
    CHECK(world.advance_for(60, 20));
    CHECK(world.now() == 20);
  }
}

TEST_CASE("A motion that changes outside callbacks changes what comes", "[world]") {
  EventLog<1> log;
  World<1> world({}, &log);
  for (const auto& b : two_balls()) world.add_body(b);
  world.advance_to(0.5);
  world.update_motion(1, motion<1>({3, 0, 0}, {-4, 0, 0}, zero, 0.5));
  world.advance_to(2);
  REQUIRE(log.count(Kind::contact) == 1);
  CHECK(log.events[0].time() == 0.75);
  world.audit();
}

TEST_CASE("A motion may change inside a callback", "[world]") {
  EventLog<1> log;
  log.then = [](World<1>& world, const Event& e) {
    if (e.kind != Kind::contact) return;
    const Vector3d here = world.motion(e.b).position(e.time());
    world.update_motion(e.b, motion<1>(here, {1, 0, 0}, zero, e.time()));
  };
  World<1> world({}, &log);
  for (const auto& b : two_balls()) world.add_body(b);
  world.advance_to(10);
  REQUIRE(log.events.size() == 2);
  CHECK(log.events[0].time() == 1);
  CHECK(log.events[1].kind == Kind::separation);  // just touching is no contact
  CHECK(log.events[1].time() == 1);
}

TEST_CASE("A teleport ends contacts where it leaves and begins them where it arrives", "[world]") {
  for (const auto& [kind, name, what] : broad_phases) {
    WorldOptions options;
    options.broad_phase = kind;
    options.rate = 10;
    options.report_pairs = true;
    EventLog<1> log;
    World<1> world(options, &log);
    for (const auto& b : two_balls()) world.add_body(b);
    world.add_body(ball<1>(1, {100, 0, 0}));
    world.advance_to(2);
    REQUIRE(world.touching(0, 1));
    world.update_motion(1, motion<1>({99.5, 0, 0}, {0, 0, 0}, zero, 2));
    world.advance_to(2);
    CHECK_FALSE(world.touching(0, 1));
    CHECK(world.touching(1, 2));
    REQUIRE(log.count(Kind::separation) == 1);
    REQUIRE(log.count(Kind::contact) == 2);
    REQUIRE(log.count(Kind::pair_ended) == 1);
    REQUIRE(log.count(Kind::pair_began) == 2);
    CHECK(log.of(Kind::separation).back().time() == 2);
    CHECK(log.of(Kind::contact).back().time() == 2);
    CHECK(log.of(Kind::pair_ended).back().a == 0);
    CHECK(log.of(Kind::pair_began).back().b == 2);
    world.advance_to(4);
    world.audit();
    CHECK(in_order_of_time(log.events));
  }
}

TEST_CASE("Two bodies that teleport together at one instant stay in contact", "[world]") {
  for (const auto& [kind, name, what] : broad_phases) {
    INFO(name);
    WorldOptions options;
    options.broad_phase = kind;
    options.rate = 10;
    options.report_pairs = true;
    EventLog<1> log;
    World<1> world(options, &log);
    for (auto b : two_balls()) {
      auto next = b.motion[0];
      next.coefficients[0] = b.motion[0].position(2) + Vector3d(50, 0, 0);
      next.start = 2;
      b.motion.push_back(next);
      world.add_body(b);
    }
    world.advance_to(10);
    CHECK(log.count(Kind::contact) == 1);
    REQUIRE(log.count(Kind::separation) == 1);
    CHECK(log.of(Kind::separation)[0].time() == 3);
    CHECK(log.count(Kind::pair_began) == 1);
    CHECK(log.count(Kind::pair_ended) == 1);
  }
}

TEST_CASE("A body that appears inside another overlaps, and does not stop the run", "[world]") {
  for (const auto response : {Response::none, Response::elastic}) {
    EventLog<1> log;
    World<1> world(with(response), &log);
    world.add_body(ball<1>(1, {0, 0, 0}));
    world.advance_to(1);
    auto late = ball<1>(1, {0.5, 0, 0}, {1, 0, 0});
    late.motion[0].start = 2;
    const BodyId id = world.add_body(late);
    CHECK(world.contains(id));
    world.advance_to(10);
    REQUIRE(log.count(Kind::overlap) == 1);
    CHECK(log.events[0].kind == Kind::overlap);
    CHECK(log.events[0].time() == 2);
    CHECK(log.count(Kind::contact) == 0);
    CHECK(log.count(Kind::separation) == (response == Response::none ? 1u : 0u));
  }
}

TEST_CASE("Removing a body ends its pairs and contacts, with reports", "[world]") {
  for (const auto& [kind, name, what] : broad_phases) {
    WorldOptions options;
    options.broad_phase = kind;
    options.rate = 10;
    options.report_pairs = true;
    EventLog<1> log;
    World<1> world(options, &log);
    for (const auto& b : two_balls()) world.add_body(b);
    world.advance_to(2);
    REQUIRE(log.count(Kind::pair_began) == 1);
    world.remove_body(0);
    world.advance_to(5);
    REQUIRE(log.count(Kind::separation) == 1);
    CHECK(log.of(Kind::separation)[0].time() == 2);
    CHECK(log.of(Kind::separation)[0].contact.point == Vector3d(1, 0, 0));
    REQUIRE(log.count(Kind::pair_ended) == 1);
    CHECK(log.of(Kind::pair_ended)[0].time() == 2);
    // The number is given again.
    CHECK(world.add_body(ball<1>(1, {50, 0, 0})) == 0);
    world.advance_to(6);
    world.audit();
  }
}

TEST_CASE("Bodies may be removed and added inside their own contact", "[world]") {
  for (const auto response : {Response::none, Response::elastic, Response::callback}) {
    for (int which = 0; which < 5; ++which) {
      INFO("response " << static_cast<int>(response) << ", case " << which);
      EventLog<1> log;
      bool done = false;
      BodyId third = 0;
      log.then = [&](World<1>& world, const Event& e) {
        if (e.kind != Kind::contact || done) return;
        done = true;
        if (which == 0 || which == 2) world.remove_body(e.a);
        if (which == 1 || which == 2) world.remove_body(e.b);
        if (which == 3) world.remove_body(third);
        if (which == 4) {  // the number of the removed body goes to another one, in contact at once
          world.remove_body(e.a);
          const BodyId added = world.add_body(ball<1>(1, {1.5, 0, 0}));
          CHECK(added == e.a);
        }
      };
      World<1> world(with(response), &log);
      for (const auto& b : two_balls()) world.add_body(b);
      third = world.add_body(ball<1>(1, {-6, 0, 0}, {0.5, 0, 0}));
      world.advance_to(20);
      world.audit();
      CHECK(done);
      CHECK(world.size() == (which == 2 ? 1u : which == 4 ? 3u : 2u));
      CHECK(log.count(Kind::overlap) == (which == 4 ? 1u : 0u));
      CHECK(in_order_of_time(log.events));
    }
  }
}

TEST_CASE("A caller's bounding volumes are renewed when they expire, as events of their own", "[world]") {
  for (const auto& [kind, name, what] : broad_phases) {
    INFO(name);
    EventLog<1> log;
    WorldOptions options;
    options.report_pairs = true;
    options.broad_phase = kind;
    options.rate = 10;
    World<1> world(options, &log);
    int calls = 0;
    auto careful = ball<1>(1, {0, 0, 0}, {1, 0, 0});
    // A box at rest that holds the ball for half a second.
    careful.box = [&](double t, const certificates::PointMotion<1>& path) {
      ++calls;
      const Vector3d from = path.position(t);
      KineticBox<1> result{motion<1>(from - Vector3d(1, 1, 1), zero, zero, t),
                           motion<1>(from + Vector3d(1.5, 1, 1), zero, zero, t)};
      result.valid_until = t + 0.5;
      return result;
    };
    world.add_body(careful);
    world.add_body(ball<1>(1, {8.25, 0, 0}));
    world.advance_to(4.25);
    CHECK(calls == 9);  // at 0, 0.5 ... 4
    world.audit();
    world.advance_to(10.25);
    CHECK(calls == 21);
    REQUIRE(log.count(Kind::contact) == 1);
    CHECK(log.of(Kind::contact)[0].time() == 6.25);
    REQUIRE(log.count(Kind::pair_began) == 1);
    CHECK(log.of(Kind::pair_began)[0].time() == 6);  // the first of the boxes that reaches 7.25
    CHECK(log.count(Kind::separation) == 1);
  }
}

TEST_CASE("The window does not matter to volumes that expire", "[world]") {
  for (const double window : {0.1, 0.7, never}) {
    WorldOptions options;
    options.window = window;
    World<1> world(options);
    int calls = 0;
    auto careful = ball<1>(1, {0, 0, 0}, {1, 0, 0});
    careful.box = [&](double t, const certificates::PointMotion<1>& path) {
      ++calls;
      auto result = box_around(path, Vector3d::Constant(-1), Vector3d::Constant(1));
      result.valid_until = t + 1;
      return result;
    };
    world.add_body(careful);
    world.advance_to(5.5);
    CHECK(calls == 6);
  }
}

TEST_CASE("The volume of the bounding sphere holds the shape in any orientation", "[world]") {
  WorldOptions options;
  options.report_pairs = true;
  std::vector<double> began;
  for (const auto volume : {BoundingVolume::shape, BoundingVolume::sphere}) {
    EventLog<1> log;
    World<1> world(options, &log);
    auto a = box<1>({1, 1, 1}, {0, 0, 0});
    a.volume = volume;
    world.add_body(a);
    world.add_body(ball<1>(1, {10, 0, 0}, {-1, 0, 0}));
    world.advance_to(20);
    REQUIRE(log.count(Kind::pair_began) == 1);
    began.push_back(log.of(Kind::pair_began)[0].time());
    REQUIRE(log.count(Kind::contact) == 1);
    CHECK(log.of(Kind::contact)[0].time() == 8);
  }
  CHECK(began[0] == 8);
  CHECK(began[1] == Approx(9 - std::sqrt(3.0)));
}

TEST_CASE("Filters: a pair is tested if each one's category is in the other's mask", "[world]") {
  for (const auto& [kind, name, what] : broad_phases) {
    for (int masks = 0; masks < 4; ++masks) {
      WorldOptions options;
      options.broad_phase = kind;
      options.rate = 10;
      options.report_pairs = true;
      EventLog<1> log;
      World<1> world(options, &log);
      auto balls = two_balls();
      balls[0].category = 2;
      balls[1].category = 4;
      balls[0].collides_with = (masks & 1) != 0 ? 4 : 2;
      balls[1].collides_with = (masks & 2) != 0 ? 2 : 4;
      for (const auto& b : balls) world.add_body(b);
      world.advance_to(10);
      world.audit();
      CHECK(log.events.empty() == (masks != 3));
      if (masks != 3) CHECK(world.counters().pair_tests == 0);
    }
  }
}

TEST_CASE("A listener that does nothing about a contact lets the bodies pass", "[world]") {
  EventLog<1> log;
  World<1> world(with(Response::callback), &log);
  for (const auto& b : two_balls()) world.add_body(b);
  world.advance_to(10);
  CHECK(log.events.size() == 1);
  CHECK(log.count(Kind::contact) == 1);
  CHECK(world.motion(1).position(10) == Vector3d(-16, 0, 0));
}

TEST_CASE("Elastic contacts of two bodies exchange momentum by the book", "[world]") {
  const auto velocities = [](BodyDescription<1> a, BodyDescription<1> b) {
    World<1> world(with(Response::elastic));
    world.add_body(a);
    world.add_body(b);
    world.advance_to(1.5);
    CHECK(world.counters().contacts == 1);
    return std::pair(world.motion(0).velocity(1.5)[0], world.motion(1).velocity(1.5)[0]);
  };
  auto balls = two_balls();
  CHECK(velocities(balls[0], balls[1]) == std::pair(-2.0, 0.0));
  balls[0].mass = 3;
  CHECK(velocities(balls[0], balls[1]) == std::pair(-1.0, 1.0));
  balls[0].fixed = true;
  CHECK(velocities(balls[0], balls[1]) == std::pair(0.0, 2.0));
  balls[1].mass = 1000;
  CHECK(velocities(balls[0], balls[1]) == std::pair(0.0, 2.0));
}

TEMPLATE_TEST_CASE_SIG("Momentum and energy last through thousands of elastic contacts", "[world]",
                       ((int Degree), Degree), 1, 2) {
  Random random(11);
  EventLog<Degree> log;
  World<Degree> world(with(Response::elastic), &log);
  const Vector3d gravity = Degree == 2 ? Vector3d(0, 0, -0.5) : Vector3d(0, 0, 0);
  double mass = 0;
  const auto state = [&](double t) {
    Vector3d momentum = Vector3d::Zero();
    double energy = 0;
    for (BodyId id = 0; id < world.size(); ++id) {
      const Vector3d v = world.motion(id).velocity(t);
      momentum += world.mass(id) * v;
      energy += world.mass(id) * (v.squaredNorm() / 2 - 2 * gravity.dot(world.motion(id).position(t)));
    }
    return std::pair(momentum, energy);
  };
  // Far apart and thrown at the middle, all in free fall: so they meet often, and nothing but they changes momentum.
  for (int i = 0; i < 6 * 6 * 6; ++i) {
    const Vector3d place(i % 6 - 2.5, i / 6 % 6 - 2.5, i / 36 - 2.5);
    const Vector3d v(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
    auto description = ball<Degree>(0.45, 1.2 * place, 5 * v - 4 * place, gravity);
    description.mass = random.one_in(2) ? 1 : random.between(0.2, 5);
    mass += description.mass;
    world.add_body(description);
  }
  const auto [momentum, energy] = state(0);
  world.advance_to(3);
  const auto [momentum_after, energy_after] = state(3);
  CHECK(log.count(Kind::contact) > 1000);
  CHECK(log.count(Kind::held) == 0);
  // Each contact rounds a few times; the bound leaves 10^3 roundings of the sum.
  CHECK((momentum_after - (momentum + 2 * 3 * mass * gravity)).norm() < 1e-12 * mass * 20);
  CHECK(energy_after == Approx(energy).epsilon(1e-11));
  CHECK(in_order_of_time(log.events));
  world.audit();
}

TEST_CASE("Walls turn bodies back at their bounding sphere", "[world]") {
  WorldOptions options;
  options.walls = Walls{{0, 0, 0}, {10, 10, 10}};
  for (const auto response : {Response::none, Response::elastic}) {
    options.response = response;
    EventLog<1> log;
    World<1> world(options, &log);
    world.add_body(ball<1>(1, {5, 5, 5}, {2, 1, 0}));
    world.advance_to(10);
    const auto hits = log.of(Kind::wall);
    REQUIRE(hits.size() == 4);
    CHECK(hits[0].time() == 2);
    CHECK(hits[0].b == 1);
    CHECK(hits[0].contact.normal == Vector3d(1, 0, 0));
    CHECK(hits[0].contact.point == Vector3d(10, 7, 5));
    CHECK(hits[1].time() == 4);
    CHECK(hits[1].b == 3);
    CHECK(hits[2].time() == 6);
    CHECK(hits[2].b == 0);
    CHECK(hits[2].contact.normal == Vector3d(-1, 0, 0));
    CHECK(hits[3].time() == 10);
    CHECK(world.counters().wall_contacts == 4);
  }
}

TEST_CASE("A ball thrown up falls back to the floor again and again", "[world]") {
  WorldOptions options;
  options.walls = Walls{{0, 0, 0}, {10, 10, 100}};
  EventLog<2> log;
  World<2> world(options, &log);
  world.add_body(ball<2>(1, {5, 5, 5}, {0, 0, 0}, {0, 0, -1}));  // 4 m above the floor: falls for 2 s
  world.advance_to(41);
  CHECK(log.count(Kind::wall) == 10);
  for (std::size_t i = 0; i < log.events.size(); ++i) CHECK(log.events[i].time() == 2.0 + 4.0 * static_cast<double>(i));
}

TEST_CASE("Fixed bodies at rest are never compared, even where they overlap", "[world]") {
  EventLog<1> log;
  World<1> world(with(Response::elastic), &log);
  for (int i = 0; i < 5; ++i) world.add_body(fixed_body<1>(Box{{1, 1, 1}}, motion<1>({0.5 * i, 0, 0})));
  world.advance_to(100);
  CHECK(log.count(Kind::contact) == 0);
  CHECK(log.count(Kind::overlap) == 9);  // all but the pairs 0-4 that touch; reported once
  CHECK(world.counters().broad_phase.swaps == 0);
}

TEST_CASE("The same run gives the same events", "[world]") {
  Random random(5);
  SceneMaker maker(random, {.shapes = Shapes::mixture, .bodies = 30, .side = 8, .heterogeneous = true, .end_time = 4});
  const auto scene = maker.scene<2>();
  WorldOptions options = with(Response::elastic);
  options.report_pairs = true;
  const auto first = run(scene, options);
  CHECK(first.size() > 50);
  CHECK(run(scene, options) == first);
  CHECK(in_order_of_time(first));
}

// ---- Errors -------------------------------------------------------------------------------------------------------

template <class F>
void throws(F&& f, const std::string& what) {
  INFO(what);
  try {
    f();
    FAIL("nothing was thrown");
  } catch (const std::invalid_argument& error) {
    INFO(error.what());
    CHECK(std::string(error.what()).find(what) != std::string::npos);
  }
}

TEST_CASE("Options that make no sense are refused by name", "[world]") {
  const auto refuse = [](auto&& change, const char* what) {
    WorldOptions options;
    change(options);
    throws([&] { World<1> world(options); }, what);
  };
  refuse([](WorldOptions& o) { o.start_time = nan; }, "start_time");
  refuse([](WorldOptions& o) { o.start_time = never; }, "start_time");
  for (const double window : {0.0, -1.0, nan}) refuse([&](WorldOptions& o) { o.window = window; }, "window");
  refuse([](WorldOptions& o) { o.zeno.interval = -1; }, "zeno.interval");
  refuse([](WorldOptions& o) { o.zeno.interval = nan; }, "zeno.interval");
  for (const double rate : {0.0, -1.0, nan, never}) {
    refuse([&](WorldOptions& o) { o.broad_phase = BroadPhaseKind::sap, o.rate = rate; }, "rate");
  }
  refuse([](WorldOptions& o) { o.walls = Walls{{0, 0, 0}, {1, 0, 1}}; }, "walls");
  refuse([](WorldOptions& o) { o.walls = Walls{{0, 0, 0}, {1, nan, 1}}; }, "walls");
  for (const double bad : {-0.1, 1.1, nan}) {
    refuse([&](WorldOptions& o) { o.walls = Walls{{0, 0, 0}, {1, 1, 1}, bad}; }, "walls.restitution");
  }
  refuse([](WorldOptions& o) { o.broad_phase = static_cast<BroadPhaseKind>(77); }, "broad_phase");
}

TEST_CASE("Bodies that make no sense are refused by name, and the world goes on", "[world]") {
  EventLog<2> log;
  World<2> world({}, &log);
  for (const auto& b : two_balls<2>()) world.add_body(b);
  const auto refuse = [&](auto&& change, const char* what) {
    auto description = ball<2>(1, {0, 0, 0});
    change(description);
    throws([&] { world.add_body(description); }, what);
  };
  using D = BodyDescription<2>;
  for (const double bad : {0.0, -1.0, nan, never, -never}) {
    INFO("size " << bad);
    refuse([&](D& d) { d.shape = Sphere{bad}; }, "radius");
    refuse([&](D& d) { d.shape = Box{{1, bad, 1}}; }, "half_extents");
    refuse([&](D& d) { d.shape = MeshShape{tetrahedron(), bad}; }, "scale");
    refuse([&](D& d) { d.mass = bad; }, "mass");
  }
  for (const double bad : {-0.1, 1.1, nan}) refuse([&](D& d) { d.restitution = bad; }, "restitution");
  refuse([](D& d) { d.shape = MeshShape{}; }, "mesh");
  for (const double bad : {nan, never}) {
    for (int i = 0; i < 3; ++i) {
      refuse([&](D& d) { d.motion[0].coefficients[static_cast<std::size_t>(i)][i] = bad; }, "motion[0]");
    }
    refuse([&](D& d) { d.motion[0].start = bad; }, "motion[0]");
    refuse([&](D& d) { d.orientation.w() = bad; }, "orientation");
  }
  refuse([](D& d) { d.motion.clear(); }, "motion");
  refuse([](D& d) { d.motion.push_back(d.motion[0]); }, "motion[1].start");
  refuse([](D& d) { d.motion.push_back(d.motion[0]), d.motion[1].start = -1; }, "motion[1].start");
  refuse([](D& d) { d.orientation.coeffs() *= 1.01; }, "orientation");
  refuse([](D& d) { d.orientation.coeffs().setZero(); }, "orientation");

  throws([&] { world.update_motion(0, motion<2>({nan, 0, 0})); }, "update_motion");
  throws([&] { world.update_motion(0, motion<2>({0, 0, 0}, zero, zero, never)); }, "update_motion");
  CHECK_THROWS_AS(world.update_motion(2, motion<2>({0, 0, 0})), std::out_of_range);
  CHECK_THROWS_AS(world.remove_body(2), std::out_of_range);
  CHECK_THROWS_AS(world.motion(2), std::out_of_range);
  CHECK_THROWS_AS(world.shape(2), std::out_of_range);
  CHECK_THROWS_AS(world.touching(0, 2), std::out_of_range);
  world.advance_to(0.5);
  throws([&] { world.advance_to(0.25); }, "advance_to");
  throws([&] { world.advance_to(nan); }, "advance_to");
  throws([&] { world.advance_to(never); }, "advance_to");
  throws([&] { world.step(nan); }, "step");

  CHECK(world.size() == 2);
  CHECK(world.now() == 0.5);
  world.advance_to(10);
  world.audit();
  CHECK(log.events.size() == 2);
}

TEST_CASE("A world of frames needs a limit to step to", "[world]") {
  WorldOptions options;
  options.broad_phase = BroadPhaseKind::sap;
  options.rate = 10;
  World<1> world(options);
  throws([&] { world.step(); }, "step");
  CHECK_FALSE(world.step(1));
}

TEST_CASE("Removed bodies are unknown", "[world]") {
  World<1> world({});
  for (const auto& b : two_balls()) world.add_body(b);
  world.advance_to(0.5);
  world.remove_body(0);
  CHECK_THROWS_AS(world.remove_body(0), std::out_of_range);
  CHECK_THROWS_AS(world.update_motion(0, motion<1>({0, 0, 0})), std::out_of_range);
  world.advance_to(5);
  CHECK(world.size() == 1);
}

}  // namespace
}  // namespace kds::collision
