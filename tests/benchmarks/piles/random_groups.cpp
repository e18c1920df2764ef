#include "tests/benchmarks/piles/random_groups.hpp"

#include "collision/shapes/shape.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

namespace kds::piles {
namespace {

/// s in which a body has to fall by half of its radius at least. 8 frames of Bullet; bodies of usual size take thrice
/// as long or longer, most of those that count as small one or two frames.
constexpr double quick = 8 / 240.0;

bool has_free_mesh(const Scene& scene) {
  return std::any_of(scene.bodies.begin(), scene.bodies.end(),
                     [](const Description& body) { return !body.fixed && collision::has_mesh(body.shape); });
}

bool has_walls_around_others_than_balls(const Scene& scene) {
  return scene.walls && std::any_of(scene.bodies.begin(), scene.bodies.end(), [](const Description& body) {
           return !std::holds_alternative<collision::Sphere>(body.shape);
         });
}

bool too_quick(const Scene& scene) {
  double least = std::numeric_limits<double>::infinity();
  for (const Description& body : scene.bodies) {
    if (!body.fixed) least = std::min(least, collision::place(body.shape, body.orientation).bounding_radius);
  }
  return std::sqrt(least) < quick * std::sqrt(scene.gravity.norm());
}

}  // namespace

bool left_out(const Scene& scene) { return has_free_mesh(scene) || has_walls_around_others_than_balls(scene); }

std::string group_of(const Scene& scene) {
  if (has_free_mesh(scene)) return "left out: free meshes";
  if (has_walls_around_others_than_balls(scene)) return "left out: walls around no balls";
  return too_quick(scene) ? "small on Earth" : scene.kind;
}

}  // namespace kds::piles
