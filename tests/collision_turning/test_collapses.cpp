// Bodies that are pinched between others, whose blows they would hand to and fro for ever.
#include "collision/world.hpp"
#include "kds/framework/snapshot.hpp"
#include "tests/collision_turning/narrow_phase/turning_oracle.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace test_collapses {
namespace {

using namespace kds;
using namespace kds::collision;
using certificates::RigidMotion;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using kds::tests::TurningOracle;
using Turning = BasicWorld<RigidMotion<2>>;

struct Log : Turning::Listener {
  std::vector<std::string> contacts;
  int passed = 0;

  void contact(Turning&, const PairEvent& event) override {
    char text[200];
    std::snprintf(text, sizeof text, "%a %llu %llu %a %a", event.contact.time, static_cast<unsigned long long>(event.a),
                  static_cast<unsigned long long>(event.b), event.contact.normal[0], event.contact.point[0]);
    contacts.emplace_back(text);
  }
  void passes(Turning&, const PairEvent&) override { ++passed; }
};

RigidMotion<2> motion(const Vector3d& position, const Vector3d& velocity, const Vector3d& acceleration,
                      const Vector3d& spin, const Quaterniond& orientation = Quaterniond::Identity()) {
  RigidMotion<2> result{{{position, velocity, acceleration / 2}}};
  result.angular_velocity = spin;
  result.orientation = orientation;
  return result;
}

const Vector3d none = Vector3d::Zero();

/// A world, and what its bodies are.
struct Scene {
  Log log;
  std::unique_ptr<Turning> world;
  std::vector<Shape> shapes;
  std::vector<double> masses;  ///< 0: fixed
  std::vector<Vector3d> accelerations;

  explicit Scene(BroadPhaseKind kind = BroadPhaseKind::automatic)
      : world(std::make_unique<Turning>(
            WorldOptions{
                .response = Response::elastic, .broad_phase = kind, .rate = kind == BroadPhaseKind::sap ? 60.0 : 0},
            &log)) {}

  void add(const Shape& shape, const RigidMotion<2>& moves, double mass, double restitution, double friction = 0) {
    shapes.push_back(shape);
    masses.push_back(mass);
    accelerations.emplace_back(2 * moves.path.coefficients[2]);
    world->add_body({.shape = shape,
                     .motion = {moves},
                     .mass = mass > 0 ? mass : 1,
                     .fixed = mass == 0,
                     .restitution = restitution,
                     .friction = friction});
  }

