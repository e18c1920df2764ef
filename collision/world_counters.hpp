// The counters of a world.
#pragma once

#include "collision/broad_phase/broad_phase_counters.hpp"
#include "kds/statistics.hpp"

#include <cstdint>

namespace kds::collision {

/// The work of a world so far.
struct WorldCounters {
  BroadPhaseCounters broad_phase;
  std::uint64_t pairs_begun = 0;  ///< pairs handed on by the broad phase
  std::uint64_t pair_tests = 0;   ///< dynamic intersection tests
  std::uint64_t contacts = 0;
  std::uint64_t separations = 0;
  std::uint64_t overlaps = 0;
  std::uint64_t wall_contacts = 0;
  std::uint64_t motion_updates = 0;       ///< by response, walls, scripts and callers
  std::uint64_t rebounds_suppressed = 0;  ///< times the Zeno policy acted on a contact
  std::uint64_t rotation_pieces = 0;      ///< of bodies that precess, after the first of each
  std::uint64_t orientation_resets = 0;   ///< law 2 of world/turning/tumbling.hpp

  friend bool operator==(const WorldCounters&, const WorldCounters&) = default;
  friend WorldCounters operator+(const WorldCounters& a, const WorldCounters& b) {
    return {.broad_phase = a.broad_phase + b.broad_phase,
            .pairs_begun = a.pairs_begun + b.pairs_begun,
            .pair_tests = a.pair_tests + b.pair_tests,
            .contacts = a.contacts + b.contacts,
            .separations = a.separations + b.separations,
            .overlaps = a.overlaps + b.overlaps,
            .wall_contacts = a.wall_contacts + b.wall_contacts,
            .motion_updates = a.motion_updates + b.motion_updates,
            .rebounds_suppressed = a.rebounds_suppressed + b.rebounds_suppressed,
            .rotation_pieces = a.rotation_pieces + b.rotation_pieces,
            .orientation_resets = a.orientation_resets + b.orientation_resets};
  }
  friend WorldCounters operator-(const WorldCounters& a, const WorldCounters& b) {
    return {.broad_phase = a.broad_phase - b.broad_phase,
            .pairs_begun = a.pairs_begun - b.pairs_begun,
            .pair_tests = a.pair_tests - b.pair_tests,
            .contacts = a.contacts - b.contacts,
            .separations = a.separations - b.separations,
            .overlaps = a.overlaps - b.overlaps,
            .wall_contacts = a.wall_contacts - b.wall_contacts,
            .motion_updates = a.motion_updates - b.motion_updates,
            .rebounds_suppressed = a.rebounds_suppressed - b.rebounds_suppressed,
            .rotation_pieces = a.rotation_pieces - b.rotation_pieces,
            .orientation_resets = a.orientation_resets - b.orientation_resets};
  }
  /// The counters of a kinetic structure: events, and failure times that were computed.
  operator Counters() const {
    return {.events = contacts + separations + overlaps + wall_contacts, .certificates = pair_tests};
  }
};

}  // namespace kds::collision
