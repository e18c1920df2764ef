// Bodies and shapes that tests of queries ask about.
#pragma once

#include "collision/body_description.hpp"
#include "collision/shapes/convex_hull.hpp"
#include "tests/collision/sample_meshes.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <memory>
#include <vector>

namespace kds::collision::samples {

inline BodyDescription<1> body(const Shape& shape, const Vector3d& at, const Vector3d& velocity = Vector3d::Zero(),
                               const Eigen::Quaterniond& orientation = Eigen::Quaterniond::Identity()) {
  BodyDescription<1> description;
  description.shape = shape;
  description.orientation = orientation;
  description.motion = {certificates::PointMotion<1>{{at, velocity}}};
  return description;
}

inline Shape random_shape(Random& random, const std::shared_ptr<const Mesh>& ring) {
  switch (random.below(5)) {
    case 0:
      return Sphere{random.uniform(0.1, 0.6)};
    case 1:
      return Box{Vector3d(random.uniform(0.1, 0.6), random.uniform(0.1, 0.6), random.uniform(0.1, 0.6))};
    case 2:
      return Capsule{random.uniform(0.1, 0.4), random.uniform(0.1, 0.5)};
    case 3:
      return MeshShape{ring, random.uniform(0.3, 0.7)};
    default: {
      std::vector<Vector3d> points;
      for (int i = 0; i < 8; ++i) points.push_back(random.vector(0.5));
      return convex_hull(points);
    }
  }
}

}  // namespace kds::collision::samples
