// Kinetic sorted list of moving elements under any ranking, on which other rules can stand.
#pragma once

#include "kds/audit.hpp"
#include "kds/framework/kinetic.hpp"
#include "structures/ranking.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace kds::structures {

/// The right neighbour of an element has become another, or one of the two has a new motion; or the element has gone.
struct NewNeighbour {
  Id left;

  friend bool operator==(const NewNeighbour&, const NewNeighbour&) = default;
};

/// Keeps moving elements in order: values by their size, points in a direction. Elements that stay equal are in the
/// order of their ids, so that the state is a function of the motions at t+. It tells whose right neighbour has changed
/// (NewNeighbour), so that other rules may stand on it.
///
/// A certificate for each two neighbours; when it fails they change places. Paper: [Basch99] section 3, sorting.
///
/// Cost: an event O(1), three certificates at most (responsive); an element is in two (local); n - 1 certificates
/// (compact); insertion, removal and a new motion O(log n) signs and O(n) moves in memory. Each event changes the order
/// (efficient): of n elements whose ranks have degree d there are at most d for each two of them.
///
/// For values in an inner loop, SortedList (sorted_list.hpp) keeps the same order in about half the time. A list of
/// things that an inner rule has, edges or gaps, is OrderedRule (ordered.hpp).
template <Ranking Rank>
class RankedListRule {
 public:
  using Element = typename Rank::Element;
  using Change = NewNeighbour;
  using Pen = Repair<Element, Change>;
  static constexpr const char* name = "RankedList";

  RankedListRule() = default;
  explicit RankedListRule(Rank ranking) : ranking_(std::move(ranking)) {}

  /// Ids, the least first.
  const std::vector<Id>& order() const { return order_; }
  /// How many elements stand before this one. Precondition: it is in the list.
  std::size_t rank(Id id) const { return rank_[id]; }
  bool contains(Id id) const { return id < rank_.size() && rank_[id] != nobody; }
  /// nobody if it is the last, or not in the list.
  Id right(Id id) const {
    return contains(id) && rank_[id] + std::size_t{1} < order_.size() ? order_[rank_[id] + std::size_t{1}] : nobody;
  }
  const Rank& ranking() const { return ranking_; }

  // Slot: the left one of two neighbours.
  auto certificate(Slot left, const MovingSet<Element>& x) const {
    using C = decltype(ranking_.in_order(x[0], x[0]));
    const Id other = right(left);
    return other == nobody ? std::nullopt : std::optional<C>(ranking_.in_order(x[left], x[other]));
  }
  std::array<Id, 2> members(Slot left) const { return {left, right(left)}; }

  Effect repair(Slot left, Pen& repair) {
    const std::size_t i = rank_[left];
    std::swap(order_[i], order_[i + 1]);
    number(i, i + 2);
    renew(i, i + 2, repair);
    return Effect::external;
  }
  void insert(Id id, Pen& repair) {
    if (rank_.size() <= id) rank_.resize(repair.elements().end_id(), nobody);
    const auto at = order_.insert(
        std::partition_point(order_.begin(), order_.end(), [&](Id other) { return is_before(other, id, repair); }), id);
    const auto i = static_cast<std::size_t>(at - order_.begin());
    number(i, order_.size());
    renew(i, i + 1, repair);
  }
  void remove(Id id, Pen& repair) {
    const std::size_t i = std::exchange(rank_[id], nobody);
    order_.erase(order_.begin() + static_cast<std::ptrdiff_t>(i));
    repair.retire(id);
    repair.report({id});
    number(i, order_.size());
    renew(i, i, repair);
  }

  std::vector<Change> changes_from_nothing() const {
    std::vector<Change> changes;
    for (const Id id : order_) changes.push_back({id});
    return changes;
  }

  void audit(const MovingSet<Element>& x, double /*now*/) const {
    if (order_.size() != x.size()) throw AuditFailure(std::string(name) + ": it does not hold the elements of the set");
    for (std::size_t i = 0; i < order_.size(); ++i) {
      if (!x.contains(order_[i]) || rank_[order_[i]] != i) {
        throw AuditFailure(std::string(name) + ": place " + std::to_string(i) + ": the element has another rank");
      }
    }
  }
  template <class Archive>
  void archive(Archive& archive) {
    archive(order_, rank_);
    if constexpr (Archive::loading) {
      for (std::size_t i = 0; i < order_.size(); ++i) {
        archive.require(order_[i] < rank_.size() && rank_[order_[i]] == i, "an element of a list has another rank");
      }
    }
  }

 private:
  bool is_before(Id a, Id b, const Pen& repair) const {
    const int sign = repair.sign(ranking_.in_order(repair[a], repair[b]));
    return sign > 0 || (sign == 0 && a < b);
  }
  void number(std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) rank_[order_[k]] = static_cast<Id>(k);
  }
  /// The elements at these places, and the one before, have other right neighbours.
  void renew(std::size_t first, std::size_t last, Pen& repair) {
    for (std::size_t k = first > 0 ? first - 1 : 0; k < std::min(last, order_.size()); ++k) {
      repair.certify(order_[k]);
      repair.report({order_[k]});
    }
  }

  Rank ranking_;
  std::vector<Id> order_;
  std::vector<Id> rank_;  ///< by id; nobody if it is not there
};

}  // namespace kds::structures
