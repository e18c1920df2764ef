// Worlds of bodies that turn.
#include "collision/world.hpp"

#include "collision/response/mass_properties.hpp"
#include "collision/shapes/convex_hull.hpp"
#include "collision/world/turning/turning_extents.hpp"
#include "tests/collision/sample_meshes.hpp"
#include "tests/support/random_numbers.hpp"

#include <Eigen/LU>
#include <catch2/catch.hpp>

#include <cmath>
#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace test_turning_world {
namespace {

using namespace kds;
using namespace kds::collision;
using certificates::RigidMotion;
using Eigen::Vector3d;
using Turning = TurningWorld<1>;

struct Log : Turning::Listener {
  std::vector<std::string> lines;
  void note(const char* what, const PairEvent& event) {
    char text[200];
    std::snprintf(text, sizeof text, "%a %s %llu %llu %a %a %a", event.contact.time, what,
                  static_cast<unsigned long long>(event.a), static_cast<unsigned long long>(event.b),
                  event.contact.normal[0], event.contact.normal[1], event.contact.normal[2]);
    lines.emplace_back(text);
  }
  void contact(Turning&, const PairEvent& event) override { note("contact", event); }
  void separation(Turning&, const PairEvent& event) override { note("separation", event); }
};

RigidMotion<1> motion(const Vector3d& position, const Vector3d& velocity, const Vector3d& spin) {
  RigidMotion<1> result{{{position, velocity}}};
  result.angular_velocity = spin;
  return result;
}

/// What an audited run between walls reports, by each broad phase.
template <class Fill>
std::vector<std::vector<std::string>> logs_by_broad_phase(double until, const Fill& fill) {
  std::vector<std::vector<std::string>> logs;
  for (const BroadPhaseKind kind : {BroadPhaseKind::all_pairs, BroadPhaseKind::sap, BroadPhaseKind::kinetic_sap,
                                    BroadPhaseKind::grid, BroadPhaseKind::automatic}) {
    Log log;
    WorldOptions options{.response = Response::elastic, .broad_phase = kind};
    options.walls = Walls{Vector3d::Constant(-4), Vector3d::Constant(4)};
    if (kind == BroadPhaseKind::sap) options.rate = 60;
    Turning world(options, &log);
    fill(world);
    for (double t = 0.5; t <= until; t += 0.5) {
      world.advance_to(t);
      world.audit();
    }
    logs.push_back(log.lines);
  }
  return logs;
}

}  // namespace

TEST_CASE("a rod that turns meets a ball, and both fly on with their energy and momenta", "[turning]") {
  Log log;
  Turning world({.response = Response::elastic}, &log);
  const BodyId rod = world.add_body(
      {.shape = Box{Vector3d(2, 0.125, 0.125)}, .motion = {motion({0, 0, 0}, {0, 0, 0}, {0, 0, 1})}, .inertia = 1.5});
  const BodyId ball = world.add_body({.shape = Sphere{0.25}, .motion = {motion({0, 1.5, 0}, {0, 0, 0}, {0, 0, 0})}});
  world.advance_to(3);
  REQUIRE(log.lines.size() == 1);
  const auto& of_rod = world.motion(rod);
  const auto& of_ball = world.motion(ball);
  CHECK(of_rod.path.velocity(3).norm() > 0.1);
  const Vector3d momentum = of_rod.path.velocity(3) + of_ball.path.velocity(3);
  CHECK(momentum.norm() < 1e-15);
  const double energy = 0.5 * (of_rod.path.velocity(3).squaredNorm() + of_ball.path.velocity(3).squaredNorm()) +
                        0.5 * 1.5 * of_rod.angular_velocity.squaredNorm();
  CHECK(std::abs(energy - 0.75) < 1e-15);
  const double spin = 1.5 * of_rod.angular_velocity[2] + of_rod.path.position(3).cross(of_rod.path.velocity(3))[2] +
                      of_ball.path.position(3).cross(of_ball.path.velocity(3))[2];
  CHECK(std::abs(spin - 1.5) < 1e-14);
}

