#include "collision/narrow_phase/near_spans.hpp"

namespace kds::collision {

using Eigen::Vector3d;

TimeSpans near_spans(const std::array<Vector3d, 2>& s, const std::array<double, 2>& g, double) {
  const auto [g0, g1] = g;
  const double c2 = dot(s[1], s[1]) - g1 * g1;
  const double half_c1 = dot(s[0], s[1]) - g0 * g1;
  if (!(c2 > 0)) {
    // At rest, or so slow that the distance is known no better than the margin: moving along an edge.
    const double distance = std::sqrt(dot(s[0], s[0]));
    return negative_spans((distance - g0) * (distance + g0), 2 * half_c1, c2);
  }
  const double nearest = -half_c1 / c2;
  const Vector3d place = place_on(s, nearest);
  const double radius = g0 + g1 * nearest;
  const double distance = std::sqrt(dot(place, place));
  if (!(distance < radius)) return {};
  const double half = std::sqrt((radius - distance) * (radius + distance) / c2);
  return TimeSpans::between(nearest - half, nearest + half);
}

TimeSpans near_spans(const std::array<Vector3d, 3>& s, const std::array<double, 3>& g, double horizon) {
  return DistanceQuartic(s, g).negative(horizon);
}

}  // namespace kds::collision
