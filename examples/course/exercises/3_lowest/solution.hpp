// Solution of exercise 3: whoever comes below the lowest is the lowest, and every certificate is about it from then on.
#pragma once

#include "certificates/order.hpp"
#include "kds/framework/kinetic.hpp"

#include <array>
#include <optional>
#include <vector>

namespace kds::exercises {

struct LowestRule {
  using Element = Motion<2>;
  using Order = certificates::Order<2>;  // Order{a, b}: a <= b
  static constexpr const char* name = "Lowest";
  Id lowest = nobody;
  std::vector<Id> taken;  // the ids of all values

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

  void insert(Id id, Repair<Element>& repair) {
    taken.push_back(id);
    if (lowest == nobody || repair.sign(Order{repair[lowest], repair[id]}) < 0) {
      lowest = id;
      certify_all(repair);
    } else {
      repair.certify(id);
    }
  }
  void remove(Id id, Repair<Element>& repair) {
    repair.retire(id);
    std::erase(taken, id);
    if (id != lowest) return;
    lowest = taken.empty() ? nobody : taken.front();
    for (const Id other : taken) {
      if (repair.sign(Order{repair[lowest], repair[other]}) < 0) lowest = other;
    }
    certify_all(repair);
  }
  /// Has the certificates of all slots made anew.
  void certify_all(Repair<Element>& repair) const {
    for (const Id id : taken) repair.certify(id);
  }
};

}  // namespace kds::exercises
