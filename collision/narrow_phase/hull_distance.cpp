#include "collision/narrow_phase/hull_distance.hpp"

#include <algorithm>
#include <limits>

namespace kds::collision::detail {
namespace {

/// The weights with which the point nearest to the origin of the line, plane or space that the first `count` of some
/// points span is their sum. False if one is not positive: then that point is not between them.
bool nearest_inside(const std::array<Eigen::Vector3d, 4>& p, std::size_t count, std::array<double, 4>& weights) {
  const Eigen::Vector3d u = p[1] - p[0], v = p[2] - p[0], w = p[3] - p[0];
  if (count == 1) {
    weights[0] = 1;
    return true;
  }
  if (count == 2) {
    weights[1] = -dot(p[0], u) / squared_norm(u);
  } else if (count == 3) {
    const Eigen::Vector3d n = cross(u, v);
    const double square = squared_norm(n);
    weights[1] = dot(cross(v, p[0]), n) / square;
    weights[2] = dot(cross(p[0], u), n) / square;
  } else {
    const double volume = dot(cross(u, v), w);
    weights[1] = -dot(cross(v, w), p[0]) / volume;
    weights[2] = -dot(cross(w, u), p[0]) / volume;
    weights[3] = -dot(cross(u, v), p[0]) / volume;
  }
  weights[0] = 1;
  bool between = true;
  for (std::size_t i = 1; i < count; ++i) {
    weights[0] -= weights[i];
    between = between && weights[i] > 0;
  }
  return between && weights[0] > 0;
}

}  // namespace

NearestOfSimplex nearest_of_simplex(const std::array<Eigen::Vector3d, 4>& points, std::size_t count) {
  constexpr double roundings = 0x1p-46;  // within which four points around the origin have it inside, of their size
  double least = std::numeric_limits<double>::infinity();
  NearestOfSimplex best{points[0], 0, {}};
  for (unsigned set = 1; set < 1u << count; ++set) {
    std::array<Eigen::Vector3d, 4> some;
    some.fill(points[0]);
    std::size_t size = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (set >> i & 1) some[size++] = points[i];
    }
    std::array<double, 4> weights{};
    if (!nearest_inside(some, size, weights)) continue;
    Eigen::Vector3d nearest = Eigen::Vector3d::Zero();
    double extent = 0;
    for (std::size_t i = 0; i < size; ++i) {
      nearest += weights[i] * some[i];
      extent = std::max(extent, some[i].cwiseAbs().maxCoeff());
    }
    if (size == 4 && nearest.cwiseAbs().maxCoeff() <= roundings * extent) nearest.setZero();
    if (!(squared_norm(nearest) < least)) continue;
    least = squared_norm(nearest);
    best = {nearest, set, weights};
  }
  return best;
}

}  // namespace kds::collision::detail
