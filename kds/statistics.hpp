// Counters of a run.
#pragma once

#include <cstdint>

namespace kds {

/// Work done by one kinetic structure.
struct Counters {
  std::uint64_t events = 0;        ///< certificate failures processed
  std::uint64_t certificates = 0;  ///< failure times asked for
  std::uint64_t rescheduled = 0;   ///< events that proved early and were put off; only with an uncertified solver
  std::uint64_t repaired = 0;      ///< certificates found to have failed before; only with an uncertified solver

  friend Counters operator+(const Counters& a, const Counters& b) {
    return {a.events + b.events, a.certificates + b.certificates, a.rescheduled + b.rescheduled,
            a.repaired + b.repaired};
  }
  friend Counters operator-(const Counters& a, const Counters& b) {
    return {a.events - b.events, a.certificates - b.certificates, a.rescheduled - b.rescheduled,
            a.repaired - b.repaired};
  }
  friend bool operator==(const Counters&, const Counters&) = default;
};

}  // namespace kds
