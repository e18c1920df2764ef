// Gauss's principle of least constraint: what bodies in contact do instead of moving into each other.
#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <span>

namespace kds::collision {

/// Two bodies that touch and must not come nearer to each other along the normal.
struct Touch {
  std::uint32_t a;         ///< place among the rates
  std::uint32_t b;
  Eigen::Vector3d normal;  ///< unit, from a to b
  double inverse_mass_a;   ///< 0: a is fixed; not both
  double inverse_mass_b;
  double push = 0;         ///< what the touch adds to the relative rate, >= 0; in: a guess
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
/// Elsewhere the relative rate is up to some 2^-48 of the largest rate above zero, so that what is held parts,
/// very slowly, rather than sinks in.
///
/// Cost: a linear solve or a few where the guesses push where the solution does, up to some n of them else. Above 64
/// touches, touches x sweeps; a chain of n equal masses takes about 6 n sweeps. Both are bounded.
bool least_constraint(std::span<Eigen::Vector3d> rates, std::span<Touch> touches);

/// The relative normal rate of a touch: positive where the bodies part.
double parting_rate(std::span<const Eigen::Vector3d> rates, const Touch& touch);

/// Relative rates of magnitude below this times the largest rate are rounding.
inline constexpr double rate_rounding = 0x1p-40;

}  // namespace kds::collision
