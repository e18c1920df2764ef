// Bodies that turn and meshes that bend in one world: when they meet and part.
#include "collision/deforming/rigid_surface.hpp"
#include "collision/shapes/bending_mesh.hpp"
#include "collision/shapes/compound.hpp"
#include "collision/world.hpp"
#include "kds/framework/snapshot.hpp"
#include "tests/collision_turning/bending_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace test_turning_and_bending {

using namespace kds;
using namespace kds::tests::sheets;

TEST_CASE("the surface of a body that turns is where it is said to be, up to its uncertainty") {
  const std::uint64_t seed = GENERATE(1, 2, 3);
  CAPTURE(seed);
  samples::Random random(seed);
  const auto all = solids();
  for (int i = 0; i < 60; ++i) {
    const Solid& solid = all[static_cast<std::size_t>(i) % all.size()];
    RigidMotion<2> motion{Path::line(random.vector(3), random.vector(2), 0.25), random.orientation(),
                          random.vector(i < 30 ? 1 : 20)};
    motion.path.coefficients[2] = random.vector(1);
    RigidSurface<2> surface(place(solid.shape, Quaterniond::Identity()));
    const double t0 = 0.25 + i * 0.125, h = std::ldexp(1.0, -2 - i % 10);
    surface.move(motion, t0, t0 + h);
    surface.surface().audit();
    Long farthest = 0;
    for (int k = 0; k <= 16; ++k) {
      const double t = t0 + h * k / 16;
      const BruteSurface exact = solid_at(solid, motion, t);
      for (std::size_t v = 0; v < exact.corners.size(); ++v) {
        // The place on the parabola, in long doubles: what position() rounds is no part of the promise.
        const Long s = static_cast<Long>(k) / 16;
        LongVector place = LongVector::Zero();
        const std::array<Long, 3> weights{(1 - s) * (1 - s), 2 * s * (1 - s), s * s};
        for (std::size_t c = 0; c < 3; ++c) {
          place += weights[c] * surface.surface().control_points(c)[v].cast<Long>();
        }
        farthest = std::max(farthest, (place - exact.corners[v]).cwiseAbs().maxCoeff());
      }
    }
    CAPTURE(i, kind_name(solid.shape), h, static_cast<double>(farthest), surface.surface().uncertainty());
    CHECK(farthest <= surface.surface().uncertainty());
    const double angle = motion.angular_velocity.norm() * h;
    CHECK(surface.surface().uncertainty() <= 0.025 * angle * angle * angle * surface.vertex_radius() + 0x1p-38);
  }
}

TEST_CASE("what turns is in contact with a sheet that bends while it is near, and not else") {
  const std::uint64_t seed = GENERATE(1, 2, 3, 4);
  CAPTURE(seed);
  samples::Random random(seed);
  const auto all = solids();
  int contacts = 0, separations = 0;
  for (int i = 0; i < 12; ++i) {
    const Solid& solid = all[static_cast<std::size_t>(i) % all.size()];
    const BendingMesh sheet = random_sheet(random);
    RigidMotion<2> motion{Path::line(random.vector(0.5), random.vector(0.5)), random.orientation(),
                          random.vector(i % 3 == 0 ? 30 : 3)};
    motion.path.coefficients[2] = random.vector(0.25);
    const RigidMotion<2> of_sheet{Path::line(Vector3d::Zero(), random.vector(0.125)), random.orientation()};
    Log log;
    Turning world({.response = Response::none}, &log);
    world.add_body({.shape = sheet, .motion = {of_sheet}});
    world.add_body({.shape = solid.shape, .motion = {motion}});
    world.advance_to(2.5);
    world.audit();
    contacts += static_cast<int>(log.count("contact") + log.count("overlap"));
    separations += static_cast<int>(log.count("separation"));
    const double tolerance = bending_tolerance * sheet.script->bounding_radius();
    for (double t = 0.001; t < 2.5; t += 0.005) {
      bool touching = false;
      for (const auto& event : log.events) {
        if (event.contact.time <= t) touching = std::string(event.what) != "separation";
      }
      const BruteSurface surface = sheet_at(sheet, of_sheet, t), placed = solid_at(solid, motion, t);
      const bool through = go_through(surface, placed);
      const Long distance = through ? 0 : brute_distance(surface, placed);
      CAPTURE(i, t, kind_name(solid.shape), static_cast<double>(distance), through);
      if (touching) {
        CHECK(distance <= solid.radius + 2.5L * tolerance);
      } else {
        CHECK_FALSE(through);
        CHECK(distance >= solid.radius);
      }
    }
  }
  CHECK(contacts > 5);
  CHECK(separations > 3);
}

