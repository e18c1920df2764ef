// Bodies that turn come to rest, and wake.
#include "collision/shapes/mesh.hpp"
#include "kds/framework/snapshot.hpp"

#include "tests/collision_turning/narrow_phase/turning_solids.hpp"
#include "tests/collision_turning/rest_scenes.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace test_turning_rest {
namespace {

using namespace kds;
using namespace kds::collision;
using namespace kds::tests::rest;
using kds::tests::Random;
using kds::tests::random_vector;

constexpr double pi = 3.14159265358979323846;

Quaterniond any_orientation(Random& random) {
  const double w = random.between(-1, 1);
  const Vector3d v = random_vector(random, 1);
  return {w, v[0], v[1], v[2]};
}

/// The lowest corner of a box.
double lowest(const Turning& world, BodyId id, const Vector3d& half) {
  const auto& motion = world.motion(id);
  double z = never;
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3d x(corner & 1 ? half[0] : -half[0], corner & 2 ? half[1] : -half[1], corner & 4 ? half[2] : -half[2]);
    z = std::min(z, motion.position(x, world.now()).vector[2]);
  }
  return z;
}

}  // namespace

TEST_CASE("a cube that falls on a face, an edge or a corner comes to rest", "[rest]") {
  for (const Quaterniond& orientation :
       {Quaterniond::Identity(), tilted(pi / 4 + 0.1, {1, 0, 0}), tilted(0.9, {1, -1, 0.1})}) {
    CAPTURE(orientation.coeffs());
    Log log;
    Turning world(options(), &log);
    const BodyId floor = world.add_body(ground());
    const BodyId cube = world.add_body(body(Box{Vector3d::Constant(0.5)}, {0, 0, 1.5}, orientation));
    world.advance_to(0.25);
    CHECK_FALSE(world.resting(floor, cube));
    world.advance_to(5);
    CHECK(log.rested == 1);
    CHECK(log.woken == 0);
    CHECK(world.resting(cube, floor));
    CHECK(world.counters().rebounds_suppressed == 1);
    CHECK(still(world, cube));
    CHECK(std::abs(world.motion(cube).path.position(5)[2] - 0.5) < 2 * holding_distance);
    CHECK(world.free_motion(cube).path.coefficients[2] == Vector3d(0, 0, -gravity / 2));
    world.audit();
  }
}

TEST_CASE("a box thrown at random comes to rest on a face, and costs nothing", "[rest]") {
  const Vector3d half(0.3, 0.4, 0.5);
  const double moment = 1.0 / 3 * (0.4 * 0.4 + 0.5 * 0.5);  // the greatest
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    Log log;
    Turning world(options(), &log);
    world.add_body(ground());
    const BodyId die = world.add_body(body(Box{half}, {0, 0, 2}, any_orientation(random), random_vector(random, 5)));
    const auto energy = [&] {
      const FreeTurning turning = world.free_turning(die);
      const auto& path = world.motion(die).path;
      return gravity * path.position(world.now())[2] + path.velocity(world.now()).squaredNorm() / 2 +
             turning.angular_momentum.dot(turning.angular_velocity) / 2;
    };
    // A flight gives a body that is pressed down this much at most, at each of its corners.
    const double flights = 4 * gravity * gravity * flight * flight * (1 + moment);
    double before = energy();
    while (!still(world, die) && world.now() < 30 && world.step(30)) {
      const double now = energy();
      if (!(now <= before + flights)) CHECK(now <= before + flights);
      before = std::min(before, now);
    }
    REQUIRE(still(world, die));
    world.audit();
    CHECK(log.passed == 0);
    // On a face, and as low as that allows.
    const auto& at = world.motion(die);
    int faces = 0;
    for (int d = 0; d < 3; ++d) {
      if (std::abs(at.direction(Vector3d::Unit(d), world.now()).vector[2]) < 1 - 8 * holding_distance) continue;
      ++faces;
      CHECK(std::abs(at.path.position(world.now())[2] - half[d]) < 2 * holding_distance);
    }
    CHECK(faces == 1);
    CHECK(lowest(world, die, half) > -1e-14);

    const auto rests = at;
    const int contacts = log.contacts;
    const auto tests = world.counters().pair_tests;
    world.advance_to(world.now() + 1000);
    CHECK(log.contacts == contacts);
    CHECK(world.counters().pair_tests <= tests + 2);
    CHECK(world.motion(die) == rests);
  }
}

