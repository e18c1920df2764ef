// The Gabriel graph against exact brute force.
#include "kds/testing/trial.hpp"
#include "structures/gabriel_graph.hpp"
#include "structures/spanning_tree.hpp"
#include "tests/structures/exact_plane.hpp"
#include "tests/structures/random_values.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

namespace test_gabriel_graph {
namespace {

using namespace kds;
using namespace kds::tests;
using certificates::PlaneMotion;
using structures::DelaunayRule;
using structures::EdgeChange;
using structures::GabrielGraphRule;
using testing::Findings;
using testing::TrialOptions;
using testing::try_rule;

/// The pairs of vertices in whose closed disc there is no other vertex: all against all.
template <int Degree>
std::vector<std::array<Id, 2>> graph_of(const DelaunayRule<PlaneMotion<Degree>>& delaunay,
                                        const MovingSet<PlaneMotion<Degree>>& set, double now) {
  std::vector<std::array<Id, 2>> graph;
  if (delaunay.flat()) return graph;
  const ExactPlane plane(set, now);
  std::vector<Id> vertices;
  for (const Id id : plane.ids()) {
    if (delaunay.vertex(id) == id) vertices.push_back(id);
  }
  for (const Id a : vertices) {
    for (const Id b : vertices) {
      const bool empty = std::all_of(vertices.begin(), vertices.end(),
                                     [&](Id c) { return c == a || c == b || plane.outside_disc(a, b, c) > 0; });
      if (a < b && empty) graph.push_back({a, b});
    }
  }
  return graph;
}

template <int Degree>
int check_graph(const GabrielGraphRule<PlaneMotion<Degree>>& rule, const MovingSet<PlaneMotion<Degree>>& set,
                double now) {
  return rule.edges() != graph_of(rule.inner(), set, now);
}

/// Knows of the graph what it has been told.
template <class Path>
struct ToldRule : StandsOn<GabrielGraphRule<Path>> {
  static constexpr const char* name = "Told";
  std::map<std::uint32_t, std::array<Id, 2>> edges;
  int wrong = 0;
  int moved = 0;

