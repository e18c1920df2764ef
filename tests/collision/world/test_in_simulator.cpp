// A world among other kinetic structures: one clock, snapshots and roll-back for all.
#include "certificates/plane_motion.hpp"
#include "kds/framework/history.hpp"
#include "kds/framework/kinetic.hpp"
#include "kds/simulator.hpp"
#include "structures/delaunay.hpp"
#include "tests/collision/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace kds::collision::test_in_simulator {
namespace {

using namespace tests;
using Path = certificates::PlaneMotion<1>;
using Delaunay = Kinetic<structures::DelaunayRule<Path>>;

static_assert(KineticStructure<World<1>> && KineticStructure<World<2>>);

Path in_plane(const certificates::PointMotion<1>& m) {
  const auto& [p, v] = m.coefficients;
  return {{Polynomial<1>{{p[0], v[0]}}, Polynomial<1>{{p[1], v[1]}}}, m.start};
}

/// Balls that bounce between walls in a plane, and the triangulation of their centres, which follows them.
class BouncingPoints {
 public:
  enum class Centres { followed, left_alone };

  BouncingPoints(BroadPhaseKind method, std::uint64_t seed, double window = never, Centres centres = Centres::followed)
      : world_(options(method, window), &log_) {
    Random random(seed);
    for (int i = 0; i < 16; ++i) {
      const Vector3d place(2.0 * (i % 4) + random.between(-0.5, 0.5), 2.0 * (i / 4) + random.between(-0.5, 0.5), 0);
      const auto path = motion<1>(place, {random.between(-2, 2), random.between(-2, 2), 0});
      world_.add_body(body<1>(Sphere{0.4}, path));
      points_.add(in_plane(path), 0);
    }
    if (centres == Centres::left_alone) return;
    triangles_.emplace(points_, 0);
    simulator_.emplace(0, world_, *triangles_);
    log_.then = [this](World<1>& world, const Event& e) {
      if (e.kind != Kind::contact && e.kind != Kind::wall) return;
      follow(world, e.a);
      if (e.kind == Kind::contact) follow(world, e.b);
    };
  }

  Simulator<World<1>, Delaunay>& simulator() { return *simulator_; }
  World<1>& world() { return world_; }
  MovingSet<Path>& points() { return points_; }
  std::vector<Event>& events() { return log_.events; }

  /// The triangulation is that of the places at the clock, made from nothing.
  void check() {
    simulator_->audit();
    for (BodyId id = 0; id < world_.size(); ++id) CHECK(points_[id] == in_plane(world_.motion(id)));
  }

 private:
  static WorldOptions options(BroadPhaseKind method, double window) {
    WorldOptions options = with_response(Response::elastic);
    options.broad_phase = method;
    options.window = window;
    options.walls = Walls{{-1, -1, -1}, {7, 7, 1}};
    return options;
  }
  void follow(World<1>& world, BodyId id) {
    if (!(points_[id] == in_plane(world.motion(id)))) points_.update(id, in_plane(world.motion(id)), world.now());
  }