TEST_CASE("a stack of boxes comes to rest, the same with all broad phases and snapshots", "[rest]") {
  std::vector<std::string> expected;
  for (const auto kind : {BroadPhaseKind::automatic, BroadPhaseKind::all_pairs, BroadPhaseKind::kinetic_sap,
                          BroadPhaseKind::grid, BroadPhaseKind::sap}) {
    for (const bool saves : {false, true}) {
      if (saves && kind != BroadPhaseKind::automatic) continue;
      CAPTURE(static_cast<int>(kind), saves);
      Log log;
      auto world = std::make_unique<Turning>(options(kind), &log);
      world->add_body(ground());
      constexpr BodyId top = 2;
      for (BodyId i = 1; i <= top; ++i) {
        world->add_body(body(Box{Vector3d(0.5, 0.5, 0.25)}, {0.02 * static_cast<double>(i % 2), 0, 0.55 * i - 0.2}));
      }
      for (int k = 1; k <= 32; ++k) {
        world->advance_to(k / 32.0);
        if (!saves) continue;
        world->audit();
        const auto image = save(*world);
        world = std::make_unique<Turning>(options(kind), &log);
        restore(image, *world);
      }
      for (BodyId i = 0; i < top; ++i) CHECK(world->resting(i, i + 1));
      CHECK_FALSE(world->resting(0, 2));
      CHECK(log.passed == 0);
      CHECK(log.rested - log.woken == static_cast<int>(top));
      CHECK(std::abs(world->motion(top).path.position(1)[2] - 0.75) < 4 * holding_distance);
      if (expected.empty()) expected = log.lines;
      CHECK(log.lines == expected);
    }
  }
}

TEST_CASE("a box rests on a slope that is less steep than its friction allows, and on no other", "[rest]") {
  for (const double degrees : {5, 20, 25, 28}) {  // friction 0.5: up to 26.6
    CAPTURE(degrees);
    const Quaterniond slope = tilted(degrees * pi / 180, {0.3, 1, 0});
    const Vector3d up = slope * Vector3d::UnitZ();
    Log log;
    Turning world(options(), &log);
    const BodyId below = world.add_body(fixed(Box{Vector3d(20, 20, 1)}, {0, 0, 0}, slope));
    const BodyId box = world.add_body(body(Box{Vector3d(0.5, 0.5, 0.25)}, 1.26 * up, slope));
    world.advance_to(1);
    const bool rests = degrees < 26;
    CHECK(world.resting(below, box) == rests);
    CHECK(log.rested == rests);
    CHECK(log.woken == 0);
    CHECK(still(world, box) == rests);
  }
}

TEST_CASE("a plate rests on an edge while its centre is above what is below", "[rest]") {
  for (const double beyond : {-0.1, -0.02, 1e-3, 0.1}) {
    CAPTURE(beyond);
    Log log;
    Turning world(options(), &log);
    world.add_body(fixed(Box{Vector3d(1, 1, 1)}, {0, 0, -1}));
    const BodyId plate = world.add_body(body(Box{Vector3d(0.8, 0.3, 0.05)}, {1 + beyond, 0.1, 0.05 + 1e-6}));
    world.advance_to(1.25);
    CHECK(log.rested == (beyond < 0));
    CHECK(still(world, plate) == (beyond < 0));
    CHECK((world.motion(plate).path.position(world.now())[2] < 0.05) == (beyond > 0));
  }
}

TEST_CASE("balls roll down slopes, and lie on level ground", "[rest]") {
  for (const double slope : {0.0, 0.05}) {
    CAPTURE(slope);
    Log log;
    Turning world(options(), &log);
    const Quaterniond q = tilted(slope, {0, 1, 0});
    world.add_body(fixed(Box{Vector3d(20, 20, 1)}, {0, 0, 0}, q));
    const BodyId ball = world.add_body(body(Sphere{0.5}, q * Vector3d(0, 0, 1.75)));
    world.advance_to(3);
    CHECK(still(world, ball) == (slope == 0));
    if (slope > 0) {  // as rolling says: 5/7 of the weight along the slope
      CHECK(world.motion(ball).path.velocity(3).norm() > 0.9 * 5.0 / 7 * gravity * std::sin(slope) * 2.5);
    }
  }
}

