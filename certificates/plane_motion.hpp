// Motion of a point in the plane.
#pragma once

#include "kds/bounded.hpp"
#include "kds/hermite.hpp"
#include "kds/motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace kds::certificates {

/// Two polynomials in the time since the path's own start: x and y.
template <int Degree>
struct PlaneMotion {
  static constexpr int degree = Degree;

  std::array<Polynomial<Degree>, 2> coordinate;  ///< length, length/s, ...; of degree 2: half the acceleration
  double start = 0;                              ///< s

  /// From place p0 with velocity v0 at time t0 to place p1 with velocity v1 at t1, by hermite_cubic(), which says how
  /// far it is off at t1: a piece of a trajectory that is given by places and velocities. It starts at t0 and goes on
  /// after t1. Throws std::invalid_argument unless t0 < t1 and all is finite.
  static PlaneMotion cubic(const std::array<double, 2>& p0, const std::array<double, 2>& v0,
                           const std::array<double, 2>& p1, const std::array<double, 2>& v1, double t0,
                           double t1) requires(Degree >= 3) {
    const double duration = kds::detail::duration_of_piece("PlaneMotion::cubic", t0, t1);
    PlaneMotion motion{{}, t0};
    for (std::size_t d = 0; d < 2; ++d) {
      const auto c = hermite_cubic(p0[d], v0[d], p1[d], v1[d], duration);
      std::copy(c.begin(), c.end(), motion.coordinate[d].c.begin());
    }
    kds::detail::require_finite("PlaneMotion::cubic", motion);
    return motion;
  }

  /// The same with accelerations a0 and a1 (not halves) too, by hermite_quintic().
  static PlaneMotion quintic(const std::array<double, 2>& p0, const std::array<double, 2>& v0,
                             const std::array<double, 2>& a0, const std::array<double, 2>& p1,
                             const std::array<double, 2>& v1, const std::array<double, 2>& a1, double t0,
                             double t1) requires(Degree >= 5) {
    const double duration = kds::detail::duration_of_piece("PlaneMotion::quintic", t0, t1);
    PlaneMotion motion{{}, t0};
    for (std::size_t d = 0; d < 2; ++d) {
      const auto c = hermite_quintic(p0[d], v0[d], a0[d], p1[d], v1[d], a1[d], duration);
      std::copy(c.begin(), c.end(), motion.coordinate[d].c.begin());
    }
    kds::detail::require_finite("PlaneMotion::quintic", motion);
    return motion;
  }

  Motion<Degree> axis(int d) const { return {coordinate[static_cast<std::size_t>(d)], start}; }
  /// x and y at t, rounded.
  std::array<double, 2> operator()(double t) const { return {coordinate[0](t - start), coordinate[1](t - start)}; }

  bool finite() const { return is_finite(axis(0)) && is_finite(axis(1)); }
  friend bool operator==(const PlaneMotion&, const PlaneMotion&) = default;
};

/// The same motion restarted at t, equal up to the rounding of its new coefficients.
template <int Degree>
PlaneMotion<Degree> restarted(const PlaneMotion<Degree>& path, double t) {
  return {{kds::restarted(path.axis(0), t).position, kds::restarted(path.axis(1), t).position}, t};
}

/// The same motion in time that runs backwards, exactly: see Motion.
template <int Degree>
PlaneMotion<Degree> reversed(const PlaneMotion<Degree>& path) {
  return {{mirrored(path.coordinate[0]), mirrored(path.coordinate[1])}, 0.0 - path.start};
}

/// A point of the plane that was sampled at `start` and has moved at most at `speed` since, in either coordinate.
struct BoundedPoint {
  static constexpr int degree = 1;
  static constexpr bool sampled = true;

  std::array<double, 2> position{};  ///< length
  double speed = 0;                  ///< length/s, >= 0
  double start = 0;                  ///< s

  Bounded axis(int d) const { return {position[static_cast<std::size_t>(d)], speed, start}; }
  bool finite() const { return is_finite(axis(0)) && is_finite(axis(1)); }
  friend bool operator==(const BoundedPoint&, const BoundedPoint&) = default;
};

/// A point of the plane that was sampled at `start` and has not accelerated by more than `acceleration` since, in
/// either coordinate.
struct BoundedAccelerationPoint {
  static constexpr int degree = 2;
  static constexpr bool sampled = true;
  static constexpr bool moves = true;

  std::array<double, 2> position{};  ///< length
  std::array<double, 2> velocity{};  ///< length/s
  double acceleration = 0;           ///< length/s^2, >= 0
  double start = 0;                  ///< s

  BoundedAcceleration axis(int d) const {
    const auto i = static_cast<std::size_t>(d);
    return {position[i], velocity[i], acceleration, start};
  }
  bool finite() const { return is_finite(axis(0)) && is_finite(axis(1)); }
  friend bool operator==(const BoundedAccelerationPoint&, const BoundedAccelerationPoint&) = default;
};

}  // namespace kds::certificates
