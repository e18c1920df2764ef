// Worlds of cubes, rods and rings that turn, with one moment of inertia and with their own, beside the same without
// spin.
#include "collision/world.hpp"
#include "tests/benchmarks/csv_file.hpp"
#include "tests/benchmarks/thread_time.hpp"
#include "tests/collision/sample_meshes.hpp"
#include "tests/support/random_numbers.hpp"

#include <cmath>
#include <cstdio>
#include <string>

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
};

/// Bodies on a lattice, their velocities at random up to 1 in each coordinate, between elastic walls.
template <class World>
void run(std::FILE* csv, const char* name, const Scene& scene) {
  constexpr bool turning = turns<typename World::Motion>;
  const double volume = 8 * scene.half.prod() / scene.packing;
  const int side = static_cast<int>(std::ceil(std::cbrt(scene.bodies)));
  const double spacing = std::cbrt(volume * scene.bodies) / side;
  WorldOptions options{.response = Response::elastic};
  options.walls = Walls{Vector3d::Zero(), Vector3d::Constant(spacing * side)};
  double best = never;
  WorldCounters counters;
  for (int round = 0; round < 3; ++round) {
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

}  // namespace

int main(int argc, char** argv) {
  const std::string folder = argc > 1 ? argv[1] : ".";
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
  std::printf("1000 rods of 1 : 10 at 0.2 %%, 2 s\n");
  run<World<1>>(csv, "rods that keep their orientation", {1000, 0.002, Box{rod}, rod, 0});
  run<TurningWorld<1>>(csv, "rods at 1 rad/s", {1000, 0.002, Box{rod}, rod, 1});
  run<TurningWorld<1>>(csv, "rods at 10 rad/s", {1000, 0.002, Box{rod}, rod, 10});
  run<TurningWorld<1>>(csv, "rods that precess at 1 rad/s", {1000, 0.002, Box{rod}, rod, 1, 2, true});
  run<TurningWorld<1>>(csv, "rods that precess at 10 rad/s", {1000, 0.002, Box{rod}, rod, 10, 2, true});
  const Vector3d flat(1, 1, 0.25);
  const MeshShape ring{samples::torus(8, 4), 1};
  for (const auto& [packing, seconds] : {std::pair(0.01, 20.0), {0.1, 2.0}}) {
    std::printf("1000 rings of 64 triangles at %g %%, %g s\n", 100 * packing, seconds);
    run<World<1>>(csv, "rings that keep their orientation", {1000, packing, ring, flat, 0, seconds});
    run<TurningWorld<1>>(csv, "rings at 1 rad/s", {1000, packing, ring, flat, 1, seconds});
    run<TurningWorld<1>>(csv, "rings at 10 rad/s", {1000, packing, ring, flat, 10, seconds});
    run<TurningWorld<1>>(csv, "rings that precess at 1 rad/s", {1000, packing, ring, flat, 1, seconds, true});
    run<TurningWorld<1>>(csv, "rings that precess at 10 rad/s", {1000, packing, ring, flat, 10, seconds, true});
  }
  return std::fclose(csv) == 0 ? 0 : 1;
}
