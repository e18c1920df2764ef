// What was wanted, and what was measured.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace speed {

struct Settings {
  std::filesystem::path folder;  ///< to write CSV into
  bool quick = false;            ///< small sizes and few rounds: shows that all works, measures nothing
  double cells_seconds = 480;    ///< wall clock; no further cell is begun after it
  int samples = 5;               ///< scenes of different seeds, where a figure is the mean over such
};

/// A row of the table of targets.
struct Target {
  std::string what;
  double measured;
  char relation;  ///< '>' or '<': the measured should be at least or at most
  double wanted;
  std::string unit;

  bool met() const { return relation == '>' ? measured >= wanted : measured <= wanted; }
};

/// Parts of the benchmark; each writes its CSV, prints it, and returns its rows of the table.
std::vector<Target> measure_peers(const Settings& settings);
std::vector<Target> measure_arena(const Settings& settings);
std::vector<Target> measure_rings(const Settings& settings);
std::vector<Target> measure_cells(const Settings& settings);
std::vector<Target> measure_growth(const Settings& settings);
std::vector<Target> measure_gas(const Settings& settings);
std::vector<Target> measure_floors(const Settings& settings);
std::vector<Target> measure_compounds(const Settings& settings);
std::vector<Target> measure_models(const Settings& settings);
std::vector<Target> measure_threads(const Settings& settings);
std::vector<Target> measure_bodies(const Settings& settings);
std::vector<Target> measure_frequency(const Settings& settings);
std::vector<Target> measure_one_hertz(const Settings& settings);

}  // namespace speed
