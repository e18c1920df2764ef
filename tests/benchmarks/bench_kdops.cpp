// When do k-DOPs pay? Kinetic sweep and prune with k = 6, 14, 18 and 26 on bodies of different shapes.
//
//     bench_kdops [BODIES [ROUNDS]]     default 1000 and 5; writes two tables of CSV to the standard output
//
// Bodies at random places in random orientations move on lines for two seconds, at most a size of theirs a second on
// each axis. First the broad phase alone, with one list and with one in every direction; then the whole world, bodies
// passing through each other or bouncing. In each round all k run in turn; times are CPU times of this thread as ratios
// to those of boxes (k = 6; with one list) in the same round, medians. Ends with an error where k changes a contact.
#include "collision/broad_phase/kinetic_sweep_and_prune.hpp"
#include "collision/world.hpp"
#include "structures/extents.hpp"
#include "tests/benchmarks/thread_time.hpp"
#include "tests/collision/sample_meshes.hpp"
#include "tests/support/random_numbers.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <utility>
#include <vector>

namespace {

using namespace kds;
using namespace kds::collision;
using Eigen::Vector3d;
using kds::tests::Random;

constexpr std::array kinds{6, 14, 18, 26};
constexpr double end_time = 2;

struct SceneKind {
  const char* name;
  Shape shape;
  double spacing;  ///< of bodies, in units of length: the sizes are about 1 to 2
  bool parallel;   ///< all along one diagonal
};

std::vector<SceneKind> scenes() {
  const auto ring = samples::torus(8, 4);  // 64 triangles, as the tori of [Coming06] section 5
  const auto fine_ring = samples::torus(64, 32);
  return {{"rods", Box{{1, 0.03, 0.03}}, 1.2, false},
          {"rods along (1 1 1)", Box{{1, 0.03, 0.03}}, 1.2, true},
          {"plates", Box{{0.5, 0.5, 0.03}}, 1.2, false},
          {"rings of 64 triangles", MeshShape{ring, 0.5}, 1.5, false},
          {"rings of 4096 triangles", MeshShape{fine_ring, 0.5}, 1.5, false},
          {"cubes", Box{{0.3, 0.3, 0.3}}, 1.2, false},
          {"balls", Sphere{0.5}, 1.5, false}};
}

std::vector<BodyDescription<1>> make_bodies(const SceneKind& kind, std::size_t n) {
  Random random(1);
  const double side = kind.spacing * std::cbrt(static_cast<double>(n));
  std::vector<BodyDescription<1>> bodies(n);
  for (auto& body : bodies) {
    body.shape = kind.shape;
    Eigen::Vector4d turn;
    do {
      for (int d = 0; d < 4; ++d) turn[d] = random.between(-1, 1);
    } while (!(turn.squaredNorm() <= 1 && turn.squaredNorm() > 0.01));
    body.orientation = Eigen::Quaterniond(turn).normalized();
    if (kind.parallel) body.orientation = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitX(), Vector3d::Ones());
    body.motion.resize(1);
    for (int d = 0; d < 3; ++d) {
      body.motion[0].coefficients[0][d] = random.between(0, side);
      body.motion[0].coefficients[1][d] = random.between(-1, 1);
    }
  }
  return bodies;
}

struct Ran {
  double setup = 0, run = 0;
  WorldCounters work;
  std::vector<double> contacts;  ///< times
};

struct Contacts final : WorldListener<1> {
  std::vector<double> times;
  void contact(World<1>&, const PairEvent& event) override { times.push_back(event.contact.time); }
};

Ran run_world(const std::vector<BodyDescription<1>>& bodies, int k, Response response) {
  WorldOptions options;
  options.broad_phase = BroadPhaseKind::kinetic_sap;
  options.kdop = k;
  options.window = end_time;
  options.response = response;
  Contacts contacts;
  const double begin = benchmarks::thread_seconds();
  World<1> world(options, &contacts);
  for (const auto& body : bodies) world.add_body(body);
  world.advance_to(0);
  const double start = benchmarks::thread_seconds();
  world.advance_to(end_time);
  const double end = benchmarks::thread_seconds();
  std::sort(contacts.times.begin(), contacts.times.end());
  return {start - begin, end - start, world.counters(), std::move(contacts.times)};
}

struct Count final : PairListener {
  std::size_t began = 0;
  void pair_began(BodySlot, BodySlot, double) override { ++began; }
  void pair_ended(BodySlot, BodySlot, double) override {}
};