TEST_CASE("what slides without friction slides on, however slowly", "[rest]") {
  const auto run = [](double speed, double turn, double friction) {
    Log log;
    Turning world(options(), &log);
    const BodyId floor = world.add_body(ground());
    Body box = body(Box{Vector3d::Constant(0.5)}, {0, 0, 0.501}, Quaterniond::Identity(), {0, 0, turn});
    box.motion[0].path.coefficients[1] = {speed, 0, 0};
    box.friction = friction;
    const BodyId id = world.add_body(box);
    world.advance_to(2);
    const double x = world.motion(id).path.position(2)[0];
    CHECK(world.resting(floor, id) == still(world, id));
    return std::pair(still(world, id), x);
  };
  CHECK(run(0, 0, 0).first);
  const auto [stopped, x] = run(0.01, 0, 0);
  CHECK_FALSE(stopped);
  CHECK(std::abs(x - 0.02) < 1e-9);
  CHECK_FALSE(run(0, 0.01, 0).first);
  CHECK(run(0.01, 0, 0.5).first);
  CHECK(run(0, 0.01, 0.5).first);
}

TEST_CASE("what is perfectly elastic, or has no weight, does not come to rest", "[rest]") {
  Log log;
  Turning world(options(), &log);
  Body elastic_ground = ground();
  elastic_ground.restitution = 1;
  world.add_body(elastic_ground);
  Body ball = body(Sphere{0.5}, {0, 0, 0.5});
  ball.restitution = 1;
  Body other = ball;
  other.motion[0].path.coefficients[0] = Vector3d(3, 0, 0.75);
  other.restitution = 0;
  other.motion[0].path.coefficients[1] = Vector3d(0, 0, -0.1);
  other.motion[0].path.coefficients[2] = Vector3d::Zero();
  world.add_body(ball), world.add_body(other);
  world.advance_to(4);
  CHECK(log.rested == 0);
  CHECK_FALSE(still(world, 1));
}

TEST_CASE("what rests wakes where it is struck, moved, or loses its support", "[rest]") {
  Log log;
  Turning world(options(), &log);
  const BodyId floor = world.add_body(ground());
  std::vector<BodyId> boxes;
  for (int i = 0; i < 2; ++i) {
    boxes.push_back(world.add_body(body(Box{Vector3d(0.5, 0.5, 0.25)}, {0, 0, 0.27 + 0.52 * i})));
  }
  const BodyId alone = world.add_body(body(Box{Vector3d(0.5, 0.5, 0.25)}, {5, 0, 0.3}));
  world.advance_to(1);
  REQUIRE(world.resting(floor, boxes[0]));
  REQUIRE(world.resting(boxes[0], boxes[1]));
  REQUIRE(world.resting(floor, alone));
  const int woken = log.woken;

  SECTION("by a ball") {
    Body ball = body(Sphere{0.25}, {-3, 0, 0.75});
    ball.motion[0].path.coefficients[0][2] = 0.75;
    ball.motion[0].path.coefficients[1] = Vector3d(6, 0, 2.4);
    ball.motion[0].path.start = 1;
    const BodyId id = world.add_body(ball);
    world.advance_to(1.6);
    CHECK(log.woken - woken == 2);
    CHECK_FALSE(still(world, boxes[1]));
    CHECK(world.resting(floor, alone));
    CHECK(world.motion(boxes[1]).path.position(1.6)[0] > 0.01);
    world.remove_body(id);  // which rolls on
    world.advance_to(3);
    CHECK(still(world, boxes[0]));
    CHECK(still(world, boxes[1]));
  }
  SECTION("as the lowest is removed") {
    world.remove_body(boxes[0]);
    world.advance_to(1.01);
    CHECK(log.woken - woken == 2);
    CHECK(world.motion(boxes[1]).path.velocity(1.01)[2] == -gravity * (1.01 - 1));
    world.advance_to(3);
    CHECK(world.resting(floor, boxes[1]));
  }
  SECTION("as the one above is removed") {
    world.remove_body(boxes[1]);
    world.advance_to(2);
    CHECK(world.resting(floor, boxes[0]));
    CHECK(log.woken - woken == 2);
  }
  SECTION("as the floor moves away") {
    auto sinks = world.motion(floor);
    sinks.path = sinks.path.restarted(1);
    sinks.path.coefficients[1] = Vector3d(0, 0, -1);
    world.update_motion(floor, sinks);
    world.advance_to(1.05);
    CHECK(log.woken - woken == 3);
    CHECK_FALSE(still(world, alone));
    CHECK_FALSE(world.resting(floor, alone));
  }
  SECTION("as the floor is removed") {
    world.remove_body(floor);
    world.advance_to(1.5);
    CHECK(log.woken - woken == 3);
    CHECK(world.motion(alone).path.velocity(1.5)[2] == -gravity * (1.5 - 1));
  }
  SECTION("as one is given a motion") {
    auto jumps = world.free_motion(boxes[0]);
    jumps.path.coefficients[1] = Vector3d(0, 3, 0);
    world.update_motion(boxes[0], jumps);
    world.advance_to(1.1);
    CHECK(log.woken - woken == 2);
    CHECK(world.motion(boxes[0]).path.velocity(1.1)[1] > 0);
    CHECK(world.resting(floor, alone));
  }
  SECTION("as a lift pushes from the side") {
    Body pusher = fixed(Box{Vector3d(0.5, 0.5, 0.1)}, {-1.5, 0, 0.25});
    pusher.motion[0].path.coefficients[1] = Vector3d(1, 0, 0);
    pusher.motion[0].path.start = 1;
    world.add_body(pusher);
    world.advance_to(1.6);
    CHECK(log.woken - woken >= 2);
    CHECK(world.motion(boxes[0]).path.position(1.6)[0] > 0.05);
  }
  world.audit();
}

