#include "examples/jobs/granular_gas/gas.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace granular_gas {
namespace {

using Eigen::Vector3d;

/// Contacts of a ball within this time after another are elastic, in the units of GasOptions: far less than the time
/// between contacts, even at the highest packing, and only of inelastic gases.
constexpr double contact_duration = 1e-6;

/// Cells of the lattice along a side.
std::size_t cells(const GasOptions& options) {
  std::size_t m = 1;
  while (4 * m * m * m < options.balls) ++m;
  return m;
}

std::vector<double> draw_radii(const GasOptions& options) {
  ThermalVelocities random(options.seed);
  std::vector<double> radii(balls_on_lattice(options));
  const double smallest = 1 / (1 + options.size_ratio);  // the mean is 1/2
  for (double& radius : radii) radius = smallest + smallest * (options.size_ratio - 1) * random.uniform();
  return radii;
}

double side_of(const GasOptions& options, const std::vector<double>& radii) {
  double volume = 0;
  for (const double radius : radii) volume += 4 * std::numbers::pi / 3 * radius * radius * radius;
  const double side = std::cbrt(volume / options.packing);
  const double spacing = side / double(cells(options)) / std::numbers::sqrt2;
  const double widest = 2 * *std::max_element(radii.begin(), radii.end());
  if (!(spacing > widest)) {
    const double most = options.packing * std::pow(spacing / widest, 3);
    throw std::invalid_argument("packing: balls of a size ratio of " + std::to_string(options.size_ratio) +
                                " fit on the lattice up to " + std::to_string(most));
  }
  return side;
}

PeriodicOptions box(const GasOptions& options, double side) {
  PeriodicOptions periodic;
  periodic.max = Vector3d::Constant(side);
  periodic.shear_rate = options.shear_rate;
  periodic.elastic_within = options.restitution < 1 ? contact_duration : 0;
  return periodic;
}

const GasOptions& validated(const GasOptions& options) {
  validate(options);
  return options;
}

}  // namespace

void validate(const GasOptions& options) {
  const auto require = [](bool right, const char* what) {
    if (!right) throw std::invalid_argument(what);
  };
  require(options.balls >= 32 && options.balls <= 10'000'000, "balls: must be from 32 to 10 000 000");
  require(options.packing > 0 && options.packing < 0.74, "packing: must be in (0, 0.74)");
  require(options.size_ratio >= 1 && options.size_ratio <= 100, "size-ratio: must be in [1, 100]");
  require(options.restitution > 0 && options.restitution <= 1, "restitution: must be in (0, 1]");
  require(std::abs(options.shear_rate) <= 1e6, "shear-rate: must be in [-1e6, 1e6]");
}

std::size_t balls_on_lattice(const GasOptions& options) {
  const std::size_t m = cells(options);
  return 4 * m * m * m;
}

Gas::Gas(const GasOptions& options)
    : options_(validated(options)),
      radii_(draw_radii(options)),
      side_(side_of(options, radii_)),
      world_(box(options, side_), this) {
  ThermalVelocities random(options.seed + 1);
  const std::size_t m = cells(options);
  const double cell = side_ / double(m);
  std::vector<Vector3d> places, velocities;
  for (std::size_t i = 0; i < size(); ++i) {
    const std::size_t corner = i % 4, at = i / 4;
    Vector3d place(double(at % m), double(at / m % m), double(at / m / m));
    if (corner > 0) place += Vector3d::Constant(0.5) - 0.5 * Vector3d::Unit(Eigen::Index(corner - 1));
    places.push_back(cell * (place + Vector3d::Constant(0.25)));
    velocities.push_back(random.inside(1 / mass(i)));
  }
  // No momentum, and a temperature of exactly 1.
  Vector3d momentum = Vector3d::Zero();
  double masses = 0, energy = 0;
  for (std::size_t i = 0; i < size(); ++i) momentum += mass(i) * velocities[i], masses += mass(i);
  for (std::size_t i = 0; i < size(); ++i) {
    velocities[i] -= momentum / masses;
    energy += mass(i) * velocities[i].squaredNorm() / 2;
  }
  world_.reserve(size());
  for (std::size_t i = 0; i < size(); ++i) {
    Vector3d velocity = velocities[i] / std::sqrt(energy / (1.5 * double(size() - 1)));
    velocity[0] += options.shear_rate * places[i][1];
    world_.add_body({.shape = Sphere{radii_[i]},
                     .motion = {{{places[i], velocity}, 0}},
                     .mass = mass(i),
                     .restitution = options.restitution});
  }
}

void Gas::contact(PeriodicWorld<1>&, const PeriodicEvent& event) {
  const double distance = radii_[event.a] + radii_[event.b];
  const double e = options_.restitution;
  ++sums_.contacts;
  sums_.virial += event.impulse * distance;
  sums_.shear_virial += event.impulse * distance * event.contact.normal[0] * event.contact.normal[1];
  // impulse = reduced mass * (1 + e) * speed of approach; contacts that elastic_within makes elastic are so few.
  sums_.dissipated += event.impulse * event.impulse * (1 / mass(event.a) + 1 / mass(event.b)) * (1 - e) / (1 + e) / 2;
}

std::vector<Vector3d> Gas::peculiar_velocities() const {
  std::vector<Vector3d> velocities;
  Vector3d momentum = Vector3d::Zero();
  double masses = 0;
  for (std::size_t i = 0; i < size(); ++i) {
    Vector3d velocity = world_.velocity(i);
    velocity[0] -= options_.shear_rate * world_.position(i)[1];
    momentum += mass(i) * velocity;
    masses += mass(i);
    velocities.push_back(velocity);
  }
  for (Vector3d& velocity : velocities) velocity -= momentum / masses;
  return velocities;
}

double Gas::temperature() const {
  const std::vector<Vector3d> velocities = peculiar_velocities();
  double sum = 0;
  for (std::size_t i = 0; i < size(); ++i) sum += mass(i) * velocities[i].squaredNorm();
  return sum / (3 * double(size() - 1));
}

}  // namespace granular_gas
