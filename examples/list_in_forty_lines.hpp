// A kinetic sorted list, written on the framework: what its author writes.
#pragma once

#include "certificates/in_order.hpp"
#include "kds/kinetic.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace kds::examples {

/// Keeps values in ascending order; those that are equal for ever by id. Slot i: element i and its right neighbour.
template <MovingElement Value>
struct ListRule {
  using Element = Value;
  using InOrder = certificates::InOrder<Value>;
  static constexpr const char* name = "ListRule";
  std::vector<Id> order;  ///< ids in order
  std::vector<Id> place;  ///< of an id in the order

  std::optional<InOrder> certificate(Slot left, const MovingSet<Value>& x) const {
    if (place[left] + 1 == order.size()) return std::nullopt;
    return InOrder{x[left], x[order[place[left] + 1]]};
  }
  std::array<Id, 2> members(Slot left) const { return {left, order[place[left] + 1]}; }

  Effect repair(Slot left, Repair<Value>& repair) {
    const std::size_t i = place[left];
    std::swap(order[i], order[i + 1]);
    renew(i, i + 2, i + 2, repair);
    return Effect::external;
  }
  void insert(Id id, Repair<Value>& repair) {
    const auto before = [&](Id other, Id self) {
      const int s = repair.sign(InOrder{repair[other], repair[self]});
      return s > 0 || (s == 0 && other < self);
    };
    const auto at = order.insert(std::lower_bound(order.begin(), order.end(), id, before), id);
    const auto i = static_cast<std::size_t>(at - order.begin());
    renew(i, i + 1, order.size(), repair);
  }
  void remove(Id id, Repair<Value>& repair) {
    repair.retire(id);
    order.erase(order.begin() + place[id]);
    renew(place[id], place[id], order.size(), repair);
  }
  /// Numbers the places from i up to `moved`; certifies the pairs from the one that ends at i up to the one at `last`.
  void renew(std::size_t i, std::size_t last, std::size_t moved, Repair<Value>& repair) {
    place.resize(repair.elements().end_id());
    for (std::size_t k = i; k < moved; ++k) place[order[k]] = static_cast<Id>(k);
    for (std::size_t k = i > 0 ? i - 1 : 0; k < std::min(last, order.size()); ++k) repair.certify(order[k]);
  }
  template <class Archive>
  void archive(Archive& archive) { archive(order, place); }
};

}  // namespace kds::examples
