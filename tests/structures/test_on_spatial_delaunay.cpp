// Rules about edges on a Delaunay triangulation in space, and what that tells them, against exact brute force.
#include "kds/testing/trial.hpp"
#include "structures/closest_pair.hpp"
#include "structures/nearest_neighbours.hpp"
#include "structures/spanning_tree.hpp"
#include "structures/spatial_triangulation.hpp"
#include "tests/structures/random_values.hpp"
#include "tests/structures/tree_paths.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <stdexcept>
#include <variant>
#include <vector>

namespace test_on_spatial_delaunay {
namespace {

using namespace kds;
using namespace kds::tests;
using structures::ClosestPairRule;
using structures::EdgeChange;
using structures::NearestNeighboursRule;
using structures::SpanningTreeRule;
using structures::SpatialDelaunayRule;
using structures::TetrahedronChange;
using structures::TetrahedronMesh;

using Path = certificates::PointMotion<1>;
using Delaunay = SpatialDelaunayRule<Path>;

/// |c - d|^2 - |a - b|^2, by itself.
struct Farther {
  static constexpr int degree = 2;
  const Path &a, &b, &c, &d;
  template <class Number>
  auto polynomial(double epoch) const {
    const auto part = [&](int axis) {
      const auto far = about<Number>(d.axis(axis), epoch) - about<Number>(c.axis(axis), epoch);
      const auto near = about<Number>(b.axis(axis), epoch) - about<Number>(a.axis(axis), epoch);
      return far * far - near * near;
    };
    return part(0) + part(1) + part(2);
  }
};
/// Whether c and d are farther from each other than a and b: 1, 0 or -1.
int compare(const MovingSet<Path>& set, double now, Id a, Id b, Id c, Id d) {
  if (std::minmax(a, b) == std::minmax(c, d)) return 0;
  return sign_after(Farther{set[a], set[b], set[c], set[d]}, now);
}

std::vector<Id> vertices_of(const Delaunay& delaunay, const MovingSet<Path>& set) {
  std::vector<Id> vertices = set.ids();
  std::erase_if(vertices, [&](Id id) { return delaunay.vertex(id) != id; });
  return vertices;
}

/// A tree that joins all points, in which no edge of a path is longer than the distance of the path's ends.
int check_tree(const SpanningTreeRule<Path, Delaunay>& rule, const MovingSet<Path>& set, double now) {
  const auto edges = rule.edges();
  if (rule.inner().flat()) return !edges.empty();
  const std::vector<Id> vertices = vertices_of(rule.inner(), set);
  if (edges.size() + 1 != vertices.size()) return 1;
  return tests::wrong_paths(edges, vertices, [&](Id a, Id b, Id c, Id d) { return compare(set, now, c, d, a, b) > 0; });
}

int check_pair(const ClosestPairRule<Path, Delaunay>& rule, const MovingSet<Path>& set, double now) {
  if (rule.inner().flat()) return 0;
  if (!rule.pair()) return 1;
  int wrong = 0;
  const std::vector<Id> ids = set.ids();
  for (const Id a : ids) {
    for (const Id b : ids) wrong += a < b && compare(set, now, a, b, (*rule.pair())[0], (*rule.pair())[1]) > 0;
  }
  return wrong;
}

int check_nearest(const NearestNeighboursRule<Path, Delaunay>& rule, const MovingSet<Path>& set, double now) {
  int wrong = 0;
  for (const Id id : set.ids()) {
    const auto nearest = rule.nearest(id);
    if (rule.inner().flat()) continue;
    for (const Id other : set.ids())
      wrong += other != id && (!nearest || compare(set, now, id, other, id, *nearest) > 0);
  }
  return wrong;
}

/// Edges and tetrahedra by what has been told alone.
struct ToldRule : StandsOn<Delaunay, Telling<Delaunay, TetrahedronChange>> {
  static constexpr const char* name = "Told";
  std::map<std::uint32_t, std::array<Id, 2>> edges{};
  std::map<std::uint32_t, TetrahedronMesh::Corners> tetrahedra{};
  std::uint32_t moved = 0;

