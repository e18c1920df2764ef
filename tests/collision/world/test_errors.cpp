// What the world refuses, and that it goes on.
#include "collision/response/contact_law.hpp"
#include "tests/collision/random_scenes.hpp"
#include "tests/support/throws.hpp"

#include <catch2/catch.hpp>

#include <cfenv>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace kds::collision::test_errors {
namespace {

using namespace tests;
using kds::tests::throws;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

struct LeavesThem final : ContactLaw {
  void respond(const Meeting&, Velocities&, Velocities&) const override {}
};

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
  refuse([](WorldOptions& o) { o.zeno.contacts = 0; }, "zeno.contacts");
  static const LeavesThem law;
  for (const Response response : {Response::none, Response::elastic}) {
    refuse([&](WorldOptions& o) { o.response = response, o.law = &law; }, "WorldOptions.law: needs response callback");
  }
  for (const double rate : {0.0, -1.0, nan, never, 1e-310}) {
    refuse([&](WorldOptions& o) { o.broad_phase = BroadPhaseKind::sap, o.rate = rate; }, "rate");
  }
  for (const auto method : all_methods) {
    for (const double rate : {-5.0, nan, never, -never}) {
      refuse([&](WorldOptions& o) { o.broad_phase = method, o.rate = rate; }, "WorldOptions.rate");
    }
    for (const int kdop : {-6, 0, 5, 7, 12, 27}) {
      refuse([&](WorldOptions& o) { o.broad_phase = method, o.rate = 1, o.kdop = kdop; }, "WorldOptions.kdop");
    }
    if (method == BroadPhaseKind::kinetic_sap) continue;
    refuse([&](WorldOptions& o) { o.broad_phase = method, o.rate = 1, o.kdop = 18; }, "WorldOptions.kdop");
  }
  refuse([](WorldOptions& o) { o.start_time = -never; }, "start_time");
  refuse([](WorldOptions& o) { o.window = -never; }, "window");
  refuse([](WorldOptions& o) { o.walls = Walls{{0, 0, 0}, {1, never, 1}}; }, "walls");
  refuse([](WorldOptions& o) { o.response = static_cast<Response>(77); }, "WorldOptions.response");
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
  refuse([](D& d) { d.volume = static_cast<BoundingVolume>(77); }, "volume");
  refuse([](D& d) { d.motion.push_back(d.motion[0]); }, "motion[1].start");
  refuse([](D& d) { d.motion.push_back(d.motion[0]), d.motion[1].start = -1; }, "motion[1].start");
  refuse([](D& d) { d.orientation.coeffs() *= 1.01; }, "orientation");
  refuse([](D& d) { d.orientation.coeffs().setZero(); }, "orientation");

  throws([&] { world.update_motion(0, motion<2>({nan, 0, 0})); }, "update_motion");
  throws([&] { world.update_motion(0, motion<2>({0, 0, 0}, zero, zero, never)); }, "update_motion");
  throws([&] { world.update_motion(0, motion<2>({0, 0, 0}, zero, zero, 1)); }, "starts at 1, after the clock");
  CHECK_THROWS_AS(world.update_motion(2, motion<2>({0, 0, 0})), std::out_of_range);
  CHECK_THROWS_AS(world.remove_body(2), std::out_of_range);
  CHECK_THROWS_AS(world.motion(2), std::out_of_range);
  CHECK_THROWS_AS(world.shape(2), std::out_of_range);
  CHECK_THROWS_AS(world.touching(0, 2), std::out_of_range);
  CHECK_THROWS_AS(world.touching(2, 0), std::out_of_range);
  CHECK_THROWS_AS(world.resting(0, 2), std::out_of_range);
  CHECK_THROWS_AS(world.resting(2, 0), std::out_of_range);
  CHECK_THROWS_AS(world.free_motion(2), std::out_of_range);
  CHECK_THROWS_AS(world.mass(2), std::out_of_range);
  CHECK_THROWS_AS(world.fixed(2), std::out_of_range);
  CHECK_THROWS_AS(world.resting_at_wall(2, 0), std::out_of_range);
  for (const int wall : {-1, 6, 17}) CHECK_THROWS_AS(world.resting_at_wall(0, wall), std::out_of_range);
  for (int wall = 0; wall < 6; ++wall) CHECK_FALSE(world.resting_at_wall(0, wall));
  CHECK_THROWS_AS(world.reserve(std::size_t{1} << 33), std::length_error);
  world.advance_to(0.5);
  throws([&] { world.advance_to(0.25); }, "advance_to");
  throws([&] { world.advance_to(nan); }, "advance_to");
  throws([&] { world.advance_to(never); }, "advance_to");
  throws([&] { world.step(nan); }, "step");
  throws([&] { world.advance_for(1, 0.25); }, "advance_for");
  throws([&] { world.advance_for(1, nan); }, "advance_for");
  throws([&] { world.advance_for(1, never); }, "advance_for");
  for (const double budget : {-1.0, nan, -never})
    throws([&] { world.advance_for(budget, 1); }, "advance_for: a budget");

  CHECK(world.size() == 2);
  CHECK(world.now() == 0.5);
  world.advance_to(10);
  world.audit();
  CHECK(log.events.size() == 2);
}

TEST_CASE("A world is not made where arithmetic is not exact", "[world]") {
  std::string said;
  std::fesetround(FE_TOWARDZERO);
  try {
    World<1> world({});
  } catch (const std::runtime_error& error) {
    said = error.what();
  }
  std::fesetround(FE_TONEAREST);
  CHECK(said.find("World: this thread does not round to nearest") == 0);
  CHECK_NOTHROW(World<1>({}));
}

TEST_CASE("A budget of no time is enough for one event", "[world]") {
  EventLog<1> log;
  World<1> world({}, &log);
  for (const auto& b : two_balls()) world.add_body(b);
  CHECK_FALSE(world.advance_for(0, 10));
  CHECK(log.events.size() == 1);
  CHECK(world.now() == 1);
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
}  // namespace kds::collision::test_errors
