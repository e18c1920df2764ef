// Scenes that are run as one world and in domains.
#pragma once

#include "collision/world.hpp"
#include "tests/collision/random_scenes.hpp"
#include "tests/support/random_numbers.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace kds::collision::tests {

/// A scene, and how it is run.
template <int Degree>
struct Trial {
  Scene<Degree> scene;
  WorldOptions options;
  std::string what;
};

/// Bodies in a box, of some kinds and sizes, many of which meet at the same times where numbers are coarse.
template <int Degree>
Trial<Degree> trial(std::uint64_t seed) {
  Random random(seed);
  SceneOptions of;
  const std::vector<Shapes> shapes{Shapes::spheres, Shapes::spheres, Shapes::boxes, Shapes::mixture};
  of.shapes = shapes[random.below(shapes.size())];
  of.numbers = random.one_in(3) ? Numbers::coarse : Numbers::fine;
  of.bodies = of.shapes == Shapes::mixture ? 10 + random.below(15) : 20 + random.below(180);
  of.side = std::cbrt(static_cast<double>(of.bodies)) * random.between(1.5, 4);
  if (of.numbers == Numbers::coarse) of.side = std::ceil(of.side);
  of.heterogeneous = random.one_in(2);
  // Where bodies are accelerated towards walls, they gather there, and the scene is one world from then on.
  of.end_time = of.shapes == Shapes::mixture ? 0.5 : random.between(0.5, Degree == 1 ? 8 : 1.5);
  Trial<Degree> result;
  result.scene = SceneMaker(random, of).template scene<Degree>();
  if (random.one_in(3)) {
    for (auto& body : result.scene.bodies) body.sensor = random.one_in(8);
  }
  if (random.one_in(3)) {
    for (auto& body : result.scene.bodies)
      body.category = 1u << random.below(2), body.collides_with = static_cast<std::uint32_t>(1 + random.below(3));
  }
  if (random.one_in(Degree == 1 ? 4 : 10)) {
    for (auto& body : result.scene.bodies) body.restitution = random.between(0.3, 1);
  }
  result.options.response = random.one_in(3) ? Response::none : Response::elastic;
  if (random.one_in(2)) {
    result.options.walls = Walls{Eigen::Vector3d::Constant(-1), Eigen::Vector3d::Constant(of.side + 1)};
  }
  const std::vector<BroadPhaseKind> kinds{BroadPhaseKind::automatic, BroadPhaseKind::grid, BroadPhaseKind::kinetic_sap};
  result.options.broad_phase = kinds[random.below(kinds.size())];
  result.what = "seed " + std::to_string(seed) + ", " + std::to_string(of.bodies) + " " + name(of.shapes);
  return result;
}

/// Balls of one size on the places of a lattice, all of which move with speeds of a lattice too: thousands of contacts
/// at the same times.
inline Trial<1> lattice(int side, double gap) {
  Random random(77);
  Trial<1> result;
  for (int i = 0; i < side * side * side; ++i) {
    const Eigen::Vector3d place = gap * Eigen::Vector3d(i % side, i / side % side, i / side / side);
    // In statements of their own: compilers differ in the order in which they evaluate arguments.
    const int w = random.integer(-1, 1), v = random.integer(-1, 1), u = random.integer(-1, 1);
    result.scene.bodies.push_back(ball<1>(0.5, place, Eigen::Vector3d(u, v, w)));
  }
  result.scene.end_time = 4;
  result.options.response = Response::elastic;
  result.options.walls = Walls{Eigen::Vector3d::Constant(-1), Eigen::Vector3d::Constant(gap * (side - 1) + 1)};
  result.what = "lattice";
  return result;
}

}  // namespace kds::collision::tests
