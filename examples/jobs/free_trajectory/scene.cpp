#include "examples/jobs/free_trajectory/scene.hpp"

#include "examples/jobs/free_trajectory/proof.hpp"

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>
#include <random>

namespace free_trajectory {
namespace {

using Eigen::Vector3d;

/// The engine's sequence is fixed by the standard, that of std::uniform_real_distribution is not.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }

 private:
  std::mt19937_64 engine_;
};

/// A bar with three sides: its edges are at `radius` from its axis. Open at both ends.
void add_bar(Obstacle& to, const Vector3d& from, const Vector3d& end, double radius) {
  const Vector3d along = (end - from).normalized();
  const Vector3d across = along.cross(std::abs(along[2]) < 0.9 ? Vector3d::UnitZ() : Vector3d::UnitX()).normalized();
  const Vector3d third = along.cross(across);
  const auto first = static_cast<std::uint32_t>(to.vertices.size());
  for (const Vector3d& middle : {from, end}) {
    to.vertices.push_back(middle + radius * across);
    to.vertices.push_back(middle + radius * (-0.5 * across + std::sqrt(0.75) * third));
    to.vertices.push_back(middle + radius * (-0.5 * across - std::sqrt(0.75) * third));
  }
  for (std::uint32_t i = 0; i < 3; ++i) {
    const std::uint32_t a = first + i, b = first + (i + 1) % 3;
    to.triangles.push_back({a, b, b + 3});
    to.triangles.push_back({a, b + 3, a + 3});
  }
}

Obstacle mast() {
  constexpr int floors = 12;
  Obstacle mast{"the mast", {}, {}};
  const auto corner = [](int floor, int i) {
    const double half = 1.5 - 0.1 * floor;  // m
    const Vector3d at(i == 0 || i == 3 ? -half : half, i < 2 ? -half : half, 3.0 * floor);
    return at;
  };
  for (int floor = 0; floor < floors; ++floor) {
    for (int i = 0; i < 4; ++i) {
      const int next = (i + 1) % 4;
      add_bar(mast, corner(floor, i), corner(floor + 1, i), 0.06);         // a leg
      add_bar(mast, corner(floor, i), corner(floor + 1, next), 0.03);      // a diagonal
      add_bar(mast, corner(floor + 1, i), corner(floor + 1, next), 0.03);  // a floor's edge
    }
  }
  return mast;
}

Obstacle ground(Random& random) {
  constexpr std::uint32_t points = 25;
  constexpr double spacing = 5;  // m
  Obstacle ground{"the ground", {}, {}};
  for (std::uint32_t y = 0; y < points; ++y) {
    for (std::uint32_t x = 0; x < points; ++x) {
      const double half = spacing * (points - 1) / 2;
      const Vector3d at(spacing * x - half, spacing * y - half, 0);
      const double rise = random.uniform(-1, 1);
      ground.vertices.push_back(at + Vector3d(0, 0, at.norm() < 10 ? 0 : rise));
    }
  }
  for (std::uint32_t y = 0; y + 1 < points; ++y) {
    for (std::uint32_t x = 0; x + 1 < points; ++x) {
      const std::uint32_t i = y * points + x;
      ground.triangles.push_back({i, i + 1, i + points + 1});
      ground.triangles.push_back({i, i + points + 1, i + points});
    }
  }
  return ground;
}

/// Way points a second apart, velocities as in a spline of Catmull and Rom.
Drone around_mast(Random& random, double height, int seconds) {
  std::vector<Vector3d> places;
  double angle = random.uniform(0, 2 * std::numbers::pi);
  for (int i = 0; i <= seconds + 2; ++i) {
    const double distance = random.uniform(5, 25);
    const double rise = random.uniform(-1, 1);
    places.emplace_back(distance * std::cos(angle), distance * std::sin(angle), height + rise);
    angle += random.uniform(0.6, 1.2);
  }
  Drone drone{0.15, {}};
  for (int i = 0; i <= seconds; ++i) {
    const auto k = static_cast<std::size_t>(i) + 1;
    drone.way.push_back({static_cast<double>(i), places[k], (places[k + 1] - places[k - 1]) / 2});
  }
  return drone;
}

}  // namespace

Scene swarm_at_mast(std::size_t drones, std::uint64_t seed) {
  constexpr int seconds = 20;
  Random random(seed);
  Scene scene;
  scene.obstacles.push_back(ground(random));
  scene.obstacles.push_back(mast());
  for (std::size_t i = 0; i < drones; ++i) {
    scene.drones.push_back(around_mast(random, 4 + 3.0 * static_cast<double>(i), seconds));
  }
  scene.end = seconds;
  return scene;
}

void add_cable(Scene& scene, std::size_t drone, double time) {
  constexpr double radius = 0.004, depth = 0.002, half_length = 4;  // m
  const Drone& flown = scene.drones.at(drone);
  const Vector3d way = velocity(flown, time).normalized();
  const Vector3d beside = way.cross(Vector3d::UnitZ()).normalized();
  const Vector3d along = way.cross(beside);
  const Vector3d middle = place(flown, time) + (flown.radius - depth) * beside;
  Obstacle cable{"the cable", {}, {}};
  for (int i = -4; i < 4; ++i) {
    add_bar(cable, middle + half_length / 4 * i * along, middle + half_length / 4 * (i + 1) * along, radius);
  }
  scene.obstacles.push_back(std::move(cable));
}

}  // namespace free_trajectory
