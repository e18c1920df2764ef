// Products, sums and lengths of vectors in one fixed order. Eigen's own order depends on the vector instructions that
// it is compiled for, and with it the last bit: a number that events depend on must not vary like that
// (docs/testing.md).
#pragma once

#include <Eigen/Core>

#include <cmath>

namespace kds::certificates {

inline double dot(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Eigen::Vector3d cross(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double squared_norm(const Eigen::Vector3d& v) { return dot(v, v); }
inline double norm(const Eigen::Vector3d& v) { return std::sqrt(squared_norm(v)); }
/// v / |v|; v itself if it is zero, or so short that its square underflows.
inline Eigen::Vector3d normalized(const Eigen::Vector3d& v) {
  const double length = norm(v);
  return length > 0 ? Eigen::Vector3d(v / length) : v;
}

}  // namespace kds::certificates
