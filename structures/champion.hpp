// The best of the candidates that an inner structure has: edges, gaps.
#pragma once

#include "kds/audit.hpp"
#include "kds/framework/kinetic.hpp"
#include "structures/bracket.hpp"
#include "structures/candidates.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace kds::structures {

/// What a ChampionRule maintains has become another, or an element that it is made of has got a new motion.
template <class Answer>
struct AnswerChange {
  Answer answer;

  friend bool operator==(const AnswerChange&, const AnswerChange&) = default;
};

/// A rule that stands on another, or on several, StandsOn<A, B, ...>, and keeps the best of candidates that come and go
/// in these: a tournament, each match of which has a certificate that its loser is not better than its winner. `Rule`,
/// which derives from it, says what the candidates are, in terms of inner():
///
///     candidate(change) const            number of the candidate that a change of the inner rule concerns; if there
///     are
///                                        several, candidate(From<I>, change): see CandidatesRule (candidates.hpp)
///     takes_part(candidate) const        whether there is such a candidate
///     better(i, j, elements) const       certificate that candidate i is not worse than j
///     ids(candidate) const               the elements that it is made of, an array of ids
///     find_answer() const -> Answer      what is maintained: champion() in terms of elements
///
/// Events are external if they change the answer. It is reported (AnswerChange), so that other rules may stand on this.
/// Slot: the number of a match.
///
/// Cost: O(log n) certificates for an event, and for each candidate that the inner rule changes; O(n) for n candidates
/// (compact), and each is in O(log n) certificates (local if an element is in few candidates).
template <class Rule, class Inner, class Better, class Answer = std::optional<std::array<Id, 2>>>
class ChampionRule : public CandidatesRule<Rule, Inner> {
  using Base = CandidatesRule<Rule, Inner>;

 public:
  using typename Base::Candidate, typename Base::Element;
  using Change = AnswerChange<Answer>;
  using Pen = Repair<Element, Change>;
  static constexpr Candidate none = Bracket::nobody;

  /// A candidate that is not worse than any; none if there is no candidate.
  Candidate champion() const { return bracket_.winner(); }
  /// Slots are below this.
  Slot end_slot() const { return static_cast<Slot>(bracket_.capacity()); }

  std::optional<Better> certificate(Slot match, const MovingSet<Element>& x) const {
    if (!bracket_.two_play(match)) return std::nullopt;
    return rule().better(bracket_.winner(match), bracket_.loser(match), x);
  }
  std::vector<Id> members(Slot match) const { return this->ids_of(bracket_.winner(match), bracket_.loser(match)); }

  Effect repair(Slot match, Pen& repair) {
    bracket_.climb(match, Bracket::nobody, beats(repair), marks(repair));
    return renew_answer(repair);
  }
  Effect followed(Pen& repair) {
    const std::vector<Candidate>& changed = this->take_changed();
    bracket_.update(
        changed, [this](Candidate c) { return rule().takes_part(c); }, beats(repair), marks(repair));
    const bool moved = std::find(changed.begin(), changed.end(), champion()) != changed.end();
    return renew_answer(repair, moved);
  }

  std::vector<Change> changes_from_nothing() const { return {{answer_}}; }

  void audit(const MovingSet<Element>& /*elements*/, double /*now*/) const {
    bracket_.audit(Rule::name);
    for (Candidate c = 0; c < bracket_.capacity(); ++c) {
      if (rule().takes_part(c) != bracket_.contains(c)) {
        throw AuditFailure(Rule::name + (": candidate " + std::to_string(c)) + ": is missing or gone");
      }
    }
  }

  template <class Archive>
  void archive(Archive& archive) {
    archive(bracket_, answer_);
  }

 protected:
  const Answer& answer() const { return answer_; }
  /// To be called where the answer changes and champion() does not. `moved`: an element of the answer has a new motion.
  Effect renew_answer(Pen& repair, bool moved = false) {
    const Answer before = std::exchange(answer_, rule().find_answer());
    const bool same = answer_ == before;
    if (!same || moved) repair.report({answer_});
    return same ? Effect::internal : Effect::external;
  }

 private:
  using Base::rule;
  auto beats(const Pen& repair) const {
    return
        [this, &repair](Candidate i, Candidate j) { return repair.sign(rule().better(i, j, repair.elements())) >= 0; };
  }
  static auto marks(Pen& repair) {
    return [&repair](std::size_t match) { repair.certify(static_cast<Slot>(match)); };
  }

  Bracket bracket_;
  Answer answer_{};
};

}  // namespace kds::structures
