#include "collision/shapes/box.hpp"

#include <cstddef>

namespace kds::collision {

using Eigen::Vector3d;

Feature box_feature(const BoxSide& side) {
  const auto vertex = [](const BoxSide& s) {
    std::uint32_t index = 0;
    for (int d = 0; d < 3; ++d) index |= s[d] > 0 ? 1u << d : 0u;
    return index;
  };
  const int free_axes = static_cast<int>((side.array() == 0).count());
  Feature feature;
  if (free_axes == 0) {
    feature.kind = Feature::Kind::vertex;
    feature.first = vertex(side);
  } else if (free_axes == 1) {
    BoxSide low = side, high = side;
    for (int d = 0; d < 3; ++d) {
      if (side[d] == 0) low[d] = -1, high[d] = 1;
    }
    feature.kind = Feature::Kind::edge;
    feature.first = vertex(low);
    feature.second = vertex(high);
  } else {
    feature.kind = Feature::Kind::face;
    for (int d = 0; d < 3; ++d) {
      if (side[d] != 0) feature.first = static_cast<std::uint32_t>(2 * d + (side[d] > 0));
    }
  }
  return feature;
}

namespace detail {

SupportingFeature ShapeKind<Box>::support(const Box&, const PlacedShape& placed, const Vector3d& direction) {
  BoxSide side;
  for (int d = 0; d < 3; ++d) {
    const Vector3d& u = placed.half_axes[static_cast<std::size_t>(d)];
    const double along = dot(direction, u);
    side[d] = std::abs(along) <= parallel_sine * norm(u) ? 0 : (along > 0 ? 1 : -1);
  }
  SupportingFeature support{box_feature(side), {}};
  auto& vertices = support.vertices;
  vertices.reserve(4);  // a face has four
  vertices.push_back(Vector3d::Zero());
  for (int d = 0; d < 3; ++d) {
    const Vector3d& u = placed.half_axes[static_cast<std::size_t>(d)];
    if (side[d] != 0) {
      for (Vector3d& v : vertices) v += side[d] * u;
      continue;
    }
    // Out along -u, back along +u: the four corners of a face come in cyclic order.
    for (std::size_t i = vertices.size(); i-- > 0;) {
      vertices.push_back(vertices[i] + u);
      vertices[i] -= u;
    }
  }
  return support;
}

}  // namespace detail

}  // namespace kds::collision
