// Solution of exercise 3: whoever comes below the lowest is the lowest, and every certificate is about it from then on.
#pragma once

#include "examples/course/exercises/3_lowest/given.hpp"

#include <array>
#include <optional>

namespace kds::exercises {

/// Keeps the lowest of moving values.
struct LowestRule : LowestOfTaken {
  static constexpr const char* name = "Lowest";

  std::optional<Order> certificate(Slot slot, const MovingSet<Element>& x) const {
    if (slot == lowest) return std::nullopt;
    return Order{x[lowest], x[slot]};
  }
  std::array<Id, 2> members(Slot slot) const { return {lowest, slot}; }

  // Repairs at one time end, since just after that time each puts a lower value in the place of a higher one.
  Effect repair(Slot slot, Repair<Element>& repair) {
    lowest = slot;
    certify_all(repair);
    return Effect::external;
  }
};

}  // namespace kds::exercises