Ran run_broad_phase(const std::vector<PlacedShape>& shapes, const std::vector<BodyDescription<1>>& bodies, int k,
                    ListedAxes listed) {
  const auto all = structures::kdop_directions(k);
  const std::vector<KdopDirection> more(all.begin() + 3, all.end());
  std::vector<KineticBox<1>> boxes;
  std::vector<std::array<double, 2>> extents;
  std::vector<KineticSweepAndPrune<1>::Entry> entries;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    boxes.push_back(box_around(bodies[i].motion[0], shapes[i].low, shapes[i].high));
    for (const auto& d : more) extents.push_back(extent(shapes[i], Vector3d(d.data())));
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) entries.push_back({static_cast<BodySlot>(i), &boxes[i]});
  Count count;
  const double begin = benchmarks::thread_seconds();
  KineticSweepAndPrune<1> broad_phase(0, {.listed = listed}, {more, [&](BodySlot id, std::size_t i, double) {
                                                                const auto& [low, high] = extents[id * more.size() + i];
                                                                return slab_around(bodies[id].motion[0], low, high,
                                                                                   more[i]);
                                                              }});
  broad_phase.extend_horizon(0, end_time);
  broad_phase.insert(entries, 0, count);
  const double start = benchmarks::thread_seconds();
  while (broad_phase.advance(end_time, count)) {
  }
  Ran ran{start - begin, benchmarks::thread_seconds() - start, {}, {}};
  ran.work.broad_phase = broad_phase.counters();
  ran.work.pairs_begun = count.began;
  return ran;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

unsigned long long number(std::uint64_t x) { return x; }

void measure_broad_phase(const SceneKind& kind, const std::vector<BodyDescription<1>>& bodies, int rounds) {
  std::vector<PlacedShape> shapes;
  for (const auto& body : bodies) shapes.push_back(place(body.shape, body.orientation));
  struct Way {
    int k;
    ListedAxes listed;
    std::vector<double> ratios;
    Ran last;
  };
  std::vector<Way> ways;
  for (const ListedAxes listed : {ListedAxes::one, ListedAxes::all}) {
    for (const int k : kinds) ways.push_back({k, listed, {}, {}});
  }
  for (int round = 0; round < rounds; ++round) {
    double boxes = 0;
    for (Way& way : ways) {
      way.last = run_broad_phase(shapes, bodies, way.k, way.listed);
      const double whole = way.last.setup + way.last.run;
      if (&way == &ways.front()) boxes = whole;
      way.ratios.push_back(whole / boxes);
    }
  }
  for (const Way& way : ways) {
    const auto& work = way.last.work;
    std::printf("%s,%d,%s,%llu,%llu,%llu,%.2f\n", kind.name, way.k, way.listed == ListedAxes::one ? "one" : "all",
                number(work.broad_phase.swaps), number(work.broad_phase.certificates), number(work.pairs_begun),
                median(way.ratios));
  }
  std::fflush(stdout);
}

/// False where contacts differ.
bool measure_world(const SceneKind& kind, const std::vector<BodyDescription<1>>& bodies, Response response,
                   int rounds) {
  std::array<std::vector<double>, kinds.size()> setup, run;
  std::array<Ran, kinds.size()> last;
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < kinds.size(); ++i) {
      last[i] = run_world(bodies, kinds[i], response);
      if (last[i].contacts != last[0].contacts) return false;
      setup[i].push_back(last[i].setup / last[0].setup);
      run[i].push_back(last[i].run / last[0].run);
    }
  }
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    const auto& work = last[i].work;
    std::printf("%s,%s,%d,%llu,%llu,%llu,%llu,%.2f,%.2f\n", kind.name,
                response == Response::elastic ? "elastic" : "none", kinds[i], number(work.contacts),
                number(work.pairs_begun), number(work.pair_tests), number(work.broad_phase.swaps), median(setup[i]),
                median(run[i]));
  }
  std::fflush(stdout);
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  const int bodies = argc > 1 ? std::atoi(argv[1]) : 1000;
  const int rounds = argc > 2 ? std::atoi(argv[2]) : 5;
  if (bodies < 2 || rounds < 1) return std::fputs("usage: bench_kdops [BODIES [ROUNDS]]\n", stderr), 2;
  std::puts("broad phase alone,k,lists,swaps,certificates,pairs,time");
  for (const SceneKind& kind : scenes()) {
    measure_broad_phase(kind, make_bodies(kind, static_cast<std::size_t>(bodies)), rounds);
  }
  std::puts("\nworld,response,k,contacts,pairs,tests,swaps,set-up time,run time");
  for (const SceneKind& kind : scenes()) {
    for (const Response response : {Response::none, Response::elastic}) {
      if (measure_world(kind, make_bodies(kind, static_cast<std::size_t>(bodies)), response, rounds)) continue;
      std::fprintf(stderr, "bench_kdops: %s: contacts depend on k\n", kind.name);
      return 1;
    }
  }
}
