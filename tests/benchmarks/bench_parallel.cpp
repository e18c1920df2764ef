// What a scene in domains costs beside one world, with one thread and with two: gases of balls, of rings of 64
// triangles that keep their orientation, and of rings and bricks that precess; and balls that lie on a floor and roll
// into each other.
//
//     bench_parallel [DIRECTORY [KIND...] [BODIES...]]      -> parallel.csv
//
// of the kinds that are named, or of all: balls, rings, spinning-rings, bricks, table; of these sizes, or of 10 000 to
// 1 000 000. plot_parallel.gp draws it.
//
// The bodies (elastic_gas.hpp, table_of_balls.hpp) run until each has had some contacts; of rings and bricks an eighth
// as many, for as long; on floors a third as many. One world and the same scene in domains take turns; the best of the
// rounds counts. The number of contacts and a hash of all of them must be the same.

#include "collision/parallel/parallel_world.hpp"
#include "collision/world.hpp"
#include "tests/benchmarks/csv_file.hpp"
#include "tests/benchmarks/elastic_gas.hpp"
#include "tests/benchmarks/table_of_balls.hpp"
#include "tests/benchmarks/thread_time.hpp"
#include "tests/collision/sample_meshes.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using namespace kds::collision;
using kds::benchmarks::ElasticGas;
using kds::benchmarks::tell;
using kds::benchmarks::wall_seconds;

/// Seconds of CPU time of all threads.
double cpu_seconds() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(used.ru_utime) + seconds(used.ru_stime);
}

struct ContactHash {
  std::uint64_t hash = 14695981039346656037u;
  void add(const PairEvent& event) {
    for (const std::uint64_t value : {std::bit_cast<std::uint64_t>(event.contact.time), event.a, event.b}) {
      hash = (hash ^ value) * 1099511628211u;
    }
  }
};
template <class Motion>
struct WorldHash final : BasicWorldListener<Motion> {
  ContactHash of;
  void contact(BasicWorld<Motion>&, const PairEvent& event) override { of.add(event); }
};
struct DividedHash final : ParallelListener {
  ContactHash of;
  void contact(const PairEvent& event) override { of.add(event); }
};

double end_of(double packing) { return packing > 0.1 ? 1 : 8; }

struct Time {
  double entry_wall = 1e300, run_wall = 1e300, run_cpu = 1e300;
  void note(double entry, double wall, double cpu) {
    entry_wall = std::min(entry_wall, entry), run_wall = std::min(run_wall, wall), run_cpu = std::min(run_cpu, cpu);
  }
};

using Straight = kds::certificates::PointMotion<1>;
using Spinning = kds::certificates::RigidMotion<1>;

/// Bodies of a shape in the places of the balls of a gas, as fast. If they turn, their surfaces do so about as fast.
template <class Motion>
std::vector<BasicBodyDescription<Motion>> bodies_of(const ElasticGas& gas, const Shape& shape) {
  std::vector<BasicBodyDescription<Motion>> bodies;
  for (const auto& ball : gas.bodies) {
    BasicBodyDescription<Motion> body;
    body.shape = shape;
    const auto& path = ball.motion[0];
    const Eigen::Vector3d& velocity = path.coefficients[1];
    if constexpr (turns<Motion>) {
      Motion motion;
      motion.path = path;
      motion.angular_velocity = {2 * velocity[1], 2 * velocity[2], 2 * velocity[0]};
      body.motion = {motion};
    } else {
      body.motion = {path};
    }
    bodies.push_back(body);
  }
  return bodies;
}

const std::vector<std::string> all_kinds{"balls", "rings", "spinning-rings", "bricks", "table"};

template <class World, class Bodies>
void run(World& world, const Bodies& bodies, double end, Time& time) {
  const double begin = wall_seconds();
  world.reserve(bodies.size());
  for (const auto& body : bodies) world.add_body(body);
  world.advance_to(0);
  const double entered = wall_seconds(), cpu = cpu_seconds();
  world.advance_to(end);
  time.note(entered - begin, wall_seconds() - entered, cpu_seconds() - cpu);
}

