// Sheets and bowls that bend, and what falls into them: as shapes, and as surfaces at one time in long doubles.
#pragma once

#include "collision/shapes/bending_mesh.hpp"
#include "collision/shapes/convex_hull.hpp"
#include "collision/shapes/mesh_script.hpp"
#include "collision/shapes/shape.hpp"
#include "tests/collision/deforming/brute_sheets.hpp"
#include "tests/collision/sample_meshes.hpp"
#include "tests/collision/sample_sheets.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace kds::collision::tests {

using Eigen::Vector3d;
using LongMatrix = Eigen::Matrix<Long, 3, 3>;

inline BendingMesh bending(std::vector<MeshScript::Keyframe> keyframes, std::vector<Mesh::Triangle> triangles) {
  return {std::make_shared<const MeshScript>(std::move(keyframes), std::move(triangles))};
}

/// A sheet that bends at random until 2: each coordinate of a vertex by up to `most`.
inline BendingMesh random_sheet(samples::Random& random, double most = 0.3) {
  std::vector<MeshScript::Keyframe> keyframes;
  const samples::Sheet sheet(3);
  for (int i = 0; i < 4; ++i) {
    auto positions = sheet.positions;
    for (Vector3d& p : positions) p += random.vector(most);
    keyframes.push_back({0.75 * i - 0.25, positions});
  }
  return bending(std::move(keyframes), sheet.triangles);
}

/// A bowl that heaves and tilts, 2 wide: z is a function of x and y, which are those of the flat sheet.
struct Bowl {
  samples::Sheet sheet{6, 1};
  std::vector<MeshScript::Keyframe> keyframes;

  Bowl(samples::Random& random, int frames, double end) {
    for (int i = 0; i <= frames; ++i) {
      auto positions = sheet.positions;
      const double most = frames < 10 ? 0.1 : 0.02;
      const double lift = random.vector(most)[0], tilt = random.vector(most)[0], wave = random.vector(most / 2)[0];
      for (Vector3d& p : positions) {
        p[2] = 0.75 * (p[0] * p[0] + p[1] * p[1]) + lift + tilt * p[0] + (p[0] * p[1] > 0 ? wave : -wave);
      }
      keyframes.push_back({end * i / frames, positions});
    }
  }
  BendingMesh shape() const { return bending(keyframes, sheet.triangles); }

  BruteSurface at(double t) const {
    BruteSurface result;
    std::size_t next = 1;
    while (next + 1 < keyframes.size() && keyframes[next].time < t) ++next;
    const auto &before = keyframes[next - 1], &after = keyframes[next];
    const Long s = std::clamp<Long>((static_cast<Long>(t) - before.time) / (after.time - before.time), 0, 1);
    for (std::size_t v = 0; v < before.positions.size(); ++v) {
      result.corners.push_back((1 - s) * before.positions[v].cast<Long>() + s * after.positions[v].cast<Long>());
    }
    result.faces = sheet.triangles;
    result.add_edges_of_faces();
    return result;
  }
};

/// The height of a height field above a place, or -infinity.
inline Long height_at(const BruteSurface& field, Long x, Long y) {
  for (const auto& [i, j, k] : field.faces) {
    const LongVector &a = field.corners[i], &b = field.corners[j], &c = field.corners[k];
    const Long area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    const Long wb = ((x - a[0]) * (c[1] - a[1]) - (y - a[1]) * (c[0] - a[0])) / area;
    const Long wc = ((b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])) / area;
    if (wb >= 0 && wc >= 0 && wb + wc <= 1) return a[2] + wb * (b[2] - a[2]) + wc * (c[2] - a[2]);
  }
  return -INFINITY;
}

/// A body as it is placed about its centre, by its own numbers.
struct Solid {
  Shape shape;
  Long radius;
  BruteSurface surface;

  BruteSurface at(const LongVector& centre, const LongMatrix& turn = LongMatrix::Identity()) const {
    BruteSurface result = surface;
    for (LongVector& c : result.corners) c = centre + turn * c;
    return result;
  }
};

inline std::vector<Solid> solids() {
  std::vector<Solid> result;
  result.push_back({Sphere{0.125}, 0.125L, {{LongVector::Zero()}, {}, {}}});
  result.push_back({Capsule{0.0625, 0.125}, 0.0625L, {{LongVector(0, 0, -0.125L), LongVector(0, 0, 0.125L)}, {}, {}}});
  result.back().surface.edges.emplace(0, 1);
  BruteSurface box;
  for (unsigned i = 0; i < 8; ++i)
    box.corners.emplace_back(i & 1 ? .125 : -.125, i & 2 ? .0625 : -.0625, i & 4 ? .1 : -.1);
  box.faces = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
               {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
  box.add_edges_of_faces();
  result.push_back({Box{Vector3d(.125, .0625, .1)}, 0, box});
  const std::vector<Vector3d> points{
      {0.125, 0, 0}, {-0.0625, 0.125, 0}, {-0.0625, -0.125, 0}, {0, 0, 0.125}, {0, 0, -0.125}};
  BruteSurface hull;
  for (const Vector3d& p : points) hull.corners.push_back(p.cast<Long>());
  hull.faces = {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {1, 0, 4}, {2, 1, 4}, {0, 2, 4}};
  hull.add_edges_of_faces();
  result.push_back({convex_hull(points), 0, hull});
  result.push_back({MeshShape{std::make_shared<const Mesh>(points, hull.faces)}, 0, hull});
  return result;
}

}  // namespace kds::collision::tests
