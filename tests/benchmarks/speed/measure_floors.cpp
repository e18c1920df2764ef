// Balls that fall on one large body and bounce, roll or slide there: what their number adds to the cost of each.
#include "collision/shapes/mesh.hpp"
#include "collision/world.hpp"
#include "tests/benchmarks/csv_file.hpp"
#include "tests/benchmarks/speed/report.hpp"
#include "tests/benchmarks/thread_time.hpp"
#include "tests/support/random_numbers.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace speed {
namespace {

using Eigen::Vector3d;
using kds::benchmarks::open_csv;
using kds::benchmarks::tell;
using kds::collision::BodyDescription;
using kds::collision::World;

struct Floor {
  std::string name;
  kds::collision::Shape shape;
  Vector3d centre;
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
};

/// A mesh of squares with the side 2, of two triangles each, whose vertices lie up to a height above or below 0.
kds::collision::MeshShape terrain(std::size_t squares, double height) {
  kds::tests::Random random(5);
  std::vector<Vector3d> vertices;
  std::vector<kds::collision::Mesh::Triangle> triangles;
  const auto row = static_cast<std::uint32_t>(squares + 1);
  for (std::uint32_t y = 0; y < row; ++y) {
    for (std::uint32_t x = 0; x < row; ++x) {
      vertices.emplace_back(2.0 * x, 2.0 * y, random.between(-height, height));
      if (x == 0 || y == 0) continue;
      const std::uint32_t corner = y * row + x;
      triangles.push_back({corner - row - 1, corner - row, corner});
      triangles.push_back({corner - row - 1, corner, corner - 1});
    }
  }
  return {std::make_shared<const kds::collision::Mesh>(vertices, triangles)};
}

/// Large enough for side x side balls at distances of 2, from the origin on.
std::vector<Floor> floors(double side) {
  using kds::collision::Box;
  const auto squares = static_cast<std::size_t>(1.5 * side);
  const Vector3d corner(-0.5 * side, -0.5 * side, -2);
  return {{"box", Box{{4 * side, 4 * side, 1}}, {side, side, -2}},
          {"slope", Box{{4 * side, 4 * side, 1}}, {side, side, -6}, Eigen::Quaterniond(1, 0.05, 0.1, 0).normalized()},
          {"dome", kds::collision::Sphere{10 * side}, {side, side, -10 * side - 2}},
          {"sheet", terrain(squares, 0), corner},
          {"terrain", terrain(squares, 0.5), corner}};
}

World<2>::Motion motion(const Vector3d& place, const Vector3d& velocity, const Vector3d& gravity) {
  return {{place, velocity, 0.5 * gravity}};
}

/// A ball falls from a height of up to 10.
World<2>::Motion fall(kds::tests::Random& random, double x, double y) {
  return motion({x, y, 0.5 + random.between(0, 10)}, {random.between(-3, 3), random.between(-3, 3), 0}, {0, 0, -9.81});
}

struct Measured {
  double seconds = kds::never;
  kds::collision::WorldCounters counters;
};

/// Three seconds of balls that fall on a floor without rebound, roll or slide there, and strike each other; set-up
/// included.
Measured measure(const Floor& floor, std::size_t side) {
  World<2> world({.response = kds::collision::Response::elastic});
  BodyDescription<2> below{.shape = floor.shape, .orientation = floor.orientation, .fixed = true};
  below.motion = {motion(floor.centre, Vector3d::Zero(), Vector3d::Zero())};
  below.restitution = 0;
  std::vector<BodyDescription<2>> bodies{below};
  kds::tests::Random random(3);
  for (std::size_t i = 0; i < side * side; ++i) {
    BodyDescription<2> ball{.shape = kds::collision::Sphere{0.5}};
    ball.motion = {fall(random, 2.0 * static_cast<double>(i % side), 2.0 * static_cast<double>(i / side))};
    ball.restitution = 0.75;
    bodies.push_back(ball);
  }
  const double begin = kds::benchmarks::thread_seconds();
  for (const auto& body : bodies) world.add_body(body);
  world.advance_to(3);
  return {kds::benchmarks::thread_seconds() - begin, world.counters()};
}

}  // namespace

std::vector<Target> measure_floors(const Settings& settings) {
  auto file = open_csv(settings.folder, "speed-floors.csv");
  tell(file, "floor,balls,us_a_ball,us_a_contact,contacts,motion_updates\n");
  std::vector<std::size_t> sides{20, 40};
  if (!settings.quick) sides.insert(sides.end(), {80, 160});
  std::vector<Target> targets;
  for (std::size_t kind = 0; kind < floors(1).size(); ++kind) {
    double first = 0;
    for (const std::size_t side : sides) {
      const Floor floor = floors(static_cast<double>(side))[kind];
      Measured best;
      for (int round = 0; round < (settings.quick ? 1 : 3); ++round) {
        const Measured measured = measure(floor, side);
        if (measured.seconds < best.seconds) best = measured;
        if (measured.seconds > 5) break;  // long enough for one round
      }
      const auto balls = static_cast<double>(side * side);
      const double a_ball = 1e6 * best.seconds / balls;
      tell(file, "%s,%zu,%.2f,%.2f,%llu,%llu\n", floor.name.c_str(), side * side, a_ball,
           1e6 * best.seconds / static_cast<double>(best.counters.contacts),
           static_cast<unsigned long long>(best.counters.contacts),
           static_cast<unsigned long long>(best.counters.motion_updates));
      if (first == 0) first = a_ball;
      const bool last = side == sides.back() || best.seconds > 15;  // more of them would take minutes
      if (!last) continue;
      targets.push_back({"auto: CPU a ball on a " + floor.name + " at " + std::to_string(side * side) +
                             " balls over that at " + std::to_string(sides.front() * sides.front()),
                         a_ball / first, '<', 3, "x"});
      break;
    }
  }
  return targets;
}

}  // namespace speed
