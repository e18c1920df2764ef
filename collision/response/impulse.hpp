// How an impulse along a normal changes two velocities, such that rounding errors do not add up.
#pragma once

#include "kds/arithmetic/double_double.hpp"

#include <Eigen/Core>

#include <algorithm>

namespace kds::collision {

/// |v|^2 - 1 for a vector that is a unit vector up to rounding, to 2^-100.
inline double excess_of_unit(const Eigen::Vector3d& v) {
  DoubleDouble sum(-1.0);
  for (int d = 0; d < 3; ++d) sum = sum + two_product(v[d], v[d]);
  return sum.high + sum.low;
}

/// Changes b's velocity relative to a by `change` along the normal and keeps the sum of momenta: for an elastic impulse
/// `change` is minus twice their relative normal velocity. Works for accelerations as well. A fixed body has inverse
/// mass 0; at most one is fixed. Precondition: the normal is a unit vector up to rounding.
///
/// Energy must not drift faster than random rounding makes it, in proportion to the square root of the number of
/// contacts. Two errors would be the same at each contact and add up, by as much as 1e-16 of the pair's energy each.
/// One is that of the quotient of the masses, a single number for bodies of two masses: so the lighter body takes the
/// rest that the heavier leaves of the change, and the sum is right whatever the quotient's error. The other is that of
/// the normal's length, which far from the origin is not random (the coordinates have few bits, and sums of their
/// squares fall midway between doubles): so it is divided out. See docs/accuracy.md.
inline void change_relative_velocity(Eigen::Vector3d& velocity_a, Eigen::Vector3d& velocity_b,
                                     const Eigen::Vector3d& normal, double change, double inverse_mass_a,
                                     double inverse_mass_b) {
  change -= change * excess_of_unit(normal);
  const Eigen::Vector3d whole = change * normal;
  const double share = std::min(inverse_mass_a, inverse_mass_b) / (inverse_mass_a + inverse_mass_b);
  const Eigen::Vector3d of_heavier = share * whole;
  const Eigen::Vector3d of_lighter = whole - of_heavier;
  const bool a_is_heavier = inverse_mass_a < inverse_mass_b;
  velocity_a -= a_is_heavier ? of_heavier : of_lighter;
  velocity_b += a_is_heavier ? of_lighter : of_heavier;
}

}  // namespace kds::collision
