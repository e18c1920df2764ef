// The margins of mesh contact: how near counts as contact, and how much larger volumes and boxes have to be for that.
#pragma once

#include "certificates/point_motion.hpp"
#include "collision/broad_phase/kinetic_box.hpp"
#include "collision/narrow_phase/relative_motion.hpp"
#include "collision/shapes/shape.hpp"
#include "collision/vectors.hpp"
#include "kds/arithmetic/lattice.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace kds::collision {

/// Polynomial in tau >= 0: two surfaces nearer than this count as touching.
///
/// This margin covers every rounding of the tests of meshes, which are made in doubles. So no contact is missed or
/// found late, and none slips between two triangles that share an edge; the price is that contact is found early by at
/// most this gap (in a corner, measured along each of the separating axes that meet there).
///
/// gap(tau) = `roundings` (S + |r0| + |r1| tau + |r2| tau^2) + `clock` |epoch| |velocity| + uncertainty of r, with S
/// the sum of the shapes' radii. Derivation, in units of 2^-53 and of the bracket: the rotation matrix has entries
/// good to 6 and placed_vertex adds 4 (in all at most 10 sqrt 3 < 18 times a vertex); projections of vertices on a
/// unit axis and their differences 8; of r 4 for each coefficient and 3 for their sum; normalising the axis 4, axes
/// that are not quite across their edges 8 (every_axis); the roots of the closed forms solve a polynomial whose
/// coefficients are off by 6, and rounding tau moves it by 2. That is 53 at most; 64 leaves room, and makes the time in
/// which two parallel faces pass each other last at least 11 roundings of tau, so that it never falls between two
/// doubles. `clock`: the time of a contact, epoch + tau, is rounded to a double by less than one spacing (2^-52
/// |epoch|); within four spacings two bodies must neither pass each other undetected nor, after an impulse at the
/// rounded time, be on the wrong sides of each other.
///
/// Paths of degree n >= 3 have further terms |r_i| tau^i in the bracket. Their conditions are solved exactly
/// (curve_spans.hpp), which saves the 6 of the roots, and subtracting the gap adds 1; the clock's rounding of tau moves
/// them by 2 n; places by Horner's rule, which only decide ties of directions, are good to 2 n + 1. That is 18 + 8 + 4
/// + 4 + 8 + 1 + 2 n = 53 for n = 5; 128 is charged, so that ties (a quarter of it) have room too.
template <int Degree>
struct ContactGap {
  static constexpr double roundings = (Degree <= 2 ? 64 : 128) * 0x1p-53;
  static constexpr double clock = 4 * 0x1p-52;

  std::array<double, std::size_t{Degree} + 1> c;

  double operator()(double tau) const {
    if constexpr (Degree == 1) {
      return c[0] + tau * c[1];
    } else if constexpr (Degree == 2) {
      return c[0] + tau * (c[1] + tau * c[2]);
    } else {
      double sum = c[Degree];
      for (std::size_t i = Degree; i-- > 0;) sum = c[i] + tau * sum;
      return sum;
    }
  }
};

template <int Degree>
ContactGap<Degree> contact_gap(const RelativeMotion<Degree>& motion, double radii) {
  ContactGap<Degree> gap;
  const double clock = ContactGap<Degree>::clock * std::abs(motion.epoch);
  double size = radii;
  for (std::size_t i = 0; i <= Degree; ++i) {
    size += norm(motion.coefficients[i]);
    gap.c[i] = ContactGap<Degree>::roundings * size + motion.uncertainty[i];
    if (i < Degree) gap.c[i] += clock * static_cast<double>(i + 1) * norm(motion.coefficients[i + 1]);
    size = 0;
  }
  return gap;
}

/// Contact is reported while shapes are no farther than this many contact gaps apart: 1 + 53/64 gaps along each
/// separating axis (see ContactGap), and between corners that face each other up to 11.4 times as far, if one of them
/// is blunt (every_kdop_direction). For corners of 60 degrees or more it is 5.2 gaps; most contacts are not between
/// corners.
inline constexpr double farthest_contact = 21;

/// Gaps by which boxes and quick tests are widened, see BoxPairTest: so they include every contact, with a margin for
/// rounding in doubles.
inline constexpr double quick_margin = 24;
static_assert(quick_margin > farthest_contact);

/// No contacts are predicted for times at which the contact gap has grown to this part of the radii, and fourfold. On a
/// straight path that happens only if its speed is a rounding error (bodies that move alike), on a curved one if it
/// goes out 2^40 radii and comes back. A larger value predicts more of such contacts, and more slowly.
inline constexpr double widest_gap = 0x1p-7;

