// Turning vectors of a body to where they are at a time, in doubles with an error bound.
#pragma once

#include "certificates/vectors.hpp"
#include "kds/simd/four_doubles.hpp"
#include "kds/turning/spin.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace kds::certificates {

/// Sum of the magnitudes of the coordinates: the least of work for a bound on the length.
inline double magnitude_sum(const Eigen::Vector3d& v) { return std::abs(v[0]) + std::abs(v[1]) + std::abs(v[2]); }

/// The rotation of a body at one time: exp((t - start) [W]) R(q), rounded.
///
/// Error bound, with u = 2^-53, relative to the length of the vector b that is turned. A cross product of vectors x, y
/// errs by 3 u |x| |y|. First R(q): p = v x b (3 u |v|), g = w p + v x p (9.5 u |q|^2, as |w| |v| <= |q|^2 / 2 and |v|
/// <= |q|), times 2 / |q|^2, known to 4 u (|that| <= 2, so 19 u + 10 u), plus b: 30 u for y = b + ... . Then the spin:
/// n = W / |W| is known to 3 u; p = n x y to 6 u, h = n x p to 12 u; with s and c as sine_cosine() bounds them, beyond
/// their radii, s p errs by 7 u, (1 - c) h by 28 u, and the sums by 3 u: 38 u of |y|. In all less than 70 u, to which
/// the radii of s and c are added: 2^-46 = 128 u is charged. Where |q|^2 or |W|^2 are not between 2^-400 and 2^400
/// nothing is said: the error is infinite; otherwise underflow costs less than 2^-600. But spins below that range that
/// have turned by next to nothing count as still, and their angle as an error: it is at most 2 |t - start| times the
/// greatest coordinate of W, as sqrt(3) and roundings are less than 2.
class Rotation {
 public:
  Rotation(const Eigen::Quaterniond& q, const Spin& spin, double t) : Rotation(q, spin, spin.rate(), t) {}
  /// The same where the rate is known already: it costs a third of it.
  Rotation(const Eigen::Quaterniond& q, const Spin& spin, const Ball<DoubleDouble>& rate, double t)
      : w_(q.w()), v_(q.x(), q.y(), q.z()), upright_(v_[0] == 0 && v_[1] == 0 && v_[2] == 0) {
    const double square = w_ * w_ + squared_norm(v_);
    scale_ = 2 / square;
    if (!in_range(square)) error_ = std::numeric_limits<double>::infinity();
    if (!spin.still() && t != spin.start) turn(spin, rate, t);
  }

  /// Where b points to.
  Eigen::Vector3d operator()(const Eigen::Vector3d& b) const {
    Eigen::Vector3d y = b;
    if (!upright_) {
      const Eigen::Vector3d p = cross(v_, b);
      y += scale_ * (w_ * p + cross(v_, p));
    }
    if (turned_) {
      const Eigen::Vector3d p = cross(axis_, y);
      y += sine_ * p + versine_ * cross(axis_, p);
    }
    return y;
  }

  /// Where the three axes of the body point to: the same bits as of each by itself.
  Eigen::Matrix3d matrix() const {
    using Columns = std::array<FourDoubles, 3>;  // coordinate by coordinate; the fourth lane is not used
    const auto crossed = [](const Eigen::Vector3d& v, const Columns& x) {
      const FourDoubles v0(v[0]), v1(v[1]), v2(v[2]);
      return Columns{v1 * x[2] - v2 * x[1], v2 * x[0] - v0 * x[2], v0 * x[1] - v1 * x[0]};
    };
    Columns y{FourDoubles(1, 0, 0, 0), FourDoubles(0, 1, 0, 0), FourDoubles(0, 0, 1, 0)};
    const auto turn = [&](const Eigen::Vector3d& v, const auto& part) {
      const Columns p = crossed(v, y), h = crossed(v, p);
      for (std::size_t d = 0; d < 3; ++d) y[d] = y[d] + part(p[d], h[d]);
    };
    if (!upright_) {
      const FourDoubles scale(scale_), w(w_);
      turn(v_, [&](const FourDoubles& p, const FourDoubles& h) { return scale * (w * p + h); });
    }
    if (turned_) {
      const FourDoubles sine(sine_), versine(versine_);
      turn(axis_, [&](const FourDoubles& p, const FourDoubles& h) { return sine * p + versine * h; });
    }
    Eigen::Matrix3d columns;
    for (std::size_t d = 0; d < 3; ++d) {
      for (std::size_t k = 0; k < 3; ++k) {
        columns(static_cast<Eigen::Index>(d), static_cast<Eigen::Index>(k)) = y[d][k];
      }
    }
    return columns;
  }

  /// Each coordinate, and the whole vector, is off by at most this times magnitude_sum(b), plus 2^-600.
  double error() const { return error_; }

 private:
  static constexpr double slowest = 0x1p-200;      ///< rad/s
  static constexpr double least_angle = 0x1p-100;  ///< rad

  static bool in_range(double square) { return square >= 0x1p-400 && square <= 0x1p400; }

  void turn(const Spin& spin, const Ball<DoubleDouble>& rate, double t) {
    const Eigen::Vector3d velocity(spin.velocity[0], spin.velocity[1], spin.velocity[2]);
    if (const double greatest = velocity.cwiseAbs().maxCoeff(); greatest < slowest) {
      const double angle = 2 * std::abs(t - spin.start) * greatest;
      if (angle <= least_angle) {
        error_ += angle;
        return;
      }
    }
    const auto a = sine_cosine<Ball<double>>(spin.angle(rate, t));
    axis_ = velocity * (1 / rate.middle.high);
    sine_ = a.sine.middle;
    versine_ = 1 - a.cosine.middle;
    turned_ = true;
    error_ += in_range(rate.middle.high * rate.middle.high) ? a.sine.radius + a.cosine.radius
                                                            : std::numeric_limits<double>::infinity();
  }

  double w_;
  Eigen::Vector3d v_;
  double scale_ = 0;
  Eigen::Vector3d axis_ = Eigen::Vector3d::Zero();
  double sine_ = 0;
  double versine_ = 0;
  double error_ = 0x1p-46;
  bool upright_;
  bool turned_ = false;
};

}  // namespace kds::certificates
