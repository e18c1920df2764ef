#include "collision/shapes/bending_mesh.hpp"
#include "collision/shapes/convex_hull.hpp"
#include "collision/shapes/mesh_script.hpp"
#include "collision/world.hpp"
#include "kds/framework/snapshot.hpp"
#include "tests/collision/deforming/bowls.hpp"
#include "tests/collision/event_log.hpp"
#include "tests/collision/sample_meshes.hpp"
#include "tests/collision/sample_sheets.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace test_bending_world {
namespace {

using namespace kds;
using namespace kds::collision;
using namespace kds::collision::tests;
template <int Degree>
using Path = certificates::PointMotion<Degree>;

/// A sheet whose middle rises from 0 to 2 in the time from 1 to 3, and is back at 5.
BendingMesh bulging_sheet() {
  const samples::Sheet sheet(4);
  auto bulged = sheet.positions;
  bulged[12][2] = 2;
  return {std::make_shared<const MeshScript>(
      std::vector<MeshScript::Keyframe>{{1, sheet.positions}, {3, bulged}, {5, sheet.positions}}, sheet.triangles)};
}

template <int Degree>
std::vector<BodyDescription<Degree>> random_bodies(samples::Random& random) {
  std::vector<BodyDescription<Degree>> bodies;
  const auto ring = samples::torus(6, 4);
  const ConvexHull hull = convex_hull({{0.5, 0, 0}, {-0.25, 0.5, 0}, {-0.25, -0.5, 0}, {0, 0, 0.5}, {0, 0, -0.25}});
  for (std::size_t i = 0; i < 16; ++i) {
    const std::vector<Shape> shapes{random_sheet(random), Sphere{0.4},     Box{Vector3d(0.4, 0.2, 0.3)},
                                    Capsule{0.2, 0.4},    MeshShape{ring}, hull};
    Path<Degree> path = Path<Degree>::line(random.vector(1.75), random.vector(1.5), i % 4 == 3 ? 0.5 : 0.0);
    if (i % 5 == 0) path.coefficients[1] = Vector3d::Zero();  // it bends where it is
    if constexpr (Degree == 2) path.coefficients[2] = random.vector(0.5);
    bodies.push_back(
        {.shape = shapes[i % 2 == 0 ? 0 : 1 + (i / 2) % 5], .orientation = random.orientation(), .motion = {path}});
  }
  return bodies;
}

}  // namespace

TEST_CASE("a ball above a sheet that bulges: contact and separation", "[deforming][world]") {
  for (const BroadPhaseKind kind :
       {BroadPhaseKind::automatic, BroadPhaseKind::grid, BroadPhaseKind::kinetic_sap, BroadPhaseKind::all_pairs}) {
    EventLog<1> log;
    World<1> world({.response = Response::none, .broad_phase = kind}, &log);
    const BodyId sheet =
        world.add_body({.shape = bulging_sheet(), .motion = {Path<1>::line(Vector3d::Zero(), Vector3d::Zero())}});
    const BodyId ball =
        world.add_body({.shape = Sphere{0.5}, .motion = {Path<1>::line(Vector3d(0, 0, 1.5), Vector3d::Zero())}});
    world.advance_to(10);
    world.audit();
    REQUIRE(log.events.size() == 2);
    CHECK(log.events[0].kind == Kind::contact);
    CHECK((log.events[0].a == sheet && log.events[0].b == ball));
    CHECK(log.events[0].time() <= 2);
    CHECK(log.events[0].time() == Approx(2).epsilon(0).margin(1e-6));
    CHECK(log.events[0].contact.normal.isApprox(Vector3d::UnitZ(), 1e-6));
    CHECK(log.events[0].contact.point.isApprox(Vector3d::UnitZ(), 1e-6));
    CHECK(log.events[0].contact.feature_a == Feature::vertex(12));
    CHECK(log.events[1].kind == Kind::separation);
    CHECK(log.events[1].time() >= 4);
    CHECK(log.events[1].time() == Approx(4).epsilon(0).margin(1e-6));
  }
}

