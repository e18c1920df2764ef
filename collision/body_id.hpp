// The names of bodies: ids, which callers use, and slots, which the parts of a world use.
#pragma once

#include <cstdint>

namespace kds::collision {

/// The place of a body in arrays: the number by which broad phases, pairs and queues refer to it. When the body has
/// been removed, another may get its slot.
using BodySlot = std::uint32_t;

/// The slot of no body.
inline constexpr BodySlot no_body = ~BodySlot{0};

/// The name of a body, which no other body of its world ever gets: the number generation * 2^32 + slot. The generation
/// is the least with which the id is greater than those of all bodies that were added before. So ids ascend in the
/// order in which bodies are added, and are 0, 1, 2, ... as long as none has been removed. Bodies come in the order of
/// their ids in all that a world reports and does at one time, whichever slots they have.
///
/// It is a plain number, which callers may store and count as they like, so the compiler does not distinguish ids from
/// slots. A world converts between the two only in its public functions and reports, by `Bodies::id_of` and
/// `Bodies::slot_of`.
using BodyId = std::uint64_t;

inline constexpr int slot_bits = 32;

constexpr BodyId body_id(std::uint32_t generation, BodySlot slot) { return BodyId{generation} << slot_bits | slot; }
constexpr BodySlot body_slot(BodyId id) { return static_cast<BodySlot>(id); }
constexpr std::uint32_t body_generation(BodyId id) { return static_cast<std::uint32_t>(id >> slot_bits); }

}  // namespace kds::collision
