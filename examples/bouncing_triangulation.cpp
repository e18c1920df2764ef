// You learn: a world of bodies and a structure of your choice on one clock, and to roll both back together.
// How to run: build/dev/examples/bouncing_triangulation
// What you see: back at 2.0 s and on: the same 42 contacts, the same 26 edges
#include "certificates/plane_motion.hpp"
#include "collision/world.hpp"
#include "examples/course/mesh_edges.hpp"
#include "kds/framework/history.hpp"
#include "kds/framework/kinetic.hpp"
#include "kds/simulator.hpp"
#include "structures/delaunay.hpp"

#include <iostream>
#include <vector>

using namespace kds;
using collision::BodyId;
using collision::PairEvent;
using collision::WallEvent;
using World = collision::World<1>;
using Path = certificates::PlaneMotion<1>;

/// The path of a ball's centre in the plane.
Path centre(const World& world, BodyId id) {
  const auto& motion = world.motion(id);
  return {{motion.axis(0).position, motion.axis(1).position}, motion.start};
}

/// Gives new paths to the centres of balls that have bounced.
struct Follower final : collision::WorldListener<1> {
  MovingSet<Path> centres;
  std::vector<double> contacts;  ///< when

  void contact(World& world, const PairEvent& e) override {
    contacts.push_back(e.contact.time);
    for (const BodyId id : {e.a, e.b}) centres.update(id, centre(world, id), e.contact.time);
  }
  void wall(World& world, const WallEvent& e) override {
    centres.update(e.body, centre(world, e.body), e.contact.time);
  }
};

int main() {
  Follower follower;
  collision::WorldOptions options;
  options.response = collision::Response::elastic;
  options.walls = collision::Walls{{0, 0, -1}, {8, 8, 1}};
  World world(options, &follower);
  for (int i = 0; i < 12; ++i) {
    const Eigen::Vector3d place(1 + 2 * (i % 4), 1 + 2.5 * (i / 4) + 0.25 * (i % 3), 0);
    const Eigen::Vector3d velocity(1.5 - i % 5, 0.25 * (i % 7) - 1, 0);
    const BodyId id = world.add_body({.shape = collision::Sphere{0.5}, .motion = {{{place, velocity}, 0}}});
    follower.centres.insert(id, centre(world, id), 0);
  }
  Kinetic<structures::DelaunayRule<Path>> triangulation(follower.centres, 0);

  Simulator simulator(0, world, triangulation);
  History history(100, simulator, follower.centres);
  while (history.step(10)) simulator.audit();
  std::vector<double> later = follower.contacts;
  std::erase_if(later, [](double t) { return t <= 2; });
  const auto edges = [&] { return course::edges_of(triangulation.rule().mesh()); };
  const course::Edges last = edges();

  history.roll_back(2);
  follower.contacts.clear();
  while (history.step(10)) {
  }
  const bool same = follower.contacts == later && edges() == last;
  std::cout << "back at 2.0 s and on: " << (same ? "the same " : "not the same ") << later.size()
            << " contacts, the same " << last.size() << " edges\n";
  return same ? 0 : 1;
}
