// Runs of a gas, and what they measure beside what theory says.
#pragma once

#include "examples/jobs/granular_gas/gas.hpp"
#include "examples/jobs/granular_gas/measures.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace granular_gas {

/// A gas in equilibrium. Theory: NaN where it is of equal balls only, and these are not.
struct Equilibrium {
  std::size_t balls;
  std::uint64_t contacts;  ///< measured
  double temperature;      ///< at the end; it was 1
  Mean compressibility;    ///< P V / (N T)
  double theory_compressibility;
  Mean rate;  ///< contacts of a ball in unit time
  double theory_rate;
  Mean diffusion;
  double diffusion_of_large_box;  ///< with diffusion_lost() added
  double theory_diffusion, simulated_diffusion;
  double contact_value;
  double theory_contact_value;
  double cpu_seconds;  ///< of the contacts measured, without the measuring
  Displacements displacements;
  RadialDistribution radial;
};

/// Runs a gas until a number of contacts has been measured, after a quarter as many and at least 20 a ball. Throws
/// std::invalid_argument for a gas that is sheared or inelastic, and for fewer than 100 contacts a ball.
Equilibrium equilibrium(const GasOptions& options, std::uint64_t contacts);

/// A sheared gas at a time.
struct ShearedState {
  double time;         ///< from the start
  double temperature;  ///< of the peculiar velocities
  double stress;       ///< -P_xy, mean since the state before
  double dissipation;  ///< energy that contacts take, by volume and time, mean since the state before
  double rate;         ///< contacts of a ball in unit time, mean since the state before
};

struct Sheared {
  Mean temperature, stress, dissipation, rate;  ///< of the second half
  double theory_temperature;                    ///< NaN unless balls are equal
};

/// Runs a sheared gas for a number of contacts, in 100 spans of time, of which each state is told. Throws
/// std::invalid_argument for a gas that is not sheared, or is elastic: it would get hotter for ever.
Sheared sheared(const GasOptions& options, std::uint64_t contacts,
                const std::function<void(const ShearedState&)>& tell);

/// CPU seconds a contact, after some 20 contacts a ball.
double seconds_a_contact(const GasOptions& options, std::uint64_t contacts);

}  // namespace granular_gas
