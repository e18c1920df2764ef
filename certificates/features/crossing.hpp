// Proof that the origin passes through a patch, and until when.
#pragma once

#include "certificates/features/closest_point.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace kds::certificates {

/// The origin is close to a point inside the patch at s and comes closer: an s' > s before which it certainly goes
/// through, or nothing where that is not easily proved (the point is near the rim, or hardly comes closer).
///
/// Shortly before s and shortly after, the signed volume n . q0 has certain and opposite signs, so that the origin is in
/// the plane of the patch in between; and during that time it cannot reach the rim: the coordinates of its foot, as
/// numerators over |n|^2, are polynomials with |derivative| <= 128 R^3 V, where no corner is farther than R or faster
/// than V (n = u x v with |u|, |v| <= 2 R and |u'|, |v'| <= 2 V; x |n|^2 = n . (v x q0): 32 R^3 V; |n|^2: 64 R^3 V; and
/// |n|^2 less two of the former: 128 R^3 V). Roundings, of corners and of these formulas, are below what is added to
/// V w in the code: paths.error + 4 x 2^-53 size for each coordinate of a corner, so less than 3 paths.error for a
/// corner; at most 800 x 2^-53 R^4 in the numerators and 120 x 2^-53 R^3 in the volume.
template <Patch kind, int Degree>
class Crossing {
 public:
  Crossing(const PatchPaths<Degree>& paths, const Corners& corners, double s) : paths_(paths), corners_(corners), s_(s) {
    double r2 = 0;
    for (std::size_t k = 0; k < 4; ++k) r2 = std::max(r2, detail::corner(corners, k).squaredNorm());
    radius_ = std::sqrt(r2);
    Lanes fastest(0.0);
    for (std::size_t d = 0; d < 3; ++d) {
      Lanes v = absolute(paths.c[1][d]);
      if constexpr (Degree == 2) v = v + absolute(paths.c[2][d]) * Lanes(2.0);
      fastest = greater(fastest, v);
    }
    speed_ = 1.74 * highest(fastest);  // sqrt(3)
  }

  std::optional<double> until(const std::array<double, 4>& weights) const {
    const Frame now(corners_);
    const double n1 = now.n.norm();
    const auto v = paths_.velocity(s_);
    double closing = 0;
    for (std::size_t k = 0; k < 4; ++k) closing -= weights[k] * now.n.dot(detail::corner(v, k)) / n1;
    const double side = now.volume < 0 ? -1 : 1;
    closing *= side;
    const double noise = 64 * radius_ * radius_ * (paths_.error + 0x1p-46 * radius_);
    const double height = std::abs(now.volume) / n1;
    const double sure = 2 * noise / n1;
    if (!(closing > 0)) {
      if (!(height < sure)) return std::nullopt;
    }
    const double rate = std::abs(closing);
    const double begin = std::max(0.0, height > sure ? s_ : s_ - sure / rate);
    const double end = std::min(1.0, s_ + 1.5 * (height + sure) / rate);
    const double before = Frame(paths_.at(begin)).volume;
    const double after = Frame(paths_.at(end)).volume;
    const bool crosses = (before > noise && after < -noise) || (before < -noise && after > noise);
    if (!crosses || !inside(now, std::max(end - s_, s_ - begin))) return std::nullopt;
    return end;
  }

 private:
  struct Frame {
    Eigen::Vector3d u, v, n, q0;
    double volume;
    explicit Frame(const Corners& q)
        : u(detail::corner(q, 1) - detail::corner(q, 0)),
          v(detail::corner(q, kind == Patch::triangle ? 2 : 3) - detail::corner(q, 0)),
          n(u.cross(v)),
          q0(detail::corner(q, 0)),
          volume(n.dot(q0)) {}
  };

  bool inside(const Frame& now, double width) const {
    const double r = radius_ + speed_ * width;
    const double slack = 128 * r * r * r * (speed_ * width + 4 * paths_.error + 0x1p-44 * r);
    const double n2 = now.n.dot(now.n);
    const double x = now.n.dot(now.v.cross(now.q0));
    const double y = -now.n.dot(now.u.cross(now.q0));
    return x > slack && y > slack && (kind == Patch::triangle ? n2 - x - y > slack : n2 - std::max(x, y) > slack);
  }

  const PatchPaths<Degree>& paths_;
  const Corners& corners_;
  double s_;
  double radius_;
  double speed_;
};

}  // namespace kds::certificates
