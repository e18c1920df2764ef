// The kinetic sorted list against the exact order of its motions, at every event and between events.
#include "kds/events/calendar_queue.hpp"
#include "kds/events/dary_queue.hpp"
#include "kds/events/pairing_queue.hpp"
#include "kds/events/place_queue.hpp"
#include "kds/simulator.hpp"
#include "tests/structures/random_values.hpp"
#include "tests/structures/recorded_list.hpp"
#include "tests/structures/rule_list.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cfenv>
#include <cmath>
#include <limits>
#include <ostream>
#include <stdexcept>
#include <vector>

namespace test_sorted_list {
namespace {

using namespace kds;
using namespace kds::tests;

/// Runs random changes and advances; returns the swaps. What is checked does not depend on the window, nor on the queue
/// of a list made of a rule, and neither may the swaps.
template <int Degree, class L>
Log run(std::uint64_t seed, Kind kind, std::size_t most, int steps, double window) {
  Random random(seed);
  Log log;
  L list(Recorder{&log});
  Model<Degree> model;
  double now = beginning(kind);
  for (std::size_t i = 0; i < most / 2; ++i) {
    model.motions[static_cast<std::uint32_t>(2 * i)] = random_motion<Degree>(random, kind, now);
  }
  std::vector<typename L::Entry> entries;
  for (const auto& [id, motion] : model.motions) entries.push_back({motion, id});
  list.assign(entries, now);
  Simulator simulator(now, list);
  if (window < never) simulator.set_window(window);
  require_order(list, model, now);
  REQUIRE(log.empty());
  for (int step = 0; step < steps; ++step) {
    const double target = now + random_delay(random, kind);
    const bool look_before = random.one_in(4);
    while (true) {
      const double next = simulator.next_time();
      // Up to the very last double before an event the old order is right.
      if (look_before && next <= target && next_down(next) >= simulator.now()) {
        require_order(list, model, next_down(next));
      }
      if (!simulator.step(target)) break;
      simulator.audit();
      if (simulator.next_time() > simulator.now()) require_order(list, model, simulator.now());
      REQUIRE(log.size() < 100000);
    }
    simulator.advance_to(target);
    now = target;
    require_order(list, model, now);
    apply(random_change(random, kind, now, most, model), list, now);
    list.audit(now);
    require_order(list, model, now);
  }
  REQUIRE(list.size() == model.motions.size());
  return log;
}

constexpr double no_window = never;

}  // namespace

TEMPLATE_TEST_CASE_SIG("a kinetic sorted list is in the exact order of its motions, whatever the horizon or the queue",
                       "[sorted_list]", ((int Degree), Degree), 1, 2, 3) {
  for (const Kind kind : all_kinds) {
    for (std::uint64_t seed = 200; seed < 204; ++seed) {
      CAPTURE(Degree, static_cast<int>(kind), seed);
      const std::size_t most = 3 + 5 * (seed % 4);
      const int steps = 40;
      const Log log = run<Degree, List<Degree>>(seed, kind, most, steps, no_window);
      CHECK(run<Degree, List<Degree>>(seed, kind, most, steps, 0.2) == log);
      CHECK(run<Degree, RuleList<Degree, Recorder, CalendarQueue<>>>(seed, kind, most, steps, no_window) == log);
      CHECK(run<Degree, RuleList<Degree, Recorder, DaryQueue<>>>(seed, kind, most, steps, no_window) == log);
      CHECK(run<Degree, RuleList<Degree, Recorder, PairingQueue<>>>(seed, kind, most, steps, no_window) == log);
      CHECK(run<Degree, RuleList<Degree, Recorder, CalendarQueue<>>>(seed, kind, most, steps, 0.1) == log);
      CHECK(run<Degree, RuleList<Degree, Recorder, DaryQueue<>>>(seed, kind, most, steps, 1.5) == log);
    }
  }
}

TEST_CASE("between two times a list of lines makes as many swaps as there are inversions", "[sorted_list]") {
  const std::uint64_t seed = 210;
  CAPTURE(seed);
  Random random(seed);
  for (int round = 0; round < 20; ++round) {
    Log log;
    List<1> list(Recorder{&log});
    Model<1> model;
    std::vector<List<1>::Entry> entries;
    for (std::uint32_t id = 0; id < 40; ++id) {
      model.motions[id] = random_motion<1>(random, round % 2 ? Kind::generic : Kind::lattice, 0);
      entries.push_back({model.motions[id], id});
    }
    list.assign(entries, 0);
    const auto before = model.order(0, rank_of);
    Simulator simulator(0, list);
    simulator.advance_to(2);
    std::vector<std::size_t> place(40);
    for (std::size_t i = 0; i < 40; ++i) place[list.entries()[i].id] = i;
    std::size_t inversions = 0;
    for (std::size_t i = 0; i < 40; ++i) {
      for (std::size_t j = i + 1; j < 40; ++j) inversions += place[before[i]] > place[before[j]];
    }
    CAPTURE(round);
    CHECK(list.counters().events == inversions);
    CHECK(log.size() == inversions);
    require_order(list, model, 2);
  }
}

TEST_CASE("changes in the midst of events of one time come out right", "[sorted_list]") {
  // As from the callback of another structure: only some of the events at this time have been processed.
  const std::uint64_t seed = 220;
  CAPTURE(seed);
  Random random(seed);
  int amidst = 0;
  for (int round = 0; round < 150; ++round) {
    CAPTURE(round);
    Log log;
    List<2> list(Recorder{&log});
    Model<2> model;
    std::vector<List<2>::Entry> entries;
    for (std::uint32_t id = 0; id < 10; ++id) {
      model.motions[id] = random_motion<2>(random, Kind::lattice, 0);
      entries.push_back({model.motions[id], id});
    }
    list.assign(entries, 0);
    Simulator simulator(0, list);
    for (int event = 0; event < 30 && simulator.step(); ++event) {
      const double now = simulator.now();
      amidst += simulator.next_time() == now;
      if (random.one_in(2)) {
        apply(random_change(random, Kind::lattice, now, 16, model), list, now);
        list.audit(now);
      }
      if (simulator.next_time() > now) require_order(list, model, now);
    }
  }
  CHECK(amidst > 100);
}

TEST_CASE("the swaps of a jump are reported one by one", "[sorted_list]") {
  Log log;
  List<1> list(Recorder{&log});
  for (std::uint32_t id = 0; id < 5; ++id) list.insert(id, {{{static_cast<double>(id), 0}}, 0}, 0);
  CHECK(log.empty());
  list.update(1, {{{3.5, 0}}, 1}, 1);
  CHECK(log == Log{{2, 1, 1}, {3, 1, 1}});
  CHECK(ids(list) == std::vector<std::uint32_t>{0, 2, 3, 1, 4});
  CHECK(list.position(1) == 3);
  CHECK(list.motion(1) == Motion<1>{{{3.5, 0}}, 1});
  log.clear();
  list.update(4, {{{-1, 0}}, 2}, 2);
  CHECK(log == Log{{4, 1, 2}, {4, 3, 2}, {4, 2, 2}, {4, 0, 2}});
  log.clear();
  list.update(4, {{{-2, 0}}, 3}, 3);
  CHECK(log.empty());
  list.audit(3);
}

TEST_CASE("a change of motion schedules what it must and nothing else", "[sorted_list]") {
  Log log;
  List<1> list(Recorder{&log});
  for (std::uint32_t id = 0; id < 3; ++id) list.insert(id, {{{2.0 * id, 0}}, 0}, 0);
  CHECK(list.next_time() == never);
  CHECK(list.queue().size() == 0);
  list.update(1, {{{2, 1}}, 0}, 0);
  CHECK(list.next_time() == 2);
  list.update(1, {{{2, -0.5}}, 0}, 0);
  CHECK(list.next_time() == 4);
  CHECK(list.queue().size() == 1);  // neighbours that part have no event
  list.remove(0, 0);
  CHECK(list.next_time() == never);
}

TEST_CASE("swaps are counted, and certificates", "[sorted_list]") {
  Log log;
  List<1> list(Recorder{&log});
  list.insert(0, {{{0, 1}}, 0}, 0);
  list.insert(1, {{{1, 0}}, 0}, 0);
  Simulator simulator(0, list);
  simulator.advance_to(3);
  CHECK(list.counters().events == 1);
  CHECK(list.counters().certificates >= 2);
  CHECK(log == Log{{1, 0, 1}});
}

TEST_CASE("a sorted list keeps to its measures", "[sorted_list]") {
  const std::uint64_t seed = 220;
  CAPTURE(seed);
  Random random(seed);
  for (const std::uint32_t n : {0u, 1u, 2u, 3u, 40u}) {
    CAPTURE(n);
    Log log;
    List<2> list(Recorder{&log});
    for (std::uint32_t id = 0; id < n; ++id) list.insert(id, random_motion<2>(random, Kind::generic, 0), 0);
    const std::uint64_t pairs = n == 0 ? 0 : n - 1;
    Simulator simulator(0, list);
    std::uint64_t certificates = list.counters().certificates;
    std::uint64_t most = 0;
    const std::uint64_t before = certificates;
    while (simulator.step()) {
      most = std::max(most, list.counters().certificates - certificates);
      certificates = list.counters().certificates;
    }
    const Measures m = list.measures();
    CHECK(m.events == log.size());
    CHECK(m.external == log.size());  // efficient
    CHECK(m.touched == certificates - before);
    CHECK(m.most_touched == most);
    CHECK(most <= 3);                                                // responsive
    CHECK(m.most_per_element == std::min<std::uint64_t>(pairs, 2));  // local
    CHECK(m.held == pairs);                                          // compact
    CHECK(m.most_held == pairs);
    if (n == 40) CHECK(log.size() > 100);
    if (n == 0) continue;
    list.remove(0, simulator.now());
    CHECK(list.measures().held == (n < 2 ? 0 : n - 2));
    CHECK(list.measures().most_held == pairs);
  }
}

// --- misuse

TEST_CASE("a list of nothing and of one", "[sorted_list]") {
  Log log;
  List<1> list(Recorder{&log});
  CHECK(list.size() == 0);
  CHECK(list.next_time() == never);
  CHECK_FALSE(list.contains(0));
  list.audit(0);
  list.assign({}, 0);
  list.extend_horizon(0, 1);
  list.insert(7, {{{1, 1}}, 0}, 0);
  CHECK(list.contains(7));
  CHECK(list.position(7) == 0);
  CHECK(list.next_time() == never);
  list.update(7, {{{2, -1}}, 0}, 0);
  list.audit(0);
  list.remove(7, 0);
  CHECK(list.size() == 0);
  CHECK_FALSE(list.contains(7));
  list.audit(0);
}

TEST_CASE("ids used twice or not known, and motions that are not finite, are refused and change nothing",
          "[sorted_list]") {
  Log log;
  List<2> list(Recorder{&log});
  const Motion<2> motion{{{1, 2, 3}}, 0};
  list.insert(3, motion, 0);
  list.insert(5, {}, 0);
  CHECK_THROWS_AS(list.insert(3, motion, 0), std::invalid_argument);
  CHECK_THROWS_WITH(list.insert(3, motion, 0), "SortedList: id 3 is used twice");
  CHECK_THROWS_AS(list.insert(std::numeric_limits<std::uint32_t>::max(), motion, 0), std::invalid_argument);
  CHECK_THROWS_AS(list.remove(4, 0), std::out_of_range);
  CHECK_THROWS_WITH(list.remove(4, 0), "SortedList: no element with id 4");
  CHECK_THROWS_AS(list.remove(4000000000u, 0), std::out_of_range);
  CHECK_THROWS_AS(list.update(4, motion, 0), std::out_of_range);
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    for (std::size_t i = 0; i < 4; ++i) {
      Motion<2> broken = motion;
      (i < 3 ? broken.position.c[i] : broken.start) = bad;
      CHECK_THROWS_AS(list.insert(6, broken, 0), std::invalid_argument);
      CHECK_THROWS_AS(list.update(3, broken, 0), std::invalid_argument);
      CHECK_THROWS_WITH(list.update(3, broken, 0), "SortedList: the motion of id 3 is not finite");
    }
  }
  CHECK(ids(list) == std::vector<std::uint32_t>{5, 3});
  CHECK_FALSE(list.contains(6));
  CHECK(list.motion(3) == motion);
  CHECK(log.empty());
  list.audit(0);
}

