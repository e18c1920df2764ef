// The lowest part of a shape along a normal.
#pragma once

#include "certificates/half_space_separation.hpp"
#include "collision/shapes/rounded_core.hpp"
#include "collision/shapes/shape.hpp"
#include "collision/shapes/support.hpp"

#include <Eigen/Core>

#include <boost/container/static_vector.hpp>

namespace kds::collision {

/// The lowest place of a shape, exactly: of a box the sum of its rounded half axes, of a hull or a mesh a vertex that
/// is turned by its rounded matrix, the products not rounded. Of several that are equally low the first. The points of
/// a capsule's and a ball's radius count as if the normal were exactly of unit length.
///
/// Cost: in proportion to the corners of a hull; to the logarithm of the triangles of a mesh, and to those of them that
/// are as low as doubles can tell, whose places are compared in exact arithmetic.
class LowestOfShape {
 public:
  /// Precondition: the shape is bounded and does not bend.
  LowestOfShape(const PlacedShape& shape, const Eigen::Vector3d& normal);
  LowestOfShape(const LowestOfShape&) = delete;
  LowestOfShape& operator=(const LowestOfShape&) = delete;

  const certificates::LowestPlace& place() const { return place_; }
  double height() const { return height_; }  ///< rounded, some roundings of the bounding radius off

 private:
  boost::container::static_vector<certificates::Generator, certificates::most_generators> generators_;
  certificates::LowestPlace place_;
  double height_;
};

/// The lowest part of a shape as a feature, as from supporting_feature(); for meshes too: of several triangles the
/// first.
SupportingFeature lowest_feature(const PlacedShape& shape, const Eigen::Vector3d& normal);

}  // namespace kds::collision
