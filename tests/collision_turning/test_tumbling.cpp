// Worlds of bodies that precess: that turn freely, and whose moments of inertia differ.
#include "collision/response/free_rotation.hpp"
#include "collision/response/principal_inertia.hpp"
#include "collision/world.hpp"
#include "kds/framework/snapshot.hpp"

#include "collision/response/mass_properties.hpp"
#include "tests/collision/sample_meshes.hpp"
#include "tests/support/random_numbers.hpp"
#include "tests/support/random_vectors.hpp"

#include <catch2/catch.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace test_tumbling {
namespace {

using namespace kds;
using namespace kds::collision;
using certificates::RigidMotion;
using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using kds::tests::Random;
using kds::tests::random_vector;

template <int Degree>
using Turning = BasicWorld<RigidMotion<Degree>>;

template <int Degree = 1>
struct Log : Turning<Degree>::Listener {
  std::vector<std::string> lines;
  void note(const char* what, double time, BodyId a, BodyId b, const Vector3d& n) {
    char text[200];
    std::snprintf(text, sizeof text, "%a %s %llu %llu %a %a %a", time, what, static_cast<unsigned long long>(a),
                  static_cast<unsigned long long>(b), n[0], n[1], n[2]);
    lines.emplace_back(text);
  }
  void contact(Turning<Degree>&, const PairEvent& e) override {
    note("contact", e.contact.time, e.a, e.b, e.contact.normal);
  }
  void separation(Turning<Degree>&, const PairEvent& e) override {
    note("separation", e.contact.time, e.a, e.b, e.contact.normal);
  }
  void wall(Turning<Degree>&, const WallEvent& e) override {
    note("wall", e.contact.time, e.body, e.body, e.contact.normal);
  }
  void passes(Turning<Degree>&, const PairEvent& e) override {
    note("passes", e.contact.time, e.a, e.b, e.contact.normal);
  }
  void overlap(Turning<Degree>&, const PairEvent& e) override {
    note("overlap", e.contact.time, e.a, e.b, e.contact.normal);
  }
  bool hears_pieces() const override { return true; }
  void moved(Turning<Degree>& world, BodyId id) override {
    note("moved", world.now(), id, id, world.motion(id).angular_velocity);
  }
};

template <int Degree = 1>
RigidMotion<Degree> motion(const Vector3d& position, const Vector3d& velocity, const Vector3d& spin,
                           const Quaterniond& orientation = Quaterniond::Identity()) {
  RigidMotion<Degree> result{{{position, velocity}}};
  result.angular_velocity = spin;
  result.orientation = orientation;
  return result;
}

Quaterniond random_rotation(Random& random) {
  Quaterniond q(0, 0, 0, 0);
  while (q.norm() < 0.1) {
    for (int i = 0; i < 4; ++i) q.coeffs()[i] = random.between(-1, 1);
  }
  return q.normalized();
}

/// What a gas of bodies has that contacts of smooth, elastic bodies keep.
struct Kept {
  double energy = 0;
  Vector3d momentum = Vector3d::Zero();
  Vector3d angular = Vector3d::Zero();  ///< about the origin
};

template <int Degree>
Kept kept(const Turning<Degree>& world) {
  Kept sum;
  for (BodyId id = 0; id < world.size(); ++id) {
    if (world.fixed(id)) continue;
    const Vector3d x = world.motion(id).path.position(world.now());
    const Vector3d v = world.motion(id).path.velocity(world.now());
    const FreeTurning turning = world.free_turning(id);
    const double mass = world.mass(id);
    sum.energy += 0.5 * (mass * v.squaredNorm() + turning.angular_momentum.dot(turning.angular_velocity));
    sum.momentum += mass * v;
    sum.angular += mass * x.cross(v) + turning.angular_momentum;
  }
  return sum;
}

/// The angle between the motion of a body and its free rotation, now.
template <int Degree>
double off(const Turning<Degree>& world, BodyId id) {
  const Quaterniond moves = world.motion(id).restarted(world.now()).orientation.normalized();
  return moves.angularDistance(world.free_turning(id).orientation);
}

/// Rods, plates, boxes, tops and cubes that fly in all directions and turn.
template <int Degree>
void fill(Turning<Degree>& world, std::uint64_t seed, int count, double mass_range = 3) {
  Random random(seed);
  for (int i = 0; i < count; ++i) {
    const Vector3d place(i % 3 * 2.0 - 2, i / 3 % 3 * 2.0 - 2, i / 9 * 2.0 - 2);
    const Vector3d velocity = 2 * random_vector(random), spin = 4 * random_vector(random);
    typename Turning<Degree>::Description body{
        .shape = Box{Vector3d(0.8, 0.2, 0.3)},
        .motion = {motion<Degree>(place, velocity, spin, random_rotation(random))}};
    if (i % 5 == 1) body.shape = Box{Vector3d(0.7, 0.7, 0.1)};
    if (i % 5 == 2) body.shape = Box{Vector3d(0.1, 0.1, 0.9)};
    if (i % 5 == 3) body.shape = Sphere{0.6};
    if (i % 5 == 4) body.shape = Sphere{0.5}, body.inertia = Matrix3d(Vector3d(0.05, 0.06, 0.09).asDiagonal());
    body.mass = random.between(1, mass_range);
    world.add_body(body);
  }
}

}  // namespace

