#include "collision/broad_phase/tuning.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

namespace kds::collision {
namespace {

void require(bool holds, const char* member, const char* what) {
  if (!holds) throw std::invalid_argument(std::string(member) + ": must be " + what);
}

void require_positive(double x, const char* member) { require(x > 0 && std::isfinite(x), member, "> 0 and finite"); }
void require_growth(double x, const char* member) { require(x >= 1 && std::isfinite(x), member, ">= 1 and finite"); }
void require_part(double x, const char* member) { require(x > 0 && x <= 1, member, "in (0, 1]"); }

/// Costs are products of these with numbers of pairs and bodies, in 64 bits.
constexpr std::uint64_t greatest_cost = 1 << 20;
void require_cost(std::uint64_t x, const char* member) {
  require(x > 0 && x <= greatest_cost, member, "in 1 ... 2^20");
}

}  // namespace

void check(const CellTuning& tuning) {
  require_growth(tuning.roominess, "CellTuning.roominess");
  require_positive(tuning.cell_per_spacing, "CellTuning.cell_per_spacing");
  require(tuning.crowded_chain >= 0 && tuning.crowded_chain <= 1 << 20, "CellTuning.crowded_chain", "in 0 ... 2^20");
  require(tuning.share_for_cells >= 4 && tuning.share_for_cells <= 1 << 20, "CellTuning.share_for_cells",
          "in 4 ... 2^20");
  require(tuning.guests_per_slab >= 0 && tuning.guests_per_slab <= 1 << 20, "CellTuning.guests_per_slab",
          "in 0 ... 2^20");
  require_cost(tuning.scanned_per_change, "CellTuning.scanned_per_change");
  require(tuning.patience > 0 && tuning.patience <= 1 << 20, "CellTuning.patience", "in 1 ... 2^20");
}

void check(const GridTuning& tuning) {
  check(tuning.cells);
  require_positive(tuning.first_travel, "GridTuning.first_travel");
  require_positive(tuning.least_travel, "GridTuning.least_travel");
  require_growth(tuning.grow_after_none, "GridTuning.grow_after_none");
  require_growth(tuning.grow_after_one, "GridTuning.grow_after_one");
  require_part(tuning.shrink_after_some, "GridTuning.shrink_after_some");
  require_part(tuning.shrink_after_many, "GridTuning.shrink_after_many");
  require_part(tuning.shrink_after_turn, "GridTuning.shrink_after_turn");
  require_cost(tuning.found_per_pair, "GridTuning.found_per_pair");
  require_cost(tuning.in_vain_per_box, "GridTuning.in_vain_per_box");
  require_part(tuning.kept_share_straight, "GridTuning.kept_share_straight");
  require_part(tuning.kept_share_curved, "GridTuning.kept_share_curved");
  require_cost(tuning.share_for_level, "GridTuning.share_for_level");
  require(tuning.jostled_at > 0, "GridTuning.jostled_at", "> 0");
  require(tuning.jostled_most >= 0 && tuning.jostled_most <= 100, "GridTuning.jostled_most", "in 0 ... 100");
  require_cost(tuning.tests_per_pair, "GridTuning.tests_per_pair");
  require_growth(tuning.grow_jostled, "GridTuning.grow_jostled");
  require_part(tuning.shrink_jostled, "GridTuning.shrink_jostled");
  require(tuning.lead >= 0 && tuning.lead < 1, "GridTuning.lead", "in [0, 1)");
}

void check(const FewBoxesTuning& tuning) {
  require_positive(tuning.first_travel, "FewBoxesTuning.first_travel");
  require_cost(tuning.comparisons_per_pair, "FewBoxesTuning.comparisons_per_pair");
  require_cost(tuning.comparisons_per_box, "FewBoxesTuning.comparisons_per_box");
  require(tuning.little <= tuning.much, "FewBoxesTuning.little", "at most FewBoxesTuning.much");
  require(tuning.much <= tuning.far_too_much, "FewBoxesTuning.much", "at most FewBoxesTuning.far_too_much");
  require_cost(tuning.far_too_much, "FewBoxesTuning.far_too_much");
  require_growth(tuning.grow, "FewBoxesTuning.grow");
  require_growth(tuning.grow_where_idle, "FewBoxesTuning.grow_where_idle");
  require_part(tuning.shrink, "FewBoxesTuning.shrink");
  require_cost(tuning.idle_part, "FewBoxesTuning.idle_part");
}

void check(const AdaptiveTuning& tuning) {
  check(tuning.few);
  check(tuning.grid);
  require(tuning.most_for_few <= most_few_boxes, "AdaptiveTuning.most_for_few", "at most 64");
}

void check(const SweepTuning& tuning) {
  switch (tuning.listed) {
    case ListedAxes::automatic:
    case ListedAxes::one:
    case ListedAxes::all:
      break;
    default:
      throw std::invalid_argument("SweepTuning.listed: unknown");
  }
  require_part(tuning.change_below, "SweepTuning.change_below");
}

}  // namespace kds::collision
