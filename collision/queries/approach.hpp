// When two paths are nearest to each other.
#pragma once

#include "certificates/point_motion.hpp"
#include "collision/degrees.hpp"

namespace kds::collision {

/// When two centres are nearest to each other, and how far apart then.
struct Approach {
  double time;      ///< s
  double distance;  ///< between the centres, not the surfaces; rounded
};

/// Of two paths in [from, until]. The time is `from`, `until`, or the first double just after which they part, by the
/// exact sign of the derivative of their distance; where there are several such, that of the least distance as doubles
/// tell it, the first of equal ones. Two that keep their distance are nearest at once. Throws std::invalid_argument
/// unless from <= until, both finite. Cost: some failure times of degree 2 Degree - 1 (kds/roots/failure_time.hpp).
template <int Degree>
Approach closest_approach(const certificates::PointMotion<Degree>& a, const certificates::PointMotion<Degree>& b,
                          double from, double until);

#define KDS_DECLARE(degree)                                                           \
  extern template Approach closest_approach(const certificates::PointMotion<degree>&, \
                                            const certificates::PointMotion<degree>&, double, double);
KDS_FOR_ALL_DEGREES(KDS_DECLARE)
#undef KDS_DECLARE

}  // namespace kds::collision
