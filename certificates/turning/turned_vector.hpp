// Vectors of a body that turns, as sums of a part at rest, one times a cosine and one times a sine.
#pragma once

#include "certificates/turning/rigid_motion.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>

namespace kds::certificates {

/// In the arithmetic of Number, or of polynomials over it.
template <class Number>
using VectorOf = std::array<Number, 3>;

template <class Number>
VectorOf<Number> vector_of(const Eigen::Vector3d& v) {
  return {Number(v[0]), Number(v[1]), Number(v[2])};
}
/// b - a.
template <class Number>
VectorOf<Number> difference_of(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return {difference<Number>(b[0], a[0]), difference<Number>(b[1], a[1]), difference<Number>(b[2], a[2])};
}
template <class Number>
Number dot(const VectorOf<Number>& a, const VectorOf<Number>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
/// a b - c d.
template <class Number>
Number difference_of_products(const Number& a, const Number& b, const Number& c, const Number& d) {
  return a * b - c * d;
}
template <class Number>
VectorOf<Number> cross(const VectorOf<Number>& a, const VectorOf<Number>& b) {
  return {difference_of_products(a[1], b[2], a[2], b[1]), difference_of_products(a[2], b[0], a[0], b[2]),
          difference_of_products(a[0], b[1], a[1], b[0])};
}
template <class Number>
VectorOf<Number> operator*(const VectorOf<Number>& a, const Number& factor) {
  return {a[0] * factor, a[1] * factor, a[2] * factor};
}

/// scale * R(t) b = parts[0] + parts[1] cos a + parts[2] w sin a, with the turn of a spin: b is a vector of the body.
template <class Number>
using TurnedVector = std::array<VectorOf<Number>, 3>;

/// Makes turned vectors of the vectors of one body, all times one positive factor, `scale`: so that no quotient is
/// needed.
///
/// With y = |q|^2 R(q) b = (q_w^2 - |v|^2) b + 2 v (v . b) + 2 q_w v x b, v being the vector part of q, and the
/// rotation about W by the angle a [Rodrigues1840]
///     w^2 exp(t [W]) y = W (W . y) + cos a (w^2 y - W (W . y)) + w sin a (W x y),
/// the scale is w^2 |q|^2; for a body that does not turn, |q|^2.
template <class Number>
class Turner {
 public:
  template <int Degree>
  explicit Turner(const RigidMotion<Degree>& motion)
      : w_(motion.orientation.w()),
        v_(vector_of<Number>(motion.orientation.vec())),
        velocity_(vector_of<Number>(motion.angular_velocity)),
        still_(motion.spin().still()),
        upright_(motion.orientation.vec().isZero(0)),
        squared_rate_(motion.spin().template squared_rate<Number>()) {
    const Number square = w_ * w_;
    const Number rest = dot(v_, v_);
    difference_ = square - rest;
    square_ = square + rest;
    scale_ = still_ ? square_ : square_ * squared_rate_;
  }

  const Number& scale() const { return scale_; }
  /// |q|^2, which is the scale of vectors that have not turned yet.
  const Number& scale_at_start() const { return square_; }

  TurnedVector<Number> operator()(const VectorOf<Number>& b) const {
    const VectorOf<Number> y = at_start(b);
    TurnedVector<Number> result{};
    if (still_) {
      result[0] = y;
      return result;
    }
    result[0] = velocity_ * dot(velocity_, y);
    result[2] = cross(velocity_, y);
    for (std::size_t d = 0; d < 3; ++d) result[1][d] = squared_rate_ * y[d] - result[0][d];
    return result;
  }

  /// |q|^2 R(q) b: a vector of the body that has not turned yet.
  VectorOf<Number> at_start(const VectorOf<Number>& b) const {
    if (upright_) return b * difference_;
    const Number along = dot(v_, b);
    const VectorOf<Number> p = cross(v_, b);
    VectorOf<Number> y;
    for (std::size_t d = 0; d < 3; ++d) {
      const Number half = v_[d] * along + w_ * p[d];
      y[d] = difference_ * b[d] + (half + half);
    }
    return y;
  }

 private:
  Number w_;
  VectorOf<Number> v_;
  VectorOf<Number> velocity_;
  bool still_;
  bool upright_;
  Number squared_rate_;
  Number difference_;  ///< q_w^2 - |v|^2
  Number square_;      ///< |q|^2
  Number scale_;
};

}  // namespace kds::certificates
