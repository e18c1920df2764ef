// A gas of hard balls in a periodic box, at rest or sheared, beside theory: docs/granular_gas.md.
#include "examples/jobs/arguments.hpp"
#include "examples/jobs/granular_gas/experiments.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <string>

namespace {

using namespace granular_gas;

constexpr const char* usage =
    "usage: granular_gas [equation|gas|shear|speed] [--balls N] [--packing P] [--size-ratio Q] [--restitution E]\n"
    "                    [--shear-rate G] [--collisions C] [--seed S] [--csv FILE]\n"
    "equation: gases of packings 0.05 to 0.45 beside theory\n"
    "gas:      one of them, with its radial distribution and displacements in the file\n"
    "shear:    a sheared inelastic gas, on its way to a steady temperature\n"
    "speed:    CPU time a collision\n"
    "The mean diameter, the mass of a ball of that diameter and the temperature at the start are 1.\n";

struct Arguments {
  std::string what = "gas";
  GasOptions gas{};
  double collisions = 0;  ///< 0: for each kind its own
  std::string csv;
};

Arguments parse(int argc, char** argv) {
  Arguments arguments;
  int first = 1;
  if (argc > 1 && argv[1][0] != '-') arguments.what = argv[first++];
  if (arguments.what == "shear") arguments.gas.restitution = 0.9, arguments.gas.shear_rate = 1;
  for (int i = first; i < argc; i += 2) {
    const std::string option = argv[i];
    if (i + 1 == argc) throw std::invalid_argument(option + ": a value is missing");
    const std::string value = argv[i + 1];
    if (option == "--balls") {
      arguments.gas.balls = jobs::whole_number(option, value);
    } else if (option == "--packing" && arguments.what != "equation") {
      arguments.gas.packing = jobs::number(option, value);
    } else if (option == "--size-ratio") {
      arguments.gas.size_ratio = jobs::number(option, value);
    } else if (option == "--restitution") {
      arguments.gas.restitution = jobs::number(option, value);
    } else if (option == "--shear-rate") {
      arguments.gas.shear_rate = jobs::number(option, value);
    } else if (option == "--collisions") {
      arguments.collisions = double(jobs::whole_number(option, value));
      if (arguments.collisions == 0) throw std::invalid_argument("--collisions: must be > 0");
    } else if (option == "--seed") {
      arguments.gas.seed = jobs::whole_number(option, value);
    } else if (option == "--csv" && arguments.what != "speed") {
      arguments.csv = value;
    } else {
      throw std::invalid_argument(option + " " + value + ": unknown");
    }
  }
  return arguments;
}

/// A file for CSV, if one is wanted; otherwise what is written is lost.
class CsvFile {
 public:
  explicit CsvFile(const std::string& name) : name_(name) {
    if (!name.empty()) file_.open(name);
    require();
    file_ << std::setprecision(10);
  }
  std::ofstream& out() { return file_; }
  void finish() {
    file_.flush();
    require();
  }

