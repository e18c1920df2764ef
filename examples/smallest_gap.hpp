// The smallest gap between moving values: a kinetic structure that stands on a sorted list.
#pragma once

#include "examples/list_in_forty_lines.hpp"
#include "structures/champion.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>

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

/// Maintains the two values that are closest: it stands on a sorted list, which tells neighbours, and keeps the
/// smallest of their gaps. A gap is known by the lower of its two values.
class SmallestGapRule : public structures::ChampionRule<SmallestGapRule, ListRule<Motion<2>>, Narrower> {
 public:
  static constexpr const char* name = "SmallestGap";

  /// The two, the lower id first; none if there are fewer than two values.
  const std::optional<std::array<Id, 2>>& pair() const { return answer(); }

  Id candidate(const NewNeighbour& change) const { return change.left; }
  bool takes_part(Id left) const {
    const auto& [order, place] = inner();
    return left < place.size() && place[left] + std::size_t{1} < order.size() && order[place[left]] == left;
  }
  std::array<Id, 2> ids(Id left) const { return {left, inner().order[inner().place[left] + 1]}; }
  Narrower better(Id gap, Id other, const MovingSet<Element>& x) const {
    const auto [a, b] = ids(gap);
    const auto [c, d] = ids(other);
    return {x[a], x[b], x[c], x[d]};
  }
  std::optional<std::array<Id, 2>> find_answer() const {
    if (champion() == none) return std::nullopt;
    const auto [a, b] = ids(champion());
    return std::array{std::min(a, b), std::max(a, b)};
  }
};

}  // namespace kds::examples
