// Conjunction screening of a made-up catalogue: docs/conjunctions.md.
#include "examples/jobs/arguments.hpp"
#include "examples/jobs/conjunctions/catalogue.hpp"
#include "examples/jobs/conjunctions/screening.hpp"
#include "examples/jobs/conjunctions/sieve.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using namespace conjunctions;

constexpr const char* usage =
    "usage: conjunctions [--objects N] [--hours H] [--distance KM] [--seed S] [--csv FILE]\n"
    "                    [--method windows|world|sieve] [--step SECONDS]\n"
    "Finds all pairs of a made-up catalogue that come nearer than a distance. --step is that of the sieve.\n";

struct Arguments {
  std::size_t objects = 3000;
  std::uint64_t seed = 1;
  Screening screening{};
  std::string method = "windows";
  double step = 16;
  std::string csv;
};

Arguments parse(int argc, char** argv) {
  Arguments arguments;
  for (int i = 1; i < argc; i += 2) {
    const std::string option = argv[i];
    if (i + 1 == argc) throw std::invalid_argument(option + ": a value is missing");
    const std::string value = argv[i + 1];
    if (option == "--objects") {
      arguments.objects = static_cast<std::size_t>(jobs::positive_number(option, value));
    } else if (option == "--hours") {
      arguments.screening.hours = jobs::positive_number(option, value);
    } else if (option == "--distance") {
      arguments.screening.distance = jobs::positive_number(option, value);
    } else if (option == "--seed") {
      arguments.seed = static_cast<std::uint64_t>(jobs::positive_number(option, value));
    } else if (option == "--step") {
      arguments.step = jobs::positive_number(option, value);
    } else if (option == "--csv") {
      arguments.csv = value;
    } else if (option == "--method" && (value == "windows" || value == "world" || value == "sieve")) {
      arguments.method = value;
    } else {
      throw std::invalid_argument(option + " " + value + ": unknown");
    }
  }
  return arguments;
}

std::vector<Conjunction> run(const Arguments& arguments) {
  const std::vector<Elements> catalogue = made_up_catalogue(arguments.objects, arguments.seed);
  std::vector<Conjunction> found;
  const auto keep = [&](const Conjunction& conjunction) { found.push_back(conjunction); };
  if (arguments.method == "sieve") {
    const SieveCost cost = sieve(catalogue, arguments.screening, arguments.step, keep);
    std::cout << "CPU s: " << cost.propagation + cost.grid + cost.refinement << " (propagation " << cost.propagation
              << ", grid " << cost.grid << ", refinement of " << cost.candidates << " candidates " << cost.refinement
              << ")\n";
  } else {
    const ScreeningCost cost = arguments.method == "world" ? screen(catalogue, arguments.screening, keep)
                                                           : screen_by_windows(catalogue, arguments.screening, keep);
    std::cout << "CPU s: " << cost.total() << " (" << cost.pieces << " pieces of motion " << cost.interpolation
              << (arguments.method == "world" ? ", giving them to the world " : ", broad phase ") << cost.broad_phase
              << (arguments.method == "world" ? ", events with " : ", ") << cost.candidates << " tests of pairs "
              << cost.pairs << ")\n";
  }
  std::sort(found.begin(), found.end(), [](const Conjunction& x, const Conjunction& y) {
    return x.entry != y.entry ? x.entry < y.entry : x.a != y.a ? x.a < y.a : x.b < y.b;
  });
  return found;
}

void write(const std::string& name, const std::vector<Conjunction>& found) {
  std::ofstream file(name);
  file << "a,b,entry_s,closest_s,distance_km,exit_s,speed_km_s,height_km,near_at_start,near_at_end\n"
       << std::setprecision(17);
  for (const Conjunction& c : found) {
    file << c.a << ',' << c.b << ',' << c.entry << ',' << c.closest << ',' << c.distance << ',' << c.exit << ','
         << c.speed << ',' << c.height << ',' << c.near_at_start << ',' << c.near_at_end << '\n';
  }
  if (!file.flush()) throw std::runtime_error(name + ": cannot be written");
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (jobs::asks_for_help(argc, argv)) return std::cout << usage, EXIT_SUCCESS;
    const Arguments arguments = parse(argc, argv);
    const std::vector<Conjunction> found = run(arguments);
    std::cout << arguments.objects << " objects, " << arguments.screening.hours << " h: " << found.size()
              << " conjunctions nearer than " << arguments.screening.distance << " km\n";
    const auto nearest = std::min_element(
        found.begin(), found.end(), [](const Conjunction& x, const Conjunction& y) { return x.distance < y.distance; });
    if (nearest != found.end()) {
      std::cout << "the nearest: " << nearest->a << " and " << nearest->b << ", " << nearest->distance * 1000
                << " m at " << nearest->closest << " s\n";
    }
    if (!arguments.csv.empty()) write(arguments.csv, found);
  } catch (const std::exception& error) {
    std::cerr << "conjunctions: " << error.what() << '\n' << usage;
    return EXIT_FAILURE;
  }
}