  EventLog<1> log_;
  World<1> world_;
  MovingSet<Path> points_;
  std::optional<Delaunay> triangles_;
  std::optional<Simulator<World<1>, Delaunay>> simulator_;
};

TEST_CASE("A world and a triangulation share one clock", "[world][simulator]") {
  std::vector<Event> alone;
  {
    BouncingPoints points(BroadPhaseKind::automatic, 7, never, BouncingPoints::Centres::left_alone);
    points.world().advance_to(4);
    alone = points.events();
    CHECK(alone.size() > 40);
  }
  for (const auto method :
       {BroadPhaseKind::automatic, BroadPhaseKind::grid, BroadPhaseKind::kinetic_sap, BroadPhaseKind::all_pairs}) {
    for (const double window : {never, 0.3}) {
      BouncingPoints points(method, 7, window);
      if (window < never) points.simulator().set_window(window);
      double last = 0;
      while (points.simulator().step(4)) {
        const double now = points.simulator().now();
        CHECK(now >= last);
        last = now;
        CHECK((points.events().empty() || points.events().back().time() <= now));
        points.check();
      }
      CHECK(points.events() == alone);
      CHECK(points.simulator().counters().events > alone.size());
    }
  }
}

TEST_CASE("The next event of a world is known, and looking for it changes nothing", "[world][simulator]") {
  for (const auto method :
       {BroadPhaseKind::automatic, BroadPhaseKind::grid, BroadPhaseKind::kinetic_sap, BroadPhaseKind::all_pairs}) {
    BouncingPoints looked(method, 11, never, BouncingPoints::Centres::left_alone);
    BouncingPoints plain(method, 11, never, BouncingPoints::Centres::left_alone);
    Random random(5);
    for (int i = 0; i < 60; ++i) {
      const double t = looked.world().now() + random.between(0, 0.1);
      const std::size_t before = looked.events().size();
      const double next = looked.world().next_time();
      CHECK(looked.world().next_time() == next);
      CHECK(looked.world().now() <= next);
      looked.world().advance_to(t);
      plain.world().advance_to(t);
      if (looked.events().size() > before && next > looked.world().now()) FAIL("an event before the next one");
      looked.world().next_time();  // the search goes beyond the edit
      const auto id = static_cast<BodyId>(random.below(16));
      const Vector3d v(random.between(-2, 2), random.between(-2, 2), 0);
      for (auto* points : {&looked, &plain}) {
        auto path = points->world().motion(id).restarted(t);
        path.coefficients[1] = v;
        points->world().update_motion(id, path);
      }
      looked.world().audit();
    }
    CHECK(looked.events() == plain.events());
    CHECK(looked.world().now() == plain.world().now());
  }
}

TEST_CASE("A world that nothing happens in has no next event, and its clock stays", "[world][simulator]") {
  for (const auto method : {BroadPhaseKind::automatic, BroadPhaseKind::grid, BroadPhaseKind::kinetic_sap}) {
    WorldOptions options;
    options.broad_phase = method;
    World<1> world(options);
    CHECK(world.next_time() == never);
    world.add_body(ball<1>(1, zero, {1, 0, 0}));
    world.add_body(ball<1>(1, {-5, 0, 0}, {-1, 0, 0}));
    CHECK(world.next_time() == 0);  // it is to be seen what follows from their coming
    world.process();
    CHECK(world.next_time() == never);
    CHECK(world.now() == 0);
    world.advance_to(2);
    CHECK(world.now() == 2);
    world.update_motion(1, motion<1>({-7, 0, 0}, {3, 0, 0}, zero, 2));
    world.process();
    CHECK(world.next_time() == 5.5);
    world.audit();
    Simulator simulator(2, world);
    CHECK(simulator.step());
    CHECK(simulator.now() == 5.5);
    CHECK(world.now() == 5.5);
  }
}

TEST_CASE("To look for what never comes, or to run until nothing comes, changes nothing of what is added later",
          "[world][simulator]") {
  struct Log final : WorldListener<1> {
    void contact(World<1>&, const PairEvent& event) override { times.push_back(event.contact.time); }
    void overlap(World<1>&, const PairEvent& event) override { times.push_back(event.contact.time); }
    std::vector<double> times;
  };
  for (const auto method : {BroadPhaseKind::automatic, BroadPhaseKind::grid, BroadPhaseKind::kinetic_sap}) {
    WorldOptions options;
    options.broad_phase = method;
    std::size_t met = 0;
    // A grid renews the boxes of bodies that fly apart to the end of time after each call, so few seeds take seconds.
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      INFO("seed " << seed);
      Log log_plain, log_looked, log_run;
      World<1> plain(options, &log_plain), looked(options, &log_looked), run(options, &log_run);
      Random random(seed);
      double t = 0;
      for (int i = 0; i < 12; ++i) {
        const auto vector = [&](double size) {
          return Vector3d(random.between(-size, size), random.between(-size, size), random.between(-size, size));
        };
        const Vector3d at = vector(1);
        const BodyDescription<1> body{.shape = Sphere{0.3}, .motion = {motion<1>(at, vector(3), zero, t)}};
        for (World<1>* world : {&plain, &looked, &run}) world->add_body(body);
        looked.next_time();
        if (random.one_in(2)) {  // its events are then told early, those of others at t
          while (run.step()) {
          }
          t = run.now();
        }
        t += random.between(0, 0.2);
        for (World<1>* world : {&plain, &looked, &run}) {
          world->advance_to(t);
          looked.next_time();
          INFO("world " << (world == &plain ? 0 : world == &looked ? 1 : 2) << ", body " << i);
          world->audit();
          std::size_t near = 0;
          const Vector3d first = world->motion(0).position(t);
          world->visit_overlapping(first, first, [&](BodyId) { ++near; });
          CHECK(near > 0);
        }
      }
      CHECK(log_looked.times == log_plain.times);
      CHECK(log_run.times == log_plain.times);
      met += log_plain.times.size();
    }
    CHECK(met > 20);
  }
}

