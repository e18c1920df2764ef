// Whether trajectories are free, by exact contact times; and by sampling, to compare with.
#pragma once

#include "examples/jobs/free_trajectory/scene.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace free_trajectory {

/// Place (m) and velocity (m/s) of a drone at a time, rounded.
Eigen::Vector3d place(const Drone& drone, double t);
Eigen::Vector3d velocity(const Drone& drone, double t);

/// Two things meet: "drone 3", "the mast"; at a time (s) and a point (m).
struct Meeting {
  double time;
  std::string first, second;
  Eigen::Vector3d point;
};

/// The first contact of a drone with anything, if all drones are larger by a margin (m) than they are; none if the
/// trajectories are free. Times are those of a world (docs/splines.md): none is missed, however short or shallow.
/// Throws std::invalid_argument for a drone whose radius with the margin is not positive.
std::optional<Meeting> first_meeting(const Scene& scene, double margin = 0);

/// The trajectories are free with the first margin, and not with the second; where they meet with that one is where the
/// clearance is least. Two drones have twice the margin between them.
struct Clearance {
  double free;      ///< m
  double not_free;  ///< m
  Meeting nearest;
};

/// Bisects on the margin until both differ by `resolution` (m) at most: about log2(most / resolution) runs. None if the
/// scene is free even with `most`. Precondition: it is free with no margin (else std::invalid_argument, which says what
/// meets).
std::optional<Clearance> least_clearance(const Scene& scene, double most, double resolution);

/// What a check at `rate` Hz finds, the first sample after `phase` of a period: the first sample in which a drone is
/// nearer to something than its radius.
std::optional<Meeting> first_sample_in_contact(const Scene& scene, double rate, double phase = 0);

/// How far a drone's ball is from the nearest obstacle at each of some times (m, rounded; negative in contact).
std::vector<double> gaps(const Scene& scene, std::size_t drone, std::span<const double> times);

}  // namespace free_trajectory
