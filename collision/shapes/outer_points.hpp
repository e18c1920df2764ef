// A few points whose convex hull holds a shape.
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace kds::collision {

class ObbTree;

/// Points whose convex hull holds a shape but for roundings: each coordinate is that of an exact one rounded to a
/// float, so it is off by 2^-24 of itself. They stand in floats, side by side, eight of them at a time: the last place
/// is repeated until their number is a multiple of eight.
class OuterPoints {
 public:
  static constexpr std::size_t most = 64;

  /// Precondition: there is room for another one, and coordinates are no larger than those of a float.
  void add(const Eigen::Vector3d& point);

  std::size_t size() const { return size_; }  ///< with those that are repeated
  const float* x() const { return coordinates_[0].data(); }
  const float* y() const { return coordinates_[1].data(); }
  const float* z() const { return coordinates_[2].data(); }

 private:
  std::array<std::array<float, most>, 3> coordinates_;
  std::size_t size_ = 0, added_ = 0;
};

/// Of the triangles of a tree, in its unit: their corners, if these are no more than OuterPoints::most, else the
/// corners of the boxes three levels below the root.
OuterPoints outer_points(const ObbTree& tree, std::span<const Eigen::Vector3d> vertices);

}  // namespace kds::collision
