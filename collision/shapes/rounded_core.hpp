// Convex shapes as zonotopes grown by a radius.
#pragma once

#include "certificates/zonotope_separation.hpp"

#include <boost/container/static_vector.hpp>

namespace kds::collision {

/// A shape as the sum of segments and of a ball: of none and its radius, for a ball; of three and no radius, for a box;
/// of one and its radius, for a capsule. The directions are columns of the rotation, the lengths the numbers of the
/// shape, and their products are not rounded.
struct RoundedCore {
  boost::container::static_vector<certificates::Generator, certificates::most_generators> generators;
  double radius = 0;
};

}  // namespace kds::collision
