// The longest call of advance_for() while bodies enter a world that has some already.
//
//     bench_entry [DIRECTORY]      -> entry.csv; 30 s
//
// Balls of radius 0.3, one in a cube of the side 2 on average, with velocities up to 1 along each axis. `there` of them
// have entered when `come` more are added at one time, and the world is called with a budget of 1 ms until all have
// entered and their contacts have been predicted. Each in a world that knows nothing of it, and in one that was told to
// reserve() room for all at first. Times are CPU times of the thread: those of the wall clock are the machine's.

#include "collision/world.hpp"
#include "tests/benchmarks/csv_file.hpp"
#include "tests/benchmarks/thread_time.hpp"
#include "tests/collision/sample_meshes.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <exception>
#include <fstream>

namespace {

using namespace kds::collision;
using Eigen::Vector3d;
using kds::benchmarks::tell;
using kds::benchmarks::thread_seconds;
using samples::Random;
using Line = kds::certificates::PointMotion<1>;

struct Entry {
  double reserving = 0;  ///< s
  double longest = 0;    ///< s: of a call
  double all = 0;        ///< s: of all calls
  int calls = 0;
};

Entry run(BroadPhaseKind method, std::size_t there, std::size_t come, bool reserves) {
  WorldOptions options;
  options.response = Response::elastic;
  options.broad_phase = method;
  options.rate = 60;
  World<1> world(options);
  Random random(1);
  const double side = 2 * std::cbrt(static_cast<double>(there + come));
  const auto add = [&](std::size_t bodies) {
    for (std::size_t i = 0; i < bodies; ++i) {
      const Vector3d place = random.vector(side / 2);
      world.add_body({.shape = Sphere{0.3}, .motion = {Line::line(place, random.vector(1), world.now())}});
    }
  };
  Entry entry;
  if (reserves) {
    const double start = thread_seconds();
    world.reserve(there + come);
    entry.reserving = thread_seconds() - start;
  }
  add(there);
  world.advance_to(0.01);
  add(come);
  for (bool done = false; !done; ++entry.calls) {
    const double start = thread_seconds();
    done = world.advance_for(1e-3, 0.02);
    const double took = thread_seconds() - start;
    entry.longest = std::max(entry.longest, took);
    entry.all += took;
  }
  return entry;
}

void measure(std::ofstream& csv, BroadPhaseKind method, const char* name, std::size_t there, std::size_t come) {
  for (const bool reserves : {false, true}) {
    const Entry entry = run(method, there, come, reserves);
    tell(csv, "%s,%zu,%zu,%d,%.1f,%.2f,%.1f,%d\n", name, there, come, static_cast<int>(reserves), 1e3 * entry.reserving,
         1e3 * entry.longest, 1e3 * entry.all, entry.calls);
  }
}

}  // namespace

int main(int count, char** arguments) try {
  std::ofstream csv = kds::benchmarks::open_csv(count > 1 ? arguments[1] : ".", "entry.csv");
  tell(csv, "method,there,come,reserved,reserve ms,longest call ms,all calls ms,calls\n");
  measure(csv, BroadPhaseKind::automatic, "auto", 0, 20'000);
  measure(csv, BroadPhaseKind::automatic, "auto", 20'000, 20'000);
  measure(csv, BroadPhaseKind::automatic, "auto", 20'000, 200'000);
  measure(csv, BroadPhaseKind::kinetic_sap, "kinetic-sap", 2'000, 2'000);
  measure(csv, BroadPhaseKind::sap, "sap", 2'000, 2'000);
} catch (const std::exception& error) {
  std::fprintf(stderr, "bench_entry: %s\n", error.what());
  return 1;
}
