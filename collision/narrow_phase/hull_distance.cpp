#include "collision/narrow_phase/hull_distance.hpp"

#include <limits>

namespace kds::collision::detail {
namespace {

using Eigen::Vector3d;

/// The point nearest to the origin of the line, plane or space that the first `count` of some points span, and the
/// weights with which it is their sum. False if one is not positive: then that point is not between them.
bool nearest_inside(const std::array<Vector3d, 4>& p, std::size_t count, Vector3d& nearest,
                    std::array<double, 4>& weights) {
  if (count == 1) {
    nearest = p[0];
    weights[0] = 1;
    return true;
  }
  const Vector3d u = p[1] - p[0];
  if (count == 2) {
    const double part = -dot(p[0], u) / squared_norm(u);
    nearest = p[0] + part * u;
    weights = {1 - part, part};
    return part > 0 && part < 1;
  }
  const Vector3d v = p[2] - p[0], n = cross(u, v);
  if (count == 3) {
    const double square = squared_norm(n);
    const double of_v = dot(cross(p[0], u), n) / square;
    const double of_u = dot(cross(v, p[0]), n) / square;
    nearest = n * (dot(n, p[0]) / square);
    weights = {1 - (of_u + of_v), of_u, of_v};
    return of_u > 0 && of_v > 0 && of_u + of_v < 1;
  }
  const Vector3d w = p[3] - p[0];
  const double volume = dot(n, w);
  const double of_w = -dot(n, p[0]) / volume;
  const double of_u = -dot(cross(v, w), p[0]) / volume;
  const double of_v = -dot(cross(w, u), p[0]) / volume;
  weights = {1 - (of_u + of_v + of_w), of_u, of_v, of_w};
  // Of points that are in a plane but for roundings the weights are any numbers: then they make another point.
  constexpr double rounding = 0x1p-40;
  nearest = Vector3d::Zero();
  double size = 0;
  for (std::size_t i = 0; i < 4; ++i) nearest += weights[i] * p[i], size = std::max(size, squared_norm(p[i]));
  if (squared_norm(nearest) <= rounding * rounding * size) nearest = Vector3d::Zero();
  return of_u > 0 && of_v > 0 && of_w > 0 && of_u + of_v + of_w < 1;
}

}  // namespace

NearestOfSimplex nearest_with_last(const std::array<Vector3d, 4>& points, std::size_t count) {
  double least = std::numeric_limits<double>::infinity();
  NearestOfSimplex best{points[count - 1], 0, {}};
  for (unsigned set = 1u << (count - 1); set < 1u << count; ++set) {  // those with the last point
    std::array<Vector3d, 4> some;
    some.fill(points[0]);
    std::size_t size = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (set >> i & 1) some[size++] = points[i];
    }
    NearestOfSimplex here{points[0], set, {}};
    if (!nearest_inside(some, size, here.point, here.weights) || !(squared_norm(here.point) < least)) continue;
    least = squared_norm(here.point);
    best = here;
  }
  return best;
}

}  // namespace kds::collision::detail
