// Worlds of bodies that turn where they have gone wrong, or could.
#include "collision/world.hpp"
#include "kds/framework/snapshot.hpp"

#include "tests/collision/sample_meshes.hpp"
#include "tests/collision_turning/narrow_phase/turning_oracle.hpp"
#include "tests/collision_turning/narrow_phase/turning_solids.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace test_turning_attacks {
namespace {

using namespace kds;
using namespace kds::collision;
using certificates::RigidMotion;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using kds::tests::Random;
using kds::tests::random_vector;
using kds::tests::TurningOracle;

template <int Degree>
using Turning = BasicWorld<RigidMotion<Degree>>;

template <int Degree>
struct Log : Turning<Degree>::Listener {
  std::vector<std::string> lines;
  double first_contact = never;

  void note(const char* what, const PairEvent& event) {
    char text[200];
    std::snprintf(text, sizeof text, "%a %s %llu %llu %a %a %a", event.contact.time, what,
                  static_cast<unsigned long long>(event.a), static_cast<unsigned long long>(event.b),
                  event.contact.normal[0], event.contact.normal[1], event.contact.normal[2]);
    lines.emplace_back(text);
  }
  void contact(Turning<Degree>&, const PairEvent& event) override {
    first_contact = std::min(first_contact, event.contact.time);
    note("contact", event);
  }
  void separation(Turning<Degree>&, const PairEvent& event) override { note("separation", event); }
  void overlap(Turning<Degree>&, const PairEvent& event) override { note("overlap", event); }
  void passes(Turning<Degree>&, const PairEvent& event) override { note("passes", event); }
};

template <int Degree>
RigidMotion<Degree> motion(const Vector3d& position, const Vector3d& velocity, const Vector3d& spin,
                           const Quaterniond& orientation = Quaterniond::Identity()) {
  RigidMotion<Degree> result{{{position, velocity}}};
  result.angular_velocity = spin;
  result.orientation = orientation;
  return result;
}

std::vector<Vector3d> corners_of_cube() {
  std::vector<Vector3d> corners;
  for (const double x : {-1, 1}) {
    for (const double y : {-1, 1}) {
      for (const double z : {-1, 1}) corners.emplace_back(x, y, z);
    }
  }
  return corners;
}

Quaterniond random_orientation(Random& random) {
  const Vector3d v = random_vector(random, 1);
  return {random.between(-1, 1), v[0], v[1], v[2]};
}

}  // namespace

TEST_CASE("boxes with parallel edges that overlap and part are done with at once", "[turning]") {
  const PlacedShape cube = place(Box{Vector3d(1, 1, 1)}, Quaterniond::Identity());
  for (const double depth : {0x1p-50, 0x1p-30, 0x1p-3, 0.5}) {
    for (const double spin : {0.0, 0.25}) {
      CAPTURE(depth, spin);
      const auto below = motion<1>({0, 0, 0}, {0, 0, 0}, {0, 0, spin});
      const auto above = motion<1>({0, 0, 2 - depth}, {0, 0, 1}, {0, 0, 3 * spin});
      CHECK(first_contact<RigidMotion<1>>({cube, below}, {cube, above}, 0, 10, ContactMode::resolved) == never);
      CHECK(first_separation<RigidMotion<1>>({cube, below}, {cube, above}, 0, 10) == depth);
    }
  }
  // A ball whose centre is in the box: no smaller one is out of it.
  const PlacedShape ball = placed_ball(0.5);
  const auto still = motion<1>({0, 0, 0}, {0, 0, 0}, {0, 0, 1});
  const auto leaves = motion<1>({0, 0, 0.75}, {0, 0, 1}, {0, 0, 0});
  CHECK(first_contact<RigidMotion<1>>({cube, still}, {ball, leaves}, 0, 10, ContactMode::resolved) == never);
}

TEST_CASE("worlds look beyond the turns of one search", "[turning]") {
  // 20 rad/s, for 100 s: far more than what a search looks at, and nothing else happens.
  Log<1> log;
  Turning<1> world({.response = Response::elastic}, &log);
  world.add_body(
      {.shape = Box{Vector3d(3, 3, 0.01)}, .motion = {motion<1>({0, 0, 0}, {0, 0, 0}, {0, 0, 0})}, .fixed = true});
  world.add_body({.shape = Box{Vector3d(1, 0.01, 0.01)},
                  .motion = {motion<1>({0, 0, 1.5}, {0, 0, -0x1p-8}, {0, 0, 20})},
                  .inertia = 0.3});
  world.add_body({.shape = Box{Vector3d(1, 0.01, 0.01)},
                  .motion = {motion<1>({1, 2, 0.9}, {0, 0, 0}, {0, 0, 20})},
                  .inertia = 0.3});
  world.advance_to(400);
  CHECK(std::abs(log.first_contact - 1.48 * 0x1p8) < 1e-12 * 0x1p8);
}

