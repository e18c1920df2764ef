// Vectors of double-doubles: for results that are calculated to some 100 bits and rounded once, at the end.
#pragma once

#include "kds/arithmetic/double_double.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>

namespace kds::collision {

/// A vector in space with some 106 bits for each coordinate.
struct PreciseVector {
  std::array<DoubleDouble, 3> coordinates{};

  PreciseVector() = default;
  PreciseVector(const DoubleDouble& x, const DoubleDouble& y, const DoubleDouble& z) : coordinates{x, y, z} {}
  explicit PreciseVector(const Eigen::Vector3d& v) : coordinates{v[0], v[1], v[2]} {}

  DoubleDouble& operator[](std::size_t i) { return coordinates[i]; }
  const DoubleDouble& operator[](std::size_t i) const { return coordinates[i]; }

  /// The nearest doubles.
  Eigen::Vector3d rounded() const { return {coordinates[0].high, coordinates[1].high, coordinates[2].high}; }

  PreciseVector& operator+=(const PreciseVector& v) {
    for (std::size_t i = 0; i < 3; ++i) coordinates[i] = coordinates[i] + v[i];
    return *this;
  }
};

inline PreciseVector operator+(const PreciseVector& a, const PreciseVector& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline PreciseVector operator-(const PreciseVector& a, const PreciseVector& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline PreciseVector operator*(const PreciseVector& v, const DoubleDouble& factor) {
  return {v[0] * factor, v[1] * factor, v[2] * factor};
}
inline PreciseVector operator*(const PreciseVector& v, double factor) {
  return {v[0] * factor, v[1] * factor, v[2] * factor};
}
inline DoubleDouble dot(const PreciseVector& a, const PreciseVector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline PreciseVector cross(const PreciseVector& a, const PreciseVector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline PreciseVector cross(const Eigen::Vector3d& a, const PreciseVector& b) {
  return {b[2] * a[1] - b[1] * a[2], b[0] * a[2] - b[2] * a[0], b[1] * a[0] - b[0] * a[1]};
}
inline PreciseVector precise_cross(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return {two_product(a[1], b[2]) - two_product(a[2], b[1]), two_product(a[2], b[0]) - two_product(a[0], b[2]),
          two_product(a[0], b[1]) - two_product(a[1], b[0])};
}
inline PreciseVector operator*(const Eigen::Matrix3d& m, const PreciseVector& v) {
  const auto row = [&](Eigen::Index i) { return v[0] * m(i, 0) + v[1] * m(i, 1) + v[2] * m(i, 2); };
  return {row(0), row(1), row(2)};
}

/// a - b, exactly except for underflow.
inline PreciseVector precise_difference(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return {two_sum(a[0], -b[0]), two_sum(a[1], -b[1]), two_sum(a[2], -b[2])};
}

/// |x| + |y| + |z|, rounded.
inline double magnitude_sum(const PreciseVector& v) { return magnitude(v[0]) + magnitude(v[1]) + magnitude(v[2]); }

}  // namespace kds::collision
