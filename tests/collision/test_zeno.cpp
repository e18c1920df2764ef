// Bodies that come to rest: restitution, endless bounces, and what is held.
#include "tests/collision/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace kds::collision {
namespace {

using namespace tests;

constexpr std::array all_methods{BroadPhaseKind::automatic, BroadPhaseKind::grid, BroadPhaseKind::kinetic_sap,
                                 BroadPhaseKind::sap, BroadPhaseKind::all_pairs};

const Vector3d weight{0, 0, -5};  // half the acceleration

WorldOptions elastic(BroadPhaseKind method = BroadPhaseKind::kinetic_sap) {
  WorldOptions options;
  options.response = Response::elastic;
  options.broad_phase = method;
  options.rate = 16;
  return options;
}

template <int Degree>
BodyDescription<Degree> bouncy(BodyDescription<Degree> body, double restitution, double mass = 1) {
  body.restitution = restitution;
  body.mass = mass;
  return body;
}

/// Its upper face is z = 0.
BodyDescription<2> floor_box(double half = 50) { return fixed_body<2>(Box{{half, half, 1}}, motion<2>({0, 0, -1})); }

/// Runs `scene(world)` with each broad phase, hands each world at the end to `check`, and compares the logs.
void with_all_methods(const WorldOptions& options, const std::function<void(World<2>&)>& scene,
                      const std::function<void(World<2>&, EventLog<2>&)>& check) {
  std::vector<Event> first;
  for (const auto method : all_methods) {
    WorldOptions own = options;
    own.broad_phase = method;
    EventLog<2> log;
    World<2> world(own, &log);
    scene(world);
    world.audit();
    CHECK(in_order_of_time(log.events));
    if (method == all_methods.front()) first = log.events;
    INFO("method " << static_cast<int>(method));
    const bool same = log.events == first;
    CHECK(same);
    check(world, log);
  }
}

bool at_rest(const World<2>& world, BodyId id) {
  return world.motion(id).coefficients[1].isZero(0) && world.motion(id).coefficients[2].isZero(0);
}

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
      CHECK(log.count(Kind::held) == (e == 0 ? 1 : 0));
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
        REQUIRE(log.count(Kind::held) == 1);
        CHECK(world.counters().held == 1);
        // Falls 3 at 10 m/s^2, then flights that shrink by e.
        const double fall = std::sqrt(2 * 3.0 / 10);
        CHECK(log.of(Kind::held)[0].time() == Approx(fall * (1 + e) / (1 - e)).margin(1e-9));
        CHECK(log.events.back().kind == Kind::held);  // and nothing after it
        CHECK(world.held(0, 1));
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
    CHECK(world.counters().held == 4);
    CHECK(log.count(Kind::wall) < 200);
    CHECK(world.held_at_wall(0, 4));
    CHECK_FALSE(world.held_at_wall(0, 1));
    CHECK(at_rest(world, 0));
    CHECK((world.motion(0).position(100) - Vector3d(0, 0, 1)).norm() < 1e-12);
    for (const int wall : {1, 3, 4}) CHECK(world.held_at_wall(1, wall));
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
      CHECK(log.count(Kind::held) == 1);
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
      CHECK(log.count(Kind::held) == 1);
      const double path = 5 * std::sin(angle) * 25;
      const Vector3d along(std::cos(angle), 0, -std::sin(angle));
      const Vector3d up(std::sin(angle), 0, std::cos(angle));
      CHECK(along.dot(world.motion(1).position(5)) == Approx(path).epsilon(1e-12));
      // It does not sink, and parts by some roundings at most.
      CHECK(up.dot(world.motion(1).position(5)) == Approx(2).margin(1e-11));
    });
  }
}

