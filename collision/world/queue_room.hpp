// Event queues by number of body or pair that grow with the scene, or have no slots at all.
#pragma once

#include "kds/events/event_queue.hpp"

#include <algorithm>
#include <cstddef>

namespace kds::collision {

/// Clears a slot, if the queue has it.
template <class Queue>
void clear(Queue& queue, Slot slot) {
  if (slot < queue.slots()) queue.clear(slot);
}

/// Slots that a queue has at first: small scenes never need more, and growing slot by slot would be much of their cost.
inline constexpr std::size_t first_slots = 32;

/// Gives a queue at least this many slots. Queues grow by doubling, as vectors do.
template <class Queue>
void make_room(Queue& queue, std::size_t slots) {
  if (queue.slots() < slots) queue.resize(std::max({slots, 2 * queue.slots(), first_slots}));
}

}  // namespace kds::collision
