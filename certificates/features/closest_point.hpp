// The point of a flat patch that is closest to the origin.
#pragma once

#include "certificates/features/patch_paths.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cstdint>

namespace kds::certificates {

/// What of a patch a point lies on.
enum class PatchPart : std::uint8_t { interior, edge, corner };

/// A point of a patch at one time.
struct PatchPoint {
  Eigen::Vector3d position;  ///< from the origin; as a direction of the second feature seen from the first, turned
  double squared_distance;
  PatchPart part;
  std::uint8_t corner;  ///< the corner, or the first one of the edge; edges go from k to k + 1 mod 4
  double along;         ///< 0 ... 1 on an edge
};

/// Interior points are found by the normal only where the squared sine of the angle between the two sides is above
/// this; flatter patches are taken for their edges, which is off by less than 2^-20 of a side. Nothing wrong follows
/// (any direction is a valid axis to try, any point of the patch a valid bound on the distance): only steps.
inline constexpr double flattest_patch = 0x1p-40;

namespace detail {

inline Lanes dot(const Corners& a, const Corners& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Lanes dot(const Eigen::Vector3d& a, const Corners& b) {
  return Lanes(a[0]) * b[0] + Lanes(a[1]) * b[1] + Lanes(a[2]) * b[2];
}
inline Eigen::Vector3d corner(const Corners& q, std::size_t k) { return {q[0][k], q[1][k], q[2][k]}; }

}  // namespace detail

/// The sides of a patch at one time, and where the origin lies over it.
template <Patch kind>
class PlacedPatch {
 public:
  explicit PlacedPatch(const Corners& q) : q_(q) {
    for (std::size_t d = 0; d < 3; ++d) e_[d] = next(q[d]) - q[d];
    squared_ = detail::dot(e_, e_);
    falling_ = -detail::dot(q, e_);
  }

  PatchPoint closest() const {
    // The interior, which is q0 + x u + y v: by the normal u x v.
    const Eigen::Vector3d u = detail::corner(e_, 0);
    const Eigen::Vector3d v = -detail::corner(e_, last);
    const Eigen::Vector3d n = u.cross(v);
    const double n2 = n.dot(n);
    const double uu = squared_[0];
    const double vv = squared_[last];
    if (n2 > flattest_patch * uu * vv) {
      const Eigen::Vector3d q0 = detail::corner(q_, 0);
      const double uv = u.dot(v);
      const double fu = falling_[0];
      const double fv = -v.dot(q0);
      const double x = vv * fu - uv * fv;
      const double y = uu * fv - uv * fu;
      if (x >= 0 && y >= 0 && (kind == Patch::triangle ? x + y <= n2 : std::max(x, y) <= n2)) {
        const double height = n.dot(q0);
        return {n * (height / n2), height * height / n2, PatchPart::interior, 0, 0};
      }
    }
    return closest_on_edges();
  }

  /// The weights of the corners that make up a point. Never negative; their sum is 1 up to rounding.
  std::array<double, 4> weights(const PatchPoint& p) const {
    std::array<double, 4> w{};
    if (p.part == PatchPart::corner) {
      w[p.corner] = 1;
    } else if (p.part == PatchPart::edge) {
      w[p.corner] = 1 - p.along;
      w[(p.corner + 1U) % 4] = p.along;
    } else {
      const Eigen::Vector3d u = detail::corner(e_, 0);
      const Eigen::Vector3d v = -detail::corner(e_, last);
      const Eigen::Vector3d n = u.cross(v);
      const Eigen::Vector3d q0 = detail::corner(q_, 0);
      const double n2 = n.dot(n);
      const double x = std::clamp(n.dot(v.cross(q0)) / n2, 0.0, 1.0);
      const double y = std::clamp(-n.dot(u.cross(q0)) / n2, 0.0, kind == Patch::triangle ? 1 - x : 1.0);
      if (kind == Patch::triangle) {
        w = {1 - x - y, x, y, 0};
      } else {
        w = {(1 - x) * (1 - y), x * (1 - y), x * y, (1 - x) * y};
      }
    }
    return w;
  }

  const Corners& corners() const { return q_; }
  Eigen::Vector3d plane_normal() const { return detail::corner(e_, 0).cross(-detail::corner(e_, last)); }

 private:
  // The edge that ends in corner 0.
  static constexpr std::size_t last = kind == Patch::triangle ? 2 : 3;

  PatchPoint closest_on_edges() const {
    const Lanes zero(0.0);
    const Lanes t = where_greater(squared_, zero, lesser(greater(falling_ / squared_, zero), Lanes(1.0)), zero);
    Corners p;
    for (std::size_t d = 0; d < 3; ++d) p[d] = q_[d] + e_[d] * t;
    const Lanes distance = detail::dot(p, p);
    const double least = lowest(distance);
    std::size_t k = 0;
    while (k < 3 && !(distance[k] <= least)) ++k;
    const double along = t[k];
    if (along > 0 && along < 1) {
      return {detail::corner(p, k), least, PatchPart::edge, static_cast<std::uint8_t>(k), along};
    }
    const auto corner = static_cast<std::uint8_t>((along > 0 ? k + 1 : k) % 4);
    return {detail::corner(p, k), least, PatchPart::corner, corner, 0};
  }

  Corners q_;
  Corners e_;      // edge k leads from corner k to the next
  Lanes squared_;  // |e|^2
  Lanes falling_;  // -q . e
};

}  // namespace kds::certificates
