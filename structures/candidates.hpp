// What rules have in common that keep candidates which inner structures have: edges, gaps.
#pragma once

#include "kds/framework/kinetic.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace kds::structures {

namespace detail {

template <class Inner>
struct StandingPlace {
  using type = StandsOn<Inner>;
};
template <class... Inners>
struct StandingPlace<StandsOn<Inners...>> {
  using type = StandsOn<Inners...>;
};

}  // namespace detail

/// The part of ChampionRule and OrderedRule that hears of candidates. `Inner` is the rule that they stand on, or
/// StandsOn<A, B, ...> if these are several, whose candidates are compared with each other. `Rule`, which derives from
/// it, says what candidates are:
///
///     candidate(change) const            number of the candidate that a change of the inner rule concerns
///     candidate(From<I>, change) const   if there are several: of one that the rule at the place I tells
///     ids(candidate) const               the elements that it is made of, ids in a container: of the rule's own set
///                                        of elements, if inner rules have others
///
/// Two candidates have different numbers, whatever rules they come from: 2 i and 2 i + 1, say. Numbers should be small,
/// as memory is that of the greatest.
template <class Rule, class Inner>
class CandidatesRule : public detail::StandingPlace<Inner>::type {
  using Base = typename detail::StandingPlace<Inner>::type;

 public:
  using Element = typename Base::Element;
  using Candidate = std::uint32_t;

  // Candidates of one rule may be compared with those of another, and must all be the present ones then: so all changes
  // are taken up together, when the last rule has told of its own.
  template <class Pen>
  Effect follow(std::span<const typename Base::Heard> changes, Pen& /*repair*/) {
    for (const auto& change : changes) changed_.push_back(rule().candidate(change));
    return Effect::internal;
  }
  template <std::size_t I, class Pen>
  Effect follow(From<I> place, std::span<const typename Base::template HeardAt<I>> changes, Pen& /*repair*/) {
    for (const auto& change : changes) changed_.push_back(rule().candidate(place, change));
    return Effect::internal;
  }

 protected:
  /// Candidates of which it has been told, since this was called last.
  const std::vector<Candidate>& take_changed() {
    taken_.swap(changed_);
    changed_.clear();
    return taken_;
  }
  /// The elements of two candidates, each once.
  std::vector<Id> ids_of(Candidate a, Candidate b) const {
    const auto first = rule().ids(a), second = rule().ids(b);
    std::vector<Id> ids(first.begin(), first.end());
    ids.insert(ids.end(), second.begin(), second.end());
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    return ids;
  }
  Rule& rule() { return static_cast<Rule&>(*this); }
  const Rule& rule() const { return static_cast<const Rule&>(*this); }

 private:
  std::vector<Candidate> changed_, taken_;
};

}  // namespace kds::structures
