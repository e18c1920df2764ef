// The k-th smallest of moving values: a median, a percentile.
#pragma once

#include "kds/framework/kinetic_rule.hpp"
#include "structures/least.hpp"
#include "structures/ranking.hpp"

#include <cstddef>

namespace kds::structures {

/// Keeps the value of rank k among moving values: k are not greater, the others not smaller. It is the greatest of the
/// k + 1 least ones. Cost and events: as LeastRule.
template <MovingElement Value>
class KthSmallestRule : public LeastRule<ByValue<Value>> {
 public:
  static constexpr const char* name = "KthSmallest";

  /// The least has rank 0.
  explicit KthSmallestRule(std::size_t rank = 0) : LeastRule<ByValue<Value>>(rank + 1) {}

  /// nobody if there are not more than rank() values. If several stay equal it is any of them.
  Id kth() const { return this->last(); }
  std::size_t rank() const { return this->count() - 1; }
  /// For another rank, to be called in Kinetic::edit(): O(log n) for each rank in between.
  void set_rank(std::size_t rank, typename KthSmallestRule::Pen& repair) { this->set_count(rank + 1, repair); }
};

}  // namespace kds::structures
