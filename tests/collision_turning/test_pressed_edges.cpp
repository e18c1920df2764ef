// Edges that slide on each other while their bodies turn are pressed together, or lifted off, by how they turn.
#include "collision/shapes/convex_hull.hpp"
#include "collision/shapes/mesh.hpp"
#include "collision/world.hpp"
#include "collision/world/turning/pressing.hpp"
#include "tests/support/random_numbers.hpp"
#include "tests/support/random_vectors.hpp"

#include <catch2/catch.hpp>

#include <Eigen/Geometry>

#include <cmath>
#include <cstddef>
#include <memory>
#include <variant>
#include <vector>

namespace test_pressed_edges {
namespace {

using namespace kds;
using namespace kds::collision;
using certificates::RigidMotion;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using kds::tests::Random;
using kds::tests::random_vector;

using Turning = BasicWorld<RigidMotion<1>>;

/// A line that turns and moves.
struct Line {
  Vector3d point, along, velocity, turns;
  Vector3d point_at(double t) const { return point + t * velocity; }
  Vector3d along_at(double t) const { return Eigen::AngleAxisd(t * turns.norm(), turns.normalized()) * along; }
};

/// How far apart two lines are.
double distance(const Line& a, const Line& b, double t) {
  const Vector3d n = a.along_at(t).cross(b.along_at(t)).normalized();
  return std::abs(n.dot(b.point_at(t) - a.point_at(t)));
}

struct Counter final : Turning::Listener {
  std::size_t contacts = 0;
  void contact(Turning&, const PairEvent&) override { ++contacts; }
};

/// A capsule with a side of 0.6, free of forces.
void add(Turning& world, const Vector3d& place, const Vector3d& velocity, const Quaterniond& orientation,
         const Vector3d& turns, double restitution) {
  Turning::Description body{.shape = Capsule{0.2, 0.3}};
  RigidMotion<1> motion{{{place, velocity}}};
  motion.orientation = orientation.normalized();
  motion.angular_velocity = turns;
  body.motion = {motion};
  body.restitution = restitution;
  world.add_body(body);
}

}  // namespace

TEST_CASE("the gap of two edges that cross closes with the acceleration that is calculated", "[turning]") {
  Random random(5);
  for (int trial = 0; trial < 200; ++trial) {
    CAPTURE(trial);
    Line a{random_vector(random), random_vector(random), random_vector(random), 3 * random_vector(random)};
    Line b{random_vector(random), random_vector(random), random_vector(random), 3 * random_vector(random)};
    // The points are those where the two are nearest, so that b - a is along the normal.
    const Vector3d normal = a.along.cross(b.along).normalized();
    if (a.along.normalized().cross(b.along.normalized()).norm() < 0.2) continue;
    const double apart = std::abs(normal.dot(b.point - a.point));
    const Vector3d n = normal.dot(b.point - a.point) < 0 ? Vector3d(-normal) : normal;
    b.point = a.point + apart * n;
    const auto edges = CrossingEdges::of({a.along, apart / 4}, {b.along, 3 * apart / 4}, a.turns, b.turns, n);
    REQUIRE(edges.has_value());
    const double calculated =
        2 * edges->normal_rate.dot(b.velocity - a.velocity) - apart * edges->normal_rate.squaredNorm();
    const double h = 1e-4;
    const double measured = (distance(a, b, h) - 2 * distance(a, b, 0) + distance(a, b, -h)) / (h * h);
    CHECK(calculated == Approx(measured).epsilon(1e-3).margin(1e-3));
  }
}

TEST_CASE("the gap of a side and an end opens with the acceleration that is calculated", "[turning]") {
  Random random(6);
  for (int trial = 0; trial < 200; ++trial) {
    CAPTURE(trial);
    const Line side{random_vector(random), random_vector(random), random_vector(random), 3 * random_vector(random)};
    const Vector3d n = side.along.cross(random_vector(random)).normalized(), speed = random_vector(random);
    const double radii = random.between(0.25, 1);
    const auto distance = [&](double t) {
      const Vector3d way = side.point + radii * n + t * speed - side.point_at(t), along = side.along_at(t).normalized();
      return (way - way.dot(along) * along).norm();
    };
    const double h = 1e-4;
    const double measured = (distance(h) - 2 * distance(0) + distance(-h)) / (h * h);
    const double calculated = opens_at_side(side.along, side.turns, speed - side.velocity, n, radii);
    CHECK(calculated == Approx(measured).epsilon(1e-3).margin(1e-3));
  }
}

TEST_CASE("the gap of two ends opens with the acceleration that is calculated", "[turning]") {
  Random random(7);
  for (int trial = 0; trial < 200; ++trial) {
    CAPTURE(trial);
    const Vector3d n = random_vector(random).normalized(), speed = random_vector(random);
    const double radii = random.between(0.25, 1), h = 1e-4;
    const auto distance = [&](double t) { return (radii * n + t * speed).norm(); };
    const double measured = (distance(h) - 2 * distance(0) + distance(-h)) / (h * h);
    CHECK(opens_at_end(speed, n, radii) == Approx(measured).epsilon(1e-3).margin(1e-3));
  }
}

TEST_CASE("edges of boxes, hulls, meshes and capsules are where their features say", "[turning]") {
  const Shape box = Box{Vector3d(1, 2, 3)};
  for (std::uint32_t d = 0; d < 3; ++d) {
    const auto edge = contact_edge(box, Feature::edge(5u & ~(1u << d), 5u | 1u << d));
    REQUIRE(edge.has_value());
    CHECK(edge->along == Vector3d::Unit(d));
  }
  CHECK(contact_edge(Capsule{0.2, 0.3}, Feature::edge(0, 1))->radius == 0.2);
  CHECK_FALSE(contact_edge(box, Feature::face(1)).has_value());
  CHECK_FALSE(contact_edge(Sphere{1}, {}).has_value());
  CHECK_FALSE(CrossingEdges::of({Vector3d::UnitX()}, {Vector3d(1, 1e-4, 0)}, Vector3d::Zero(), Vector3d::Zero(),
                                Vector3d::UnitZ())
                  .has_value());
}

TEST_CASE("capsules whose sides slide crosswise while they spin part in flights that can be seen", "[turning]") {
  for (const double restitution : {0.9, 0.6, 0.3, 0.0}) {
    CAPTURE(restitution);
    Counter counter;
    Turning world({.response = Response::elastic}, &counter);
    add(world, {-0.603, -0.781, 0.484}, {0.0036, -0.0298, 1.33}, {-0.589, 0.377, 0.4497, -0.5559},
        {-1.49, 0.555, -4.29}, restitution);
    add(world, {-0.481, -0.502, 0.798}, {-0.326, 0.248, -0.347}, {0.6168, 0.5874, 0.4484, 0.2712},
        {0.853, -0.684, 3.81}, restitution);
    while (world.now() < 1 && counter.contacts < 1000) world.step(1);
    CHECK(world.now() == 1);
    CHECK(counter.contacts > 0);
  }
}

TEST_CASE("the end of a capsule that spins is pressed to a plane by what its centre does", "[turning]") {
  // The axis, nearly along the wall, turns towards it at an end that does not move along the normal otherwise.
  constexpr double half_length = 0.3, radius = 0.1, rate = 10;
  const Vector3d end = half_length * Vector3d(-std::cos(0.06), std::sin(0.06), 0), turns(-rate, rate / 10, 0);
  for (const Shape& wall : {Shape(HalfSpace{-Vector3d::UnitY(), 0}), Shape(Box{Vector3d(5, 1, 5)})}) {
    const bool box = std::holds_alternative<Box>(wall);
    CAPTURE(box);
    Counter counter;
    Turning world({.response = Response::elastic}, &counter);
    world.add_body({.shape = wall, .motion = {RigidMotion<1>{{{Vector3d(0, box ? 1 : 0, 0)}}}}, .fixed = true});
    RigidMotion<1> motion{{{Vector3d(0, -radius - end[1] - 1e-6, 0), Vector3d(0, 0.001 - turns.cross(end)[1], 0)}}};
    motion.orientation = Quaterniond::FromTwoVectors(Vector3d::UnitZ(), end);
    motion.angular_velocity = turns;
    world.add_body({.shape = Capsule{radius, half_length}, .motion = {motion}, .inertia = 0.02, .restitution = 0});
    while (world.now() < 0.05 && counter.contacts < 1000) world.step(0.05);
    CHECK(counter.contacts == 50);  // flights of a millisecond
  }
}

TEST_CASE("the end of a capsule that spins is pressed to a corner, or to what is round, by what its centre does",
          "[turning]") {
  // As above, but the end does not move along the wall, of which there is the point at the origin alone.
  constexpr double half_length = 0.3, radius = 0.1, rate = 10;
  const Vector3d end = half_length * Vector3d(-std::cos(0.06), std::sin(0.06), 0), turns(-rate, rate / 10, 0);
  const Vector3d tip(0, 0, 0);
  const auto pyramid = [&] {
    return std::vector<Vector3d>{tip, {-0.5, 1, -0.5}, {0.5, 1, -0.5}, {0.5, 1, 0.5}, {-0.5, 1, 0.5}};
  };
  const Quaterniond upright = Quaterniond::FromTwoVectors(Vector3d::UnitZ(), Vector3d::UnitY());
  const Quaterniond on_corner = Quaterniond::FromTwoVectors(Vector3d(1, 1, 1), -Vector3d::UnitY());
  struct Point {
    Shape shape;
    double below;  ///< how far from its centre the point is
    Quaterniond orientation;
  };
  const Mesh mesh(pyramid(), {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}, {1, 3, 2}, {1, 4, 3}});
  for (const Point& point : {Point{Box{Vector3d::Constant(0.5)}, std::sqrt(0.75), on_corner},
                             Point{convex_hull(pyramid()), 0, Quaterniond::Identity()},
                             Point{MeshShape{std::make_shared<const Mesh>(mesh)}, 0, Quaterniond::Identity()},
                             Point{Capsule{0.5, 1}, 1.5, upright}, Point{Sphere{0.5}, 0.5, Quaterniond::Identity()}}) {
    CAPTURE(point.shape.index());
    Counter counter;
    Turning world({.response = Response::elastic}, &counter);
    RigidMotion<1> still{{{Vector3d(0, point.below, 0)}}};
    still.orientation = point.orientation;
    world.add_body({.shape = point.shape, .motion = {still}, .fixed = true});
    Vector3d velocity = -turns.cross(end);
    velocity[1] += 0.001;
    RigidMotion<1> motion{{{Vector3d(0, -radius - 1e-6, 0) - end, velocity}}};
    motion.orientation = Quaterniond::FromTwoVectors(Vector3d::UnitZ(), end);
    motion.angular_velocity = turns;
    world.add_body({.shape = Capsule{radius, half_length}, .motion = {motion}, .inertia = 0.02, .restitution = 0});
    while (world.now() < 0.05 && counter.contacts < 1000) world.step(0.05);
    CHECK(counter.contacts >= 10);
    CHECK(counter.contacts <= 51);  // flights of a millisecond, or longer ones
  }
}

