// What exercise 3 gives: the state of the structure, and how elements come and go.
#pragma once

#include "certificates/order.hpp"
#include "kds/framework/kinetic.hpp"

#include <vector>

namespace kds::exercises {

/// The lowest of the values that have been inserted.
struct LowestOfTaken {
  using Element = Motion<2>;
  using Order = certificates::Order<2>;  // Order{a, b}: a <= b
  Id lowest = nobody;
  std::vector<Id> taken;  // the ids of all values

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