TEST_CASE("a keyframe in the far future makes contacts no less exact", "[deforming][world]") {
  const samples::Sheet sheet(2);
  const auto run = [&](double last, BroadPhaseKind kind, const Vector3d& acceleration) {
    EventLog<2> log;
    World<2> world({.response = Response::none, .broad_phase = kind}, &log);
    const std::vector<MeshScript::Keyframe> keyframes{{0, sheet.positions}, {last, sheet.positions}};
    world.add_body({.shape = BendingMesh{std::make_shared<const MeshScript>(keyframes, sheet.triangles)},
                    .motion = {Path<2>::line(Vector3d::Zero(), Vector3d::Zero())}});
    world.add_body({.shape = Sphere{0.25},
                    .motion = {Path<2>::parabola(Vector3d(0.125, 0.25, 1), Vector3d(0, 0, -1), acceleration)}});
    world.add_body({.shape = Sphere{0.25}, .motion = {Path<2>::line(Vector3d(0, 0, 2), Vector3d(1, 0, 0))}});
    world.advance_to(4);
    return log.events;
  };
  for (const Vector3d& acceleration : {Vector3d(0, 0, 0), Vector3d(0, 0, -2)}) {
    const auto expected = run(8, BroadPhaseKind::all_pairs, acceleration);
    REQUIRE(expected.size() == 2);  // the second ball passes above the sheet
    for (const double last : {1e6, 1e12, 1e61, 1e300}) {
      for (const BroadPhaseKind kind : {BroadPhaseKind::all_pairs, BroadPhaseKind::grid}) {
        INFO("keyframe at " << last << ", acceleration " << acceleration.transpose());
        const auto events = run(last, kind, acceleration);
        REQUIRE(events.size() == expected.size());
        for (std::size_t i = 0; i < events.size(); ++i) {
          CHECK(events[i].kind == expected[i].kind);
          CHECK(events[i].time() == Approx(expected[i].time()).epsilon(1e-7));
        }
      }
    }
  }
}

TEST_CASE("a late clock parts no surfaces that bend into each other", "[deforming][world]") {
  const ConvexHull hull = convex_hull({{0.5, 0, 0}, {-0.25, 0.5, 0}, {-0.25, -0.5, 0}, {0, 0, 0.5}, {0, 0, -0.25}});
  const std::vector<Shape> shapes{
      Sphere{0.25}, Box{Vector3d(0.2, 0.3, 0.1)},       Capsule{0.1, 0.3}, MeshShape{samples::torus(6, 4)},
      hull,         HalfSpace{-Vector3d::UnitZ(), -0.9}};
  // A sheet that rises, and meets another body or, if there is none, two triangles of which one goes through the other.
  const auto run = [](const Shape* shape, double start) {
    EventLog<1> log;
    World<1> world({.start_time = start, .response = Response::none}, &log);
    samples::Sheet sheet(4);
    if (!shape) {
      sheet.positions = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0.2, 0.2, 1}, {1.2, 0.3, 1}, {0.3, 1.1, 1.2}};
      sheet.triangles = {{0, 1, 2}, {3, 4, 5}};
    }
    auto moved = sheet.positions;
    for (std::size_t v = 0; v < moved.size(); ++v) moved[v][2] += shape ? 1.0 : v < 3 ? 0.0 : -2.0;
    if (shape) moved[12][2] += 0.5;
    const std::vector<MeshScript::Keyframe> keyframes{{start, sheet.positions}, {start + 2, moved}};
    const Path<1> still = Path<1>::line(Vector3d::Zero(), Vector3d::Zero(), start);
    world.add_body({.shape = BendingMesh{std::make_shared<const MeshScript>(keyframes, sheet.triangles)},
                    .motion = {still},
                    .self_contacts = !shape});
    if (shape && std::holds_alternative<HalfSpace>(*shape)) {
      const Path<1> away = Path<1>::line(Vector3d::Zero(), Vector3d(0, 0, 0.125), start);
      world.add_body({.shape = *shape, .motion = {away}, .fixed = true});
    } else if (shape) {
      world.add_body({.shape = *shape,
                      .orientation = Eigen::Quaterniond(0.8, 0.6, 0, 0),
                      .motion = {Path<1>::line(Vector3d(0.1, 0.3, 2), Vector3d(0.1, 0.2, -0.9), start)}});
    }
    world.advance_to(start + 8);
    return log.events;
  };
  for (std::size_t k = 0; k <= shapes.size(); ++k) {
    const Shape* const shape = k < shapes.size() ? &shapes[k] : nullptr;
    const auto expected = run(shape, 0);
    CAPTURE(k);
    REQUIRE(expected.size() == 2);
    for (const double start : {0x1p26, 0x1p28, 0x1p30, 0x1p34}) {
      const auto events = run(shape, start);
      CAPTURE(start);
      REQUIRE(events.size() == 2);
      const double spacing = next_up(start) - start;
      for (std::size_t i = 0; i < 2; ++i) {
        CHECK(events[i].kind == expected[i].kind);
        CHECK(events[i].time() - start == Approx(expected[i].time()).epsilon(0).margin(1e-7 + 8 * spacing));
      }
      CHECK(events[0].time() - start <= expected[0].time() + spacing);
    }
  }
}

