#include "collision/narrow_phase/nearest_point.hpp"

#include "collision/narrow_phase/time_spans.hpp"
#include "collision/vectors.hpp"

namespace kds::collision {

using Eigen::Vector3d;

NearestPoint nearest_point(const PlacedTriangle& triangle, const Vector3d& to) {
  const auto& v = triangle.vertices;
  const Vector3d normal = unit(cross(triangle.edge(0), triangle.edge(1)));
  bool inside = true;
  NearestPoint best{v[0], 0, 0};
  double least = TimeSpans::infinity;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3d edge = triangle.edge(i);
    const Vector3d d = to - v[i];
    inside = inside && dot(cross(normal, edge), d) > 0;
    const double along = dot(edge, d);
    const double length = dot(edge, edge);
    NearestPoint candidate{v[i], 0, i};
    if (along >= length) {
      candidate = {v[(i + 1) % 3], 0, (i + 1) % 3};
    } else if (along > 0) {
      candidate = {v[i] + (along / length) * edge, 1, i};
    }
    const Vector3d apart = to - candidate.point;
    const double distance = dot(apart, apart);
    if (distance < least) {
      least = distance;
      best = candidate;
    }
  }
  if (inside) return {to - dot(normal, to - v[0]) * normal, 2, 0};
  return best;
}

}  // namespace kds::collision
