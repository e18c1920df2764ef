// You learn: to let a rule stand on several structures of different types, and to compare what these have.
// How to run: build/dev/examples/closest_on_two_levels
// What you see: 2 events of its own, 7 of the pairs that it stands on
#include "examples/closest_on_two_levels.hpp"
#include "kds/framework/kinetic.hpp"
#include "kds/simulator.hpp"

#include <iostream>

using namespace kds;
using examples::ClosestOnTwoLevels, examples::Line, examples::Curve;

int main() {
  // In km and minutes: four aircraft that fly straight, and above them four that turn.
  MovingSet<Line> lower;
  for (const Line& path : {Line{{{{{0, 12}}, {{0, 3}}}}, 0}, Line{{{{{100, -11}}, {{10, 1}}}}, 0},
                           Line{{{{{50, 1}}, {{80, -9}}}}, 0}, Line{{{{{20, 8}}, {{60, -3}}}}, 0}}) {
    lower.add(path, 0);
  }
  MovingSet<Curve> upper;
  for (const Curve& path :
       {Curve{{{{{0, 9, 0.25}}, {{40, 0, -0.5}}}}, 0}, Curve{{{{{30, 8, -0.5}}, {{60, -4, 0.25}}}}, 0},
        Curve{{{{{90, -6, 0}}, {{0, 5, 0.5}}}}, 0}, Curve{{{{{95, -9, 0.25}}, {{45, -2, 0}}}}, 0}}) {
    upper.add(path, 0);
  }

  const auto another = [](const ClosestOnTwoLevels& rule, const KineticEvent& event) {
    if (event.effect != Effect::external) return;
    const auto& [level, ids] = *rule.closest();
    std::cout << "from minute " << event.time << " on " << ids[0] << " and " << ids[1] << " of the "
              << (level == 0 ? "lower" : "upper") << " level are the closest\n";
  };
  Kinetic<structures::DelaunayRule<Line>> lower_triangles(lower, 0);
  Kinetic<structures::DelaunayRule<Curve>> upper_triangles(upper, 0);
  Kinetic<examples::Lower> lower_pair(lower_triangles, 0);
  Kinetic<examples::Upper> upper_pair(upper_triangles, 0);
  Kinetic<ElementsRule<Curve>> upper_points(upper, 0);
  Kinetic<ClosestOnTwoLevels, decltype(another)> closest({lower_pair, upper_pair, upper_points}, 0, {}, another);
  Simulator simulator(0, lower_triangles, upper_triangles, lower_pair, upper_pair, upper_points, closest);
  simulator.advance_to(8);
  std::cout << closest.measures().events << " events of its own, " << closest.measures().followed
            << " of the pairs that it stands on\n";
}
