// What the framework costs, and what its structures do: CSV.
//
// First the sorted list of the framework (examples/list_in_forty_lines.hpp) against the tuned one
// (structures/sorted_list.hpp) on the same values: CPU time a swap as a ratio, the two run in turn, median of ROUNDS
// (the first argument, 9). Then insertions of ends that grow, and points in rectangles against lists that a range
// tree would have. Then each structure of the family on n points with random positions in a unit square and speeds
// up to 1, run for a while: events, the four measures, and CPU time an event as a ratio to that of a swap of the
// tuned list of as many values.
#include "certificates/plane_motion.hpp"
#include "examples/list_in_forty_lines.hpp"
#include "kds/framework/kinetic.hpp"
#include "kds/simulator.hpp"
#include "structures/aabb_tree.hpp"
#include "structures/alpha_complex.hpp"
#include "structures/closest_pair.hpp"
#include "structures/convex_hull.hpp"
#include "structures/delaunay.hpp"
#include "structures/extents.hpp"
#include "structures/gabriel_graph.hpp"
#include "structures/growing_segments.hpp"
#include "structures/heap.hpp"
#include "structures/k_nearest.hpp"
#include "structures/periodic_delaunay.hpp"
#include "structures/points_inside.hpp"
#include "structures/sorted_list.hpp"
#include "structures/spatial_triangulation.hpp"
#include "structures/tournament.hpp"
#include "tests/benchmarks/thread_time.hpp"
#include "tests/support/random_numbers.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <utility>
#include <vector>

