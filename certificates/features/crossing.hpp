// Proof that the origin passes through a patch, and until when.
#pragma once

#include "certificates/features/closest_point.hpp"
#include "certificates/features/turning_axis.hpp"
#include "certificates/vectors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace kds::certificates {

/// The origin is close to a point inside the patch at s and comes closer: an s' > s before which it certainly goes
/// through, or nothing where that is not easily proved (the point is near the rim, or hardly comes closer).
///
/// Shortly before s and shortly after, the signed volume n . q0 has certain and opposite signs (by the polynomial that
/// TurningAxis bounds; Horner's rule adds at most 2 x 6 roundings of its norm), so that the origin is in the plane of
/// the patch in between; and during that time it cannot reach the rim: the coordinates of its foot, as
/// numerators over |n|^2, are polynomials with |derivative| <= 128 R^3 V, where no corner is farther than R or faster
/// than V (n = u x v with |u|, |v| <= 2 R and |u'|, |v'| <= 2 V; x |n|^2 = n . (v x q0): 32 R^3 V; |n|^2: 64 R^3 V; and
/// |n|^2 less two of the former: 128 R^3 V). Roundings, of corners and of these formulas, are below what is added to
/// V w in the code: paths.error + 4 x 2^-53 size for each coordinate of a corner, so less than 3 paths.error for a
/// corner; at most 800 x 2^-53 R^4 in the numerators.
template <Patch kind, int Degree>
class Crossing {
 public:
  Crossing(const PatchPaths<Degree>& paths, const TurningAxis<kind, Degree>& turning, const PlacedPatch<kind>& now,
           double s)
      : paths_(paths), turning_(turning), now_(now), s_(s) {
    radius_ = std::sqrt(highest(detail::dot(now.corners(), now.corners())));
    Lanes fastest(0.0);
    for (std::size_t d = 0; d < 3; ++d) {
      Lanes v = magnitude(paths.c[1][d]);
      if constexpr (Degree == 2) v = v + magnitude(paths.c[2][d]) * Lanes(2.0);
      fastest = greater(fastest, v);
    }
    speed_ = 1.74 * highest(fastest);  // sqrt(3)
  }

  std::optional<double> until(const std::array<double, 4>& weights) const {
    const double inverse = 1 / std::sqrt(now_.squared_normal());
    const double volume = now_.volume();
    const Eigen::Vector3d velocity = detail::weighted(paths_.velocity(s_), weights);
    const double across = dot(now_.normal(), velocity);
    const double closing = (volume < 0 ? across : -across) * inverse;
    const double noise = turning_.volume_error() + 0x1p-48 * norm(turning_.volume());
    const double height = std::abs(volume) * inverse;
    const double sure = 2 * noise * inverse;
    if (!(closing > 0 || height < sure)) return std::nullopt;
    const double pace = 1 / std::abs(closing);
    const double begin = std::max(0.0, height > sure ? s_ : s_ - sure * pace);
    const double end = std::min(1.0, s_ + 1.5 * (height + sure) * pace);
    const double before = turning_.volume()(begin);
    const double after = turning_.volume()(end);
    const bool crosses = (before > noise && after < -noise) || (before < -noise && after > noise);
    if (!crosses || !inside(std::max(end - s_, s_ - begin))) return std::nullopt;
    return end;
  }

 private:
  bool inside(double width) const {
    const double r = radius_ + speed_ * width;
    const double slack = 128 * r * r * r * (speed_ * width + 4 * paths_.error + 0x1p-44 * r);
    const double n2 = now_.squared_normal();
    const auto [x, y] = now_.foot();
    return x > slack && y > slack && (kind == Patch::triangle ? n2 - x - y > slack : n2 - std::max(x, y) > slack);
  }

  const PatchPaths<Degree>& paths_;
  const TurningAxis<kind, Degree>& turning_;
  const PlacedPatch<kind>& now_;
  double s_;
  double radius_;
  double speed_;
};

}  // namespace kds::certificates
