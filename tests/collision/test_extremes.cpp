// Large clocks, and sizes that are far apart.
#include "tests/collision/counted_runs.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

namespace kds::collision::test_extremes {
namespace {

using namespace tests;

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
  CHECK(log.count(Kind::rebound_suppressed) == 0);
  for (BodyId id = 0; id < 8; ++id) {
    CHECK(world.motion(id).position(world.now()).cwiseAbs().maxCoeff() < 4 + 1e-5);
  }
}

TEST_CASE("A step without a limit ends, however short the window, and finds what there is", "[degenerate]") {
  constexpr double late = 1e9;
  for (const double window : {1e-9, 1e-7, 0.25, 100.0}) {
    for (const auto method : all_methods) {
      if (method == BroadPhaseKind::sap) continue;  // asks for a limit
      INFO("window " << window << ", method " << static_cast<int>(method));
      WorldOptions options = with(Response::none, method);
      options.start_time = late;
      options.window = window;
      EventLog<1> log;
      World<1> world(options, &log);
      CHECK_FALSE(world.step());  // nothing there
      for (auto b : two_balls()) {
        b.motion[0].start = world.now();
        world.add_body(b);
      }
      const double start = world.now();
      while (world.step()) {
      }
      REQUIRE(log.count(Kind::contact) == 1);
      REQUIRE(log.count(Kind::separation) == 1);
      CHECK(log.of(Kind::contact)[0].time() == Approx(start + 1).epsilon(1e-15));
      CHECK(log.of(Kind::separation)[0].time() == Approx(start + 3).epsilon(1e-15));
      CHECK_FALSE(world.step());
    }
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

/// The scene with all lengths, speeds and accelerations times a power of two: the same, in other units.
template <int Degree>
Scene<Degree> in_units(Scene<Degree> scene, int exponent) {
  const double unit = std::ldexp(1, exponent);
  for (auto& b : scene.bodies) {
    if (auto* const ball = std::get_if<Sphere>(&b.shape)) ball->radius *= unit;
    if (auto* const box = std::get_if<Box>(&b.shape)) box->half_extents *= unit;
    if (auto* const mesh = std::get_if<MeshShape>(&b.shape)) mesh->scale *= unit;
    for (auto& piece : b.motion) {
      for (auto& c : piece.coefficients) c *= unit;
    }
  }
  return scene;
}

TEMPLATE_TEST_CASE_SIG("Very small and very large units: the same events, to the bit", "[extreme]",
                       ((int Degree), Degree), 1, 2) {
  for (const auto shapes : {Shapes::spheres, Shapes::boxes, Shapes::mixture, Shapes::cubes}) {
    const bool meshes = shapes == Shapes::mixture || shapes == Shapes::cubes;
    for (const int exponent : {meshes ? -100 : -200, -60, 60, meshes ? 95 : 200}) {
      for (std::uint64_t seed = 1; seed <= 2; ++seed) {
        INFO(name(shapes) << ", unit 2^" << exponent << ", seed " << seed);
        Random random(seed);
        SceneMaker maker(random, {.shapes = shapes, .bodies = 8, .side = 5, .end_time = 2});
        const auto scene = maker.scene<Degree>();
        for (const auto method : {BroadPhaseKind::automatic, BroadPhaseKind::kinetic_sap}) {
          for (const auto response : {Response::none, Response::elastic}) {
            const auto events = run(scene, with(response, method));
            const auto scaled = run(in_units(scene, exponent), with(response, method));
            REQUIRE(scaled.size() == events.size());
            for (std::size_t i = 0; i < events.size(); ++i) {
              CHECK(scaled[i].kind == events[i].kind);
              CHECK(scaled[i].a == events[i].a);
              CHECK(scaled[i].b == events[i].b);
              CHECK(scaled[i].time() == events[i].time());
              CHECK(scaled[i].contact.normal == events[i].contact.normal);
            }
          }
        }
      }
    }
  }
}

template <class F>
void refuses(F&& f, const std::string& what) {
  INFO(what);
  try {
    f();
    FAIL("nothing was thrown");
  } catch (const std::invalid_argument& error) {
    CHECK(std::string(error.what()).find(what) == 0);
  }
}

TEST_CASE("Numbers out of range are refused by name, and the world goes on", "[extreme]") {
  World<2> world({});
  const auto refuse = [&](auto&& change, const std::string& what) {
    auto description = ball<2>(1, zero);
    change(description);
    refuses([&] { world.add_body(description); }, what);
  };
  using Description = BodyDescription<2>;
  for (const double size : {1e-320, 1e-300, 1e-200, 0x1p-206, 0x1p206, 1e155, 1e170, 1e308}) {
    refuse([&](Description& b) { b.shape = Sphere{size}; }, "radius: ");
    refuse([&](Description& b) { b.shape = Box{{1, size, 1}}; }, "half_extents: ");
    refuse([&](Description& b) { b.mass = size; }, "mass: ");
  }
  for (const double scale : {1e-320, 1e-200, 1e-172, 1e-162, 1e-50, 1e-34, 1e31, 1e60, 1e200}) {
    refuse([&](Description& b) { b.shape = MeshShape{tetrahedron(), scale}; }, "scale: ");
  }
  for (const double large : {0x1p206, -1e155, 1e308, -1e308}) {
    refuse([&](Description& b) { b.motion[0].coefficients[0][1] = large; }, "motion[0].coefficients[0]: ");
    refuse([&](Description& b) { b.motion[0].coefficients[1][0] = large; }, "motion[0].coefficients[1]: ");
    refuse([&](Description& b) { b.motion[0].coefficients[2][2] = large; }, "motion[0].coefficients[2]: ");
    refuse([&](Description& b) { b.motion[0].start = large; }, "motion[0].start: ");
    WorldOptions options;
    options.start_time = large;
    refuses([&] { World<1> late(options); }, "WorldOptions.start_time: ");
  }
  CHECK(world.size() == 0);
  // At the ends of the range, and what is small but no size, all is well.
  for (const double size : {smallest_size, 0.25 * largest_magnitude}) {
    const auto a = world.add_body(ball<2>(size, {-3 * size, 0, 0}, {size, 0, 0}));
    const auto b = world.add_body(ball<2>(size, zero, {0, 5e-324, 0}, {0, 0, 5e-324}));
    world.update_motion(a, motion<2>({-3 * size, 0, 0}, {0.5 * size, 0, 0}, zero, world.now()));
    refuses(
        [&] {
          world.update_motion(b, motion<2>({1e62, 0, 0}, zero, zero, world.now()));
        },
        "World::update_motion: motion.coefficients[0]: ");
    const double nan = std::numeric_limits<double>::quiet_NaN();
    refuses(
        [&] {
          world.update_motion(b, motion<2>({nan, 0, 0}, zero, zero, world.now()));
        },
        "World::update_motion: motion: must be finite");
    const double start = world.now();
    world.advance_to(start + 2.5);
    CHECK(world.touching(a, b));
    world.remove_body(a), world.remove_body(b);
  }
}

TEST_CASE("Meshes at the ends of their range meet as others do", "[extreme]") {
  for (const double scale : {0x1p-110, 0x1p-90, 1.0, 0x1p90, 0x1p100}) {
    for (const auto method : all_methods) {
      WorldOptions options = with(Response::none, method);
      INFO("scale " << scale << ", method " << static_cast<int>(method));
      const auto events =
          run(Scene<1>{{body<1>(MeshShape{tetrahedron(), scale}, motion<1>(zero, {scale, 0, 0})),
                        body<1>(MeshShape{tetrahedron(), scale}, motion<1>({6 * scale, 0.1 * scale, 0.2 * scale}))},
                       20},
              options);
      const auto contacts = contacts_of(events);
      REQUIRE(contacts.size() == 1);
      CHECK(contacts[0].time() == Approx(4));
    }
  }
}

}  // namespace
}  // namespace kds::collision::test_extremes
