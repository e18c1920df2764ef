// Meshes that bend, and half-spaces.
#include "collision/shapes/bending_mesh.hpp"
#include "collision/shapes/mesh_script.hpp"
#include "collision/shapes/shape.hpp"
#include "collision/world.hpp"
#include "kds/framework/snapshot.hpp"
#include "tests/collision/deforming/bowls.hpp"
#include "tests/collision/event_log.hpp"
#include "tests/collision/sample_meshes.hpp"
#include "tests/collision/sample_sheets.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace test_bending_planes {
namespace {

using namespace kds;
using namespace kds::collision;
using namespace kds::collision::tests;
template <int Degree>
using Path = certificates::PointMotion<Degree>;

template <int Degree>
struct Scene {
  BendingMesh sheet;
  HalfSpace plane;
  Eigen::Quaterniond turn, of_plane;
  Path<Degree> path, path_of_plane;

  explicit Scene(samples::Random& random)
      : sheet(random_sheet(random, 0.5)),
        plane{Vector3d(0, 0, 1), random.vector(0.5)[0]},
        turn(random.orientation()),
        of_plane(random.orientation()),
        path(Path<Degree>::line(of_plane * Vector3d(0, 0, 1.5) + random.vector(1), random.vector(1.5),
                                random.vector(0.25)[0] - 0.25)),
        path_of_plane(Path<Degree>::line(random.vector(0.25), random.vector(0.5))) {
    if constexpr (Degree == 2) path.coefficients[2] = random.vector(1);
  }
  void put_into(World<Degree>& world) const {
    world.add_body({.shape = plane, .orientation = of_plane, .motion = {path_of_plane}, .fixed = true});
    world.add_body({.shape = sheet, .orientation = turn, .motion = {path}, .fixed = true});
  }
  /// Of the lowest vertex, by long doubles.
  Long height(double t) const {
    const LongVector normal = of_plane.cast<Long>() * plane.normal.cast<Long>();
    const auto at = [t](const Path<Degree>& motion) {
      LongVector sum = LongVector::Zero();
      Long power = 1;
      for (const Vector3d& c : motion.coefficients) {
        sum += power * c.template cast<Long>();
        power *= static_cast<Long>(t) - motion.start;
      }
      return sum;
    };
    Long least = INFINITY;
    for (std::size_t v = 0; v < sheet.script->vertices(); ++v) {
      const LongVector corner = turn.cast<Long>() * sheet.script->position(v, t).cast<Long>();
      least = std::min(least, normal.dot(at(path) + corner - at(path_of_plane)) - plane.offset);
    }
    return least;
  }
};

}  // namespace

TEMPLATE_TEST_CASE_SIG("a sheet that bends is in contact with a half-space while it is near, and not else",
                       "[deforming][half_space]", ((int Degree), Degree), 1, 2) {
  const std::uint64_t seed = GENERATE(1, 2, 3);
  CAPTURE(Degree, seed);
  samples::Random random(seed);
  int contacts = 0, separations = 0;
  for (int i = 0; i < 40; ++i) {
    const Scene<Degree> scene(random);
    EventLog<Degree> log;
    World<Degree> world({.response = Response::none}, &log);
    scene.put_into(world);
    world.advance_to(3);
    world.audit();
    const double tolerance = bending_tolerance * scene.sheet.script->bounding_radius();
    for (const Event& event : log.events) {
      contacts += event.kind == Kind::contact, separations += event.kind == Kind::separation;
      CAPTURE(i, event);
      if (event.kind == Kind::contact) {
        CHECK(scene.height(event.time()) == Approx(tolerance).epsilon(0).margin(tolerance / 2));
        CHECK(event.contact.feature_b.kind == Feature::Kind::vertex);
        CHECK((event.contact.normal - scene.of_plane * scene.plane.normal).norm() < 1e-15);
        const Vector3d above = event.contact.point - scene.path_of_plane.position(event.time());
        CHECK(std::abs(event.contact.normal.dot(above) - scene.plane.offset) < 2 * tolerance);
      }
    }
    for (double t = 0.001; t < 3; t += 0.01) {
      bool touching = false;
      for (const Event& event : log.events) {
        if (event.time() <= t) touching = event.kind != Kind::separation;
      }
      const auto height = static_cast<double>(scene.height(t));
      CAPTURE(i, t, height);
      CHECK((touching ? height <= 2 * tolerance : height > tolerance / 2));
    }
  }
  CHECK(contacts > 5);
  CHECK(separations > 3);
}

TEST_CASE("sheets that bend above a half-space: the same events by all broad phases, and after a snapshot",
          "[deforming][half_space]") {
  const Response response = GENERATE(Response::none, Response::elastic);
  std::vector<Event> expected;
  for (const BroadPhaseKind kind :
       {BroadPhaseKind::all_pairs, BroadPhaseKind::automatic, BroadPhaseKind::grid, BroadPhaseKind::kinetic_sap}) {
    samples::Random random(7);
    EventLog<2> log;
    World<2> world({.response = response, .broad_phase = kind}, &log);
    for (int i = 0; i < 5; ++i) Scene<2>(random).put_into(world);
    world.advance_to(1);
    const Snapshot saved = save(world);
    const auto before = log.events;
    world.advance_to(2);
    restore(saved, world);
    log.events = before;
    world.advance_to(3);
    world.audit();
    if (expected.empty()) expected = log.events;
    CHECK(log.events == expected);
  }
  CHECK(expected.size() > 10);
}

TEST_CASE("a membrane is let down to the ground and lifted again", "[deforming][half_space][degeneracy]") {
  const samples::Sheet sheet(2);
  const auto at = [&](double z) { return sheet.moved(Vector3d(0, 0, z)); };
  // All vertices arrive at once, and stay for a while.
  const BendingMesh membrane{std::make_shared<const MeshScript>(
      std::vector<MeshScript::Keyframe>{{1, at(1)}, {2, at(0)}, {3, at(0)}, {4, at(1)}}, sheet.triangles)};
  EventLog<1> log;
  World<1> world({.response = Response::none}, &log);
  const Path<1> still = Path<1>::line(Vector3d::Zero(), Vector3d::Zero());
  world.add_body({.shape = HalfSpace{Vector3d(0, 0, 1), 0}, .motion = {still}, .fixed = true});
  world.add_body({.shape = membrane, .motion = {still}});
  world.advance_to(2.5);
  CHECK(world.touching(0, 1));
  world.advance_to(10);
  CAPTURE(log.events);
  REQUIRE(log.events.size() == 2);
  CHECK(log.events[0].kind == Kind::contact);
  CHECK((log.events[0].time() <= 2 && log.events[0].time() > 2 - 1e-7));
  CHECK(log.events[0].contact.feature_b == Feature::vertex(0));
  CHECK(log.events[1].kind == Kind::separation);
  CHECK((log.events[1].time() >= 3 && log.events[1].time() < 3 + 1e-7));
}

}  // namespace test_bending_planes
