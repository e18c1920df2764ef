// Triangulations against exact brute force, for the tests of Delaunay triangulation and convex hull.
#pragma once

#include "certificates/plane_motion.hpp"
#include "kds/simulator.hpp"
#include "structures/convex_hull.hpp"
#include "structures/delaunay.hpp"
#include "tests/structures/exact_plane.hpp"

#include <cstdint>
#include <vector>

namespace kds::tests {

using Delaunay1 = Kinetic<structures::DelaunayRule<certificates::PlaneMotion<1>>>;
using Hull1 = Kinetic<structures::ConvexHullRule<certificates::PlaneMotion<1>>>;

/// Every triangle turns left, every edge of the hull has all points on its left, no point is inside a circle; and there
/// are as many triangles as the vertices must have.
template <int Degree, structures::Criterion What>
int check_triangulation(const structures::PlaneTriangulationRule<certificates::PlaneMotion<Degree>, What>& rule,
                        const MovingSet<certificates::PlaneMotion<Degree>>& set, double now) {
  const ExactPlane plane(set, now);
  const auto ids = plane.ids();
  const structures::TriangleMesh& mesh = rule.mesh();
  int wrong = 0;
  if (rule.flat()) {
    for (const Id a : ids) {
      for (const Id b : ids) {
        for (const Id c : ids) wrong += a < b && b < c && plane.orientation(a, b, c) != 0;
      }
    }
    return wrong;
  }
  std::size_t vertices = 0, triangles = 0;
  for (const Id id : ids) {
    vertices += mesh.contains(id);
    wrong += rule.vertex(id) != id && !plane.same(id, rule.vertex(id));
    wrong += mesh.contains(id) != (rule.vertex(id) == id);
  }
  const std::vector<Id> hull = rule.hull();
  for (std::uint32_t t = 0; t < mesh.end_triangle(); ++t) {
    if (!mesh.in_use(t) || !mesh.finite(t)) continue;
    ++triangles;
    const Id a = mesh.origin(3 * t), b = mesh.origin(3 * t + 1), c = mesh.origin(3 * t + 2);
    wrong += plane.orientation(a, b, c) <= 0;
    if (What != structures::Criterion::delaunay) continue;
    for (const Id d : ids) wrong += d != a && d != b && d != c && plane.inside(a, b, c, d) > 0;
  }
  wrong += triangles != 2 * vertices - 2 - hull.size();
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Id a = hull[i], b = hull[(i + 1) % hull.size()];
    for (const Id c : ids) wrong += plane.orientation(a, b, c) < 0;
  }
  return wrong;
}

inline certificates::PlaneMotion<1> line(double x, double y, double speed_x = 0, double speed_y = 0, double start = 0) {
  return {{{{{x, speed_x}}, {{y, speed_y}}}}, start};
}

/// Runs to the end with an audit at every event; the number of things that are wrong between events.
template <class Structure, class Set>
int run_out(Structure& structure, Set& set, double now, double end) {
  Simulator simulator(now, structure);
  int wrong = 0;
  std::uint64_t events = 0;
  while (simulator.step(end)) {
    simulator.audit();
    if (simulator.next_time() > simulator.now()) wrong += check_triangulation(structure.rule(), set, simulator.now());
    if (++events > 20000) return -1;
  }
  simulator.advance_to(end);
  simulator.audit();
  return wrong + check_triangulation(structure.rule(), set, end);
}

}  // namespace kds::tests
