// The kinetic sorted list where numbers are many, large, small, equal or an ulp apart.
#include "kds/simulator.hpp"
#include "tests/structures/random_values.hpp"
#include "tests/structures/recorded_list.hpp"
#include "tests/support/exact_models.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

namespace test_stress_sorted_list {
namespace {

using namespace kds;
using namespace kds::tests;

template <int Degree>
using PlainList = structures::SortedList<Degree, PlainRecorder>;

template <int Degree>
std::vector<typename PlainList<Degree>::Entry> numbered(const std::vector<Motion<Degree>>& motions) {
  std::vector<typename PlainList<Degree>::Entry> entries;
  for (std::size_t i = 0; i < motions.size(); ++i) entries.push_back({motions[i], static_cast<std::uint32_t>(i)});
  return entries;
}

/// What is wrong with the three pairs around the swap that has just been made, exactly; empty if nothing.
///
/// A swap changes the order and the events there and nowhere else; what was right elsewhere stays right until its own
/// failure time, which was checked when it was set. So with whole audits before and after, looking around each swap is
/// looking at everything after every swap. It takes O(1) where a whole audit takes O(n).
template <int Degree>
std::string wrong_around(const PlainList<Degree>& list, const Swap& swap) {
  const auto entries = list.entries();
  const std::size_t left = list.position(swap.left);
  for (std::size_t i = left == 0 ? 0 : left - 1; i < std::min(left + 2, entries.size() - 1); ++i) {
    const auto at = " at place " + std::to_string(i);
    if (list.position(entries[i].id) != i) return "position" + at;
    const certificates::Order<Degree> order{entries[i].motion, entries[i + 1].motion};
    const double scheduled = list.queue().time(static_cast<Slot>(i));
    const bool due = scheduled <= swap.time;
    const int sign = sign_after(order, swap.time);
    if (due) continue;  // at this very time
    if (sign < 0 || (sign == 0 && entries[i].id > entries[i + 1].id)) return "order" + at;
    const double t = failure_time(order, swap.time);
    if ((scheduled != never) != (t != never)) return "missing or needless event" + at;
    if (scheduled != t) return "time" + at;
  }
  if (list.position(swap.left) + 1 != list.position(swap.right)) return "the swap itself";
  return {};
}

/// The exact order of ids at t+; for those equal for ever by id.
template <int Degree>
std::vector<std::uint32_t> exact_order(const std::vector<Motion<Degree>>& motions, double t) {
  std::vector<oracle::Value> values;
  for (const auto& m : motions) values.push_back({{m.position.c.begin(), m.position.c.end()}, m.start});
  std::vector<std::uint32_t> ids;
  for (const std::size_t i : oracle::order_after(values, t)) ids.push_back(static_cast<std::uint32_t>(i));
  return ids;
}

/// All events up to `end`, checked: around every swap, and against the exact order at each time.
template <int Degree>
std::vector<Swap> run_checked(const std::vector<Motion<Degree>>& motions, double end) {
  std::vector<Swap> log;
  PlainList<Degree> list(PlainRecorder{&log});
  list.assign(numbered<Degree>(motions), 0);
  list.audit(0);
  REQUIRE(ids(list) == exact_order<Degree>(motions, 0));
  Simulator simulator(0, list);
  while (simulator.step(end)) {
    const std::string wrong = log.empty() ? "" : wrong_around<Degree>(list, log.back());
    if (!wrong.empty()) FAIL(wrong << " after swap " << log.size());
    if (simulator.next_time() > simulator.now()) {
      simulator.audit();
      const bool right = ids(list) == exact_order<Degree>(motions, simulator.now());
      if (!right) FAIL("order at " << simulator.now());
    }
  }
  simulator.advance_to(end);
  simulator.audit();
  REQUIRE(ids(list) == exact_order<Degree>(motions, end));
  return log;
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("stress: a hundred thousand random elements, checked exactly around every swap",
                       "[sorted_list][stress]", ((int Degree), Degree), 1, 2) {
  constexpr std::size_t n = 100'000;
  constexpr std::size_t swaps = 20'000;
  const std::uint64_t seed = 500 + Degree;
  CAPTURE(seed);
  Random random(seed);
  std::vector<Motion<Degree>> motions(n);
  for (auto& m : motions) m = random_motion<Degree>(random, Kind::generic, 0);
  std::vector<Swap> log;
  PlainList<Degree> list(PlainRecorder{&log});
  list.assign(numbered<Degree>(motions), 0);
  list.audit(0);
  Simulator simulator(0, list);
  std::string wrong;
  while (log.size() < swaps && wrong.empty() && simulator.step()) {
    wrong = wrong_around<Degree>(list, log.back());
    if (log.size() == swaps / 2) simulator.audit();
  }
  CHECK(wrong == "");
  CHECK(log.size() == swaps);
  simulator.audit();  // every pair, and every failure time
}

TEST_CASE("stress: every element of a lattice of lines meets every other at one instant", "[sorted_list][stress]") {
  // 200 lines through one point: 19 900 swaps at t = 1, each one necessary.
  std::vector<Motion<1>> lines;
  for (int i = 0; i < 200; ++i) lines.push_back({{{7.0 - i, 1.0 * i}}, 0});
  std::reverse(lines.begin(), lines.end());
  const auto log = run_checked<1>(lines, 2);
  CHECK(log.size() == 200 * 199 / 2);
  CHECK(std::all_of(log.begin(), log.end(), [](const Swap& s) { return s.time == 1; }));
}

TEST_CASE("stress: a grid of lines, hundreds of times at which hundreds swap", "[sorted_list][stress]") {
  // Places 0 ... 15, speeds 0 ... 7: all meetings at fractions of small integers, most of them shared.
  std::vector<Motion<1>> lines;
  for (int place = 0; place < 16; ++place) {
    for (int speed = 0; speed < 8; ++speed) lines.push_back({{{1.0 * place, 1.0 * speed}}, 0});
  }
  const auto log = run_checked<1>(lines, 100);
  // Each pair with a lower place and a higher speed swaps once, and those that start as one are in order at once.
  CHECK(log.size() == (16 * 15 / 2) * (8 * 7 / 2));
  // Parabolas that meet in a lattice, touch and are one.
  std::vector<Motion<2>> parabolas;
  for (int a = -2; a <= 2; ++a) {
    for (int b = -2; b <= 2; ++b) {
      for (int c = -2; c <= 2; ++c) parabolas.push_back({{{1.0 * a, 1.0 * b, 0.5 * c}}, 0});
    }
  }
  parabolas.insert(parabolas.end(), parabolas.begin(), parabolas.begin() + 20);
  CHECK(run_checked<2>(parabolas, 20).size() > 1000);
}

TEST_CASE("stress: lines that cross at an angle of 1e-15", "[sorted_list][stress]") {
  // Near parallel: speeds differ by an ulp or a few. All cross, at times that the places decide; exactly once each.
  const std::uint64_t seed = 510;
  CAPTURE(seed);
  Random random(seed);
  std::vector<Motion<1>> lines;
  double speed = 1;
  for (int i = 0; i < 70; ++i) {
    lines.push_back({{{random.between(0, 1e-13), speed}}, 0});
    speed = next_up(speed);
  }
  const auto log = run_checked<1>(lines, 1e9);
  // In the end they stand by speed.
  std::vector<std::uint32_t> final(lines.size());
  std::iota(final.begin(), final.end(), 0u);
  CHECK(exact_order<1>(lines, 1e9) == final);
  CHECK(log.size() > 500);
}

TEST_CASE("stress: parabolas that touch with discriminant 0 and an ulp to either side", "[sorted_list][stress]") {
  // x = (t - m)^2 + gap against 0, as coefficients. Exactly 0: a touch, no event. An ulp below: two swaps, or none if
  // the dip falls between two doubles, which the exact signs at those tell. An ulp above: nothing.
  int crossed = 0;
  int touched = 0;
  const std::uint64_t seed = 520;
  CAPTURE(seed);
  Random random(seed);
  for (int round = 0; round < 400; ++round) {
    const double m = random.integer(1, 1 << 20) * 0x1p-16;  // squares are exact
    const double c0 = m * m;
    for (const int ulps : {-1, 0, 1}) {
      const double shifted = ulps < 0 ? next_down(c0) : (ulps > 0 ? next_up(c0) : c0);
      const std::vector<Motion<2>> motions{{{{0, 0, 0}}, 0}, {{{shifted, -2 * m, 1}}, 0}};
      const auto log = run_checked<2>(motions, 4 * m + 1);
      const bool dips = ulps < 0;
      if (!dips && !log.empty()) FAIL("a swap without crossing, m = " << m << ", ulps " << ulps);
      if (dips && log.size() != 2) FAIL(log.size() << " swaps where two are right, m = " << m);
      if (dips) {
        // sqrt(ulp) to either side of m.
        const double half = std::sqrt(c0 - shifted);
        const bool placed =
            std::abs(log[0].time - (m - half)) <= 1e-15 * m && std::abs(log[1].time - (m + half)) <= 1e-15 * m;
        if (!placed) FAIL("swaps at " << log[0].time << " and " << log[1].time << ", m = " << m);
      }
      crossed += dips;
      touched += !dips;
    }
  }
  CHECK(crossed == 400);
  CHECK(touched == 800);
}

TEST_CASE("stress: motions change exactly at event times", "[sorted_list][stress]") {
  const std::uint64_t seed = 530;
  CAPTURE(seed);
  Random random(seed);
  for (int round = 0; round < 12; ++round) {
    const Kind kind = all_kinds[static_cast<std::size_t>(round) % all_kinds.size()];
    CAPTURE(round, static_cast<int>(kind));
    const double begin = beginning(kind);
    std::vector<Motion<2>> motions(60);
    for (auto& m : motions) m = random_motion<2>(random, kind, begin);
    std::vector<Swap> log;
    PlainList<2> list(PlainRecorder{&log});
    list.assign(numbered<2>(motions), begin);
    Simulator simulator(begin, list);
    std::size_t edits = 0;
    for (int event = 0; event < 200 && simulator.step(); ++event) {
      const double now = simulator.now();
      if (simulator.next_time() == now) continue;  // amidst: test_sorted_list.cpp
      // Of those that have just met: one turns round, the other jumps, or takes up the same motion.
      for (const std::uint32_t id : {log.back().left, log.back().right, static_cast<std::uint32_t>(random.below(60))}) {
        Motion<2> changed = restarted(motions[id], now);
        switch (random.below(4)) {
          case 0:
            changed.position.c[1] = -changed.position.c[1];
            break;
          case 1:
            changed = random_motion<2>(random, kind, now);
            break;
          case 2:
            changed = motions[random.below(60)];
            break;
          default:
            break;
        }
        motions[id] = changed;
        list.update(id, changed, now);
        ++edits;
      }
      list.audit(now);
      const bool right = simulator.next_time() <= now || ids(list) == exact_order<2>(motions, now);
      if (!right) FAIL("order after changes at " << now);
    }
    if (kind != Kind::resting && kind != Kind::coarse) CHECK(edits > 10);
  }
}

TEMPLATE_TEST_CASE_SIG("stress: numbers all subnormal, huge, equal, or of all sizes", "[sorted_list][stress]",
                       ((int Degree), Degree), 1, 2) {
  const std::uint64_t seed = 540 + Degree;
  CAPTURE(seed);
  Random random(seed);
  const double least = std::numeric_limits<double>::denorm_min();
  const auto subnormal = [&] { return random.integer(-40, 40) * least; };
  const auto huge = [&] { return random.between(-1e300, 1e300); };
  const auto equal = [&] { return 0.1; };
  const auto any_size = [&] { return random.scaled(-1000, 990); };
  std::size_t swaps = 0;
  const auto check = [&](const char* what, const auto& number, double end) {
    CAPTURE(what);
    std::vector<Motion<Degree>> motions(Degree == 1 ? 24 : 12);
    for (auto& m : motions) {
      for (double& c : m.position.c) c = number();
    }
    swaps += run_checked<Degree>(motions, end).size();
  };
  for (int round = 0; round < 1; ++round) {
    check("subnormal", subnormal, 100);
    check("huge", huge, 1e3);
    check("equal", equal, 1e3);
    check("any size", any_size, 1e300);
  }
  CHECK(swaps > 20);
  // Starts, too.
  std::vector<Motion<Degree>> motions(24);
  for (auto& m : motions) {
    for (double& c : m.position.c) c = subnormal();
    m.start = subnormal();
  }
  run_checked<Degree>(motions, 100);
}

}  // namespace test_stress_sorted_list
