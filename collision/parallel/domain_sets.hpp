// Sets of domains, of which there are few different ones.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace kds::collision {

/// A domain, below `most_domains`.
using DomainIndex = std::uint16_t;
/// The greatest one stands for no domain.
inline constexpr DomainIndex no_domain = std::numeric_limits<DomainIndex>::max();
inline constexpr std::size_t most_domains = no_domain;

/// Stores each set of domains once and gives it a number: bodies near each other are known to the same domains, so
/// there are far fewer sets than bodies, and sets are equal where their numbers are. The set of domain i alone has
/// number i.
///
/// Cost: O(length) to find the number of a set, O(1) for its members. Memory: two bytes a member and some 12 a set.
class DomainSets {
 public:
  using Number = std::uint32_t;

  /// Precondition: domains <= most_domains.
  explicit DomainSets(std::size_t domains) : alone_(domains) {
    for (std::size_t i = 0; i < domains; ++i) {
      const auto domain = static_cast<DomainIndex>(i);
      store({&domain, 1});
    }
  }

  std::size_t size() const { return begin_.size() - 1; }
  /// Its members, ascending. Valid until the next set is stored.
  std::span<const DomainIndex> operator[](Number set) const {
    return {members_.data() + begin_[set], begin_[set + 1] - begin_[set]};
  }

  /// The number of the set with these members, which must be ascending.
  Number number_of(std::span<const DomainIndex> members) {
    if (members.size() == 1) return members[0];
    if (2 * (size() - alone_ + 1) > table_.size()) grow();
    Number& found = *place_of(members);
    if (found == none) found = store(members);
    return found;
  }

 private:
  static constexpr Number none = std::numeric_limits<Number>::max();

  Number store(std::span<const DomainIndex> members) {
    members_.insert(members_.end(), members.begin(), members.end());
    begin_.push_back(members_.size());
    return static_cast<Number>(size() - 1);
  }
  /// Where in the table it is, or is to be.
  Number* place_of(std::span<const DomainIndex> members) {
    std::uint64_t hash = members.size();
    for (const DomainIndex member : members) hash = (hash ^ member) * 0x9e3779b97f4a7c15u, hash ^= hash >> 29;
    const std::size_t mask = table_.size() - 1;
    for (std::size_t at = hash & mask;; at = (at + 1) & mask) {
      if (table_[at] == none || std::ranges::equal((*this)[table_[at]], members)) return &table_[at];
    }
  }
  void grow() {
    table_.assign(std::max<std::size_t>(64, 2 * table_.size()), none);
    for (std::size_t set = alone_; set < size(); ++set) {
      const auto number = static_cast<Number>(set);
      *place_of((*this)[number]) = number;
    }
  }

  std::vector<DomainIndex> members_;   ///< of all sets, one after another
  std::vector<std::size_t> begin_{0};  ///< by number: where those of a set begin; one more
  std::size_t alone_;                  ///< sets of one member
  std::vector<Number> table_;          ///< of the others, by hash; the size is a power of two, at least half is free
};

}  // namespace kds::collision