TEST_CASE("a tensor of equal moments is the moment, and others are of bodies that precess, if contacts turn them",
          "[turning]") {
  const auto rod_after = [](const Inertia& inertia) {
    Turning world({.response = Response::elastic});
    const BodyId rod = world.add_body({.shape = Box{Vector3d(2, 0.125, 0.125)},
                                       .motion = {motion({0, 0, 0}, {0, 0, 0}, {0, 0, 1})},
                                       .inertia = inertia});
    world.add_body({.shape = Sphere{0.25}, .motion = {motion({0, 1.5, 0}, {0, 0, 0}, {0, 0, 0})}});
    world.advance_to(3);
    CHECK(world.counters().contacts == 1);
    return world.motion(rod);
  };
  CHECK(rod_after(Eigen::Matrix3d(1.5 * Eigen::Matrix3d::Identity())) == rod_after(1.5));
  CHECK_FALSE(rod_after(1.25) == rod_after(1.5));
  const Turning::Description rod{.shape = Box{Vector3d(1, 2, 3)},
                                 .motion = {motion({0, 0, 0}, {0, 0, 0}, {1, 0, 1})},
                                 .inertia = Eigen::Matrix3d(Vector3d(3, 4, 5).asDiagonal())};
  Turning({.response = Response::none}).add_body(rod);
  Turning world({.response = Response::elastic});
  world.add_body(rod);
  world.advance_to(1);
  const auto pieces = world.counters().rotation_pieces;
  CHECK(pieces > 0);
  world.remove_body(0);
  auto driven = rod;
  driven.fixed = true;
  world.add_body(driven);
  auto ghost = rod;
  ghost.sensor = true;
  world.add_body(ghost);
  world.advance_to(2);
  CHECK(world.counters().rotation_pieces == pieces);
}

TEST_CASE("turning worlds find the same contacts whichever broad phase they have", "[turning]") {
  const auto fill = [](Turning& world) {
    kds::tests::Random random(77);
    for (int i = 0; i < 30; ++i) {
      const Vector3d place(i % 3 * 2.0 - 2, i / 3 % 3 * 2.0 - 2, i / 9 * 2.0 - 3);
      const auto between = [&] { return random.between(-1, 1); };
      Turning::Description body{
          .shape = Box{Vector3d(0.5, 0.5, 0.5)},
          .motion = {motion(place, {between(), between(), between()}, 5 * Vector3d(between(), between(), between()))}};
      if (i % 3 == 0) body.shape = Sphere{0.5};
      if (i % 5 == 0) body.shape = Box{Vector3d(0.75, 0.1, 0.2)}, body.inertia = 0.2;
      world.add_body(body);
    }
  };
  const auto logs = logs_by_broad_phase(3, fill);
  CHECK(logs.front().size() > 30);
  for (const auto& lines : logs) CHECK(lines == logs.front());
}

TEST_CASE("turning worlds with meshes find the same contacts whichever broad phase they have", "[turning]") {
  const std::vector<std::shared_ptr<const Mesh>> meshes{samples::torus(6, 4), samples::cuboid(Vector3d(0.5, 0.4, 0.6)),
                                                        samples::ball_mesh(1)};
  const auto fill = [&](Turning& world) {
    kds::tests::Random random(78);
    for (std::size_t i = 0; i < 18; ++i) {
      const Vector3d place(static_cast<double>(i % 3) * 2.4 - 2.4, static_cast<double>(i / 3 % 3) * 2.4 - 2.4,
                           static_cast<double>(i / 9) * 2.4 - 1.2);
      const auto between = [&] { return random.between(-1, 1); };
      Turning::Description body{.shape = MeshShape{meshes[i % 3], 0.9},
                                .motion = {motion(place, 3 * Vector3d(between(), between(), between()),
                                                  5 * Vector3d(between(), between(), between()))},
                                .inertia = 0.3};
      if (i % 5 == 0) body.shape = Sphere{0.5};
      if (i % 7 == 0) body.shape = Box{Vector3d(0.75, 0.1, 0.2)};
      world.add_body(body);
    }
  };
  const auto logs = logs_by_broad_phase(2, fill);
  CHECK(logs.front().size() > 10);
  for (const auto& lines : logs) CHECK(lines == logs.front());
}

