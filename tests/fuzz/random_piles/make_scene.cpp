#include "tests/fuzz/random_piles/make_scene.hpp"

#include "tests/fuzz/random_piles/maker.hpp"

#include <array>
#include <variant>
#include <vector>

namespace kds::piles {
namespace {

using Eigen::Vector3d;

void scale(collision::Shape& shape, double unit) {
  if (auto* ball = std::get_if<collision::Sphere>(&shape)) ball->radius *= unit;
  if (auto* box = std::get_if<collision::Box>(&shape)) box->half_extents *= unit;
  if (auto* mesh = std::get_if<collision::MeshShape>(&shape)) mesh->scale *= unit;
  if (auto* capsule = std::get_if<collision::Capsule>(&shape)) {
    capsule->radius *= unit;
    capsule->half_length *= unit;
  }
}

/// Other units of length. Accelerations are scaled too, unless gravity is to be what it is.
void scale(Scene& scene, double unit, bool gravity) {
  if (scene.walls) {
    scene.walls->min *= unit;
    scene.walls->max *= unit;
  }
  if (scene.region) {
    scene.region->min *= unit;
    scene.region->max *= unit;
  }
  if (gravity) scene.gravity *= unit;
  for (Description& body : scene.bodies) {
    scale(body.shape, unit);
    for (auto& piece : body.motion) {
      piece.coefficients[0] *= unit;
      piece.coefficients[1] *= unit;
      if (gravity) piece.coefficients[2] *= unit;
    }
  }
}

}  // namespace

Scene make_scene(std::uint64_t seed) {
  static const std::vector<NamedKind> kinds = [] {
    std::vector<NamedKind> all;
    for (const auto& some : {kinds_in_boxes(), kinds_on_slopes(), kinds_in_rows()}) {
      all.insert(all.end(), some.begin(), some.end());
    }
    return all;
  }();
  constexpr std::array restitutions{0.0, 0.1, 0.3, 0.5, 0.6, 0.8, 0.9, 0.99, 1.0};
  Maker make(seed);
  const NamedKind& kind = kinds[make.random.below(kinds.size())];
  make.restitution = restitutions[make.random.below(restitutions.size())];
  make.scene.kind = kind.name;
  make.scene.gravity = Vector3d(0, -9.81, 0);
  if (make.random.one_in(6)) make.greatest_mass = 1e6;
  if (make.random.one_in(6)) make.speed = 0;
  kind.make(make);
  if (make.random.one_in(6)) scale(make.scene, make.random.one_in(2) ? 1e-3 : 1e3, !make.random.one_in(3));
  return make.scene;
}

}  // namespace kds::piles