TEST_CASE("balls that spin part in worlds that let them pass", "[turning]") {
  Log<1> log;
  Turning<1> world({}, &log);
  world.add_body({.shape = Sphere{1}, .motion = {motion<1>({0, 0, 0}, {0, 0, 0}, {0, 0, 30})}});
  world.add_body({.shape = Sphere{1}, .motion = {motion<1>({-4, 0, 0}, {1, 0, 0}, {5, 0, 0})}});
  world.advance_to(8);
  world.audit();
  REQUIRE(log.lines.size() == 2);
  CHECK(log.lines[0].find("contact") != std::string::npos);
  CHECK(log.lines[1].find("separation") != std::string::npos);
}

TEST_CASE("a fast rod never passes a thin plate, nor is it stopped beside it", "[turning]") {
  for (const double rate : {5.0, 20.0, 60.0, 300.0}) {
    const auto seed = static_cast<std::uint64_t>(1000 + rate);
    CAPTURE(rate, seed);
    Random random(seed);
    int passed = 0, stopped = 0, wrong = 0;
    for (int trial = 0; trial < 100; ++trial) {
      const Shape plate = Box{Vector3d(3, 3, 0.01)}, rod = Box{Vector3d(1, 0.01, 0.01)};
      const bool misses = trial % 2 != 0;  // by 1 cm
      const Vector3d place(misses ? 4.0101 : random.between(-1, 1), random.between(-1, 1), 2);
      const auto of_plate = motion<1>({0, 0, 0}, {0, 0, 0}, {0, 0, 0});
      const auto of_rod =
          motion<1>(place, {0, 0, -4}, rate * random_vector(random, 1).normalized(), random_orientation(random));
      Log<1> log;
      Turning<1> world({.response = Response::elastic}, &log);
      world.add_body({.shape = plate, .motion = {of_plate}, .fixed = true});
      world.add_body({.shape = rod, .motion = {of_rod}, .inertia = 0.3});
      world.advance_to(1);
      const double t = log.first_contact;
      if (misses) {
        stopped += t < never;
      } else {
        passed += t == never || world.motion(1).path.position(1)[2] < 0;
        wrong +=
            t < never && !(std::abs(static_cast<double>(TurningOracle::gap(of_plate, plate, of_rod, rod, t))) < 1e-13);
      }
    }
    CHECK(passed == 0);
    CHECK(stopped == 0);
    CHECK(wrong == 0);
  }
}

