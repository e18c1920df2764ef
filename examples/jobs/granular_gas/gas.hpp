// A gas of hard balls in a periodic box, and what its contacts add up to.
#pragma once

#include "collision/periodic/periodic_world.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace granular_gas {

using namespace kds::collision;

/// Units: the mean diameter, the mass of a ball of that diameter, and the temperature at the start (k = 1) are 1.
struct GasOptions {
  std::size_t balls = 1000;  ///< rounded up to what fills a face-centred cubic lattice, 4 m^3
  double packing = 0.3;      ///< the part of the volume that balls fill
  double size_ratio = 1;     ///< of the largest radius to the smallest; in between they are uniform
  double restitution = 1;
  double shear_rate = 0;
  std::uint64_t seed = 1;
};

/// Throws std::invalid_argument, naming the option that is out of range, or the greatest packing for this size ratio.
void validate(const GasOptions& options);
/// How many balls there will be.
std::size_t balls_on_lattice(const GasOptions& options);

/// Of all contacts so far.
struct ContactSums {
  std::uint64_t contacts = 0;
  double virial = 0;        ///< impulse times distance of centres
  double shear_virial = 0;  ///< the same times the x and the y of the normal
  double dissipated = 0;    ///< energy
};

/// Balls start on the lattice, with random velocities of temperature 1 about the shear flow.
class Gas final : private PeriodicListener<1> {
 public:
  explicit Gas(const GasOptions& options);

  void advance_to(double t) { world_.advance_to(t); }
  double now() const { return world_.now(); }

  std::size_t size() const { return radii_.size(); }
  double side() const { return side_; }
  double volume() const { return side_ * side_ * side_; }
  double radius(std::size_t i) const { return radii_[i]; }
  double mass(std::size_t i) const { return 8 * radii_[i] * radii_[i] * radii_[i]; }
  const std::vector<double>& radii() const { return radii_; }
  Eigen::Vector3d position(std::size_t i) const { return world_.position(i); }
  /// Where it would be, had it not been brought back into the box.
  Eigen::Vector3d unwrapped(std::size_t i) const {
    return world_.position(i) + world_.lattice().displacement(world_.crossings(i), world_.now());
  }

  /// Velocities about the mean flow, which is in proportion to y.
  std::vector<Eigen::Vector3d> peculiar_velocities() const;
  /// Two thirds of the energy of the peculiar velocities, over the number of balls less 1: they have no mean momentum.
  double temperature() const;
  const ContactSums& sums() const { return sums_; }
  const PeriodicWorld<1>& world() const { return world_; }

 private:
  void contact(PeriodicWorld<1>&, const PeriodicEvent& event) override;

  GasOptions options_;
  std::vector<double> radii_;
  double side_;
  PeriodicWorld<1> world_;
  ContactSums sums_;
};

}  // namespace granular_gas