TEST_CASE("turning worlds with hulls find the same contacts whichever broad phase they have", "[turning][hull]") {
  const Shape octahedron =
      convex_hull({{0.7, 0, 0}, {-0.7, 0, 0}, {0, 0.7, 0}, {0, -0.7, 0}, {0, 0, 0.7}, {0, 0, -0.7}});
  const Shape wedge = convex_hull({{0.6, 0, 0}, {-0.6, 0, 0}, {0, 0.6, 0.4}, {0, -0.6, 0.4}, {0, 0, -0.2}});
  const auto ring = samples::torus(6, 4);
  const auto fill = [&](Turning& world) {
    kds::tests::Random random(79);
    for (std::size_t i = 0; i < 24; ++i) {
      const Vector3d place(static_cast<double>(i % 3) * 2.4 - 2.4, static_cast<double>(i / 3 % 3) * 2.4 - 2.4,
                           static_cast<double>(i / 9) * 2.4 - 2.4);
      const auto between = [&] { return random.between(-1, 1); };
      Turning::Description body{.shape = i % 2 == 0 ? octahedron : wedge,
                                .motion = {motion(place, 3 * Vector3d(between(), between(), between()),
                                                  5 * Vector3d(between(), between(), between()))}};
      if (i % 2 != 0) body.inertia = 0.3;  // that of an octahedron is the same about all axes
      if (i % 5 == 0) body.shape = Sphere{0.5};
      if (i % 7 == 0) body.shape = Box{Vector3d(0.5, 0.5, 0.5)};
      if (i % 11 == 3) body.shape = MeshShape{ring, 0.5}, body.inertia = 0.3;
      world.add_body(body);
    }
  };
  const auto logs = logs_by_broad_phase(2, fill);
  CHECK(logs.front().size() > 15);
  for (const auto& lines : logs) CHECK(lines == logs.front());
}

TEST_CASE("turning worlds with capsules find the same contacts whichever broad phase they have", "[turning][capsule]") {
  const Shape wedge = convex_hull({{0.6, 0, 0}, {-0.6, 0, 0}, {0, 0.6, 0.4}, {0, -0.6, 0.4}, {0, 0, -0.2}});
  const auto ring = samples::torus(6, 4);
  const auto fill = [&](Turning& world) {
    kds::tests::Random random(80);
    for (std::size_t i = 0; i < 27; ++i) {
      const Vector3d place(static_cast<double>(i % 3) * 2.4 - 2.4, static_cast<double>(i / 3 % 3) * 2.4 - 2.4,
                           static_cast<double>(i / 9) * 2.4 - 2.4);
      const auto between = [&] { return random.between(-1, 1); };
      Turning::Description body{.shape = Capsule{0.25, 0.6},
                                .motion = {motion(place, 3 * Vector3d(between(), between(), between()),
                                                  5 * Vector3d(between(), between(), between()))}};
      if (i % 5 == 0) body.shape = Sphere{0.5};
      if (i % 7 == 1) body.shape = Box{Vector3d(0.5, 0.5, 0.5)};
      if (i % 9 == 2) body.shape = wedge, body.inertia = 0.3;
      if (i % 13 == 3) body.shape = MeshShape{ring, 0.5}, body.inertia = 0.3;
      world.add_body(body);
    }
  };
  const auto logs = logs_by_broad_phase(2, fill);
  CHECK(logs.front().size() > 15);
  for (const auto& lines : logs) CHECK(lines == logs.front());
}

TEST_CASE("a capsule that tumbles bounces, with its energy and momenta, and precesses as a top", "[turning][capsule]") {
  Turning world({.response = Response::elastic});
  const Capsule shape{0.25, 1};
  const BodyId capsule = world.add_body({.shape = shape, .motion = {motion({0, 0, 0}, {0, 0, 0}, {1, 0, 0})}});
  const BodyId ball = world.add_body({.shape = Sphere{0.25}, .motion = {motion({0, -2, 0.75}, {0, 1, 0}, {0, 0, 0})}});
  const auto momentum = [&](double t) {
    return Vector3d(world.motion(capsule).path.velocity(t) + world.motion(ball).path.velocity(t));
  };
  const auto angular_momentum = [&](double t) {
    Vector3d sum = world.free_turning(capsule).angular_momentum;
    for (const BodyId id : {capsule, ball}) {
      sum += world.motion(id).path.position(t).cross(world.motion(id).path.velocity(t));
    }
    return sum;
  };
  const Eigen::Matrix3d inertia = mass_properties(shape, 1).inertia;
  const auto energy = [&](double t) {
    const auto turning = world.free_turning(capsule);
    const Vector3d of_body = turning.orientation.normalized().inverse() * turning.angular_momentum;
    return 0.5 * (world.motion(capsule).path.velocity(t).squaredNorm() +
                  world.motion(ball).path.velocity(t).squaredNorm() + of_body.dot(inertia.inverse() * of_body));
  };
  const Vector3d momentum_before = momentum(0), angular_before = angular_momentum(0);
  const double energy_before = energy(0);
  world.advance_to(4);
  CHECK(world.counters().contacts == 1);
  CHECK((world.motion(ball).path.velocity(4) - Vector3d(0, 1, 0)).norm() > 0.1);
  CHECK((momentum(4) - momentum_before).norm() < 1e-14);
  CHECK((angular_momentum(4) - angular_before).norm() < 1e-14);
  CHECK(std::abs(energy(4) - energy_before) < 1e-14);
}

