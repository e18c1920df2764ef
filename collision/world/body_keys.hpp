// The ids of a world's bodies, and the order of bodies that follows from them.
#pragma once

#include "collision/body_id.hpp"
#include "kds/large_vector.hpp"

#include <compare>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

namespace kds::collision {

/// The greatest generation that there is.
inline constexpr std::uint32_t last_generation = ~std::uint32_t{0};

/// For each slot the generation of the body that is there, or was there last. Where the bodies are those of another
/// world (transfer.cpp), also the *number* of each: the slot that it has there.
///
/// The *key* of a body orders the bodies of a world: events of one time, the two bodies of a pair, and the terms of
/// sums come in the order of keys. It is the body's id; in a world that has bodies of another world, the id that the
/// body has there. So this order does not depend on which slots bodies have.
///
/// Cost: O(1) each. Until a slot is given for a second time no generations are stored.
class BodyKeys {
 public:
  std::uint32_t generation(BodySlot slot) const { return slot < generations_.size() ? generations_[slot] : 0; }
  BodyId id(BodySlot slot) const { return body_id(generation(slot), slot); }
  BodyId key(BodySlot slot) const { return body_id(generation(slot), number(slot)); }
  bool before(BodySlot a, BodySlot b) const { return key(a) < key(b); }

  /// Whether there is an id for another body in this slot. If not, a slot that has never been given has one.
  bool can_give(BodySlot slot) const {
    return slot >= body_slot(next_id_) || body_generation(next_id_) != last_generation;
  }
  /// The body in this slot gets the least id that is greater than all that have been given. Precondition: can_give().
  void give(BodySlot slot) {
    const std::uint32_t generation = body_generation(next_id_) + (slot < body_slot(next_id_) ? 1 : 0);
    set_generation(slot, generation);
    next_id_ = body_id(generation, slot) + 1;
  }
  void set_generation(BodySlot slot, std::uint32_t generation) {
    if (generation == this->generation(slot)) return;
    if (generations_.size() <= slot) generations_.resize(slot + std::size_t{1});
    generations_[slot] = generation;
  }

  /// Empty where slots are numbers.
  bool numbered() const { return !numbers_.empty(); }
  BodySlot number(BodySlot slot) const { return numbers_.empty() ? slot : numbers_[slot]; }
  void set_number(BodySlot slot, BodySlot number) {
    if (numbers_.size() <= slot) numbers_.resize(slot + std::size_t{1});
    numbers_[slot] = number;
  }
  /// So many slots have these numbers, one after the other.
  void number_from(BodySlot first, std::size_t slots) {
    numbers_.resize(slots);
    std::iota(numbers_.begin(), numbers_.end(), first);
  }

  /// For snapshots: by slot, up to the last that is not 0; and a number that the next id is not below.
  const std::vector<std::uint32_t>& generations() const { return generations_; }
  BodyId next_id() const { return next_id_; }
  template <class Archive>
  void archive(Archive& archive) {
    archive(generations_, next_id_);
  }
  void become(std::span<const std::uint32_t> generations, BodyId next_id) {
    generations_.assign(generations.begin(), generations.end()), next_id_ = next_id;
  }

 private:
  std::vector<std::uint32_t> generations_;
  LargeVector<BodySlot> numbers_;
  BodyId next_id_ = 0;
};

/// The place of a pair of bodies in the order of pairs.
struct PairKey {
  BodyId a, b;
  friend auto operator<=>(const PairKey&, const PairKey&) = default;
};

/// The order of events in queues whose slots are bodies.
struct BodyRank {
  static constexpr bool lasts = true;  ///< who has an event is there, and has its key

  const BodyKeys* keys;
  BodyId operator()(std::uint32_t slot) const { return keys->key(slot); }
};

}  // namespace kds::collision
