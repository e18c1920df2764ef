#include "collision/world.hpp"
#include "tests/benchmarks/piles/pile.hpp"
#include "tests/benchmarks/thread_time.hpp"

#include <algorithm>

namespace piles {

using namespace kds::collision;
using Eigen::Vector3d;

namespace {

constexpr double sky = 1000;             ///< the top of the walls, which no ball reaches
constexpr double look_at_clock = 0.2;    ///< s of the wall clock between looks at how much time is used
constexpr double to_coefficient = -0.5;  ///< of an acceleration downward

}  // namespace

Outcome run_world(const Pile& pile, double most_seconds) {
  using kds::benchmarks::thread_seconds;
  Gauge gauge(pile);
  double seconds = 0;
  double begin = thread_seconds();
  const Vector3d top(pile.space[0], sky, pile.space[2]);
  World<2> world({.response = Response::elastic, .walls = Walls{Vector3d::Zero(), top, restitution}});
  for (const Ball& ball : pile.balls) {
    world.add_body({.shape = Sphere{ball.radius},
                    .motion = {{{ball.place, ball.velocity, Vector3d(0, to_coefficient * gravity, 0)}, 0}},
                    .mass = ball.mass(),
                    .restitution = restitution});
  }
  // They reach through the walls, which stop only what moves.
  for (const FixedBox& box : pile.boxes) {
    world.add_body({.shape = Box{box.half_extents},
                    .orientation = box.turn,
                    .motion = {{{box.place}, 0}},
                    .fixed = true,
                    .restitution = restitution});
  }
  std::vector<Vector3d> places(pile.balls.size()), velocities(pile.balls.size());
  for (int i = 1; seconds < most_seconds; ++i) {
    const double t = std::min(i * sample, length_of_run);
    while (!world.advance_for(look_at_clock, t) && seconds + thread_seconds() - begin < most_seconds) {
    }
    seconds += thread_seconds() - begin;
    for (std::size_t k = 0; k < places.size(); ++k) {
      const auto& motion = world.motion(static_cast<BodyId>(k));
      places[k] = motion.position(world.now());
      velocities[k] = motion.velocity(world.now());
    }
    gauge.look(world.now(), seconds, places, velocities);
    begin = thread_seconds();
    if (t >= length_of_run) break;
  }
  return gauge.outcome();
}

}  // namespace piles
