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

/// Slots that a queue has at first: small scenes never need more, and growing slot by slot would dominate their cost.
inline constexpr std::size_t first_slots = 32;

/// Gives a queue at least this many slots; throws as its resize() does. Queues grow by doubling, as vectors do, up to
/// what they can have.
template <class Queue>
void make_room(Queue& queue, std::size_t slots) {
  if (queue.slots() >= slots) return;
  std::size_t room = std::max(2 * queue.slots(), first_slots);
  if constexpr (requires { Queue::most_slots; }) room = std::min(room, Queue::most_slots);
  queue.resize(std::max(slots, room));
}

}  // namespace kds::collision
