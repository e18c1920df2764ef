// The smallest gap between moving values: a kinetic structure made of a sorted list and a tournament.
#pragma once

#include "examples/list_in_forty_lines.hpp"
#include "structures/bracket.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace kds::examples {

/// b - a <= d - c: one gap is not wider than another.
struct Narrower {
  static constexpr int degree = 2;
  const Motion<2>&a, &b, &c, &d;

  template <class Number>
  auto polynomial(double epoch) const {
    return difference_about<Number>(d, c, epoch) - difference_about<Number>(b, a, epoch);
  }
  bool vanishes() const { return a == c && b == d; }
};

/// Its name on a page of the course.
template <class Name>
std::string fact(const Narrower& gaps, const Name& name) {
  return "gap " + name(gaps.a) + name(gaps.b) + " \u2264 gap " + name(gaps.c) + name(gaps.d);
}

/// Maintains the two closest neighbours: the list gives neighbours, a tournament of their gaps the smallest one. Even
/// slots are the list's, odd ones the matches; a gap is identified by the lower of its two values.
class SmallestGapRule {
 public:
  using Element = Motion<2>;
  static constexpr const char* name = "SmallestGap";
  using Choice = std::variant<std::monostate, std::optional<ListRule<Element>::InOrder>, Narrower>;

 private:
  std::array<Id, 2> ends(Id lower) const { return {lower, list_.order[list_.place[lower] + 1]}; }
  Narrower narrower(Id gap, Id other, const MovingSet<Element>& x) const {
    const auto [a, b] = ends(gap);
    const auto [c, d] = ends(other);
    return {x[a], x[b], x[c], x[d]};
  }
  auto beats(const Repair<Element>& repair) const {
    return [this, &repair](Id left, Id right) {
      return repair.sign(narrower(left, right, repair.elements())) >= 0;
    };
  }
  static auto marks(Repair<Element>& repair) {
    return [&repair](std::size_t match) { repair.certify(static_cast<Slot>(2 * match + 1)); };
  }

  /// Calls the list, then plays the matches of the gaps that it has marked again: these have changed.
  template <class Do>
  void within(Repair<Element>& repair, const Do& work) {
    repair.nested(0, 2, [&] { return work(), 0; });
    std::vector<Id> gaps;
    for (const Slot slot : repair.marked()) {
      if (slot % 2 == 0) gaps.push_back(slot / 2);
    }
    const auto is_gap = [&](Id lower) {
      const std::size_t place = list_.place[lower];
      return place + 1 < list_.order.size() && list_.order[place] == lower;
    };
    gaps_.update(gaps, is_gap, beats(repair), marks(repair));
  }

 public:
  const ListRule<Element>& list() const { return list_; }
  /// The two, the lower one first. Precondition: there are two values or more.
  std::array<Id, 2> pair() const { return ends(gaps_.winner()); }

  /// Slots are below this.
  Slot end_slot() const { return static_cast<Slot>(2 * std::max(gaps_.capacity(), list_.place.size())); }

  Choice certificate(Slot slot, const MovingSet<Element>& x) const {
    if (slot % 2 == 0 && slot / 2 < list_.place.size()) return list_.certificate(slot / 2, x);
    if (slot % 2 == 0) return {};
    if (!gaps_.two_play(slot / 2)) return {};
    return narrower(gaps_.winner(slot / 2), gaps_.loser(slot / 2), x);
  }
  std::vector<Id> members(Slot slot) const {
    const auto [a, b] = ends(slot % 2 == 0 ? slot / 2 : gaps_.winner(slot / 2));
    if (slot % 2 == 0) return {a, b};
    const auto [c, d] = ends(gaps_.loser(slot / 2));
    return b == c ? std::vector{a, b, d} : d == a ? std::vector{a, b, c} : std::vector{a, b, c, d};
  }
  Effect repair(Slot slot, Repair<Element>& repair) {
    const auto before = pair();
    if (slot % 2 == 0) {
      within(repair, [&] { list_.repair(slot / 2, repair); });
    } else {
      gaps_.climb(slot / 2, structures::Bracket::nobody, beats(repair), marks(repair));
    }
    const bool same = pair() == before || pair() == std::array{before[1], before[0]};  // closest when they swap, too
    return same ? Effect::internal : Effect::external;
  }
  void insert(Id id, Repair<Element>& repair) {
    within(repair, [&] { list_.insert(id, repair); });
  }
  void remove(Id id, Repair<Element>& repair) {
    within(repair, [&] { list_.remove(id, repair); });
  }
  template <class Archive>
  void archive(Archive& archive) {
    archive(list_, gaps_);
  }

 private:
  ListRule<Element> list_;
  structures::Bracket gaps_;
};

}  // namespace kds::examples
