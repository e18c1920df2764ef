// Is the default ever worse than the best method? Scenes of all kinds: each property varied about a centre, and a
// random sample of combinations.
#include "tests/benchmarks/csv_file.hpp"
#include "tests/benchmarks/speed/methods.hpp"
#include "tests/benchmarks/speed/race.hpp"
#include "tests/benchmarks/speed/report.hpp"
#include "tests/support/random_numbers.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <iterator>
#include <string>
#include <vector>

namespace speed {
namespace {

using kds::benchmarks::open_csv;
using kds::benchmarks::tell;
using kds::tests::Random;

struct Cell {
  SceneOptions scene;
  double rate = 60;  ///< Hz
};

constexpr std::size_t bodies[] = {10, 100, 1000, 10'000};
constexpr std::size_t most_bodies = 100'000;
constexpr double packings[] = {0.001, 0.01, 0.1, 0.25};
constexpr double rates[] = {1, 60, 1000};
constexpr double size_spreads[] = {1, 10, 1000};
constexpr double speed_spreads[] = {1, 100};
constexpr double at_rest[] = {0, 0.5, 0.95};
constexpr Flatness flatness[] = {Flatness::cube, Flatness::slab, Flatness::line};

Cell centre() {
  Cell cell;
  cell.scene.draw = Draw::logarithmic;
  cell.scene.size_spread = cell.scene.speed_spread = 1;
  cell.scene.seed = 7;
  return cell;
}

std::string name(const Cell& cell) {
  char text[160];
  std::snprintf(text, sizeof text, "n=%zu %g%% %gHz sizes 1:%g speeds 1:%g rest %g %s", cell.scene.bodies,
                100 * cell.scene.packing, cell.rate, cell.scene.size_spread, cell.scene.speed_spread,
                cell.scene.at_rest, name(cell.scene.flatness));
  return text;
}

/// The centre, and each property at each of its other values.
std::vector<Cell> star(bool quick) {
  std::vector<Cell> cells;
  const auto vary = [&](auto change) {
    Cell cell = centre();
    change(cell);
    const bool known = std::any_of(cells.begin(), cells.end(), [&](const Cell& c) { return name(c) == name(cell); });
    if (!known) cells.push_back(cell);
  };
  for (const std::size_t n : bodies) vary([&](Cell& c) { c.scene.bodies = n; });
  if (!quick) vary([&](Cell& c) { c.scene.bodies = most_bodies; });
  for (const double x : packings) vary([&](Cell& c) { c.scene.packing = x; });
  for (const double x : rates) vary([&](Cell& c) { c.rate = x; });
  for (const double x : size_spreads) vary([&](Cell& c) { c.scene.size_spread = x; });
  for (const double x : speed_spreads) vary([&](Cell& c) { c.scene.speed_spread = x; });
  for (const double x : at_rest) vary([&](Cell& c) { c.scene.at_rest = x; });
  for (const Flatness x : flatness) vary([&](Cell& c) { c.scene.flatness = x; });
  return cells;
}

Cell random_cell(Random& random) {
  const auto pick = [&](const auto& values) { return values[random.below(std::size(values))]; };
  Cell cell = centre();
  cell.scene.bodies = pick(bodies);
  cell.scene.packing = pick(packings);
  cell.rate = pick(rates);
  cell.scene.size_spread = pick(size_spreads);
  cell.scene.speed_spread = pick(speed_spreads);
  cell.scene.at_rest = pick(at_rest);
  cell.scene.flatness = pick(flatness);
  cell.scene.seed = random.bits();
  return cell;
}

/// The default over the best of the other methods.
struct CellRatio {
  std::string cell;
  std::string best;
  Ratio total;
  double run;  ///< set-up aside, over the least run of the others
};

CellRatio measure(const Cell& cell, const Settings& settings, std::ofstream& file) {
  const BallScene scene = make_scene(cell.scene);
  Drive drive{cell.rate, 1};
  std::vector<Entrant> entrants;
  for (const Method& m : methods()) {
    if (scene.balls.size() > m.most_bodies) continue;
    entrants.push_back({m.name, [&scene, &drive, &m] { return to_run(run_method(scene, m, drive)); }});
  }
  RaceOptions options = settings.quick ? single_round : RaceOptions{};
  options.least = 0.01;  // so that all have their turns within a short time
  const auto results = race(entrants, options);
  check_agreement(results, name(cell));

  const Result& ours = results.front();
  CellRatio worst{name(cell), "", {0, 0, 0}, 0};
  for (const Result& r : results) {
    if (&r == &ours || r.cut) continue;
    const Ratio total = ratio(ours, r);
    if (total.median > worst.total.median) worst.best = r.name, worst.total = total;
    worst.run = std::max(worst.run, ratio(ours, r, &Round::run).median);
  }
  for (const Result& r : results) {
    const auto& counters = r.best.counters;
    const auto number = [](std::uint64_t x) { return static_cast<unsigned long long>(x); };
    tell(file, "%zu,%.4g,%g,%g,%g,%g,%s,%s,%.7f,%.7f,%.3f,%llu,%llu,%llu,%llu,%llu,%d\n", cell.scene.bodies,
         scene.packing, cell.rate, cell.scene.size_spread, cell.scene.speed_spread, cell.scene.at_rest,
         name(cell.scene.flatness), r.name.c_str(), r.best.setup, r.best_run, ratio(r, ours).median,
         number(r.best.events), number(r.best.contacts), number(counters.broad_phase.swaps), number(r.best.tests),
         number(counters.broad_phase.box_updates), r.cut);
  }
  return worst;
}

}  // namespace

std::vector<Target> measure_cells(const Settings& settings) {
  const auto begin = std::chrono::steady_clock::now();
  const auto seconds = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(); };
  auto file = open_csv(settings.folder, "speed-cells.csv");
  tell(file,
       "bodies,packing,rate,size_spread,speed_spread,at_rest,flatness,method,setup_cpu,run_cpu,ratio_to_default,"
       "events,contacts,swaps,tests,box_updates,cut\n");
  std::vector<CellRatio> ratios;
  for (const Cell& cell : star(settings.quick)) ratios.push_back(measure(cell, settings, file));
  constexpr std::uint64_t seed = 20061;
  Random random(seed);
  const std::size_t most_cells = settings.quick ? ratios.size() + 4 : 200;
  while (ratios.size() < most_cells && seconds() < settings.cells_seconds) {
    ratios.push_back(measure(random_cell(random), settings, file));
  }

