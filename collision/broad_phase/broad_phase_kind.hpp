// The broad phases, by name.
#pragma once

#include <array>
#include <string_view>

namespace kds::collision {

/// Selects a broad phase. The choice changes the cost, never contacts or their times.
enum class BroadPhaseKind {
  automatic,    ///< the one that suits the number of bodies
  grid,         ///< kinetic grid: event-driven, each body in a fat box
  kinetic_sap,  ///< kinetic sweep and prune: event-driven, exact
  sap,          ///< sweep and prune over arrays with swept AABBs, frame by frame
  all_pairs,    ///< no pruning: every pair tested once and its result kept
};

/// A kind of broad phase, the name by which tools know it, and what it is in words.
struct NamedBroadPhase {
  BroadPhaseKind kind;
  std::string_view name;
  std::string_view what;
};

/// All of them, the default first.
inline constexpr std::array broad_phases{
    NamedBroadPhase{BroadPhaseKind::automatic, "auto", "the one that suits the scene"},
    NamedBroadPhase{BroadPhaseKind::grid, "grid", "kinetic grid: event-driven, each body in a fat box"},
    NamedBroadPhase{BroadPhaseKind::kinetic_sap, "kinetic-sap", "kinetic sweep and prune: event-driven, exact"},
    NamedBroadPhase{BroadPhaseKind::sap, "sap", "sweep and prune over arrays with swept boxes, at --rate"},
    NamedBroadPhase{BroadPhaseKind::all_pairs, "all-pairs", "every pair tested once and its result kept, no pruning"}};

}  // namespace kds::collision