TEST_CASE("bodies that do not turn meet a sheet that bends when they do in a world of paths") {
  const std::uint64_t seed = GENERATE(1, 2);
  CAPTURE(seed);
  samples::Random random(seed);
  const auto all = solids();
  int events = 0;
  for (int i = 0; i < 40; ++i) {
    const Solid& solid = all[static_cast<std::size_t>(i) % all.size()];
    const BendingMesh sheet = random_sheet(random);
    const Quaterniond turn = random.orientation(), of_sheet = random.orientation();
    const auto path = Path::line(random.vector(1), random.vector(0.75));
    struct Times final : WorldListener<2> {
      std::vector<double> at;
      void contact(World<2>&, const PairEvent& e) override { at.push_back(e.contact.time); }
      void separation(World<2>&, const PairEvent& e) override { at.push_back(e.contact.time); }
    } times;
    World<2> plain({.response = Response::none}, &times);
    plain.add_body({.shape = sheet, .orientation = of_sheet, .motion = {Path{}}});
    plain.add_body({.shape = solid.shape, .orientation = turn, .motion = {path}});
    plain.advance_to(3);
    Log log;
    Turning world({.response = Response::none}, &log);
    world.add_body({.shape = sheet, .motion = {RigidMotion<2>{Path{}, of_sheet}}});
    world.add_body({.shape = solid.shape, .motion = {RigidMotion<2>{path, turn}}});
    world.advance_to(3);
    std::erase_if(log.events, [](const auto& event) { return std::string(event.what) == "overlap"; });
    CAPTURE(i, kind_name(solid.shape));
    REQUIRE(log.events.size() == times.at.size());
    for (std::size_t k = 0; k < times.at.size(); ++k) {
      ++events;
      CHECK(log.events[k].contact.time == Approx(times.at[k]).epsilon(0).margin(1e-5));
    }
  }
  CHECK(events > 10);
}

TEST_CASE("bodies that turn among sheets that bend: the same events by all broad phases, and after a snapshot") {
  const std::uint64_t seed = GENERATE(1, 2);
  const Response response = GENERATE(Response::none, Response::elastic);
  CAPTURE(seed, static_cast<int>(response));
  std::vector<Log::Event> expected;
  for (const BroadPhaseKind kind : all_methods) {
    CAPTURE(static_cast<int>(kind));
    samples::Random random(seed);
    Log log;
    WorldOptions options = kds::tests::planes::options(kind);
    options.response = response;
    Turning world(options, &log);
    const Bowl bowl(random, 7, 1);
    world.add_body(fixed_sheet(bowl.shape(), 0.5));
    Body lid = fixed_sheet(random_sheet(random));
    lid.motion[0].path = Path::line(Vector3d(0, 0, 2), Vector3d(0, 0, -0.5));
    lid.motion[0].orientation = Quaterniond(0, 1, 0, 0);
    world.add_body(lid);
    const auto all = solids();
    for (int i = 0; i < 10; ++i) {
      RigidMotion<2> motion{Path::line(Vector3d(0, 0, 1) + random.vector(0.5), random.vector(1)), random.orientation(),
                            random.vector(5)};
      motion.path.coefficients[2] = Vector3d(0, 0, -4);
      Body body{.shape = all[static_cast<std::size_t>(i) % all.size()].shape, .motion = {motion}, .restitution = 0.75};
      if (off_centre(body.shape)) body.inertia = 0.01;
      world.add_body(body);
    }
    const double end = 0.75;
    world.advance_to(0.4 * end);
    if (kind == BroadPhaseKind::grid) {
      const Snapshot saved = save(world);
      const auto before = log.events;
      world.advance_to(0.75 * end);
      restore(saved, world);
      log.events = before;
    }
    world.advance_to(end);
    world.audit();
    if (expected.empty()) expected = log.events;
    CHECK(log.events.size() == expected.size());
    CHECK(log.events == expected);
  }
  CHECK(expected.size() > 20);
}

