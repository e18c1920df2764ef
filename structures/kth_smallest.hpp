// The k-th smallest of moving values: a median, a percentile.
#pragma once

#include "certificates/in_order.hpp"
#include "kds/audit.hpp"
#include "kds/framework/kinetic_rule.hpp"
#include "structures/bracket.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace kds::structures {

/// Keeps the value of rank k among moving values: k are not greater, the others not smaller. Two tournaments: the
/// greatest of the k + 1 least values, which is the answer, and the least of the others; one more certificate says that
/// these two are in order. So values that are far from the answer cost little. Paper: [Basch99], for tournaments.
///
/// Cost: an event O(log n) certificates (responsive); n - 1 certificates (compact), each value in O(log n) (local). An
/// event is external if the answer has become another. Events: those of two tournaments, whose values also come and go,
/// and one for each two values that change places at rank k: vertices of the k-level, of which lines have O(n k^(1/3))
/// [Dey98].
template <MovingElement Value>
class KthSmallestRule {
 public:
  using Element = Value;
  using InOrder = certificates::InOrder<Value>;
  static constexpr const char* name = "KthSmallest";

  /// The least has rank 0.
  explicit KthSmallestRule(std::size_t rank = 0) : rank_(rank) {}

  /// nobody if there are not more than rank() values. If several stay equal it is any of them.
  Id kth() const { return lower_size_ > rank_ ? lower_.winner() : nobody; }
  std::size_t rank() const { return rank_; }
  /// For another rank, to be called in Kinetic::edit(): O(log n) for each rank in between.
  void set_rank(std::size_t rank, Repair<Value>& repair) {
    rank_ = rank;
    share(repair);
  }

  // Slot 0: the two winners are in order. 2 m: match m of the lower values; 2 m + 1: of the upper ones.
  std::optional<InOrder> certificate(Slot slot, const MovingSet<Value>& x) const {
    const auto two = members(slot);
    if (two.empty()) return std::nullopt;
    return InOrder{x[two[0]], x[two[1]]};
  }
  /// The one that is to be smaller first.
  std::vector<Id> members(Slot slot) const {
    if (slot == 0 && !both()) return {};
    if (slot == 0) return {lower_.winner(), upper_.winner()};
    const Bracket& bracket = slot % 2 == 0 ? lower_ : upper_;
    if (slot == 1 || !bracket.two_play(slot / 2)) return {};
    const Id winner = bracket.winner(slot / 2), loser = bracket.loser(slot / 2);
    return slot % 2 == 0 ? std::vector{loser, winner} : std::vector{winner, loser};
  }

  Effect repair(Slot slot, Repair<Value>& repair) {
    const Id before = kth();
    if (slot == 0) {
      const Id low = lower_.winner(), high = upper_.winner();
      put(low, false, true, repair);
      put(high, true, false, repair);
    } else if (slot % 2 == 0) {
      lower_.climb(slot / 2, Bracket::nobody, greater(repair), marks(0, repair));
    } else {
      upper_.climb(slot / 2, Bracket::nobody, smaller(repair), marks(1, repair));
    }
    return kth() == before ? Effect::internal : Effect::external;
  }
  void insert(Id id, Repair<Value>& repair) {
    lower_.reserve(id + std::size_t{1}, greater(repair), marks(0, repair));
    upper_.reserve(id + std::size_t{1}, smaller(repair), marks(1, repair));
    put(id, true, false, repair);
    ++lower_size_;
    share(repair);
  }
  void remove(Id id, Repair<Value>& repair) {
    lower_size_ -= lower_.contains(id);
    put(id, false, false, repair);
    share(repair);
  }
  void audit(const MovingSet<Value>& x, double /*now*/) const {
    lower_.audit(name);
    upper_.audit(name);
    std::size_t lower = 0;
    for (const Id id : x.ids()) {
      lower += lower_.contains(id);
      if (lower_.contains(id) == upper_.contains(id)) {
        throw AuditFailure(name + (": id " + std::to_string(id)) + ": is on neither side, or on both");
      }
    }
    if (lower != lower_size_ || lower != std::min(rank_ + 1, x.size())) {
      throw AuditFailure(std::string(name) + ": the lower values are not as many as the rank says");
    }
  }
  template <class Archive>
  void archive(Archive& archive) {
    archive(rank_, lower_size_, lower_, upper_);
  }

 private:
  bool both() const { return lower_.winner() != Bracket::nobody && upper_.winner() != Bracket::nobody; }

  auto greater(const Repair<Value>& repair) const {
    return [&repair](Id i, Id j) { return repair.sign(InOrder{repair[j], repair[i]}) >= 0; };
  }
  auto smaller(const Repair<Value>& repair) const {
    return [&repair](Id i, Id j) { return repair.sign(InOrder{repair[i], repair[j]}) >= 0; };
  }
  static auto marks(Slot side, Repair<Value>& repair) {
    repair.certify(0);
    return [side, &repair](std::size_t match) { repair.certify(static_cast<Slot>(2 * match) + side); };
  }

  void put(Id id, bool in_lower, bool in_upper, Repair<Value>& repair) {
    if (in_lower || lower_.contains(id)) lower_.set(id, in_lower, greater(repair), marks(0, repair));
    if (in_upper || upper_.contains(id)) upper_.set(id, in_upper, smaller(repair), marks(1, repair));
  }
  /// Moves the greatest of the lower values, or the least of the upper ones, until rank_ + 1 are lower.
  void share(Repair<Value>& repair) {
    for (; lower_size_ > rank_ + 1; --lower_size_) put(lower_.winner(), false, true, repair);
    for (; lower_size_ <= rank_ && upper_.winner() != Bracket::nobody; ++lower_size_) {
      put(upper_.winner(), true, false, repair);
    }
  }

  std::size_t rank_;
  std::uint64_t lower_size_ = 0;
  Bracket lower_;
  Bracket upper_;
};

}  // namespace kds::structures
