// Worlds of cubes, rods and rings that turn, with one moment of inertia and with their own, beside the same without
// spin, and planar ones. bench_turning_worlds [FOLDER [SCENE]]: of a scene alone one run.
#include "collision/shapes/compound.hpp"
#include "collision/shapes/convex_hull.hpp"
#include "collision/world.hpp"
#include "tests/benchmarks/csv_file.hpp"
#include "tests/benchmarks/thread_time.hpp"
#include "tests/collision/sample_meshes.hpp"
#include "tests/support/random_numbers.hpp"

#include <cmath>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace kds;
using namespace kds::collision;
using Eigen::Vector3d;

struct Scene {
  int bodies;
  double packing;  ///< the part of the space that the shapes' boxes fill
  Shape shape;
  Vector3d half;  ///< of the box around it
  double rate;    ///< rad/s
  double seconds = 2;
  bool precesses = false;  ///< it has its own moments of inertia, in place of one for all axes
  bool passes = false;     ///< through others, in open space: what does not turn then never does
  bool turned = false;     ///< to random orientations
};

/// If it is not empty, only the scene of this name is run, once: so its instructions can be counted.
std::string only;
bool found = false;

/// Bodies on a lattice, their velocities at random up to 1 in each coordinate, between elastic walls or without any.
template <class World>
void run(std::FILE* csv, const char* name, const Scene& scene) {
  constexpr bool turning = turns<typename World::Motion>;
  if (!only.empty() && only != name) return;
  found = true;
  const double volume = 8 * scene.half.prod() / scene.packing;
  const int side = static_cast<int>(std::ceil(std::cbrt(scene.bodies)));
  const double spacing = std::cbrt(volume * scene.bodies) / side;
  WorldOptions options{.response = scene.passes ? Response::none : Response::elastic};
  if (!scene.passes) options.walls = Walls{Vector3d::Zero(), Vector3d::Constant(spacing * side)};
  double best = never;
  WorldCounters counters;
  for (int round = 0; round < (only.empty() ? 3 : 1); ++round) {
    tests::Random random(1);
    const double start = benchmarks::thread_seconds();
    World world(options);
    for (int i = 0; i < scene.bodies; ++i) {
      const Vector3d place = spacing * Vector3d(i % side + 0.5, i / side % side + 0.5, i / side / side + 0.5);
      const auto at_random = [&] {
        return Vector3d(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
      };
      const Vector3d velocity = at_random(), spin = scene.rate * at_random().normalized();
      typename World::Description body{.shape = scene.shape};
      if constexpr (turning) {
        body.motion = {{{{place, velocity}}}};
        body.motion[0].angular_velocity = spin;
        if (!scene.precesses) body.inertia = 2.0 / 3 * scene.half.squaredNorm() / 3;
      } else {
        body.motion = {{{place, velocity}}};
      }
      if (scene.turned) {
        const double x = random.between(-1, 1), y = random.between(-1, 1), z = random.between(-1, 1);
        const Eigen::Quaterniond orientation = Eigen::Quaterniond(random.between(-1, 1), x, y, z).normalized();
        if constexpr (turning) {
          body.motion[0].orientation = orientation;
        } else {
          body.orientation = orientation;
        }
      }
      world.add_body(body);
    }
    world.advance_to(scene.seconds);
    best = std::min(best, benchmarks::thread_seconds() - start);
    counters = world.counters();
  }
  std::printf("%-34s %8.2f ms, %6llu contacts, %7llu pair tests\n", name, 1e3 * best,
              static_cast<unsigned long long>(counters.contacts), static_cast<unsigned long long>(counters.pair_tests));
  std::fprintf(csv, "%s,%d,%g,%g,%.3f,%llu,%llu\n", name, scene.bodies, scene.packing, scene.rate, 1e3 * best,
               static_cast<unsigned long long>(counters.contacts),
               static_cast<unsigned long long>(counters.pair_tests));
}

/// Something that lies about on the part of a compound that is turned about the axis of turning: all is planar.
void run_planar(std::FILE* csv, const char* name, const Shape& shape) {
  if (!only.empty() && only != name) return;
  found = true;
  const auto motion = [](const Vector3d& place, const Vector3d& acceleration, double rate) {
    certificates::RigidMotion<2> result{{{place, Vector3d::Zero(), 0.5 * acceleration}}};
    result.angular_velocity = {0, 0, rate};
    return result;
  };
  const CompoundPart plate{Box{Vector3d(2, 0.1, 1)}, Vector3d::Zero(), {std::cos(0.05), 0, 0, std::sin(0.05)}};
  const double start = benchmarks::thread_seconds();
  TurningWorld<2> world({.response = Response::elastic});
  for (const bool fixed : {true, false}) {
    world.add_body({.shape = fixed ? Shape(compound(std::vector{plate})) : shape,
                    .motion = {fixed ? motion({0, 0, 0}, {0, 0, 0}, 0.1) : motion({0.2, 0.5, 0}, {0, -9.8, 0}, 0)},
                    .fixed = fixed,
                    .restitution = 0.3,
                    .friction = 0.5});
  }
  world.advance_to(0.6);
  const double seconds = benchmarks::thread_seconds() - start;
  const auto contacts = static_cast<unsigned long long>(world.counters().contacts);
  std::printf("%-34s %8.2f ms, %6llu contacts\n", name, 1e3 * seconds, contacts);
  std::fprintf(csv, "%s,2,0,0.1,%.3f,%llu,%llu\n", name, 1e3 * seconds, contacts,
               static_cast<unsigned long long>(world.counters().pair_tests));
}

}  // namespace

