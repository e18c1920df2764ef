// The scenes of the accuracy benchmark: bodies in open space that pass through each other, so that what happens is one
// list of contacts, whoever looks for it.
#pragma once

#include "collision/world.hpp"
#include "examples/kds-collide/generator.hpp"
#include "io/scene_reader.hpp"
#include "tests/support/random_numbers.hpp"

#include <Eigen/Core>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

namespace accuracy {

using Eigen::Vector3d;
using kds::collision::BodyDescription;
using kds::collision::Sphere;
using kds::tests::Random;

template <int Degree>
struct Scene {
  std::string name;
  std::string what;
  std::vector<BodyDescription<Degree>> bodies;
  double end_time = 2;  ///< s; begins at 0
};

/// The tool's generator, without its walls: spheres, boxes or rings.
template <int Degree>
Scene<Degree> generated(const std::string& name, const std::string& what,
                        const kds_collide::GeneratorOptions& options) {
  const auto text = kds_collide::generate_scene(options);
  const auto folder = std::filesystem::temp_directory_path() / ("kds-accuracy-" + name);
  std::filesystem::create_directories(folder);
  for (const auto& mesh : text.meshes) std::ofstream(folder / mesh.name) << mesh.text;
  const auto read = kds::io::parse_scene(text.json, folder / "scene.json");
  std::filesystem::remove_all(folder);
  Scene<Degree> scene{name, what, {}, options.end_time.value_or(kds_collide::default_end_time)};
  for (const auto& body : read.bodies) {
    BodyDescription<Degree> description;
    description.shape = body.shape;
    description.orientation = body.orientation;
    description.motion.emplace_back();
    for (std::size_t i = 0; i <= Degree; ++i)
      description.motion[0].coefficients[i] = body.motion[0].path.coefficients[i];
    scene.bodies.push_back(std::move(description));
  }
  return scene;
}

inline Vector3d direction(Random& random) {
  for (;;) {
    Vector3d v;
    for (int d = 3; d-- > 0;) v[d] = random.between(-1, 1);
    const double square = v.squaredNorm();
    if (square > 0.01 && square < 1) return v / std::sqrt(square);
  }
}

/// Balls on parabolas: the generator's, with accelerations of up to 2 length units / s^2.
inline Scene<2> curved(std::size_t bodies, double density, std::uint64_t seed) {
  auto scene = generated<2>("curved", "balls on parabolas, 1 %",
                            {.kind = "spheres", .bodies = bodies, .density = density, .seed = seed, .end_time = 2});
  Random random(seed);
  for (auto& body : scene.bodies) {
    const double size = random.between(0, 1);
    body.motion[0].coefficients[2] = direction(random) * size;
  }
  return scene;
}

/// Four of five are small (radius 0.02-0.05) and fast (100-300 units / s); the others large (1-2) and slow (0.5). The
/// large ones fill 5 % of a cube in which all start apart.
inline Scene<1> bullets(std::size_t bodies, std::uint64_t seed) {
  Scene<1> scene{"bullets", "small fast balls among large slow ones", {}, 0.2};
  Random random(seed);
  const std::size_t large = bodies / 5;
  const double side = std::cbrt(static_cast<double>(large) * 4.0 / 3.0 * std::numbers::pi * 3.75 / 0.05);
  while (scene.bodies.size() < bodies) {
    const bool is_large = scene.bodies.size() < large;
    const double radius = is_large ? random.between(1, 2) : random.between(0.02, 0.05);
    Vector3d at;
    for (int d = 3; d-- > 0;) at[d] = random.between(0, side);
    bool free = true;
    for (const auto& other : scene.bodies) {
      const double sum_of_radii = radius + std::get<Sphere>(other.shape).radius;
      free = free && (other.motion[0].coefficients[0] - at).squaredNorm() > sum_of_radii * sum_of_radii * (1 + 1e-6);
    }
    if (!free) continue;
    BodyDescription<1> body;
    body.shape = Sphere{radius};
    const double speed = is_large ? 0.5 : random.between(100, 300);
    body.motion = {{{at, direction(random) * speed}, 0}};
    scene.bodies.push_back(std::move(body));
  }
  return scene;
}

}  // namespace accuracy
