#include "collision/broad_phase/box_slant.hpp"

#include <algorithm>
#include <cmath>

namespace kds::collision {

BoxSlant::BoxSlant(const StaticBox& box, const Eigen::Vector3d& velocity) {
  // The quotient of two doubles is 1 in magnitude only if they are equal in magnitude: main_axis() is exact.
  const double fastest = velocity.cwiseAbs().maxCoeff();
  for (int d = 0; d < 3; ++d) {
    along_[static_cast<std::size_t>(d)] = {velocity[d] / fastest, box.min[d] + box.max[d], box.max[d] - box.min[d]};
  }
}

bool BoxSlant::pays(const StaticBox& box, const Eigen::Vector3d& velocity) {
  const Eigen::Array3d speeds = velocity.array().abs();
  const double second = speeds.sum() - speeds.maxCoeff() - speeds.minCoeff();
  return second > 0x1p-5 * speeds.maxCoeff() && box.min.abs().max(box.max.abs()).minCoeff() > 0x1p-500;
}

}  // namespace kds::collision
