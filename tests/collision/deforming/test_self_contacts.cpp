#include "collision/shapes/bending_mesh.hpp"
#include "collision/shapes/mesh_script.hpp"
#include "collision/world.hpp"
#include "kds/framework/snapshot.hpp"
#include "tests/collision/deforming/brute_sheets.hpp"
#include "tests/collision/deforming/folded_strip.hpp"
#include "tests/collision/event_log.hpp"
#include "tests/collision/sample_meshes.hpp"
#include "tests/collision/sample_sheets.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

namespace test_self_contacts {
namespace {

using namespace kds;
using namespace kds::collision;
using namespace kds::collision::tests;
using Path = certificates::PointMotion<1>;
using Keyframes = std::vector<MeshScript::Keyframe>;

BodyDescription<1> sheet_of(const Keyframes& keyframes, const samples::Sheet& sheet) {
  return {.shape = BendingMesh{std::make_shared<const MeshScript>(keyframes, sheet.triangles)},
          .orientation = Eigen::Quaterniond(0.6, 0, 0.8, 0),
          .motion = {Path::line(Vector3d(1, 2, 3), Vector3d(5, 0, 0))},
          .self_contacts = true};
}

/// The least distance of two features without a common vertex; 0 where an edge goes through such a face.
Long self_distance(const std::vector<LongVector>& v, const std::vector<Mesh::Triangle>& triangles) {
  Long least = INFINITY;
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const auto& [a, b, c] : triangles) {
    for (const auto& [x, y] : {std::pair{a, b}, std::pair{b, c}, std::pair{c, a}}) edges.emplace(std::minmax(x, y));
  }
  for (const auto& [a, b, c] : triangles) {
    for (std::uint32_t p = 0; p < v.size(); ++p) {
      if (p != a && p != b && p != c) least = std::min(least, height_over(v[p], v[a], v[b], v[c]));
    }
    for (const auto& [p, q] : edges) {
      if (p == a || p == b || p == c || q == a || q == b || q == c) continue;
      if (go_through({{v[p], v[q]}, {}, {{0, 1}}}, {{v[a], v[b], v[c]}, {{0, 1, 2}}, {}})) return 0;
    }
  }
  for (const auto& [a, b] : edges) {
    for (const auto& [c, d] : edges) {
      if (a == c || a == d || b == c || b == d) continue;
      least = std::min({least, distance_across(v[a], v[b], v[c], v[d]), distance_to_segment(v[a], v[c], v[d]),
                        distance_to_segment(v[b], v[c], v[d])});
    }
  }
  return least;
}

}  // namespace

TEST_CASE("a strip that is folded down on itself: contact and separation of a body with itself", "[deforming][world]") {
  const Fold fold;
  const Response response = GENERATE(Response::none, Response::elastic);
  EventLog<1> log;
  World<1> world({.response = response}, &log);
  auto description = sheet_of(fold.keyframes, fold.sheet);
  description.fixed = true;
  const BodyId strip = world.add_body(description);
  const BodyId other =
      world.add_body({.shape = Sphere{0.1}, .motion = {Path::line(Vector3d(1, 9, 3), Vector3d::Zero())}});
  world.advance_to(2.5625);
  CHECK(world.touching(strip, strip));
  CHECK_FALSE(world.touching(other, other));
  world.audit();
  world.advance_to(6);
  CHECK_FALSE(world.touching(strip, strip));
  world.audit();
  REQUIRE(log.events.size() == 4);
  for (std::size_t i = 0; i < 4; ++i) {
    const Event& event = log.events[i];
    const double expected = 2.5 + (i % 2 == 0 ? 0 : 0.125) + (i < 2 ? 0 : 0.875);
    CAPTURE(i, event);
    CHECK(event.kind == (i % 2 == 0 ? Kind::contact : Kind::separation));
    CHECK((event.a == strip && event.b == strip));
    CHECK((i % 2 == 0 ? expected - event.time() : event.time() - expected) >= 0);
    CHECK(event.time() == Approx(expected).epsilon(0).margin(1e-6));
  }
  const Event& contact = log.events[0];
  // The vertices of the end come down on edges from x = -1 / 2 to 0.
  CHECK(contact.time() <= 2.5);
  CHECK(contact.time() == Approx(2.5).epsilon(0).margin(1e-6));
  CHECK((contact.contact.feature_a.kind == Feature::Kind::vertex) !=
        (contact.contact.feature_b.kind == Feature::Kind::vertex));
  const Eigen::Matrix3d turn = description.orientation.toRotationMatrix();
  CHECK(std::abs(std::abs(contact.contact.normal.dot(turn.col(2))) - 1) < 1e-6);
  const Vector3d point = turn.transpose() * (contact.contact.point - Vector3d(1 + 5 * contact.time(), 2, 3));
  CHECK(std::abs(point[0] + 0.25) < 1e-6);
  CHECK(std::abs(point[2]) < 1e-6);
}

