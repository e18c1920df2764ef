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
#include <memory>
#include <utility>
#include <vector>

namespace test_bending_response {
namespace {

using namespace kds;
using namespace kds::collision;
using namespace kds::collision::tests;
template <int Degree>
using Path = certificates::PointMotion<Degree>;

template <int Degree>
Path<Degree> still() {
  return Path<Degree>::line(Vector3d::Zero(), Vector3d::Zero());
}

template <int Degree>
BodyDescription<Degree> fixed_sheet(const BendingMesh& shape, double restitution = 1) {
  return {.shape = shape, .motion = {still<Degree>()}, .fixed = true, .restitution = restitution};
}

}  // namespace

TEST_CASE("what falls into a bowl that heaves never goes into it", "[deforming][world][response]") {
  const std::uint64_t seed = GENERATE(1, 2, 3);
  CAPTURE(seed);
  samples::Random random(seed);
  int contacts = 0;
  for (const Solid& solid : solids()) {
    const Bowl bowl(random, seed == 2 ? 40 : 5, 1);
    const double restitution = 0.25 * static_cast<double>(seed - 1);
    EventLog<2> log;
    World<2> world({.response = Response::elastic}, &log);
    world.add_body(fixed_sheet<2>(bowl.shape(), restitution));
    Path<2> path = Path<2>::line(Vector3d(0.25, -0.125, 0.5) + random.vector(0.125), random.vector(0.25));
    path.coefficients[2] = Vector3d(0, 0, -5);
    const BodyId body = world.add_body({.shape = solid.shape, .motion = {path}});
    const auto check = [&](double t) {
      const BruteSurface field = bowl.at(t);
      const Vector3d place = world.motion(body).position(t);
      const BruteSurface placed = solid.at(place.cast<Long>());
      CAPTURE(t, kind_name(solid.shape), place.transpose());
      CHECK(brute_distance(field, placed) > solid.radius);
      CHECK_FALSE(go_through(field, placed));
      CHECK(place[2] > height_at(field, place[0], place[1]));
    };
    log.then = [&](World<2>& w, const Event& e) {
      REQUIRE(e.kind == Kind::contact);
      if (++contacts % 64 == 0 || log.events.size() < 8) check(w.now());
    };
    for (double t = 0; t <= 1.25; t += 1.0 / 32) {
      world.advance_to(t);
      check(t);
    }
    if (restitution < 0.25) CHECK(log.events.size() > 100);  // it has come to lie there
  }
}

TEST_CASE("a heap in a bowl that heaves stays above it", "[deforming][world][response]") {
  struct Counter final : WorldListener<2> {
    int passed = 0;
    void passes(World<2>&, const PairEvent& e) override { passed += e.a == 0; }
    void overlap(World<2>&, const PairEvent& e) override { passed += e.a == 0; }
  };
  const std::uint64_t seed = GENERATE(1, 2, 3, 4);
  CAPTURE(seed);
  samples::Random random(seed);
  const Bowl bowl(random, seed % 2 == 0 ? 12 : 3, 1);
  Counter counter;
  World<2> world({.response = Response::elastic}, &counter);
  world.add_body(fixed_sheet<2>(bowl.shape(), 0.25 * static_cast<double>(seed - 1)));
  const auto all = solids();
  std::vector<BodyId> bodies;
  for (int i = 0; i < 5; ++i) {
    Path<2> path = Path<2>::line(Vector3d(0, 0, 0.5 + 0.375 * i) + random.vector(0.125), random.vector(0.25));
    path.coefficients[2] = Vector3d(0, 0, -5);
    bodies.push_back(world.add_body({.shape = all[static_cast<std::size_t>(i)].shape,
                                     .motion = {path},
                                     .mass = i % 2 == 0 ? 1.0 : 8.0,
                                     .restitution = i == 3 ? 1 : 0.5}));
  }
  for (int step = 1; step <= 16; ++step) {
    const double t = step / 20.0;
    world.advance_to(t);
    const BruteSurface field = bowl.at(t);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      const Vector3d place = world.motion(bodies[i]).position(t);
      const BruteSurface placed = all[i].at(place.cast<Long>());
      CAPTURE(t, i, place.transpose());
      CHECK(brute_distance(field, placed) > all[i].radius);
      CHECK_FALSE(go_through(field, placed));
      CHECK(place[2] > height_at(field, place[0], place[1]));
    }
  }
  CHECK(counter.passed == 0);
}