TEST_CASE("Resting: a box slides off the edge and falls, from the instant at which it has left it", "[zeno]") {
  const auto scene = [&](World<2>& world) {
    world.add_body(floor_box(4));
    world.add_body(bouncy(box<2>({0.5, 0.5, 0.5}, {0, 0, 0.5}, {2, 0, 0}, weight), 0));
    world.advance_to(10);
  };
  with_all_methods(elastic(), scene, [&](World<2>& world, EventLog<2>& log) {
    CHECK(log.count(Kind::held) == 1);
    CHECK_FALSE(world.held(0, 1));
    CHECK(world.motion(1).start == Approx(2.25));
    const double fallen = 5 * 7.75 * 7.75;
    CHECK(world.motion(1).position(10)[2] == Approx(0.5 - fallen));
  });
}

TEST_CASE("Resting: the support goes away, comes back, lifts, the body falls, lands, is lifted", "[zeno]") {
  const auto scene = [&](World<2>& world) {
    world.add_body(floor_box());
    world.add_body(bouncy(ball<2>(1, {0, 0, 1}, zero, weight), 0.5));
    world.advance_to(1);
    CHECK(world.held(0, 1));
    // Faster down than the ball follows, for 0.5 s.
    world.update_motion(0, motion<2>({0, 0, -1}, {0, 0, -8}, zero, 1));
    world.advance_to(1.5);
    CHECK_FALSE(world.held(0, 1));
    CHECK(world.motion(1).position(1.5)[2] == Approx(1 - 1.25));
    world.update_motion(0, motion<2>({0, 0, -5}, zero, zero, 1.5));
    world.advance_to(10);
    CHECK(world.held(0, 1));
    CHECK(world.motion(1).position(10)[2] == Approx(-3));
    // Up: it is thrown, comes back, and rides.
    world.update_motion(0, motion<2>({0, 0, -5}, {0, 0, 0.5}, zero, 10));
    world.advance_to(11);
    CHECK(world.held(0, 1));
    CHECK(world.motion(1).velocity(11) == Vector3d(0, 0, 0.5));
    CHECK(world.motion(1).position(11)[2] == Approx(-2.5));
    // The floor is taken away.
    world.remove_body(0);
    world.advance_to(12);
    CHECK(world.motion(1).position(12)[2] == Approx(-2.5 + 0.5 - 5));
  };
  with_all_methods(elastic(), scene, [](World<2>&, EventLog<2>&) {});
}

TEST_CASE("Resting: a floor that sinks with less than gravity carries on, with more it lets go", "[zeno]") {
  for (const double half : {4.0, 6.0}) {
    const auto scene = [&](World<2>& world) {
      world.add_body(floor_box());
      world.add_body(bouncy(ball<2>(1, {0, 0, 1}, zero, weight), 0.5));
      world.advance_to(1);
      world.update_motion(0, motion<2>({0, 0, -1}, zero, {0, 0, -half}, 1));
      world.advance_to(2);
    };
    with_all_methods(elastic(), scene, [&](World<2>& world, EventLog<2>&) {
      CHECK(world.held(0, 1) == (half < 5));
      CHECK(world.motion(1).position(2)[2] == Approx(1 - std::min(half, 5.0)));
    });
  }
}

TEST_CASE("Resting: what lies on the floor may be knocked up, along and down", "[zeno]") {
  const auto scene = [&](World<2>& world) {
    world.add_body(fixed_body<2>(Box{{0.5, 0.5, 1}}, motion<2>({0, 0, -1})));  // a pillar
    world.add_body(bouncy(ball<2>(1, {0, 0, 1}, zero, weight), 0.5));
    world.add_body(ball<2>(0.25, {-4, 0, -2}, {3.25, 0, 2.5}));  // from below, past the pillar
    world.advance_to(10);
  };
  with_all_methods(elastic(), scene, [](World<2>& world, EventLog<2>& log) {
    const auto contacts = log.of(Kind::contact);
    REQUIRE(contacts.size() >= 2);
    const auto hit = std::find_if(contacts.begin(), contacts.end(), [](const Event& e) { return e.a == 1; });
    REQUIRE(hit != contacts.end());
    CHECK(hit->contact.normal[2] < 0);  // from the large ball down to the small one
    CHECK(world.motion(1).coefficients[2] == weight);
    CHECK_FALSE(world.held(0, 1));
  });
}

