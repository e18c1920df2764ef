#include "collision/broad_phase/box_slant.hpp"

#include <algorithm>
#include <cmath>

namespace kds::collision {

BoxSlant::BoxSlant(const StaticBox& box, const Eigen::Vector3d& velocity) {
  const Eigen::Vector3d speeds = velocity.cwiseAbs();
  main_ = speeds[1] > speeds[0] ? 1 : 0;
  if (speeds[2] > speeds[static_cast<int>(main_)]) main_ = 2;
  const double fastest = speeds[static_cast<int>(main_)];
  for (int d = 0; d < 3; ++d) {
    const double along = velocity[d] / fastest;
    along_[static_cast<std::size_t>(d)] = {along, std::abs(along), box.min[d] + box.max[d], box.max[d] - box.min[d],
                                           std::max(std::abs(box.min[d]), std::abs(box.max[d]))};
  }
}

bool BoxSlant::pays(const StaticBox& box, const Eigen::Vector3d& velocity) {
  const Eigen::Array3d speeds = velocity.array().abs();
  const double second = speeds.sum() - speeds.maxCoeff() - speeds.minCoeff();
  return second > 0x1p-5 * speeds.maxCoeff() && box.min.abs().max(box.max.abs()).minCoeff() > 0x1p-500;
}

}  // namespace kds::collision
