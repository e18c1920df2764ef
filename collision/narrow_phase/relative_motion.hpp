// The motion of one body seen from another, and how near counts as contact.
#pragma once

#include "certificates/point_motion.hpp"
#include "kds/arithmetic/ball.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace kds::collision {

/// Products and sums in one fixed order: the same bits whatever Eigen is told about vector instructions.
inline double dot(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Eigen::Vector3d cross(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Centre of b minus centre of a: coefficients of a polynomial in tau, the time since the epoch of the pair. Bodies do
/// not rotate, so this is all that moves in a pair.
template <int Degree>
struct RelativeMotion {
  std::array<Eigen::Vector3d, std::size_t{Degree} + 1> coefficients;
  std::array<double, std::size_t{Degree} + 1> uncertainty{};  ///< how far each coefficient may be from the true one
  double epoch = 0;                              ///< s; the clock's value at tau = 0

  Eigen::Vector3d position(double tau) const {
    if constexpr (Degree == 1) {
      return coefficients[0] + tau * coefficients[1];
    } else {
      return coefficients[0] + tau * (coefficients[1] + tau * coefficients[2]);
    }
  }
  Eigen::Vector3d velocity(double tau) const {
    if constexpr (Degree == 1) {
      return coefficients[1];
    } else {
      return coefficients[1] + (2 * tau) * coefficients[2];
    }
  }
  Eigen::Vector3d acceleration() const {
    if constexpr (Degree == 1) {
      return Eigen::Vector3d::Zero();
    } else {
      return 2 * coefficients[2];
    }
  }
};

/// The motion of b seen from a. The epoch is the later of the two starts: a function of the motions alone.
template <int Degree>
RelativeMotion<Degree> relative_to(const certificates::PointMotion<Degree>& a,
                                   const certificates::PointMotion<Degree>& b) {
  RelativeMotion<Degree> relative;
  relative.epoch = std::max(a.start, b.start);
  const auto r = certificates::relative_motion<Ball<double>>(a, b, relative.epoch);
  for (std::size_t i = 0; i <= Degree; ++i) {
    for (std::size_t d = 0; d < 3; ++d) {
      relative.coefficients[i][static_cast<Eigen::Index>(d)] = r[d].c[i].middle;
      relative.uncertainty[i] += r[d].c[i].radius;
    }
  }
  return relative;
}

/// Polynomial in tau >= 0: two surfaces nearer than this count as touching.
///
/// This margin pays for every rounding of the tests of meshes, which are made in doubles. So no contact is missed or
/// found late, and none slips between two triangles that share an edge; the price is that contact is found early by
/// at most this gap (in a corner, measured along each of the separating axes that meet there).
///
/// gap(tau) = `roundings` (S + |r0| + |r1| tau + |r2| tau^2) + `clock` |epoch| |velocity| + uncertainty of r, with S
/// the sum of the shapes' radii. Derivation, in units of 2^-53 and of the bracket: the rotation matrix has entries
/// good to 6 and placed_vertex adds 4 (in all at most 10 sqrt 3 < 18 times a vertex); projections of vertices on a
/// unit axis and their differences 8; of r 4 for each coefficient and 3 for their sum; normalising the axis 4; the
/// roots of the closed forms solve a polynomial whose coefficients are off by 6, and rounding tau moves it by 2. That
/// is 45 at most; 64 leaves room, and makes the time in which two parallel faces pass each other last at least 19
/// roundings of tau, so that it never falls between two doubles. `clock`: the time of a contact, epoch + tau, is
/// rounded to a double by less than one spacing (2^-52 |epoch|); within four spacings two bodies must not pass each
/// other unseen nor, after an impulse at the rounded time, find themselves on the wrong side.
template <int Degree>
struct ContactGap {
  static constexpr double roundings = 64 * 0x1p-53;
  static constexpr double clock = 4 * 0x1p-52;

  std::array<double, std::size_t{Degree} + 1> c;

  double operator()(double tau) const {
    if constexpr (Degree == 1) {
      return c[0] + tau * c[1];
    } else {
      return c[0] + tau * (c[1] + tau * c[2]);
    }
  }
};

template <int Degree>
ContactGap<Degree> contact_gap(const RelativeMotion<Degree>& motion, double radii) {
  ContactGap<Degree> gap;
  const double clock = ContactGap<Degree>::clock * std::abs(motion.epoch);
  double size = radii;
  for (std::size_t i = 0; i <= Degree; ++i) {
    size += motion.coefficients[i].norm();
    gap.c[i] = ContactGap<Degree>::roundings * size + motion.uncertainty[i];
    if (i < Degree) gap.c[i] += clock * static_cast<double>(i + 1) * motion.coefficients[i + 1].norm();
    size = 0;
  }
  return gap;
}

}  // namespace kds::collision
