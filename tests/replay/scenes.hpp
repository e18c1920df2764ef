// The scenes whose event logs are hashed. Made of +, -, *, / and sqrt alone, which every machine rounds alike; what
// sin and cos give depends on the C library, and with it on the processor.
#pragma once

#include "collision/shapes/convex_hull.hpp"
#include "collision/shapes/mesh_script.hpp"
#include "collision/world.hpp"
#include "tests/collision/random_scenes.hpp"
#include "tests/collision/sample_sheets.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace kds::replay {

using namespace collision;
using namespace collision::tests;

/// A torus of radii 0.75 and 0.25 about z, its points on circles by ((1 - u^2) / (1 + u^2), 2 u / (1 + u^2)).
inline std::shared_ptr<const Mesh> rational_torus() {
  constexpr std::array<std::array<double, 2>, 8> circle{
      {{1, 0}, {0.6, 0.8}, {0, 1}, {-0.6, 0.8}, {-1, 0}, {-0.6, -0.8}, {0, -1}, {0.6, -0.8}}};
  constexpr std::uint32_t across = 4;
  std::vector<Vector3d> vertices;
  std::vector<Mesh::Triangle> triangles;
  for (std::uint32_t i = 0; i < circle.size(); ++i) {
    for (std::uint32_t j = 0; j < across; ++j) {
      const double r = 0.75 + 0.25 * circle[2 * j][0];
      vertices.emplace_back(r * circle[i][0], r * circle[i][1], 0.25 * circle[2 * j][1]);
      const auto at = [&](std::uint32_t p, std::uint32_t q) { return (p % 8) * across + q % across; };
      triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return std::make_shared<const Mesh>(std::move(vertices), std::move(triangles));
}

/// Random bodies of one kind, or every other one a ring.
template <int Degree>
Scene<Degree> random_scene(const SceneOptions& options, std::uint64_t seed) {
  Random random(seed);
  SceneOptions chosen = options;
  const bool rings = options.shapes == Shapes::rings || options.shapes == Shapes::mixture;
  if (rings) chosen.shapes = options.shapes == Shapes::rings ? Shapes::cubes : Shapes::spheres;
  Scene<Degree> scene = SceneMaker(random, chosen).template scene<Degree>();
  if (!rings) return scene;
  const auto ring = rational_torus();
  const bool mixed = options.shapes == Shapes::mixture;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    switch (mixed ? i % 4 : 0) {
      case 0:
        scene.bodies[i].shape = MeshShape{ring, 0.75};
        break;
      case 1:
        scene.bodies[i].shape = Box{{0.5, 0.4, 0.3}};
        scene.bodies[i].orientation = unit_quaternion(0.5, 0.1, 0.7, -0.5);
        break;
      case 2:
        scene.bodies[i].shape = MeshShape{tetrahedron(), 0.6};
        break;
      default:  // stays a sphere
        break;
    }
  }
  return scene;
}

/// A ball and a box dropped on a floor, over and over: gravity, many bounces, and the policy for those without end.
inline Scene<2> bouncing_scene() {
  Scene<2> scene;
  scene.end_time = 6;
  scene.bodies.push_back(fixed_body<2>(Box{{5, 5, 1}}, motion<2>({0, 0, -1})));
  const Vector3d gravity(0, 0, -4.905);
  scene.bodies.push_back(ball<2>(0.5, {0, 0, 3}, zero, gravity));
  scene.bodies.push_back(ball<2>(0.25, {0.01, 0.02, 5}, zero, gravity));
  auto turned = box<2>({0.5, 0.4, 0.3}, {2, 2, 2}, {0, 0.125, 0}, gravity);
  turned.orientation = unit_quaternion(0.9, 0.1, 0.3, -0.3);
  scene.bodies.push_back(turned);
  auto ring = body<2>(MeshShape{rational_torus(), 1}, motion<2>({-2, -2, 2}, {0.125, 0, 0}, gravity));
  ring.orientation = unit_quaternion(0.9, -0.4, 0.1, 0.1);
  scene.bodies.push_back(ring);
  return scene;
}

/// Capsules, two of them parallel, dropped on a floor, on a fixed box and ring, and on each other, some without
/// rebound.
inline Scene<2> capsule_scene() {
  Scene<2> scene;
  scene.end_time = 4;
  const Vector3d gravity(0, 0, -4.905);
  const auto along_x = unit_quaternion(0.5, 0.5, 0.5, 0.5);
  scene.bodies.push_back(fixed_body<2>(Box{{6, 6, 1}}, motion<2>({0, 0, -1})));
  auto ring = fixed_body<2>(MeshShape{rational_torus(), 1}, motion<2>({-3, -3, 0.5}));
  ring.orientation = unit_quaternion(0.9, -0.4, 0.1, 0.1);
  scene.bodies.push_back(ring);
  auto bar = fixed_body<2>(Capsule{0.25, 2}, motion<2>({2, 0, 1}));
  bar.orientation = along_x;
  scene.bodies.push_back(bar);
  scene.bodies.push_back(ball<2>(0.25, {2.5, 0.125, 4}, zero, gravity));
  for (int i = 0; i < 8; ++i) {
    const double column = i % 4, row = i / 4;
    auto capsule =
        body<2>(Capsule{0.25 + 0.0625 * i, i % 3 == 0 ? 0.125 : 0.5},
                motion<2>({2 * column - 3, 0.25 * column + row - 3, 2.5 + 2 * row}, {0.125, 0.25, 0}, gravity));
    if (i % 4 == 1) capsule.orientation = along_x;
    if (i % 4 >= 2) capsule.orientation = unit_quaternion(0.9, 0.1 * i, 0.3, -0.3);
    capsule.restitution = i % 2 == 0 ? 1 : 0.5;
    scene.bodies.push_back(capsule);
  }
  return scene;
}

/// A sheet that is a bowl, and heaves: from keyframe to keyframe it has another depth and tilt.
inline BendingMesh bowl(const std::array<std::array<double, 2>, 4>& forms, double duration) {
  const samples::Sheet sheet(6, 2);
  std::vector<MeshScript::Keyframe> keyframes;
  for (std::size_t i = 0; i < forms.size(); ++i) {
    keyframes.push_back({0.375 * duration * static_cast<double>(i), sheet.positions});
    for (Vector3d& p : keyframes.back().positions) {
      p[2] = forms[i][0] * (p[0] * p[0] + p[1] * p[1]) + forms[i][1] * p[0];
    }
  }
  return {std::make_shared<const MeshScript>(std::move(keyframes), sheet.triangles)};
}

/// Bodies of all kinds that fall into one; or fly through two that pass through each other, and fold.
template <int Degree>
Scene<Degree> bending_scene(bool falls) {
  Scene<Degree> scene;
  scene.end_time = 0.75;
  const auto sheet = bowl({{{0.25, 0}, {0.375, 0.125}, {0.25, -0.125}, {0.3125, 0}}}, 1);
  scene.bodies.push_back(fixed_body<Degree>(sheet, motion<Degree>({0, 0, 0})));
    if (!falls) {
    auto other =
        body<Degree>(bowl({{{0.25, 0}, {-0.5, 0.25}, {2, 1}, {-2, 0}}}, 0.75), motion<Degree>({0, 0, 1}, {0, 0, -1}));
    other.orientation = unit_quaternion(0.5, 0.5, 0.5, 0.5);
    other.self_contacts = true;
    scene.bodies.push_back(other);
  }
  const auto hull = convex_hull({{0.25, 0, 0}, {-0.125, 0.25, 0}, {-0.125, -0.25, 0}, {0, 0, 0.25}, {0, 0, -0.125}});
  const std::array<Shape, 5> shapes{Sphere{0.25}, Box{{0.25, 0.2, 0.15}}, Capsule{0.125, 0.25},
                                    MeshShape{rational_torus(), 0.25}, hull};
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    const double x = static_cast<double>(i % 3), y = static_cast<double>(i / 3);
    auto falling = body<Degree>(shapes[i], motion<Degree>({0.75 * x - 0.7, y - 0.6, 1}, {0.125, 0.25, -2}));
    if constexpr (Degree == 2) falling.motion[0].coefficients[2] = Vector3d(0, 0, -4.905);
    falling.orientation = unit_quaternion(0.9, -0.4, 0.1, 0.1);
    falling.restitution = i == 0 ? 0.25 : 1;
    scene.bodies.push_back(falling);
  }
  return scene;
}

/// Balls that fall without rebound on a bed of fixed ones, uneven, and come to lie in its hollows and on each other.
inline Scene<2> resting_scene() {
  Random random(3);
  Scene<2> scene;
  scene.end_time = 1.25;
  const auto jitter = [&] { return random.between(-0.1, 0.1); };
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 5; ++j) {
      const double x = 1.7 * i + jitter(), y = 1.7 * j + jitter(), z = jitter();
      scene.bodies.push_back(fixed_body<2>(Sphere{1}, motion<2>({x, y, z})));
    }
  }
  for (int i = 0; i < 12; ++i) {
    const double x = 0.9 + 1.7 * (i % 4) + jitter(), y = 0.9 + 1.7 * (i / 4) + jitter();
    scene.bodies.push_back(ball<2>(0.8, {x, y, 2.5 + 0.125 * i}, zero, {0, 0, -4.905}));
    scene.bodies.back().restitution = 0;
  }
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    scene.bodies[i].category = scene.bodies[i].fixed ? 1 : 2;
    if (scene.bodies[i].fixed) scene.bodies[i].collides_with = 2;
  }
  return scene;
}

}  // namespace kds::replay