TEST_CASE("a body that precesses is turned as Euler's equations say, up to the option", "[turning]") {
  for (const double error : {1e-1, 1e-2, 1e-3, 1e-5}) {
    CAPTURE(error);
    Turning<1> world({.response = Response::elastic, .orientation_error = error});
    const Vector3d half(0.3, 0.7, 1.1);
    const BodyId id = world.add_body(
        {.shape = Box{half}, .motion = {motion({1, 2, 3}, {0.1, 0, 0}, {0.3, 1.1, -0.4}, Quaterniond(3, 0, 4, 0))}});
    const Quaterniond orientation(0.6, 0, 0.8, 0);
    const PrincipalInertia inertia = principal_inertia(mass_properties(Box{half}, 1).inertia);
    const RotationState state{angular_momentum(inertia, orientation, {0.3, 1.1, -0.4}), orientation, 0};
    const FreeTurning before = world.free_turning(id);
    CHECK((before.angular_momentum - state.momentum).norm() < 1e-15);
    double farthest = 0;
    for (double t = 0.01; t < 20; t += 0.137) {
      world.advance_to(t);
      const FreeTurning now = world.free_turning(id);
      REQUIRE(now.angular_momentum == before.angular_momentum);
      REQUIRE(now.orientation.angularDistance(orientation_at(inertia, state, t)) < 1e-12);
      farthest = std::max(farthest, off(world, id));
    }
    CHECK(farthest <= error);
    if (error < 0.1) CHECK(farthest > 0.5 * error);  // longer pieces would turn by more than a radian
    CHECK(std::abs(kept(world).energy - (0.005 + 0.5 * before.angular_momentum.dot(before.angular_velocity))) < 1e-14);
    CHECK((world.motion(id).path.position(world.now()) - Vector3d(1 + 0.1 * world.now(), 2, 3)).norm() < 1e-15 * 8);
    CHECK(world.counters().rotation_pieces > 3);
    world.audit();
  }
}

TEST_CASE("a plate that turns about its intermediate axis flips over", "[turning]") {
  Turning<1> world({.response = Response::elastic, .orientation_error = 1e-4});
  const Box plate{Vector3d(1.5, 1, 0.25)};
  const BodyId id = world.add_body({.shape = plate, .motion = {motion({0, 0, 0}, {0, 0, 0}, {0.001, 2, 0})}});
  const FreeTurning at_first = world.free_turning(id);
  world.advance_to(15);  // It turned about its y axis, the intermediate one: by now that points the other way.
  const FreeTurning turning = world.free_turning(id);
  CHECK((turning.orientation * Vector3d::UnitY())[1] < -0.999);
  CHECK(turning.angular_momentum == at_first.angular_momentum);
  world.audit();
}

TEST_CASE("what turns about a principal axis, or not at all, has no pieces", "[turning]") {
  Turning<2> world({.response = Response::elastic});
  const Box box{Vector3d(0.3, 0.7, 1.1)};
  world.add_body({.shape = box, .motion = {motion<2>({0, 0, 0}, {0, 0, 0}, {0, 3, 0})}});
  world.add_body({.shape = box, .motion = {motion<2>({9, 0, 0}, {1, 0, 0}, {0, 0, 0})}});
  world.add_body({.shape = Box{Vector3d(0.3, 0.3, 1)}, .motion = {motion<2>({0, 9, 0}, {0, 1, 0}, {2, -2, 0})}});
  CHECK_FALSE(world.step(1000));
  CHECK(world.counters().rotation_pieces == 0);
  CHECK(world.motion(0).angular_velocity == Vector3d(0, 3, 0));
}

