// Drones around a mast: proved free, with the least clearance, or their first contact (docs/free_trajectory.md).
#include "examples/jobs/arguments.hpp"
#include "examples/jobs/free_trajectory/proof.hpp"
#include "examples/jobs/free_trajectory/scene.hpp"

#include <cstdint>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using namespace free_trajectory;

constexpr const char* usage =
    "usage: free_trajectory [DRONES [SEED [GAPS.csv]]]\n"
    "Proves that DRONES (8) on random paths (SEED, 1) around a mast meet nothing, then finds where one meets a cable.\n"
    "GAPS.csv is written: how far that one is from the cable around that time.\n";

constexpr double rate = 100;  // Hz, of the check by sampling
constexpr int phases = 10;    // of it that are tried

void prove(const char* title, const Scene& scene) {
  std::cout << title << ": ";
  if (const auto meeting = first_meeting(scene)) {
    std::cout << "NOT FREE: " << meeting->second << " meets " << meeting->first << " at " << meeting->time << " s\n";
  } else if (const auto clearance = least_clearance(scene, 10, 0.001)) {
    std::cout << "FREE; the least clearance is between " << clearance->free * 1000 << " and "
              << clearance->not_free * 1000 << " mm, of " << clearance->nearest.second << " from "
              << clearance->nearest.first << " at " << clearance->nearest.time << " s\n";
  } else {
    std::cout << "FREE, by more than 10 m\n";
  }
  int seen = 0;
  for (int i = 0; i < phases; ++i) seen += first_sample_in_contact(scene, rate, double(i) / phases).has_value();
  std::cout << "  sampled at " << rate << " Hz: " << (first_sample_in_contact(scene, rate) ? "contact" : "no contact")
            << "; contact in " << seen << " of " << phases << " phases of the samples\n";
}

/// For the picture: how far drone 0 is from the cable around a time, every 0.1 ms.
void write_gaps(const std::string& name, const Scene& scene, double time) {
  std::vector<double> times;
  for (int i = -550; i <= 550; ++i) times.push_back(time + i * 1e-4);
  const std::vector<double> distances = gaps(scene, 0, times);
  std::ofstream file(name);
  file << "time_s,gap_m\n" << std::setprecision(17);
  for (std::size_t i = 0; i < times.size(); ++i) file << times[i] << ',' << distances[i] << '\n';
  if (!file.flush()) throw std::runtime_error(name + ": cannot be written");
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (jobs::asks_for_help(argc, argv)) return std::cout << usage, EXIT_SUCCESS;
    if (argc > 4) throw std::invalid_argument(std::string(argv[4]) + ": there are three arguments at most");
    const std::size_t drones = argc > 1 ? jobs::whole_number("DRONES", argv[1]) : 8;
    const std::uint64_t seed = argc > 2 ? jobs::whole_number("SEED", argv[2]) : 1;
    Scene scene = swarm_at_mast(drones, seed);
    prove("around the mast", scene);
    constexpr double time = 12.405;  // s, between two samples
    add_cable(scene, 0, time);
    prove("with a cable", scene);
    if (argc > 3) write_gaps(argv[3], scene, time);
  } catch (const std::exception& error) {
    std::cerr << "free_trajectory: " << error.what() << '\n' << usage;
    return EXIT_FAILURE;
  }
}
