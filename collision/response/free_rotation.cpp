#include "collision/response/free_rotation.hpp"

#include "certificates/turning/rotation.hpp"
#include "certificates/turning/turned_orientation.hpp"
#include "collision/response/inertia.hpp"
#include "collision/vectors.hpp"
#include "kds/arithmetic/lattice.hpp"
#include "kds/arithmetic/power_of_two.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace kds::collision {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::Vector4d;

Vector3d turned(const Quaterniond& q, const Vector3d& v) { return certificates::Rotation(q, Spin{}, 0)(v); }

Spin spin_of(const Vector3d& velocity, double start) { return {{velocity[0], velocity[1], velocity[2]}, start}; }

/// The exponent of a power of two that is above all coordinates, by a factor of two at most; 0 of the zero vector.
int exponent_of(const Vector3d& v) {
  int exponent = 0;
  std::frexp(v.cwiseAbs().maxCoeff(), &exponent);
  return exponent;
}

/// x 2^exponent, rounded once.
double scaled(double x, int exponent) {
  return std::abs(exponent) < 1023 ? x * power_of_two(exponent) : std::ldexp(x, exponent);
}

Vector3d inverse_moments(const PrincipalInertia& inertia) {
  return {1 / inertia.moments[0], 1 / inertia.moments[1], 1 / inertia.moments[2]};
}

}  // namespace

Vector3d angular_velocity(const PrincipalInertia& inertia, const RotationState& state) {
  const Vector3d momentum = turned(state.orientation.conjugate(), state.momentum);
  return turned(state.orientation, inverse_moments(inertia).cwiseProduct(momentum));
}

Vector3d angular_momentum(const PrincipalInertia& inertia, const Quaterniond& orientation, const Vector3d& velocity) {
  return turned(orientation, turned(orientation.conjugate(), velocity).cwiseQuotient(inverse_moments(inertia)));
}

Matrix3d inverse_inertia(const PrincipalInertia& inertia, const Quaterniond& orientation) {
  Matrix3d rotation;
  for (int k = 0; k < 3; ++k) rotation.col(k) = turned(orientation, Vector3d::Unit(k));
  return turned_tensor(Matrix3d(inverse_moments(inertia).asDiagonal()), rotation);
}

FreeRotation::FreeRotation(const PrincipalInertia& inertia, const RotationState& state)
    : inertia_(inertia),
      state_(state),
      own_momentum_(turned(state.orientation.conjugate(), state.momentum)),
      inverse_(inverse_moments(inertia)) {
  const Vector3d rates = inverse_.cwiseProduct(own_momentum_);
  const int of_momentum = exponent_of(own_momentum_), of_rates = exponent_of(rates);
  rate_ = power_of_two(of_rates);
  for (int i = 0; i < 3; ++i) {
    inverse_moments_[i] = scaled(inverse_[i], of_momentum - of_rates);
    momentum_[0][i] = scaled(own_momentum_[i], -of_momentum);
  }
  constexpr double roundings = 0x1p-46;
  const Vector3d unit_rates = inverse_moments_.cwiseProduct(momentum_[0]);
  steady_ = norm(cross(momentum_[0], unit_rates)) <= roundings * norm(momentum_[0]) * norm(unit_rates);
  quaternion_[0] = state.orientation.coeffs();
  valid_until_ = in_closed_form() ? never : state.time;
}

double FreeRotation::size(std::size_t term) const {
  return std::max(momentum_[term].cwiseAbs().maxCoeff(), quaternion_[term].cwiseAbs().maxCoeff());
}