TEST_CASE("bodies that precess keep energy and momenta over contacts", "[turning]") {
  const auto in_cage = [](Turning<1>& world) {
    for (int side = 0; side < 6; ++side) {
      Vector3d place = Vector3d::Zero(), half = Vector3d::Constant(4);
      place[side / 2] = side % 2 ? 4 : -4, half[side / 2] = 0.5;
      world.add_body({.shape = Box{half}, .motion = {motion(place, {0, 0, 0}, {0, 0, 0})}, .fixed = true});
    }
  };
  for (const std::uint64_t seed : {1, 2, 3}) {
    CAPTURE(seed);
    Turning<1> world({.response = Response::elastic, .orientation_error = seed == 3 ? 0.1 : 1e-3});
    const bool caged = seed == 2;
    fill(world, seed, 18);
    if (caged) in_cage(world);
    if (!caged) {  // a ring of balls that fly in, so that the bodies meet
      for (int i = 0; i < 40; ++i) {
        Random random(seed * 1000 + static_cast<std::uint64_t>(i));
        const Vector3d from = random_vector(random).normalized() * (8 + 0.7 * i);
        world.add_body({.shape = Sphere{0.4}, .motion = {motion(from, -2 * from.normalized(), {0, 0, 0})}});
      }
    }
    const Kept before = kept(world);
    world.advance_to(6);
    world.audit();
    const Kept after = kept(world);
    const double contacts = static_cast<double>(world.counters().contacts);
    CAPTURE(contacts, world.counters().orientation_resets);
    CHECK(contacts > (caged ? 60 : 10));
    CHECK(world.counters().orientation_resets == 0);
    CHECK(std::abs(after.energy - before.energy) < 1e-15 * before.energy * std::sqrt(contacts) * 2);
    if (caged) continue;
    CHECK((after.momentum - before.momentum).norm() < 1e-13);
    CHECK((after.angular - before.angular).norm() < 1e-12);
  }
}

TEST_CASE("worlds of bodies that precess tell the same whichever broad phase they have", "[turning]") {
  std::vector<std::string> expected;
  for (const BroadPhaseKind kind : {BroadPhaseKind::all_pairs, BroadPhaseKind::sap, BroadPhaseKind::kinetic_sap,
                                    BroadPhaseKind::grid, BroadPhaseKind::automatic}) {
    Log<2> log;
    WorldOptions options{.response = Response::elastic, .broad_phase = kind};
    options.walls = Walls{Vector3d::Constant(-4), Vector3d::Constant(4), 0.9};
    if (kind == BroadPhaseKind::sap) options.rate = 60;
    Turning<2> world(options, &log);
    fill(world, 77, 18);
    for (BodyId id = 0; id < world.size(); ++id) {
      auto falls = world.motion(id);
      falls.path.coefficients[2] = Vector3d(0, 0, -2);
      world.update_motion(id, falls);
    }
    for (int i = 1; i <= 4; ++i) {
      world.advance_to(0.5 * i);
      world.audit();
    }
    if (expected.empty()) expected = log.lines;
    CHECK(log.lines.size() > 200);
    CHECK(log.lines == expected);
  }
}

