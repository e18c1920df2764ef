// A contact of two bodies.
#pragma once

#include "collision/shapes/feature.hpp"

#include <Eigen/Core>

namespace kds::collision {

/// When, where and how two bodies touch.
struct Contact {
  double time = 0;                                    ///< s
  Eigen::Vector3d point = Eigen::Vector3d::Zero();    ///< in world coordinates
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();  ///< unit, from a to b
  Feature feature_a{};                                ///< of a, or its part, what touches; none for spheres and walls
  Feature feature_b{};
};

template <class Archive>
void archive_members(Archive& archive, Contact& contact) {
  archive(contact.time, contact.feature_a, contact.feature_b);
  for (Eigen::Vector3d* v : {&contact.point, &contact.normal}) archive((*v)[0], (*v)[1], (*v)[2]);
}

}  // namespace kds::collision
