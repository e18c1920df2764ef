// The world where thousands of events fall on one instant, where an ulp decides, and where numbers are extreme; each
// with every broad phase.
#include "tests/collision/counted_runs.hpp"
#include "tests/collision/random_scenes.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

namespace kds::collision::test_stress_world {
namespace {

using namespace tests;

WorldOptions with(Response response, double rate = 16) {
  WorldOptions options;
  options.response = response;
  options.rate = rate;
  return options;
}

/// Runs the scene with each broad phase and returns the events, which must be the same.
template <int Degree>
std::vector<Event> run_all(const std::vector<BodyDescription<Degree>>& bodies, WorldOptions options, double end,
                           const std::function<void(World<Degree>&)>& finally = {}) {
  std::vector<Event> first;
  for (const auto method : all_methods) {
    options.broad_phase = method;
    EventLog<Degree> log;
    World<Degree> world(options, &log);
    for (const auto& b : bodies) world.add_body(b);
    world.advance_to(options.start_time + end);
    world.audit();
    if (finally) finally(world);
    auto& events = log.events;
    const bool in_order = in_order_of_time(log.events);
    CHECK(in_order);
    if (method == all_methods.front()) {
      first = std::move(events);
    } else {
      INFO("method " << static_cast<int>(method) << ", " << events.size() << " events, " << first.size()
                     << " expected");
      const bool same = events == first;
      CHECK(same);
    }
  }
  return first;
}

template <int Degree>
void add_lattice(std::vector<BodyDescription<Degree>>& bodies, int n, const Shape& shape, const Vector3d& corner,
                 double spacing, const Vector3d& velocity) {
  for (int i = 0; i < n * n * n; ++i) {
    const Vector3d cell(i % n, i / n % n, i / (n * n));
    bodies.push_back(body<Degree>(shape, motion<Degree>(corner + spacing * cell, velocity)));
  }
}

TEST_CASE("stress: two lattices fly into each other, thousands of contacts at one instant", "[world][stress]") {
  for (const Shape& shape : {Shape(Sphere{0.5}), Shape(Box{{0.5, 0.5, 0.5}})}) {
    const int n = std::holds_alternative<Sphere>(shape) ? 7 : 4;
    // Touching in the lattice, and aligned: rows meet head on at t = 1.
    std::vector<BodyDescription<1>> bodies;
    add_lattice(bodies, n, shape, {0, 0, 0}, 1, {1, 0, 0});
    add_lattice(bodies, n, shape, {n + 2.0, 0, 0}, 1, {-1, 0, 0});
    // Each row of n passes its motion through the other row: n x n contacts in each of n x n rows, all at once.
    const auto bounced = run_all<1>(bodies, with(Response::elastic), 3, [](World<1>& world) {
      for (BodyId id = 0; id < world.size(); ++id) {
        const bool left = id < world.size() / 2;
        if (world.motion(id).velocity(3) != Vector3d(left ? -1 : 1, 0, 0)) FAIL("body " << id);
      }
    });
    CHECK(bounced.size() == static_cast<std::size_t>(n * n * n * n));
    CHECK(std::all_of(bounced.begin(), bounced.end(), [](const Event& e) { return e.time() == 1; }));
    // Passing: spaced by one, each meets the other's row at integer and half-integer times.
    bodies.clear();
    add_lattice(bodies, 4, shape, {0, 0, 0}, 2, {1, 0, 0});
    add_lattice(bodies, 4, shape, {8, 0, 0}, 2, {-1, 0, 0});
    const auto passed = run_all<1>(bodies, with(Response::none), 20);
    CHECK(count(passed, Kind::contact) == 16 * 16);
    CHECK(count(passed, Kind::separation) == 16 * 16);
  }
}

TEST_CASE("stress: Newton's cradle, touching or spaced, linear or thrown: momentum goes through", "[world][stress]") {
  constexpr std::size_t n = 60;
  for (const double gap : {0.0, 0x1p-10, 0x1p-40, 0.1}) {
    for (const double mass : {1.0, 3.0}) {
      std::vector<BodyDescription<2>> bodies;
      for (std::size_t i = 0; i < n; ++i) {
        const double place = i * (2 + gap) - (i == 0 ? 2 : 0);
        bodies.push_back(ball<2>(1, {place, 0, 0}, {i == 0 ? 2.0 : 0.0, 1, 0}, {0, 0, -5}));
        bodies.back().mass = mass;
      }
      const auto events = run_all<2>(bodies, with(Response::elastic), 8, [&](World<2>& world) {
        for (std::size_t i = 0; i < n; ++i) {
          const double speed = world.motion(i).velocity(8)[0];
          if (std::abs(speed - (i == n - 1 ? 2 : 0)) > 1e-12) FAIL("ball " << i << " at " << speed << ", gap " << gap);
          CHECK(world.counters().rebounds_suppressed == 0);
        }
      });
      CHECK(events.size() == n - 1);
      CHECK(std::is_sorted(events.begin(), events.end(), [](const Event& x, const Event& y) { return x.a < y.a; }));
    }
  }
}

TEST_CASE("stress: Newton's cradle without full restitution passes on what it should", "[world][stress]") {
  // Each of n contacts leaves (1 + e) / 2 of the speed to the next ball.
  constexpr std::size_t n = 12;
  const double e = 0.75;
  std::vector<BodyDescription<1>> bodies;
  for (std::size_t i = 0; i < n; ++i) {
    bodies.push_back(ball<1>(1, {2.5 * i, 0, 0}, {i == 0 ? 1.0 : 0.0, 0, 0}));
    bodies.back().restitution = e;
  }
  const auto scene_end = 200.0;
  run_all<1>(bodies, with(Response::elastic), scene_end, [&](World<1>& world) {
    double momentum = 0;
    for (std::size_t i = 0; i < n; ++i) momentum += world.motion(i).velocity(scene_end)[0];
    CHECK(momentum == Approx(1));
    CHECK(world.motion(n - 1).velocity(scene_end)[0] == Approx(std::pow((1 + e) / 2, n - 1)).epsilon(0.05));
  });
}

TEST_CASE("stress: balls in a box whose six sides close in: reported, and the run ends", "[world][stress]") {
  for (const double e : {0.5, 1.0}) {
    std::vector<BodyDescription<1>> bodies;
    for (int side = 0; side < 6; ++side) {
      Vector3d out = zero;
      out[side / 2] = side % 2 == 0 ? -1 : 1;
      Vector3d half = Vector3d::Constant(8);
      half[side / 2] = 1;
      bodies.push_back(fixed_body<1>(Box{half}, motion<1>(5.0 * out, -1.0 * out)));
    }
    for (int i = 0; i < 8; ++i) {
      bodies.push_back(
          ball<1>(0.5, {i % 2 * 2.0 - 1, i / 2 % 2 * 2.0 - 1, i / 4 * 2.0 - 1}, {0.5 - i % 3, 0.25 * i, 1}));
      bodies.back().restitution = e;
    }
    // Only balls count; the sides pass through each other.
    for (int side = 0; side < 6; ++side) bodies[static_cast<std::size_t>(side)].category = 2;
    for (int side = 0; side < 6; ++side) bodies[static_cast<std::size_t>(side)].collides_with = 1;
    WorldOptions options = with(Response::elastic);
    options.zeno = {.contacts = 20, .interval = 1e-2};
    const auto events = run_all<1>(bodies, options, 6);
    INFO("restitution " << e);
    CHECK(count(events, Kind::rebound_suppressed) > 0);
    CHECK(events.size() < 20000);
  }
}

TEST_CASE("stress: near-parallel motions that cross at 1e-15", "[world][stress]") {
  const std::uint64_t seed = 600;
  CAPTURE(seed);
  Random random(seed);
  for (int round = 0; round < 40; ++round) {
    // Both at speed about 1; the relative speed is some ulps, the gap some 1e-15. Coordinates are multiples of 2^-52,
    // so the times are quotients of small integers.
    const int ulps = random.integer(1, 9);
    const int gap = random.integer(0, 20);
    const double slow = 1;
    const double fast = 1 + ulps * 0x1p-52;
    for (const Shape& shape : {Shape(Sphere{0.5}), Shape(Box{{0.5, 0.5, 0.5}})}) {
      const std::vector<BodyDescription<1>> bodies{body<1>(shape, motion<1>({-1, 0, 0}, {fast, 0, 0})),
                                                   body<1>(shape, motion<1>({gap * 0x1p-52, 0, 0}, {slow, 0, 0}))};
      const auto events = run_all<1>(bodies, with(Response::none, 0.5), 100);
      // Touching at the start and closing in is an overlap at t+; else they meet at gap / ulps.
      REQUIRE(events.size() == 1);
      CHECK(events[0].kind == (gap == 0 ? Kind::overlap : Kind::contact));
      const double exact = static_cast<double>(gap) / ulps;  // rounded; the contact is the first double not before it
      const bool right = events[0].time() == exact || events[0].time() == next_up(exact);
      if (!right) FAIL("contact at " << events[0].time() << ", not " << exact);
    }
  }
}

TEST_CASE("stress: paths that touch with discriminant 0 and an ulp to either side", "[world][stress]") {
  const std::uint64_t seed = 610;
  CAPTURE(seed);
  Random random(seed);
  for (int round = 0; round < 30; ++round) {
    const double radius = random.integer(1, 64) / 16.0;
    const double other = random.integer(1, 64) / 16.0;
    const double sum_of_radii = radius + other;
    for (const double distance : {next_down(sum_of_radii), sum_of_radii, next_up(sum_of_radii)}) {
      const bool meets = distance < sum_of_radii;
      // A ball passes a ball along x at that distance.
      const std::vector<BodyDescription<1>> passing{ball<1>(radius, {0, 0, 0}),
                                                    ball<1>(other, {-8, distance, 0}, {2, 0, 0})};
      const auto passed = run_all<1>(passing, with(Response::none), 8);
      if (count(passed, Kind::contact) != meets) FAIL("passing at " << distance << ", sum of radii " << sum_of_radii);
      if (count(passed, Kind::separation) != meets) FAIL("no end of passing at " << distance);
      // A ball is thrown up under a ball or box, 4 high, and turns at that distance.
      for (const Shape& target : {Shape(Sphere{radius}), Shape(Box{{radius, radius, radius}})}) {
        for (const auto response : {Response::none, Response::elastic}) {
          const std::vector<BodyDescription<2>> thrown{fixed_body<2>(target, motion<2>({0, 0, 4 + distance})),
                                                       ball<2>(other, {0, 0, 0}, {0, 0, 4}, {0, 0, -1})};
          // The target's place is rounded: it may be that of another distance.
          const bool reaches = (4 + distance) - 4 < sum_of_radii;
          const auto events = run_all<2>(thrown, with(response), 5);
          if (count(events, Kind::contact) != reaches)
            FAIL("thrown to " << distance << ", sum of radii " << sum_of_radii);
        }
      }
    }
  }
}

TEST_CASE("stress: motions that callbacks change exactly at event times", "[world][stress]") {
  // What is changed depends on the event alone, so that it is the same whatever the order of one instant.
  const std::uint64_t seed = 620;
  CAPTURE(seed);
  for (std::uint64_t round = 0; round < 4; ++round) {
    const auto numbers = round % 2 == 0 ? Numbers::coarse : Numbers::fine;
    Random random(seed + round);
    SceneMaker maker(random, {.shapes = round < 2 ? Shapes::spheres : Shapes::boxes,
                              .numbers = numbers,
                              .bodies = 24,
                              .side = 6,
                              .end_time = 6});
    const auto scene = maker.scene<1>();
    std::vector<Event> first;
    for (const auto method : all_methods) {
      WorldOptions options = with(Response::elastic);
      options.broad_phase = method;
      options.walls = Walls{{-2, -2, -2}, {8, 8, 8}};
      EventLog<1> log;
      std::size_t edits = 0;
      log.then = [&](World<1>& world, const Event& e) {
        if (e.kind != Kind::contact) return;
        const auto bits = static_cast<std::uint64_t>(lattice_index(e.time())) * 0x9e3779b97f4a7c15ull;
        if (bits >> 63 != 0) return;
        const BodyId other = (e.a + 1 + e.b) % world.size();
        auto changed = world.free_motion(other).restarted(e.time());
        changed.coefficients[1] = Vector3d(changed.coefficients[1][1], -changed.coefficients[1][0], 0.5);
        world.update_motion(other, changed);
        ++edits;
      };
      World<1> world(options, &log);
      for (const auto& b : scene.bodies) world.add_body(b);
      while (world.step(scene.end_time)) world.audit();
      const auto& events = log.events;
      if (method == all_methods.front()) first = events;
      const bool same = events == first;
      INFO("round " << round << ", method " << static_cast<int>(method) << ", " << edits << " edits");
      CHECK(edits > 0);
      CHECK(same);
    }
  }
}

TEST_CASE("stress: scenes whose numbers are all tiny, all huge, or equal", "[world][stress]") {
  // Scaled by powers of two in length and time, a scene has the same events at scaled times.
  struct Scale {
    double length, time;
  };
  const auto events_of = [](const Scale& scale) {
    Random random(630);
    std::vector<BodyDescription<1>> bodies;
    for (int i = 0; i < 24; ++i) {
      const Vector3d at(random.between(0, 4), random.between(0, 4), random.between(0, 4));
      const Vector3d speed(random.between(-2, 2), random.between(-2, 2), random.between(-2, 2));
      const double size = random.between(0.25, 0.5) * scale.length;
      const Shape shape = i % 2 == 0 ? Shape(Sphere{size}) : Shape(Box{{size, size, size}});
      bodies.push_back(body<1>(shape, motion<1>(at * scale.length, speed * (scale.length / scale.time))));
    }
    return run_all<1>(bodies, with(Response::none, 16 / scale.time), 4 * scale.time);
  };
  const auto expected = events_of({1, 1});
  CHECK(count(expected, Kind::contact) > 5);
  for (const Scale& scale : {Scale{0x1p-100, 1}, Scale{0x1p100, 1}, Scale{1, 0x1p-100}, Scale{1, 0x1p100},
                             Scale{0x1p-200, 0x1p-100}, Scale{0x1p200, 0x1p100}}) {
    const auto found = events_of(scale);
    INFO("length " << scale.length << ", time " << scale.time);
    REQUIRE(found.size() == expected.size());
    bool same = true;
    for (std::size_t i = 0; i < found.size(); ++i) {
      same = same && found[i].kind == expected[i].kind && found[i].a == expected[i].a && found[i].b == expected[i].b &&
             found[i].time() == expected[i].time() * scale.time;
    }
    CHECK(same);
  }
  // All equal: bodies in one place with one motion.
  const std::vector<BodyDescription<2>> equal(
      20, box<2>({0.1, 0.1, 0.1}, {0.1, 0.1, 0.1}, {0.1, 0.1, 0.1}, {0.1, 0.1, 0.1}));
  const auto one = run_all<2>(equal, with(Response::none), 10);
  CHECK(count(one, Kind::overlap) == 20 * 19 / 2);
  CHECK(one.size() == 20 * 19 / 2);
}

}  // namespace
}  // namespace kds::collision::test_stress_world
