// Friction and tangential restitution in worlds of bodies that turn.
#include "collision/response/mass_properties.hpp"
#include "collision/world.hpp"
#include "kds/framework/snapshot.hpp"

#include "tests/collision_turning/narrow_phase/turning_solids.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace test_friction {
namespace {

using namespace kds;
using namespace kds::collision;
using certificates::RigidMotion;
using Eigen::Vector3d;
using kds::tests::Random;
using kds::tests::random_vector;
using Turning = TurningWorld<1>;
using Body = Turning::Description;

RigidMotion<1> motion(const Vector3d& position, const Vector3d& velocity, const Vector3d& spin) {
  RigidMotion<1> result{{{position, velocity}}};
  result.angular_velocity = spin;
  return result;
}

/// Contacts, with the motions that they lead to.
struct Log : Turning::Listener {
  std::vector<std::string> lines;
  void contact(Turning& world, const PairEvent& event) override {
    char text[300];
    const auto& a = world.motion(event.a);
    const auto& b = world.motion(event.b);
    std::snprintf(text, sizeof text, "%a %llu %llu %a %a %a %a %a %a", event.contact.time,
                  static_cast<unsigned long long>(event.a), static_cast<unsigned long long>(event.b),
                  a.path.coefficients[1][0], a.angular_velocity[0], a.angular_velocity[1], b.path.coefficients[1][2],
                  b.angular_velocity[1], b.angular_velocity[2]);
    lines.emplace_back(text);
  }
};

/// What a world without walls keeps, about the origin of space.
struct Totals {
  double energy = 0;
  Vector3d momentum = Vector3d::Zero(), angular_momentum = Vector3d::Zero();
};

/// Balls and cubes, every third a ball, that fly towards the middle; surfaces of all kinds, or all the same.
struct Cloud {
  explicit Cloud(std::uint64_t seed) {
    Random random(seed);
    for (int i = 0; i < 27; ++i) {
      const Vector3d place = 2.0 * Vector3d(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1) + random_vector(random, 0.1);
      Body body{.shape = Box{Vector3d(0.4, 0.4, 0.4)},
                .motion = {motion(place, random_vector(random, 0.5) - place, random_vector(random, 6))}};
      if (i % 3 == 0) body.shape = Sphere{0.5};
      body.mass = random.between(0.5, 2);
      body.restitution = i % 2 == 0 ? 1 : 0.75;
      body.friction = random.one_in(5) ? 0 : random.between(0, 2);
      body.tangential_restitution = random.between(-1, 1);
      bodies.push_back(body);
    }
  }

  void fill(Turning& world) const {
    for (const Body& body : bodies) world.add_body(body);
  }

  Totals totals(const Turning& world, double t) const {
    Totals sum;
    for (BodyId id = 0; id < bodies.size(); ++id) {
      const Body& body = bodies[id];
      const double moment = mass_properties(body.shape, body.mass).inertia(0, 0);
      const auto& m = world.motion(id);
      const Vector3d velocity = m.path.velocity(t);
      sum.energy += 0.5 * (body.mass * velocity.squaredNorm() + moment * m.angular_velocity.squaredNorm());
      sum.momentum += body.mass * velocity;
      sum.angular_momentum += body.mass * m.path.position(t).cross(velocity) + moment * m.angular_velocity;
    }
    return sum;
  }

  std::vector<Body> bodies;
};

/// Flights that are all but unbounded below: what rebounds faster than restitution says would gain energy.
WorldOptions options(BroadPhaseKind kind = BroadPhaseKind::automatic) {
  WorldOptions result{.response = Response::elastic, .broad_phase = kind};
  result.shortest_flight = 1e-12;
  if (kind == BroadPhaseKind::sap) result.rate = 60;
  return result;
}

}  // namespace

