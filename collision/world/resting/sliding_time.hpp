// How far ahead contacts with meshes are sought.
#pragma once

#include "certificates/point_motion.hpp"
#include "collision/vectors.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace kds::collision {

/// How far the end of a contact with a mesh is sought: this many sizes of the smaller body along it.
inline constexpr double most_slide = 4;

/// A time in which two bodies move by no more than about twice a distance relative to each other; `never` if they do
/// not move so.
template <int Degree>
double sliding_time(const certificates::PointMotion<Degree>& a, const certificates::PointMotion<Degree>& b, double now,
                    double distance) {
  const auto of_a = a.restarted(now).coefficients, of_b = b.restarted(now).coefficients;
  const auto term = [&](std::size_t k) { return norm(Eigen::Vector3d(of_b[k] - of_a[k])); };
  double time = distance / term(1);
  if constexpr (Degree >= 2) time = std::min(time, std::sqrt(distance / term(2)));
  for (std::size_t k = 3; k <= Degree; ++k) {
    if (!(term(k) > 0)) continue;
    time = std::min(time, 1024.0);
    double power = time;
    for (std::size_t i = 1; i < k; ++i) power *= time;
    for (; term(k) * power > distance; time /= 2) power = std::ldexp(power, -static_cast<int>(k));
  }
  return time;
}

}  // namespace kds::collision
