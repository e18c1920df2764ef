#include "tests/fuzz/random_worlds/meshes.hpp"

namespace kds::fuzz {

const std::vector<Surface>& sample_surfaces() {
  constexpr double thin = 0x1p-20;  // 1e6 times as long as wide, and far wider than the thinnest triangle allowed
  static const std::vector<Surface> surfaces{
      {"tetrahedron", {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}},
      {"cube",
       {{-1, -1, -1}, {1, -1, -1}, {-1, 1, -1}, {1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {-1, 1, 1}, {1, 1, 1}},
       {{0, 4, 2},
        {2, 4, 6},
        {1, 3, 5},
        {3, 7, 5},
        {0, 1, 4},
        {1, 5, 4},
        {2, 6, 3},
        {3, 6, 7},
        {0, 2, 1},
        {1, 2, 3},
        {4, 5, 6},
        {5, 7, 6}}},
      {"one triangle", {{1, 0, 0}, {-1, 1, 0}, {-1, -1, 0}}, {{0, 1, 2}}},
      {"square, one half of it on both sides",
       {{1, 1, 0}, {-1, 1, 0}, {-1, -1, 0}, {1, -1, 0}},
       {{0, 1, 2}, {0, 2, 3}, {2, 1, 0}}},
      {"fan about an edge",
       {{0, 0, -1}, {0, 0, 1}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {1, 1, 0}},
       {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}, {1, 0, 5}, {0, 1, 6}}},
      {"blade and sail", {{1, 0, 0}, {-1, thin, 0}, {-1, -thin, 0}, {0, 0, 1}}, {{0, 1, 2}, {0, 1, 3}}},
      {"two parallel squares",
       {{1, 1, 1}, {-1, 1, 1}, {-1, -1, 1}, {1, -1, 1}, {1, 1, -1}, {-1, 1, -1}, {-1, -1, -1}, {1, -1, -1}},
       {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}}},
      {"sheet folded flat", {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0.25, 0.5, 0}}, {{0, 1, 2}, {0, 1, 3}}},
      {"open wedge away from its origin", {{1, 1, 0}, {1, -1, 0}, {2, 0, 0.5}, {2, 0, -0.5}}, {{0, 1, 2}, {0, 1, 3}}},
      {"fan about a vertex",
       {{0, 0, 0.5}, {1, 0, 0}, {0.5, 1, 0}, {-0.5, 1, 0}, {-1, 0, 0}, {-0.5, -1, 0}, {0.5, -1, 0}},
       {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}, {0, 5, 6}}}};
  return surfaces;
}

const std::vector<std::shared_ptr<const collision::Mesh>>& sample_meshes() {
  static const std::vector<std::shared_ptr<const collision::Mesh>> meshes = [] {
    std::vector<std::shared_ptr<const collision::Mesh>> result;
    for (const Surface& surface : sample_surfaces()) {
      result.push_back(std::make_shared<const collision::Mesh>(surface.vertices, surface.triangles));
    }
    return result;
  }();
  return meshes;
}

std::vector<Eigen::Vector3d> cut_box(const Eigen::Vector3d& half_extents) {
  std::vector<Eigen::Vector3d> corners;
  for (int i = 0; i < 7; ++i) {
    corners.push_back(half_extents.cwiseProduct(Eigen::Vector3d(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
  }
  return corners;
}

std::vector<collision::CompoundPart> angle(const Eigen::Vector3d& half_extents) {
  const double x = half_extents[0], y = half_extents[1], z = half_extents[2];
  return {{collision::Box{{x, y, 0.25 * z}}, {0, 0, -0.75 * z}}, {collision::Box{{0.25 * x, y, z}}, {-0.75 * x, 0, 0}}};
}

}  // namespace kds::fuzz
