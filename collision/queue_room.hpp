// Event queues by number of body or pair that grow with the scene, or have no slots at all.
#pragma once

#include "kds/events/event_queue.hpp"

#include <algorithm>
#include <cstddef>

namespace kds::collision {

template <class Queue>
void clear(Queue& queue, Slot slot) {
  if (slot < queue.slots()) queue.clear(slot);
}

/// The queues grow by doubling, as vectors do.
template <class Queue>
void make_room(Queue& queue, std::size_t slots) {
  if (queue.slots() < slots) queue.resize(std::max(slots, 2 * queue.slots()));
}

}  // namespace kds::collision
