// What has come of a step of a window, of all domains together.
#pragma once

#include "collision/parallel/domain.hpp"
#include "collision/parallel/processes.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace kds::collision {

/// The same in all processes, once it has been combined: they conclude the same from it.
struct StepOutcome {
  bool divisible = true;  ///< as DomainReport, of each domain
  bool stayed = true;
  double halo_used = 0;  ///< by the domain that needed most of the halo; more than 1 if the step does not hold
  std::array<std::uint64_t, 4> told{};
  std::uint64_t computed = 0;
  std::uint64_t most_computed = 0;  ///< by one domain
  std::uint64_t owned = 0;
  std::uint64_t most_owned = 0;  ///< by one domain
  std::uint64_t known = 0;
  std::uint64_t wrong = 0;
  std::uint64_t copies_made = 0;  ///< since the last step that held

  bool went_through() const { return divisible && stayed; }
  bool holds() const { return went_through() && halo_used <= 1; }

  /// Adds what has come of it in a domain, which has needed so much of the halo.
  void add(const DomainReport& report, double used) {
    divisible = divisible && report.divisible, stayed = stayed && report.stayed;
    halo_used = std::max(halo_used, used);
    for (std::size_t kind = 0; kind < told.size(); ++kind) told[kind] += report.told[kind];
    computed += report.computed, most_computed = std::max(most_computed, report.computed);
    owned += report.owned, most_owned = std::max(most_owned, report.owned);
    known += report.known, wrong += report.wrong;
  }

  /// From what this process has of it that which all have.
  void combine(Team& team) {
    std::array sums{told[0], told[1], told[2], told[3], computed, owned, known, wrong, copies_made};
    std::array<double, 5> maxima{divisible ? 0.0 : 1.0, stayed ? 0.0 : 1.0, halo_used,
                                 static_cast<double>(most_computed), static_cast<double>(most_owned)};
    team.combine(sums, maxima);
    std::copy_n(sums.begin(), told.size(), told.begin());
    computed = sums[4], owned = sums[5], known = sums[6], wrong = sums[7], copies_made = sums[8];
    divisible = maxima[0] == 0, stayed = maxima[1] == 0, halo_used = maxima[2];
    most_computed = static_cast<std::uint64_t>(maxima[3]), most_owned = static_cast<std::uint64_t>(maxima[4]);
  }
};

}  // namespace kds::collision