TEST_CASE("A world that is changed before the clock of its simulator has to be brought up to it",
          "[world][simulator]") {
  EventLog<1> log, log_alone;
  World<1> world(with_response(Response::elastic), &log), alone(with_response(Response::elastic), &log_alone);
  World<1> idle{WorldOptions{}};
  for (World<1>* each : {&world, &alone}) {
    each->add_body(ball<1>(1, zero));
    each->add_body(ball<1>(1, {9, 0, 0}));
  }
  Simulator simulator(0, idle, world);
  simulator.advance_to(2);
  REQUIRE(world.now() == 0);
  world.update_motion(1, motion<1>({9, 0, 0}, {-1, 0, 0}));
  CHECK_FALSE(simulator.step(2));  // The two meet at 7, so nothing has been missed.
  CHECK(simulator.next_time() == 7);
  CHECK(simulator.now() == 2);
  REQUIRE(world.now() == 0);
  for (World<1>* each : {&world, &alone}) each->update_motion(1, motion<1>({9, 0, 0}, {-4, 0, 0}));
  const std::string refused =
      "Simulator: the clock stands at 2, and structure 1 (in the order of the arguments, from 0) is due at "
      "1.75: it was changed at a time before the clock";
  CHECK_THROWS_WITH(simulator.step(), refused);
  CHECK_THROWS_WITH(simulator.step(9), refused);
  CHECK_THROWS_WITH(simulator.advance_to(9), refused);
  CHECK_THROWS_WITH(simulator.next_time(), refused);
  CHECK_THROWS_AS(simulator.advance_to(3), std::logic_error);
  CHECK(simulator.now() == 2);
  CHECK(world.now() == 0);

  world.advance_to(2);
  simulator.advance_to(9);
  alone.advance_to(9);
  REQUIRE(log.events.size() == 1);
  CHECK(log.events[0].time() == 1.75);
  CHECK(log.events == log_alone.events);
}

TEST_CASE("A world that is ahead of the clock of its simulator is refused", "[world][simulator]") {
  World<1> idle{WorldOptions{}}, world{WorldOptions{}};
  world.add_body(ball<1>(1, zero, {1, 0, 0}));
  Simulator simulator(0, world, idle);
  simulator.advance_to(2);
  world.advance_to(2);
  CHECK_NOTHROW(simulator.advance_to(3));  // up to the clock is no further
  world.advance_to(5);
  const std::string refused =
      "Simulator: the clock stands at 3, and structure 0 (in the order of the arguments, from 0) was advanced "
      "by itself to 5";
  CHECK_THROWS_WITH(simulator.step(), refused);
  CHECK_THROWS_WITH(simulator.advance_to(9), refused);
  CHECK(simulator.now() == 3);
}

TEST_CASE("A world and a triangulation are rolled back together", "[world][simulator][history]") {
  for (const auto method : {BroadPhaseKind::automatic, BroadPhaseKind::kinetic_sap}) {
    BouncingPoints points(method, 3);
    History history(50, points.simulator(), points.points());
    while (history.step(3)) {
    }
    const auto events = points.events();
    std::vector<double> times;
    for (const Event& e : events) times.push_back(e.time());
    for (const double back : {2.5, 1.0, 0.25}) {
      history.roll_back(back);
      points.check();
      points.events().clear();
      while (history.step(3)) points.check();
      std::vector<Event> expected;
      for (const Event& e : events) {
        if (e.time() > back) expected.push_back(e);
      }
      CHECK(points.events() == expected);
    }
  }
}

}  // namespace
}  // namespace kds::collision::test_in_simulator
