// Gases in periodic boxes, and records of what happens in them.
#pragma once

#include "collision/periodic/periodic_world.hpp"

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace periodic_scenes {

using namespace kds::collision;

/// Balls that do not overlap, of masses by their volumes, in random places, with velocities of temperature 1; radii
/// from 0.3 to 0.5. Precondition: there is room for them.
template <int Degree>
std::vector<BodyDescription<Degree>> random_balls(std::size_t count, const PeriodicOptions& options, std::uint64_t seed,
                                                  double restitution = 1) {
  ThermalVelocities random(seed);
  std::vector<BodyDescription<Degree>> balls;
  while (balls.size() < count) {
    BodyDescription<Degree> ball;
    const double radius = 0.3 + 0.2 * random.uniform();
    Eigen::Vector3d place;
    for (int d = 0; d < 3; ++d) {
      const bool walls = options.boundaries[static_cast<std::size_t>(d)] == Boundary::walls;
      const double low = options.min[d] + (walls ? radius : 0), high = options.max[d] - (walls ? radius : 0);
      place[d] = low + (high - low) * random.uniform();
    }
    bool free = true;
    for (const auto& other : balls) {
      Eigen::Vector3d apart = place - other.motion[0].coefficients[0];
      for (int d = 0; d < 3; ++d) {
        if (options.boundaries[static_cast<std::size_t>(d)] != Boundary::periodic) continue;
        const double period = options.max[d] - options.min[d];
        apart[d] -= period * std::round(apart[d] / period);
      }
      free = free && apart.norm() > radius + std::get<Sphere>(other.shape).radius;
    }
    if (!free) continue;
    ball.shape = Sphere{radius};
    ball.mass = 8 * radius * radius * radius;
    ball.restitution = restitution;
    Eigen::Vector3d velocity = random.inside(1 / ball.mass);
    velocity[0] += options.shear_rate * place[1];
    ball.motion = {{{place, velocity}, options.world.start_time}};
    balls.push_back(ball);
  }
  return balls;
}

/// All that is told, in numbers, bit for bit.
template <int Degree>
struct Log final : PeriodicListener<Degree> {
  std::vector<double> numbers;
  std::size_t contacts = 0, overlaps = 0, passed = 0, walls = 0, wraps = 0;

  void contact(PeriodicWorld<Degree>&, const PeriodicEvent& event) override { ++contacts, add(1, event); }
  void overlap(PeriodicWorld<Degree>&, const PeriodicEvent& event) override { ++overlaps, add(2, event); }
  void passes(PeriodicWorld<Degree>&, const PeriodicEvent& event) override { ++passed, add(3, event); }
  void wall(PeriodicWorld<Degree>&, const WallEvent& event) override {
    ++walls;
    numbers.insert(numbers.end(), {4, double(event.body), double(event.wall), event.contact.time});
  }
  void wrapped(PeriodicWorld<Degree>& world, BodyId id, const Offset& by) override {
    ++wraps;
    numbers.insert(numbers.end(), {5, double(id), double(by[0]), double(by[1]), double(by[2]), world.now()});
  }
  void add(double kind, const PeriodicEvent& event) {
    numbers.insert(numbers.end(), {kind, double(event.a), double(event.b), event.contact.time, event.impulse});
    for (std::size_t d = 0; d < 3; ++d) {
      numbers.push_back(double(event.offset[d]));
      numbers.push_back(event.contact.point[Eigen::Index(d)]);
      numbers.push_back(event.contact.normal[Eigen::Index(d)]);
    }
  }
};

}  // namespace periodic_scenes
