// You learn: to stand several structures on one, which is kept once; to write one more in a few lines.
// How to run: build/dev/examples/on_one_triangulation
// What you see: 118 flips; another closest pair 7 times, another spanning tree 49 times
#include "certificates/plane_motion.hpp"
#include "kds/framework/kinetic.hpp"
#include "kds/simulator.hpp"
#include "structures/alpha_complex.hpp"
#include "structures/closest_pair.hpp"
#include "structures/gabriel_graph.hpp"
#include "structures/k_nearest.hpp"
#include "structures/nearest_neighbours.hpp"
#include "structures/spanning_tree.hpp"
#include "structures/voronoi_cells.hpp"

#include <array>
#include <cstddef>
#include <iostream>
#include <optional>
#include <span>
#include <vector>

using namespace kds;
using Path = certificates::PlaneMotion<1>;
using Delaunay = structures::DelaunayRule<Path>;

/// How many neighbours each point has in the triangulation: proved by that alone, so it has no certificates of its own.
struct DegreesRule : StandsOn<Delaunay> {
  static constexpr const char* name = "Degrees";
  std::vector<int> degree;

  std::optional<certificates::DistanceOrder<Path>> certificate(Slot, const MovingSet<Path>&) const { return {}; }
  std::array<Id, 0> members(Slot) const { return {}; }
  Effect repair(Slot, Repair<Path>&) { return Effect::internal; }
  Effect follow(std::span<const structures::EdgeChange> changes, Repair<Path>& repair) {
    degree.resize(repair.elements().end_id());
    for (const auto& change : changes) {
      if (change.what == structures::EdgeChange::What::moved) continue;
      for (const Id end : change.ends) degree[end] += change.what == structures::EdgeChange::What::came ? 1 : -1;
    }
    return Effect::external;
  }
};

int main() {
  MovingSet<Path> points;
  for (int i = 0; i < 30; ++i) {  // spread over a square, and on their ways in all directions
    const double x = i * 7 % 30 + 0.25 * (i % 3), y = i * 11 % 30 - 0.125 * (i % 5);
    points.add({{{{{x, (i * 13 % 17 - 8) / 4.0}}, {{y, (i * 5 % 19 - 9) / 4.0}}}}, 0}, 0);
  }
  Kinetic<Delaunay> triangulation(points, 0);
  Kinetic<structures::ClosestPairRule<Path>> closest(triangulation, 0);
  Kinetic<structures::SpanningTreeRule<Path>> tree(triangulation, 0);
  Kinetic<structures::NearestNeighboursRule<Path>> nearest(triangulation, 0);
  Kinetic<structures::GabrielGraphRule<Path>> gabriel(triangulation, 0);
  Kinetic<structures::AlphaComplexRule<Path>> shape(triangulation, 0, structures::AlphaComplexRule<Path>(3));
  Kinetic<structures::VoronoiCellsRule<Path>> cells(triangulation, 0);
  Kinetic<structures::KNearestRule<Path>> three(cells, 0, structures::KNearestRule<Path>(3));  // on what stands on it
  Kinetic<DegreesRule> degrees(triangulation, 0);
  Simulator simulator(0, triangulation, closest, tree, nearest, gabriel, shape, cells, three, degrees);
  simulator.advance_to(4);
  simulator.audit();

  int ends = 0;
  for (const int degree : degrees.rule().degree) ends += degree;
  int mutual = 0;
  for (const kds::Id id : points.ids()) {
    const auto other = nearest.rule().nearest(id);
    mutual += other && nearest.rule().nearest(*other) == id;
  }
  std::cout << triangulation.measures().external << " flips; another closest pair " << closest.measures().external
            << " times, another spanning tree " << tree.measures().external << " times\n"
            << tree.rule().edges().size() << " of " << ends / 2 << " edges are in the tree\n"
            << mutual << " points are the nearest of their nearest\n"
            << gabriel.rule().edges().size() << " edges are in the Gabriel graph, " << shape.rule().border().size()
            << " on the border of the alpha shape of radius 3\n"
            << "the Voronoi cell of point 0 has the corners";
  for (const auto& [x, y] : cells.rule().cell(0, points, 4).vertices) std::cout << " (" << x << ", " << y << ")";
  std::cout << "\nand its three nearest are, in order,";
  for (const kds::Id id : three.rule().nearest(0)) std::cout << " " << id;
  std::cout << "\n";
}
