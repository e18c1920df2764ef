// Pairs of bodies that never meet because the caller says so.
#pragma once

#include "collision/body_id.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace kds::collision {

/// A set of pairs of bodies, by slot.
///
/// Cost: O(log n) each; O(k log n) for a body of k pairs that is removed.
class IgnoredPairs {
 public:
  /// The lower slot first.
  using Pair = std::pair<BodySlot, BodySlot>;
  static Pair pair(BodySlot a, BodySlot b) { return std::minmax(a, b); }

  bool empty() const { return partners_.empty(); }
  bool contains(BodySlot a, BodySlot b) const {
    const auto found = partners_.find(a);
    return found != partners_.end() && found->second.contains(b);
  }
  void add(BodySlot a, BodySlot b) {
    partners_[a].insert(b);
    partners_[b].insert(a);
  }
  void remove(BodySlot a, BodySlot b) {
    erase(a, b);
    erase(b, a);
  }
  /// All pairs of a body.
  void forget(BodySlot body) {
    const auto found = partners_.find(body);
    if (found == partners_.end()) return;
    for (const BodySlot other : found->second) erase(other, body);
    partners_.erase(found);
  }
  void clear() { partners_.clear(); }

  /// Calls visit(other) for each body that does not meet this one, ascending.
  template <class Visit>
  void each_partner(BodySlot body, const Visit& visit) const {
    const auto found = partners_.find(body);
    if (found == partners_.end()) return;
    for (const BodySlot other : found->second) visit(other);
  }
  /// All pairs, in order.
  std::vector<Pair> pairs() const {
    std::vector<Pair> all;
    for (const auto& [body, others] : partners_) {
      for (auto other = others.upper_bound(body); other != others.end(); ++other) all.emplace_back(body, *other);
    }
    return all;
  }

 private:
  void erase(BodySlot from, BodySlot other) {
    const auto found = partners_.find(from);
    if (found == partners_.end()) return;
    found->second.erase(other);
    if (found->second.empty()) partners_.erase(found);
  }

  std::map<BodySlot, std::set<BodySlot>> partners_;
};

}  // namespace kds::collision
