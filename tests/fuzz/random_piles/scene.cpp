#include "tests/fuzz/random_piles/scene.hpp"

#include <algorithm>

namespace kds::piles {

bool Scene::driven() const {
  return std::any_of(bodies.begin(), bodies.end(), [](const Description& body) {
    if (!body.fixed) return false;
    return std::any_of(body.motion.begin(), body.motion.end(), [](const auto& piece) {
      return !piece.coefficients[1].isZero(0) || !piece.coefficients[2].isZero(0);
    });
  });
}

bool Scene::isolated() const {
  return !walls && gravity.isZero(0) &&
         std::none_of(bodies.begin(), bodies.end(), [](const Description& body) { return body.fixed; });
}

bool Scene::has_meshes() const {
  return std::any_of(bodies.begin(), bodies.end(),
                     [](const Description& body) { return collision::has_mesh(body.shape); });
}

}  // namespace kds::piles
