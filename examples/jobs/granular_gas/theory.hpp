// What theory says of gases of hard balls: equations of state and kinetic theory, for temperature 1.
#pragma once

#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace granular_gas {

/// Moments of the diameters of a mixture, whose masses are the cubes of their diameters.
struct Mixture {
  double packing;
  double number_density;
  double mean = 0, square = 0, cube = 0;  ///< of the diameters

  Mixture(const std::vector<double>& radii, double volume) : number_density(double(radii.size()) / volume) {
    for (const double radius : radii) {
      const double d = 2 * radius, share = 1 / double(radii.size());
      mean += d * share, square += d * d * share, cube += d * d * d * share;
    }
    packing = std::numbers::pi / 6 * number_density * cube;
  }

  /// The radial distribution of two diameters at contact: [Boublik70]; of equal balls that of [Carnahan69].
  double contact_value(double a, double b) const {
    const double free = 1 - packing, x = packing * square / cube * 2 * a * b / (a + b);
    return 1 / free + 1.5 * x / (free * free) + 0.5 * x * x / (free * free * free);
  }

  /// P V / (N T): [Mansoori71]; of equal balls (1 + p + p^2 - p^3) / (1 - p)^3 [Carnahan69].
  double compressibility() const {
    const double free = 1 - packing;
    return 1 / free + 3 * packing * mean * square / cube / (free * free) +
           packing * packing * (3 - packing) * square * square * square / (cube * cube) / (free * free * free);
  }
};

/// Contacts of a ball in unit time, by Enskog: mean over some of the balls, each with some of the others.
inline double enskog_rate(const Mixture& mixture, const std::vector<double>& radii) {
  const std::size_t count = radii.size() < 500 ? radii.size() : 500;
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j < count; ++j) {
      const double a = 2 * radii[i], b = 2 * radii[j], distance = (a + b) / 2;
      const double inverse_masses = 1 / (a * a * a) + 1 / (b * b * b);
      sum += distance * distance * std::sqrt(2 * std::numbers::pi * inverse_masses) * mixture.contact_value(a, b);
    }
  }
  return 2 * mixture.number_density * sum / double(count * count);
}

// Of equal balls of diameter 1 and mass 1.

/// Enskog's coefficient of self-diffusion, with Sonine's corrections [Chapman70].
inline double enskog_diffusion(double packing, double contact_value) {
  return 1.0190 * std::sqrt(1 / std::numbers::pi) * 3 / 8 / (6 / std::numbers::pi * packing * contact_value);
}

/// The same by a fit to simulations, within some per cent [Speedy87].
inline double simulated_diffusion(double packing) {
  const double n = 6 / std::numbers::pi * packing;
  return 1.0190 * std::sqrt(1 / std::numbers::pi) * 3 / 8 / n * (1 - n / 1.09) * (1 + n * n * (0.4 - 0.83 * n * n));
}

/// Enskog's viscosity at temperature 1.
inline double enskog_viscosity(double packing, double contact_value) {
  const double b = 4 * packing;
  return 1.016 * 5 / 16 / std::sqrt(std::numbers::pi) * (1 / contact_value + 0.8 * b + 0.7614 * b * b * contact_value);
}

/// How much less diffusion there is in a periodic box than in a large one, since balls drag each other's images along
/// [Yeh04]: 2.837 T / (6 pi viscosity side).
inline double diffusion_lost(double packing, double contact_value, double side) {
  return 2.837297 / (6 * std::numbers::pi * enskog_viscosity(packing, contact_value) * side);
}

/// The temperature at which a sheared gas loses as much in contacts as shear brings in, with Enskog's viscosity and
/// rate: a contact takes (1 - e^2) T on the average.
inline double steady_temperature(double packing, double contact_value, double restitution, double shear_rate) {
  const double n = 6 / std::numbers::pi * packing;
  const double loss = n * 2 * n * std::sqrt(std::numbers::pi) * contact_value * (1 - restitution * restitution);
  return shear_rate * shear_rate * enskog_viscosity(packing, contact_value) / loss;
}

}  // namespace granular_gas
