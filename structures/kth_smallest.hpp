// The k-th smallest of moving values: a median, a percentile.
#pragma once

#include "certificates/in_order.hpp"
#include "kds/audit.hpp"
#include "kds/framework/kinetic_rule.hpp"
#include "structures/tournaments.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>

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
class KthSmallestRule : public Tournaments<KthSmallestRule<Value>, Value> {
  using Sides = Tournaments<KthSmallestRule, Value>;
  using Sides::contains, Sides::size, Sides::winner;
  static constexpr std::size_t lower = 0, upper = 1;

 public:
  using Element = Value;
  using InOrder = certificates::InOrder<Value>;
  static constexpr const char* name = "KthSmallest";

  /// The least has rank 0.
  explicit KthSmallestRule(std::size_t rank = 0) : Sides(2), rank_(rank) {}

  /// nobody if there are not more than rank() values. If several stay equal it is any of them.
  Id kth() const { return size(lower) > rank_ ? winner(lower) : nobody; }
  std::size_t rank() const { return rank_; }
  /// For another rank, to be called in Kinetic::edit(): O(log n) for each rank in between.
  void set_rank(std::size_t rank, Repair<Value>& repair) {
    rank_ = rank;
    share(repair);
  }

  InOrder better(Id i, Id j, std::size_t side, const MovingSet<Value>& x) const {
    return side == lower ? InOrder{x[j], x[i]} : InOrder{x[i], x[j]};
  }

  // Slot 0: the winners of both sides are in order. The others are matches.
  std::optional<InOrder> certificate(Slot slot, const MovingSet<Value>& x) const {
    if (slot > 0) return Sides::certificate(slot, x);
    if (size(lower) == 0 || size(upper) == 0) return std::nullopt;
    return InOrder{x[winner(lower)], x[winner(upper)]};
  }
  std::array<Id, 2> members(Slot slot) const {
    return slot > 0 ? Sides::members(slot) : std::array{winner(lower), winner(upper)};
  }

  Effect repair(Slot slot, Repair<Value>& repair) {
    const Id before = kth();
    if (slot > 0) this->play(slot, repair);
    if (slot == 0) move(winner(upper), lower, repair);  // Then the greatest of the lower ones has to go.
    share(repair);
    return kth() == before ? Effect::internal : Effect::external;
  }
  void insert(Id id, Repair<Value>& repair) {
    this->enter(id, lower, repair);
    share(repair);
  }
  void remove(Id id, Repair<Value>& repair) {
    this->leave(id, lower, repair);
    this->leave(id, upper, repair);
    share(repair);
  }

  void audit(const MovingSet<Value>& x, double /*now*/) const {
    this->audit_matches();
    for (const Id id : x.ids()) {
      if (contains(id, lower) == contains(id, upper)) {
        throw AuditFailure(name + (": id " + std::to_string(id)) + ": is on neither side, or on both");
      }
    }
    if (size(lower) != std::min(rank_ + 1, x.size()) || size(lower) + size(upper) != x.size()) {
      throw AuditFailure(std::string(name) + ": the lower values are not as many as the rank says");
    }
  }
  template <class Archive>
  void archive(Archive& archive) {
    archive(rank_);
    this->archive_matches(archive, 2);
  }

 private:
  void move(Id id, std::size_t side, Repair<Value>& repair) {
    this->leave(id, 1 - side, repair);
    this->enter(id, side, repair);
  }
  /// Moves the greatest of the lower values, or the least of the upper ones, until rank_ + 1 are lower.
  void share(Repair<Value>& repair) {
    while (size(lower) > rank_ + 1) move(winner(lower), upper, repair);
    while (size(lower) <= rank_ && size(upper) > 0) move(winner(upper), lower, repair);
    repair.certify(0);
  }

  std::size_t rank_;
};

}  // namespace kds::structures
