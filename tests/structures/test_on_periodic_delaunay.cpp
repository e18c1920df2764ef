// Structures that stand on a periodic triangulation, against exact brute force over copies of the points.
#include "kds/testing/trial.hpp"
#include "structures/closest_pair.hpp"
#include "structures/nearest_neighbours.hpp"
#include "structures/periodic_delaunay.hpp"
#include "structures/spanning_tree.hpp"
#include "tests/structures/exact_torus.hpp"
#include "tests/structures/periodic_motion.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace test_on_periodic_delaunay {
namespace {

using namespace kds;
using namespace kds::tests;
using Path = certificates::PlaneMotion<1>;
using Delaunay = structures::PeriodicDelaunayRule<Path>;
using ClosestPair = structures::ClosestPairRule<Path, Delaunay>;
using NearestNeighbours = structures::NearestNeighboursRule<Path, Delaunay>;
using SpanningTree = structures::SpanningTreeRule<Path, Delaunay>;
using testing::Findings;
using testing::TrialOptions;
using testing::try_rule;

/// Distances of points, each to the nearest copy of the other.
class Distances {
 public:
  Distances(const MovingSet<Path>& set, const Delaunay& delaunay, double now)
      : torus_(set, delaunay.periods(), now), ids_(torus_.ids()) {}

  const std::vector<Id>& ids() const { return ids_; }
  /// Sign of |a - b| - |c - d|.
  int compare(Id a, Id b, Id c, Id d) const {
    return torus_.compare_distances(near(a, b), {b, 0, 0}, near(c, d), {d, 0, 0});
  }

 private:
  const ExactTorus::Copy& near(Id a, Id b) const {
    auto found = nearest_.find({a, b});
    if (found == nearest_.end()) found = nearest_.emplace(std::pair{a, b}, torus_.nearest_copy(a, b)).first;
    return found->second;
  }

  ExactTorus torus_;
  std::vector<Id> ids_;
  mutable std::map<std::pair<Id, Id>, ExactTorus::Copy> nearest_;
};

int check_pair(const ClosestPair& rule, const MovingSet<Path>& set, double now) {
  const Distances distances(set, rule.delaunay(), now);
  if (!rule.pair()) return set.size() > 1;
  const auto [a, b] = *rule.pair();
  int wrong = a >= b || !set.contains(a) || !set.contains(b);
  for (const Id c : distances.ids()) {
    for (const Id d : distances.ids()) wrong += c < d && distances.compare(a, b, c, d) > 0;
  }
  return wrong;
}

int check_nearest(const NearestNeighbours& rule, const MovingSet<Path>& set, double now) {
  const Distances distances(set, rule.inner(), now);
  int wrong = 0;
  for (const Id id : distances.ids()) {
    const std::optional<Id> nearest = rule.nearest(id);
    wrong += !nearest && set.size() > 1;
    if (!nearest) continue;
    wrong += *nearest == id || !set.contains(*nearest);
    for (const Id other : distances.ids()) {
      wrong += other != id && distances.compare(id, *nearest, id, other) > 0;
    }
  }
  return wrong;
}

/// A tree that joins all vertices, in which no edge of a path is longer than the distance of the path's ends.
int check_tree(const SpanningTree& rule, const MovingSet<Path>& set, double now) {
  const Distances distances(set, rule.inner(), now);
  std::map<Id, std::vector<Id>> neighbours;
  for (const Id id : distances.ids()) {
    if (rule.inner().vertex(id) == id) neighbours[id];
  }
  const auto edges = rule.edges();
  if (edges.size() + (neighbours.empty() ? 0 : 1) != neighbours.size()) return 1;
  for (const auto& [a, b] : edges) neighbours[a].push_back(b), neighbours[b].push_back(a);
  int wrong = 0;
  for (const auto& [from, unused] : neighbours) {
    std::vector<std::vector<Id>> paths{{from}};
    std::size_t reached = 0;
    for (; reached < paths.size(); ++reached) {
      const std::vector<Id> path = paths[reached];
      for (std::size_t i = 1; i < path.size(); ++i) {
        wrong += distances.compare(path[i - 1], path[i], from, path.back()) > 0;
      }
      for (const Id next : neighbours[path.back()]) {
        if (path.size() > 1 && next == path[path.size() - 2]) continue;
        paths.push_back(path);
        paths.back().push_back(next);
      }
      if (paths.size() > neighbours.size()) return wrong + 1;
    }
    wrong += reached != neighbours.size();
  }
  return wrong;
}

/// Runs trials of a rule, on periods of 1.
template <class Rule, class Check>
void try_on_periodic(std::uint64_t first_seed, const Check& check) {
  std::size_t events = 0;
  for (const Kind kind : all_kinds) {
    for (std::uint64_t seed = first_seed; seed < first_seed + 2; ++seed) {
      CAPTURE(static_cast<int>(kind), seed);
      const TrialOptions options{seed, kind, 6, 3 * (seed % 3), 8, seed % 2 == 0 ? never : 0.4, 16};
      const Findings found = try_rule(options, Rule{}, random_periodic_motion, check);
      CHECK(found.first == "");
      events += found.events.size();
    }
  }
  CHECK(events > 200);
}

}  // namespace

TEST_CASE("the closest pair of a periodic triangulation", "[periodic_delaunay][closest_pair]") {
  try_on_periodic<ClosestPair>(1300, check_pair);
}

TEST_CASE("nearest neighbours of a periodic triangulation", "[periodic_delaunay][nearest_neighbours]") {
  try_on_periodic<NearestNeighbours>(1310, check_nearest);
}

TEST_CASE("the spanning tree of a periodic triangulation", "[periodic_delaunay][spanning_tree]") {
  try_on_periodic<SpanningTree>(1320, check_tree);
}

TEST_CASE("an edge from a point to its own copy joins no two", "[periodic_delaunay][degeneracy]") {
  MovingSet<Path> set;
  Kinetic<Delaunay> triangulation(set, 0, Delaunay({1, 100}));  // Own copies are the nearest ones.
  Kinetic<ClosestPair> closest(triangulation, 0);
  Kinetic<NearestNeighbours> nearest(triangulation, 0);
  Kinetic<SpanningTree> tree(triangulation, 0);
  const auto at = [](double x, double y) { return Path{{{{{x, 0}}, {{y, 0}}}}, 0}; };
  set.insert(4, at(0, 0), 0);
  CHECK_FALSE(closest.rule().pair());
  CHECK_FALSE(nearest.rule().nearest(4));
  CHECK(tree.rule().edges().empty());
  set.insert(1, at(0.5, 30), 0);
  set.insert(7, at(0.25, 90), 0);  // 10 from the copy above of the first
  CHECK(closest.rule().pair() == std::array<Id, 2>{4, 7});
  CHECK(nearest.rule().nearest(1) == Id{4});
  CHECK(nearest.rule().nearest(4) == Id{7});
  CHECK(tree.rule().edges() == std::vector<std::array<Id, 2>>{{4, 7}, {1, 4}});
  set.insert(9, at(-3.5, 730), 0);  // in one place with the second, up to periods
  CHECK(closest.rule().pair() == std::array<Id, 2>{1, 9});
  closest.audit(0), nearest.audit(0), tree.audit(0);
}

}  // namespace test_on_periodic_delaunay
