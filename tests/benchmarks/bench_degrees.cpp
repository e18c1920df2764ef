// What an event costs by the degree of the motions: prints how many events there are, and lets callgrind count the
// instructions of them alone:
//
//     valgrind --tool=callgrind --toggle-collect='*take_events*' bench_degrees WHAT DEGREE
//
// WHAT: hull, delaunay, periodic, pair (the closest one, with its triangulation) or gabriel (likewise); DEGREE: 1,
// 2, 3. 100 points with random positions in a unit square, the other coefficients up to 1, for a second.
#include "certificates/plane_motion.hpp"
#include "kds/simulator.hpp"
#include "structures/closest_pair.hpp"
#include "structures/convex_hull.hpp"
#include "structures/gabriel_graph.hpp"
#include "structures/periodic_delaunay.hpp"
#include "tests/support/random_numbers.hpp"

#include <cstddef>
#include <cstdio>
#include <string>

namespace {

using namespace kds;
using kds::tests::Random;

constexpr double end = 1;

template <class AnySimulator>
[[gnu::noinline]] void take_events(AnySimulator& simulator) {
  simulator.advance_to(end);
}

template <class... Structures>
bool measure(Structures&... structures) {
  Simulator simulator(0, structures...);
  (structures.extend_horizon(0, end), ...);
  take_events(simulator);
  std::printf("%llu events\n", static_cast<unsigned long long>(simulator.counters().events));
  return true;
}

template <int Degree>
bool measure(const std::string& what) {
  using Path = certificates::PlaneMotion<Degree>;
  Random random(100);
  MovingSet<Path> set;
  for (Id id = 0; id < 100; ++id) {
    Path path{};
    for (auto& x : path.coordinate) {
      x.c[0] = random.unit();
      for (std::size_t i = 1; i <= Degree; ++i) x.c[i] = random.between(-1, 1);
    }
    set.insert(id, path, 0);
  }
  if (what == "hull") {
    Kinetic<structures::ConvexHullRule<Path>> hull(set, 0);
    return measure(hull);
  }
  if (what == "periodic") {
    Kinetic<structures::PeriodicDelaunayRule<Path>> triangulation(set, 0);
    return measure(triangulation);
  }
  Kinetic<structures::DelaunayRule<Path>> triangulation(set, 0);
  if (what == "delaunay") return measure(triangulation);
  if (what == "pair") {
    Kinetic<structures::ClosestPairRule<Path>> pair(triangulation, 0);
    return measure(triangulation, pair);
  }
  if (what == "gabriel") {
    Kinetic<structures::GabrielGraphRule<Path>> graph(triangulation, 0);
    return measure(triangulation, graph);
  }
  return false;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string what = argc == 3 ? argv[1] : "", degree = argc == 3 ? argv[2] : "";
  const bool done = degree == "1"   ? measure<1>(what)
                    : degree == "2" ? measure<2>(what)
                                    : degree == "3" && measure<3>(what);
  if (!done) std::fprintf(stderr, "usage: bench_degrees hull|delaunay|periodic|pair|gabriel 1|2|3\n");
  return done ? 0 : 1;
}
