// Solid shapes as convex hulls of points, grown by a radius.
#pragma once

#include "collision/shapes/hull_structure.hpp"
#include "collision/shapes/shape.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <span>

namespace kds::collision {

/// The hull of points in the coordinates of a body, and all that is nearer to it than a radius: of a rounded box its
/// corners (of a box, bit d of the index set: at the upper end of axis d; of a capsule, the ends of its segment; of a
/// ball, its centre), of a hull its points. None of these numbers is rounded.
class ConvexCore {
 public:
  /// Precondition: the shape is a rounded box or a hull. Refers to it.
  explicit ConvexCore(const Shape& shape);

  std::span<const Eigen::Vector3d> points() const { return hull_.empty() ? std::span(own_.data(), size_) : hull_; }
  const HullStructure& structure() const { return *structure_; }
  double radius() const { return radius_; }
  /// The unit normal of a face that points out, known to some roundings.
  Eigen::Vector3d normal(std::size_t face) const;

  /// Whether it has faces, that is, a volume of its own.
  bool solid() const { return !structure_->faces.empty(); }

 private:
  std::span<const Eigen::Vector3d> hull_, normals_;  ///< of a hull
  std::array<Eigen::Vector3d, 8> own_;
  std::size_t size_ = 0;
  const HullStructure* structure_ = nullptr;
  double radius_ = 0;
};

}  // namespace kds::collision
