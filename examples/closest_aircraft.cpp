// You learn: to maintain the closest pair of moving points, and to be told when it changes.
// How to run: build/dev/examples/closest_aircraft
// What you see: nearest of all were AB0 and AB1, at 1.29944 km
#include "certificates/plane_motion.hpp"
#include "kds/framework/kinetic.hpp"
#include "kds/simulator.hpp"
#include "structures/closest_pair.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <string>

using namespace kds;
using Path = certificates::PlaneMotion<1>;  // straight, in km and minutes
using Closest = structures::ClosestPairRule<Path>;

std::string name(Id id) { return "AB" + std::to_string(id); }

double distance(const Path& a, const Path& b, double t) { return std::hypot(a(t)[0] - b(t)[0], a(t)[1] - b(t)[1]); }

int main() {
  MovingSet<Path> aircraft;
  const double now = 0;
  for (const Path& path :
       {Path{{{{{0, 12}}, {{0, 3}}}}, 0}, Path{{{{{100, -11}}, {{10, 1}}}}, 0}, Path{{{{{50, 1}}, {{80, -9}}}}, 0},
        Path{{{{{20, 8}}, {{60, -3}}}}, 0}, Path{{{{{90, -9}}, {{70, -6}}}}, 0}, Path{{{{{70, -2}}, {{1, 10}}}}, 0}}) {
    aircraft.add(path, now);
  }

  // The structure has events of its proof, too (internal); those that change the pair are external.
  const auto another = [&](const Closest& closest, const KineticEvent& event) {
    if (event.effect != Effect::external) return;
    const auto [a, b] = *closest.pair();
    std::cout << "from minute " << event.time << " on " << name(a) << " and " << name(b) << " are the closest, at "
              << distance(aircraft[a], aircraft[b], event.time) << " km\n";
  };
  Kinetic<structures::DelaunayRule<Path>> triangulation(aircraft, now);
  Kinetic<Closest, decltype(another)> closest(triangulation, now, {}, another);
  Simulator simulator(now, triangulation, closest);

  // Between two events the pair is the same, so the least distance is where a parabola is lowest, or at an event.
  double least = never;
  std::array<Id, 2> nearest{};
  for (double from = now, to; from < 10; from = to) {
    const auto pair = *closest.rule().pair();
    const Id a = pair[0], b = pair[1];
    to = std::min(simulator.next_time(), 10.0);
    const auto difference = [&](int d) { return aircraft[a].axis(d).position - aircraft[b].axis(d).position; };
    const auto x = difference(0), y = difference(1);  // all start at 0
    const double lowest = -(x.c[0] * x.c[1] + y.c[0] * y.c[1]) / (x.c[1] * x.c[1] + y.c[1] * y.c[1]);
    const double at = std::clamp(lowest, from, to);
    if (const double d = distance(aircraft[a], aircraft[b], at); d < least) least = d, nearest = {a, b};
    simulator.advance_to(to);
  }
  std::cout << "nearest of all were " << name(nearest[0]) << " and " << name(nearest[1]) << ", at " << least << " km\n";
}
