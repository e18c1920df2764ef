// You learn: to triangulate points of a plane that repeats itself, and what stands on that triangulation.
// How to run: build/dev/examples/periodic_triangulation
// What you see: 1116 flips, always 60 edges; another closest pair 89 times
#include "certificates/plane_motion.hpp"
#include "kds/framework/kinetic.hpp"
#include "kds/simulator.hpp"
#include "structures/closest_pair.hpp"
#include "structures/periodic_delaunay.hpp"
#include "structures/spanning_tree.hpp"

#include <iostream>

using namespace kds;
using Path = certificates::PlaneMotion<1>;
using Delaunay = structures::PeriodicDelaunayRule<Path>;

int main() {
  MovingSet<Path> points;
  for (int i = 0; i < 20; ++i) {  // spread over a rectangle of 6 x 4, and on their ways in all directions
    const double x = i * 7 % 24 / 4.0, y = i * 11 % 16 / 4.0 + 0.125 * (i % 2);
    points.add({{{{{x, (i * 13 % 17 - 8) / 4.0}}, {{y, (i * 5 % 19 - 9) / 4.0}}}}, 0}, 0);
  }
  Kinetic<Delaunay> triangulation(points, 0, Delaunay({6, 4}));
  Kinetic<structures::ClosestPairRule<Path, Delaunay>> closest(triangulation, 0);
  Kinetic<structures::SpanningTreeRule<Path, Delaunay>> tree(triangulation, 0);
  Simulator simulator(0, triangulation, closest, tree);
  simulator.advance_to(10);  // Points leave the rectangle, and need not be brought back.
  simulator.audit();

  const auto& mesh = triangulation.rule().mesh();
  std::cout << triangulation.measures().external << " flips, always " << mesh.end_edge()
            << " edges; another closest pair " << closest.measures().external << " times\n";
  std::cout << "around point 0 at (" << points[0](10)[0] << ", " << points[0](10)[1] << "):\n";
  auto h = mesh.from(0);
  do {  // Where a neighbour is: its point, displaced by the periods that the edge says
    const Id id = mesh.target(h);
    const auto& offset = mesh.offset(h);
    std::cout << "  point " << id << ", its copy at (" << points[id](10)[0] + 6.0 * static_cast<double>(offset.x)
              << ", " << points[id](10)[1] + 4.0 * static_cast<double>(offset.y) << ")\n";
    h = mesh.counter_clockwise(h);
  } while (h != mesh.from(0));
}
