// The part that rules with tournaments have in common: which match a slot is, what it proves, and how it is played.
#pragma once

#include "kds/audit.hpp"
#include "kds/framework/kinetic_rule.hpp"
#include "structures/bracket.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace kds::structures {

/// A constant number of tournaments of elements. Each match is certified: the loser is not better than the winner.
/// `Rule`, which derives from it, says what that is:
///
///     better(i, j, tournament, elements) const      certificate that element i is not worse than j
///
/// Slot: match * tournaments + tournament. There is no match 0, and no certificate in its slots: they are for what else
/// the rule certifies.
///
/// Cost: O(log n) certificates where an element comes, goes or changes, or a certificate fails; n - 1 certificates for
/// each tournament (compact), each element in O(log n) of them (local). Paper: [Basch99] section 3.2.
template <class Rule, MovingElement Entrant>
class Tournaments {
 public:
  using Element = Entrant;

  explicit Tournaments(std::size_t tournaments) : brackets_(tournaments) {}

  auto certificate(Slot slot, const MovingSet<Element>& x) const {
    using C = decltype(rule().better(0, 0, 0, x));
    if (!bracket(slot).two_play(match(slot))) return std::optional<C>();
    const auto [loser, winner] = members(slot);
    return std::optional<C>(rule().better(winner, loser, tournament(slot), x));
  }
  /// Loser and winner of a match. Precondition: the slot has a certificate.
  std::array<Id, 2> members(Slot slot) const {
    return {bracket(slot).loser(match(slot)), bracket(slot).winner(match(slot))};
  }

 protected:
  /// One that is not worse than any; nobody if there are none.
  Id winner(std::size_t tournament) const { return brackets_[tournament].winner(); }
  bool contains(Id id, std::size_t tournament) const { return brackets_[tournament].contains(id); }
  /// The tournament that a slot belongs to.
  std::size_t tournament(Slot slot) const { return slot % brackets_.size(); }
  /// Ids of elements are below this.
  Id end_entrant() const {
    std::size_t end = 0;
    for (const Bracket& each : brackets_) end = std::max(end, each.capacity());
    return static_cast<Id>(end);
  }
  /// How many elements there are.
  std::size_t size(std::size_t tournament) const { return brackets_[tournament].size(); }

  /// Plays a match whose certificate has failed, and the matches above it that this changes. Returns whether the
  /// tournament has another winner.
  template <class Pen>
  bool play(Slot slot, Pen& repair) {
    const std::size_t i = tournament(slot);
    const Id before = winner(i);
    brackets_[i].climb(match(slot), Bracket::nobody, beats(i, repair), marks(i, repair));
    return winner(i) != before;
  }
  /// Lets an element in, or one that has changed play again.
  template <class Pen>
  void enter(Id id, std::size_t i, Pen& repair) {
    brackets_[i].reserve(id + std::size_t{1}, beats(i, repair), marks(i, repair));
    brackets_[i].set(id, true, beats(i, repair), marks(i, repair));
  }
  /// Lets an element out, if it is in this tournament; or in whichever it is.
  template <class Pen>
  void leave(Id id, std::size_t i, Pen& repair) {
    if (contains(id, i)) brackets_[i].set(id, false, beats(i, repair), marks(i, repair));
  }
  template <class Pen>
  void leave(Id id, Pen& repair) {
    for (std::size_t i = 0; i < brackets_.size(); ++i) leave(id, i, repair);
  }

  /// Throws AuditFailure unless each element is in so many of the tournaments, and no id that is none in any.
  void audit_matches(const MovingSet<Element>& x, std::size_t tournaments) const {
    for (const Bracket& each : brackets_) each.audit(Rule::name);
    for (Id id = 0; id < std::max(x.end_id(), end_entrant()); ++id) {
      const auto here =
          std::count_if(brackets_.begin(), brackets_.end(), [id](const Bracket& b) { return b.contains(id); });
      if (static_cast<std::size_t>(here) == (x.contains(id) ? tournaments : 0)) continue;
      throw AuditFailure(Rule::name + (": id " + std::to_string(id)) + ": is in " + std::to_string(here) +
                         " tournaments");
    }
  }
  /// A snapshot must have this many tournaments.
  template <class Archive>
  void archive_matches(Archive& archive, std::size_t tournaments) {
    archive(brackets_);
    if constexpr (Archive::loading) {
      archive.require(brackets_.size() == tournaments, "a structure has another number of tournaments");
    }
  }

 private:
  const Rule& rule() const { return static_cast<const Rule&>(*this); }
  std::size_t match(Slot slot) const { return slot / brackets_.size(); }
  const Bracket& bracket(Slot slot) const { return brackets_[tournament(slot)]; }

  template <class Pen>
  auto beats(std::size_t i, const Pen& repair) const {
    return [this, i, &repair](Id a, Id b) { return repair.sign(rule().better(a, b, i, repair.elements())) >= 0; };
  }
  template <class Pen>
  auto marks(std::size_t i, Pen& repair) const {
    return [this, i, &repair](std::size_t match) { repair.certify(static_cast<Slot>(match * brackets_.size() + i)); };
  }

  std::vector<Bracket> brackets_;
};

}  // namespace kds::structures
