#include "examples/jobs/granular_gas/experiments.hpp"

#include "examples/jobs/cpu_time.hpp"
#include "examples/jobs/granular_gas/theory.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

namespace granular_gas {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t blocks = 20;            // of which errors are computed
constexpr std::size_t contacts_to_mix = 20;   // of each ball, before anything is measured: the lattice has melted
constexpr std::size_t samples_in_block = 20;  // of places

bool equal_balls(const GasOptions& options) { return options.size_ratio == 1; }

/// Mean contacts of a ball, of this many in all.
double of_each(const Gas& gas, std::uint64_t contacts) { return 2 * double(contacts) / double(gas.size()); }

void require_contacts(const Gas& gas, std::uint64_t contacts) {
  constexpr double least = 100;
  if (of_each(gas, contacts) >= least) return;
  throw std::invalid_argument("collisions: must be at least 50 times the number of balls, " +
                              std::to_string(gas.size()));
}

void mix(Gas& gas, double rate, double contacts_of_each) { gas.advance_to(gas.now() + contacts_of_each / rate); }

}  // namespace

Equilibrium equilibrium(const GasOptions& options, std::uint64_t contacts) {
  if (options.shear_rate != 0) throw std::invalid_argument("shear-rate: a gas in equilibrium is not sheared");
  if (options.restitution != 1) throw std::invalid_argument("restitution: a gas in equilibrium is elastic, 1");
  Gas gas(options);
  require_contacts(gas, contacts);
  const Mixture mixture(gas.radii(), gas.volume());
  const double theory_rate = enskog_rate(mixture, gas.radii());
  mix(gas, theory_rate, std::max(double(contacts_to_mix), of_each(gas, contacts) / 4));

  const double span = of_each(gas, contacts) / theory_rate / double(blocks);
  const double interval = span / double(samples_in_block);
  Displacements displacements(interval);
  RadialDistribution radial;
  std::vector<double> compressibilities, rates;
  const ContactSums start = gas.sums();
  const double started = gas.now();
  double seconds = 0, other = 0;
  displacements.sample(gas);
  jobs::CpuTime time;
  for (std::size_t block = 0; block < blocks; ++block) {
    const ContactSums before = gas.sums();
    for (std::size_t i = 1; i <= samples_in_block; ++i) {
      gas.advance_to(started + double(block) * span + double(i) * interval);
      time.charge(seconds);
      displacements.sample(gas);
      if (i % 5 == 0) radial.sample(gas);
      time.charge(other);
    }
    const double n = double(gas.size());
    compressibilities.push_back(1 + (gas.sums().virial - before.virial) / (3 * n * gas.temperature() * span));
    rates.push_back(2 * double(gas.sums().contacts - before.contacts) / (n * span));
  }
  // Between ten and thirty contacts of a ball, or what a short run has of that.
  const auto intervals = [&](double contacts_of_ball) {
    const auto wanted = static_cast<std::size_t>(std::ceil(contacts_of_ball / theory_rate / interval));
    return std::min(wanted, displacements.longest());
  };
  const std::size_t from = intervals(10), to = std::max(from + 1, intervals(30));
  const double contact_value = mixture.contact_value(1, 1), packing = mixture.packing;
  const bool equal = equal_balls(options);
  const Mean diffusion = displacements.diffusion(from, to);
  return {
      .balls = gas.size(),
      .contacts = gas.sums().contacts - start.contacts,
      .temperature = gas.temperature(),
      .compressibility = mean_of(compressibilities),
      .theory_compressibility = mixture.compressibility(),
      .rate = mean_of(rates),
      .theory_rate = theory_rate,
      .diffusion = diffusion,
      .diffusion_of_large_box = equal ? diffusion.value + diffusion_lost(packing, contact_value, gas.side()) : unknown,
      .theory_diffusion = equal ? enskog_diffusion(packing, contact_value) : unknown,
      .simulated_diffusion = equal ? simulated_diffusion(packing) : unknown,
      .contact_value = radial.at_contact(),
      .theory_contact_value = equal ? contact_value : unknown,
      .cpu_seconds = seconds,
      .displacements = std::move(displacements),
      .radial = std::move(radial)};
}

Sheared sheared(const GasOptions& options, std::uint64_t contacts,
                const std::function<void(const ShearedState&)>& tell) {
  if (options.shear_rate == 0) throw std::invalid_argument("shear-rate: must not be 0");
  if (options.restitution == 1) {
    throw std::invalid_argument("restitution: a sheared gas that is elastic gets hotter for ever");
  }
  constexpr std::size_t spans = 100;
  constexpr std::size_t samples = 10;  // in a span
  Gas gas(options);
  require_contacts(gas, contacts);
  std::vector<double> temperatures, stresses, dissipations, rates;
  double rate = enskog_rate(Mixture(gas.radii(), gas.volume()), gas.radii());
  const double n = double(gas.size());
  for (std::size_t i = 0; i < spans; ++i) {
    // As long as contacts at the present rate take; the temperature changes it.
    const double span = of_each(gas, contacts) / double(spans) / rate;
    const double start = gas.now();
    const ContactSums before = gas.sums();
    double temperature = 0, streaming = 0;
    for (std::size_t k = 1; k <= samples; ++k) {
      gas.advance_to(start + span * double(k) / double(samples));
      const std::vector<Eigen::Vector3d> velocities = gas.peculiar_velocities();
      for (std::size_t ball = 0; ball < gas.size(); ++ball) {
        const Eigen::Vector3d& v = velocities[ball];
        temperature += gas.mass(ball) * v.squaredNorm() / (3 * (n - 1) * double(samples));
        streaming += gas.mass(ball) * v[0] * v[1] / double(samples);
      }
    }
    const ContactSums& after = gas.sums();
    // The normal points to b, and so does the impulse that b gets: contacts press, as streaming does.
    const double contact_part = (after.shear_virial - before.shear_virial) / span;
    const ShearedState state{.time = gas.now(),
                             .temperature = temperature,
                             .stress = -(streaming + contact_part) / gas.volume(),
                             .dissipation = (after.dissipated - before.dissipated) / span / gas.volume(),
                             .rate = 2 * double(after.contacts - before.contacts) / (n * span)};
    rate = std::max(state.rate, rate / 2);
    tell(state);
    if (i < spans / 2) continue;
    temperatures.push_back(state.temperature);
    stresses.push_back(state.stress);
    dissipations.push_back(state.dissipation);
    rates.push_back(state.rate);
  }
  const Mixture mixture(gas.radii(), gas.volume());
  return {.temperature = mean_of(temperatures),
          .stress = mean_of(stresses),
          .dissipation = mean_of(dissipations),
          .rate = mean_of(rates),
          .theory_temperature = equal_balls(options) ? steady_temperature(mixture.packing, mixture.contact_value(1, 1),
                                                                          options.restitution, options.shear_rate)
                                                     : unknown};
}

double seconds_a_contact(const GasOptions& options, std::uint64_t contacts) {
  Gas gas(options);
  const double rate = enskog_rate(Mixture(gas.radii(), gas.volume()), gas.radii());
  mix(gas, rate, double(contacts_to_mix));
  const std::uint64_t before = gas.sums().contacts;
  double seconds = 0;
  jobs::CpuTime time;
  gas.advance_to(gas.now() + of_each(gas, contacts) / rate);
  time.charge(seconds);
  return seconds / double(gas.sums().contacts - before);
}

}  // namespace granular_gas