int main(int argc, char** argv) {
  const std::string folder = argc > 1 ? argv[1] : ".";
  if (argc > 2) only = argv[2];
  std::FILE* const csv = std::fopen((folder + "/turning_worlds.csv").c_str(), "w");
  if (!csv) return std::perror("turning_worlds.csv"), 1;
  std::fprintf(csv, "scene,bodies,packing,rate,ms,contacts,pair_tests\n");
  const Vector3d cube = Vector3d::Constant(0.5), rod(1, 0.1, 0.1);
  for (const double packing : {0.01, 0.1}) {
    std::printf("1000 cubes at %g %%, 2 s\n", 100 * packing);
    run<World<1>>(csv, "cubes that keep their orientation", {1000, packing, Box{cube}, cube, 0});
    run<TurningWorld<1>>(csv, "cubes without spin at first", {1000, packing, Box{cube}, cube, 0});
    run<TurningWorld<1>>(csv, "cubes at 1 rad/s", {1000, packing, Box{cube}, cube, 1});
    run<TurningWorld<1>>(csv, "cubes at 10 rad/s", {1000, packing, Box{cube}, cube, 10});
  }
  const Vector3d flat(1, 1, 0.25);
  const MeshShape ring{samples::torus(8, 4), 1};
  const Capsule capsule{0.2, 0.5};
  std::vector<Vector3d> corners;
  for (int d = 0; d < 3; ++d) corners.push_back(Vector3d::Unit(d)), corners.push_back(-Vector3d::Unit(d));
  const ConvexHull octahedron = convex_hull(corners);
  std::printf("1000 bodies that pass through each other and do not turn: in a World, and in a TurningWorld\n");
  const auto passing = [&](const char* name, const char* name_turning, const Scene& scene) {
    run<World<1>>(csv, name, scene);
    run<TurningWorld<1>>(csv, name_turning, scene);
  };
  passing("passing cubes at 1 %", "passing cubes at 1 % in a TurningWorld",
          {1000, 0.01, Box{cube}, cube, 0, 20, false, true});
  passing("passing cubes at 10 %", "passing cubes at 10 % in a TurningWorld",
          {1000, 0.1, Box{cube}, cube, 0, 2, false, true});
  passing("passing turned cubes", "passing turned cubes in a TurningWorld",
          {1000, 0.01, Box{cube}, cube, 0, 20, false, true, true});
  passing("passing capsules", "passing capsules in a TurningWorld",
          {1000, 0.01, capsule, Vector3d(0.2, 0.2, 0.7), 0, 20, false, true});
  passing("passing octahedra", "passing octahedra in a TurningWorld",
          {1000, 0.01, octahedron, Vector3d::Ones(), 0, 20, false, true});
  passing("passing rings", "passing rings in a TurningWorld", {1000, 0.01, ring, flat, 0, 20, false, true});
  std::printf("1000 rods of 1 : 10 at 0.2 %%, 2 s\n");
  run<World<1>>(csv, "rods that keep their orientation", {1000, 0.002, Box{rod}, rod, 0});
  run<TurningWorld<1>>(csv, "rods at 1 rad/s", {1000, 0.002, Box{rod}, rod, 1});
  run<TurningWorld<1>>(csv, "rods at 10 rad/s", {1000, 0.002, Box{rod}, rod, 10});
  run<TurningWorld<1>>(csv, "rods that precess at 1 rad/s", {1000, 0.002, Box{rod}, rod, 1, 2, true});
  run<TurningWorld<1>>(csv, "rods that precess at 10 rad/s", {1000, 0.002, Box{rod}, rod, 10, 2, true});
  for (const auto& [packing, seconds] : {std::pair(0.01, 20.0), {0.1, 2.0}}) {
    std::printf("1000 rings of 64 triangles at %g %%, %g s\n", 100 * packing, seconds);
    run<World<1>>(csv, "rings that keep their orientation", {1000, packing, ring, flat, 0, seconds});
    run<TurningWorld<1>>(csv, "rings at 1 rad/s", {1000, packing, ring, flat, 1, seconds});
    run<TurningWorld<1>>(csv, "rings at 10 rad/s", {1000, packing, ring, flat, 10, seconds});
    run<TurningWorld<1>>(csv, "rings that precess at 1 rad/s", {1000, packing, ring, flat, 1, seconds, true});
    run<TurningWorld<1>>(csv, "rings that precess at 10 rad/s", {1000, packing, ring, flat, 10, seconds, true});
  }
  std::printf("planar: on a plate of a compound that is turned about the common axis, 0.6 s\n");
  std::vector<Vector3d> prism;
  for (int i = 0; i < 7; ++i) {
    const double angle = 2 * std::acos(-1.0) * i / 7;
    for (const double z : {-0.3, 0.3}) prism.emplace_back(0.25 * std::cos(angle), 0.25 * std::sin(angle), z);
  }
  run_planar(csv, "planar: a box", Box{Vector3d(0.25, 0.2, 0.3)});
  run_planar(csv, "planar: a prism of seven sides", convex_hull(prism));
  if (!found) return std::fprintf(stderr, "bench_turning_worlds: there is no scene '%s'\n", only.c_str()), 2;
  return std::fclose(csv) == 0 ? 0 : 1;
}
