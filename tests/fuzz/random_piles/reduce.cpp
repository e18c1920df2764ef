#include "tests/fuzz/random_piles/reduce.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdio>

namespace kds::piles {
namespace {

void print_vector(const char* name, const Eigen::Vector3d& v) {
  std::printf(" %s (%.17g, %.17g, %.17g)", name, v[0], v[1], v[2]);
}

}  // namespace

std::optional<Scene> reduced(Scene scene, const Budget& budget) {
  if (!found(budget, measure(scene, budget))) return std::nullopt;
  for (std::size_t part = scene.bodies.size() / 2; part > 0;) {
    bool smaller = false;
    for (std::size_t from = 0; from < scene.bodies.size();) {
      Scene less = scene;
      const std::size_t to = std::min(from + part, less.bodies.size());
      less.bodies.erase(less.bodies.begin() + static_cast<std::ptrdiff_t>(from),
                        less.bodies.begin() + static_cast<std::ptrdiff_t>(to));
      if (!less.bodies.empty() && found(budget, measure(less, budget))) {
        scene = std::move(less);
        smaller = true;
      } else {
        from += part;
      }
    }
    if (!smaller) part /= 2;
  }
  return scene;
}

void print_scene(const Scene& scene) {
  std::printf("%s:", scene.kind.c_str());
  print_vector("gravity", scene.gravity);
  if (scene.walls) {
    print_vector("walls", scene.walls->min);
    print_vector("to", scene.walls->max);
  }
  std::puts("");
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Description& body = scene.bodies[i];
    std::printf("%3zu %s %s, mass %.17g, e %g,", i, body.fixed ? "fixed" : "free", kind_name(body.shape), body.mass,
                body.restitution);
    print_vector("measures", measures(body.shape));
    const auto& q = body.orientation;
    if (q.w() != 1) std::printf(" turned (%.17g, %.17g, %.17g, %.17g)", q.w(), q.x(), q.y(), q.z());
    for (const auto& piece : body.motion) {
      std::printf(" from %g:", piece.start);
      print_vector("at", piece.coefficients[0]);
      if (!piece.coefficients[1].isZero(0)) print_vector("v", piece.coefficients[1]);
    }
    std::puts("");
  }
  std::fflush(stdout);
}

}  // namespace kds::piles
