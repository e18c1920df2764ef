// Bodies that turn, in numbers of some 330 bits, written down from the definition of their motion.
#pragma once

#include "certificates/turning/distance_of_parts.hpp"
#include "certificates/turning/edge_edge_separation.hpp"
#include "certificates/turning/rigid_motion.hpp"
#include "certificates/turning/vertex_face_separation.hpp"

#include <Eigen/Core>
#include <boost/multiprecision/cpp_bin_float.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace kds::tests {

using Real = boost::multiprecision::number<
    boost::multiprecision::cpp_bin_float<100, boost::multiprecision::digit_base_10, void, std::int32_t>,
    boost::multiprecision::et_off>;
using RealVector = std::array<Real, 3>;

inline RealVector real(const Eigen::Vector3d& v) { return {Real(v[0]), Real(v[1]), Real(v[2])}; }
inline RealVector operator+(const RealVector& a, const RealVector& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline RealVector operator-(const RealVector& a, const RealVector& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline RealVector operator*(const RealVector& a, const Real& k) { return {a[0] * k, a[1] * k, a[2] * k}; }
inline Real inner(const RealVector& a, const RealVector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline RealVector outer(const RealVector& a, const RealVector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline Real length(const RealVector& a) { return sqrt(inner(a, a)); }
/// Between the length and twice the length.
inline Real size_of(const RealVector& a) { return abs(a[0]) + abs(a[1]) + abs(a[2]); }

/// A motion near a time t: the sine and the cosine are computed there, and those of the small rest by their series.
template <int Degree>
class TrueMotion {
 public:
  TrueMotion(const certificates::RigidMotion<Degree>& motion, double near)
      : motion_(motion), near_(near), velocity_(real(motion.angular_velocity)), rate_(length(velocity_)) {
    axis_ = rate_ == 0 ? RealVector{Real(1), Real(0), Real(0)} : velocity_ * (1 / rate_);
    const Real angle = rate_ * (Real(near) - Real(motion.start()));
    sine_ = sin(angle);
    cosine_ = cos(angle);
    const auto& q = motion.orientation;
    const Real w = q.w(), x = q.x(), y = q.y(), z = q.z();
    const Real n = w * w + x * x + y * y + z * z;
    columns_ = {RealVector{1 - 2 * (y * y + z * z) / n, 2 * (x * y + w * z) / n, 2 * (x * z - w * y) / n},
                RealVector{2 * (x * y - w * z) / n, 1 - 2 * (x * x + z * z) / n, 2 * (y * z + w * x) / n},
                RealVector{2 * (x * z + w * y) / n, 2 * (y * z - w * x) / n, 1 - 2 * (x * x + y * y) / n}};
  }

  /// Turns to near + rest, rest being a small number of seconds.
  void to(const Real& rest) {
    elapsed_ = Real(near_) - Real(motion_.start()) + rest;
    const Real angle = rate_ * rest;
    Real s = 0, c = 0, term = 1;
    for (int n = 0; n < 60; ++n) {  // enough for a hundred digits of a small angle
      if (n > 0) term = term * angle / n;
      if (abs(term) < Real("1e-115")) break;
      (n % 2 == 0 ? c : s) += n % 4 < 2 ? term : -term;
    }
    s_ = sine_ * c + cosine_ * s;
    c_ = cosine_ * c - sine_ * s;
  }

  RealVector direction(const RealVector& b) const {
    const RealVector y = columns_[0] * b[0] + columns_[1] * b[1] + columns_[2] * b[2];
    return y * c_ + outer(axis_, y) * s_ + axis_ * (inner(axis_, y) * (1 - c_));
  }
  RealVector origin() const {
    RealVector sum = real(motion_.path.coefficients[Degree]);
    for (std::size_t i = Degree; i-- > 0;) sum = sum * elapsed_ + real(motion_.path.coefficients[i]);
    return sum;
  }
  RealVector position(const Eigen::Vector3d& b) const { return origin() + direction(real(b)); }
  RealVector velocity(const Eigen::Vector3d& b) const {
    RealVector v = real(motion_.path.coefficients[1]);
    if constexpr (Degree == 2) v = v + real(motion_.path.coefficients[2]) * (2 * elapsed_);
    return v + outer(velocity_, direction(real(b)));
  }

 private:
  const certificates::RigidMotion<Degree>& motion_;
  double near_;
  RealVector velocity_;
  Real rate_;
  RealVector axis_;
  Real sine_, cosine_;
  std::array<RealVector, 3> columns_;
  Real elapsed_, s_, c_;
};

/// A value, and the size of what it was summed up from: what is less than a hundred digits below that is zero.
struct TrueValue {
  Real value, size;

  int sign() const { return abs(value) <= size * Real("1e-85") ? 0 : value.sign(); }
};

template <int Degree>
TrueValue true_value(const certificates::VertexFaceSeparation<Degree>& f, const TrueMotion<Degree>& a,
                     const TrueMotion<Degree>& b) {
  const RealVector corner = b.position(f.corners[0]);
  const RealVector first = b.position(f.corners[1]) - corner;
  const RealVector second = b.position(f.corners[2]) - corner;
  const RealVector vertex = a.position(f.vertex);
  const Real size = size_of(first) * size_of(second) * (size_of(vertex) + size_of(corner) + size_of(a.origin()));
  return {inner(outer(first, second), vertex - corner), size};
}

template <int Degree>
TrueValue true_value(const certificates::EdgeEdgeSeparation<Degree>& f, const TrueMotion<Degree>& a,
                     const TrueMotion<Degree>& b) {
  const RealVector x = a.position(f.edge_a[0]);
  const RealVector y = b.position(f.edge_b[0]);
  const RealVector u = a.position(f.edge_a[1]) - x;
  const RealVector v = b.position(f.edge_b[1]) - y;
  return {inner(outer(u, v), x - y),
          (size_of(u) + size_of(x)) * (size_of(v) + size_of(y)) * (size_of(x) + size_of(y) + size_of(a.origin()))};
}

/// Of what a formula of distance_of_parts.hpp names: where the points are, and what is known of them.
template <int Degree>
struct TrueParts {
  const TrueMotion<Degree>& a;
  const TrueMotion<Degree>& b;
  RealVector x, y, d;

  RealVector of_a(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const {
    return a.position(to) - a.position(from);
  }
  RealVector of_b(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const {
    return b.position(to) - b.position(from);
  }
  Real lengths() const { return size_of(x) + size_of(y) + size_of(d) + size_of(a.origin()) + 1; }
};

template <int Degree>
Real true_value(const certificates::PastEnd& f, const TrueParts<Degree>& parts) {
  return inner(parts.of_a(f.edge[0], f.edge[1]), parts.d);
}
template <int Degree>
Real true_value(const certificates::AcrossSide& f, const TrueParts<Degree>& parts) {
  // From the side away from the third corner: what of d is across the edge, in the plane.
  const RealVector e = parts.of_a(f.face[0], f.face[1]), third = parts.of_a(f.face[0], f.face[2]);
  const RealVector inward = third * inner(e, e) - e * inner(e, third);
  return -inner(inward, parts.d);
}
inline Real squared_radius(const std::array<double, 2>& radii) {
  const Real sum = Real(radii[0]) + Real(radii[1]);
  return sum * sum;
}
template <int Degree>
Real true_value(const certificates::PointsApart& f, const TrueParts<Degree>& parts) {
  return inner(parts.d, parts.d) - squared_radius(f.radii);
}
template <int Degree>
Real true_value(const certificates::LineApart& f, const TrueParts<Degree>& parts) {
  const RealVector u = parts.of_a(f.edge[0], f.edge[1]), across = outer(u, parts.d);
  return inner(across, across) - squared_radius(f.radii) * inner(u, u);
}
template <int Degree>
Real true_value(const certificates::AwayFromLine& f, const TrueParts<Degree>& parts) {
  const RealVector u = parts.of_a(f.line[0], f.line[1]);
  return inner(parts.of_b(f.edge[0], f.edge[1]), outer(outer(u, parts.d), u));
}
template <int Degree>
Real true_value(const certificates::PlaneApart& f, const TrueParts<Degree>& parts) {
  const RealVector n = outer(parts.of_a(f.face[0], f.face[1]), parts.of_a(f.face[0], f.face[2]));
  const Real height = inner(n, parts.d);
  return height * height - squared_radius(f.radii) * inner(n, n);
}
template <int Degree>
Real true_value(const certificates::LinesApart& f, const TrueParts<Degree>& parts) {
  const RealVector n = outer(parts.of_a(f.edge_a[0], f.edge_a[1]), parts.of_b(f.edge_b[0], f.edge_b[1]));
  const Real height = inner(n, parts.d);
  return height * height - squared_radius(f.radii) * inner(n, n);
}
template <int Degree, class Formula>
TrueValue true_value(const certificates::BetweenParts<Degree, Formula>& f, const TrueMotion<Degree>& a,
                     const TrueMotion<Degree>& b) {
  const RealVector x = a.position(f.x), y = b.position(f.y);
  const TrueParts<Degree> parts{a, b, x, y, y - x};
  const Real lengths = parts.lengths();  // with numbers of up to 3, all products are less than the sixth power
  return {true_value(f.formula, parts), lengths * lengths * lengths * lengths * lengths * lengths};
}

/// The true signs of a certificate at times near one time.
template <class Certificate>
class TrueSigns {
 public:
  TrueSigns(const Certificate& f, double near) : f_(f), near_(near), a_(f.a, near), b_(f.b, near) {}

  TrueValue value_at(double t) { return value(Real(t) - Real(near_)); }
  TrueValue value_after(double t, const Real& later) { return value(Real(t) - Real(near_) + later); }

  /// At t; 0 also where f is too small to tell.
  int at(double t) { return sign(Real(t) - Real(near_)); }

  /// Of the derivative at t, by a difference over 1e-30 of the time in which something turns; 0 where it is too small.
  int derivative_at(double t) {
    const Real rate = 1 + size_of(real(f_.a.angular_velocity)) + size_of(real(f_.b.angular_velocity));
    const Real h = Real("1e-30") / rate;
    const TrueValue after = value(Real(t) - Real(near_) + h);
    const Real change = after.value - value(Real(t) - Real(near_) - h).value;
    return abs(change) <= after.size * Real("1e-75") ? 0 : change.sign();
  }

  /// Just after t: where f(t) is zero, a while later, which must say the same twice.
  int after(double t) {
    if (const int s = at(t)) return s;
    const Real rate = 1 + size_of(real(f_.a.angular_velocity)) + size_of(real(f_.b.angular_velocity));
    const int s = sign(Real(t) - Real(near_) + ldexp(Real(1), -20) / rate);
    const int sooner = sign(Real(t) - Real(near_) + ldexp(Real(1), -28) / rate);
    return s == sooner ? s : 9;
  }

 private:
  TrueValue value(const Real& rest) {
    a_.to(rest);
    b_.to(rest);
    return true_value(f_, a_, b_);
  }
  int sign(const Real& rest) { return value(rest).sign(); }

  const Certificate& f_;
  double near_;
  TrueMotion<std::decay_t<decltype(Certificate::a)>::degree> a_, b_;
};

}  // namespace kds::tests