TEST_CASE("Resting: what falls on a body at rest does not press it through the floor", "[zeno]") {
  for (const double mass : {0.01, 1.0, 100.0}) {
    const auto scene = [&](World<2>& world) {
      world.add_body(floor_box());
      world.add_body(bouncy(box<2>({1, 1, 1}, {0, 0, 1}, zero, weight), 0.5));
      world.add_body(bouncy(box<2>({1, 1, 1}, {0.5, 0.5, 8}, zero, weight), 0.5, mass));
      double lowest = 1;
      while (world.step(30)) lowest = std::min(lowest, world.motion(1).position(world.now())[2]);
      CHECK(lowest > 1 - 1e-9);
    };
    with_all_methods(elastic(), scene, [&](World<2>& world, EventLog<2>& log) {
      INFO("mass " << mass);
      CHECK(log.count(Kind::held) >= 3);
      CHECK(at_rest(world, 1));
      CHECK(at_rest(world, 2));
      CHECK(std::abs(world.motion(1).position(30)[2] - 1) < 1e-9);
      CHECK(std::abs(world.motion(2).position(30)[2] - 3) < 1e-9);
    });
  }
}

TEST_CASE("Resting: an elastic blow goes through a body at rest on the floor and comes back", "[zeno]") {
  const auto scene = [&](World<2>& world) {
    world.add_body(floor_box());
    world.add_body(ball<2>(1, {0, 0, 1}, zero, weight));
    world.advance_to(1);
    auto blow = ball<2>(1, {0, 0, 8}, {0, 0, -7});  // weightless
    blow.motion[0].start = 1;
    world.add_body(blow);
    world.advance_to(1.25);
    CHECK(world.held(0, 1));
    world.advance_to(1.75);
  };
  with_all_methods(elastic(), scene, [](World<2>& world, EventLog<2>&) {
    // Down at 7, through the ball, back from the floor, and up again.
    CHECK(world.motion(2).velocity(1.75)[2] == Approx(7));
    CHECK(world.motion(2).position(1.75)[2] == Approx(3 + 7 * (0.75 - 5 / 7.0)));
  });
}

TEST_CASE("Resting: two balls, one upon the other, and a pile of three boxes", "[zeno]") {
  for (const double e : {0.0, 0.3, 0.8}) {
    for (const bool balls : {true, false}) {
      const auto scene = [&](World<2>& world) {
        world.add_body(floor_box());
        const std::vector<double> masses = balls ? std::vector<double>{1, 2} : std::vector<double>{1, 4, 0.3};
        for (std::size_t i = 0; i < masses.size(); ++i) {
          const Vector3d at(balls ? 0 : 0.25 * static_cast<double>(i), 0, 3 + 3 * static_cast<double>(i));
          world.add_body(balls ? bouncy(ball<2>(1, at, zero, weight), e, masses[i])
                               : bouncy(box<2>({1, 1, 1}, at, zero, weight), e, masses[i]));
        }
        world.advance_to(40);
        const auto events = world.counters().contacts;
        world.advance_to(1000);
        CHECK(world.counters().contacts == events);
      };
      with_all_methods(elastic(), scene, [&](World<2>& world, EventLog<2>& log) {
        INFO("restitution " << e << (balls ? ", balls" : ", boxes"));
        CHECK(log.count(Kind::held) >= world.size() - 1);
        CHECK(log.count(Kind::contact) < 20000);
        for (BodyId id = 1; id < world.size(); ++id) {
          CHECK(world.held(id - 1, id));
          CHECK(at_rest(world, id));
          CHECK(std::abs(world.motion(id).position(1000)[2] - (2.0 * id - 1)) < 1e-9);
        }
      });
    }
  }
}

