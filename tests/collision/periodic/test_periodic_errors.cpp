// What a periodic world refuses, in one line that says what is wrong, and without having changed anything.
#include "collision/periodic/periodic_world.hpp"
#include "collision/response/contact_law.hpp"
#include "tests/collision/periodic/periodic_scenes.hpp"
#include "tests/collision/sample_meshes.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>

namespace test_periodic_errors {

using namespace periodic_scenes;
using Catch::Contains;

struct LeavesThem final : ContactLaw {
  void respond(const Meeting&, Velocities&, Velocities&) const override {}
};

std::string refusal(const std::function<void(PeriodicOptions&)>& change) {
  PeriodicOptions options;
  change(options);
  try {
    PeriodicWorld<1> world(options);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "none";
}

TEST_CASE("periodic world: options that are out of range are named") {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(refusal([](auto&) {}) == "none");
  CHECK_THAT(refusal([](auto& o) { o.max[1] = 0; }), Contains("PeriodicOptions.min, max: y of min must be below"));
  CHECK_THAT(refusal([](auto& o) { o.max[0] = -1; }), Contains("x of min must be below that of max"));
  CHECK_THAT(refusal([](auto& o) { o.min[2] = nan; }), Contains("z must be finite"));
  CHECK_THAT(refusal([](auto& o) { o.max[2] = INFINITY; }), Contains("z must be finite"));
  CHECK(refusal([](auto& o) { o.max[2] = INFINITY, o.boundaries[2] = Boundary::open; }) == "none");
  CHECK_THAT(refusal([](auto& o) { o.boundaries[0] = static_cast<Boundary>(7); }), Contains("that of x is unknown"));
  CHECK_THAT(refusal([](auto& o) { o.shear_rate = nan; }), Contains("shear_rate: must be finite"));
  CHECK_THAT(refusal([](auto& o) { o.shear_rate = 1, o.boundaries[1] = Boundary::walls; }),
             Contains("shear_rate: needs periodic x and y"));
  CHECK_THAT(refusal([](auto& o) { o.wall_restitution = 1.5; }), Contains("wall_restitution: must be in [0, 1]"));
  CHECK_THAT(refusal([](auto& o) { o.wall_temperatures[3] = 1; }), Contains("wall_temperatures[3]: there is no wall"));
  CHECK_THAT(refusal([](auto& o) { o.wall_temperatures[3] = -1; }), Contains("wall_temperatures[3]: must be in"));
  CHECK_THAT(refusal([](auto& o) { o.elastic_within = -1; }), Contains("elastic_within: must be finite and >= 0"));
  CHECK_THAT(refusal([](auto& o) { o.world.response = Response::elastic; }), Contains("world.response: must not"));
  static const LeavesThem law;
  CHECK_THAT(refusal([](auto& o) { o.world.law = &law; }), Contains("world.law: must not"));
  CHECK_THAT(refusal([](auto& o) { o.world.walls = Walls{{0, 0, 0}, {1, 1, 1}}; }), Contains("see boundaries"));
  CHECK_THAT(refusal([](auto& o) { o.world.report_pairs = true; }), Contains("not reported"));
  CHECK_THAT(refusal([](auto& o) { o.world.window = 0; }), Contains("window: must be > 0"));
}

TEST_CASE("periodic world: bodies that it cannot have are refused, and nothing is changed") {
  PeriodicOptions options;
  options.max = {2, 3, 4};
  PeriodicWorld<1> world(options);
  const BodyDescription<1> good{.shape = Sphere{0.5}, .motion = {{{{1, 1, 1}, {1, 0, 0}}, 0}}};
  const BodyId body = world.add_body(good);
  const std::size_t in_world = world.world().size();
  const auto refusal_of = [&](const std::function<void(BodyDescription<1>&)>& change) -> std::string {
    BodyDescription<1> bad = good;
    change(bad);
    try {
      world.add_body(bad);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "none";
  };
  CHECK_THAT(refusal_of([](auto& b) { b.shape = Sphere{1}; }),
             Contains("a bounding radius of 1 is not below half the period along x, 2"));
  CHECK_THAT(refusal_of([](auto& b) { b.shape = Box{{0.1, 1.2, 0.1}}; }), Contains("is not below half the period"));
  CHECK_THAT(refusal_of([](auto& b) { b.motion.clear(); }), Contains("motion: has no piece"));
  CHECK_THAT(refusal_of([](auto& b) { b.motion.push_back({{{1, 1, 1}}, 1}); }), Contains("more than one piece"));
  CHECK_THAT(refusal_of([](auto& b) { b.motion[0].start = 1; }), Contains("is after now()"));
  CHECK_THAT(refusal_of([](auto& b) { b.motion[0].coefficients[0][1] = NAN; }), Contains("must be finite"));
  CHECK_THAT(refusal_of([](auto& b) { b.motion[0].coefficients[0][1] = 1e60; }), Contains("2^31 periods away"));
  CHECK_THAT(refusal_of([](auto& b) { b.motion[0].coefficients[0][1] = 1e99; }), Contains("beyond 2^205"));
  CHECK_THAT(refusal_of([](auto& b) { b.sensor = true; }), Contains("sensor"));
  CHECK_THAT(refusal_of([](auto& b) { b.mass = 0; }), Contains("mass"));
  CHECK_THAT(refusal_of([](auto& b) { b.restitution = 2; }), Contains("restitution"));
  CHECK_THAT(refusal_of([](auto& b) { b.category = 1u << 16; }), Contains("category: a periodic world has 16 bits"));
  CHECK(world.size() == 1);
  CHECK(world.world().size() == in_world);
  CHECK_THROWS_WITH(world.update_motion(body, {{{1, 1, 1}, {0, 0, INFINITY}}, 0}), Contains("must be finite"));
  CHECK_THROWS_WITH(world.update_motion(body, {{{1, 1, 1}}, 5}), Contains("after the clock"));
  CHECK(world.velocity(body) == Eigen::Vector3d(1, 0, 0));
  CHECK_THROWS_AS(world.set_restitution(body, -1), std::invalid_argument);
  CHECK_THROWS_WITH(world.step(kds::never), Contains("needs a limit"));
  CHECK_THROWS_WITH(world.advance_to(-1), Contains("not a finite time from now on"));
  world.audit();

  PeriodicWorld<1> far({.min = {1e12, 0, 0}, .max = {1e12 + 64, 8, 8}});
  CHECK_THROWS_WITH(far.add_body(good), Contains("too small for the coordinates of a box of the period along x"));
}

TEST_CASE("periodic world: ids of images and of bodies that were removed") {
  PeriodicOptions options;
  options.max = {4, 4, 4};
  PeriodicWorld<1> world(options);
  const BodyId body = world.add_body({.shape = Sphere{0.5}, .motion = {{{{0.1, 2, 2}}, 0}}});
  REQUIRE(world.world().size() == 2);
  BodyId image = 0;
  world.world().visit_overlapping({4, 0, 0}, {5, 4, 4}, [&](BodyId id) { image = id; });
  CHECK(image != world.in_world(body));
  CHECK((world.owner(image).body == body && world.owner(image).offset == Offset{1, 0, 0}));
  CHECK_FALSE(world.contains(1));
  CHECK_THROWS_WITH(world.motion(1), Contains("no body 1 (generation 0 of slot 1): it has never been there"));
  CHECK_THROWS_AS(world.remove_body(1), std::out_of_range);
  world.remove_body(body);
  CHECK(world.world().size() == 0);
  CHECK_THROWS_WITH(world.motion(body), Contains("no body 0 (generation 0 of slot 0): it was removed"));
  CHECK_THROWS_AS(world.owner(image), std::out_of_range);
  const BodyId next = world.add_body({.shape = Sphere{0.5}, .motion = {{{{2, 2, 2}}, 0}}});
  CHECK(next == body_id(1, 0));
  CHECK_FALSE(world.contains(body));
}

TEST_CASE("periodic world: filters count across the ends too") {
  PeriodicOptions options;
  options.max = {8, 8, 8};
  const auto collide = GENERATE(true, false);
  Log<1> log;
  PeriodicWorld<1> world(options, &log);
  const std::uint32_t mask = collide ? 0xffff : 0xffff & ~4u;
  world.add_body(
      {.shape = Sphere{0.5}, .motion = {{{{1, 4, 4}, {-1, 0, 0}}, 0}}, .category = 2, .collides_with = mask});
  world.add_body({.shape = Sphere{0.5}, .motion = {{{{7, 4, 4}, {1, 0, 0}}, 0}}, .category = 4});
  world.advance_to(2);
  CHECK(log.contacts == (collide ? 1 : 0));
}

TEST_CASE("periodic world: bodies of one group do not meet across the ends either") {
  PeriodicOptions options;
  options.max = {8, 8, 8};
  const std::uint32_t group = GENERATE(0u, 3u, 4u);
  Log<1> log;
  PeriodicWorld<1> world(options, &log);
  world.add_body({.shape = Sphere{0.5}, .motion = {{{{1, 4, 4}, {-1, 0, 0}}, 0}}, .group = 3});
  world.add_body({.shape = Sphere{0.5}, .motion = {{{{7, 4, 4}, {1, 0, 0}}, 0}}, .group = group});
  world.advance_to(2);
  CHECK(log.contacts == (group == 3 ? 0 : 1));
}

TEST_CASE("periodic world: bodies that overlap at the start pass, and are told once") {
  PeriodicOptions options;
  options.max = {4, 4, 4};
  Log<1> log;
  PeriodicWorld<1> world(options, &log);
  world.add_body({.shape = Sphere{0.5}, .motion = {{{{0.1, 2, 2}, {0.5, 0, 0}}, 0}}});
  world.add_body({.shape = Sphere{0.5}, .motion = {{{{3.8, 2, 2}, {0.5, 0, 0}}, 0}}});
  world.advance_to(30);  // both wrap, side by side
  CHECK(log.overlaps == 1);
  CHECK(log.contacts == 0);
  CHECK(log.wraps > 4);
}

}  // namespace test_periodic_errors