TEST_CASE("a body put gently on one that rests joins it, or wakes it where it would fall", "[rest]") {
  for (const double at : {0.0, 0.45}) {
    CAPTURE(at);
    Log log;
    Turning world(options(), &log);
    world.add_body(fixed(Box{Vector3d(0.25, 0.25, 0.5)}, {0, 0, -0.5}));
    const BodyId plate = world.add_body(body(Box{Vector3d(1, 0.25, 0.0625)}, {0, 0, 0.0626}));
    world.advance_to(0.5);
    REQUIRE(still(world, plate));
    Body box = body(Box{Vector3d::Constant(0.125)}, {2 * at, 0, 0.250005});
    box.motion[0].path.start = 0.5;
    box.mass = 2;
    const BodyId weight = world.add_body(box);
    world.advance_to(0.75);
    CHECK(log.woken == (at > 0));
    CHECK(world.resting(plate, weight) == (at == 0));
    CHECK(still(world, plate) == (at == 0));
  }
}

TEST_CASE("rods and boxes come to rest on terrain that is a mesh", "[rest]") {
  // Hills: parabolas along both axes.

  constexpr std::uint32_t n = 8;
  std::vector<Vector3d> vertices;
  std::vector<Mesh::Triangle> triangles;
  for (std::uint32_t i = 0; i <= n; ++i) {
    for (std::uint32_t j = 0; j <= n; ++j) {
      const double x = -2 + 4.0 * i / n, y = -2 + 4.0 * j / n;
      vertices.emplace_back(x, y, 0.25 * x * x + 0.125 * y * y);
    }
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t j = 0; j < n; ++j) {
      const std::uint32_t a = i * (n + 1) + j, b = a + n + 1;
      triangles.push_back({a, b, b + 1}), triangles.push_back({a, b + 1, a + 1});
    }
  }
  const auto bowl = std::make_shared<const Mesh>(vertices, triangles);
  const std::uint64_t seed = 4;
  Random random(seed);
  Log log;
  Turning world(options(), &log);
  world.add_body(fixed(MeshShape{bowl, 1}, {0, 0, 0}));
  for (int i = 0; i < 2; ++i) {
    const Shape shape = i == 0 ? Box{Vector3d(0.4, 0.1, 0.12)} : Box{Vector3d(0.2, 0.25, 0.3)};
    world.add_body(body(shape, {2.0 * i - 1, 0.3, 1.5}, any_orientation(random)));
  }
  world.advance_to(5);
  CHECK(still(world, 1));
  CHECK(still(world, 2));
  CHECK(log.passed == 0);
  world.audit();
}

}  // namespace test_turning_rest
