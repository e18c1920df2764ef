// You learn: a structure for a query that moves itself: points in a rectangle, and in a disc that grows.
// How to run: build/dev/examples/points_in_a_region
// What you see: the rectangle meets 4 of 5 points; the disc has 5 of 5 at t = 8
#include "examples/points_in_a_region.hpp"
#include "certificates/plane_motion.hpp"
#include "kds/framework/kinetic.hpp"
#include "kds/simulator.hpp"

#include <iostream>
#include <set>
#include <string>

using namespace kds;
using Path = certificates::PlaneMotion<1>;
using Rectangle = structures::BoxRegion<Path>;
using Disc = structures::BallRegion<Path>;

int main() {
  const auto path = [](double x, double y, double vx, double vy) {
    return Path{{Polynomial<1>{{x, vx}}, Polynomial<1>{{y, vy}}}, 0};
  };
  MovingSet<Path> points;
  for (const Path& point :
       {path(2, 0, 0, 0), path(4, 3, 0, -1), path(6, 0.5, -1, 0), path(8, -4, 0, 0.5), path(5, 5, 0, 0)}) {
    points.add(point, 0);
  }

  std::set<Id> met;
  const auto tell = [&](const char* region, const auto& rule, const KineticEvent& event) {
    if (event.effect == Effect::internal) return;  // a point is beyond another side, and outside all the same
    const Id id = rule.members(event.slot)[0];
    std::cout << "t = " << event.time << ": point " << id << (rule.inside.contains(id) ? " enters " : " leaves ")
              << region << ", which has " << rule.count << '\n';
  };
  const auto of_rectangle = [&](const auto& rule, const KineticEvent& event) {
    tell("the rectangle", rule, event);
    if (event.effect == Effect::external) met.insert(rule.members(event.slot)[0]);
  };
  const auto of_disc = [&](const auto& rule, const KineticEvent& event) { tell("the disc", rule, event); };

  // From (-1, -1) to (1, 1), one unit to the right a second; and about the origin, one unit wider a second.
  const examples::PointsInRule<Rectangle> in_rectangle{Rectangle{path(-1, -1, 1, 0), path(1, 1, 1, 0)}};
  const examples::PointsInRule<Disc> in_disc{Disc{path(0, 0, 0, 0), Motion<1>{{{1, 1}}, 0}}};
  Kinetic<examples::PointsInRule<Rectangle>, decltype(of_rectangle)> rectangle(points, 0, in_rectangle, of_rectangle);
  Kinetic<examples::PointsInRule<Disc>, decltype(of_disc)> disc(points, 0, in_disc, of_disc);
  Simulator simulator(0, rectangle, disc);
  while (simulator.step(8)) simulator.audit();
  std::cout << "the rectangle meets " << met.size() << " of 5 points; the disc has " << disc.rule().count
            << " of 5 at t = 8\n";
}