TEST_CASE("a ball is in contact with a sheet that bends while it is near, and not else", "[deforming][world]") {
  const std::uint64_t seed = GENERATE(1, 2, 3);
  CAPTURE(seed);
  samples::Random random(seed);
  int contacts = 0;
  for (int i = 0; i < 10; ++i) {
    const BendingMesh sheet = random_sheet(random);
    const Path<1> path = Path<1>::line(random.vector(0.75), random.vector(0.5));
    EventLog<1> log;
    World<1> world({.response = Response::none}, &log);
    world.add_body({.shape = sheet, .motion = {Path<1>::line(Vector3d::Zero(), Vector3d::Zero())}});
    world.add_body({.shape = Sphere{0.25}, .motion = {path}});
    world.advance_to(3);
    contacts += !log.events.empty();
    const double tolerance = bending_tolerance * sheet.script->bounding_radius();
    for (double t = 0.001; t < 3; t += 0.01) {
      bool touching = false;
      for (const Event& event : log.events) {
        if (event.time() <= t) touching = event.kind != Kind::separation;
      }
      BruteSurface surface;
      for (std::size_t k = 0; k < sheet.script->vertices(); ++k) {
        surface.corners.push_back(sheet.script->position(k, t).cast<Long>());
      }
      surface.faces = samples::Sheet(3).triangles;
      surface.add_edges_of_faces();
      const auto distance = static_cast<double>(brute_distance(surface, {{path.position(t).cast<Long>()}, {}, {}}));
      CAPTURE(i, t, distance);
      if (touching ? distance > 0.25 + 2.01 * tolerance : distance < 0.25) FAIL_CHECK("wrong state");
    }
  }
  CHECK(contacts > 4);
}

TEST_CASE("a mesh whose keyframes are alike begins and ends contacts as a rigid one does", "[deforming][world]") {
  const std::uint64_t seed = GENERATE(1, 2);
  CAPTURE(seed);
  samples::Random random(seed);
  const auto ring = samples::torus(7, 5);
  const std::vector<Vector3d> vertices(ring->vertices().begin(), ring->vertices().end());
  const std::vector<Mesh::Triangle> triangles(ring->triangles().begin(), ring->triangles().end());
  const BendingMesh stiff{std::make_shared<const MeshScript>(
      std::vector<MeshScript::Keyframe>{{0.25, vertices}, {0.75, vertices}}, triangles)};
  int same = 0, events = 0;
  constexpr int rounds = 40;
  for (int i = 0; i < rounds; ++i) {
    const std::vector<Shape> shapes{Sphere{0.5}, Box{Vector3d(0.5, 0.25, 0.375)}, Capsule{0.25, 0.5}, MeshShape{ring}};
    const Eigen::Quaterniond turn = random.orientation(), of_other = random.orientation();
    const Vector3d from = 2 * random.direction();
    const Path<1> path = Path<1>::line(from, -1.25 * from + random.vector(0.5), 0.125);
    std::array<std::vector<Event>, 2> logs;
    for (const bool bends : {false, true}) {
      EventLog<1> log;
      World<1> world({.response = Response::none}, &log);
      const Shape shape = bends ? Shape(stiff) : Shape(MeshShape{ring});
      world.add_body({.shape = shape, .orientation = turn, .motion = {path}});
      world.add_body({.shape = shapes[static_cast<std::size_t>(i % 4)],
                      .orientation = of_other,
                      .motion = {Path<1>::line(Vector3d::Zero(), Vector3d::Zero())}});
      world.advance_to(5);
      logs[bends] = log.events;
    }
    CAPTURE(i, logs[0], logs[1]);
    if (logs[0].size() != logs[1].size()) continue;  // a gap, or a depth, below the tolerance
    ++same;
    for (std::size_t k = 0; k < logs[0].size(); ++k) {
      ++events;
      const bool parts = logs[0][k].kind == Kind::separation;
      CHECK(logs[0][k].kind == logs[1][k].kind);
      const double later = logs[1][k].time() - logs[0][k].time();
      CHECK((parts ? later : -later) >= -1e-9);
      CHECK(std::abs(later) < 1e-3);  // grazing at that: 1e-7 within the square of it
    }
  }
  CHECK(same > rounds * 9 / 10);
  CHECK(events > rounds);
}

