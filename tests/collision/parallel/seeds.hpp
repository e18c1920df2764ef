// The seeds of random scenes that a test runs: its own, or others by hand.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <initializer_list>
#include <sstream>
#include <stdexcept>
#include <string>

namespace kds::collision::tests {

/// Scenes of some seeds, each of which is run in so many domains at most.
struct Seeds {
  std::uint64_t first = 1;
  std::uint64_t count = 1;
  std::size_t most_domains = 8;
};

/// Calls run(seed, most domains) for each, and throws what it throws. By hand, in place of these: the environment
/// variable has "FIRST LAST", or "FIRST LAST DOMAINS". Then all of them are run, also after one that throws, and what
/// is thrown in the end is what each has said.
template <class Run>
void each_seed(const char* variable, std::initializer_list<Seeds> standard, const Run& run) {
  const char* const wished = std::getenv(variable);
  if (!wished) {
    for (const Seeds& seeds : standard) {
      for (std::uint64_t seed = seeds.first; seed < seeds.first + seeds.count; ++seed) run(seed, seeds.most_domains);
    }
    return;
  }
  std::istringstream text(wished);
  std::uint64_t first = 1, last = 0;
  if (!(text >> first >> last)) throw std::invalid_argument(std::string(variable) + ": is not \"FIRST LAST\"");
  std::size_t most_domains = 0;
  if (!(text >> most_domains)) most_domains = standard.begin()->most_domains;
  std::size_t failed = 0;
  std::string said;
  for (std::uint64_t seed = first; seed <= last; ++seed) {
    try {
      run(seed, most_domains);
    } catch (const std::exception& error) {
      ++failed;
      said += "\nseed " + std::to_string(seed) + ": " + error.what();
    }
  }
  if (failed > 0) throw std::runtime_error(std::to_string(failed) + " seeds fail:" + said);
}

}  // namespace kds::collision::tests