/// By how much the bounding volume of a body has to extend beyond its shape in a world with meshes, so that volumes
/// overlap as long as contact may be reported, and contacts do not depend on the broad phase: the contact gap belongs
/// to a pair, a volume to one body, so each of the two has a share of it.
///
/// The share of a body with path p0 + v tau + a tau^2 from its start s on, and of radius R, is the polynomial
///     share(tau) = `roundings` (R + |p0| + |v| tau + |a| tau^2) + `clock` (|s| + tau) (|v| + 2 |a| tau)
/// with the sums of magnitudes of coordinates for |.|, which are not below the lengths. Law: while contact is
/// reported, a mesh and another shape are no farther apart, in any direction, than the sum of their two shares.
///
/// Derivation. u = 2^-53; tau_a and tau_b count from the starts of the two bodies, tau from the later one, the epoch.
/// (1) Written about the epoch, a path has |p0'| + |v'| tau + |a| tau^2 <= |p0| + |v| tau_a + |a| tau_a^2 (the triangle
/// inequality), and |v'| + 2 |a| tau <= |v| + 2 |a| tau_a; |epoch| <= |s| + tau_a, for each of the two. So the sums of
/// the brackets of both bodies are not below those of ContactGap. (2) The uncertainty of the relative coefficients is
/// at most 14 u of these sums: seven operations, charged 2 u each. With the roundings of ContactGap that is 78 u. (3)
/// Contact is reported up to `farthest_contact` gaps away: 1638 u and 84 x 2^-52. (4) The time of a separation is
/// rounded up to a double, by one spacing, 2^-52 (|s| + tau_a) at most, and tau by u: 1 x 2^-52 of `clock`, 1 u of
/// `roundings`. 1792 and 96 leave room for what is rounded here and where ends are moved.
///
/// Paths of degree n >= 3 have the terms |p_i| tau^i and i |p_i| tau^(i-1) in the brackets. The uncertainty of their
/// relative coefficients is at most (5.1 n + 4) u of the sums (detail::shifted_balls() in kds/motion.hpp), 30 u for
/// n = 5: with the 128 u of ContactGap that is 158 u, and 21 times as much 3318 u; 4096 is charged.
///
/// A volume is grown by a constant as long as that is enough: so its corners move alike, and it is not renewed. After
/// that its ends move apart as the share grows, which is always enough: at most one renewal for each motion.
template <int Degree>
class MeshClearance {
 public:
  static constexpr double roundings = (Degree <= 2 ? 1792 : 4096) * 0x1p-53;
  static constexpr double clock = 96 * 0x1p-52;

  MeshClearance(const certificates::PointMotion<Degree>& motion, double radius) : least_(box_margin * radius) {
    std::array<double, std::max<std::size_t>(3, std::size_t{Degree} + 1)> size{};
    for (std::size_t i = 0; i <= Degree; ++i) {
      const Eigen::Vector3d& c = motion.coefficients[i];
      size[i] = std::abs(c[0]) + std::abs(c[1]) + std::abs(c[2]);
    }
    const double start = std::abs(motion.start);
    if constexpr (Degree <= 2) {
      const auto& [position, velocity, half_acceleration] = size;
      share_[0] = roundings * (radius + position) + clock * start * velocity;
      share_[1] = roundings * velocity + clock * (velocity + 2 * start * half_acceleration);
      if constexpr (Degree >= 2) share_[2] = (roundings + 2 * clock) * half_acceleration;
    } else {
      for (std::size_t i = 0; i <= Degree; ++i) {
        const auto power = static_cast<double>(i);
        const double next = i < Degree ? (power + 1) * size[i + 1] : 0.0;
        share_[i] = roundings * size[i] + clock * (power * size[i] + start * next);
      }
      share_[0] += roundings * radius;
    }
    constant_ = std::max(least_, 2 * share_[0]);
    holds_until_ = motion.start + lasts() * (1 - 0x1p-50);
    if (holds_until_ < never) holds_until_ = next_down(holds_until_);
  }

  /// Not less than the share until `holds_until()`, on the clock; that is `never` if it always is.
  double constant() const { return constant_; }
  double holds_until() const { return holds_until_; }
  /// Whether the constant is the part of the radius by which boxes of meshes are grown anyway.
  bool is_least() const { return constant_ == least_; }

  /// Not less than the share, and than the constant, from the motion's start on.
  std::array<double, std::size_t{Degree} + 1> growing() const {
    std::array<double, std::size_t{Degree} + 1> growth = share_;
    growth[0] = least_ + 2 * share_[0];
    return growth;
  }

  const std::array<double, std::size_t{Degree} + 1>& share() const { return share_; }

 private:
  /// A time, in seconds from the start, at which the share is not above the constant.
  double lasts() const {
    const double room = constant_ - share_[0];
    if constexpr (Degree >= 3) {
      // By bisection, from a time that is long enough for anything.
      const auto drift = [this](double time) {
        double sum = 0;
        for (std::size_t i = Degree; i > 0; --i) sum = (sum + share_[i]) * time;
        return sum;
      };
      if (!(drift(1) > 0)) return never;
      double time = 0x1p400;
      while (time > 0 && !(drift(time) <= room)) time *= 0.5;
      return time;
    } else if constexpr (Degree == 1) {
      return share_[1] > 0 ? room / share_[1] : never;
    } else {
      double time = share_[1] > 0 ? 0.5 * room / share_[1] : never;
      if (share_[2] > 0) time = std::min(time, std::sqrt(0.5 * room / share_[2]));
      return time;
    }
  }

  std::array<double, std::size_t{Degree} + 1> share_;
  double least_;
  double constant_;
  double holds_until_;
};

/// Moves the ends of a box apart by a polynomial of the time since `start`. Precondition: the box is used from then on
/// alone.
///
/// About another start, d earlier or later, the polynomial's value is the same; where its coefficients are rounded, by
/// 2^-52 of their sum, the growth has more room than that.
template <int Degree>
void grow(KineticBox<Degree>& box, std::array<double, std::size_t{Degree} + 1> growth, double start) {
  const auto about = [&](double epoch) {
    std::array<double, std::size_t{Degree} + 1> g = growth;
    const double d = epoch - start;
    if constexpr (Degree >= 3) {
      g = taylor_shift<double>(Polynomial<Degree>{g}, d).c;
    } else if constexpr (Degree == 1) {
      g[0] += d * g[1];
    } else {
      g[0] += d * (g[1] + d * g[2]);
      g[1] += 2 * d * g[2];
    }
    return g;
  };
  const auto of_min = about(box.min.start);
  const auto of_max = about(box.max.start);
  for (std::size_t i = 0; i <= Degree; ++i) {
    box.min.coefficients[i].array() -= of_min[i];
    box.max.coefficients[i].array() += of_max[i];
  }
}

}  // namespace kds::collision
