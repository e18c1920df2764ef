// Compounds in worlds of bodies that turn: they bounce, tumble and come to rest as one body.
#include "collision/queries/casts.hpp"
#include "collision/queries/future.hpp"
#include "collision/queries/nearest.hpp"
#include "collision/response/mass_properties.hpp"
#include "collision/shapes/compound.hpp"
#include "collision/shapes/convex_hull.hpp"
#include "collision/shapes/polytope.hpp"
#include "collision/world.hpp"
#include "collision/world/turning/turning_extents.hpp"
#include "kds/framework/snapshot.hpp"
#include "tests/collision/sample_meshes.hpp"
#include "tests/collision_turning/half_space_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <variant>
#include <vector>

namespace test_turning_compounds {
namespace {

using namespace kds;
using namespace kds::collision;
using namespace kds::tests::planes;
using kds::tests::motion_of;
using kds::tests::Random;
using kds::tests::random_vector;

/// Two cubes and the rod between them.
Compound dumb_bell() {
  return compound(std::vector<CompoundPart>{
      {Box{{0.5, 0.0625, 0.0625}}}, {Box{{0.25, 0.25, 0.25}}, {0.75, 0, 0}}, {Box{{0.25, 0.25, 0.25}}, {-0.75, 0, 0}}});
}

/// A top on four legs, about its centre of mass.
Compound table() {
  std::vector<CompoundPart> parts{{Box{{0.5, 0.5, 0.0625}}}};
  for (const double x : {-0.4375, 0.4375}) {
    for (const double y : {-0.4375, 0.4375}) parts.push_back({Box{{0.0625, 0.0625, 0.25}}, {x, y, -0.3125}});
  }
  return compound(about_centre_of_mass(parts));
}

/// A head, which is a mesh, on a handle.
Compound hammer() {
  const std::vector<CompoundPart> parts{{Box{{0.5, 0.0625, 0.0625}}},
                                        {MeshShape{samples::cuboid({0.125, 0.3125, 0.125})}, {0.625, 0, 0}}};
  return compound(about_centre_of_mass(parts));
}

std::vector<Vector3d> points_of(const Compound& shape) {
  std::vector<Vector3d> points;
  for (const Shape& part : shape.parts->parts()) {
    if (const auto* const hull = std::get_if<ConvexHull>(&part)) {
      points.insert(points.end(), hull->polytope->points().begin(), hull->polytope->points().end());
    } else {
      const auto vertices = std::get<MeshShape>(part).mesh->vertices();
      points.insert(points.end(), vertices.begin(), vertices.end());
    }
  }
  return points;
}

double lowest(const Turning& world, BodyId id, const Compound& shape) {
  double least = never;
  for (const Vector3d& x : points_of(shape)) {
    least = std::min(least, world.motion(id).position(x, world.now()).vector[2]);
  }
  return least;
}

struct Sums {
  double energy = 0;
  Vector3d momentum = zero, angular = zero;
};

/// Of free bodies of the mass 1 that nothing accelerates.
Sums sums(const Turning& world, const std::vector<BodyId>& ids) {
  Sums sums;
  for (const BodyId id : ids) {
    const FreeTurning turning = world.free_turning(id);
    const auto& path = world.motion(id).path;
    const Vector3d v = path.velocity(world.now());
    sums.energy += 0.5 * v.squaredNorm() + 0.5 * turning.angular_momentum.dot(turning.angular_velocity);
    sums.momentum += v;
    sums.angular += path.position(world.now()).cross(v) + turning.angular_momentum;
  }
  return sums;
}

/// Compounds and others that fly about in a room of half-spaces, above a fixed table.
void fill_room(Turning& world, std::uint64_t seed) {
  add_room(world, 3);
  world.add_body(fixed(table(), {0, 0, -2.5}, Quaterniond(1, 0.25, 0, 0.5)));
  Random random(seed);
  const std::vector<Shape> shapes{dumb_bell(), Sphere{0.375},
                                  table(),     Capsule{0.25, 0.5},
                                  hammer(),    MeshShape{samples::cuboid(Vector3d(0.5, 0.5, 0.25))}};
  for (std::size_t i = 0; i < 12; ++i) {
    const auto place = [](std::size_t k) { return 1.75 * (static_cast<double>(k % 3) - 1); };
    add_flying(world, shapes[i % shapes.size()], i, {place(i), place(i / 3 % 2), i < 6 ? -0.5 : 1.75}, random);
  }
}

}  // namespace

TEST_CASE("a dumb-bell tumbles and hits a post with one of its ends", "[turning][compound]") {
  Log log;
  Turning world(options(), &log);
  const BodyId bell = world.add_body({.shape = dumb_bell(), .motion = {motion_of<2>({0, 0, 0}, {0, 0, 0}, {0, 0, 2})}});
  Body post = fixed(Sphere{0.125}, {0, 0.875, 0});
  const BodyId id = world.add_body(post);
  world.advance_to(1);
  REQUIRE(log.count("contact") == 1);
  const Contact& contact = log.events[0].contact;
  CHECK((log.events[0].a == bell && log.events[0].b == id));
  // The long side of the cube, 1/4 beside its middle, is at the ball's height when sin a = (1/4 + 1/8) / (7/8).
  const double angle = std::acos(0.375 / 0.875);
  CHECK(std::abs(contact.time - (std::acos(-1.0) / 2 - std::asin(0.375 / 0.875)) / 2) < 1e-12);
  CHECK(std::abs(contact.time - angle / 2) < 1e-12);
  CHECK(std::abs(world.motion(bell).path.velocity(1)[0]) > 0.1);
}

TEST_CASE("a compound of one part does what the part does, to the bit", "[turning][compound]") {
  const Shape tetrahedron = convex_hull({{0.5, 0.5, 0.5}, {0.5, -0.5, -0.5}, {-0.5, 0.5, -0.5}, {-0.5, -0.5, 0.5}});
  const Shape block = convex_hull({{0.5, 0.25, 0.375},
                                   {-0.5, 0.25, 0.375},
                                   {0.5, -0.25, 0.375},
                                   {0.5, 0.25, -0.375},
                                   {-0.5, -0.25, 0.375},
                                   {-0.5, 0.25, -0.375},
                                   {0.5, -0.25, -0.375},
                                   {-0.5, -0.25, -0.375}});
  const Shape mesh = MeshShape{samples::cuboid(Vector3d(0.5, 0.375, 0.25))};
  const auto run = [&](bool as_compounds) {
    auto log = std::make_unique<Log>();
    Turning world(options(), log.get());
    world.add_body(ground());
    Random random(3);
    for (std::size_t i = 0; i < 9; ++i) {
      Shape shape = std::array{tetrahedron, block, mesh}[i % 3];
      if (as_compounds) shape = compound(std::vector{CompoundPart{shape}});
      const Vector3d at(1.25 * static_cast<double>(i % 3), 1.25 * static_cast<double>(i / 3), 2);
      Body body = thrown(shape, at, random_vector(random, 2), random_vector(random, 4));
      body.restitution = 0.5, body.friction = i % 2 == 0 ? 0.25 : 0;
      world.add_body(body);
    }
    world.advance_to(1);
    return log;
  };
  const auto alone = run(false), as_compounds = run(true);
  CHECK(alone->count("contact") > 40);
  CHECK(alone->events == as_compounds->events);
}

TEST_CASE("dumb-bells that meet keep their energy and momenta", "[turning][compound]") {
  Log log;
  WorldOptions exact = options();
  exact.shortest_flight = 1e-12;
  Turning world(exact, &log);
  Random random(7);
  std::vector<BodyId> ids;
  for (int i = 0; i < 8; ++i) {
    const Vector3d at = 2.0 * Vector3d(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
    RigidMotion<2> motion = motion_of<2>(at, -0.5 * at + random_vector(random, 0.5), random_vector(random, 4));
    motion.path.coefficients[2] = zero;
    ids.push_back(world.add_body({.shape = i % 3 == 0 ? Shape(table()) : Shape(dumb_bell()), .motion = {motion}}));
  }
  const Sums before = sums(world, ids);
  world.advance_to(8);
  const Sums after = sums(world, ids);
  CHECK(log.count("contact") > 10);
  CHECK(world.counters().orientation_resets == 0);
  CHECK(std::abs(after.energy / before.energy - 1) < 1e-13);
  CHECK((after.momentum - before.momentum).norm() < 1e-13);
  CHECK((after.angular - before.angular).norm() < 1e-11);
}

TEST_CASE("compounds that turn: the same log by each broad phase, in windows and over snapshots",
          "[turning][compound][snapshot]") {
  const double until = 0.75;
  const auto run = [&](BroadPhaseKind kind, bool saved) {
    auto log = std::make_unique<Log>();
    auto world = std::make_unique<Turning>(options(kind), log.get());
    fill_room(*world, 5);
    for (int k = 1; k <= 4; ++k) {
      world->advance_to(until * k / 4);
      world->audit();
      if (!saved) continue;
      const auto image = save(*world);
      world = std::make_unique<Turning>(options(kind), log.get());
      restore(image, *world);
    }
    return log;
  };
  const auto first = run(BroadPhaseKind::all_pairs, false);
  CHECK(first->count("contact") > 20);
  for (const BroadPhaseKind kind : all_methods) CHECK(run(kind, false)->events == first->events);
  CHECK(run(BroadPhaseKind::automatic, true)->events == first->events);
}

TEST_CASE("tables that are dropped come to rest, on a half-space and on a box", "[turning][compound][rest]") {
  for (const bool on_box : {false, true}) {
    const Compound shape = on_box ? table() : dumb_bell();
    CAPTURE(on_box);
    Log log;
    Turning world(options(), &log);
    Body floor = on_box ? fixed(Box{Vector3d(8, 8, 0.5)}, {0, 0, -0.5}) : ground();
    floor.friction = 0.5;
    const BodyId below = world.add_body(floor);
    Body body = thrown(shape, {0, 0, 1.25}, {0.5, 0, 0}, {1, 0.5, 0.25}, Quaterniond(1, 0.125, 0.25, 0));
    body.restitution = 0.25, body.friction = 0.5;
    const BodyId id = world.add_body(body);
    world.advance_to(6);
    world.audit();
    CHECK(world.resting(below, id));
    CHECK(std::abs(lowest(world, id, shape)) < 1e-4);
  }
}

TEST_CASE("compounds that are driven turn as they are told, and queries see their parts",
          "[turning][compound][queries]") {
  // A door of two panels with a gap between them, which turns about its post, the z axis.
  const std::vector<CompoundPart> panels{{Box{{1, 0.0625, 0.25}}, {1, 0, 0.5}}, {Box{{1, 0.0625, 0.25}}, {1, 0, -0.5}}};
  Turning world(options());
  RigidMotion<2> motion = motion_of<2>(zero, zero, {0, 0, 1});
  const BodyId door = world.add_body({.shape = compound(panels), .motion = {motion}, .fixed = true});
  RigidMotion<2> away = motion_of<2>({0, 1.5, 0.5}, zero, zero);
  const BodyId ball = world.add_body({.shape = Sphere{0.25}, .motion = {away}, .sensor = true});
  const auto meets = next_contact_between(world, door, ball, 2);
  REQUIRE(meets);
  CHECK(std::abs(meets->time - (std::acos(-1.0) / 2 - std::asin(0.3125 / 1.5))) < 1e-9);
  world.advance_to(std::acos(-1.0) / 2);  // It is along the y axis.
  CHECK(overlapping(world, place(Sphere{0.125}, Quaterniond::Identity()), {0, 1.75, 0.5}) ==
        std::vector<BodyId>{door, ball});
  CHECK(overlapping(world, place(Sphere{0.125}, Quaterniond::Identity()), {0, 1.75, 0}).empty());
  const auto hit = cast(world, Ray{{-2, 0.5, 0.5}, {2, 0.5, 0.5}});
  REQUIRE(hit);
  CHECK(hit->body == door);
  CHECK(std::abs(hit->contact.point[0] + 0.0625) < 1e-9);
  CHECK_FALSE(cast(world, Ray{{-2, 0.5, 0}, {2, 0.5, 0}}));
  const auto near = nearest(world, Vector3d(0, 0.5, 0), 1);
  REQUIRE(near.size() == 1);
  CHECK((near[0].body == door && std::abs(near[0].distance - 0.25) < 1e-9));
  // What is thrown through the gap passes.
  Body small = thrown(Sphere{0.125}, {-1, 0.5, 0}, {4, 0, 0}, zero);
  small.motion[0].path.start = world.now();
  small.motion[0].path.coefficients[2] = zero;
  const BodyId through = world.add_body(small);
  CHECK_FALSE(next_contact_between(world, door, through, world.now() + 0.375));
}

TEST_CASE("the volume of a compound that turns holds it, and is no larger than its ball", "[turning][compound]") {
  Random random(9);
  for (int i = 0; i < 40; ++i) {
    const Compound shape = i % 2 == 0 ? table() : i % 4 == 1 ? dumb_bell() : hammer();
    RigidMotion<2> motion = motion_of<2>(zero, zero, i % 5 == 0 ? zero : random_vector(random, 3));
    const Vector3d v = random_vector(random, 1);
    motion.orientation = Quaterniond(random.between(-1, 1), v[0], v[1], v[2]);
    const PlacedShape placed = place(shape, Quaterniond::Identity());
    const Vector3d half = turning_half_extents(placed, motion);
    CHECK(half.maxCoeff() <= placed.bounding_radius);
    Vector3d reached = zero;
    for (int k = 0; k < 200; ++k) {
      for (const Vector3d& x : points_of(shape)) {
        reached = reached.cwiseMax(motion.position(x, 0.05 * k).vector.cwiseAbs());
      }
    }
    CHECK((reached.array() <= half.array()).all());
  }
  const RigidMotion<2> still = motion_of<2>(zero, zero, zero);
  CHECK((turning_half_extents(place(dumb_bell(), Quaterniond::Identity()), still) - Vector3d(1, 0.25, 0.25)).norm() <
        1e-9);
}

TEST_CASE("compounds that cannot turn freely are refused, and nothing is added", "[turning][compound]") {
  Turning world(options());
  const auto refused = [&](const Shape& shape, const std::string& what) {
    CHECK_THROWS_WITH(world.add_body(thrown(shape, zero, zero, zero)), Catch::StartsWith(what));
    CHECK(world.size() == 0);
  };
  const std::vector<CompoundPart> beside{{Box{{1, 1, 1}}}, {Box{{1, 1, 1}}, {2, 0, 0}}};
  refused(compound(beside),
          "inertia: the centre of mass of this compound is at (1, 0, 0), and free bodies turn about "
          "their origin: subtract it from the positions of the parts, or give their inertia");
  const auto open = std::make_shared<const Mesh>(std::vector<Vector3d>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                                                 std::vector<Mesh::Triangle>{{0, 1, 2}});
  const Compound with_open = compound(std::vector<CompoundPart>{{Box{{1, 1, 1}}}, {MeshShape{open}}});
  refused(with_open, "compound: part 1: mass_properties: the mesh is open: edge 0-1 belongs to one triangle, 0");
  refused(Compound{}, "compound: is missing");
  // With an inertia that is given, or fixed, both can be.
  Body given = thrown(with_open, zero, zero, {1, 0, 0});
  given.inertia = 1;
  world.add_body(given);
  world.add_body(fixed(compound(beside), {9, 0, 0}));
  CHECK(world.size() == 2);
}

}  // namespace test_turning_compounds
