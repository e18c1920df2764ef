// The counters of a broad phase.
#pragma once

#include <cstdint>

namespace kds::collision {

/// Work done by a broad phase.
struct BroadPhaseCounters {
  std::uint64_t swaps = 0;         ///< exchanges of adjacent interval ends
  std::uint64_t certificates = 0;  ///< failure times computed
  std::uint64_t box_updates = 0;   ///< bounding volumes computed or changed

  friend BroadPhaseCounters operator+(const BroadPhaseCounters& a, const BroadPhaseCounters& b) {
    return {a.swaps + b.swaps, a.certificates + b.certificates, a.box_updates + b.box_updates};
  }
  friend BroadPhaseCounters operator-(const BroadPhaseCounters& a, const BroadPhaseCounters& b) {
    return {a.swaps - b.swaps, a.certificates - b.certificates, a.box_updates - b.box_updates};
  }
  friend bool operator==(const BroadPhaseCounters&, const BroadPhaseCounters&) = default;
};

}  // namespace kds::collision