TEMPLATE_TEST_CASE_SIG("a contact gives a body the velocity of the surface and the rebound",
                       "[deforming][world][response]", ((int Degree), Degree), 1, 2) {
  const std::uint64_t seed = GENERATE(1, 2);
  CAPTURE(Degree, seed);
  samples::Random random(seed);
  int checked = 0;
  for (int i = 0; i < 30; ++i) {
    const double restitution = 0.5 + 0.25 * (i % 3);
    const Bowl bowl(random, 3, 1);
    Path<Degree> path =
        Path<Degree>::line(random.vector(0.25) + Vector3d(0, 0, 0.75), random.vector(0.5) - 2 * Vector3d::UnitZ());
    if constexpr (Degree == 2) path.coefficients[2] = random.vector(0.5);
    Path<Degree> sheet_path = Path<Degree>::line(random.vector(0.0625), random.vector(0.25));

    Vector3d before = path.coefficients[1];
    EventLog<Degree> log;
    World<Degree> world({.response = Response::elastic}, &log);

    auto sheet = fixed_sheet<Degree>(bowl.shape(), restitution);
    sheet.motion = {sheet_path};
    world.add_body(sheet);
    const BodyId ball = world.add_body({.shape = Sphere{0.125}, .motion = {path}});
    const double tolerance = bending_tolerance * bowl.shape().script->bounding_radius();
    log.then = [&](World<Degree>& w, const Event& e) {
      const double t = e.time();
      if (log.events.size() > 4) return;
      const Vector3d after = w.motion(ball).velocity(t);
      BruteSurface field = bowl.at(t);
      const LongVector centre = (w.motion(ball).position(t) - sheet_path.position(t)).template cast<Long>();
      const Long distance = brute_distance(field, {{centre}, {}, {}});
      CHECK(distance > 0.125L);
      CHECK(distance <= 0.125L + tolerance);
      // Where the surface is struck, and how fast it moves there: by places a little later, of the same three corners.
      const double later = 0x1p-12;
      Vector3d point = Vector3d::Zero(), moved = Vector3d::Zero();
      const BruteSurface next = bowl.at(t + later);
      for (const auto& [x, y, z] : field.faces) {
        const LongVector &a = field.corners[x], &b = field.corners[y], &c = field.corners[z];
        if (!(height_over(centre, a, b, c) <= distance + 1e-12L)) continue;
        const LongVector n = (b - a).cross(c - a);
        const Long wb = n.dot((centre - a).cross(c - a)) / n.squaredNorm(),
                   wc = n.dot((b - a).cross(centre - a)) / n.squaredNorm();
        point = ((1 - wb - wc) * a + wb * b + wc * c).template cast<double>();
        moved = ((1 - wb - wc) * next.corners[x] + wb * next.corners[y] + wc * next.corners[z]).template cast<double>();
      }
      const bool piece_ends = std::fmod(3 * t, 1.0) > 1 - 4 * later || t > 1 - 2 * later;
      if (moved != Vector3d::Zero() && !piece_ends) {  // else it has met an edge or a vertex
        ++checked;
        const Vector3d n = (centre.template cast<double>() - point).normalized();
        CHECK((n - e.contact.normal).norm() < 1e-6);
        const Vector3d surface = (moved - point) / later + sheet_path.velocity(t);
        Vector3d arrives = before;
        if constexpr (Degree == 2) arrives += 2 * path.coefficients[2] * (t - path.start);
        const double approach = n.dot(arrives - surface), parts = n.dot(after - surface);
        CHECK(approach < 0);
        CHECK(parts == Approx(-restitution * approach).epsilon(1e-6).margin(1e-5));
        CHECK((after - arrives - n.dot(after - arrives) * n).norm() < 1e-6);  // smooth
      }
      path = w.motion(ball);
      before = path.coefficients[1];
    };
    world.advance_to(1.5);
  }
  CHECK(checked > 20);
}