void FreeRotation::expand(double wanted) {
  if (in_closed_form()) {
    if (!steady_) top_spins_ = top_spins();
    return;
  }
  constexpr double left_out = 0x1p-60;
  constexpr double greatest = 0x1p200;  // of a coefficient, lest the next overflow: fewer terms, and a shorter time
  const Vector3d& n = inverse_moments_;
  const Vector3d differences(n[2] - n[1], n[0] - n[2], n[1] - n[0]);
  double span = std::min(wanted * rate_, 1.0);
  double power = 1;
  int small = 0;
  std::array<Vector3d, most_terms> rates;
  for (terms_ = 0; small < 2 && terms_ < most_terms && size(terms_) <= greatest;) {
    const std::size_t m = terms_++;
    rates[m] = n.cwiseProduct(momentum_[m]);
    Vector3d change = Vector3d::Zero();
    Vector4d turn = Vector4d::Zero();
    for (std::size_t k = 0; k <= m; ++k) {
      const Vector3d &l = momentum_[k], &other = momentum_[m - k], &w = rates[m - k];
      const Vector4d& q = quaternion_[k];
      change += Vector3d(l[1] * other[2], l[2] * other[0], l[0] * other[1]);
      turn += Vector4d(q[3] * w[0] + (q[1] * w[2] - q[2] * w[1]), q[3] * w[1] + (q[2] * w[0] - q[0] * w[2]),
                       q[3] * w[2] + (q[0] * w[1] - q[1] * w[0]), -(q[0] * w[0] + q[1] * w[1] + q[2] * w[2]));
    }
    const double order = static_cast<double>(terms_);
    momentum_[terms_] = differences.cwiseProduct(change) / order;
    quaternion_[terms_] = turn / (2 * order);
    power *= span;
    small = power * size(terms_) <= left_out ? small + 1 : 0;
  }
  const auto converges = [&] {
    double last = 1;  // span^(terms_ - 1)
    for (std::size_t m = 1; m < terms_; ++m) last *= span;
    return last * size(terms_ - 1) <= left_out && last * span * size(terms_) <= left_out;
  };
  while (!converges()) span /= 2;
  valid_until_ = state_.time + span / rate_;
}

TopSpins FreeRotation::top_spins() const {
  const int axis = inertia_.symmetry, across = (axis + 1) % 3;
  Vector3d own = Vector3d::Zero();
  own[axis] = -own_momentum_[axis] * (inverse_[axis] - inverse_[across]);
  TopSpins top{spin_of(inverse_[across] * state_.momentum, state_.time), spin_of(own, state_.time), 0, 0};
  top.precession_rate = top.precession.rate();
  top.own_rate = top.own.rate();
  return top;
}

Quaterniond TopSpins::carried(const Quaterniond& from, double t) const {
  using certificates::turned_orientation;
  const Quaterniond q = turned_orientation(from, precession, precession_rate, t);
  return turned_orientation(q.conjugate(), own, own_rate, t).conjugate();
}

Quaterniond FreeRotation::orientation(double t) const {
  if (steady_) {
    return certificates::turned_orientation(state_.orientation, spin_of(angular_velocity(), state_.time), t);
  }
  if (inertia_.symmetry >= 0) return (top_spins_ ? *top_spins_ : top_spins()).carried(state_.orientation, t);
  const double span = (t - state_.time) * rate_;
  Vector4d sum = quaternion_[terms_];
  for (std::size_t m = terms_; m-- > 0;) sum = sum * span + quaternion_[m];
  return Quaterniond(sum);
}

Vector3d FreeRotation::angular_velocity() const {
  return turned(state_.orientation, inverse_.cwiseProduct(own_momentum_));
}

Vector3d FreeRotation::acceleration(double t) const {
  if (steady_) return Vector3d::Zero();
  Vector3d momentum = momentum_[terms_];
  const double span = (t - state_.time) * rate_;
  for (std::size_t m = terms_; m-- > 0;) momentum = momentum * span + momentum_[m];
  const Vector3d rates = inverse_moments_.cwiseProduct(momentum);
  return rate_ * (rate_ * inverse_moments_.cwiseProduct(cross(momentum, rates)));
}

Quaterniond orientation_at(const PrincipalInertia& inertia, const RotationState& state, double t) {
  RotationState reached = state;
  for (;;) {
    FreeRotation rotation(inertia, reached);
    rotation.expand(t - reached.time);
    if (t <= rotation.valid_until() || !(rotation.valid_until() > reached.time)) return rotation.orientation(t);
    reached.orientation = rotation.orientation(rotation.valid_until());
    reached.time = rotation.valid_until();
  }
}

}  // namespace kds::collision
