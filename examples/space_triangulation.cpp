// You learn: to keep triangulations of points in space, of which one has weights and hides points.
// How to run: build/dev/examples/space_triangulation
// What you see: each was compared with one that was built anew, and was the same
#include "certificates/weighted_point.hpp"
#include "kds/framework/kinetic.hpp"
#include "kds/simulator.hpp"
#include "structures/spatial_triangulation.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <iostream>
#include <set>
#include <stdexcept>

using namespace kds;
using Weighted = certificates::WeightedPoint<1>;  // a path, and the square of a radius as its weight
using Point = certificates::PointMotion<1>;

/// The tetrahedra as sets of corners.
template <class Rule>
std::set<std::array<Id, 4>> tetrahedra(const Rule& rule) {
  std::set<std::array<Id, 4>> result;
  for (std::uint32_t t = 0; t < rule.mesh().end_tetrahedron(); ++t) {
    if (!rule.mesh().in_use(t)) continue;
    auto corners = rule.mesh().corners(t);
    std::sort(corners.begin(), corners.end());
    result.insert(corners);
  }
  return result;
}

/// Runs a structure for a second. The triangulation is unique, so another one that is built at the end is the same.
template <class Rule, class Element>
void run(const char* what, MovingSet<Element>& elements) {
  Kinetic<Rule> structure(elements, 0);
  Simulator simulator(0, structure);
  simulator.advance_to(1);
  const Kinetic<Rule> anew(elements, 1);
  if (tetrahedra(structure.rule()) != tetrahedra(anew.rule())) throw std::logic_error("the triangulation is another");
  const Measures measures = structure.measures();
  std::cout << what << ": " << measures.events << " events, " << tetrahedra(structure.rule()).size() << " tetrahedra, "
            << structure.rule().hull().size() << " facets of the hull, " << structure.rule().hidden().size()
            << " hidden points\n";
}

int main() {
  // Points of a cubic lattice, where everything is degenerate: eight on a sphere, squares in planes. Half of the layers
  // slide, so that many events come at one time.
  MovingSet<Point> lattice;
  // Balls of different sizes that drift; some lie within what others cover, and are hidden.
  MovingSet<Weighted> balls;
  std::uint32_t dice = 1;
  const auto random = [&dice] {
    dice = dice * 1664525u + 1013904223u;
    return dice * 0x1p-32;
  };
  for (int i = 0; i < 64; ++i) {
    const Eigen::Vector3d place(i % 4, i / 4 % 4, i / 16);
    lattice.add(Point::line(place, Eigen::Vector3d(i / 16 % 2, 0, 0)), 0);
    const Eigen::Vector3d start(random(), random(), random()), velocity(random(), random(), random());
    const double radius = 0.4 * random();
    balls.add({Point::line(start, velocity), {{radius * radius}}}, 0);
  }
  run<structures::SpatialDelaunayRule<Point>>("Delaunay triangulation of a lattice", lattice);
  run<structures::RegularTriangulationRule<Weighted>>("regular triangulation of balls", balls);
  std::cout << "each was compared with one that was built anew, and was the same\n";
}
