// A kinetic sorted list, written on the framework: what its author writes.
#pragma once

#include "certificates/in_order.hpp"
#include "kds/kinetic.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

namespace kds::examples {

/// Keeps values in ascending order; those that are equal for ever by id. Slot i: element i and its right neighbour.
template <MovingElement Value>
class ListRule {
 public:
  using Element = Value;
  using InOrder = certificates::InOrder<Value>;
  static constexpr const char* name = "ListRule";

  const std::vector<Id>& order() const { return order_; }

  std::optional<InOrder> certificate(Slot left, const MovingSet<Value>& x) const {
    if (place_[left] + 1 == order_.size()) return std::nullopt;
    return InOrder{x[left], x[order_[place_[left] + 1]]};
  }
  std::array<Id, 2> members(Slot left) const { return {left, order_[place_[left] + 1]}; }

  Effect repair(Slot left, Repair<Value>& repair) {
    const std::size_t i = place_[left];
    std::swap(order_[i], order_[i + 1]);
    certify(i > 0 ? i - 1 : 0, i + 2, i + 2, repair);
    return Effect::external;
  }
  void insert(Id id, Repair<Value>& repair) {
    const auto before = [&](Id other, Id self) {
      const int s = repair.sign(InOrder{repair[other], repair[self]});
      return s > 0 || (s == 0 && other < self);
    };
    const auto place = order_.insert(std::lower_bound(order_.begin(), order_.end(), id, before), id);
    const auto i = static_cast<std::size_t>(place - order_.begin());
    certify(i > 0 ? i - 1 : 0, i + 1, order_.size(), repair);
  }
  void remove(Id id, Repair<Value>& repair) {
    const std::size_t i = place_[id];
    order_.erase(order_.begin() + static_cast<std::ptrdiff_t>(i));
    repair.retire(id);
    certify(i > 0 ? i - 1 : 0, i, order_.size(), repair);
  }
  template <class Archive>
  void archive(Archive& archive) { archive(order_, place_); }

 private:
  /// Numbers the places from `first` up to `moved`, and certifies those up to `last`.
  void certify(std::size_t first, std::size_t last, std::size_t moved, Repair<Value>& repair) {
    place_.resize(repair.elements().end_id());
    for (std::size_t i = first; i < moved; ++i) place_[order_[i]] = static_cast<Id>(i);
    for (std::size_t i = first; i < std::min(last, order_.size()); ++i) repair.certify(order_[i]);
  }

  std::vector<Id> order_;    // ids in order
  std::vector<Id> place_;    // of an id in the order
};

}  // namespace kds::examples
