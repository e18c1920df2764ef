// Gauss's principle of least constraint: how bodies in contact move without penetrating.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <span>

namespace kds::collision {

/// Two bodies that touch and must not come nearer to each other along the normal.
struct Touch {
  std::uint32_t a;  ///< place among the rates
  std::uint32_t b;
  Eigen::Vector3d normal;  ///< unit, from a to b
  double inverse_mass_a;   ///< 0: a is fixed; not both
  double inverse_mass_b;
  double push = 0;   ///< what the touch adds to the relative rate, >= 0; on entry a guess
  double least = 0;  ///< the least relative rate that is allowed: below 0 where there is a gap to be closed
};

/// Changes rates (velocities, or accelerations, of bodies) as little as possible, measured by mass, so that at every
/// touch normal . (rate_b - rate_a) >= 0. Pushes are frictionless, along the normals, equal and opposite.
/// Returns whether that was achieved; if not (a body between two that close in, or a pile too large to be solved within
/// the bounds below), some touches are left violated.
///
/// Paper: [Gauss1829]; the sign conditions make it the linear complementarity problem of [Baraff94]. Up to 64 touches
/// it is solved by active sets [Lawson74], above that by projected successive over-relaxation [Cryer71]; neither needs
/// touches to be independent of each other.
///
/// Rounding: along the axes (all normals are unit vectors of an axis) bodies at rest come out at rest, exactly.
/// Elsewhere the relative rate is up to some 2^-48 of the largest rate above zero, so that bodies in contact part, very
/// slowly, rather than sink in.
///
/// Cost for n touches: one or a few linear solves if the guesses are positive where the solution is, otherwise up to
/// some n of them. Above 64 touches, touches x sweeps; a chain of n equal masses takes about 6 n sweeps. Both are
/// bounded.
bool least_constraint(std::span<Eigen::Vector3d> rates, std::span<Touch> touches);

/// The same up to a tolerance, with at most `most_sweeps` visits of each touch: for many bodies whose pushes were
/// solved a short time before. Returns whether no relative rate is below the allowed one by more than the tolerance.
bool nearly_least_constraint(std::span<Eigen::Vector3d> rates, std::span<Touch> touches, double tolerance,
                             std::size_t most_sweeps);

/// Pushes the two of a touch apart: changes their relative rate by `amount`. If one is fixed the other takes all of it,
/// exactly.
inline void give_push(std::span<Eigen::Vector3d> rates, Touch& touch, double amount) {
  touch.push += amount;
  const double sum = touch.inverse_mass_a + touch.inverse_mass_b;
  if (touch.inverse_mass_a != 0) rates[touch.a] -= (amount * (touch.inverse_mass_a / sum)) * touch.normal;
  if (touch.inverse_mass_b != 0) rates[touch.b] += (amount * (touch.inverse_mass_b / sum)) * touch.normal;
}

/// The relative normal rate of a touch: positive where the bodies part.
inline double parting_rate(std::span<const Eigen::Vector3d> rates, const Touch& touch) {
  const Eigen::Vector3d& a = rates[touch.a];
  const Eigen::Vector3d& b = rates[touch.b];
  return touch.normal[0] * (b[0] - a[0]) + touch.normal[1] * (b[1] - a[1]) + touch.normal[2] * (b[2] - a[2]);
}

/// Relative rates of magnitude below this times the largest rate count as rounding errors.
inline constexpr double rate_rounding = 0x1p-40;

}  // namespace kds::collision