  std::optional<certificates::OutsideDisc<Path>> certificate(Slot, const MovingSet<Path>&) const { return {}; }
  std::array<Id, 0> members(Slot) const { return {}; }
  Effect repair(Slot, Repair<Path>&) { return Effect::internal; }
  Effect follow(std::span<const EdgeChange> changes, Repair<Path>&) {
    for (const EdgeChange& change : changes) {
      const auto known = edges.find(change.edge);
      const bool same = known != edges.end() && known->second == change.ends;
      if (change.what == EdgeChange::What::came) {
        wrong += known != edges.end();
        edges[change.edge] = change.ends;
      } else {
        wrong += !same;
        change.what == EdgeChange::What::went ? void(edges.erase(change.edge)) : void(++moved);
      }
    }
    return Effect::external;
  }
  template <class Archive>
  void archive(Archive& archive) {
    std::vector<std::uint32_t> numbers;
    std::vector<std::array<Id, 2>> ends;
    for (const auto& [number, two] : edges) numbers.push_back(number), ends.push_back(two);
    archive(numbers, ends, wrong, moved);
    edges.clear();
    for (std::size_t i = 0; i < numbers.size(); ++i) edges[numbers[i]] = ends[i];
  }
};

template <int Degree>
int check_told(const ToldRule<PlaneMotion<Degree>>& rule, const MovingSet<PlaneMotion<Degree>>& set, double now) {
  int wrong = rule.wrong;
  for (const auto& [number, ends] : rule.edges) wrong += !rule.inner().contains(number);
  for (std::uint32_t edge = 0; edge < rule.inner().end_edge(); ++edge) {
    if (!rule.inner().contains(edge)) continue;
    const auto known = rule.edges.find(edge);
    wrong += known == rule.edges.end() || known->second != rule.inner().ends(edge);
  }
  return wrong + check_graph<Degree>(rule.inner(), set, now);
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("the kinetic Gabriel graph is that of its points, exactly, and so is what it tells",
                       "[gabriel_graph]", ((int Degree), Degree), 1, 2) {
  std::size_t events = 0;
  for (const Kind kind : all_kinds) {
    for (std::uint64_t seed = Degree == 1 ? 640 : 641; seed < (Degree == 1 ? 643u : 642u); ++seed) {
      CAPTURE(Degree, static_cast<int>(kind), seed);
      const TrialOptions options{seed, kind, 6, 2 + 3 * (seed % 3), 9, seed % 2 == 0 ? never : 0.4, 4};
      const Findings found = try_rule(options, ToldRule<PlaneMotion<Degree>>{}, random_plane_motion<Degree>,
                                      check_told<Degree>);
      CHECK(found.first == "");
      events += found.events.size();
    }
  }
  CHECK(events > 200);
}

TEST_CASE("points on the border of a disc are in it, and points in one place count as one", "[gabriel_graph]") {
  MovingSet<PlaneMotion<1>> set;
  const auto at = [](double x, double y) { return PlaneMotion<1>{{{{{x, 0}}, {{y, 0}}}}, 0}; };
  Kinetic<DelaunayRule<PlaneMotion<1>>> triangulation(set, 0);
  Kinetic<GabrielGraphRule<PlaneMotion<1>>> graph(triangulation, 0);
  Kinetic<ToldRule<PlaneMotion<1>>> told(graph, 0);
  const auto right = [&] { return check_told<1>(told.rule(), set, 0) == 0; };
  using Edges = std::vector<std::array<Id, 2>>;
  set.insert(0, at(0, 0), 0);
  set.insert(1, at(4, 0), 0);
  set.insert(2, at(8, 0), 0);
  CHECK(graph.rule().edges().empty());  // all on one line
  set.insert(3, at(4, 3), 0);
  CHECK(graph.rule().edges() == Edges{{0, 1}, {1, 2}, {1, 3}});
  set.insert(4, at(0, 3), 0);  // a rectangle: neither diagonal is in the graph, whichever the triangulation has
  CHECK(graph.rule().edges() == Edges{{0, 1}, {0, 4}, {1, 2}, {1, 3}, {3, 4}});
  CHECK(right());
  set.insert(5, at(4, 0), 0);  // in the place of 1
  CHECK(graph.rule().edges() == Edges{{0, 1}, {0, 4}, {1, 2}, {1, 3}, {3, 4}});
  CHECK(right());
  set.remove(1, 0);
  CHECK(graph.rule().edges() == Edges{{0, 4}, {0, 5}, {2, 5}, {3, 4}, {3, 5}});
  CHECK(right());
  set.update(4, at(0, 3.5), 0);  // the triangles stay
  CHECK(told.rule().moved > 0);
  CHECK(graph.rule().edges() == Edges{{0, 4}, {0, 5}, {2, 5}, {3, 4}, {3, 5}});
  CHECK(right());
  graph.audit(0);
}

TEST_CASE("a listener that hears of a Gabriel edge may remove its end and insert another", "[gabriel_graph]") {
  const std::uint64_t seed = 645;
  CAPTURE(seed);
  Random random(seed);
  MovingSet<PlaneMotion<1>> set;
  for (Id id = 0; id < 10; ++id) set.insert(id, random_plane_motion<1>(random, Kind::lattice, 0), 0);
  Kinetic<DelaunayRule<PlaneMotion<1>>> triangulation(set, 0);
  int edits = 0;
  double done = 0;
  const auto edit = [&](const GabrielGraphRule<PlaneMotion<1>>& rule, const KineticEvent& event) {
    if (event.effect == Effect::internal || event.time == done || edits == 20) return;
    done = event.time;
    ++edits;
    set.remove(rule.edges().front()[0], event.time);
    set.insert(set.free_id(), random_plane_motion<1>(random, Kind::lattice, event.time), event.time);
  };
  Kinetic<GabrielGraphRule<PlaneMotion<1>>, decltype(edit)> graph(triangulation, 0, {}, edit);
  Kinetic<ToldRule<PlaneMotion<1>>> told(graph, 0);
  Simulator simulator(0, triangulation, graph, told);
  int wrong = 0;
  while (simulator.step(4)) {
    simulator.audit();
    if (simulator.next_time() > simulator.now()) wrong += check_told<1>(told.rule(), set, simulator.now());
  }
  CHECK(wrong == 0);
  CHECK(edits == 20);
}

TEST_CASE("a Gabriel graph keeps to its measures, and contains the spanning tree", "[gabriel_graph]") {
  const std::uint64_t seed = 646, n = 40;
  CAPTURE(seed);
  Random random(seed);
  MovingSet<PlaneMotion<1>> set;
  for (Id id = 0; id < n; ++id) set.insert(id, random_plane_motion<1>(random, Kind::generic, 0), 0);
  Kinetic<DelaunayRule<PlaneMotion<1>>> triangulation(set, 0);
  Kinetic<GabrielGraphRule<PlaneMotion<1>>> graph(triangulation, 0);
  Kinetic<structures::SpanningTreeRule<PlaneMotion<1>>> tree(triangulation, 0);
  Simulator simulator(0, triangulation, graph, tree);
  simulator.advance_to(1);
  simulator.audit();
  for (const auto& edge : tree.rule().edges()) {
    const auto edges = graph.rule().edges();
    CHECK(std::binary_search(edges.begin(), edges.end(), edge));
  }
  const Measures m = graph.measures();
  CHECK(check_graph<1>(graph.rule(), set, 1) == 0);
  CHECK(m.events > 30);
  CHECK(m.external == m.events);  // efficient; no flip changes the graph
  CHECK(m.most_held < 6 * n);     // compact
  CHECK(m.most_touched <= 12);    // responsive
}

}  // namespace test_gabriel_graph