TEMPLATE_TEST_CASE_SIG("bodies on meshes that bend: the same events by all broad phases, and after a snapshot",
                       "[deforming][world][response]", ((int Degree), Degree), 1, 2) {
  const std::uint64_t seed = GENERATE(1, 2);
  const Response response = GENERATE(Response::elastic, Response::callback);
  CAPTURE(Degree, seed, static_cast<int>(response));
  std::vector<Event> expected;
  for (const BroadPhaseKind kind : {BroadPhaseKind::all_pairs, BroadPhaseKind::automatic, BroadPhaseKind::grid,
                                    BroadPhaseKind::kinetic_sap, BroadPhaseKind::sap}) {
    CAPTURE(static_cast<int>(kind));
    samples::Random random(seed);
    EventLog<Degree> log;
    if (response == Response::callback) {
      log.then = [](World<Degree>& w, const Event& e) {
        if (e.kind != Kind::contact) return;
        for (const BodyId id : {e.a, e.b}) {  // it bounces back the way it came, now and then
          if (w.fixed(id) || static_cast<int>(64 * e.time()) % 4 == 0) continue;
          auto motion = w.motion(id).restarted(w.now());
          motion.coefficients[1] *= -1;
          w.update_motion(id, motion);
        }
      };
    }
    World<Degree> world({.response = response,
                         .broad_phase = kind,
                         .rate = kind == BroadPhaseKind::sap ? 10.0 : 0.0,
                         .walls = Walls{Vector3d::Constant(-4), Vector3d::Constant(4), 0.5}},
                        &log);
    const Bowl bowl(random, 7, 1), lid(random, 5, 0.75);
    world.add_body(fixed_sheet<Degree>(bowl.shape(), 0.5));
    auto cover = fixed_sheet<Degree>(lid.shape(), 0.75);
    cover.orientation = Eigen::Quaterniond(0, 1, 0, 0);
    cover.motion = {Path<Degree>::line(Vector3d(0, 0, 2), Vector3d(0, 0, -0.5))};  // the two pass each other
    world.add_body(cover);
    for (int i = 0; i < 10; ++i) {
      Path<Degree> path = Path<Degree>::line(Vector3d(0, 0, 1) + random.vector(0.5), random.vector(1));
      if constexpr (Degree == 2) path.coefficients[2] = Vector3d(0, 0, -4);
      const auto all = solids();
      world.add_body(
          {.shape = all[static_cast<std::size_t>(i) % all.size()].shape, .motion = {path}, .restitution = 0.75});
    }
    const double end = Degree == 1 ? 2.5 : 1.0;
    if (kind == BroadPhaseKind::sap) {
      for (int i = 1; i <= 10; ++i) world.advance_to(end * 0.1 * i);
    } else {
      world.advance_to(0.4 * end);
      if (kind == BroadPhaseKind::grid) {
        const Snapshot saved = save(world);
        const auto before = log.events;
        world.advance_to(0.75 * end);
        restore(saved, world);
        log.events = before;
      }
      world.advance_to(end);
    }
    world.audit();
    if (expected.empty()) expected = log.events;
    CHECK(log.events.size() == expected.size());
    CHECK(log.events == expected);
  }
  CHECK(expected.size() > 30);
}

TEST_CASE("a ball put down on a sheet that stands, then rises, stays on it", "[deforming][world][response]") {
  const samples::Sheet sheet(4);
  EventLog<2> log;
  World<2> world({.response = Response::elastic}, &log);
  world.add_body(fixed_sheet<2>(
      bending({{1, sheet.positions}, {2, sheet.moved(Vector3d(0, 0, 1))}, {3, sheet.positions}}, sheet.triangles), 0));
  Path<2> path = Path<2>::line(Vector3d(0.1, 0.3, 0.25), Vector3d::Zero());
  path.coefficients[2] = Vector3d(0, 0, -5);
  const BodyId ball = world.add_body({.shape = Sphere{0.25}, .motion = {path}});
  for (double t = 0; t <= 3.25; t += 0.125) {
    world.advance_to(t);
    CAPTURE(t);
    const double height = t < 1 ? 0 : t < 2 ? t - 1 : t < 3 ? 3 - t : 0;
    const double above = world.motion(ball).position(t)[2] - 0.25 - height;
    CHECK(above >= 0);
    // While the sheet stands or rises it lies there, within the height of the shortest flights; when the sheet turns
    // round at 1 m/s the ball flies off, and is back after 0.4 s.
    if (t <= 2 || t >= 2.5) CHECK(above < 3e-6);
  }
  CHECK(log.count(Kind::overlap) == 0);
  CHECK(log.count(Kind::contact) > 1000);
}

TEST_CASE("balls that lie on a ball that lies on a sheet are lifted with it", "[deforming][world][response]") {
  const samples::Sheet sheet(2);
  World<2> world({.response = Response::elastic});
  world.add_body(
      fixed_sheet<2>(bending({{0.5, sheet.positions}, {1.5, sheet.moved(Vector3d(0, 0, 1))}}, sheet.triangles), 0));
  std::vector<BodyId> column;
  for (int i = 0; i < 3; ++i) {
    Path<2> path = Path<2>::line(Vector3d(0.25, 0.125, 0.25 + 0.5 * i), Vector3d::Zero());
    path.coefficients[2] = Vector3d(0, 0, -5);
    column.push_back(
        world.add_body({.shape = Sphere{0.25}, .motion = {path}, .mass = std::pow(8.0, i), .restitution = 0}));
  }
  for (double t = 0; t <= 1.5; t += 0.125) {
    world.advance_to(t);
    CAPTURE(t);
    const double height = std::max(0.0, t - 0.5);
    for (int i = 0; i < 3; ++i) {
      const double above = world.motion(column[static_cast<std::size_t>(i)]).position(t)[2] - 0.25 - 0.5 * i - height;
      CHECK(above > -1e-9);
      CHECK(above < 1e-4);
    }
  }
}

}  // namespace test_bending_response
