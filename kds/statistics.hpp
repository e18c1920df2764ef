// What a run did, counted.
#pragma once

#include <cstdint>

namespace kds {

/// Work done by one kinetic structure.
struct Counters {
  std::uint64_t events = 0;        ///< certificate failures processed
  std::uint64_t certificates = 0;  ///< failure times asked for

  friend Counters operator+(const Counters& a, const Counters& b) {
    return {a.events + b.events, a.certificates + b.certificates};
  }
};

}  // namespace kds
