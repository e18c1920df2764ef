// Restitution, and bounces that pile up in time.
#include "tests/collision/world/resting_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

namespace kds::collision::test_zeno {
namespace {

using namespace tests;

TEST_CASE("Restitution: a contact leaves that part of the speed, the lower of two counts", "[restitution]") {
  for (const double e : {0.0, 0.25, 0.5, 1.0}) {
    for (const double other : {0.25, 1.0}) {
      EventLog<1> log;
      World<1> world(elastic(), &log);
      world.add_body(bouncy(ball<1>(1, {0, 0, 0}, {1, 0, 0}), e, 1));
      world.add_body(bouncy(ball<1>(1, {4, 0, 0}, {-1, 0, 0}), other, 3));
      world.advance_to(5);
      REQUIRE(log.count(Kind::contact) == 1);
      const double a = world.motion(0).velocity(5)[0];
      const double b = world.motion(1).velocity(5)[0];
      CHECK(a + 3 * b == Approx(1 - 3));
      CHECK(b - a == Approx(std::min(e, other) * 2).margin(1e-15));
      CHECK(log.count(Kind::rebound_suppressed) == (e == 0 ? 1 : 0));
    }
  }
}

TEST_CASE("Restitution: walls take part of the speed along their normal", "[restitution]") {
  for (const double of_walls : {0.5, 1.0}) {
    WorldOptions options = elastic();
    options.walls = Walls{{-5, -5, -5}, {5, 5, 5}, of_walls};
    EventLog<1> log;
    World<1> world(options, &log);
    world.add_body(bouncy(ball<1>(1, {0, 0, 0}, {4, 1, 0}), 0.75));
    world.advance_to(1.5);
    CHECK(world.motion(0).velocity(1.5) == Vector3d(-4 * std::min(0.75, of_walls), 1, 0));
  }
}

TEST_CASE("Zeno: a ball or box that bounces ever lower comes to rest at the right time and place", "[zeno]") {
  for (const double e : {0.1, 0.5, 0.9}) {
    for (const Shape& shape : {Shape(Sphere{1}), Shape(Box{{1, 1, 1}}), Shape(MeshShape{cube(), 1})}) {
      const auto scene = [&](World<2>& world) {
        world.add_body(floor_box());
        world.add_body(bouncy(body<2>(shape, motion<2>({0, 0, 4}, {0.25, 0, 0}, weight)), e));
        world.advance_to(100);
      };
      with_all_methods(elastic(), scene, [&](World<2>& world, EventLog<2>& log) {
        REQUIRE(log.count(Kind::rebound_suppressed) == 1);
        CHECK(world.counters().rebounds_suppressed == 1);
        // Falls 3 at 10 m/s^2, then flights that shrink by e.
        const double fall = std::sqrt(2 * 3.0 / 10);
        CHECK(log.of(Kind::rebound_suppressed)[0].time() == Approx(fall * (1 + e) / (1 - e)).margin(1e-9));
        CHECK(log.events.back().kind == Kind::rebound_suppressed);  // and nothing after it
        CHECK(world.resting(0, 1));
        CHECK(world.motion(1).velocity(100) == Vector3d(0.25, 0, 0));
        CHECK(world.motion(1).coefficients[2] == zero);
        CHECK((world.motion(1).position(100) - Vector3d(25, 0, 1)).cwiseAbs().maxCoeff() < 1e-11);
        CHECK(world.free_motion(1).coefficients[2] == weight);
      });
    }
  }
}

TEST_CASE("Zeno: a ball comes to rest on a wall, and in a corner", "[zeno]") {
  WorldOptions options = elastic();
  options.walls = Walls{{-5, -5, 0}, {5, 5, 10}};
  const auto scene = [&](World<2>& world) {
    world.add_body(bouncy(ball<2>(1, {0, 0, 4}, {0, 0, 0}, weight), 0.5));
    world.add_body(bouncy(ball<2>(1, {3, 3, 4}, {0, 0, 0}, {1, 1, -5}), 0.5));
    world.advance_to(100);
  };
  with_all_methods(options, scene, [&](World<2>& world, EventLog<2>& log) {
    CHECK(world.counters().rebounds_suppressed == 4);
    CHECK(log.count(Kind::wall) < 200);
    CHECK(world.resting_at_wall(0, 4));
    CHECK_FALSE(world.resting_at_wall(0, 1));
    CHECK(at_rest(world, 0));
    CHECK((world.motion(0).position(100) - Vector3d(0, 0, 1)).norm() < 1e-12);
    for (const int wall : {1, 3, 4}) CHECK(world.resting_at_wall(1, wall));
    CHECK(at_rest(world, 1));
    CHECK((world.motion(1).position(100) - Vector3d(4, 4, 1)).norm() < 1e-12);
  });
}

TEST_CASE("Zeno: near a large clock, where doubles are sparse, the run ends too", "[zeno]") {
  for (const double start : {1e6, 1e9}) {
    WorldOptions options = elastic();
    options.start_time = start;
    const double tick = next_up(start) - start;
    const auto scene = [&](World<2>& world) {
      world.add_body(floor_box());
      auto thrown = bouncy(ball<2>(1, {0, 0, 4}, {0, 0, 0}, weight), 0.5);
      thrown.motion[0].start = start;
      world.add_body(thrown);
      world.advance_to(start + 100);
    };
    with_all_methods(options, scene, [&](World<2>& world, EventLog<2>& log) {
      CHECK(log.count(Kind::contact) < 100);
      CHECK(log.count(Kind::rebound_suppressed) == 1);
      CHECK(at_rest(world, 1));
      CHECK(std::abs(world.motion(1).position(start + 100)[2] - 1) < 20 * tick);
    });
  }
}

TEST_CASE("Zeno: on a slope a ball slides down as it should", "[zeno]") {
  for (const double e : {0.0, 0.5}) {
    const double angle = 0.25;
    const auto scene = [&](World<2>& world) {
      auto slope = fixed_body<2>(Box{{80, 80, 1}}, motion<2>({0, 0, 0}));
      slope.orientation = Eigen::AngleAxisd(angle, Vector3d::UnitY());
      world.add_body(slope);
      const Vector3d up(std::sin(angle), 0, std::cos(angle));
      world.add_body(bouncy(body<2>(Sphere{1}, motion<2>(2.0 * up, zero, weight)), e));
      world.advance_to(5);
    };
    with_all_methods(elastic(), scene, [&](World<2>& world, EventLog<2>& log) {
      CHECK(log.count(Kind::rebound_suppressed) == 1);
      const double path = 5 * std::sin(angle) * 25;
      const Vector3d along(std::cos(angle), 0, -std::sin(angle));
      const Vector3d up(std::sin(angle), 0, std::cos(angle));
      CHECK(along.dot(world.motion(1).position(5)) == Approx(path).epsilon(1e-12));
      // It does not sink, and parts by some roundings at most.
      CHECK(up.dot(world.motion(1).position(5)) == Approx(2).margin(1e-11));
    });
  }
}

TEST_CASE("Zeno: a body between fixed ones that close in is let pass, that is reported and the run ends", "[zeno]") {
  for (const double e : {0.0, 0.5, 1.0}) {
    const auto scene = [&](World<2>& world) {
      world.add_body(fixed_body<2>(Box{{50, 50, 1}}, motion<2>({0, 0, -1})));
      world.add_body(fixed_body<2>(Box{{50, 50, 1}}, motion<2>({0, 0, 6}, {0, 0, -1})));
      world.add_body(bouncy(ball<2>(1, {0, 0, 2}, zero, weight), e));
      world.advance_to(20);
    };
    WorldOptions options = elastic();
    options.zeno.interval = 1e-4;  // the elastic ball collapses sooner
    with_all_methods(options, scene, [&](World<2>& world, EventLog<2>& log) {
      INFO("restitution " << e);
      CHECK(log.count(Kind::rebound_suppressed) > 0);
      CHECK(log.count(Kind::contact) < 20000);
      CHECK(std::isfinite(world.motion(2).position(20).norm()));
    });
  }
}

TEST_CASE("Zeno: three balls without gravity collapse into a cluster, momentum is kept", "[zeno]") {
  // Inelastic collapse of three in a line: restitution below 7 - 4 sqrt(3), about 0.072.
  for (const double e : {0.0, 0.05, 0.07}) {
    const auto scene = [&](World<2>& world) {
      world.add_body(bouncy(ball<2>(1, {-4, 0, 0}, {1, 0.5, 0}), e));
      world.add_body(bouncy(ball<2>(1, {0, 2, 0}, {0, 0, 0}), e));
      world.add_body(bouncy(ball<2>(1, {4, 4, 0}, {-1, -0.5, 0}), e));
      world.advance_to(100);
    };
    with_all_methods(elastic(), scene, [&](World<2>& world, EventLog<2>& log) {
      CHECK(log.count(Kind::contact) < 1000);
      Vector3d momentum = zero;
      for (BodyId id = 0; id < 3; ++id) momentum += world.motion(id).velocity(100);
      CHECK(momentum.norm() < 1e-12);
    });
  }
}

}  // namespace
}  // namespace kds::collision::test_zeno
