// Exercise 3: a structure with a rule. It keeps the lowest of moving values: its proof is that each other value is not
// below it. Write the certificate of a slot, and its repair; given.hpp has the rest.
#pragma once

#include "examples/course/exercises/3_lowest/given.hpp"

#include <array>
#include <optional>

namespace kds::exercises {

/// Keeps the lowest of moving values.
struct LowestRule : LowestOfTaken {
  static constexpr const char* name = "Lowest";

  /// Slot i is about value i and the lowest one; that one's own slot is empty (std::nullopt). To be written.
  std::optional<Order> certificate(Slot /*slot*/, const MovingSet<Element>& /*x*/) const { return std::nullopt; }
  std::array<Id, 2> members(Slot slot) const { return {lowest, slot}; }

  /// The certificate of this slot has failed: who is the lowest, and which certificates are about it? To be written,
  /// with certify_all(). Effect::external: the answer has changed; Effect::internal: only its proof has. And why do
  /// repairs at one time end?
  Effect repair(Slot /*slot*/, Repair<Element>& /*repair*/) { return Effect::internal; }
};

}  // namespace kds::exercises
