// Elastic gases of balls, for measurements of scenes in domains.
#pragma once

#include "collision/world.hpp"
#include "tests/support/random_numbers.hpp"

#include <cmath>
#include <cstddef>
#include <vector>

namespace kds::benchmarks {

struct ElasticGas {
  collision::WorldOptions options;
  std::vector<collision::BodyDescription<1>> bodies;
  double spacing = 0;  ///< mean distance of neighbours
};

/// Elastic balls of diameter 1 in a cube, on the places of a lattice, with speeds of a normal distribution.
inline ElasticGas elastic_gas(std::size_t bodies, double packing) {
  ElasticGas result;
  const double side = std::cbrt(static_cast<double>(bodies) * 0.5235987755982988 / packing);
  const auto row = static_cast<std::size_t>(std::ceil(std::cbrt(static_cast<double>(bodies))));
  const double apart = side / static_cast<double>(row);
  result.spacing = side / std::cbrt(static_cast<double>(bodies));
  result.options.response = collision::Response::elastic;
  result.options.walls = collision::Walls{Eigen::Vector3d::Zero(), Eigen::Vector3d::Constant(side)};
  tests::Random random(2);
  const auto place = [&](std::size_t i) { return (static_cast<double>(i) + 0.5) * apart; };
  for (std::size_t i = 0; i < bodies; ++i) {
    collision::BodyDescription<1> ball;
    ball.shape = collision::Sphere{0.5};
    collision::World<1>::Motion motion{};
    motion.coefficients[0] = {place(i % row), place(i / row % row), place(i / row / row)};
    for (int d = 0; d < 3; ++d) {  // the sum of uniform ones is near enough to normal
      motion.coefficients[1][d] = 0;
      for (int k = 0; k < 4; ++k) motion.coefficients[1][d] += random.between(-0.5, 0.5);
    }
    ball.motion = {motion};
    result.bodies.push_back(ball);
  }
  return result;
}

}  // namespace kds::benchmarks
