// Drones on cubic trajectories around a lattice mast: data for the proof.
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace free_trajectory {

/// A surface of triangles, in metres.
struct Obstacle {
  std::string name;
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

struct WayPoint {
  double time;               ///< s
  Eigen::Vector3d place;     ///< m
  Eigen::Vector3d velocity;  ///< m/s
};

/// A ball around a drone flies a cubic from each way point to the next.
struct Drone {
  double radius;  ///< m
  std::vector<WayPoint> way;
};

struct Scene {
  std::vector<Obstacle> obstacles;
  std::vector<Drone> drones;
  double end = 0;  ///< s; when the last way point of each is reached
};

/// A mast of lattice, 36 m high, on hilly ground, and drones that fly around it for 20 s, at up to some 30 m/s, each in
/// a layer of heights of its own. The same number and seed give the same scene on every system.
Scene swarm_at_mast(std::size_t drones, std::uint64_t seed);

/// Adds a cable of 4 mm radius beside the way of a drone, at right angles to it, so near that its middle line is 2 mm
/// deep in the drone's ball at a time.
void add_cable(Scene& scene, std::size_t drone, double time);

}  // namespace free_trajectory
