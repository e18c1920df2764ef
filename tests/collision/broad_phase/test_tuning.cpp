// Whatever the tuning, broad phases find the same overlaps; only what that costs is another.
#include "collision/broad_phase/tuning.hpp"

#include "collision/broad_phase/adaptive_broad_phase.hpp"
#include "collision/broad_phase/kinetic_sweep_and_prune.hpp"
#include "tests/collision/broad_phase/broad_phase_stress.hpp"
#include "tests/collision/broad_phase/kept_boxes.hpp"

#include <catch2/catch.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace kds::collision::test_tuning {
namespace {

using namespace tests;

/// A run of random changes, at the end of each of which all pairs that overlap are known (and no others, if exact).
template <int Degree>
BroadPhaseCounters run(std::unique_ptr<BroadPhase<Degree>> broad_phase, std::size_t bodies) {
  Stress<Degree> stress(17, false, std::move(broad_phase));
  stress.side = 8;
  stress.insert(bodies);
  for (int round = 0; round < 20; ++round) {
    stress.advance(stress.now + stress.random.between(0, 0.5));
    stress.compare_with_brute_force();
    for (int i = 0; i < 4; ++i) stress.update();
    if (stress.random.one_in(5)) stress.insert(1);
    if (stress.random.one_in(5)) stress.remove();
    stress.compare_with_brute_force();
  }
  return stress.broad_phase.counters();
}

template <class Tuning>
using Change = std::function<void(Tuning&)>;

template <class Tuning>
std::vector<Tuning> all_of(const std::vector<Change<Tuning>>& changes) {
  std::vector<Tuning> tunings(changes.size() + 1);
  for (std::size_t i = 0; i < changes.size(); ++i) changes[i](tunings[i]);
  for (const auto& change : changes) change(tunings.back());
  return tunings;
}

const std::vector<Change<GridTuning>> other_grids{
    [](GridTuning& t) { t.cells.roominess = 1; },
    [](GridTuning& t) { t.cells.cell_per_spacing = 0.2; },
    [](GridTuning& t) { t.cells.crowded_chain = 0, t.cells.patience = 1; },
    [](GridTuning& t) { t.first_travel = 4; },
    [](GridTuning& t) { t.least_travel = 1; },
    [](GridTuning& t) { t.grow_after_none = t.grow_after_one = 3; },
    [](GridTuning& t) { t.shrink_after_some = t.shrink_after_many = 0.1, t.many = 4; },
    [](GridTuning& t) { t.shrink_after_turn = 0.1; },
    [](GridTuning& t) { t.kept_share_straight = t.kept_share_curved = 0.01; },
    [](GridTuning& t) { t.share_for_level = 1; },
    [](GridTuning& t) { t.jostled_at = 1, t.jostled_most = 40; },
    [](GridTuning& t) { t.tests_per_pair = 1, t.little_spent = 1000, t.much_spent = 2000, t.jostled_at = 1; },
    [](GridTuning& t) { t.grow_jostled = 3, t.shrink_jostled = 0.1, t.jostled_at = 1; },
    [](GridTuning& t) { t.lead = 0, t.jostled_at = 1; },
};

const std::vector<Change<FewBoxesTuning>> other_few_boxes{
    [](FewBoxesTuning& t) { t.first_travel = 0.01; },
    [](FewBoxesTuning& t) { t.comparisons_per_pair = 200; },
    [](FewBoxesTuning& t) { t.comparisons_per_box = 1; },
    [](FewBoxesTuning& t) { t.little = t.much = t.far_too_much = 1; },
    [](FewBoxesTuning& t) { t.grow = 8, t.grow_where_idle = 20, t.shrink = 0.1; },
    [](FewBoxesTuning& t) { t.idle_part = 1; },
};

TEMPLATE_TEST_CASE_SIG("The tuning of broad phases changes what they cost and not what they find", "[broad_phase]",
                       ((int Degree), Degree), 1, 2) {
  std::size_t differ = 0;
  const auto grid = run<Degree>(with_boxes<KineticGrid, Degree>(), 12);
  for (const GridTuning& tuning : all_of(other_grids)) {
    INFO("grid " << differ);
    differ += run<Degree>(with_boxes<KineticGrid, Degree>(std::size_t{1}, tuning), 12) != grid;
  }
  CHECK(differ > other_grids.size() / 2);

  differ = 0;
  const auto few = run<Degree>(std::make_unique<FewBoxes<Degree>>(), 12);
  for (const FewBoxesTuning& tuning : all_of(other_few_boxes)) {
    INFO("few boxes " << differ);
    differ += run<Degree>(std::make_unique<FewBoxes<Degree>>(tuning), 12) != few;
  }
  CHECK(differ > other_few_boxes.size() / 2);

  const auto chosen = run<Degree>(with_boxes<AdaptiveBroadPhase, Degree>(), 12);
  AdaptiveTuning adaptive;
  adaptive.most_for_few = 8;
  adaptive.grid.first_travel = 4;
  CHECK(run<Degree>(with_boxes<AdaptiveBroadPhase, Degree>(std::size_t{1}, adaptive), 12) != chosen);

  const auto lists = run<Degree>(std::make_unique<KineticSweepAndPrune<Degree>>(0), 12);
  for (const SweepTuning& tuning :
       {SweepTuning{.few_bodies = 10}, SweepTuning{.listed = ListedAxes::one, .change_below = 1}}) {
    CHECK(run<Degree>(std::make_unique<KineticSweepAndPrune<Degree>>(0, tuning), 12) != lists);
  }
}

/// What is thrown for a tuning with one member out of range names that member.
template <class Tuning>
void require_refused(const Change<Tuning>& change, const std::string& member) {
  Tuning tuning;
  CHECK_NOTHROW(check(tuning));
  change(tuning);
  CHECK_THROWS_WITH(check(tuning), Catch::StartsWith(member + ": "));
}

TEST_CASE("A tuning that is out of range is refused by name", "[broad_phase]") {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  require_refused<CellTuning>([](auto& t) { t.roominess = 0.99; }, "CellTuning.roominess");
  require_refused<CellTuning>([](auto& t) { t.cell_per_spacing = nan; }, "CellTuning.cell_per_spacing");
  require_refused<CellTuning>([](auto& t) { t.patience = 0; }, "CellTuning.patience");
  require_refused<GridTuning>([](auto& t) { t.cells.crowded_chain = -1; }, "CellTuning.crowded_chain");
  require_refused<CellTuning>([](auto& t) { t.guests_per_slab = -1; }, "CellTuning.guests_per_slab");
  require_refused<CellTuning>([](auto& t) { t.share_for_cells = 3; }, "CellTuning.share_for_cells");
  require_refused<CellTuning>([](auto& t) { t.scanned_per_change = 0; }, "CellTuning.scanned_per_change");
  require_refused<GridTuning>([](auto& t) { t.first_travel = 0; }, "GridTuning.first_travel");
  require_refused<GridTuning>([](auto& t) { t.shrink_after_many = 0; }, "GridTuning.shrink_after_many");
  require_refused<GridTuning>([](auto& t) { t.found_per_pair = 0; }, "GridTuning.found_per_pair");
  require_refused<GridTuning>([](auto& t) { t.share_for_level = 0; }, "GridTuning.share_for_level");
  require_refused<GridTuning>([](auto& t) { t.lead = 1; }, "GridTuning.lead");
  require_refused<FewBoxesTuning>([](auto& t) { t.little = 4; }, "FewBoxesTuning.little");
  require_refused<FewBoxesTuning>([](auto& t) { t.shrink = 1.5; }, "FewBoxesTuning.shrink");
  require_refused<AdaptiveTuning>([](auto& t) { t.most_for_few = 65; }, "AdaptiveTuning.most_for_few");
  require_refused<SweepTuning>([](auto& t) { t.change_below = 0; }, "SweepTuning.change_below");
  require_refused<SweepTuning>([](auto& t) { t.listed = static_cast<ListedAxes>(9); }, "SweepTuning.listed");
  GridTuning tuning;
  tuning.lead = -1;
  CHECK_THROWS_AS(KineticGrid<1>(nullptr, 1, tuning), std::invalid_argument);
}

}  // namespace
}  // namespace kds::collision::test_tuning