namespace {

/// What happens to bodies that begin anywhere, overlapping or not; sensors, masks, scripts, jumps among them.
template <int Degree>
std::vector<std::string> story(const WorldOptions& options, std::uint64_t seed, bool snapshots) {
  Log<Degree> log;
  auto world = std::make_unique<Turning<Degree>>(options, &log);
  Random random(seed);
  for (int i = 0; i < 24; ++i) {
    auto m = motion<Degree>(random_vector(random, 2.5), random_vector(random, 1), random_vector(random, 5),
                            random_orientation(random));
    if constexpr (Degree == 2) m.path.coefficients[2] = Vector3d(0, 0, -1);
    typename Turning<Degree>::Description body{.shape = Box{Vector3d(0.5, 0.5, 0.5)}, .motion = {m}};
    if (i % 3 == 0) body.shape = Sphere{0.5};
    if (i % 5 == 0) body.shape = Box{Vector3d(0.75, 0.1, 0.2)}, body.inertia = 0.2;
    if (i % 11 == 1) body.sensor = true;
    if (i % 7 == 2) body.category = 2, body.collides_with = 1;
    if (i % 13 == 3) body.fixed = true;
    if (i % 9 == 4) {
      m.path.start = 0.7;
      m.orientation = random_orientation(random);
      body.motion.push_back(m);
    }
    if (i % 8 == 5) body.restitution = 0.5;
    world->add_body(body);
  }
  for (int i = 1; i <= 8; ++i) {
    world->advance_to(i * 0.25);
    world->audit();
    if (!snapshots) continue;
    const auto image = save(*world);
    world = std::make_unique<Turning<Degree>>(options, &log);
    restore(image, *world);
  }
  return log.lines;
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("events do not depend on broad phases, windows and snapshots", "[turning]",
                       ((int Degree), Degree), 1, 2) {
  for (const Response response : {Response::none, Response::elastic}) {
    const std::uint64_t seed = 2;
    CAPTURE(Degree, seed, static_cast<int>(response));
    WorldOptions options{.response = response, .broad_phase = BroadPhaseKind::all_pairs};
    options.walls = Walls{Vector3d::Constant(-4), Vector3d::Constant(4)};
    const auto expected = story<Degree>(options, seed, false);
    CHECK(expected.size() > 30);
    options.broad_phase = BroadPhaseKind::kinetic_sap;
    options.kdop = 26;
    options.window = 0.3;
    CHECK(story<Degree>(options, seed, false) == expected);
    options.kdop = 6;
    options.broad_phase = BroadPhaseKind::grid;
    options.window = 0.05;
    CHECK(story<Degree>(options, seed, false) == expected);
    options.broad_phase = BroadPhaseKind::automatic;
    options.window = never;
    CHECK(story<Degree>(options, seed, true) == expected);
  }
}

TEST_CASE("descriptions of bodies that cannot turn are refused, and nothing is added", "[turning]") {
  Turning<1> world({.response = Response::elastic});
  const auto refused = [&](const Turning<1>::Description& body, const std::string& text) {
    CAPTURE(text);
    CHECK_THROWS_WITH(world.add_body(body), Catch::Contains(text));
    CHECK(world.size() == 0);
    world.audit();
  };
  const auto still = motion<1>({0, 0, 0}, {0, 0, 0}, {0, 0, 0});
  const double nan = std::nan("");
  auto bad = still;
  bad.orientation = Quaterniond(0, 0, 0, 0);
  refused({.shape = Sphere{1}, .motion = {bad}}, "motion[0].orientation");
  bad = still, bad.orientation = Quaterniond(nan, 0, 0, 1);
  refused({.shape = Sphere{1}, .motion = {bad}}, "motion[0].orientation");
  bad = still, bad.orientation = Quaterniond(1, 0, 0, nan);
  refused({.shape = Sphere{1}, .motion = {still, bad}}, "motion[1]");
  bad = still, bad.angular_velocity[1] = never;
  refused({.shape = Sphere{1}, .motion = {bad}}, "motion[0].angular_velocity");
  bad = still, bad.angular_velocity[1] = nan;
  refused({.shape = Sphere{1}, .motion = {bad}}, "motion[0].angular_velocity");
  bad = still, bad.path.coefficients[1][2] = nan;
  refused({.shape = Sphere{1}, .motion = {bad}}, "motion[0].path");
  refused({.shape = Sphere{1}, .motion = {still}, .inertia = -1}, "inertia");
  refused({.shape = Sphere{1}, .motion = {still}, .inertia = nan}, "inertia");
  const auto tensor = [](double x, double y, double z) { return Eigen::Matrix3d(Vector3d(x, y, z).asDiagonal()); };
  refused({.shape = Sphere{1}, .motion = {still}, .inertia = tensor(0, 0, 0)}, "inertia: must not be zero");
  refused({.shape = Sphere{1}, .motion = {still}, .inertia = tensor(1, nan, 1)}, "inertia: must be finite");
  refused({.shape = Sphere{1}, .motion = {still}, .inertia = tensor(1, 1, -1)}, "inertia: must be positive definite");
  refused({.shape = Sphere{1}, .motion = {still}, .inertia = tensor(1, 1, 3), .fixed = true}, "inertia: is of no body");
  refused({.shape = Sphere{1}, .motion = {still}, .inertia = tensor(1, 1, 0x1p-41)}, "inertia");  // too thin
  refused({.shape = Sphere{1}, .orientation = Quaterniond(0, 1, 0, 0), .motion = {still}}, "orientation");
  refused({.shape = Capsule{}, .motion = {still}}, "radius: must be > 0");
  refused({.shape = BendingMesh{}, .motion = {still}}, "fixed: contacts do not move a mesh that bends");
  // A cube whose corners are off its centre turns about the wrong point, unless its inertia is given as of this point.
  const auto cube_at = [](double x) {
    const auto cube = samples::cuboid();
    std::vector<Vector3d> corners(cube->vertices().begin(), cube->vertices().end());
    for (Vector3d& corner : corners) corner[0] += x;
    return MeshShape{std::make_shared<const Mesh>(
        std::move(corners), std::vector<Mesh::Triangle>(cube->triangles().begin(), cube->triangles().end()))};
  };
  refused({.shape = cube_at(0.5), .motion = {still}}, "centre of mass of this mesh is at (0.5, 0, 0)");
  world.remove_body(world.add_body({.shape = cube_at(0), .motion = {still}}));
  world.remove_body(world.add_body({.shape = cube_at(0.5), .motion = {still}, .inertia = 1}));
  const BodyId id = world.add_body({.shape = Sphere{1}, .motion = {still}});
  bad = still, bad.orientation = Quaterniond(0, 0, 0, 0);
  CHECK_THROWS_WITH(world.update_motion(id, bad), Catch::Contains("orientation"));
  CHECK(world.motion(id) == still);
}

TEST_CASE("a body that turns and has no room between two walls stands still along their axis", "[turning][walls]") {
  struct Told : Turning<2>::Listener {
    int walls = 0, suppressed = 0;
    void wall(Turning<2>&, const WallEvent&) override { ++walls; }
    void rebound_suppressed_at_wall(Turning<2>&, const WallEvent&) override { ++suppressed; }
  };
  constexpr double end = 0x1p-6;  // s
  for (const double centre : {0.0, 0.1, -0x1p20}) {
    for (const double room : {0.0, 0x1p-45, 0x1p-21, 0.5}) {
      for (const double weight : {0.0, 10.0}) {
        for (const double restitution : {1.0, 0.5}) {
          CAPTURE(centre, room, weight, restitution);
          WorldOptions options;
          options.response = Response::elastic;
          options.walls = Walls{{-9, -9, centre - 1 - room / 2}, {9, 9, centre + 1 + room / 2}, restitution};
          Told told;
          Turning<2> world(options, &told);
          RigidMotion<2> falls = motion<2>({0, 0, centre}, {2, 0, 0.125}, {0, 1, 0});
          falls.path.coefficients[2] = {0, 0, -weight / 2};
          const BodyId id = world.add_body({.shape = Sphere{1}, .motion = {falls}});
          int steps = 0;
          while (steps < 20000 && world.step(end)) ++steps;
          CHECK(steps < 20000);
          world.audit();
          const auto& path = world.motion(id).path;
          CHECK(path.velocity(end)[0] == 2);
          CHECK(std::abs(path.position(end)[2] - centre) <= room / 2 + 0x1p-30);
          const bool held = room < 0x1p-40 || (room < 0x1p-20 && weight > 0 && restitution < 1);
          CHECK((told.suppressed > 0) == held);
          if (held) CHECK(path.velocity(end)[2] == 0);
          if (room == 0.5) CHECK(told.walls < 200);
        }
      }
    }
  }
}

TEST_CASE("small bodies that spin fast keep their energy", "[turning]") {
  for (const double unit : {1.0, 1e-3}) {          // m
    for (const double speed : {1.0, 3.0, 30.0}) {  // m/s
      CAPTURE(unit, speed);
      Random random(7);
      WorldOptions options;
      options.response = Response::elastic;
      options.walls = Walls{Vector3d::Constant(-4 * unit), Vector3d::Constant(4 * unit), 1};
      Turning<1> world(options);
      for (const Vector3d& corner : corners_of_cube()) {
        const auto flies = motion<1>(2 * unit * corner, random_vector(random, speed),
                                     random_vector(random, speed / unit), Quaterniond::Identity());
        world.add_body({.shape = Box{unit * Vector3d(0.5, 0.75, 1)}, .motion = {flies}});
      }
      const auto energy = [&] {
        double twice = 0;
        for (BodyId id = 0; id < world.size(); ++id) {
          const FreeTurning turning = world.free_turning(id);
          twice += world.motion(id).path.velocity(world.now()).squaredNorm() +
                   turning.angular_velocity.dot(turning.angular_momentum);
        }
        return twice / 2;
      };
      const double before = energy();
      world.advance_to(50 * unit / speed);
      CHECK(world.counters().contacts > 50);
      CHECK(energy() == Approx(before).epsilon(1e-9));
    }
  }
}

}  // namespace test_turning_attacks
