#include "collision/narrow_phase/segment_ways.hpp"

#include "collision/narrow_phase/nearest_point.hpp"
#include "collision/narrow_phase/time_spans.hpp"
#include "collision/narrow_phase/zonotope_cells.hpp"
#include "collision/vectors.hpp"

#include <cmath>

namespace kds::collision {
namespace {

using Eigen::Vector3d;

/// Calls visit(way) for several ways, among them the shortest, if the segment does not go through the triangle.
template <class Visit>
void every_way(const PlacedTriangle& triangle, const Vector3d& centre, const Vector3d& half, const Visit& visit) {
  for (const double end : {-1.0, 1.0}) {
    const Vector3d at = centre + end * half;
    const NearestPoint nearest = nearest_point(triangle, at);
    const Vector3d along =
        nearest.dimension == 2 ? accurate_cross(triangle.edge(0), triangle.edge(1)) : triangle.edge(nearest.index);
    visit(SegmentWay{at - nearest.point, nearest.dimension, along, triangle.vertices[nearest.index] - end * half, end});
  }
  const double square = dot(half, half);
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3d from = centre - triangle.vertices[i];
    const double part = -dot(from, half) / square;
    if (std::abs(part) < 1) visit(SegmentWay{from + part * half, 1, half, triangle.vertices[i], part});
    // Where both an edge and the segment are nearest within: the common perpendicular.
    const Vector3d edge = triangle.edge(i);
    const Vector3d normal = accurate_cross(edge, half);
    const double sine_square = dot(normal, normal);
    if (!(sine_square > 0)) continue;
    const double on_edge = dot(cross(from, half), normal) / sine_square;
    const double on_half = dot(cross(from, edge), normal) / sine_square;
    if (!(on_edge > 0 && on_edge < 1 && std::abs(on_half) < 1)) continue;
    const Vector3d out = unit(normal);
    visit(SegmentWay{dot(out, from) * out, 2, out, triangle.vertices[i], on_half});
  }
}

}  // namespace

SegmentWay shortest_way(const PlacedTriangle& triangle, const Vector3d& centre, const Vector3d& half) {
  double least = TimeSpans::infinity;
  SegmentWay best;
  every_way(triangle, centre, half, [&](const SegmentWay& way) {
    const double square = dot(way.apart, way.apart);
    if (square < least) {
      least = square;
      best = way;
    }
  });
  return best;
}

NearestStretch nearest_stretch(const PlacedTriangle& triangle, const Vector3d& centre, const Vector3d& half,
                               double tolerance) {
  const SegmentWay best = shortest_way(triangle, centre, half);
  const double enough = norm(best.apart) + tolerance;
  SegmentWay low = best, high = best;
  every_way(triangle, centre, half, [&](const SegmentWay& way) {
    if (norm(way.apart) > enough) return;
    if (way.part < low.part) low = way;
    if (way.part > high.part) high = way;
  });
  const Vector3d core = centre + (0.5 * (low.part + high.part)) * half;
  return {core, core - 0.5 * (low.apart + high.apart), low.part, high.part};
}

}  // namespace kds::collision
