// Makes the broad phase that options ask for.
#pragma once

#include "collision/broad_phase/box_of.hpp"
#include "collision/broad_phase/broad_phase.hpp"
#include "collision/broad_phase/kdop.hpp"
#include "collision/profile.hpp"
#include "collision/world_options.hpp"

#include <memory>

namespace kds::collision {

/// A broad phase without bodies, at `now`. Throws std::invalid_argument, naming the option, for an option that it
/// cannot have.
template <int Degree>
std::unique_ptr<BroadPhase<Degree>> new_broad_phase(const WorldOptions& options, double now, Profile* profile,
                                                    BoxOf<Degree> box_of, Kdops<Degree> kdops);

}  // namespace kds::collision
