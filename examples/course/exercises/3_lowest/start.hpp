// Exercise 3: a structure with a rule. It keeps the lowest of moving values: its proof is that each other value is not
// below it. Write the certificate of a slot, and its repair.
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

  /// Slot i is about value i and the lowest one; that one's own slot is empty (std::nullopt). To be written.
  std::optional<Order> certificate(Slot /*slot*/, const MovingSet<Element>& /*x*/) const { return std::nullopt; }
  std::array<Id, 2> members(Slot slot) const { return {lowest, slot}; }

  /// The certificate of this slot has failed: who is the lowest, and which certificates are about it? To be written,
  /// with certify_all(). Effect::external: the answer has changed; Effect::internal: only its proof has. And why do
  /// repairs at one time end?
  Effect repair(Slot /*slot*/, Repair<Element>& /*repair*/) { return Effect::internal; }

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