TEST_CASE("Resting: the lowest of a pile is taken away and the rest lands on the floor", "[zeno]") {
  const auto scene = [&](World<2>& world) {
    world.add_body(floor_box());
    for (int i = 0; i < 4; ++i) world.add_body(bouncy(box<2>({1, 1, 1}, {0, 0, 1 + 2.0 * i}, zero, weight), 0.25));
    world.advance_to(1);
    for (BodyId id = 1; id <= 4; ++id) CHECK(world.held(id - 1, id));
    world.remove_body(1);
    world.advance_to(1.5);
    CHECK(world.motion(4).position(1.5)[2] == Approx(7 - 5 * 0.25));  // all fall as one
    world.advance_to(30);
  };
  with_all_methods(elastic(), scene, [](World<2>& world, EventLog<2>&) {
    for (BodyId id = 2; id <= 4; ++id) {
      CHECK(at_rest(world, id));
      CHECK(std::abs(world.motion(id).position(30)[2] - (2.0 * id - 3)) < 1e-9);
    }
  });
}

TEST_CASE("Resting: a ball slides over a ball and off it", "[zeno]") {
  const auto scene = [&](World<2>& world) {
    world.add_body(fixed_body<2>(Sphere{2}, motion<2>(zero)));
    world.add_body(bouncy(ball<2>(1, {0.125, 0, 3.25}, zero, weight), 0.25));
    double least = 3;
    while (world.step(3)) least = std::min(least, world.motion(1).position(world.now()).norm());
    CHECK(least > 3 - 1e-9);
  };
  with_all_methods(elastic(), scene, [](World<2>& world, EventLog<2>& log) {
    // Without friction it leaves where cos(angle) = 2/3; energy tells its speed (bounces have cost some).
    const Event last = log.events.back();
    CHECK(last.contact.normal[2] == Approx(2.0 / 3).margin(0.02));
    CHECK(world.motion(1).coefficients[2] == weight);
    CHECK(log.count(Kind::contact) < 20000);
  });
}

TEST_CASE("Resting: meshes rest on meshes and slide into what stands in the way", "[zeno]") {
  // A step: two cubes side by side, the right one higher; as one mesh.
  const auto step = [] {
    std::vector<Vector3d> vertices;
    std::vector<Mesh::Triangle> triangles;
    const auto& one = *cube();
    for (const Vector3d& at : {Vector3d(-1, 0, -1), Vector3d(1, 0, 0)}) {
      const auto first = static_cast<std::uint32_t>(vertices.size());
      for (const auto& v : one.vertices()) vertices.push_back(v + at);
      for (const auto& t : one.triangles()) triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    }
    return std::make_shared<const Mesh>(vertices, triangles);
  }();
  for (const Shape& slider : {Shape(Sphere{0.25}), Shape(Box{{0.25, 0.25, 0.25}})}) {
    const auto scene = [&](World<2>& world) {
      world.add_body(fixed_body<2>(MeshShape{step, 1}, motion<2>(zero)));
      world.add_body(bouncy(body<2>(slider, motion<2>({-1, 0, 0.5}, {0.5, 0, 0}, weight)), 0.5));
      world.advance_to(3);
    };
    with_all_methods(elastic(), scene, [&](World<2>& world, EventLog<2>& log) {
      REQUIRE(log.count(Kind::held) >= 1);
      // At x = 0 it meets the face of the higher cube and goes back at half the speed, still on the lower one.
      const auto contacts = log.of(Kind::contact);
      const auto hit = std::find_if(contacts.begin(), contacts.end(),
                                    [](const Event& e) { return std::abs(e.contact.normal[0]) > 0.99; });
      REQUIRE(hit != contacts.end());
      CHECK(hit->time() == Approx(1.5).margin(1e-6));
      CHECK(world.motion(1).velocity(3)[0] == Approx(-0.25));
      CHECK(world.motion(1).position(3)[2] == Approx(0.25).margin(1e-5));
    });
  }
}

TEST_CASE("Zeno: a body between fixed ones that close in cannot be held, that is reported and the run ends", "[zeno]") {
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
      CHECK(log.count(Kind::held) > 0);
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
}  // namespace kds::collision