namespace {

using namespace kds;
using kds::benchmarks::thread_seconds;
using kds::tests::Random;

template <int Degree>
Motion<Degree> random_value(Random& random) {
  Motion<Degree> motion;
  motion.position.c[0] = random.unit();
  for (std::size_t i = 1; i <= Degree; ++i) motion.position.c[i] = random.between(-1, 1);
  return motion;
}

template <int Degree>
certificates::PlaneMotion<Degree> random_path(Random& random) {
  const auto x = random_value<Degree>(random);
  const auto y = random_value<Degree>(random);
  return {{x.position, y.position}, 0};
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

struct Cost {
  double seconds;
  std::uint64_t events;
  double per_event() const { return seconds / static_cast<double>(events); }
};

template <class... Structures>
Cost run(double end, Structures&... structures) {
  Simulator simulator(0, structures...);
  const double start = thread_seconds();
  simulator.advance_to(end);
  return {thread_seconds() - start, simulator.counters().events};
}

/// Until about 20 n swaps have been made, but at most for a second.
double duration(Id n) { return std::min(1.0, 100.0 / n); }

template <int Degree>
Cost tuned_list(Id n, double end) {
  Random random(n);
  std::vector<typename structures::SortedList<Degree>::Entry> entries;
  for (Id id = 0; id < n; ++id) entries.push_back({random_value<Degree>(random), id});
  structures::SortedList<Degree> list;
  Simulator simulator(0, list);
  simulator.set_window(end);
  list.assign(entries, 0);
  const double start = thread_seconds();
  simulator.advance_to(end);
  return {thread_seconds() - start, list.counters().events};
}

template <int Degree>
Cost framework_list(Id n, double end) {
  Random random(n);
  MovingSet<Motion<Degree>> set;
  for (Id id = 0; id < n; ++id) set.insert(id, random_value<Degree>(random), 0);
  Kinetic<examples::ListRule<Motion<Degree>>> list(set, 0);
  list.extend_horizon(0, end);
  return run(end, list);
}

template <int Degree>
void compare_lists(Id n, int rounds) {
  const double end = duration(n);
  std::vector<double> ratios;
  std::uint64_t events = 0;
  for (int round = 0; round < rounds; ++round) {
    const Cost tuned = tuned_list<Degree>(n, end);
    const Cost framework = framework_list<Degree>(n, end);
    if (tuned.events != framework.events) std::abort();
    events = tuned.events;
    ratios.push_back(framework.seconds / tuned.seconds);
  }
  std::printf("list of the framework / tuned list,%d,%u,%llu,%.2f\n", Degree, n,
              static_cast<unsigned long long>(events), median(ratios));
}

/// What `run_once` costs, which runs a structure of n elements and returns {Cost, Measures}, against swaps of a tuned
/// list.
template <class Run>
void measure(const char* name, int degree, Id n, int rounds, Run&& run_once) {
  std::vector<double> ratios;
  Measures m;
  for (int round = 0; round < rounds; ++round) {
    const auto [cost, measures] = run_once();
    const Cost swaps = tuned_list<1>(n, duration(n));
    if (cost.events > 0) ratios.push_back(cost.per_event() / swaps.per_event());
    m = measures;
  }
  const auto number = [](std::uint64_t x) { return static_cast<double>(x); };
  std::printf("%s,%d,%u,%llu,%.3f,%.1f,%llu,%.2f,%llu,%.1f\n", name, degree, n,
              static_cast<unsigned long long>(m.events), number(m.external) / number(m.events),
              number(m.touched) / number(m.events), static_cast<unsigned long long>(m.most_touched),
              number(m.most_held) / n, static_cast<unsigned long long>(m.most_per_element),
              ratios.empty() ? 0 : median(ratios));
  std::fflush(stdout);
}

/// A structure made of a rule, on random elements.
template <class Rule, class Make>
void measure(const char* name, int degree, Id n, double end, int rounds, const Rule& rule, Make&& make) {
  measure(name, degree, n, rounds, [&] {
    Random random(n);
    MovingSet<typename Rule::Element> set;
    for (Id id = 0; id < n; ++id) set.insert(id, make(random), 0);
    Kinetic<Rule> structure(set, 0, rule);
    structure.extend_horizon(0, end);
    const Cost cost = run(end, structure);
    return std::pair(cost, structure.measures());
  });
}

/// A structure that keeps its elements itself, on random values.
template <class Structure>
void measure(const char* name, Id n, double end, int rounds) {
  measure(name, 1, n, rounds, [&] {
    Random random(n);
    Structure structure;
    structure.extend_horizon(0, end);
    for (Id id = 0; id < n; ++id) structure.insert(id, random_value<1>(random), 0);
    const Cost cost = run(end, structure);
    return std::pair(cost, structure.measures());
  });
}

template <int Degree>
void measure_plane(Id n, double end, int rounds) {
  using Path = certificates::PlaneMotion<Degree>;
  measure("convex hull", Degree, n, end, rounds, structures::ConvexHullRule<Path>{}, random_path<Degree>);
  measure("Delaunay", Degree, n, end, rounds, structures::DelaunayRule<Path>{}, random_path<Degree>);
  measure("periodic Delaunay", Degree, n, end, rounds, structures::PeriodicDelaunayRule<Path>{}, random_path<Degree>);
  const auto on_delaunay = [&]<class Rule>(const char* name, const Rule& rule) {
    measure(name, Degree, n, rounds, [&] {
      Random random(n);
      MovingSet<Path> set;
      for (Id id = 0; id < n; ++id) set.insert(id, random_path<Degree>(random), 0);
      Kinetic<structures::DelaunayRule<Path>> triangulation(set, 0);
      Kinetic<Rule> outer(triangulation, 0, rule);
      triangulation.extend_horizon(0, end);
      outer.extend_horizon(0, end);
      const Cost cost = run(end, triangulation, outer);
      return std::pair(cost, outer.measures());
    });
  };
  on_delaunay("closest pair, on Delaunay", structures::ClosestPairRule<Path>{});
  on_delaunay("Gabriel graph, on Delaunay", structures::GabrielGraphRule<Path>{});
  measure("4 nearest of all, on Delaunay and Voronoi cells", Degree, n, rounds, [&] {
    Random random(n);
    MovingSet<Path> set;
    for (Id id = 0; id < n; ++id) set.insert(id, random_path<Degree>(random), 0);
    Kinetic<structures::DelaunayRule<Path>> triangulation(set, 0);
    Kinetic<structures::VoronoiCellsRule<Path>> cells(triangulation, 0);
    Kinetic<structures::KNearestRule<Path>> nearest(cells, 0, structures::KNearestRule<Path>(4));
    triangulation.extend_horizon(0, end);
    nearest.extend_horizon(0, end);
    const Cost cost = run(end, triangulation, cells, nearest);
    return std::pair(cost, nearest.measures());
  });
  // Of about the points' distances: half of the triangles are in the complex.
  on_delaunay("alpha complex, on Delaunay", structures::AlphaComplexRule<Path>(0.5 / std::sqrt(n)));
}

template <int Degree>
certificates::PointMotion<Degree> random_path_in_space(Random& random) {
  certificates::PointMotion<Degree> path;
  for (auto& c : path.coefficients) c = {random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
  path.coefficients[0] = {random.unit(), random.unit(), random.unit()};
  return path;
}

template <int Degree>
void measure_space(Id n, double end, int rounds) {
  using Path = certificates::PointMotion<Degree>;
  measure("Delaunay in space", Degree, n, end, rounds, structures::SpatialDelaunayRule<Path>{},
          random_path_in_space<Degree>);
  using Weighted = certificates::WeightedPoint<Degree>;
  const auto weighted = [n](Random& random) {
    return Weighted{random_path_in_space<Degree>(random), {{random.unit() / std::cbrt(static_cast<double>(n) * n)}}};
  };
  measure("regular in space", Degree, n, end, rounds, structures::RegularTriangulationRule<Weighted>{}, weighted);
}

/// An end that grows is inserted among n others, after a hundredth of a second.
void measure_insertion(Id n, int rounds) {
  std::vector<double> ratios;
  for (int round = 0; round < rounds; ++round) {
    Random random(n);
    MovingSet<structures::GrowingEnd> set;
    const auto end = [&] { return structures::GrowingEnd{random_path<1>(random)}; };
    for (Id id = 0; id < n; ++id) set.insert(id, end(), 0);
    Kinetic<structures::GrowingSegmentsRule> structure(set, 0);
    run(0.01, structure);
    constexpr Id more = 50;
    const double start = thread_seconds();
    for (Id id = n; id < n + more; ++id) {
      auto next = end();
      next.path.start = 0.01;
      set.insert(id, next, 0.01);
    }
    ratios.push_back((thread_seconds() - start) / more / tuned_list<1>(1000, duration(1000)).per_event());
  }
  std::printf("insertion of an end that grows / swap of a tuned list of 1 000,1,%u,50,%.0f\n", n, median(ratios));
}

/// Who is in m rectangles with a tenth of the square's sides, for 0.1 s, against the two sorted lists that a range tree
/// of the n points would have to keep at least.
void compare_with_range_tree(Id n, Id regions, int rounds) {
  using Path = certificates::PlaneMotion<1>;
  using Rectangle = structures::BoxRegion<Path>;
  constexpr double end = 0.1;
  std::vector<double> ratios;
  Cost inside{}, lists{};
  for (int round = 0; round < rounds; ++round) {
    Random random(n);
    MovingSet<Path> points;
    MovingSet<Rectangle> rectangles;
    for (Id id = 0; id < n; ++id) points.insert(id, random_path<1>(random), 0);
    for (Id id = 0; id < regions; ++id) {
      const Path low = random_path<1>(random);
      Path high = low;
      for (auto& x : high.coordinate) x.c[0] += 0.1;
      rectangles.insert(id, {low, high}, 0);
    }
    Kinetic<ElementsRule<Rectangle>> set(rectangles, 0);
    Kinetic<structures::PointsInsideRule<Rectangle>> structure(points, set, 0);
    inside = run(end, set, structure);
    const Cost x = tuned_list<1>(n, end), y = tuned_list<1>(n + 1, end);
    lists = {x.seconds + y.seconds, x.events + y.events};
    ratios.push_back(inside.seconds / lists.seconds);
  }
  std::printf("points in %u rectangles / two tuned lists,1,%u,%llu / %llu,%.2f\n", regions, n,
              static_cast<unsigned long long>(inside.events), static_cast<unsigned long long>(lists.events),
              median(ratios));
}

}  // namespace

int main(int argc, char** argv) {
  const int rounds = argc > 1 ? std::max(1, std::atoi(argv[1])) : 9;
  std::printf("what,degree,n,swaps,time ratio\n");
  for (const Id n : {100u, 1000u, 10000u}) compare_lists<1>(n, rounds);
  for (const Id n : {100u, 1000u, 10000u}) compare_lists<2>(n, rounds);
  for (const Id n : {100u, 1000u, 10000u}) measure_insertion(n, n < 10000 ? rounds : 1);
  for (const Id n : {100u, 1000u}) {
    for (const Id regions : {1u, 10u, 100u, 1000u}) {
      if (n * regions <= 100000) compare_with_range_tree(n, regions, rounds);
    }
  }
  std::printf(
      "\nstructure,degree,n,events,external share,certificates/event,most/event,held/n,most/element,"
      "time of an event / swap of a tuned list\n");
  const auto value = [](Random& random) { return random_value<1>(random); };
  const auto path = [](Random& random) { return random_path<1>(random); };
  using Path = certificates::PlaneMotion<1>;
  for (const Id n : {100u, 1000u, 10000u}) {
    measure<structures::SortedList<1>>("sorted list, tuned", n, duration(n), rounds);
    measure<structures::Tournament<1>>("tournament", n, 1, rounds);
    measure("heap", 1, n, 1, rounds, structures::HeapRule<structures::ByValue<Motion<1>>>{}, value);
    measure("extents of 4 directions", 1, n, 1, rounds,
            structures::ExtentsRule<Path, 2>({{1, 0}, {1, 1}, {0, 1}, {-1, 1}}), path);
    // Fat boxes of about the points' distances.
    measure("AABB tree", 1, n, 1, rounds, structures::AabbTreeRule<Path, 2>({0.25 / std::sqrt(n), 0}), path);
  }
  for (const Id n : {100u, 1000u}) {
    measure("ends of segments that grow", 1, n, 2, rounds, structures::GrowingSegmentsRule{},
            [](Random& random) { return structures::GrowingEnd{random_path<1>(random)}; });
    measure_plane<1>(n, 0.25, rounds);
    measure_plane<2>(n, 0.25, rounds);
    measure("Delaunay", 3, n, 0.25, rounds, structures::DelaunayRule<certificates::PlaneMotion<3>>{}, random_path<3>);
    measure_space<1>(n, 0.05, rounds);
    measure_space<2>(n, 0.05, rounds);
  }
}
