// The orientation of a body that turns, as a quaternion of doubles.
#pragma once

#include "kds/turning/spin.hpp"

#include <Eigen/Geometry>

namespace kds::certificates {

/// (cos h, sin h W / |W|) q for half the angle h that the spin has turned at t: the orientation then, rounded. Each
/// coordinate is off by at most 2^-49 |q|; where nothing has turned q stays as it is, bit for bit. Angles of any size.
///
/// Error bound, with u = 2^-53: the sine and the cosine are rounded from 2^-70 (u), the sine is divided by the rate and
/// multiplied by W (4 u in all), and a sum of four products makes 4 u: 8 u |q|, and less than that for the rest.
Eigen::Quaterniond turned_orientation(const Eigen::Quaterniond& q, const Spin& spin, double t);
/// The same where spin.rate() is known already.
Eigen::Quaterniond turned_orientation(const Eigen::Quaterniond& q, const Spin& spin, const Ball<DoubleDouble>& rate,
                                      double t);

}  // namespace kds::certificates