TEST_CASE("an assignment that is refused leaves a list that can be used", "[sorted_list]") {
  Log log;
  List<1> list(Recorder{&log});
  list.insert(3, {{{1, 2}}, 0}, 0);
  const std::vector<List<1>::Entry> twice{{{{{0, 1}}, 0}, 1}, {{{{1, 1}}, 0}, 2}, {{{{2, 1}}, 0}, 1}};
  const std::vector<List<1>::Entry> broken{{{{{0, 1}}, 0}, 1}, {{{{std::nan(""), 1}}, 0}, 2}};
  for (const auto& entries : {twice, broken}) {
    CHECK_THROWS_AS(list.assign(entries, 0), std::invalid_argument);
    for (std::uint32_t id = 0; id < 8; ++id) {
      const auto known = ids(list);
      CHECK(list.contains(id) == (std::find(known.begin(), known.end(), id) != known.end()));
    }
    CHECK_NOTHROW(list.audit(0));
  }
  list.assign(std::vector<List<1>::Entry>{{{{{1, 0}}, 0}, 1}, {{{{0, 0}}, 0}, 2}}, 0);
  CHECK(ids(list) == std::vector<std::uint32_t>{2, 1});
}

TEST_CASE("an audit finds what the list has got wrong", "[sorted_list]") {
  Log log;
  List<1> list(Recorder{&log});
  list.insert(0, {{{0, 1}}, 0}, 0);
  list.insert(1, {{{1, 0}}, 0}, 0);
  CHECK_NOTHROW(list.audit(0));
  CHECK_NOTHROW(list.audit(0.5));
  CHECK_NOTHROW(list.audit(1));                  // due, and waiting
  CHECK_THROWS_AS(list.audit(2), AuditFailure);  // the clock has run past a swap
  list.process();
  CHECK_NOTHROW(list.audit(2));
  CHECK_THROWS_AS(list.audit(0), AuditFailure);  // and back before it
}

