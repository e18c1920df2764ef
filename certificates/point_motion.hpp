// Motion of a point in space: a vector polynomial in the time since its own start.
#pragma once

#include "kds/hermite.hpp"
#include "kds/motion.hpp"

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>

namespace kds::certificates {

/// The coefficients of a motion: an array of vectors. If only the first ones are given, or none, the others are zero.
template <int Degree>
struct PointCoefficients : std::array<Eigen::Vector3d, std::size_t{Degree} + 1> {
  using Vector = Eigen::Vector3d;

  PointCoefficients() { set(); }
  PointCoefficients(const Vector& c0) { set(c0); }
  PointCoefficients(const Vector& c0, const Vector& c1) requires(Degree >= 1) { set(c0, c1); }
  PointCoefficients(const Vector& c0, const Vector& c1, const Vector& c2) requires(Degree >= 2) { set(c0, c1, c2); }
  template <class... Others>
  PointCoefficients(const Vector& c0, const Vector& c1, const Vector& c2, const Vector& c3,
                    const Others&... others) requires(Degree >= 3 + sizeof...(Others)) {
    set(c0, c1, c2, c3, others...);
  }

 private:
  template <class... Given>
  void set(const Given&... given) {
    std::size_t i = 0;
    (((*this)[i++] = given), ...);
    while (i <= Degree) (*this)[i++] = Vector::Zero();
  }
};

}  // namespace kds::certificates

/// Element access, for structured bindings.
template <int Degree>
struct std::tuple_size<kds::certificates::PointCoefficients<Degree>>
    : std::tuple_size<std::array<Eigen::Vector3d, std::size_t{Degree} + 1>> {};
template <std::size_t I, int Degree>
struct std::tuple_element<I, kds::certificates::PointCoefficients<Degree>> {
  using type = Eigen::Vector3d;
};

namespace kds::certificates {

/// x(t) = c[0] + c[1] (t - start) + c[2] (t - start)^2: position, velocity, *half* the acceleration.
template <int Degree>
struct PointMotion {
  static constexpr int degree = Degree;

  PointCoefficients<Degree> coefficients;  ///< length, length/s, length/s^2 ...; zero from the first left out on
  double start = 0;                        ///< s

  /// Through a position (length) at time t (s) with a constant velocity (length/s).
  static PointMotion line(const Eigen::Vector3d& position, const Eigen::Vector3d& velocity,
                          double t = 0) requires(Degree >= 1) {
    return {{position, velocity}, t};
  }

  /// Through a position (length) at time t (s) with a velocity (length/s) and a constant acceleration (length/s^2), of
  /// which the coefficient is half.
  static PointMotion parabola(const Eigen::Vector3d& position, const Eigen::Vector3d& velocity,
                              const Eigen::Vector3d& acceleration, double t = 0) requires(Degree >= 2) {
    return {{position, velocity, 0.5 * acceleration}, t};
  }

  /// From place p0 with velocity v0 at time t0 to place p1 with velocity v1 at t1, the only cubic that does
  /// (Hermite's): a piece of a trajectory that is given by places and velocities.
  ///
  /// Precondition: t0 < t1, all finite (else std::invalid_argument). It starts at t0, exactly as given, and goes on
  /// after t1. There it is off p1 by less than 2^-48 (|p0| + |p1| + T (|v0| + |v1|)) in each coordinate, T = t1 - t0,
  /// and off v1 by less than three times that over T: some 20 roundings of the terms of its coefficients, which are up
  /// to three times those sums, and of Horner's rule. A world does not take so small a gap to the next piece for a
  /// jump.
  static PointMotion cubic(const Eigen::Vector3d& p0, const Eigen::Vector3d& v0, const Eigen::Vector3d& p1,
                           const Eigen::Vector3d& v1, double t0, double t1) requires(Degree >= 3) {
    const double duration = kds::detail::duration_of_piece("PointMotion::cubic", t0, t1);
    PointMotion motion{{}, t0};
    for (int d = 0; d < 3; ++d) {
      const auto c = hermite_cubic(p0[d], v0[d], p1[d], v1[d], duration);
      for (std::size_t i = 0; i < c.size(); ++i) motion.coefficients[i][d] = c[i];
    }
    kds::detail::require_finite("PointMotion::cubic", motion);
    return motion;
  }

  /// The same with accelerations a0 and a1 (not halves) too: Hermite's quintic. Pieces that share places, velocities
  /// and accelerations make a path whose acceleration is continuous.
  ///
  /// Off p1 by less than 2^-45 (|p0| + |p1| + T (|v0| + |v1|) + T^2 (|a0| + |a1|)), off v1 by less than five times that
  /// over T, off a1 by less than twenty times that over T^2.
  static PointMotion quintic(const Eigen::Vector3d& p0, const Eigen::Vector3d& v0, const Eigen::Vector3d& a0,
                             const Eigen::Vector3d& p1, const Eigen::Vector3d& v1, const Eigen::Vector3d& a1, double t0,
                             double t1) requires(Degree >= 5) {
    const double duration = kds::detail::duration_of_piece("PointMotion::quintic", t0, t1);
    PointMotion motion{{}, t0};
    for (int d = 0; d < 3; ++d) {
      const auto c = hermite_quintic(p0[d], v0[d], a0[d], p1[d], v1[d], a1[d], duration);
      for (std::size_t i = 0; i < c.size(); ++i) motion.coefficients[i][d] = c[i];
    }
    kds::detail::require_finite("PointMotion::quintic", motion);
    return motion;
  }

