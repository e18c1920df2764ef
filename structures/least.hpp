// The k least of moving elements: of values, of points in a direction or by their distances from another.
#pragma once

#include "kds/audit.hpp"
#include "kds/framework/kinetic.hpp"
#include "structures/ranking.hpp"
#include "structures/tournaments.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

namespace kds::structures {

/// An element has come among the least, or has left them. One that gets another motion and stays among them is told of
/// twice in one call: as gone, and as come.
struct LeastChange {
  enum class What : std::uint8_t { came, went };  ///< to the least; away from them
  What what;
  Id id;

  friend bool operator==(const LeastChange&, const LeastChange&) = default;
};

/// The greatest of the least ones is another element than before, or the same one with a new motion.
struct LastChange {
  Id last;  ///< nobody if there are fewer than count() elements

  friend bool operator==(const LastChange&, const LastChange&) = default;
};

/// Keeps which k of moving elements are the least, and which of these is the greatest. Two tournaments: the greatest of
/// the least elements, and the least of the others; one more certificate says that these two are in order. So elements
/// that are far from the border between both cost little. Paper: [Basch99], for tournaments.
///
/// Cost: an event O(log n) certificates (responsive); n - 1 certificates (compact), each element in O(log n) (local).
/// An event is external if last() has become another, so also if another element is among the least. Events: those of
/// two tournaments, whose elements also come and go, and one for each two elements that change places at rank k:
/// vertices of the k-level, of which lines have O(n k^(1/3)) [Dey98].
///
/// It reports which elements are among the least (LeastChange), and which is the last of them (LastChange), so that
/// other rules may stand on it.
///
/// It stores the ranking, since certificates may refer to what that contains. One that contains a motion (points ranked
/// by their distances from a robot) cannot be reversed: reverse() turns round elements only.
template <Ranking Rank>
class LeastRule : public Tournaments<LeastRule<Rank>, typename Rank::Element> {
  using Sides = Tournaments<LeastRule, typename Rank::Element>;
  using Sides::enter, Sides::leave, Sides::size, Sides::winner;
  static constexpr std::size_t least = 0, others = 1;

 public:
  using typename Sides::Element;
  using Change = Changes<LeastChange, LastChange>;
  using Pen = Repair<Element, Change>;
  static constexpr const char* name = "Least";

  explicit LeastRule(std::size_t count = 1, Rank ranking = {})
      : Sides(2), count_(count), ranking_(std::move(ranking)) {}

  /// Whether an element is among the least; all are if there are not more than count().
  bool contains(Id id) const { return Sides::contains(id, least); }
  /// The greatest of the least ones; nobody if there are fewer than count() elements, or count() is 0. If several stay
  /// equal it is any of them.
  Id last() const { return size(least) == count_ ? winner(least) : nobody; }
  std::size_t count() const { return count_; }
  const Rank& ranking() const { return ranking_; }

  /// For another number, to be called in Kinetic::edit(): O(log n) for each in between.
  void set_count(std::size_t count, Pen& repair) {
    renew_last(repair, [&] {
      count_ = count;
      share(repair);
    });
  }
  /// For another ranking, to be called in Kinetic::edit(): O(n log n).
  void set_ranking(Rank ranking, Pen& repair) {
    for (const Id id : repair.elements().ids()) let_go(id, repair);
    ranking_ = std::move(ranking);
    for (const Id id : repair.elements().ids()) insert(id, repair);
  }

  /// Of the least ones the greatest wins, of the others the least.
  auto better(Id i, Id j, std::size_t side, const MovingSet<Element>& x) const {
    return side == least ? ranking_.in_order(x[j], x[i]) : ranking_.in_order(x[i], x[j]);
  }

  // Slot 0: the winners of both sides are in order. The others are matches.
  auto certificate(Slot slot, const MovingSet<Element>& x) const {
    const bool two = slot == 0 && size(least) > 0 && size(others) > 0;
    return two ? std::optional(better(winner(least), winner(others), others, x)) : Sides::certificate(slot, x);
  }
  std::array<Id, 2> members(Slot slot) const {
    return slot > 0 ? Sides::members(slot) : std::array{winner(least), winner(others)};
  }

  Effect repair(Slot slot, Pen& repair) {
    return renew_last(repair, [&] {
      if (slot > 0) this->play(slot, repair);
      if (slot == 0) move(winner(others), least, repair);  // Then the greatest of the least has to go.
      share(repair);
    });
  }
  void insert(Id id, Pen& repair) {
    renew_last(repair, [&] {
      enter(id, least, repair);
      repair.report(LeastChange{LeastChange::What::came, id});
      share(repair);
    });
  }
  void remove(Id id, Pen& repair) {
    renew_last(repair, [&] {
      let_go(id, repair);
      share(repair);
    });
  }

  std::tuple<std::vector<LeastChange>, std::vector<LastChange>> changes_from_nothing() const {
    std::vector<LeastChange> changes;
    for (Id id = 0; id < this->end_entrant(); ++id) {
      if (contains(id)) changes.push_back({LeastChange::What::came, id});
    }
    if (last() == nobody) return {std::move(changes), {}};
    return {std::move(changes), {{last()}}};
  }

  void audit(const MovingSet<Element>& x, double /*now*/) const {
    this->audit_matches(x, 1);
    if (size(least) == std::min(count_, x.size())) return;
    throw AuditFailure(std::string(name) + ": " + std::to_string(size(least)) + " elements are among the least, of " +
                       std::to_string(count_));
  }
  template <class Archive>
  void archive(Archive& archive) {
    archive(count_);
    if constexpr (!std::is_empty_v<Rank>) archive(ranking_);
    this->archive_matches(archive, 2);
  }

 private:
  void move(Id id, std::size_t side, Pen& repair) {
    leave(id, repair);
    enter(id, side, repair);
    repair.report(LeastChange{side == least ? LeastChange::What::came : LeastChange::What::went, id});
  }
  void let_go(Id id, Pen& repair) {
    if (contains(id)) repair.report(LeastChange{LeastChange::What::went, id});
    leave(id, repair);
  }
  /// An element with a new motion is removed and inserted, so for a while another one is last if this one was.
  template <class F>
  Effect renew_last(Pen& repair, F&& change) {
    const Id before = last();
    change();
    if (last() == before) return Effect::internal;
    repair.report(LastChange{last()});
    return Effect::external;
  }
  /// Moves the greatest of the least elements, or the least of the others, until count_ are among the least.
  void share(Pen& repair) {
    while (size(least) > count_) move(winner(least), others, repair);
    while (size(least) < count_ && size(others) > 0) move(winner(others), least, repair);
    repair.certify(0);
  }

  std::size_t count_;
  Rank ranking_;
};

}  // namespace kds::structures