template <class Motion>
void measure(std::ofstream& csv, const char* kind, const WorldOptions& options,
             const std::vector<BasicBodyDescription<Motion>>& descriptions, double packing, double end) {
  const std::size_t bodies = descriptions.size();
  Time whole;
  struct Way {
    std::size_t threads, domains;
    Time time{};
    ParallelCounters counters{};
  };
  std::vector<Way> ways{{1, 2}, {2, 2}, {2, 0}};
  if (bodies >= 100'000) ways.push_back({1, 8}), ways.push_back({2, 8});
  const int rounds = bodies >= 300'000 ? 2 : 3;
  for (int round = 0; round < rounds; ++round) {
    WorldHash<Motion> right;
    BasicWorld<Motion> world(options, &right);
    run(world, descriptions, end, whole);
    for (Way& way : ways) {
      DividedHash hash;
      BasicParallelWorld<Motion> divided(options, {.threads = way.threads, .domains = way.domains}, &hash);
      run(divided, descriptions, end, way.time);
      way.counters = divided.counters();
      if (hash.of.hash != right.of.hash) throw std::runtime_error("a scene in domains has other contacts");
    }
  }
  for (const Way& way : ways) {
    const ParallelCounters& c = way.counters;
    const auto ratio = [](std::uint64_t a, std::uint64_t b) {
      return b ? static_cast<double>(a) / static_cast<double>(b) : 1;
    };
    tell(csv, "%s,%zu,%g,%zu,%zu,%llu,%.3f,%.3f,%.3f,%.3f,%.3f,%.3f,%.3f,%.3f,%llu,%llu,%.4g\n", kind, bodies, packing,
         way.threads, way.domains, static_cast<unsigned long long>(c.contacts), whole.entry_wall, whole.run_wall,
         way.time.entry_wall, way.time.run_wall, whole.run_wall / way.time.run_wall, way.time.run_cpu / whole.run_cpu,
         ratio(c.bodies_known, c.bodies_owned), ratio(c.events_computed, c.contacts + c.wall_contacts),
         static_cast<unsigned long long>(c.windows), static_cast<unsigned long long>(c.windows_failed),
         end / static_cast<double>(std::max<std::uint64_t>(c.windows, 1)));
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    std::ofstream csv = kds::benchmarks::open_csv(argc > 1 ? argv[1] : ".", "parallel.csv");
    tell(csv,
         "kind,bodies,packing,threads,domains,contacts,world_entry_s,world_run_s,entry_s,run_s,speed_up,cpu_ratio,"
         "known_per_owned,computed_per_event,windows,failed,seconds_a_window\n");
    std::vector<std::size_t> sizes;
    std::vector<std::string> kinds;
    for (int i = 2; i < argc; ++i) {
      const std::string word = argv[i];
      if (word.find_first_not_of("0123456789") == std::string::npos) {
        sizes.push_back(std::stoull(word));
      } else if (std::find(all_kinds.begin(), all_kinds.end(), word) != all_kinds.end()) {
        kinds.push_back(word);
      } else {
        throw std::invalid_argument("'" + word + "' is neither a kind nor a number of bodies");
      }
    }
    if (sizes.empty()) sizes = {10'000, 30'000, 100'000, 300'000, 1'000'000};
    const auto wanted = [&](const char* kind) {
      return kinds.empty() || std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
    };
    const MeshShape ring{kds::collision::samples::torus(8, 4), 0.5};
    const Box brick{{0.4, 0.2, 0.15}};
    for (const double packing : {0.25, 0.01}) {
      for (const std::size_t bodies : sizes) {
        const double end = end_of(packing);
        if (wanted("balls")) {
          const auto gas = kds::benchmarks::elastic_gas(bodies, packing);
          measure(csv, "balls", gas.options, gas.bodies, packing, end);
        }
        const auto few = kds::benchmarks::elastic_gas(bodies / 8, packing);
        if (wanted("rings")) measure(csv, "rings", few.options, bodies_of<Straight>(few, ring), packing, end);
        if (wanted("spinning-rings")) {
          measure(csv, "spinning-rings", few.options, bodies_of<Spinning>(few, ring), packing, end);
        }
        if (wanted("bricks")) measure(csv, "bricks", few.options, bodies_of<Spinning>(few, brick), packing, end);
        if (wanted("table")) {
          const auto table = kds::benchmarks::table_of_balls(bodies / 3, packing);
          measure(csv, "table", table.options, table.bodies, packing, 2 * end);
        }
      }
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_parallel: %s\n", error.what());
    return 1;
  }
}
