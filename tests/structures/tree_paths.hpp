// What a minimum spanning tree is by its paths.
#pragma once

#include "kds/framework/moving_set.hpp"

#include <array>
#include <map>
#include <vector>

namespace kds::tests {

/// How many paths of the tree contradict that it is minimum: a path without an end, or with an edge longer than the
/// distance of its ends. `edges` are pairs of ids; longer(a, b, c, d): whether a and b are farther from each other than
/// c and d.
template <class Edges, class Longer>
int wrong_paths(const Edges& edges, const std::vector<Id>& vertices, const Longer& longer) {
  int wrong = 0;
  std::map<Id, std::vector<Id>> neighbours;
  for (const auto& [a, b] : edges) neighbours[a].push_back(b), neighbours[b].push_back(a);
  for (const Id from : vertices) {
    std::map<Id, std::array<Id, 2>> longest{{from, {from, from}}};  // of the edges on the path there
    std::vector<Id> open{from};
    while (!open.empty()) {
      const Id at = open.back();
      open.pop_back();
      for (const Id to : neighbours[at]) {
        if (longest.contains(to)) continue;
        const auto [a, b] = longest[at];
        longest[to] = a == b || longer(at, to, a, b) ? std::array{at, to} : std::array{a, b};
        wrong += longer(longest[to][0], longest[to][1], from, to);
        open.push_back(to);
      }
    }
    wrong += longest.size() != vertices.size();
  }
  return wrong;
}

}  // namespace kds::tests
