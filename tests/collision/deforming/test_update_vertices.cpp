#include "collision/shapes/bending_mesh.hpp"
#include "collision/shapes/mesh_script.hpp"
#include "collision/world.hpp"
#include "kds/framework/snapshot.hpp"
#include "tests/collision/deforming/brute_sheets.hpp"
#include "tests/collision/event_log.hpp"
#include "tests/collision/sample_meshes.hpp"
#include "tests/collision/sample_sheets.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

namespace test_update_vertices {
namespace {

using namespace kds;
using namespace kds::collision;
using namespace kds::collision::tests;
template <int Degree>
using Path = certificates::PointMotion<Degree>;
using Keyframes = std::vector<MeshScript::Keyframe>;

/// What a simulator of cloth might find: a sheet that is shaken, with steps of a 64th of a second, and one vertex that
/// stays, so that the sheet is always as large.
struct Cloth {
  samples::Sheet sheet{4};
  Keyframes steps;

  explicit Cloth(samples::Random& random, int count = 64) {
    auto positions = sheet.positions;
    for (int i = 0; i <= count; ++i) {
      steps.push_back({i / 64.0, positions});
      for (std::size_t v = 1; v < positions.size(); ++v) {
        positions[v] = 0.875 * (positions[v] + random.vector(0.05)) + 0.125 * 0.875 * sheet.positions[v];
      }
    }
    steps[0].positions = steps[1].positions;
    for (auto& step : steps) step.positions[0] = Vector3d(-2, 0, 0);
  }
  BendingMesh script(std::size_t count) const {
    const Keyframes first(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(count));
    return {std::make_shared<const MeshScript>(first, sheet.triangles)};
  }
};

template <int Degree>
void add_bodies(World<Degree>& world, const BendingMesh& cloth, samples::Random& random) {
  world.add_body({.shape = cloth,
                  .motion = {Path<Degree>::line(Vector3d::Zero(), Vector3d::Zero())},
                  .fixed = true,
                  .restitution = 0.75});
  for (int i = 0; i < 6; ++i) {
    Path<Degree> path =
        Path<Degree>::line(random.vector(0.5) + Vector3d(0, 0, 0.75), random.vector(1) - Vector3d(0, 0, 1));
    if constexpr (Degree == 2) path.coefficients[2] = Vector3d(0, 0, -2);
    const Shape shape = i % 2 == 0 ? Shape(Sphere{0.25}) : Shape(Box{Vector3d(0.25, 0.125, 0.125)});
    world.add_body({.shape = shape, .motion = {path}});
  }
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("steps given one by one make the events of the script that they are", "[deforming][world]",
                       ((int Degree), Degree), 1, 2) {
  const Response response = GENERATE(Response::none, Response::elastic);
  const std::uint64_t seed = GENERATE(1, 2);
  CAPTURE(Degree, seed, static_cast<int>(response));
  samples::Random first(seed);
  const Cloth cloth(first);
  EventLog<Degree> expected;
  World<Degree> scripted({.response = response}, &expected);
  samples::Random random(seed + 10);
  add_bodies(scripted, cloth.script(cloth.steps.size()), random);
  scripted.advance_to(1);
  for (const BroadPhaseKind kind : {BroadPhaseKind::automatic, BroadPhaseKind::grid, BroadPhaseKind::kinetic_sap,
                                    BroadPhaseKind::sap, BroadPhaseKind::all_pairs}) {
    CAPTURE(static_cast<int>(kind));
    EventLog<Degree> log;
    World<Degree> world({.response = response, .broad_phase = kind, .rate = kind == BroadPhaseKind::sap ? 16.0 : 0.0},
                        &log);
    samples::Random again(seed + 10);
    add_bodies(world, cloth.script(1), again);
    for (std::size_t i = 1; i < cloth.steps.size(); ++i) {
      world.update_vertices(0, {cloth.steps[i]});
      if (i == 20 && kind == BroadPhaseKind::grid) {
        const Snapshot saved = save(world);
        world.advance_to(cloth.steps[i].time);
        log.events.erase(std::remove_if(log.events.begin(), log.events.end(),
                                        [&](const Event& e) { return e.time() > cloth.steps[i - 1].time; }),
                         log.events.end());
        restore(saved, world);
      }
      world.advance_to(cloth.steps[i].time);
    }
    world.audit();
    CHECK(log.events == expected.events);
  }
  CHECK(expected.events.size() >= 8);
}

TEST_CASE("vertices that are given a way in the midst of another go on from where they are", "[deforming][world]") {
  const std::uint64_t seed = GENERATE(1, 2, 3);
  CAPTURE(seed);
  std::vector<Event> expected;
  for (const BroadPhaseKind kind : {BroadPhaseKind::all_pairs, BroadPhaseKind::grid, BroadPhaseKind::kinetic_sap}) {
    CAPTURE(static_cast<int>(kind));
    samples::Random random(seed);
    const Cloth cloth(random, 8);
    EventLog<1> log;
    World<1> world({.response = Response::none, .broad_phase = kind}, &log);
    const BodyId sheet =
        world.add_body({.shape = cloth.script(8), .motion = {Path<1>::line(Vector3d::Zero(), Vector3d(0, 0, 0.125))}});
    const Path<1> path = Path<1>::line(Vector3d(0.25, 0, 0.5), Vector3d(0, 0, -0.375));
    const BodyId ball = world.add_body({.shape = Sphere{0.25}, .motion = {path}});
    const auto script_now = [&] { return std::get<BendingMesh>(world.shape(sheet).shape).script; };
    const auto wave = [&](double t1, double height) {
      auto positions = cloth.sheet.positions;
      for (Vector3d& p : positions) p[2] += height * p[0];
      return MeshScript::Keyframe{t1, positions};
    };
    // A callback changes the way, too.
    log.then = [&](World<1>& w, const Event& e) {
      if (e.kind == Kind::contact) w.update_vertices(sheet, {wave(w.now() + 0.125, -0.5), wave(w.now() + 0.5, 0.25)});
    };
    for (int i = 1; i <= 24; ++i) {
      const double t = 0.07 * i;
      world.advance_to(t);
      if (i % 3 == 0) {
        const auto before = script_now();
        world.update_vertices(sheet, {wave(t + 0.11, random.vector(0.5)[0])});
        const auto after = script_now();
        for (std::size_t v = 0; v < before->vertices(); ++v) CHECK(before->position(v, t) == after->position(v, t));
      }
      if (i == 13) world.update_vertices(sheet, {});  // it stands still
      const auto script = script_now();
      BruteSurface surface;
      for (std::size_t v = 0; v < script->vertices(); ++v) {
        surface.corners.push_back((script->position(v, t) + Vector3d(0, 0, 0.125 * t)).cast<Long>());
      }
      surface.faces = cloth.sheet.triangles;
      surface.add_edges_of_faces();
      const Long distance = brute_distance(surface, {{path.position(t).cast<Long>()}, {}, {}});
      CAPTURE(t, static_cast<double>(distance));
      const double tolerance = bending_tolerance * script->bounding_radius();
      world.step(t);
      CHECK((world.touching(sheet, ball) ? distance < 0.25L + 3 * tolerance : distance > 0.25L));
    }
    world.audit();
    if (expected.empty()) expected = log.events;
    CHECK(log.events == expected);
    CHECK(log.count(Kind::contact) > 0);
  }
}

TEST_CASE("what is refused of vertices", "[deforming][world]") {
  samples::Random random(1);
  const Cloth cloth(random, 2);
  World<1> world({.response = Response::none});
  const Path<1> rest = Path<1>::line(Vector3d::Zero(), Vector3d::Zero());
  const BodyId sheet = world.add_body({.shape = cloth.script(2), .motion = {rest}});
  const BodyId ball = world.add_body({.shape = Sphere{1}, .motion = {rest}});
  world.advance_to(1);
  const auto& flat = cloth.sheet.positions;
  CHECK_THROWS_WITH(world.update_vertices(ball, {{2, flat}}),
                    "World::update_vertices: body 1 is a sphere, which does not bend");
  CHECK_THROWS_WITH(world.update_vertices(sheet, {{1, flat}}),
                    "World::update_vertices: keyframes[0].time: must be later than now");
  CHECK_THROWS_WITH(world.update_vertices(sheet, {{2, flat}, {2, flat}}),
                    "World::update_vertices: keyframes[1].time: must be later than that of the keyframe before");
  CHECK_THROWS_WITH(world.update_vertices(sheet, {{2, {flat.begin(), flat.end() - 1}}}),
                    "World::update_vertices: keyframes[0].positions: has 24 positions, and the mesh has 25 vertices");
  auto bad = flat;
  bad[7][1] = INFINITY;
  CHECK_THROWS_WITH(
      world.update_vertices(sheet, {{2, bad}}),
      "World::update_vertices: keyframes[0].positions[7]: must be finite, and at most 2^100 in magnitude");
  CHECK_THROWS_AS(world.update_vertices(7, {}), std::out_of_range);
  CHECK_NOTHROW(world.update_vertices(sheet, {{2, flat}}));
}

TEST_CASE("a sheet that travels by its keyframes has the volume of each piece", "[deforming][world]") {
  const samples::Sheet sheet(2);
  Keyframes keyframes;
  for (int i = 0; i <= 8; ++i) keyframes.push_back({1.0 * i, sheet.moved(Vector3d(8 * i, 0, 0))});
  const BendingMesh travels{std::make_shared<const MeshScript>(keyframes, sheet.triangles)};
  const Path<1> rest = Path<1>::line(Vector3d::Zero(), Vector3d::Zero());
  std::vector<Event> expected;
  for (const auto& [kind, kdop] : {std::pair{BroadPhaseKind::all_pairs, 6}, std::pair{BroadPhaseKind::grid, 6},
                                   std::pair{BroadPhaseKind::kinetic_sap, 6},
                                   std::pair{BroadPhaseKind::kinetic_sap, 18}, std::pair{BroadPhaseKind::sap, 6}}) {
    CAPTURE(static_cast<int>(kind), kdop);
    EventLog<1> log;
    World<1> world({.response = Response::none,
                    .broad_phase = kind,
                    .rate = kind == BroadPhaseKind::sap ? 4.0 : 0.0,
                    .kdop = kdop,
                    .report_pairs = true},
                   &log);
    world.add_body({.shape = travels, .motion = {rest}});
    for (int i = 0; i <= 8; ++i) {
      world.add_body({.shape = Sphere{0.5}, .motion = {Path<1>::line(Vector3d(8 * i, 0, 0.25), Vector3d::Zero())}});
    }
    const auto found = [&](double x) {
      std::vector<BodyId> ids;
      world.visit_overlapping(Vector3d(x, 0, -1), Vector3d(x, 0, -0.5), [&](BodyId id) { ids.push_back(id); });
      world.visit_overlapping(Vector3d(x, 0, -0.125), Vector3d(x, 0, 0), [&](BodyId id) { ids.push_back(id); });
      return std::count(ids.begin(), ids.end(), 0);
    };
    world.advance_to(2.5);
    CHECK(found(20) == 1);
    CHECK(found(4) == 0);
    CHECK(found(50) == 0);
    std::vector<BodyId> swept;
    const KineticBox<1> far =
        box_around<1>(Path<1>::line(Vector3d(60, 0, 0), Vector3d::Zero()), -Vector3d::Ones(), Vector3d::Ones());
    world.visit_swept(far, 8, [&](BodyId id) { swept.push_back(id); });
    CHECK(std::count(swept.begin(), swept.end(), 0) == 1);
    CHECK(log.count(Kind::pair_began) - log.count(Kind::pair_ended) <= 2);  // only with those of this piece
    world.advance_to(8);
    world.audit();
    CHECK(log.count(Kind::contact) == 8);
    CHECK(log.count(Kind::overlap) == 1);
    CHECK(log.count(Kind::pair_began) == 9);
    if (kdop != 6) continue;
    if (expected.empty()) expected = log.events;
    CHECK(log.events == expected);
  }
}

}  // namespace test_update_vertices
