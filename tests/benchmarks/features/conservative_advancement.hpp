// A contender: steps of the distance over the greatest relative speed.
#pragma once

#include "certificates/features/closest_point.hpp"
#include "tests/certificates/feature_queries.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace kds::benchmarks {

/// Paper: [Li21], additive continuous collision detection: a common velocity taken off, then steps of nine tenths of
/// the distance over the greatest relative speed, until the distance is below the tolerance. Plain doubles. The closest
/// points are those of the library, so that the difference is the steps alone.
class ConservativeAdvancement {
 public:
  static std::optional<double> first_contact(tests::Features kind, const std::array<Eigen::Vector3d, 4>& begin,
                                             const std::array<Eigen::Vector3d, 4>& end) {
    using certificates::Patch;
    return kind == tests::Features::vertex_face ? search<Patch::triangle>(begin, end)
                                                : search<Patch::parallelogram>(begin, end);
  }

 private:
  static constexpr double tolerance = 1e-6;  // of the size, as the library's default
  static constexpr int most_steps = 10000;

  template <certificates::Patch kind>
  static std::optional<double> search(const std::array<Eigen::Vector3d, 4>& begin,
                                      const std::array<Eigen::Vector3d, 4>& end) {
    const auto paths = certificates::patch_paths<kind, 1>({begin, end});
    std::array<Eigen::Vector3d, 4> step;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < 4; ++k) mean += 0.25 * (step[k] = end[k] - begin[k]);
    const auto speed = [&](std::size_t k) { return (step[k] - mean).norm(); };
    const double relative = kind == certificates::Patch::triangle
                                ? speed(0) + std::max({speed(1), speed(2), speed(3)})
                                : std::max(speed(0), speed(1)) + std::max(speed(2), speed(3));
    double t = 0;
    for (int i = 0; i < most_steps; ++i) {
      const certificates::PlacedPatch<kind> patch(paths.at(t));
      const double distance = std::sqrt(patch.closest().squared_distance);
      if (distance <= tolerance * paths.size) return t;
      t += 0.9 * distance / relative;
      if (!(t <= 1)) return std::nullopt;
    }
    return t;
  }
};

}  // namespace kds::benchmarks
