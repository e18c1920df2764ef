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

inline BoxSlant::Side BoxSlant::side(std::size_t d, double min, double minus_max) const {
  const double farthest = along_[d].farthest() + std::max(std::abs(min), std::abs(minus_max));
  return {min - minus_max - along_[d].twice_centre, along_[d].extent - (min + minus_max) + 0x1p-47 * farthest};
}

inline bool BoxSlant::apart(std::size_t i, const Side& at_i, std::size_t j, const Side& at_j) const {
  return std::abs(along_[j].velocity * at_i.distance - along_[i].velocity * at_j.distance) >
         along_[j].speed() * at_i.reach + along_[i].speed() * at_j.reach;
}

bool BoxSlant::apart(const BoxBounds& other) const {
  const Side x = side(0, other.xy[0], other.zx[1]);
  const Side y = side(1, other.xy[1], other.yz[0]);
  if (apart(0, x, 1, y)) return true;
  const Side z = side(2, other.zx[0], other.yz[1]);
  return apart(1, y, 2, z) || apart(2, z, 0, x);
}

}  // namespace kds::collision