TEST_CASE("windows, single steps, looks ahead and snapshots change no bit of how bodies precess", "[turning]") {
  const auto begin = [](Turning<1>& world) { fill(world, 5, 18); };
  WorldOptions options{.response = Response::elastic};
  options.walls = Walls{Vector3d::Constant(-4), Vector3d::Constant(4)};
  Log<> expected;
  Turning<1> whole(options, &expected);
  begin(whole);
  whole.advance_to(1.5);
  const auto same = [&](const Turning<1>& world) {
    for (BodyId id = 0; id < whole.size(); ++id) CHECK(world.motion(id) == whole.motion(id));
  };
  Log<> log;
  options.window = 0.1;
  Turning<1> windows(options, &log);
  begin(windows);
  windows.advance_to(0);
  CHECK_THROWS_WITH(windows.next_time(), Catch::Contains("so it needs extend_horizon(), or a Simulator with a window"));
  windows.extend_horizon(0, 0.1);
  while (windows.next_time() <= 1.5 || windows.next_time() == never) {
    if (windows.next_time() == never) {
      if (windows.now() + 0.1 > 1.5) break;
      windows.extend_horizon(windows.now(), windows.now() + 0.1);
      windows.advance_to(windows.now() + 0.05);
    } else {
      const auto before = windows.motion(0);
      windows.next_time();
      REQUIRE(windows.motion(0) == before);
      windows.process();
    }
  }
  windows.advance_to(1.5);
  CHECK(log.lines == expected.lines);
  same(windows);

  Log<> saved;
  auto first = std::make_unique<Turning<1>>(options, &saved);
  begin(*first);
  for (int i = 1; i <= 5; ++i) {
    first->advance_to(0.3 * i - 0.05);
    const Snapshot snapshot = save(*first);
    auto second = std::make_unique<Turning<1>>(options, &saved);
    restore(snapshot, *second);
    second->audit();
    first = std::move(second);
  }
  first->advance_to(1.5);
  CHECK(saved.lines == expected.lines);
  same(*first);
}

TEST_CASE("edits and scripts say how a body turns, and its angular momentum follows", "[turning]") {
  Turning<1> world({.response = Response::elastic});
  const Matrix3d tensor = Vector3d(1, 2, 2.5).asDiagonal();
  auto second = motion({0, 0, 0}, {0, 0, 0}, {0, 0, 2});
  second.path.start = 2;
  const BodyId id = world.add_body(
      {.shape = Sphere{1}, .motion = {motion({0, 0, 0}, {0, 0, 0}, {1, 1, 1}), second}, .inertia = tensor});
  CHECK(world.free_turning(id).angular_momentum == Vector3d(1, 2, 2.5));
  world.advance_to(1.23);
  const Vector3d momentum = world.free_turning(id).angular_momentum;
  CHECK(momentum == Vector3d(1, 2, 2.5));
  // A push changes the path alone: the angular velocity, which is that of the piece, is the same to the bit.
  auto pushed = world.motion(id).restarted(world.now());
  pushed.path.coefficients[1] = Vector3d(3, 0, 0);
  const Quaterniond before = world.free_turning(id).orientation;
  world.update_motion(id, pushed);
  CHECK(world.free_turning(id).angular_momentum == momentum);
  CHECK(world.free_turning(id).orientation.coeffs() == before.coeffs());
  world.advance_to(1.9);
  CHECK(off(world, id) <= 1e-3);
  CHECK((world.motion(id).path.position(1.9) - Vector3d(3 * (1.9 - 1.23), 0, 0)).norm() < 1e-14);
  // That has discarded the script.
  world.advance_to(2.5);
  CHECK(world.free_turning(id).angular_momentum == momentum);
  // Another angular velocity.
  auto turned = motion({0, 0, 0}, {0, 0, 0}, {0, 0, 2}, Quaterniond(0, 0, 5, 0));
  turned.path.start = 2.5;
  world.update_motion(id, turned);
  CHECK((world.free_turning(id).angular_momentum - Vector3d(0, 0, 5)).norm() < 1e-15);
  CHECK(world.motion(id).angular_velocity == Vector3d(0, 0, 2));
  world.advance_to(3);
  world.audit();
  world.remove_body(id);
  world.advance_to(4);
  // The slot is given again, to a body that does not precess, and then to one that does.
  const BodyId ball = world.add_body({.shape = Sphere{1}, .motion = {motion({0, 0, 0}, {0, 0, 0}, {1, 1, 1})}});
  CHECK(body_slot(ball) == body_slot(id));
  world.advance_to(5);
  CHECK(world.motion(ball).angular_velocity == Vector3d(1, 1, 1));
}

