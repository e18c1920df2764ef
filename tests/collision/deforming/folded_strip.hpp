// A strip that is folded down on itself.
#pragma once

#include "collision/shapes/bending_mesh.hpp"
#include "collision/shapes/mesh_script.hpp"
#include "tests/collision/sample_sheets.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <memory>
#include <vector>

namespace kds::collision::tests {

/// A strip, of which one end is lifted over the middle and comes down on it at t = 2.5, is all through it at 2.625, and
/// goes back from 3 on, the same way.
struct Fold {
  samples::Sheet sheet{4};
  std::vector<MeshScript::Keyframe> keyframes;

  Fold() {
    const auto lifted = with_end({0, 0, 1}), over = with_end({-1.25, 0, 1}), down = with_end({-1.25, 0, -1});
    keyframes = {{0, sheet.positions}, {1, lifted}, {2, over}, {3, down}, {4, over}, {5, lifted}};
  }
  BendingMesh shape() const { return {std::make_shared<const MeshScript>(keyframes, sheet.triangles)}; }

  /// The row of vertices at x = 1 is moved, and that at x = 1 / 2 lifted.
  std::vector<Eigen::Vector3d> with_end(const Eigen::Vector3d& way) const {
    auto positions = sheet.positions;
    for (std::size_t v = 15; v < 20; ++v) positions[v][2] = 0.5;
    for (std::size_t v = 20; v < 25; ++v) positions[v] += way;
    return positions;
  }
};

}  // namespace kds::collision::tests
