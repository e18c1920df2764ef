// The measures by which kinetic data structures are judged, counted.
#pragma once

#include <cstdint>

namespace kds {

/// Whether an event changed the attribute that the structure maintains, or only its proof.
enum class Effect : std::uint8_t { internal, external };

/// The four measures of [Basch99] section 2, as counted on a run.
///
/// A structure is *responsive* if few certificates are touched in an event (events, touched, most_touched), *local* if
/// an element is in few certificates (most_per_element), *compact* if it has few certificates (held, most_held), and
/// *efficient* if it has not many more events than the attribute that it maintains has changes (events against
/// external).
struct Measures {
  std::uint64_t events = 0;            ///< certificates that failed; samples taken for one count too
  std::uint64_t external = 0;          ///< events that changed the attribute that is maintained, not only its proof
  std::uint64_t followed = 0;          ///< events of the structure that it stands on, which it has taken up
  std::uint64_t touched = 0;           ///< certificates made, replaced or given up in all events
  std::uint64_t most_touched = 0;      ///< ... in one event
  std::uint64_t held = 0;              ///< certificates now, with or without an event to come
  std::uint64_t most_held = 0;         ///< ... at any time
  std::uint64_t most_per_element = 0;  ///< certificates that the busiest element is in now

  friend bool operator==(const Measures&, const Measures&) = default;
};

}  // namespace kds