TEST_CASE("a script of a body that precesses begins each of its pieces anew", "[turning]") {
  Turning<1> world({.response = Response::elastic});
  auto first = motion({0, 0, 0}, {0, 0, 0}, {1, 1, 1});
  first.path.start = 1;
  auto second = motion({0, 0, 0}, {0, 0, 0}, {0, 0, 2});
  second.path.start = 2;
  const BodyId id = world.add_body(
      {.shape = Sphere{1}, .motion = {first, second}, .inertia = Matrix3d(Vector3d(1, 2, 2.5).asDiagonal())});
  world.advance_to(1.5);
  CHECK(world.free_turning(id).angular_momentum == Vector3d(1, 2, 2.5));
  CHECK(world.counters().rotation_pieces > 3);
  world.audit();
  world.advance_to(2.5);
  CHECK(world.free_turning(id).angular_momentum == Vector3d(0, 0, 5));
  const auto pieces = world.counters().rotation_pieces;
  world.advance_to(9);
  CHECK(world.counters().rotation_pieces == pieces);
}

TEST_CASE("a plate that rocks on the floor stays within twice the option of its free rotation", "[turning]") {
  Log<2> log;
  Turning<2> world({.response = Response::elastic}, &log);
  world.add_body(
      {.shape = Box{Vector3d(5, 5, 0.5)}, .motion = {motion<2>({0, 0, -0.5}, {0, 0, 0}, {0, 0, 0})}, .fixed = true});
  auto falls = motion<2>({0, 0, 0.6}, {0, 0, 0}, {0.4, 0.3, 3}, Quaterniond(0.98, 0.15, 0.1, 0).normalized());
  falls.path.coefficients[2] = Vector3d(0, 0, -5);
  const BodyId plate =
      world.add_body({.shape = Box{Vector3d(0.6, 0.5, 0.05)}, .motion = {falls}, .restitution = 0.3, .friction = 0.2});
  double farthest = 0;
  for (int i = 1; i <= 100; ++i) {
    world.advance_to(0.01 * i);
    world.audit();
    farthest = std::max(farthest, off(world, plate));
    REQUIRE(world.motion(plate).path.position(world.now())[2] > 0.049);
  }
  CHECK(world.counters().contacts > 10);
  CHECK(farthest <= 2e-3);
}

TEST_CASE("what cannot precess is refused by name", "[turning]") {
  Turning<1> world({.response = Response::elastic});
  const auto what = [&](const Turning<1>::Description& body) -> std::string {
    try {
      world.add_body(body);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "accepted";
  };
  Turning<1>::Description body{.shape = Box{Vector3d(1, 2, 3)}, .motion = {motion({0, 0, 0}, {0, 0, 0}, {1, 1, 1})}};
  const auto with = [&](const Matrix3d& tensor) {
    body.inertia = tensor;
    return what(body);
  };
  CHECK(with(Vector3d(1, 2, 4).asDiagonal()) ==
        "inertia: is of no body: its greatest moment exceeds the sum of the two others");
  CHECK(with(Vector3d(1, 2, 0).asDiagonal()) == "inertia: must be positive definite");
  CHECK(with(Vector3d(1, 1, 1e-13).asDiagonal()) ==
        "inertia: its least moment must be at least 2^-40 (9.1e-13) of the greatest");
  body.inertia = Inertia();
  body.motion[0].path.start = 0;
  body.motion[0].angular_velocity = Vector3d(1e20, 1e20, 0);
  world.advance_to(1);
  CHECK(what(body) ==
        "motion[0].angular_velocity: the body precesses, and turns by more than a radian between two doubles of the "
        "clock");
  body.motion[0].angular_velocity = Vector3d(1, 1, 0);
  const BodyId id = world.add_body(body);
  CHECK_THROWS_AS(world.update_motion(id, motion({0, 0, 0}, {0, 0, 0}, {1e20, 1e20, 0})), std::invalid_argument);
  world.advance_to(2);
  body.fixed = true;
  const BodyId driven = world.add_body(body);
  CHECK_THROWS_AS(world.free_turning(driven), std::invalid_argument);
  CHECK(world.free_turning(id).angular_velocity.norm() > 1);
  CHECK_THROWS_AS(Turning<1>({.orientation_error = 0}), std::invalid_argument);
  CHECK_THROWS_AS(Turning<1>({.orientation_error = 0.2}), std::invalid_argument);
  CHECK_THROWS_AS(Turning<1>({.orientation_error = std::nan("")}), std::invalid_argument);
}

}  // namespace test_tumbling
