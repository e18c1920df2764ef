// What tests of rules that stand on others have in common.
#pragma once

#include "kds/framework/kinetic.hpp"
#include "structures/triangulation_edges.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <variant>
#include <vector>

namespace kds::tests {

/// What rules without certificates have.
template <class Element>
struct Quiet {
  std::monostate certificate(Slot, const MovingSet<Element>&) const { return {}; }
  std::array<Id, 0> members(Slot) const { return {}; }
};

/// Edges by what has been told of them. Throws what would be wrong.
struct EdgesTold {
  std::map<std::uint32_t, std::array<Id, 2>> ends{};

  void take(const structures::EdgeChange& change) {
    const auto known = ends.find(change.edge);
    if (change.what == structures::EdgeChange::What::came) {
      if (known != ends.end()) throw std::logic_error("an edge comes that is there");
      ends[change.edge] = change.ends;
    } else {
      if (known == ends.end() || known->second != change.ends) throw std::logic_error("an unknown edge");
      if (change.what == structures::EdgeChange::What::went) ends.erase(known);
    }
  }
  bool joins(Id a, Id b) const {
    return std::any_of(ends.begin(), ends.end(), [&](const auto& edge) {
      return edge.second == std::array{std::min(a, b), std::max(a, b)};
    });
  }
  template <class Archive>
  void archive(Archive& archive) {
    std::vector<std::uint32_t> numbers;
    std::vector<std::array<Id, 2>> all;
    for (const auto& [edge, its_ends] : ends) numbers.push_back(edge), all.push_back(its_ends);
    archive(numbers, all);
    ends.clear();
    for (std::size_t i = 0; i < all.size(); ++i) ends[numbers[i]] = all[i];
  }
};

}  // namespace kds::tests