  /// Motion of one coordinate.
  Motion<Degree> axis(int d) const {
    Motion<Degree> motion;
    for (std::size_t i = 0; i <= Degree; ++i) motion.position.c[i] = coefficients[i][d];
    motion.start = start;
    return motion;
  }

  /// At t, rounded.
  Eigen::Vector3d position(double t) const {
    const double elapsed = t - start;
    Eigen::Vector3d x = coefficients[Degree];
    for (std::size_t i = Degree; i-- > 0;) x = x * elapsed + coefficients[i];
    return x;
  }

  /// First derivative at t, rounded.
  Eigen::Vector3d velocity(double t) const {
    const double elapsed = t - start;
    Eigen::Vector3d v = coefficients[Degree] * Degree;
    for (std::size_t i = Degree; i-- > 1;) v = v * elapsed + coefficients[i] * static_cast<double>(i);
    return v;
  }

  /// Second derivative at t, rounded.
  Eigen::Vector3d acceleration(double t) const {
    Eigen::Vector3d a = Eigen::Vector3d::Zero();
    const double elapsed = t - start;
    for (std::size_t i = Degree; i >= 2; --i) a = a * elapsed + coefficients[i] * static_cast<double>(i * (i - 1));
    return a;
  }

  /// The same motion restarted at t, equal up to the rounding of its new coefficients. Where the last coefficients are
  /// zero it is restarted as a motion of the lower degree, bit for bit.
  PointMotion restarted(double t) const {
    PointMotion result;
    if constexpr (Degree >= 3) {
      if (coefficients[Degree].isZero(0)) {
        const auto shorter = without_last(*this).restarted(t);
        for (std::size_t i = 0; i < Degree; ++i) result.coefficients[i] = shorter.coefficients[i];
        result.coefficients[Degree] = Eigen::Vector3d::Zero();
        result.start = t;
        return result;
      }
    }
    for (int d = 0; d < 3; ++d) {
      const auto shifted = kds::restarted(axis(d), t);
      for (std::size_t i = 0; i <= Degree; ++i) result.coefficients[i][d] = shifted.position.c[i];
    }
    result.start = t;
    return result;
  }

  /// Without a branch for each number: the difference of a number with itself is zero unless it is infinite or a NaN.
  bool finite() const {
    double zero = start - start;
    for (const auto& c : coefficients) zero += (c - c).sum();
    return zero == 0;
  }

  friend bool operator==(const PointMotion& a, const PointMotion& b) {
    return a.start == b.start && a.coefficients == b.coefficients;
  }
};

/// The path of the centre of a body with this motion: the motion itself. Other types of motion define their own.
template <int Degree>
const PointMotion<Degree>& path_of(const PointMotion<Degree>& motion) {
  return motion;
}

/// The motion without its last coefficient, which counts as zero.
template <int Degree>
PointMotion<Degree - 1> without_last(const PointMotion<Degree>& path) requires(Degree >= 2) {
  PointMotion<Degree - 1> result;
  for (std::size_t i = 0; i < Degree; ++i) result.coefficients[i] = path.coefficients[i];
  result.start = path.start;
  return result;
}

/// The same motion in time that runs backwards, exactly: see Motion.
template <int Degree>
PointMotion<Degree> reversed(const PointMotion<Degree>& path) {
  PointMotion<Degree> result = path;
  for (std::size_t i = 1; i <= Degree; i += 2) result.coefficients[i] = Eigen::Vector3d::Zero() - path.coefficients[i];
  result.start = 0.0 - path.start;
  return result;
}

/// For snapshots (kds/framework/snapshot.hpp).
template <class Archive, int Degree>
void archive_members(Archive& archive, PointMotion<Degree>& path) {
  for (auto& c : path.coefficients) archive(c[0], c[1], c[2]);
  archive(path.start);
}

/// b - a, coordinate by coordinate, as polynomials in (t - epoch) in the arithmetic of Number.
template <class Number, int Degree>
std::array<Polynomial<Degree, Number>, 3> relative_motion(const PointMotion<Degree>& a, const PointMotion<Degree>& b,
                                                          double epoch) {
  std::array<Polynomial<Degree, Number>, 3> r;
  for (int d = 0; d < 3; ++d) {
    r[static_cast<std::size_t>(d)] = difference_about<Number>(b.axis(d), a.axis(d), epoch);
  }
  return r;
}

}  // namespace kds::certificates