TEST_CASE("a horizon takes events away and brings them back", "[sorted_list]") {
  Log log;
  List<1> list(Recorder{&log});
  list.insert(0, {{{0, 1}}, 0}, 0);
  list.insert(1, {{{1, 0}}, 0}, 0);
  list.insert(2, {{{5, 0}}, 0}, 0);
  CHECK(list.next_time() == 1);
  list.extend_horizon(0, 0.5);
  CHECK(list.next_time() == never);
  CHECK(list.queue().size() == 0);
  list.audit(0);
  list.extend_horizon(0, 1);
  CHECK(list.next_time() == 1);
  list.audit(0);
  list.process();
  CHECK(list.next_time() == never);  // the next swap, at 5, is beyond
  list.audit(1);
  list.extend_horizon(1, 10);
  CHECK(list.next_time() == 5);
  list.audit(1);
}

TEST_CASE("entries and motions of the list may be given to its changes", "[sorted_list]") {
  Log log;
  List<1> list(Recorder{&log});
  list.assign(std::vector<List<1>::Entry>{{{{{0, 1}}, 0}, 0}, {{{{1, 0}}, 0}, 1}, {{{{2, -1}}, 0}, 2}}, 0);
  list.assign(list.entries(), 5);  // without the swaps in between
  CHECK(ids(list) == std::vector<std::uint32_t>{2, 1, 0});
  list.audit(5);
  list.assign(list.entries().subspan(1), 5);
  CHECK(ids(list) == std::vector<std::uint32_t>{1, 0});
  for (std::uint32_t id = 2; id < 300; ++id) list.insert(id, list.motion(0), 5);
  list.update(1, list.motion(0), 5);
  for (const auto& entry : list.entries()) CHECK(entry.motion == Motion<1>{{{0, 1}}, 0});
  list.audit(5);
}

TEST_CASE("a list is not made where arithmetic is not exact", "[sorted_list]") {
  bool refused = false;
  std::fesetround(FE_DOWNWARD);
  try {
    structures::SortedList<1> list;
  } catch (const std::runtime_error&) {
    refused = true;
  }
  std::fesetround(FE_TONEAREST);
  CHECK(refused);
  CHECK_NOTHROW(structures::SortedList<1>());
}

}  // namespace test_sorted_list
