// The point of a flat patch that is closest to the origin.
#pragma once

#include "certificates/features/patch_paths.hpp"
#include "certificates/vectors.hpp"

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

/// Squared sines of the angle between two sides of a patch. Above the first the place of a foot follows from squared
/// lengths (to 2^-32 of a side); above the second from the normal (to 2^-8); flatter patches are taken for their edges,
/// which is off by 2^-45 of a side. Nothing wrong follows from a bad foot (any direction is a valid axis to try, any
/// point of the patch a valid bound on the distance): only more steps.
inline constexpr double flat_patch = 0x1p-20;
inline constexpr double flattest_patch = 0x1p-90;

namespace detail {

inline Lanes dot(const Corners& a, const Corners& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Lanes dot(const Eigen::Vector3d& a, const Corners& b) {
  return Lanes(a[0]) * b[0] + Lanes(a[1]) * b[1] + Lanes(a[2]) * b[2];
}
inline Eigen::Vector3d weighted(const Corners& q, const std::array<double, 4>& w) {
  const Lanes weights(w[0], w[1], w[2], w[3]);
  Eigen::Vector3d p;
  for (int d = 0; d < 3; ++d) {
    const Lanes x = q[static_cast<std::size_t>(d)] * weights;
    p[d] = (x[0] + x[1]) + (x[2] + x[3]);
  }
  return p;
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
    u_ = detail::corner(e_, 0);
    v_ = -detail::corner(e_, last);
    n_ = cross(u_, v_);
    n2_ = dot(n_, n_);
  }

  PatchPoint closest() const {
    const double uu = squared_[0];
    const double vv = squared_[last];
    if (n2_ > flat_patch * uu * vv) {
      const double uv = dot(u_, v_);
      const double fu = falling_[0];
      const double fv = -dot(v_, detail::corner(q_, 0));
      if (inside(vv * fu - uv * fv, uu * fv - uv * fu, n2_)) {
        const double height = volume();
        return {n_ * (height / n2_), height * height / n2_, PatchPart::interior, 0, 0};
      }
    } else if (n2_ > flattest_patch * uu * vv) {
      return closest_of_flat();
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
      return corner_weights(interior_place());
    }
    return w;
  }

  /// The point of the patch with these weights.
  Eigen::Vector3d position(const std::array<double, 4>& w) const { return detail::weighted(q_, w); }

  const Corners& corners() const { return q_; }

  /// The closest directions of all parts of the patch, each made perpendicular to the edge it belongs to once more.
  ///
  /// A closest point is computed to some roundings of the size, and as a direction it is off by as much over the
  /// distance: below a distance of 2^-26 sizes that can be too much for an axis across an edge as long as the size.
  /// What is left of the product with the edge after it has been taken off is a rounding of the axis itself.
  std::array<Eigen::Vector3d, 9> careful_axes() const {
    std::array<Eigen::Vector3d, 9> axes;
    for (std::size_t k = 0; k < 4; ++k) {
      const Eigen::Vector3d e = detail::corner(e_, k);
      axes[k] = detail::corner(q_, k);
      axes[4 + k] = across(across(axes[k], e), e);
    }
    axes[8] = across(n_, squared_[0] > squared_[last] ? u_ : v_);
    if (dot(axes[8], axes[0]) < 0) axes[8] = -axes[8];
    return axes;
  }

  /// The patch is q0 + x u + y v, with x, y >= 0 and x + y <= 1 or x, y <= 1; this is u x v, of length n.
  const Eigen::Vector3d& normal() const { return n_; }
  double squared_normal() const { return n2_; }
  /// n . q0: six times the volume of the tetrahedron of the four points, up to its sign.
  double volume() const { return dot(n_, detail::corner(q_, 0)); }

  /// For the foot q0 + x u + y v of the origin: x and y, times |n|^2.
  std::array<double, 2> foot() const {
    const Eigen::Vector3d q0 = detail::corner(q_, 0);
    return {dot(n_, cross(v_, q0)), -dot(n_, cross(u_, q0))};
  }

 private:
  // The edge that ends in corner 0.
  static constexpr std::size_t last = kind == Patch::triangle ? 2 : 3;

  static std::array<double, 4> corner_weights(const std::array<double, 2>& place) {
    const auto [x, y] = place;
    if (kind == Patch::triangle) return {1 - x - y, x, y, 0};
    return {(1 - x) * (1 - y), x * (1 - y), x * y, (1 - x) * y};
  }

  /// n less its part along e.
  static Eigen::Vector3d across(const Eigen::Vector3d& n, const Eigen::Vector3d& e) {
    const double squared = dot(e, e);
    return squared > 0 ? n - e * (dot(n, e) / squared) : n;
  }

  static bool inside(double x, double y, double n2) {
    return x >= 0 && y >= 0 && (kind == Patch::triangle ? x + y <= n2 : std::max(x, y) <= n2);
  }

  /// x and y of the foot, inside. In flat patches its error is along the sides, and a step along the longer one
  /// takes that out.
  std::array<double, 2> interior_place() const {
    auto [x, y] = foot();
    x /= n2_;
    y /= n2_;
    const Eigen::Vector3d p = detail::corner(q_, 0) + x * u_ + y * v_;
    if (squared_[0] > squared_[last]) {
      x -= dot(p, u_) / squared_[0];
    } else {
      y -= dot(p, v_) / squared_[last];
    }
    x = std::clamp(x, 0.0, 1.0);
    y = std::clamp(y, 0.0, kind == Patch::triangle ? 1 - x : 1.0);
    return {x, y};
  }

  /// The interior counts only as far as a point of the patch is really closer than the edges.
  PatchPoint closest_of_flat() const {
    const PatchPoint on_edges = closest_on_edges();
    const auto [x, y] = foot();
    if (!inside(x, y, n2_)) return on_edges;
    const Eigen::Vector3d& longer = squared_[0] > squared_[last] ? u_ : v_;
    PatchPoint point{across(n_, longer) * (volume() / n2_), 0, PatchPart::interior, 0, 0};
    const double distance = squared_norm(position(corner_weights(interior_place())));
    if (!(distance < on_edges.squared_distance)) return on_edges;
    point.squared_distance = distance;
    return point;
  }

  PatchPoint closest_on_edges() const {
    const Lanes zero(0.0);
    const Lanes t = where_greater(squared_, zero, lesser(greater(falling_ / squared_, zero), Lanes(1.0)), zero);
    Corners p;
    for (std::size_t d = 0; d < 3; ++d) p[d] = q_[d] + e_[d] * t;
    const Lanes distance = detail::dot(p, p);
    const double least = lowest(distance);
    // The first of them; no branch, for it would be as often wrong as right.
    const std::size_t k = distance[0] <= least ? 0 : (distance[1] <= least ? 1 : (distance[2] <= least ? 2 : 3));
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
  Eigen::Vector3d u_, v_, n_;
  double n2_;
};

}  // namespace kds::certificates
