// The candidates that an inner structure has, sorted: edges by length, gaps by width.
#pragma once

#include "kds/audit.hpp"
#include "kds/framework/kinetic.hpp"
#include "structures/candidates.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace kds::structures {

/// A rule that stands on another, or on several, StandsOn<A, B, ...>, and keeps candidates that come and go in these in
/// order: a sorted list of things that are made of elements. `Rule`, which derives from it, says what they are, in
/// terms of inner():
///
///     candidate(change) const            number of the candidate that a change of the inner rule concerns; if there
///     are
///                                        several, candidate(From<I>, change): see CandidatesRule (candidates.hpp)
///     takes_part(candidate) const        whether there is such a candidate
///     in_order(i, j, elements) const     certificate that candidate i is not greater than j
///     ids(candidate) const               the elements that it is made of, an array of ids
///     swapped(i, j) -> Effect            i, the greater, has come to stand before j, its right neighbour
///     renewed() -> Effect                candidates have come, gone, or taken other places
///
/// Slot: the candidate that is the left one of two neighbours. Candidates that stay equal are in any order.
///
/// Cost: three certificates for an event, and O(log n) signs and O(n) moves in memory for each candidate that the inner
/// rule changes; n - 1 certificates (compact).
template <class Rule, class Inner, class InOrder>
class OrderedRule : public CandidatesRule<Rule, Inner> {
  using Base = CandidatesRule<Rule, Inner>;

 public:
  using typename Base::Candidate, typename Base::Element;
  using Pen = RepairOf<OrderedRule>;

  /// The least first.
  const std::vector<Candidate>& order() const { return order_; }
  /// Precondition: takes_part(candidate).
  std::size_t rank(Candidate candidate) const { return rank_[candidate]; }

  std::optional<InOrder> certificate(Slot left, const MovingSet<Element>& x) const {
    if (!listed(left) || rank_[left] + std::size_t{1} == order_.size()) return std::nullopt;
    return rule().in_order(left, order_[rank_[left] + std::size_t{1}], x);
  }
  std::vector<Id> members(Slot left) const { return this->ids_of(left, order_[rank_[left] + std::size_t{1}]); }

  Effect repair(Slot left, Pen& repair) {
    const std::size_t i = rank_[left];
    std::swap(order_[i], order_[i + 1]);
    std::swap(rank_[order_[i]], rank_[order_[i + 1]]);
    for (std::size_t k = i > 0 ? i - 1 : 0; k < i + 2; ++k) repair.certify(order_[k]);
    return rule().swapped(order_[i + 1], order_[i]);
  }
  Effect followed(Pen& repair) {
    const std::vector<Candidate>& changed = this->take_changed();
    const std::size_t first_out = take_out(changed, repair);
    const std::size_t first = std::min(first_out, put_in(changed, repair));
    for (std::size_t k = first; k < order_.size(); ++k) rank_[order_[k]] = static_cast<std::uint32_t>(k);
    for (const Candidate c : changed) {
      if (!listed(c)) continue;
      repair.certify(c);
      if (rank_[c] > 0) repair.certify(order_[rank_[c] - std::size_t{1}]);
    }
    return rule().renewed();
  }

  void audit(const MovingSet<Element>& /*elements*/, double /*now*/) const {
    const auto fail = [](Candidate c, const char* what) {
      throw AuditFailure(Rule::name + (": candidate " + std::to_string(c)) + ": " + what);
    };
    for (Candidate c = 0; c < rank_.size(); ++c) {
      if (rule().takes_part(c) != listed(c)) fail(c, "is missing or gone");
      if (listed(c) && order_[rank_[c]] != c) fail(c, "is not where its rank says");
    }
  }

  template <class Archive>
  void archive(Archive& archive) {
    archive(order_, rank_);
  }

 private:
  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

  using Base::rule;
  bool listed(Candidate c) const { return c < rank_.size() && rank_[c] != none; }

  /// All candidates that have changed come out first, so that those that stay are in order when others look for their
  /// places. Gives the first place that has changed.
  std::size_t take_out(const std::vector<Candidate>& changed, Pen& repair) {
    places_.clear();
    for (const Candidate c : changed) {
      if (!listed(c)) continue;
      places_.push_back(std::exchange(rank_[c], none));
      repair.certify(c);
    }
    if (places_.empty()) return order_.size();
    for (std::size_t place : places_) {  // the next on the left that stays gets a new neighbour
      while (place > 0 && rank_[order_[place - 1]] == none) --place;
      if (place > 0) repair.certify(order_[place - 1]);
    }
    std::erase_if(order_, [this](Candidate c) { return rank_[c] == none; });
    return *std::min_element(places_.begin(), places_.end());
  }
  /// The same for those that are there now.
  std::size_t put_in(const std::vector<Candidate>& changed, Pen& repair) {
    std::size_t first = order_.size();
    for (const Candidate c : changed) {
      if (!rule().takes_part(c) || listed(c)) continue;
      if (c >= rank_.size()) rank_.resize(c + std::size_t{1}, none);
      const auto at = std::partition_point(order_.begin(), order_.end(), [&](Candidate other) {
        return repair.sign(rule().in_order(other, c, repair.elements())) >= 0;
      });
      const auto place = static_cast<std::size_t>(at - order_.begin());
      order_.insert(at, c);
      rank_[c] = 0;  // until all are there
      first = std::min(first, place);
    }
    return first;
  }

  std::vector<Candidate> order_;
  std::vector<std::uint32_t> rank_;  ///< of a candidate; none if it is not listed
  std::vector<std::uint32_t> places_;
};

}  // namespace kds::structures
