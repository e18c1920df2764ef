// You learn: to bound moving points: all of them by a k-DOP, each by a fat box in a tree that reports which are near.
// How to run: build/dev/examples/bounding_volumes
// What you see: the 14-DOP has changed its extreme points 12 times; it extends from z = 0.0608 to 2.3808
#include "certificates/point_motion.hpp"
#include "kds/framework/kinetic.hpp"
#include "kds/simulator.hpp"
#include "structures/aabb_tree.hpp"
#include "structures/extents.hpp"

#include <cmath>
#include <iostream>

using namespace kds;
using Path = certificates::PointMotion<2>;
using Dop = structures::ExtentsRule<Path, 3>;

/// Receives the pairs of fat boxes that overlap.
struct Neighbours {
  int* began;
  void pair_began(Id, Id, double) { ++*began; }
  void pair_ended(Id, Id, double) {}
};
using Tree = structures::AabbTreeRule<Path, 3, Neighbours>;

int main() {
  // Thirty points, thrown up from a circle, each a little later than the one before.
  MovingSet<Path> points;
  for (int i = 0; i < 30; ++i) {
    const double angle = 0.7 * i;
    const Eigen::Vector3d from(std::cos(angle), std::sin(angle), 0);
    points.add({{from, Eigen::Vector3d(-0.5 * from[0], 0.025 * i, 4 + 0.1 * i), {0, 0, -4.905}}, 0}, 0);
  }

  // Two structures on the same points. The k-DOP has an event where another point is the extreme one in a direction (or
  // the proof of it changes); the tree where a point leaves its fat box, which is made to last for 0.1 s.
  int changes = 0, began = 0;
  const auto changed = [&](const Dop&, const KineticEvent& event) { changes += event.effect == Effect::external; };
  Kinetic<Dop, decltype(changed)> dop(points, 0, Dop(structures::kdop_directions(14)), changed);
  Kinetic<Tree> tree(points, 0, Tree({.slack = 0, .ahead = 0.1}, {&began}));
  Simulator simulator(0, dop, tree);
  simulator.advance_to(0.8);
  simulator.audit();  // both, against the motions, with exact signs

  const auto [low, high] = dop.rule().extent(2, points, simulator.now());
  std::cout << "the 14-DOP has changed its extreme points " << changes << " times; it extends from z = " << low
            << " to " << high << '\n';

  // Which points are above z = 1 now? Exactly, not just by fat boxes.
  const structures::TreeBox<3> above{{-never, -never, 1}, {never, never, never}};
  std::cout << tree.rule().query(above, points, simulator.now()).size() << " points are above z = 1; fat boxes met "
            << began << " times\n";
}
