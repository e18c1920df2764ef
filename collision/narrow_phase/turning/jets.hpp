// Numbers and vectors that turn, with their first two derivatives at one time, and how long a number surely stays
// positive.
#pragma once

#include "certificates/turning/rigid_motion.hpp"
#include "collision/vectors.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace kds::collision {

/// f, f' and f'' at one time.
struct Jet {
  double value = 0;
  double rate = 0;
  double bend = 0;

  friend Jet operator+(const Jet& a, const Jet& b) { return {a.value + b.value, a.rate + b.rate, a.bend + b.bend}; }
  friend Jet operator-(const Jet& a, const Jet& b) { return {a.value - b.value, a.rate - b.rate, a.bend - b.bend}; }
  friend Jet operator*(double factor, const Jet& a) { return {factor * a.value, factor * a.rate, factor * a.bend}; }
};

/// The same of a vector.
struct VectorJet {
  Eigen::Vector3d value;
  Eigen::Vector3d rate;
  Eigen::Vector3d bend;

  friend VectorJet operator+(const VectorJet& a, const VectorJet& b) {
    return {a.value + b.value, a.rate + b.rate, a.bend + b.bend};
  }
  friend VectorJet operator-(const VectorJet& a, const VectorJet& b) {
    return {a.value - b.value, a.rate - b.rate, a.bend - b.bend};
  }
  friend VectorJet operator*(double factor, const VectorJet& a) {
    return {factor * a.value, factor * a.rate, factor * a.bend};
  }
};

inline Jet dot(const VectorJet& a, const VectorJet& b) {
  return {dot(a.value, b.value), dot(a.rate, b.value) + dot(a.value, b.rate),
          dot(a.bend, b.value) + 2 * dot(a.rate, b.rate) + dot(a.value, b.bend)};
}
inline VectorJet cross(const VectorJet& a, const VectorJet& b) {
  return {cross(a.value, b.value), cross(a.rate, b.value) + cross(a.value, b.rate),
          cross(a.bend, b.value) + 2 * cross(a.rate, b.rate) + cross(a.value, b.bend)};
}
/// Of a vector of a body that turns with the angular velocity w.
inline VectorJet turning(const Eigen::Vector3d& vector, const Eigen::Vector3d& w) {
  const Eigen::Vector3d rate = cross(w, vector);
  return {vector, rate, cross(w, rate)};
}

/// A power of two that is not above the cube root of x, and not below half of it. Precondition: x > 0.
inline double power_below_cube_root(double x) {
  int exponent = 0;
  std::frexp(x, &exponent);  // 2^(exponent - 1) <= x < 2^exponent
  exponent -= 1;
  return std::ldexp(1.0, exponent >= 0 ? exponent / 3 : -((2 - exponent) / 3));
}

/// A time s in [0, longest], rounded down, such that value + rate x + bend x^2 / 2 - third x^3 / 6 > 0 for all x in [0,
/// s]. It is near the first root unless bend is positive: a positive bend counts as 0. `third` >= 0.
///
/// Method: without a positive bend the function is concave. Where it is positive at the far end too, it is positive all
/// the way. Otherwise there is a time until which no term takes more than a third of the value, and by four times that
/// time they have taken all of it together. In between chords meet zero before the function does, and tangents after
/// it.
inline double positive_for(const Jet& f, double third, double longest) {
  if (!(f.value > 0)) return 0;
  const double c2 = std::min(f.bend, 0.0) / 2;
  const double c3 = third / 6;
  const auto at = [&](double s) { return f.value + s * (f.rate + s * (c2 - s * c3)); };
  if (at(longest) > 0) return longest;
  double low = longest;
  if (f.rate < 0) low = std::min(low, -f.value / (3 * f.rate));
  if (c2 < 0) low = std::min(low, std::sqrt(-f.value / (3 * c2)));
  if (c3 > 0) low = std::min(low, power_below_cube_root(f.value / (3 * c3)));
  double high = std::min(longest, 4 * low);
  double at_low = at(low);
  if (!(at_low > 0)) low = 0, at_low = f.value;  // but for roundings it is
  for (int round = 0; round < 4 && at_low > 0; ++round) {
    const double at_high = at(high);
    if (!(at_high < 0)) break;
    const double slope = f.rate + high * (2 * c2 - 3 * high * c3);
    low += (high - low) * (at_low / (at_low - at_high));
    at_low = at(low);
    if (slope < 0) high = std::max(low, high - at_high / slope);
  }
  return low * (1 - 0x1p-30);
}

/// The same for a function that is known not to be negative at first, whatever its value in doubles: for all x in (0,
/// s]. `rate_error`, `bend_error`: how much less its rate and bend may be.
///
/// Method: it is at least x (rate + bend x / 2 - third x^2 / 6).
inline double positive_after(const Jet& f, double rate_error, double bend_error, double third, double longest) {
  const Jet over_x{f.rate - rate_error, (f.bend - bend_error) / 2, -third / 3};
  return std::max(positive_for(f, third, longest), positive_for(over_x, 0, longest));
}

}  // namespace kds::collision