  double energy() const {
    double sum = 0;
    for (BodyId id = 0; id < shapes.size(); ++id) {
      if (masses[id] == 0) continue;
      const auto& path = world->motion(id).path;
      const double t = world->now();
      const auto turning = world->free_turning(id);
      sum += 0.5 * masses[id] * path.velocity(t).squaredNorm() +
             0.5 * turning.angular_momentum.dot(turning.angular_velocity) -
             masses[id] * accelerations[id].dot(path.position(t));
    }
    return sum;
  }
  /// Of what moves, without what the accelerations have added.
  Vector3d momentum() const {
    Vector3d sum = none;
    for (BodyId id = 0; id < shapes.size(); ++id) {
      const double t = world->now();
      if (masses[id] > 0) sum += masses[id] * (world->motion(id).path.velocity(t) - t * accelerations[id]);
    }
    return sum;
  }
  /// The least gap of two bodies, neither of which two are balls or fixed.
  double gap() const {
    double least = never;
    for (BodyId a = 0; a < shapes.size(); ++a) {
      for (BodyId b = a + 1; b < shapes.size(); ++b) {
        if (masses[a] == 0 && masses[b] == 0) continue;
        least = std::min(least, static_cast<double>(TurningOracle::gap(world->motion(a), shapes[a], world->motion(b),
                                                                       shapes[b], world->now())));
      }
    }
    return least;
  }
};

/// Advances in steps, up to a time or so many contacts; after each step the energy must not have grown by more than
/// what shortest flights lift, and no two bodies may be in each other.
void run(Scene& scene, double until, std::size_t most_contacts, double most_grown) {
  constexpr int steps = 64;
  double energy = scene.energy();
  for (int i = 1; i <= steps; ++i) {
    const double t = until * i / steps;
    while (scene.log.contacts.size() <= most_contacts && scene.world->step(t)) {
    }
    REQUIRE(scene.log.contacts.size() <= most_contacts);
    scene.world->advance_to(t);
    const double now = scene.energy();
    CHECK(now <= energy + most_grown);
    energy = now;
    CHECK(scene.gap() > -1e-13);
  }
  scene.world->audit();
}

/// The same where nothing is fixed: momentum is kept up to an error, and no two bodies are let through each other.
void run_free(Scene& scene, double until, std::size_t most_contacts, double most_grown, double momentum_error) {
  const Vector3d before = scene.momentum();
  run(scene, until, most_contacts, most_grown);
  CHECK(scene.log.passed == 0);
  CHECK((scene.momentum() - before).norm() < momentum_error);
}

/// A box of restitution e between a box and a ball that close in on it. All boxes precess.
void pinch(Scene& scene, double e) {
  const Box box{Vector3d(1, 0.5, 0.25)};
  scene.add(box,
            motion({-0.258, -0.629, -0.258}, {-2, -1, -2}, none,
                   {0.48743276071164193, 0.08265391762059919, 1.001351930619806},
                   {0.9974024683244652, 0.03213020013109482, 0.001858556635236147, 0.06443998903657201}),
            0.25, 0.5, 0.3);
  scene.add(box,
            motion({-1.83875, -1.0645, -0.8793205000000001}, {1.25, -0.5, 0.871}, {0, 0, -1},
                   {0.9873915205535501, -0.11778879082008024, -1.0027112633237796},
                   {0.9958508603851584, 0.06417420463382757, -0.004092354918506548, -0.064389346641945}),
            0.25, e, 0.3);
  scene.add(Sphere{1}, motion({-3, -0.871, 0.371}, {0, 1, -1}, none, {1, 1, -1}), 1, 1, 0.3);
}

/// Two plates that close in on a body, which they cannot but press in the end.
void close_in(Scene& scene, const Shape& shape, double e) {
  const Box plate{Vector3d(0.25, 2, 2)};
  scene.add(plate, motion({-2, 0, 0}, {0.5, 0, 0}, none, none), 0, 1);
  scene.add(plate, motion({2, 0, 0}, {-0.5, 0, 0}, none, none), 0, 1);
  scene.add(shape, motion({0.125, 0, 0}, {1, 0.125, 0}, none, {0.25, 0.125, 1}), 1, e, 0.3);
}

/// A light box between two that are a hundred times as heavy.
void crush(Scene& scene, double e) {
  const Box box{Vector3d(1, 0.5, 0.25)};
  const Vector3d g(0, 0, -9.81);
  scene.add(box, motion({0, 0, 1}, {0, 0, -1}, g, {0.1, 0.2, 0}), 100, 1, 0.3);
  scene.add(box, motion({0.1, 0.1, 0}, none, g, {0, 0.1, 0.3}), 1, e, 0.3);
  scene.add(box, motion({0.3, 0.2, -1}, {0, 0, 1}, g, {0.3, 0, 0}), 100, 1, 0.3);
}

}  // namespace

TEST_CASE("a box that is pinched does not hand blows to and fro without end", "[collapse]") {
  for (const double e : {0.0, 0.1}) {
    CAPTURE(e);
    Scene scene;
    pinch(scene, e);
    run_free(scene, 0.046875, 6000, 1e-9, 1e-12);
  }
}

TEST_CASE("what plates close in on gets no faster than they are, and is let through one of them", "[collapse]") {
  for (const double e : {0.0, 0.3}) {
    for (const Shape& shape : {Shape(Sphere{0.5}), Shape(Box{Vector3d(0.5, 0.375, 0.25)})}) {
      CAPTURE(e, shape.index());
      Scene scene;
      close_in(scene, shape, e);
      scene.world->advance_to(4);
      scene.world->audit();
      CHECK(scene.log.passed > 0);
      CHECK(scene.log.contacts.size() < 500);
      CHECK(scene.world->motion(2).path.velocity(4).norm() < 4);
      CHECK(scene.energy() < 2);
    }
  }
}

TEST_CASE("a light box between heavy ones takes bounded contacts, and keeps the momentum", "[collapse]") {
  for (const double e : {0.0, 0.3}) {
    CAPTURE(e);
    Scene scene;
    crush(scene, e);
    run_free(scene, 0.5, 3000, 1e-3, 1e-11);
  }
}

