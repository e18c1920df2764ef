// An arena: many fast bullets that ignore each other, and targets that they hit.
#pragma once

#include "tests/benchmarks/thread_time.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace speed {

/// Targets fly about and reflect at the walls; the third hit destroys one. A bullet flies straight until it hits a
/// target or a wall. What is gone is replaced at the end of the frame, elsewhere.
struct Arena {
  static constexpr double bullet_radius = 0.05;
  static constexpr double target_radius = 0.6;
  static constexpr int lives = 3;  ///< hits that a target survives, and one more

  std::uint32_t targets = 500;
  std::uint32_t bullets = 1500;
  double rate = 60;      ///< frames a second
  double duration = 20;  ///< s
  std::uint64_t seed = 1;
  Eigen::Vector3d low{-50, -50, -10}, high{50, 50, 10};  ///< walls

  std::uint32_t bodies() const { return targets + bullets; }
  /// Bodies are numbered, the targets first.
  bool is_target(std::uint32_t body) const { return body < targets; }
  std::uint64_t frames() const { return static_cast<std::uint64_t>(duration * rate); }
  double end_of(std::uint64_t frame) const { return static_cast<double>(frame) / rate; }

  struct Start {
    Eigen::Vector3d position, velocity;
  };
  /// Where a body begins, and how it moves; `life`: how often it has been replaced.
  Start start(std::uint32_t body, std::uint32_t life) const;
};

struct Hit {
  double time;
  std::uint32_t target, bullet;
};

struct ArenaOutcome {
  double setup = 0;  ///< CPU s up to the first frame
  double run = 0;    ///< CPU s of all frames
  std::uint64_t walls = 0;
  std::uint64_t tests = 0;  ///< of a bullet and a target
};

/// In a world, driven by events. `hits` are appended, here and below.
ArenaOutcome run_arena(const Arena& arena, std::vector<Hit>& hits);

/// Frame by frame: each bullet's swept box is asked of Bullet's btDbvt of the swept boxes of targets, the ball-ball
/// quadratic is solved for what it finds, and hits and walls of the frame are processed in order of time.
ArenaOutcome run_arena_by_bullet(const Arena& arena, std::vector<Hit>& hits);

}  // namespace speed
