// Motion of a point in space that has a weight.
#pragma once

#include "certificates/point_motion.hpp"
#include "kds/motion.hpp"

#include <cmath>

namespace kds::certificates {

/// A path, and a weight that is a polynomial in the time since the path's start; for a ball the square of its radius.
template <int Degree, int WeightDegree = 0>
struct WeightedPoint {
  static constexpr int degree = Degree;
  static_assert(WeightDegree <= 2 * Degree, "the certificates' degree leaves room for weights of twice the paths'");

  PointMotion<Degree> path;
  Polynomial<WeightDegree> weight_since_start;  ///< length^2, length^2/s ...

  Motion<Degree> axis(int d) const { return path.axis(d); }
  Motion<WeightDegree> weight() const { return {weight_since_start, path.start}; }

  bool finite() const { return path.finite() && is_finite(weight()); }
  friend bool operator==(const WeightedPoint&, const WeightedPoint&) = default;
};

/// The same motion restarted at t, equal up to the rounding of its new coefficients.
template <int Degree, int WeightDegree>
WeightedPoint<Degree, WeightDegree> restarted(const WeightedPoint<Degree, WeightDegree>& point, double t) {
  return {point.path.restarted(t), kds::restarted(point.weight(), t).position};
}

/// The same motion in time that runs backwards, exactly: see Motion.
template <int Degree, int WeightDegree>
WeightedPoint<Degree, WeightDegree> reversed(const WeightedPoint<Degree, WeightDegree>& point) {
  return {reversed(point.path), mirrored(point.weight_since_start)};
}

/// For snapshots (kds/framework/snapshot.hpp).
template <class Archive, int Degree, int WeightDegree>
void archive_members(Archive& archive, WeightedPoint<Degree, WeightDegree>& point) {
  archive(point.path, point.weight_since_start);
}

}  // namespace kds::certificates