TEST_CASE("what turning adds to a rebound is taken from how bodies turn", "[turning]") {
  // Two capsules that slide on each other, nearly parallel, while they turn against each other: so they are pressed
  // together a hundred times as much as by a weight.
  Counter counter;
  Turning world({.response = Response::elastic}, &counter);
  const auto add_capsule = [&](const Vector3d& place, const Vector3d& velocity, const Quaterniond& orientation,
                               const Vector3d& turns) {
    RigidMotion<1> motion{{{place, velocity}}};
    motion.orientation = orientation;
    motion.angular_velocity = turns;
    return world.add_body({.shape = Capsule{0.15, 0.35}, .motion = {motion}, .restitution = 0});
  };
  const BodyId a = add_capsule({0.050447400901378898, 0.68956650684836496, 3.4196154041741109},
                               {-0.059458107073023243, 0.52744626654414239, -0.20642217468874588},
                               {-0.20929540741794461, -0.19312135428451405, 0.41859319439390036, -0.86236843202901514},
                               {1.5832052442217122, 1.1675710133649821, -1.2473812756546958});
  const BodyId b = add_capsule({-0.067881880679963591, 0.48696160310015363, 3.8570552505341431},
                               {-0.35478105488953593, -0.2171946021331988, -0.49610303871727252},
                               {0.35586938616321651, -0.57252727987989915, -0.67099772302988114, -0.30875807598712934},
                               {-1.2800265322191779, 0.15617501158555691, -4.7085136590421941});
  const auto energy = [&] {
    double sum = 0;
    for (const BodyId id : {a, b}) {
      const auto turning = world.free_turning(id);
      sum += world.motion(id).path.velocity(world.now()).squaredNorm() / 2 +
             turning.angular_momentum.dot(turning.angular_velocity) / 2;
    }
    return sum;
  };
  const double before = energy();
  while (world.now() < 0.004 && counter.contacts < 100) {
    world.step(0.004);
    CHECK(energy() <= before * (1 + 1e-9));
  }
  CHECK(counter.contacts > 0);
  CHECK(counter.contacts < 100);
}

}  // namespace test_pressed_edges
