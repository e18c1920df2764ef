#include "tests/fuzz/random_worlds/way.hpp"

#include "tests/support/random_numbers.hpp"

#include <algorithm>
#include <array>
#include <sstream>

namespace kds::fuzz {
namespace {

using kds::tests::Random;

std::string_view name_of(BroadPhaseKind kind) {
  const auto& all = collision::broad_phases;
  return std::find_if(all.begin(), all.end(), [&](const auto& each) { return each.kind == kind; })->name;
}

/// A snapshot of a world that reports pairs is loaded only by one whose broad phase is exact just as well.
bool may_load(const Scenario& scenario, BroadPhaseKind saved, BroadPhaseKind loading) {
  using enum BroadPhaseKind;
  return !scenario.report_pairs || (saved == kinetic_sap) == (loading == kinetic_sap);
}

}  // namespace

std::string Way::name() const {
  std::ostringstream out;
  out << name_of(broad_phase);
  if (window != never) out << ", window " << window;
  if (threads != 1) out << ", " << threads << " threads";
  if (kdop != 6) out << ", k-DOPs of " << kdop;
  if (stops != 0) out << ", " << stops << " stops";
  if (budgets) out << ", for budgets";
  if (save_every != 0) out << ", saved every " << save_every << " steps";
  if (saves_between_calls) out << ", saved before each call";
  if (runs_ahead) out << ", with steps undone";
  if (!runs_ahead && (save_every != 0 || saves_between_calls)) out << " into " << name_of(load_into);
  if (audits) out << ", audited";
  if (growth != 1) out << ", shapes too large";
  return out.str();
}

Way reference_way(const Scenario& /*scenario*/) { return {}; }

std::vector<Way> ways_of(const Scenario& scenario) {
  using enum BroadPhaseKind;
  Random random(scenario.seed ^ 0x5851f42d4c957f2du);  // other numbers than those of the scenario
  constexpr std::array plain{automatic, grid, kinetic_sap};
  std::vector<Way> ways;
  const bool many = scenario.bodies.size() > Way::most_bodies_saved_often;
  for (const BroadPhaseKind kind : plain) ways.push_back({.broad_phase = kind, .audits = !many && random.one_in(8)});
  if (random.one_in(4)) ways.push_back({.broad_phase = sap, .rate = random.one_in(2) ? 8 : 1.7});

  Way varied{.broad_phase = plain[random.below(plain.size())]};
  const std::array windows{0.37, 0.125, many ? 0.03 : 0.004, 5.0};
  switch (random.below(6)) {
    case 0:
      varied.broad_phase = all_pairs;
      [[fallthrough]];
    case 1:
      varied.window = windows[random.below(windows.size())];
      break;
    case 2:
      varied.broad_phase = all_pairs;
      [[fallthrough]];
    case 3:
      varied.stops = random.integer(1, 9);
      break;
    case 4:
      varied.threads = 2;
      break;
    default:
      if (scenario.report_pairs) break;  // the pairs of k-DOPs are others
      varied.broad_phase = kinetic_sap;
      varied.kdop = std::array{14, 18, 26}[random.below(3)];
  }
  varied.budgets = random.one_in(2);
  ways.push_back(varied);

  constexpr std::array all{all_pairs, automatic, grid, kinetic_sap, sap};
  if (scenario.may_be_saved) {
    Way saved{.broad_phase = all[random.below(all.size())]};
    if (random.one_in(2)) saved.save_every = static_cast<std::size_t>(random.one_in(3) ? 1 : random.integer(2, 9));
    if (many) saved.save_every *= 50;
    saved.saves_between_calls = saved.save_every == 0 || random.one_in(2);
    saved.load_into = all[random.below(all.size())];
    if (!may_load(scenario, saved.broad_phase, saved.load_into)) saved.load_into = saved.broad_phase;
    saved.runs_ahead = random.one_in(3);
    saved.budgets = random.one_in(3);
    ways.push_back(saved);
  }
  return ways;
}

}  // namespace kds::fuzz