TEST_CASE("light bodies without rebound between heavy ones that nothing presses are not let through", "[collapse]") {
  // Two heavy bodies fly towards each other, with light ones between them: nothing accelerates any of them.
  for (const Shape& shape : {Shape(Sphere{1}), Shape(Box{Vector3d(1, 0.875, 0.75)})}) {
    for (int count = 3; count <= 4; ++count) {
      CAPTURE(shape.index(), count);
      Scene scene;
      for (int i = 0; i < count; ++i) {
        const bool heavy = i == 0 || i == count - 1;
        const double velocity = i == 0 ? 1 : heavy ? -1 : 0.01 * i;
        scene.add(shape, motion({2.5 * i, 0.01 * (i % 2), 0}, {velocity, 0, 0}, none, none), heavy ? 100 : 1, 0);
      }
      scene.world->advance_to(8);
      scene.world->audit();
      CHECK(scene.log.passed == 0);
      CHECK(scene.log.contacts.size() < 30'000);
      for (BodyId id = 1; id < scene.shapes.size(); ++id) {
        CHECK(scene.world->motion(id).path.position(8)[0] > scene.world->motion(id - 1).path.position(8)[0] + 1);
      }
    }
  }
}

TEST_CASE("a box that drops between two walls that lean apart comes to lie there", "[collapse]") {
  for (const double e : {0.0, 0.3}) {
    CAPTURE(e);
    Scene scene;
    for (const double side : {-1.0, 1.0}) {
      const Quaterniond leans(0.875, 0, -side * 0.5, 0);
      scene.add(Box{Vector3d(3, 3, 0.25)}, motion({side * 1.5, 0, 0}, none, none, none, leans), 0, 1, 0.5);
    }
    scene.add(Box{Vector3d(0.5, 0.25, 0.375)}, motion({0.01, 0, 2}, none, {0, 0, -9.81}, {0.1, 0.2, 0.3}), 1, e, 0.5);
    run(scene, 2, 30000, 1e-3);
    CHECK(scene.log.passed == 0);
  }
}

TEST_CASE("what becomes a thousand times as heavy presses nothing through the floor", "[collapse]") {
  Scene scene;
  const Vector3d weight(0, 0, -10);
  scene.add(HalfSpace{Vector3d::UnitZ(), 0}, motion(none, none, none, none), 0, 1, 1);
  for (const int i : {0, 1, 2}) {
    const Vector3d place(0.01 * i, 0, 0.5 + 1.0001 * i);
    scene.add(Box{Vector3d::Constant(0.5)}, motion(place, none, weight, none), 1, 0.3, 0.5);
  }
  scene.world->advance_to(2);
  CHECK(scene.world->resting(0, 1));
  scene.world->set_mass(3, 1000);
  scene.world->advance_to(2.01);
  CHECK(scene.log.passed == 0);
  for (const BodyId id : {1, 2, 3}) {
    CHECK(std::abs(scene.world->motion(id).path.position(2.01)[2] - (static_cast<double>(id) - 0.5)) < 1e-3);
  }
}

TEST_CASE("collapses are the same with all broad phases and snapshots", "[collapse]") {
  const auto contacts = [](BroadPhaseKind kind, bool saves) {
    auto scene = std::make_unique<Scene>(kind);
    crush(*scene, 0);
    std::size_t seen = 0;
    while (scene->world->step(0.5)) {
      if (!saves || scene->log.contacts.size() < seen + 16) continue;
      seen = scene->log.contacts.size();
      const auto image = save(*scene->world);
      auto next = std::make_unique<Scene>(kind);
      restore(image, *next->world);
      next->log.contacts = scene->log.contacts;
      scene = std::move(next);
    }
    return scene->log.contacts;
  };
  const auto expected = contacts(BroadPhaseKind::automatic, false);
  CHECK(expected.size() > 200);
  CHECK(contacts(BroadPhaseKind::automatic, true) == expected);
  for (const BroadPhaseKind kind : {BroadPhaseKind::sap, BroadPhaseKind::kinetic_sap, BroadPhaseKind::grid}) {
    CAPTURE(static_cast<int>(kind));
    CHECK(contacts(kind, false) == expected);
  }
}

}  // namespace test_collapses