TEST_CASE("a ball with spin bounces off a floor as the rough sphere does", "[friction]") {
  const std::uint64_t seed = 5;
  CAPTURE(seed);
  Random random(seed);
  int sliding = 0, sticking = 0;
  for (int i = 0; i < 200; ++i) {
    CAPTURE(i);
    const double radius = random.between(0.2, 1), mass = random.between(0.5, 2), moment = 0.4 * mass * radius * radius;
    const double e = random.between(0, 1), mu = random.between(0, 1), e_t = random.between(-1, 1);
    const Vector3d velocity(random.between(-2, 2), random.between(-2, 2), -random.between(0.5, 2));
    const Vector3d spin = random_vector(random, 5);
    Turning world(options());
    // Of each number the lower counts.
    const bool lower = random.one_in(2);
    const BodyId floor = world.add_body({.shape = Box{Vector3d(9, 9, 1)},
                                         .motion = {motion({0, 0, -1}, {0, 0, 0}, {0, 0, 0})},
                                         .fixed = true,
                                         .friction = lower ? mu + 0.5 : mu,
                                         .tangential_restitution = lower ? e_t : 1});
    const BodyId ball = world.add_body({.shape = Sphere{radius},
                                        .motion = {motion({0, 0, radius + 1}, velocity, spin)},
                                        .mass = mass,
                                        .restitution = e,
                                        .friction = lower ? mu : mu + 0.5,
                                        .tangential_restitution = lower ? 1 : e_t});
    world.advance_to(2.5);
    const Vector3d down(0, 0, -radius);
    Vector3d slip = velocity + spin.cross(down);
    slip[2] = 0;
    const double push = mass * (1 + e) * -velocity[2];
    Vector3d along = -(1 + e_t) * slip * (2 * mass / 7);
    const bool slides = along.norm() > mu * push;
    if (slides) along = -mu * push * slip.normalized();
    ++(slides ? sliding : sticking);
    const Vector3d velocity_after = velocity + (along + Vector3d(0, 0, push)) / mass;
    const Vector3d spin_after = spin + down.cross(along) / moment;
    CHECK((world.motion(ball).path.coefficients[1] - velocity_after).norm() < 1e-13);
    CHECK((world.motion(ball).angular_velocity - spin_after).norm() < 1e-12);
    CHECK(world.motion(floor).angular_velocity.isZero(0));
    CHECK(world.counters().contacts == 1);
  }
  CHECK(sliding > 40);
  CHECK(sticking > 40);
}

TEST_CASE("a ball thrown onto a floor with backspin ends up rolling", "[friction]") {
  using Falling = TurningWorld<2>;
  const double radius = 0.5, speed = 2;
  for (const double spin : {-20.0, 0.0, 3.0, 30.0}) {
    CAPTURE(spin);
    Falling world({.response = Response::elastic});
    RigidMotion<2> on_floor{{{Vector3d(0, 0, -1)}}}, thrown{{{{0, 0, radius + 0.25}, {speed, 0, 0}, {0, 0, -5}}}};
    thrown.angular_velocity = {0, spin, 0};
    world.add_body({.shape = Box{Vector3d(99, 9, 1)}, .motion = {on_floor}, .fixed = true, .friction = 0.5});
    const BodyId ball =
        world.add_body({.shape = Sphere{radius}, .motion = {thrown}, .restitution = 0.5, .friction = 0.5});
    world.advance_to(2);
    // Whatever friction does, it keeps the angular momentum about points of the floor.
    const double rolls = (5 * speed + 2 * radius * spin) / 7;
    const auto& after = world.motion(ball);
    CHECK(std::abs(after.path.coefficients[1][0] - rolls) < 1e-11);
    CHECK(std::abs(after.angular_velocity[1] - rolls / radius) < 1e-11);
    CHECK(std::abs(after.path.coefficients[1][1]) < 1e-11);
    CHECK(std::abs(after.path.position(2)[2] - radius) < 1e-5);
    CHECK(world.counters().contacts < 2500);
  }
}

TEST_CASE("friction keeps momenta, and never adds energy", "[friction]") {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    CAPTURE(seed);
    const Cloud cloud(seed);
    struct Ledger : Turning::Listener {
      const Cloud* cloud = nullptr;
      double energy = 0, gained = 0;
      int contacts = 0;
      void contact(Turning& world, const PairEvent& event) override {
        const double now = cloud->totals(world, event.contact.time).energy;
        gained = std::max(gained, (now - energy) / energy);
        energy = now;
        ++contacts;
      }
    } ledger;
    Turning world(options(), &ledger);
    cloud.fill(world);
    const Totals before = cloud.totals(world, 0);
    ledger.cloud = &cloud, ledger.energy = before.energy;
    world.advance_to(4);
    const Totals after = cloud.totals(world, 4);
    CHECK(ledger.contacts > 30);
    CHECK(ledger.gained < 1e-14);
    CHECK(after.energy < 0.95 * before.energy);
    CHECK((after.momentum - before.momentum).norm() < 1e-12);
    CHECK((after.angular_momentum - before.angular_momentum).norm() < 1e-12);
  }
}