TEST_CASE("a compound of hulls meets a sheet that bends as its parts do") {
  samples::Random random(5);
  const Compound bar = compound(std::vector<CompoundPart>{{Box{Vector3d(0.25, 0.0625, 0.0625)}, {0.25, 0, 0}},
                                                          {Box{Vector3d(0.0625, 0.25, 0.0625)}, {-0.25, 0, 0}}});
  int events = 0;
  for (int i = 0; i < 8; ++i) {
    const BendingMesh sheet = random_sheet(random);
    const RigidMotion<2> motion{Path::line(random.vector(0.5), random.vector(0.5)), random.orientation(),
                                random.vector(4)};
    std::array<std::vector<double>, 2> begins;
    for (const bool whole : {false, true}) {
      Log log;
      Turning world({.response = Response::none}, &log);
      world.add_body({.shape = sheet, .motion = {RigidMotion<2>{}}});
      if (whole) {
        world.add_body({.shape = bar, .motion = {motion}});
      } else {
        for (const Shape& part : bar.parts->parts())
          world.add_body({.shape = part, .motion = {motion}, .category = 2, .collides_with = 1});
      }
      world.advance_to(2.5);
      int touching = 0;
      for (const auto& event : log.events) {
        const int was = touching;
        touching += std::string(event.what) == "separation" ? -1 : 1;
        if (std::min(was, touching) == 0) begins[whole].push_back(event.contact.time);
      }
    }
    CAPTURE(i);
    CHECK(begins[0] == begins[1]);
    events += static_cast<int>(begins[0].size());
  }
  CHECK(events > 6);
}

TEST_CASE("what turns by next to nothing meets a sheet that bends as what does not turn") {
  const auto run = [](double spin) {
    samples::Random random(5);
    Log log;
    Turning world({.response = Response::none}, &log);
    world.add_body({.shape = random_sheet(random), .motion = {RigidMotion<2>{}}});
    for (const Shape& shape : {Shape(Box{Vector3d(0.25, 0.5, 0.375)}), Shape(Capsule{0.5, 0.25})}) {
      const RigidMotion<2> motion{Path::line(Vector3d(random.vector(0.5) + Vector3d(0, 0, 4)), Vector3d(0, 0, -2)),
                                  random.orientation(), spin * Vector3d(1, 0, 0.5)};
      world.add_body({.shape = shape, .motion = {motion}});
    }
    world.advance_to(6);
    world.audit();
    return log.events;
  };
  const auto still = run(0);
  REQUIRE(still.size() >= 4);
  // Those that have passed the sheet are not followed for ever.
  for (const double spin : {1e-9, 1e-59, 1e-61, 1e-100, 1e-119, 1e-121, 1e-150, 1e-200, 1e-300, 5e-324}) {
    INFO("spin " << spin);
    const auto events = run(spin);
    REQUIRE(events.size() == still.size());
    for (std::size_t i = 0; i < events.size(); ++i) {
      CHECK(std::string(events[i].what) == still[i].what);
      CHECK(events[i].contact.time == Approx(still[i].contact.time).epsilon(0).margin(1e-6));
      CHECK(events[i].contact.point.allFinite());
    }
  }
}

TEST_CASE("meshes that bend do not turn themselves") {
  const BendingMesh sheet = bending({{0, samples::Sheet(2).positions}}, samples::Sheet(2).triangles);
  Turning world({.response = Response::none});
  RigidMotion<2> turns{};
  turns.angular_velocity = Vector3d(0, 0, 1);
  CHECK_THROWS_WITH(world.add_body({.shape = sheet, .motion = {turns}}),
                    "motion[0].angular_velocity: a bending mesh does not turn: its vertices say how it moves");
  const BodyId id = world.add_body({.shape = sheet, .motion = {RigidMotion<2>{}}});
  CHECK_THROWS_WITH(world.update_motion(id, turns), Catch::Contains("angular_velocity: a bending mesh does not turn"));
  const BodyId ball = world.add_body({.shape = Sphere{1}, .motion = {turns}});
  CHECK_THROWS_WITH(world.add_body({.shape = sheet, .sensor = true, .attached_to = ball}),
                    Catch::Contains("attached_to: a bending mesh does not turn, as body 1 may"));
}

}  // namespace test_turning_and_bending
