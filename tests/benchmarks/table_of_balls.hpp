// Balls that lie on a floor and roll into each other, for measurements of scenes in domains.
#pragma once

#include "collision/world.hpp"
#include "tests/support/random_numbers.hpp"

#include <cmath>
#include <cstddef>
#include <vector>

namespace kds::benchmarks {

struct TableOfBalls {
  collision::WorldOptions options;
  std::vector<collision::BodyDescription<2>> bodies;
};

/// Balls of diameter 1 that cover this part of a fixed box, on which their weight presses them, within walls. They lose
/// a tenth of their speed along the normal with each contact.
inline TableOfBalls table_of_balls(std::size_t balls, double packing) {
  TableOfBalls result;
  const auto row = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(balls))));
  const double apart = std::sqrt(0.7853981633974483 / packing), side = apart * static_cast<double>(row);
  result.options.response = collision::Response::elastic;
  result.options.walls = collision::Walls{{0, 0, -3}, {side, side, 3}};
  collision::BodyDescription<2> floor;
  floor.shape = collision::Box{{side, side, 1}};
  floor.motion = {collision::World<2>::Motion{{Eigen::Vector3d(0.5 * side, 0.5 * side, -1)}}};
  floor.fixed = true;
  result.bodies.push_back(floor);
  tests::Random random(2);
  for (std::size_t i = 0; i < balls; ++i) {
    const auto place = [&](std::size_t at) { return (static_cast<double>(at) + 0.5) * apart; };
    collision::BodyDescription<2> ball;
    ball.shape = collision::Sphere{0.5};
    ball.restitution = 0.9;
    const double u = random.between(-1, 1), v = random.between(-1, 1);
    ball.motion = {
        collision::World<2>::Motion{{Eigen::Vector3d(place(i % row), place(i / row), 0.5), {u, v, 0}, {0, 0, -4.905}}}};
    result.bodies.push_back(ball);
  }
  return result;
}

}  // namespace kds::benchmarks