TEST_CASE("perfectly rough balls keep their energy, and smooth ones their spins", "[friction]") {
  for (const double e_t : {1.0, -1.0}) {
    CAPTURE(e_t);
    Cloud cloud(7);
    for (Body& body : cloud.bodies) {
      body.shape = Sphere{0.5};
      body.restitution = 1, body.friction = 1e9, body.tangential_restitution = e_t;
    }
    Log log;
    Turning world(options(), &log);
    cloud.fill(world);
    const double before = cloud.totals(world, 0).energy;
    world.advance_to(4);
    CHECK(log.lines.size() > 30);
    CHECK(std::abs(cloud.totals(world, 4).energy - before) < 1e-12 * before);
    int turned = 0;
    for (BodyId id = 0; id < cloud.bodies.size(); ++id) {
      turned += world.motion(id).angular_velocity != cloud.bodies[id].motion[0].angular_velocity;
    }
    CHECK((e_t == 1 ? turned > 15 : turned == 0));
  }
}

TEST_CASE("what is smooth in one way or the other gives the same bits as no friction", "[friction]") {
  const auto run = [](double friction, double e_t, bool every_other) {
    Cloud cloud(8);
    for (std::size_t i = 0; i < cloud.bodies.size(); ++i) {
      cloud.bodies[i].friction = every_other && i % 2 == 0 ? 0 : friction;
      cloud.bodies[i].tangential_restitution = e_t;
    }
    Log log;
    Turning world(options(), &log);
    // Of the even bodies, which are smooth, and of the odd ones, which meet none but them.
    for (std::size_t i = 0; i < cloud.bodies.size(); ++i) {
      if (!every_other) continue;
      cloud.bodies[i].category = i % 2 == 0 ? 1 : 2;
      cloud.bodies[i].collides_with = i % 2 == 0 ? 2 : 1;
    }
    cloud.fill(world);
    world.advance_to(3);
    return log.lines;
  };
  const auto smooth = run(0, 0, false);
  CHECK(smooth.size() > 30);
  CHECK(run(1, -1, false) == smooth);
  CHECK(run(0, 1, false) == smooth);
  CHECK(run(1, 0, false) != smooth);
  CHECK(run(1, 0, true) == run(0, 0, true));
}

TEST_CASE("with friction all broad phases and snapshots give the same contacts and motions", "[friction]") {
  const auto run = [](WorldOptions chosen, bool snapshots) {
    chosen.walls = Walls{Vector3d::Constant(-4), Vector3d::Constant(4)};
    Log log;
    auto world = std::make_unique<Turning>(chosen, &log);
    Cloud(9).fill(*world);
    for (int i = 1; i <= 8; ++i) {
      world->advance_to(0.5 * i);
      world->audit();
      if (!snapshots) continue;
      const auto image = save(*world);
      world = std::make_unique<Turning>(chosen, &log);
      restore(image, *world);
    }
    return log.lines;
  };
  const auto expected = run(options(BroadPhaseKind::all_pairs), false);
  CHECK(expected.size() > 60);
  for (const BroadPhaseKind kind : {BroadPhaseKind::sap, BroadPhaseKind::kinetic_sap, BroadPhaseKind::grid}) {
    CAPTURE(static_cast<int>(kind));
    CHECK(run(options(kind), false) == expected);
  }
  CHECK(run(options(), true) == expected);
}

TEST_CASE("surfaces that no body has are refused", "[friction]") {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Turning world({.response = Response::elastic});
  const auto add = [&](double friction, double e_t) {
    world.add_body({.shape = Sphere{1},
                    .motion = {motion({0, 0, 0}, {0, 0, 0}, {0, 0, 0})},
                    .friction = friction,
                    .tangential_restitution = e_t});
  };
  for (const double bad : {-0.5, nan, infinity}) {
    CHECK_THROWS_WITH(add(bad, 0), Catch::StartsWith("friction: must be in [0, 2^205"));
  }
  for (const double bad : {-1.5, 1.5, nan}) {
    CHECK_THROWS_WITH(add(1, bad), "tangential_restitution: must be in [-1, 1]");
  }
  CHECK(world.size() == 0);
  World<1> others({.response = Response::elastic});
  BodyDescription<1> body{.shape = Sphere{1}, .motion = {{{{Vector3d(0, 0, 0)}}}}, .friction = 0.5};
  CHECK_THROWS_WITH(others.add_body(body), "friction: bodies of this world do not turn");
  body.friction = 0, body.tangential_restitution = -1;
  CHECK_THROWS_WITH(others.add_body(body), "tangential_restitution: bodies of this world do not turn");
}

}  // namespace test_friction