  std::sort(ratios.begin(), ratios.end(),
            [](const CellRatio& x, const CellRatio& y) { return x.total.median < y.total.median; });
  auto sorted = open_csv(settings.folder, "speed-ratios.csv");
  sorted << "rank,total,low,high,run,best,cell\n";
  for (std::size_t i = 0; i < ratios.size(); ++i) {
    const auto& [cell, best, total, run] = ratios[i];
    sorted << i + 1 << ',' << total.median << ',' << total.low << ',' << total.high << ',' << run << ',' << best << ','
           << cell << '\n';
  }
  constexpr double wanted = 1.15;
  const auto within =
      std::count_if(ratios.begin(), ratios.end(), [](const CellRatio& r) { return r.total.median <= wanted; });
  std::printf("\n%zu cells in %.0f s; default within %g of the best other in %td. The worst:\n", ratios.size(),
              seconds(), wanted, within);
  for (std::size_t i = ratios.size() - std::min<std::size_t>(10, ratios.size()); i < ratios.size(); ++i) {
    const auto& [cell, best, total, run] = ratios[i];
    std::printf("  %.3f in %.3f ... %.3f (run alone %.3f) of %s  %s\n", total.median, total.low, total.high, run,
                best.c_str(), cell.c_str());
  }
  return {{"auto over the best method: worst cell", ratios.back().total.median, '<', wanted, "x"},
          {"auto over the best method: share of cells within 1.15",
           static_cast<double>(within) / static_cast<double>(ratios.size()), '>', 1, ""}};
}

}  // namespace speed
