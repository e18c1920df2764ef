// Bodies that turn bounce off meshes that bend.
#include "collision/shapes/bending_mesh.hpp"
#include "collision/world.hpp"
#include "tests/collision_turning/bending_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace test_turning_off_bending {

using namespace kds;
using namespace kds::tests::sheets;

TEST_CASE("what turns and falls into a bowl that heaves never goes into it") {
  const std::uint64_t seed = GENERATE(1, 2, 3, 4);
  CAPTURE(seed);
  samples::Random random(seed);
  for (const Solid& solid : solids()) {
    const Bowl bowl(random, seed == 2 ? 40 : 5, 1);
    Log log;
    Turning world({.response = Response::elastic}, &log);
    world.add_body(fixed_sheet(bowl.shape(), 0.25 * static_cast<double>(seed - 1)));
    RigidMotion<2> motion{Path::line(Vector3d(0.25, -0.125, 0.75) + random.vector(0.125), random.vector(0.25)),
                          random.orientation(), random.vector(10)};
    motion.path.coefficients[2] = Vector3d(0, 0, -5);
    Body description{.shape = solid.shape, .motion = {motion}};
    if (off_centre(solid.shape)) description.inertia = 0.01;
    if (seed % 2 == 0) description.friction = 0.5;
    const BodyId body = world.add_body(description);
    for (double t = 0; t <= 1; t += 1.0 / 64) {
      world.advance_to(t);
      const BruteSurface field = bowl.at(t);
      const RigidMotion<2> now = world.motion(body);
      const BruteSurface placed = solid_at(solid, now, t);
      CAPTURE(t, kind_name(solid.shape), log.events.size());
      CHECK(brute_distance(field, placed) > solid.radius);
      CHECK_FALSE(go_through(field, placed));
      const LongVector place = place_at(now, t);
      CHECK(place[2] > height_at(field, place[0], place[1]));
    }
    CHECK(log.count("contact") > 1);
    CHECK(log.count("passes") == 0);
    CHECK(log.count("overlap") == 0);
    CHECK(log.count("rests") == 0);
  }
}

TEST_CASE("a contact gives what turns the velocity of the surface and the rebound, at the point that they touch with") {
  const std::uint64_t seed = GENERATE(1, 2, 3);
  CAPTURE(seed);
  samples::Random random(seed);
  const auto all = solids();
  int checked = 0;
  for (int i = 0; i < 24; ++i) {
    const double restitution = 0.5 + 0.25 * (i % 3);
    // A plate that rises, and tilts as it does: its velocity at a place is a linear function of that.
    const samples::Sheet plate(2, 4);
    const double rise = random.vector(0.5)[0], tilt = random.vector(0.25)[0];
    auto later = plate.positions;
    for (Vector3d& p : later) p[2] += rise + tilt * p[0];
    const BendingMesh sheet = bending({{0, plate.positions}, {1, later}}, plate.triangles);
    Log log;
    Turning world({.response = Response::elastic}, &log);
    world.add_body(fixed_sheet(sheet, restitution));
    const Solid& solid = all[static_cast<std::size_t>(i) % all.size()];
    const RigidMotion<2> motion{Path::line(Vector3d(0.25, -0.125, 0.75), random.vector(0.5) + Vector3d(0, 0, -2)),
                                random.orientation(), random.vector(8)};
    Body description{.shape = solid.shape, .motion = {motion}, .mass = 2};
    description.inertia = 0.01;
    const BodyId body = world.add_body(description);
    while (log.count("contact") == 0 && world.step(1)) {
    }
    REQUIRE(log.count("contact") == 1);
    const Contact& contact = log.events[0].contact;
    const RigidMotion<2> after = world.motion(body);
    const double t = contact.time;
    const Vector3d arm = contact.point - after.path.position(t);
    const Vector3d surface(0, 0, rise + tilt * contact.point[0]);
    const auto parts = [&](const Vector3d& velocity, const Vector3d& spin) {
      return contact.normal.dot(velocity + spin.cross(arm) - surface);
    };
    const double before = parts(motion.path.velocity(t), motion.angular_velocity);
    CAPTURE(i, kind_name(solid.shape), t);
    CHECK(before < 0);
    CHECK(parts(after.path.velocity(t), after.angular_velocity) == Approx(-restitution * before).epsilon(1e-6));
    // The impulse is along the normal, and turns the body by the arm.
    const Vector3d impulse = 2 * (after.path.velocity(t) - motion.path.velocity(t));
    CHECK(impulse.cross(contact.normal).norm() < 1e-9);
    CHECK((0.01 * (after.angular_velocity - motion.angular_velocity) - arm.cross(impulse)).norm() < 1e-9);
    ++checked;
  }
  CHECK(checked == 24);
}

TEST_CASE("a membrane that is moved step by step wakes what rests in its way, and pushes it on") {
  std::vector<Vector3d> positions;  // upright, above the plate on which a box lies
  const samples::Sheet sheet(4);
  for (const Vector3d& p : sheet.positions) positions.emplace_back(0, p[0], p[1] + 1.625);
  const auto at = [&](double x) {
    auto moved = positions;
    for (Vector3d& p : moved) p[0] = x + 0.0625 * p[1] * p[1];
    return moved;
  };
  Log log;
  Turning world({.response = Response::elastic}, &log);
  const BodyId membrane = world.add_body(fixed_sheet(bending({{0, at(-0.5)}}, sheet.triangles), 0));
  world.add_body({.shape = Box{Vector3d(2, 2, 0.5)}, .motion = {RigidMotion<2>{}}, .fixed = true});
  RigidMotion<2> falls{Path::line(Vector3d(0, 0, 0.8125), Vector3d::Zero())};
  falls.path.coefficients[2] = Vector3d(0, 0, -5);
  const Solid cube = solids()[2];
  const BodyId box = world.add_body({.shape = cube.shape, .motion = {falls}, .restitution = 0, .friction = 0.5});
  world.advance_to(2);
  REQUIRE(log.count("rests") == 1);
  for (int step = 1; step <= 24; ++step) {
    const double t = 2 + step / 16.0, x = -0.5 + step / 32.0;
    world.update_vertices(membrane, {{t, at(x)}});
    world.advance_to(t);
    BruteSurface surface;
    for (const Vector3d& p : at(x)) surface.corners.push_back(p.cast<Long>());
    surface.faces = sheet.triangles;
    surface.add_edges_of_faces();
    const BruteSurface placed = solid_at(cube, world.motion(box), t);
    CAPTURE(t, log.events.size());
    CHECK_FALSE(go_through(surface, placed));
    CHECK(brute_distance(surface, placed) > 0);
    CHECK(place_at(world.motion(box), t)[0] > x);
  }
  CHECK(log.count("wakes") >= 1);
  CHECK(log.count("passes") == 0);
  CHECK(place_at(world.motion(box), world.now())[0] > 0.25);
}

}  // namespace test_turning_off_bending