TEST_CASE("sheets that bend at random touch themselves while brute force says so", "[deforming][world]") {
  const std::uint64_t seed = GENERATE(1, 2, 3, 4);
  CAPTURE(seed);
  const samples::Sheet sheet(3);
  std::vector<Event> expected;
  for (const BroadPhaseKind kind : {BroadPhaseKind::all_pairs, BroadPhaseKind::grid, BroadPhaseKind::kinetic_sap}) {
    CAPTURE(static_cast<int>(kind));
    samples::Random random(seed);
    const auto shaken = [&] {
      auto positions = sheet.positions;
      for (Vector3d& p : positions) p += random.vector(0.75);
      return positions;
    };
    Keyframes keyframes;
    for (int i = 0; i < 4; ++i) keyframes.push_back({0.5 * i + 0.25, i == 0 ? sheet.positions : shaken()});
    EventLog<1> log;
    World<1> world({.response = Response::none, .broad_phase = kind}, &log);
    const BodyId id = world.add_body(sheet_of(keyframes, sheet));
    for (int i = 1; i <= 80; ++i) {
      const double t = i / 32.0;
      world.advance_to(t);
      if (i == 20 || i == 70) world.update_vertices(id, {{t + 0.3, shaken()}, {t + 0.7, shaken()}});
      if (i == 40 && kind == BroadPhaseKind::grid) {
        const Snapshot saved = save(world);
        const auto before = log.events;
        world.advance_to(2.25);
        restore(saved, world);
        log.events = before;
      }
      const auto script = std::get<BendingMesh>(world.shape(id).shape).script;
      std::vector<LongVector> v;
      for (std::size_t k = 0; k < script->vertices(); ++k) v.push_back(script->position(k, t).cast<Long>());
      const Long distance = self_distance(v, sheet.triangles);
      CAPTURE(t, static_cast<double>(distance));
      const double tolerance = bending_tolerance * script->bounding_radius();
      CHECK((world.touching(id, id) ? distance < 3 * tolerance : distance > 0));
    }
    world.audit();
    if (expected.empty()) expected = log.events;
    CHECK(log.events == expected);
    for (std::size_t i = 0; i < log.events.size(); ++i) {
      CHECK(log.events[i].kind == (i % 2 == 0 ? Kind::contact : Kind::separation));
      CHECK(log.events[i].contact.feature_a != log.events[i].contact.feature_b);
    }
  }
  CHECK(!expected.empty());
}

TEST_CASE("a sheet that touches itself when it enters, and is removed", "[deforming][world]") {
  const Fold fold;
  EventLog<1> log;
  World<1> world({.response = Response::none}, &log);
  const BodyId strip = world.add_body(sheet_of({{0, fold.with_end({-1.25, 0, -0.125})}}, fold.sheet));
  world.advance_to(1);
  REQUIRE(log.events.size() == 1);
  CHECK(log.events[0].kind == Kind::overlap);
  CHECK((log.events[0].a == strip && log.events[0].b == strip));
  world.remove_body(strip);
  world.advance_to(2);
  REQUIRE(log.events.size() == 2);
  CHECK(log.events[1].kind == Kind::separation);
  CHECK_THROWS_WITH(
      world.add_body(
          {.shape = Sphere{1}, .motion = {Path::line(Vector3d::Zero(), Vector3d::Zero())}, .self_contacts = true}),
      "self_contacts: a sphere does not bend, and never meets itself");
}

}  // namespace test_self_contacts
