// The scenes that the benchmark of speed is about: moving balls in a box, made from a seed.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace speed {

/// Proportions of the box, shortest side to longest.
enum class Flatness {
  cube,  ///< 1 : 1 : 1
  slab,  ///< 1 : 1 : 0.02
  line,  ///< 1 : 0.02 : 0.02
};
const char* name(Flatness flatness);

/// How radii and speeds are drawn: between 1 and `spread`, scaled to a mean of 1.
enum class Draw {
  uniform,      ///< [Coming06] section 5 with a spread of 3: 0.5 ... 1.5
  logarithmic,  ///< every power of ten alike
};

/// One unit of length is the mean radius; a ball of mean speed moves by it in 1 s.
struct SceneOptions {
  std::size_t bodies = 1000;
  double packing = 0.01;    ///< volume of the balls over that of the box
  double size_spread = 3;   ///< largest radius over smallest, >= 1
  double speed_spread = 3;  ///< the same of speeds
  Draw draw = Draw::uniform;
  bool maxwell = false;     ///< velocities of a gas in equilibrium instead: three normal deviates of variance 1
  double at_rest = 0;       ///< share of balls that do not move
  Flatness flatness = Flatness::cube;
  std::uint64_t seed = 1;
};

/// Balls that do not overlap, in a box from the origin; all of mass 1.
struct BallScene {
  struct Ball {
    double radius;
    Eigen::Vector3d position;  ///< at time `start`
    Eigen::Vector3d velocity;
    double start = 0;          ///< s
  };
  Eigen::Vector3d side;  ///< of the box
  std::vector<Ball> balls;
  double packing = 0;     ///< reached; below what was asked for where so few balls find no room in so small a box
  double start_time = 0;  ///< s
};

/// Random sequential placement, the largest ball first, in expected linear time for packings up to 0.3. One seed gives
/// one scene. Throws std::invalid_argument for options out of range.
BallScene make_scene(const SceneOptions& options);

}  // namespace speed
