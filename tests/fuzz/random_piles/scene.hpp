// A scene in which bodies fall, pile up and come to rest.
#pragma once

#include "collision/body_description.hpp"
#include "collision/world_options.hpp"

#include <Eigen/Core>

#include <optional>
#include <string>
#include <vector>

namespace kds::piles {

using Description = collision::BodyDescription<2>;

/// Free bodies have one piece of motion, whose acceleration is `gravity`. The response is elastic.
struct Scene {
  std::string kind;
  std::optional<collision::Walls> walls{};
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();
  std::vector<Description> bodies{};
  double seconds = 20;

  /// A box that no centre can leave but upward, where the scene has one that is not made of walls.
  struct Region {
    Eigen::Vector3d min;
    Eigen::Vector3d max;
  };
  std::optional<Region> region{};

  /// Whether a fixed body moves, so that energy may grow.
  bool driven() const;
  /// Whether nothing but the bodies themselves acts on them, so that momentum is conserved.
  bool isolated() const;
  bool has_meshes() const;
};

}  // namespace kds::piles
