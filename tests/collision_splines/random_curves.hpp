// Random scenes of bodies on cubics, quartics and quintics.
#pragma once

#include "tests/collision/random_scenes.hpp"

#include <cmath>
#include <cstddef>

namespace kds::collision::tests {

/// Gives a path terms above the acceleration, smaller the higher: within some seconds they come to some lengths.
template <int Degree>
void bend(certificates::PointMotion<Degree>& path, Random& random, Numbers numbers) {
  double most = 1;
  for (std::size_t i = 3; i <= Degree; ++i) {
    most *= 0.5;
    for (int d = 0; d < 3; ++d) {
      path.coefficients[i][d] =
          numbers == Numbers::fine ? random.between(-most, most) : most * 0.25 * random.integer(-4, 4);
    }
  }
}

/// A scene as SceneMaker makes it, with capsules in the mixture, most of its bodies on curves. Pieces that went on
/// where the last one ended still do.
template <int Degree>
Scene<Degree> curved_scene(Random& random, const SceneOptions& options) {
  auto scene = SceneMaker(random, options).template scene<Degree>();
  for (auto& description : scene.bodies) {
    if (options.shapes == Shapes::mixture && random.one_in(4)) {
      const bool fine = options.numbers == Numbers::fine;
      description.shape = fine ? Capsule{random.between(0.2, 0.7), random.between(0.2, 1)} : Capsule{0.5, 0.5};
    }
    if (description.fixed) continue;
    for (std::size_t i = 0; i < description.motion.size(); ++i) {
      auto& piece = description.motion[i];
      if (!random.one_in(4)) bend(piece, random, options.numbers);
      if (i > 0 && !random.one_in(3)) piece.coefficients[0] = description.motion[i - 1].position(piece.start);
    }
  }
  return scene;
}

}  // namespace kds::collision::tests
