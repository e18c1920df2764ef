// What rounding does to energy and momentum over many contacts.
//
//     bench_drift [DIRECTORY [CONTACTS [SEEDS]]]      -> drift.csv; 1 000 000 contacts, one seed
//
// 64 elastic balls in a box with walls (packing 0.15). Of each contact the changes of energy and momentum are taken in
// long doubles; walls turn one coordinate of a velocity round, which is exact. Were roundings random and unbiased, the
// sums would be of the size of the root of the sum of squares: columns `expected`. `bias` is the mean change of energy
// at a contact over the energy of the two balls, in units of its standard error. Then [Galperin03]: 3141 bounces
// between masses of ratio 1e6.

#include "tests/benchmarks/accuracy/bounces.hpp"
#include "tests/benchmarks/accuracy/gas.hpp"

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

namespace {

using namespace accuracy;

struct Case {
  const char* name;
  int degree;
  GasOptions options;
};

template <int Degree>
void measure(const Case& c, std::uint64_t contacts, std::ofstream& csv) {
  Gas<Degree> gas(c.options);
  for (int half_decade = 4;; ++half_decade) {
    const auto n = static_cast<std::uint64_t>(std::llround(std::pow(10.0, 0.5 * half_decade)));
    if (n > contacts) break;
    gas.run_to(n);
    const Drift& d = gas.drift();
    const Long count = static_cast<Long>(n);
    char line[512];
    std::snprintf(line, sizeof line, "%s,%d,%llu,%llu,%.3Lg,%.3Lg,%.3Lg,%.3Lg,%.3Lg,%.2Lf,%.3Lg,%llu\n", c.name, Degree,
                  static_cast<unsigned long long>(c.options.seed), static_cast<unsigned long long>(n), d.all_energy,
                  std::sqrt(d.energy_square), d.momentum.norm() / gas.momentum_scale(),
                  std::sqrt(d.momentum_square) / gas.momentum_scale(), std::sqrt(d.pair_energy_square / count),
                  d.pair_energy / std::sqrt(d.pair_energy_square), d.worst_energy,
                  static_cast<unsigned long long>(gas.world().counters().rebounds_suppressed));
    csv << line << std::flush;
    std::fputs(line, stdout);
  }
}

void bounces(double mass_ratio) {
  const Bounces found(mass_ratio);
  const auto exact = exact_bounces(mass_ratio);
  double worst = 0;
  for (std::size_t i = 0; i < std::min(found.times().size(), exact.size()); ++i) {
    worst = std::max(worst, std::abs(found.times()[i] - exact[i]) / exact[i]);
  }
  const double energy = mass_ratio / 2;
  const double now =
      0.5 * (mass_ratio * found.heavy_speed() * found.heavy_speed() + found.light_speed() * found.light_speed());
  std::printf("bounces at mass ratio %g: %zu, with a hundred digits %zu; times differ by %.2g at most (relative), "
              "energy by %.2g, rebounds suppressed %llu\n",
              mass_ratio, found.times().size(), exact.size(), worst, (now - energy) / energy,
              static_cast<unsigned long long>(found.rebounds_suppressed()));
}

}  // namespace

int main(int argc, char** argv) {
  const std::filesystem::path folder = argc > 1 ? argv[1] : ".";
  const auto contacts = static_cast<std::uint64_t>(argc > 2 ? std::atoll(argv[2]) : 1'000'000);
  const int seeds = argc > 3 ? std::atoi(argv[3]) : 1;
  try {
    if (contacts < 100 || seeds < 1) throw std::runtime_error("usage: bench_drift [DIRECTORY [CONTACTS [SEEDS]]]");
    for (const double ratio : {1e2, 1e4, 1e6, 1e8}) bounces(ratio);
    std::filesystem::create_directories(folder);
    std::ofstream csv(folder / "drift.csv");
    if (!csv) throw std::runtime_error("cannot write " + (folder / "drift.csv").string());
    csv << "case,degree,seed,contacts,energy,energy_expected,momentum,momentum_expected,rms_at_contact,bias,"
           "worst_at_contact,held\n";
    std::fputs("case,degree,seed,contacts,energy,energy_expected,momentum,momentum_expected,rms_at_contact,bias,"
               "worst_at_contact,held\n", stdout);
    for (int seed = 1; seed <= seeds; ++seed) {
      std::vector<Case> cases{{"near", 1, {}},
                              {"mass ratio 1e6", 1, {.mass_ratio = 1e6}},
                              {"mass ratio 1e3", 1, {.mass_ratio = 1e3}},
                              {"clock 1e9", 1, {.start_time = 1e9}},
                              {"coordinates 1e8", 1, {.offset = 1e8}},
                              {"speed 1e-9", 1, {.speed = 1e-9}},
                              {"speed 1e9", 1, {.speed = 1e9}},
                              {"gravity", 2, {.gravity = 1}}};
      for (Case& c : cases) {
        c.options.seed = static_cast<std::uint64_t>(seed);
        if (c.degree == 1) measure<1>(c, contacts, csv);
        if (c.degree == 2) measure<2>(c, contacts, csv);
      }
    }
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_drift: %s\n", error.what());
    return 1;
  }
}
