// How near two features are at a time, and whether they approach.
#pragma once

#include "certificates/features/closest_point.hpp"
#include "certificates/features/feature_contact.hpp"
#include "certificates/features/fixed_axis.hpp"
#include "certificates/features/patch_paths.hpp"
#include "collision/vectors.hpp"

#include <Eigen/Core>

#include <cmath>
#include <cstddef>

namespace kds::collision {

/// Two features at a time, as if they touched there.
struct FeatureNearness {
  certificates::FeatureContact touch;
  double gap;    ///< beyond the thickness, rounded; units of length
  double rate;   ///< of the gap, as the stretch of time goes by: units of length
  double noise;  ///< a greater rate, of either sign, has the sign of the rate meant
  double size;   ///< of the pair (ContactTolerance)
};

/// At the part s of the stretch of time, which is t. `uncertainty`: how far the coordinates of both may be off in all.
template <certificates::Patch patch, int Degree>
FeatureNearness nearness_at(const certificates::ControlPoints<Degree>& control, double s, double t, double thickness,
                            double uncertainty) {
  const auto paths = certificates::patch_paths<patch, Degree>(control);
  const certificates::PlacedPatch<patch> placed(paths.at(s));
  const auto point = placed.closest();
  const auto w = placed.weights(point);
  FeatureNearness result{};
  certificates::FeatureContact& touch = result.touch;
  touch.status = certificates::FeatureContactStatus::at_start;
  touch.time = t;
  touch.distance = std::sqrt(point.squared_distance);
  if constexpr (patch == certificates::Patch::triangle) {
    touch.weights = {1, w[0] + w[3], w[1], w[2]};
  } else {
    touch.weights = {w[0] + w[3], w[1] + w[2], w[0] + w[1], w[2] + w[3]};
  }
  const auto rates = paths.velocity(s);
  const auto rate_along = [&](const Eigen::Vector3d& n) {
    double rate = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      for (std::size_t d = 0; d < 3; ++d) rate += n[static_cast<Eigen::Index>(d)] * rates[d][k] * w[k];
    }
    return rate;
  };
  // Of what touches the direction is lost in roundings: then it is across both features.
  touch.normal = normalized(point.position);
  if (!(touch.distance > 64 * certificates::axis_margin(paths, 0))) {
    const Eigen::Vector3d n = normalized(placed.normal());
    touch.normal = rate_along(n) > 0 ? Eigen::Vector3d(-n) : n;
    if (!(squared_norm(n) > 0)) touch.normal = Eigen::Vector3d::UnitX();
  }
  result.gap = touch.distance - thickness;
  result.rate = rate_along(touch.normal);
  // Some tens of roundings of coordinates, and what both ends of the paths may be off.
  result.noise = 0x1p-46 * paths.size + 4 * (paths.error + 1.74 * uncertainty);
  result.size = paths.size;
  return result;
}

}  // namespace kds::collision