  std::monostate certificate(Slot, const MovingSet<Path>&) const { return {}; }
  std::array<Id, 0> members(Slot) const { return {}; }
  Effect repair(Slot, Repair<Path>&) { return Effect::internal; }
  Effect follow(From<0>, std::span<const EdgeChange> changes, Repair<Path>&) {
    for (const EdgeChange& change : changes) {
      const auto known = edges.find(change.edge);
      if ((change.what == EdgeChange::What::came) != (known == edges.end()))
        throw std::logic_error("comes, or goes, twice");
      if (known != edges.end() && known->second != change.ends) throw std::logic_error("an edge with other ends");
      if (change.what == EdgeChange::What::came) edges[change.edge] = change.ends;
      if (change.what == EdgeChange::What::went) edges.erase(known);
      moved += change.what == EdgeChange::What::moved;
    }
    return Effect::external;
  }
  Effect follow(From<1>, std::span<const TetrahedronChange> changes, Repair<Path>&) {
    const auto& mesh = inner().mesh();
    for (const auto& [t] : changes) {
      tetrahedra.erase(t);
      if (t < mesh.end_tetrahedron() && mesh.in_use(t)) tetrahedra[t] = mesh.corners(t);
    }
    return Effect::external;
  }
  template <class Archive>
  void archive(Archive& archive) {
    std::vector<std::uint32_t> numbers, places;
    std::vector<std::array<Id, 2>> ends;
    std::vector<TetrahedronMesh::Corners> corners;
    for (const auto& [edge, its] : edges) numbers.push_back(edge), ends.push_back(its);
    for (const auto& [t, its] : tetrahedra) places.push_back(t), corners.push_back(its);
    archive(numbers, ends, places, corners, moved);
    edges.clear(), tetrahedra.clear();
    for (std::size_t i = 0; i < numbers.size(); ++i) edges[numbers[i]] = ends[i];
    for (std::size_t i = 0; i < places.size(); ++i) tetrahedra[places[i]] = corners[i];
  }
};

int check_told(const ToldRule& rule, const MovingSet<Path>& /*set*/, double /*now*/) {
  const auto& mesh = rule.inner().mesh();
  std::set<std::array<Id, 2>> edges, told;
  std::size_t there = 0;
  int wrong = 0;
  for (std::uint32_t t = 0; t < mesh.end_tetrahedron(); ++t) {
    if (!mesh.in_use(t)) continue;
    ++there;
    const auto known = rule.tetrahedra.find(t);
    wrong += known == rule.tetrahedra.end() || known->second != mesh.corners(t);
    for (const Id a : mesh.corners(t)) {
      for (const Id b : mesh.corners(t)) {
        if (a < b && b != TetrahedronMesh::infinite) edges.insert({a, b});
      }
    }
  }
  for (const auto& [edge, ends] : rule.edges) told.insert(ends);
  return wrong + (there != rule.tetrahedra.size()) + (edges != told) + (told.size() != rule.edges.size());
}

/// The number of events. Kinds in which many points are in one plane or place are among them.
template <class Rule, class Check>
std::size_t trials(const Check& check, std::uint64_t seed) {
  std::size_t events = 0;
  for (const Kind kind : {Kind::generic, Kind::lattice, Kind::resting, Kind::coarse}) {
    CAPTURE(Rule::name, static_cast<int>(kind), seed);
    const testing::TrialOptions options{seed, kind, 8, 6, 10, seed % 2 == 0 ? never : 0.4, 8};
    const auto found = testing::try_rule(options, Rule{}, random_point_motion<1>, check);
    CHECK(found.first == "");
    events += found.events.size();
    ++seed;
  }
  return events;
}

}  // namespace

TEST_CASE("a triangulation in space tells which edges and tetrahedra come and go", "[spatial_triangulation]") {
  CHECK(trials<ToldRule>(check_told, 820) > 50);
}

TEST_CASE("a spanning tree of points in space stands on their triangulation", "[spatial_triangulation]") {
  CHECK(trials<SpanningTreeRule<Path, Delaunay>>(check_tree, 830) > 50);
}

TEST_CASE("a closest pair and nearest neighbours in space", "[spatial_triangulation]") {
  CHECK(trials<ClosestPairRule<Path, Delaunay>>(check_pair, 840) > 50);
  CHECK(trials<NearestNeighboursRule<Path, Delaunay>>(check_nearest, 850) > 50);
}

}  // namespace test_on_spatial_delaunay