TEMPLATE_TEST_CASE_SIG("meshes that bend among others: the same events by all broad phases, and after a snapshot",
                       "[deforming][world]", ((int Degree), Degree), 1, 2) {
  const std::uint64_t seed = GENERATE(1, 2);
  CAPTURE(Degree, seed);
  std::vector<Event> expected;
  for (const BroadPhaseKind kind : {BroadPhaseKind::all_pairs, BroadPhaseKind::automatic, BroadPhaseKind::grid,
                                    BroadPhaseKind::kinetic_sap, BroadPhaseKind::sap}) {
    CAPTURE(static_cast<int>(kind));
    samples::Random random(seed);
    EventLog<Degree> log;
    World<Degree> world(
        {.response = Response::none, .broad_phase = kind, .rate = kind == BroadPhaseKind::sap ? 10.0 : 0.0}, &log);
    for (const auto& body : random_bodies<Degree>(random)) world.add_body(body);
    if (kind == BroadPhaseKind::sap) {
      for (int i = 1; i <= 30; ++i) world.advance_to(0.1 * i);
    } else {
      world.advance_to(1.25);
      if (kind == BroadPhaseKind::grid) {
        const Snapshot saved = save(world);
        const auto before = log.events;
        world.advance_to(2);
        restore(saved, world);
        log.events = before;
      }
      world.advance_to(3);
    }
    world.audit();
    if (expected.empty()) {
      expected = log.events;
      std::map<std::pair<BodyId, BodyId>, int> state;
      for (const Event& e : expected) {
        int& now = state[{e.a, e.b}];
        CHECK(now == (e.kind == Kind::separation ? 1 : 0));
        now = e.kind == Kind::separation ? 0 : 1;
        CHECK(std::abs(e.contact.normal.norm() - 1) < 1e-12);
      }
    }
    CHECK(log.events == expected);
  }
  CHECK(expected.size() > 10);
}

TEST_CASE("what is refused of meshes that bend", "[deforming][world]") {
  const BodyDescription<1> sheet{.shape = bulging_sheet(),
                                 .motion = {Path<1>::line(Vector3d::Zero(), Vector3d::Zero())}};
  World<1> elastic({.response = Response::elastic});
  CHECK_THROWS_WITH(elastic.add_body(sheet),
                    "fixed: contacts do not move a mesh that bends: it has to be fixed, or a sensor");
  BodyDescription<1> sensor = sheet, fixed = sheet;
  sensor.sensor = true, fixed.fixed = true;
  CHECK_NOTHROW(elastic.add_body(sensor));
  CHECK_NOTHROW(elastic.add_body(fixed));
  World<1> world({.response = Response::none});
  CHECK_THROWS_WITH(world.add_body({.shape = BendingMesh{}, .motion = sheet.motion}), "script: is missing");
  const auto flat = samples::Sheet(4).positions;
  const auto script = [&](std::vector<MeshScript::Keyframe> keyframes) {
    return MeshScript(std::move(keyframes), samples::Sheet(4).triangles);
  };
  CHECK_THROWS_WITH(script({}), "keyframes: there is none");
  CHECK_THROWS_WITH(script({{0, flat}, {0, flat}}),
                    "keyframes[1].time: must be later than that of the keyframe before");
  CHECK_THROWS_WITH(script({{0, flat}, {1, {flat.begin(), flat.end() - 1}}}),
                    "keyframes[1].positions: has 24 positions, and keyframes[0] has 25");
  auto bad = flat;
  bad[3][0] = std::nan("");
  CHECK_THROWS_WITH(script({{0, flat}, {1, bad}}),
                    "keyframes[1].positions[3]: must be finite, and at most 2^100 in magnitude");
}

}  // namespace test_bending_world