 private:
  void require() const {
    if (!name_.empty() && !file_) throw std::runtime_error(name_ + ": cannot be written");
  }
  std::string name_;
  std::ofstream file_;
};

std::uint64_t collisions(const Arguments& arguments, double of_each) {
  if (arguments.collisions > 0) return static_cast<std::uint64_t>(arguments.collisions);
  return static_cast<std::uint64_t>(of_each * double(std::max<std::size_t>(arguments.gas.balls, 32)));
}

void print(const char* name, const std::string& measured, double theory, const char* whose) {
  std::cout << "  " << std::left << std::setw(26) << name << std::setw(24) << measured;
  if (!std::isnan(theory)) std::cout << whose << ' ' << theory;
  std::cout << '\n';
}
std::string text(const Mean& mean) {
  std::ostringstream out;
  out << std::setprecision(5) << mean.value << " +- " << std::setprecision(2) << mean.error;
  return out.str();
}
std::string text(double value) {
  std::ostringstream out;
  out << std::setprecision(5) << value;
  return out.str();
}

void run_gas(const Arguments& arguments) {
  CsvFile csv(arguments.csv);
  const Equilibrium gas = equilibrium(arguments.gas, collisions(arguments, 1000));
  std::cout << gas.balls << " balls, packing " << arguments.gas.packing << ": " << gas.contacts << " collisions, "
            << gas.cpu_seconds / double(gas.contacts) * 1e6 << " us each; temperature 1 to "
            << std::abs(gas.temperature - 1) << '\n';
  print("pressure, P V / (N T)", text(gas.compressibility), gas.theory_compressibility, "Carnahan and Starling");
  print("collisions of a ball / s", text(gas.rate), gas.theory_rate, "Enskog");
  print("diffusion", text(gas.diffusion), gas.theory_diffusion, "Enskog");
  if (!std::isnan(gas.diffusion_of_large_box)) {
    print("  in a large box", text(gas.diffusion_of_large_box), gas.simulated_diffusion, "Speedy's fit to simulations");
  }
  print("distribution at contact", text(gas.contact_value), gas.theory_contact_value, "Carnahan and Starling");
  csv.out() << "distance,radial_distribution,,time,mean_square_displacement\n";
  const Displacements& moved = gas.displacements;
  for (std::size_t i = 0; i < std::max(RadialDistribution::bins, moved.longest()); ++i) {
    if (i < RadialDistribution::bins)
      csv.out() << RadialDistribution::distance(i) << ',' << gas.radial.value(i);
    else
      csv.out() << ',';
    csv.out() << ",,";
    if (i < moved.longest())
      csv.out() << double(i + 1) * moved.interval() << ',' << moved.mean_square(i + 1);
    else
      csv.out() << ',';
    csv.out() << '\n';
  }
  csv.finish();
}

void run_equation(Arguments arguments) {
  CsvFile csv(arguments.csv);
  csv.out()
      << "packing,compressibility,error,theory,rate,error,theory,diffusion,error,large_box,theory,fit,contact,theory\n";
  std::cout
      << "packing  P V / (N T), theory              collisions / s, Enskog          diffusion, in a large box, fit\n";
  for (int i = 1; i <= 9; ++i) {
    arguments.gas.packing = 0.05 * i;
    const Equilibrium gas = equilibrium(arguments.gas, collisions(arguments, 1000));
    std::cout << std::left << std::setw(9) << arguments.gas.packing << std::setw(20) << text(gas.compressibility)
              << std::setw(12) << gas.theory_compressibility << std::setw(20) << text(gas.rate) << std::setw(12)
              << gas.theory_rate << std::setw(22) << text(gas.diffusion) << std::setw(10) << gas.diffusion_of_large_box
              << gas.simulated_diffusion << std::endl;
    const auto& of = gas;
    csv.out() << arguments.gas.packing << ',' << of.compressibility.value << ',' << of.compressibility.error << ','
              << of.theory_compressibility << ',' << of.rate.value << ',' << of.rate.error << ',' << of.theory_rate
              << ',' << of.diffusion.value << ',' << of.diffusion.error << ',' << of.diffusion_of_large_box << ','
              << of.theory_diffusion << ',' << of.simulated_diffusion << ',' << of.contact_value << ','
              << of.theory_contact_value << '\n';
  }
  csv.finish();
}

void run_shear(const Arguments& arguments) {
  CsvFile csv(arguments.csv);
  csv.out() << "time,temperature,stress,dissipation,rate\n";
  const Sheared steady = sheared(arguments.gas, collisions(arguments, 500), [&](const ShearedState& state) {
    csv.out() << state.time << ',' << state.temperature << ',' << state.stress << ',' << state.dissipation << ','
              << state.rate << '\n';
  });
  csv.finish();
  std::cout << "sheared at " << arguments.gas.shear_rate << ", restitution " << arguments.gas.restitution
            << ", packing " << arguments.gas.packing << ": steady state of the second half\n";
  print("temperature", text(steady.temperature), steady.theory_temperature, "balance with Enskog's viscosity");
  const double power = arguments.gas.shear_rate;
  print("power of the shear", text(Mean{steady.stress.value * power, steady.stress.error * std::abs(power)}),
        std::nan(""), "");
  print("taken by collisions", text(steady.dissipation), std::nan(""), "");
  print("collisions of a ball / s", text(steady.rate), std::nan(""), "");
}

void run_speed(const Arguments& arguments) {
  const std::uint64_t count = collisions(arguments, 100);
  const double seconds = seconds_a_contact(arguments.gas, count);
  std::cout << balls_on_lattice(arguments.gas) << " balls, packing " << arguments.gas.packing << ": " << seconds * 1e6
            << " us of CPU time a collision, " << 1 / seconds << " collisions / s\n";
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (jobs::asks_for_help(argc, argv)) return std::cout << usage, EXIT_SUCCESS;
    const Arguments arguments = parse(argc, argv);
    if (arguments.what == "gas") {
      run_gas(arguments);
    } else if (arguments.what == "equation") {
      run_equation(arguments);
    } else if (arguments.what == "shear") {
      run_shear(arguments);
    } else if (arguments.what == "speed") {
      run_speed(arguments);
    } else {
      throw std::invalid_argument(arguments.what + ": unknown");
    }
  } catch (const std::exception& error) {
    std::cerr << "granular_gas: " << error.what() << '\n' << usage;
    return EXIT_FAILURE;
  }
}
