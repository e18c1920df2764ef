#include "examples/kds-collide/scene.hpp"

#include <algorithm>

namespace kds_collide {
namespace {

/// File names and keys come from outside and may hold anything; an error stays one line.
std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, ' ');
  return text;
}

}  // namespace

int Scene::degree() const {
  for (const SceneBody& body : bodies) {
    for (const MotionPiece& piece : body.motion) {
      if (!piece.coefficients[2].isZero(0)) return 2;
    }
  }
  return 1;
}

SceneError::SceneError(const std::string& file, const std::string& where, const std::string& what)
    : std::runtime_error(one_line(file + ": " + where + ": " + what)) {}

}  // namespace kds_collide
