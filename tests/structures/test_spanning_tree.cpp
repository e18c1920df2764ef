// The spanning tree against exact brute force.
#include "kds/testing/trial.hpp"
#include "structures/spanning_tree.hpp"
#include "tests/structures/exact_plane.hpp"
#include "tests/structures/random_values.hpp"
#include "tests/structures/told_edges.hpp"
#include "tests/structures/tree_paths.hpp"

#include <catch2/catch.hpp>

#include <map>
#include <span>
#include <vector>

namespace test_spanning_tree {
namespace {

using namespace kds;
using namespace kds::tests;
using certificates::PlaneMotion;
using structures::DelaunayRule;
using structures::SpanningTreeRule;
using testing::Findings;
using testing::TrialOptions;
using testing::try_rule;

/// A tree that joins all points, in which no edge of a path is longer than the distance of the path's ends.
template <int Degree>
int check_tree(const SpanningTreeRule<PlaneMotion<Degree>>& rule, const MovingSet<PlaneMotion<Degree>>& set,
               double now) {
  const ExactPlane plane(set, now);
  std::vector<Id> vertices;
  for (const Id id : plane.ids()) {
    if (rule.inner().vertex(id) == id) vertices.push_back(id);
  }
  const auto edges = rule.edges();
  if (rule.inner().flat()) return !edges.empty();
  if (edges.size() + 1 != vertices.size()) return 1;
  return tests::wrong_paths(edges, vertices,
                            [&](Id a, Id b, Id c, Id d) { return plane.compare_distances(a, b, c, d) > 0; });
}

/// The tree by what it tells.
struct ToldRule : StandsOn<SpanningTreeRule<PlaneMotion<1>>>, Quiet<PlaneMotion<1>> {
  static constexpr const char* name = "Told";
  EdgesTold edges{};

  Effect repair(Slot, Repair<PlaneMotion<1>>&) { return Effect::internal; }
  Effect follow(std::span<const structures::EdgeChange> changes, Repair<PlaneMotion<1>>&) {
    for (const auto& change : changes) edges.take(change);
    return Effect::external;
  }
  template <class Archive>
  void archive(Archive& archive) {
    archive(edges);
  }
};

}  // namespace

TEST_CASE("a spanning tree tells which of its edges come and go", "[spanning_tree]") {
  for (const Kind kind : all_kinds) {
    const std::uint64_t seed = 605;
    CAPTURE(static_cast<int>(kind), seed);
    const auto check = [](const ToldRule& rule, const auto&, double) {
      int wrong = rule.edges.ends.size() != rule.inner().edges().size();
      for (const auto& [edge, ends] : rule.edges.ends) {
        wrong += !rule.inner().contains(edge) || rule.inner().ids(edge) != ends;
      }
      return wrong;
    };
    CHECK(try_rule({seed, kind, 12, 6, 9}, ToldRule{}, random_plane_motion<1>, check).first == "");
  }
}

TEMPLATE_TEST_CASE_SIG("the kinetic spanning tree is a shortest one, exactly", "[spanning_tree]",
                       ((int Degree), Degree), 1, 2) {
  std::size_t events = 0;
  for (const Kind kind : all_kinds) {
    for (std::uint64_t seed = Degree == 1 ? 600 : 601; seed < (Degree == 1 ? 603u : 602u); ++seed) {
      CAPTURE(Degree, static_cast<int>(kind), seed);
      const TrialOptions options{seed, kind, 6, 2 + 3 * (seed % 3), 9, seed % 2 == 0 ? never : 0.4, 16};
      const Findings found =
          try_rule(options, SpanningTreeRule<PlaneMotion<Degree>>{}, random_plane_motion<Degree>, check_tree<Degree>);
      CHECK(found.first == "");
      events += found.events.size();
    }
  }
  CHECK(events > 200);
}

TEST_CASE("a spanning tree keeps to its measures", "[spanning_tree]") {
  const std::uint64_t seed = 610, n = 40;
  CAPTURE(seed);
  Random random(seed);
  MovingSet<PlaneMotion<1>> set;
  for (Id id = 0; id < n; ++id) set.insert(id, random_plane_motion<1>(random, Kind::generic, 0), 0);
  Kinetic<DelaunayRule<PlaneMotion<1>>> triangulation(set, 0);
  Kinetic<SpanningTreeRule<PlaneMotion<1>>> tree(triangulation, 0);
  Simulator simulator(0, triangulation, tree);
  simulator.advance_to(1);
  simulator.audit();
  const Measures m = tree.measures();
  CHECK(check_tree(tree.rule(), set, 1) == 0);
  CHECK(m.external > 10);
  CHECK(m.external < m.events / 2);
  CHECK(m.most_held <= 3 * n);  // compact
  CHECK(m.most_touched <= 6);   // responsive: an edge comes and one goes
}

}  // namespace test_spanning_tree
