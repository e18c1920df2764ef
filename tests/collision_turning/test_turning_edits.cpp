// Masses and filters of bodies that turn, changed while the world runs.
#include "collision/world.hpp"
#include "kds/framework/snapshot.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

namespace test_turning_edits {
namespace {

using namespace kds;
using namespace kds::collision;
using certificates::RigidMotion;
using Eigen::Vector3d;

template <int Degree>
RigidMotion<Degree> turning(const Vector3d& place, const Vector3d& velocity, const Vector3d& angular_velocity) {
  RigidMotion<Degree> motion;
  motion.path.coefficients[0] = place, motion.path.coefficients[1] = velocity;
  motion.angular_velocity = angular_velocity;
  return motion;
}

TEST_CASE("A free body that precesses keeps turning as it did when its mass changes") {
  const auto world_of_one = [] {
    auto world = std::make_unique<TurningWorld<1>>(WorldOptions{.response = Response::elastic});
    world->add_body(
        {.shape = Box{{1, 0.6, 0.3}}, .motion = {turning<1>({0, 0, 0}, {1, 0, 0}, {1, 2, 0.5})}, .mass = 2});
    world->advance_to(1.5);
    return world;
  };
  const auto heavy = world_of_one(), same = world_of_one();
  heavy->set_mass(0, 8);  // a factor that is a power of two: the same roundings
  const FreeTurning before = same->free_turning(0), after = heavy->free_turning(0);
  CHECK(after.angular_momentum == 4 * before.angular_momentum);
  CHECK(after.angular_velocity == before.angular_velocity);
  for (const double t : {2.0, 5.0}) {
    heavy->advance_to(t), same->advance_to(t);
    CHECK(heavy->motion(0) == same->motion(0));
  }
  heavy->audit();
  TurningWorld<1> loaded(WorldOptions{.response = Response::elastic});
  restore(save(*heavy), loaded);
  CHECK(loaded.mass(0) == 8);
}

TEST_CASE("A ball's new mass and inertia count from the next contact on") {
  TurningWorld<1> world(WorldOptions{.response = Response::elastic});
  for (const double side : {-1.0, 1.0}) {
    world.add_body({.shape = Sphere{1},
                    .motion = {turning<1>({3 * side, 0, 0}, {-side, 0, 0}, {0, 0, 1})},
                    .friction = 1,
                    .tangential_restitution = 0});
  }
  world.advance_to(1);
  world.set_mass(0, 1e6);
  world.advance_to(3);
  // The heavy one is a wall for the other, which reverses its velocity against it, and its surface takes up the speed
  // of the heavy one's: of the slip of 2 of surfaces that turn alike, by an impulse of 2/7 of it.
  const auto heavy = world.motion(0), light = world.motion(1);
  CHECK(heavy.path.velocity(3)[0] == Approx(1).epsilon(1e-5));
  CHECK(light.path.velocity(3)[0] == Approx(3).epsilon(1e-5));
  CHECK(std::abs(light.path.velocity(3)[1]) == Approx(2 * 2. / 7).epsilon(1e-5));
  CHECK(heavy.angular_velocity[2] == Approx(1).epsilon(1e-5));
}

TEST_CASE("A crate whose mask leaves out the floor wakes and falls") {
  struct Told final : TurningWorld<2>::Listener {
    std::vector<std::string> lines;
    void rests(TurningWorld<2>&, const PairEvent& e) override { lines.push_back("rests " + std::to_string(e.a)); }
    void wakes(TurningWorld<2>&, const PairEvent& e) override { lines.push_back("wakes " + std::to_string(e.a)); }
  } told;
  WorldOptions options{.response = Response::elastic};
  options.broad_phase = GENERATE(BroadPhaseKind::automatic, BroadPhaseKind::kinetic_sap, BroadPhaseKind::grid);
  TurningWorld<2> world(options, &told);
  TurningWorld<2>::Description floor{.shape = Box{{5, 5, 1}}, .motion = {turning<2>({0, 0, -1}, {0, 0, 0}, {0, 0, 0})}};
  floor.fixed = true, floor.friction = 1, floor.category = 2, floor.restitution = 0;
  world.add_body(floor);
  TurningWorld<2>::Description crate{.shape = Box{{0.5, 0.5, 0.5}},
                                     .motion = {turning<2>({0, 0, 0.51}, {0, 0, 0}, {0, 0, 0})}};
  crate.motion[0].path.coefficients[2] = {0, 0, -5};
  crate.friction = 1, crate.restitution = 0;
  const BodyId id = world.add_body(crate);
  world.advance_to(2);
  REQUIRE(world.resting(0, id));
  std::vector<BodyId> partners;
  world.visit_partners(id, [&](BodyId other) { partners.push_back(other); });
  CHECK(partners == std::vector<BodyId>{0});
  world.set_filter(id, 1, ~4u);
  world.advance_to(3);
  CHECK(world.resting(0, id));
  world.set_filter(id, 1, ~2u);
  world.advance_to(4);
  CHECK(told.lines == std::vector<std::string>{"rests 0", "wakes 0"});
  CHECK(world.motion(id).path.position(4)[2] == Approx(0.5 - 5).epsilon(1e-4));
  world.audit();
}

}  // namespace
}  // namespace test_turning_edits
