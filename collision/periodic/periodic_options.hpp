// How a periodic world is to run.
#pragma once

#include "collision/world_options.hpp"

#include <Eigen/Core>

#include <array>
#include <cstdint>

namespace kds::collision {

/// What is at both ends of the box along an axis.
enum class Boundary {
  periodic,  ///< what leaves at one end comes in at the other
  walls,     ///< walls, which bodies do not pass
  open,      ///< nothing: the box has no ends there
};

/// Throughout, temperatures are in units of mass * speed^2: Boltzmann's constant is 1.
struct PeriodicOptions {
  /// Ends of the box, in units of length, finite where the axis is not open.
  Eigen::Vector3d min = Eigen::Vector3d::Zero();
  Eigen::Vector3d max = Eigen::Vector3d::Ones();
  std::array<Boundary, 3> boundaries{Boundary::periodic, Boundary::periodic, Boundary::periodic};
  /// Lees-Edwards, 1/s: the box above in y, and all in it, moves in x faster by this times the period in y, so that the
  /// mean velocity in x grows by this for each unit of y. Needs periodic x and y.
  double shear_rate = 0;
  double wall_restitution = 1;  ///< in [0, 1]; of a body and a wall the lower counts
  /// By wall, as in WallEvent. 0: the wall reflects. Above: a thermostat, a body leaves it with a velocity drawn from
  /// the flux of a gas of this temperature (thermal_velocities.hpp). Only where there are walls.
  std::array<double, 6> wall_temperatures{};
  std::uint64_t seed = 1;  ///< of what thermostats draw
  /// s, >= 0: a contact of a body that has had another within this time is elastic. Inelastic gases need it: their
  /// contacts may pile up in time (inelastic collapse). [Luding98]
  double elastic_within = 0;
  /// The other options. `response`, `law` and `walls` are for the periodic world to choose and must not be given, nor
  /// `report_pairs` or `report_pieces`.
  WorldOptions world{};
};

/// Throws std::invalid_argument, naming the option, for one that is out of range or does not fit the others.
void validate(const PeriodicOptions& options);

}  // namespace kds::collision
