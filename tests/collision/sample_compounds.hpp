// Random bodies of several parts.
#pragma once

#include "collision/shapes/compound.hpp"
#include "tests/collision/random_scenes.hpp"

#include <cstddef>
#include <memory>
#include <variant>
#include <vector>

namespace kds::collision::tests {

enum class Parts { boxes, solids, all };  ///< solids: boxes and hulls; all: meshes too

inline ConvexHull wedge(double size) {
  return convex_hull({{-size, -size, -size}, {size, -size, -size}, {0, size, -size}, {0, 0, size}});
}

/// So many parts, within a cube of the half side `half_side`, that may overlap.
inline std::vector<CompoundPart> random_parts(Random& random, Parts kinds, std::size_t count, double half_side = 1) {
  std::vector<CompoundPart> parts;
  for (std::size_t i = 0; i < count; ++i) {
    CompoundPart part;
    const int most = kinds == Parts::boxes ? 0 : kinds == Parts::solids ? 1 : 2;
    const double size = random.between(0.15, 0.5);
    switch (random.integer(0, most)) {
      case 0: {
        const double x = random.between(0.15, 0.5), y = random.between(0.15, 0.5);
        part.shape = Box{{x, y, size}};
        break;
      }
      case 1:
        part.shape = wedge(size);
        break;
      default:
        part.shape = MeshShape{random.one_in(2) ? tetrahedron() : ring(), size};
        break;
    }
    for (int d = 0; d < 3; ++d) part.position[d] = random.between(-half_side, half_side);
    if (!random.one_in(3)) {
      const double w = random.between(-1, 1), x = random.between(-1, 1), y = random.between(-1, 1);
      part.orientation = unit_quaternion(w, x, y, random.between(0.1, 1));
    }
    parts.push_back(part);
  }
  return parts;
}

inline Compound random_compound(Random& random, Parts kinds, std::size_t count, double half_side = 1) {
  return compound(random_parts(random, kinds, count, half_side));
}

/// A placed compound whose parts are looked at one by one, without their tree.
inline PlacedShape without_tree(PlacedShape placed) {
  const auto& whole = *std::get<Compound>(placed.shape).parts;
  for (const Shape& part : whole.parts()) {
    const bool typical = std::holds_alternative<MeshShape>(part) == whole.has_mesh();  // which says has_mesh(shape)
    if (typical) placed.shape = Compound{std::make_shared<const CompoundParts>(std::vector<Shape>{part})};
    if (typical) break;
  }
  return placed;
}

/// A scene of SceneMaker in which every other body is a compound.
template <int Degree>
Scene<Degree> compound_scene(Random& random, const SceneOptions& options, Parts kinds, int most_parts = 4) {
  Scene<Degree> scene = SceneMaker(random, options).scene<Degree>();
  for (std::size_t i = 0; i < scene.bodies.size(); i += 2) {
    scene.bodies[i].shape = random_compound(random, kinds, static_cast<std::size_t>(random.integer(1, most_parts)));
  }
  return scene;
}

/// A box cut in two, across x at a part of its length: both halves are where they were, up to a rounding of that place.
inline Compound cut_box(const Vector3d& half, double at) {
  const double middle = at * half[0];
  const double left = 0.5 * (middle + half[0]), right = 0.5 * (half[0] - middle);
  const std::vector<CompoundPart> parts{{Box{{left, half[1], half[2]}}, {middle - left, 0, 0}},
                                        {Box{{right, half[1], half[2]}}, {middle + right, 0, 0}}};
  return compound(parts);
}

}  // namespace kds::collision::tests
