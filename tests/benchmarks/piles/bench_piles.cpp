// Piles of balls that come to rest: this engine, exact, beside Bullet's rigid bodies at 240 frames a second.
//
//     bench_piles [DIRECTORY [SECONDS]]     default build/bench, 120; writes piles.csv
//
// 20, 200 and 2 000 balls fall into a box, 100 through a hopper; 20 s are simulated in all. A run that takes more than
// SECONDS of the processor is stopped, and `reached` says where. Energies are in parts of that at the start, seen from
// the floor; a pile rests from when its kinetic energy stays below 1e-12 of that.

#include "tests/benchmarks/csv_file.hpp"
#include "tests/benchmarks/piles/pile.hpp"

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>

namespace {

using namespace piles;
using kds::benchmarks::tell;

void row(std::ofstream& csv, const Pile& pile, const char* engine, const Outcome& outcome) {
  tell(csv, "%s,%s,%.3f,%.3f,%.1f,%.2f,%.2e,%.2e\n", pile.name.c_str(), engine, outcome.seconds,
       outcome.seconds_to_rest, outcome.rest, outcome.reached, outcome.overlap, outcome.kinetic);
}

}  // namespace

int main(int argc, char** argv) try {
  const std::filesystem::path folder = argc > 1 ? argv[1] : "build/bench";
  const double most_seconds = argc > 2 ? std::atof(argv[2]) : 120;
  if (!(most_seconds > 0) || argc > 3) return std::fputs("usage: bench_piles [DIRECTORY [SECONDS]]\n", stderr), 2;
  std::ofstream csv = kds::benchmarks::open_csv(folder, "piles.csv");
  tell(csv, "scene,engine,cpu_s,cpu_s_until_rest,rests_at_s,reached_s,deepest_overlap,kinetic_energy_at_end\n");
  for (const Pile& pile : {make_pile(20, 6, 1), make_pile(200, 6, 6), make_hopper(100), make_pile(2000, 14, 14)}) {
    row(csv, pile, "kds", run_world(pile, most_seconds));
#ifdef KDS_PEER_BULLET
    row(csv, pile, "Bullet", run_bullet(pile, most_seconds));
#endif
  }
} catch (const std::exception& failure) {
  std::fprintf(stderr, "bench_piles: %s\n", failure.what());
  return 1;
}
