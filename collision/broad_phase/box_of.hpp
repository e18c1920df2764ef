// Whom broad phases ask for the boxes of bodies.
#pragma once

#include "collision/body_id.hpp"
#include "collision/broad_phase/kinetic_box.hpp"

#include <functional>

namespace kds::collision {

/// The present kinetic box of a body: the owner of the bodies can calculate it, so a broad phase that rarely needs it
/// need not store it.
///
/// Laws: (1) it is asked only of bodies that are in the broad phase, and until one is inserted, updated or removed
/// again the answer is the box that was given last, bit for bit; in between, while a query is answered, it may also be
/// a later one that the broad phase is about to be given; (2) where the owner answers queries by several threads at
/// once, it may be asked by them at once.
template <int Degree>
using BoxOf = std::function<KineticBox<Degree>(BodySlot)>;

}  // namespace kds::collision
