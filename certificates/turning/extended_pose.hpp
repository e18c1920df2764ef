// Turning vectors of a body to where they are at a time, in double-doubles with an error bound.
#pragma once

#include "certificates/turning/rigid_motion.hpp"
#include "certificates/turning/turned_vector.hpp"
#include "kds/arithmetic/ball.hpp"
#include "kds/arithmetic/double_double.hpp"
#include "kds/turning/spin.hpp"

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <limits>

namespace kds::certificates {

using ExtendedVector = VectorOf<DoubleDouble>;

/// What an operation of double-doubles errs by at most, relative to its result.
inline constexpr double extended_unit = 0x1p-102;

inline double magnitude_sum(const ExtendedVector& v) {
  return std::abs(v[0].high) + std::abs(v[1].high) + std::abs(v[2].high);
}
/// b - a, exactly, barring overflow.
inline ExtendedVector exact_difference(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return {two_sum(b[0], -a[0]), two_sum(b[1], -a[1]), two_sum(b[2], -a[2])};
}
inline ExtendedVector operator+(const ExtendedVector& a, const ExtendedVector& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline ExtendedVector operator-(const ExtendedVector& a, const ExtendedVector& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

/// A motion at one time, as Rotation and RigidMotion::origin have it in doubles: about a third of the work of balls,
/// which carry an error along with each number.
///
/// Error bound. Rotation's derivation holds with d = extended_unit in place of u, as the steps are the same but for
/// two: W is not divided by its length, but the sine and 1 - cosine are, by w, known to 4 d, and by w^2, known to 2 d.
/// So s W x y errs by 9 d, (1 - c) W x (W x y) by 24 d, and the sums by 3 d: no more than there. 2^-95 = 128 d is
/// charged, besides the radii of sine and cosine. What products of numbers below 2^-465 lose is below 2^-1022, and
/// grows to 2^-600 at most where |q|^2 and |W|^2 are in the range that is asked for.
class ExtendedPose {
 public:
  template <int Degree>
  ExtendedPose(const RigidMotion<Degree>& motion, double t)
      : q_(motion.orientation.vec()), w_(motion.orientation.w()), spin_(motion.angular_velocity) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const DoubleDouble square =
        (two_product(w_, w_) + two_product(q_[0], q_[0])) + (two_product(q_[1], q_[1]) + two_product(q_[2], q_[2]));
    upright_ = q_[0] == 0 && q_[1] == 0 && q_[2] == 0;
    factor_ = DoubleDouble(2.0) / square;
    scale_ = square;
    error_ = in_range(square.high) ? 0x1p-95 : infinity;
    const Spin spin = motion.spin();
    turned_ = !spin.still();
    if (turned_) {
      const Ball<DoubleDouble> rate = spin.rate();
      const auto a = sine_cosine<Ball<DoubleDouble>>(spin.angle(rate, t));
      const DoubleDouble squared_rate =
          two_product(spin_[0], spin_[0]) + two_product(spin_[1], spin_[1]) + two_product(spin_[2], spin_[2]);
      sine_ = a.sine.middle / rate.middle;
      versine_ = (1.0 - a.cosine.middle) / squared_rate;
      error_ += in_range(squared_rate.high) ? a.sine.radius + a.cosine.radius : infinity;
      scale_ = scale_ * squared_rate;
    }
    set_origin(motion.path, t);
  }

  /// Where b points to. Each coordinate, and the whole vector, is off by at most error() times magnitude_sum(b), plus
  /// 2^-600.
  ExtendedVector operator()(const ExtendedVector& b) const {
    ExtendedVector y = b;
    if (!upright_) {
      const ExtendedVector p = cross(q_, b);
      const ExtendedVector r = cross(q_, p);
      for (std::size_t d = 0; d < 3; ++d) y[d] = y[d] + (p[d] * w_ + r[d]) * factor_;
    }
    if (turned_) {
      const ExtendedVector p = cross(spin_, y);
      const ExtendedVector r = cross(spin_, p);
      for (std::size_t d = 0; d < 3; ++d) y[d] = y[d] + (p[d] * sine_ + r[d] * versine_);
    }
    return y;
  }
  double error() const { return error_; }

  /// Where the origin of the body is, and by how much each coordinate may be off.
  const ExtendedVector& origin() const { return origin_; }
  double origin_error() const { return origin_error_; }

  /// As Turner has it, to 8 d.
  const DoubleDouble& scale() const { return scale_; }

 private:
  static bool in_range(double square) { return square >= 0x1p-400 && square <= 0x1p400; }

  static ExtendedVector cross(const Eigen::Vector3d& a, const ExtendedVector& b) {
    return {b[2] * a[1] - b[1] * a[2], b[0] * a[2] - b[2] * a[0], b[1] * a[0] - b[0] * a[1]};
  }

  /// The elapsed time is exact. A term of degree 2 takes two products and two sums: 16 d of the terms is charged.
  template <int Degree>
  void set_origin(const PointMotion<Degree>& path, double t) {
    const DoubleDouble elapsed = two_sum(t, -path.start);
    double terms = 0;
    for (std::size_t d = 0; d < 3; ++d) origin_[d] = DoubleDouble(0.0);
    for (std::size_t i = Degree + 1; i-- > 0;) {
      for (std::size_t d = 0; d < 3; ++d) {
        origin_[d] = origin_[d] * elapsed + path.coefficients[i][static_cast<Eigen::Index>(d)];
      }
      terms = terms * std::abs(elapsed.high) + magnitude_sum(path.coefficients[i]);
    }
    origin_error_ = 16 * extended_unit * terms + 0x1p-600;
  }

  Eigen::Vector3d q_;
  double w_;
  Eigen::Vector3d spin_;
  bool upright_;
  bool turned_;
  DoubleDouble factor_, sine_, versine_, scale_;
  double error_;
  ExtendedVector origin_;
  double origin_error_;
};

/// As bounded_value, in double-doubles, and times the scales of both bodies.
///
/// Error bound: scales and products of them err by less than 32 d of the value. Where the scale is not between 2^-200
/// and 2^200 nothing is said.
inline Ball<DoubleDouble> bounded_value(const DoubleDouble& value, const DoubleDouble& scale, double lengths,
                                        double size, double error) {
  const bool usual = lengths <= 0x1p100 && size <= 0x1p100 && scale.high >= 0x1p-200 && scale.high <= 0x1p200;
  if (!usual) return {DoubleDouble(0.0), std::numeric_limits<double>::infinity()};
  return {value * scale,
          (lengths * error + 32 * extended_unit * std::abs(value.high) + 0x1p-380) * scale.high * (1 + 0x1p-40)};
}

}  // namespace kds::certificates