TEST_CASE("the volume of a capsule holds it however far it turns, and is no larger than its ball", "[turning]") {
  kds::tests::Random random(81);
  const auto between = [&] { return random.between(-1, 1); };
  for (int round = 0; round < 200; ++round) {
    const Capsule capsule{random.between(0.01, 1), random.between(0.01, 2)};
    auto m =
        motion({0, 0, 0}, {0, 0, 0}, round % 5 == 0 ? Vector3d(0, 0, 0) : Vector3d(between(), between(), between()));
    if (round % 7 == 0) m.angular_velocity = Vector3d(0, 0, 2);
    m.orientation = Eigen::Quaterniond(between(), between(), between(), between());
    const PlacedShape placed = place(capsule, Eigen::Quaterniond::Identity());
    const Vector3d half = turning_half_extents(placed, m);
    Vector3d reached = Vector3d::Zero();
    for (int i = 0; i <= 400; ++i) {
      const Vector3d end = m.direction(Vector3d(0, 0, capsule.half_length), 0.05 * i).vector;
      reached = reached.cwiseMax(Vector3d(end.cwiseAbs() + Vector3d::Constant(capsule.radius)));
    }
    CHECK((half - reached).minCoeff() >= 0);
    CHECK(half.maxCoeff() <= placed.bounding_radius);
    if (m.spin().still()) CHECK((half - reached).maxCoeff() < 1e-9);
  }
}

TEST_CASE("a cube that is a hull bounces as the box does", "[turning][hull]") {
  std::vector<Vector3d> corners;
  for (int k = 0; k < 8; ++k) corners.emplace_back(k & 1 ? 0.5 : -0.5, k & 2 ? 0.5 : -0.5, k & 4 ? 0.5 : -0.5);
  const auto contacts_of = [](const Shape& cube) {
    Log log;
    Turning world({.response = Response::elastic}, &log);
    world.add_body({.shape = cube, .motion = {motion({0, 0, 0}, {0, 0, 0}, {1, 2, 3})}});
    world.add_body({.shape = Sphere{0.25}, .motion = {motion({0.25, 3, 0.125}, {0, -1, 0}, {0, 0, 0})}});
    world.advance_to(5);
    return std::pair(log.lines.size(), world.motion(0).angular_velocity);
  };
  const auto of_box = contacts_of(Box{Vector3d(0.5, 0.5, 0.5)}), of_hull = contacts_of(convex_hull(corners));
  CHECK(of_box.first == 1);
  CHECK(of_hull.first == 1);
  CHECK((of_box.second - of_hull.second).norm() < 1e-12);
}

TEST_CASE("a mesh that turns bounces off a ball, and energy and momenta are kept", "[turning]") {
  Log log;
  Turning world({.response = Response::elastic}, &log);
  const BodyId rod = world.add_body({.shape = MeshShape{samples::cuboid(Vector3d(2, 0.125, 0.125))},
                                     .motion = {motion({0, 0, 0}, {0, 0, 0}, {0, 0, 1})},
                                     .inertia = 1.5});
  const BodyId ball = world.add_body({.shape = Sphere{0.25}, .motion = {motion({0, 1.5, 0}, {0, 0, 0}, {0, 0, 0})}});
  world.advance_to(3);
  CHECK(log.lines.size() == 1);
  const auto& of_rod = world.motion(rod);
  const auto& of_ball = world.motion(ball);
  CHECK((of_rod.path.velocity(3) + of_ball.path.velocity(3)).norm() < 1e-15);
  const double energy = 0.5 * (of_rod.path.velocity(3).squaredNorm() + of_ball.path.velocity(3).squaredNorm()) +
                        0.5 * 1.5 * of_rod.angular_velocity.squaredNorm();
  CHECK(std::abs(energy - 0.75) < 1e-15);
}

}  // namespace test_turning_world
