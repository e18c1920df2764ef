// Whether an edge goes through a face, and a point lies inside a solid: by exact signs.
#pragma once

#include "kds/arithmetic/ball.hpp"
#include "kds/arithmetic/exact.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>

namespace kds::collision {

namespace detail {

/// (b - a) x (c - a) . (p - a): six times the volume of the four points.
template <class Number>
Number signed_volume(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                     const Eigen::Vector3d& p) {
  const auto from_a = [&](const Eigen::Vector3d& x) {
    return std::array<Number, 3>{Number(x[0]) - Number(a[0]), Number(x[1]) - Number(a[1]), Number(x[2]) - Number(a[2])};
  };
  const auto u = from_a(b);
  const auto v = from_a(c);
  const auto w = from_a(p);
  return (u[1] * v[2] - u[2] * v[1]) * w[0] + (u[2] * v[0] - u[0] * v[2]) * w[1] + (u[0] * v[1] - u[1] * v[0]) * w[2];
}

}  // namespace detail

/// The side of the plane through a, b, c on which p lies: 1 where they turn counter-clockwise as seen from it, 0 on the
/// plane, or -1. Exact.
inline int side_of_plane(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                         const Eigen::Vector3d& p) {
  if (const int sign = certain_sign(detail::signed_volume<Ball<double>>(a, b, c, p))) return sign;
  return detail::signed_volume<Exact>(a, b, c, p).sign();
}

/// Whether the segment from p to q goes through the inside of the triangle a, b, c, from one side to the other.
inline bool goes_through(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Eigen::Vector3d& a,
                         const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const int from = side_of_plane(a, b, c, p);
  if (from == 0 || side_of_plane(a, b, c, q) != -from) return false;
  const int first = side_of_plane(p, q, a, b);
  return first != 0 && side_of_plane(p, q, b, c) == first && side_of_plane(p, q, c, a) == first;
}

}  // namespace kds::collision
