// Run time against error of everything that finds the time at which a polynomial turns negative.
//
//     bench_roots [DIRECTORY [POLYNOMIALS [ROUNDS [SEED]]]]     -> roots.csv, roots-summary.csv, roots.md, ...
//
// Degrees 1 to 8, every family of families.hpp, every contender of contenders.hpp, horizons infinite, finite and at the
// crossing. The truth comes from exact arithmetic (truth.hpp), the verdicts from judge.hpp, the times from the CPU
// clock of the thread. About two minutes.

#include "tests/benchmarks/roots/measure.hpp"
#include "tests/benchmarks/roots/report.hpp"

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <utility>

namespace {

using namespace bench_roots;

template <int Degree>
void measure_degree(std::vector<Cell>& cells, const Options& options) {
  std::printf("degree %d:", Degree);
  for (const Family& family : families()) {
    if (Degree < family.least_degree) continue;
    std::printf(" %s", family.name);
    std::fflush(stdout);
    for (Cell& cell : measure<Degree>(family, options)) cells.push_back(std::move(cell));
  }
  std::printf("\n");
}

}  // namespace

int main(int argc, char** argv) try {
  const std::filesystem::path folder = argc > 1 ? argv[1] : ".";
  Options options;
  if (argc > 2) options.polynomials = std::max(1, std::atoi(argv[2]));
  if (argc > 3) options.rounds = std::max(1, std::atoi(argv[3]));
  if (argc > 4) options.seed = std::strtoull(argv[4], nullptr, 10);
  std::filesystem::create_directories(folder);

  std::vector<Cell> cells;
  [&]<int... Less>(std::integer_sequence<int, Less...>) { (measure_degree<Less + 1>(cells, options), ...); }
  (std::make_integer_sequence<int, greatest_degree>{});

  const std::vector<Summary> rows = summarise(cells);
  write_cells(folder / "roots.csv", cells);
  write_summary(folder / "roots-summary.csv", rows);
  write_tables(folder / "roots.md", rows);
  write_families(folder / "roots-families.md", cells);
  std::printf("written: roots.csv roots-summary.csv roots.md roots-families.md in %s\n", folder.c_str());

  bool broken = false;
  for (const Summary& row : rows) {
    const std::size_t wrong = row.tally.wrong() + row.edge.wrong();
    const std::size_t unenclosed = row.tally.unenclosed + row.edge.unenclosed;
    if (!row.certified || wrong + unenclosed == 0) continue;
    std::fprintf(stderr,
                 "bench_roots: %s, degree %d, is certified, and gave %zu wrong answers and %zu wrong enclosures\n",
                 row.solver.c_str(), row.degree, wrong, unenclosed);
    broken = true;
  }
  return broken ? 1 : 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "bench_roots: %s\n", error.what());
  return 1;
}
