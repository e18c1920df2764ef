#include "collision/narrow_phase/contact_patch.hpp"

#include "collision/shapes/support.hpp"
#include "collision/vectors.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace kds::collision {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

Vector3d mean(std::span<const Vector3d> points) {
  Vector3d sum = Vector3d::Zero();
  for (const Vector3d& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

/// The interval of the first of two parallel segments, from 0 to 1, that the second is beside; none if they are not
/// parallel.
std::optional<std::pair<double, double>> shared_stretch(const Vector3d& p0, const Vector3d& p1, const Vector3d& q0,
                                                        const Vector3d& q1) {
  const Vector3d u = p1 - p0;
  const Vector3d v = q1 - q0;
  const Vector3d w = p0 - q0;
  const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), uw = dot(u, w);
  if (uu * vv - uv * uv > parallel_sine * uu * vv) return std::nullopt;
  const double q_start = -uw / uu;
  const double q_stop = q_start + uv / uu;
  return std::pair(std::max(0.0, std::min(q_start, q_stop)), std::min(1.0, std::max(q_start, q_stop)));
}

/// Halfway between the closest points of two segments; for parallel ones, in the middle of their common stretch.
Vector3d between_segments(const Vector3d& p0, const Vector3d& p1, const Vector3d& q0, const Vector3d& q1) {
  const Vector3d u = p1 - p0;
  const Vector3d v = q1 - q0;
  const Vector3d w = p0 - q0;
  if (const auto stretch = shared_stretch(p0, p1, q0, q1)) {
    return p0 + u * std::clamp(0.5 * (stretch->first + stretch->second), 0.0, 1.0);
  }
  const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), uw = dot(u, w), vw = dot(v, w);
  const double determinant = uu * vv - uv * uv;
  double s = std::clamp((uv * vw - vv * uw) / determinant, 0.0, 1.0);
  const double t = std::clamp((uv * s + vw) / vv, 0.0, 1.0);
  s = std::clamp((uv * t - uw) / uu, 0.0, 1.0);
  return 0.5 * (p0 + u * s + q0 + v * t);
}

/// Two directions that complete the normal to a right-handed frame.
std::pair<Vector3d, Vector3d> tangents(const Vector3d& normal) {
  int smallest = 0;
  normal.cwiseAbs().minCoeff(&smallest);
  const Vector3d first = normalized(cross(normal, Vector3d::Unit(smallest)));
  return {first, cross(normal, first)};
}

/// Cuts a polygon or segment with the half plane left of the line from `from` to `to`, seen along the normal.
std::vector<Vector3d> clip(const std::vector<Vector3d>& polygon, const Vector3d& from, const Vector3d& inward) {
  std::vector<Vector3d> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector3d& here = polygon[i];
    const Vector3d& next = polygon[(i + 1) % polygon.size()];
    const double d_here = dot(inward, here - from);
    const double d_next = dot(inward, next - from);
    if (d_here >= 0) kept.push_back(here);
    if ((d_here < 0) != (d_next < 0)) kept.push_back(here + (next - here) * (d_here / (d_here - d_next)));
  }
  return kept;
}

std::vector<Vector3d> moved_by(std::span<const Vector3d> points, const Vector3d& offset) {
  std::vector<Vector3d> moved(points.begin(), points.end());
  for (Vector3d& p : moved) p += offset;
  return moved;
}

/// The intersection of a segment or polygon with a polygon, seen along the normal. If it is empty, since rounding has
/// just separated them, all of the polygon.
std::vector<Vector3d> shared(std::vector<Vector3d> cut, std::vector<Vector3d> window, const Vector3d& normal) {
  if (window.size() == 2) std::swap(cut, window);
  const auto [first, second] = tangents(normal);
  double area = 0;
  for (std::size_t i = 0; i < window.size(); ++i) {
    const Vector3d& p = window[i];
    const Vector3d& q = window[(i + 1) % window.size()];
    area += dot(first, p) * dot(second, q) - dot(first, q) * dot(second, p);
  }
  const double turn = area < 0 ? -1.0 : 1.0;
  for (std::size_t i = 0; i < window.size() && !cut.empty(); ++i) {
    const Vector3d along = window[(i + 1) % window.size()] - window[i];
    cut = clip(cut, window[i], turn * cross(normal, along));
  }
  return cut.empty() ? window : cut;
}

}  // namespace

Vector3d patch_centre(std::span<const Vector3d> a, std::span<const Vector3d> b, const Vector3d& offset,
                      const Vector3d& normal) {
  if (a.size() == 1) return a[0];
  if (b.size() == 1) return b[0] + offset;
  const std::vector<Vector3d> moved = moved_by(b, offset);
  if (a.size() == 2 && moved.size() == 2) return between_segments(a[0], a[1], moved[0], moved[1]);
  return mean(shared({a.begin(), a.end()}, moved, normal));
}

std::vector<Vector3d> patch_corners(std::span<const Vector3d> a, std::span<const Vector3d> b, const Vector3d& offset,
                                    const Vector3d& normal) {
  if (a.size() == 1 || b.size() == 1) return {patch_centre(a, b, offset, normal)};
  const std::vector<Vector3d> moved = moved_by(b, offset);
  if (a.size() > 2 || moved.size() > 2) return shared({a.begin(), a.end()}, moved, normal);
  const auto stretch = shared_stretch(a[0], a[1], moved[0], moved[1]);
  if (!stretch) return {between_segments(a[0], a[1], moved[0], moved[1])};
  return {a[0] + (a[1] - a[0]) * stretch->first, a[0] + (a[1] - a[0]) * stretch->second};
}

}  // namespace kds::collision
