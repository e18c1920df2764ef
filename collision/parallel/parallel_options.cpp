#include "collision/parallel/parallel_options.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

namespace kds::collision {

void validate(const ParallelOptions& options) {
  const auto fail = [](const char* what) { throw std::invalid_argument(std::string("ParallelOptions.") + what); };
  if (options.domains > most_domains) fail("domains: must be at most 65535");
  static_assert(most_domains == 65535);
  if (!(options.halo > 0 && std::isfinite(options.halo))) fail("halo: must be > 0 and finite");
  if (!(options.longest_window > 0)) fail("longest_window: must be > 0");
}

}  // namespace kds::collision
