// How far two shapes are apart along a direction, one of them moving: whether that rises or falls.
#pragma once

#include "collision/narrow_phase/curve_spans.hpp"
#include "collision/narrow_phase/mesh_margins.hpp"
#include "collision/narrow_phase/relative_motion.hpp"
#include "collision/vectors.hpp"
#include "kds/certificate.hpp"

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <cstddef>

namespace kds::collision {

/// Speeds along an axis up to [0] + tau [1] are rounding errors and count as zero.
template <int Degree>
std::array<double, 2> smallest_speeds(const RelativeMotion<Degree>& motion) requires(Degree <= 2) {
  constexpr double rounding = 8 * 0x1p-53;
  if constexpr (Degree == 1) {
    return {rounding * norm(motion.coefficients[1]), 0};
  } else {
    return {rounding * norm(motion.coefficients[1]), 2 * rounding * norm(motion.coefficients[2])};
  }
}

/// The same for degree n = 3 to 5, and for all derivatives: up to the derivatives of this polynomial they are rounding
/// errors. A coefficient along an axis takes 4 of them, Horner's rule for its derivatives 2 n + 1.
template <int Degree>
std::array<double, std::size_t{Degree} + 1> smallest_speeds(const RelativeMotion<Degree>& motion) {
  constexpr double rounding = 16 * 0x1p-53;
  std::array<double, std::size_t{Degree} + 1> smallest;
  for (std::size_t i = 0; i <= Degree; ++i) smallest[i] = rounding * norm(motion.coefficients[i]);
  return smallest;
}

/// A direction, and how far apart two shapes are along it: they touch while that is below the contact gap along all.
template <int Degree>
struct TouchCondition {
  std::array<double, std::size_t{Degree} + 1> separation;  ///< along the normal; below the gap: near
  Eigen::Vector3d normal;                                  ///< unit, from a to b

  double operator()(double tau) const {
    if constexpr (Degree == 1) {
      return separation[0] + tau * separation[1];
    } else if constexpr (Degree >= 3) {
      return derivative_at(separation, 0, tau);
    } else {
      return separation[0] + tau * (separation[1] + tau * separation[2]);
    }
  }

  /// 1 if it rises just after tau, -1 if it falls, 0 if it does neither up to rounding.
  template <class Speeds>
  int trend(double tau, const Speeds& speeds) const {
    const auto sign = [](double x, double rounding) { return x > rounding ? 1 : (x < -rounding ? -1 : 0); };
    if constexpr (Degree >= 3) {
      int trend = 0;
      for (int order = 1; order <= Degree && trend == 0; ++order) {
        trend = sign(derivative_at(separation, order, tau), derivative_at(speeds, order, tau));
      }
      return trend;
    } else if constexpr (Degree == 1) {
      return sign(separation[1], speeds[0]);
    } else {
      // It falls if its rate f is negative, and so is f + e, of which e is the error, or falling: exactly.
      const auto sign_of = [&](const PolynomialCertificate<1>& f, int order = 0) { return sign_after(f, tau, order); };
      const int now = sign_of(rate({0, 0}));
      if (now == 0) return 0;
      const auto beyond_error = rate({-now * speeds[0], -now * speeds[1]});
      return sign_of(beyond_error) == now || sign_of(beyond_error, 1) == now ? now : 0;
    }
  }

  /// How fast it rises, and an error.
  PolynomialCertificate<1> rate(const std::array<double, 2>& error) const requires(Degree == 2) {
    return {{{{separation[1] + error[0], 2 * separation[2] + error[1]}}, 0.0}};
  }
  /// Whether it is below the opposite of the gap, `now`: of degree 2 just after tau, exactly.
  bool deeper_than(const ContactGap<Degree>& gap, double now, double tau) const {
    const double above = (*this)(tau) + now;
    if (Degree != 2 || !(std::abs(above) <= 0.5 * now)) return !(above > 0);
    return sign_after(above_gap(gap), tau) < 0;
  }
  PolynomialCertificate<Degree> above_gap(const ContactGap<Degree>& gap) const {
    Polynomial<Degree> above;
    for (std::size_t i = 0; i <= Degree; ++i) above.c[i] = separation[i] + gap.c[i];
    return {{above, 0.0}};
  }
};

}  // namespace kds::collision
