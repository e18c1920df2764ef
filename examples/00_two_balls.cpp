// You learn: to add bodies to a world and be told of their contacts.
// How to run: scripts/demo, then build/release/examples/00_two_balls
// What you see: the balls meet at t = 1 in (2, 0, 0)
#include "collision/world.hpp"

#include <iostream>

using namespace kds::collision;
using Motion = kds::certificates::PointMotion<1>;  // straight paths; 2, with parabola(), for gravity
using Eigen::Vector3d;

struct Teller : WorldListener<1> {
  void contact(World<1>&, const PairEvent& event) override {
    const auto& [time, point, normal, feature_a, feature_b] = event.contact;
    std::cout << "the balls meet at t = " << time << " in (" << point[0] << ", " << point[1] << ", " << point[2]
              << ")\n";
  }
};

int main() {
  Teller teller;
  World<1> world({.response = Response::elastic}, &teller);
  const Motion right = Motion::line(Vector3d(0, 0, 0), Vector3d(1, 0, 0));  // (0, 0, 0) + (1, 0, 0) t from t = 0 on
  const Motion left = Motion::line(Vector3d(4, 0, 0), Vector3d(-1, 0, 0));
  world.add_body({.shape = Sphere{1.0}, .motion = {right}});
  world.add_body({.shape = Sphere{1.0}, .motion = {left}});
  world.advance_to(10);
}
