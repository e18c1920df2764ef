#include "io/scene.hpp"

#include "io/one_line.hpp"

namespace kds::io {

int Scene::degree() const {
  for (const SceneBody& body : bodies) {
    for (const MotionPiece& piece : body.motion) {
      if (!piece.path.coefficients[2].isZero(0)) return 2;
    }
  }
  return 1;
}

SceneError::SceneError(const std::string& file, const std::string& where, const std::string& what)
    : std::runtime_error(one_line(file + ": " + where + ": " + what)) {}

}  // namespace kds::io
