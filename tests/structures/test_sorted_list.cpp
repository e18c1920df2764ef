// The kinetic sorted list against the exact order of its motions, at every event and between events.
#include "kds/events/calendar_queue.hpp"
#include "kds/events/dary_queue.hpp"
#include "kds/events/pairing_queue.hpp"
#include "kds/events/place_queue.hpp"
#include "kds/simulator.hpp"
#include "structures/sorted_list.hpp"
#include "tests/structures/random_values.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <ostream>
#include <stdexcept>
#include <vector>

namespace {

using namespace kds;
using namespace kds::tests;
using structures::SortedList;

struct Swap {
  std::uint32_t left, right;
  double time;
  friend bool operator==(const Swap&, const Swap&) = default;
  friend std::ostream& operator<<(std::ostream& out, const Swap& s) {
    return out << s.left << " < " << s.right << " from " << s.time;
  }
};
using Log = std::vector<Swap>;

/// Ranks fall while ids rise, in steps of three, so that both settle ties.
std::uint32_t rank_of(std::uint32_t id) { return 1000 - id / 3; }

struct Recorder {
  Log* log;
  void swapped(std::uint32_t left, std::uint32_t right, double t) { log->push_back({left, right, t}); }
  static std::uint32_t rank(std::uint32_t id) { return rank_of(id); }
};

template <int Degree, class Queue = PlaceQueue>
using List = SortedList<Degree, Recorder, Queue>;

template <class L>
std::vector<std::uint32_t> ids(const L& list) {
  std::vector<std::uint32_t> result;
  for (const auto& entry : list.entries()) result.push_back(entry.id);
  return result;
}

template <class L, int Degree>
void require_order(const L& list, const Model<Degree>& model, double t) {
  if (ids(list) != model.order(t, rank_of)) {
    CAPTURE(t);
    REQUIRE(ids(list) == model.order(t, rank_of));
  }
}

/// Runs random changes and advances; returns the swaps. What is checked does not depend on the queue or the window,
/// and neither may the swaps.
template <int Degree, class Queue>
Log run(std::uint64_t seed, Kind kind, std::size_t most, int steps, double window) {
  Random random(seed);
  Log log;
  List<Degree, Queue> list(Recorder{&log});
  Model<Degree> model;
  double now = beginning(kind);
  for (std::size_t i = 0; i < most / 2; ++i) {
    model.motions[static_cast<std::uint32_t>(2 * i)] = random_motion<Degree>(random, kind, now);
  }
  std::vector<typename List<Degree, Queue>::Entry> entries;
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

TEMPLATE_TEST_CASE_SIG("a kinetic sorted list is in the exact order of its motions, whatever its queue and horizon",
                       "[sorted_list]", ((int Degree), Degree), 1, 2, 3) {
  for (const Kind kind : all_kinds) {
    for (std::uint64_t seed = 200; seed < 204; ++seed) {
      CAPTURE(Degree, static_cast<int>(kind), seed);
      const std::size_t most = 3 + 5 * (seed % 4);
      const int steps = 40;
      const Log log = run<Degree, CalendarQueue<>>(seed, kind, most, steps, no_window);
      CHECK(run<Degree, PlaceQueue>(seed, kind, most, steps, no_window) == log);
      CHECK(run<Degree, PlaceQueue>(seed, kind, most, steps, 0.2) == log);
      CHECK(run<Degree, DaryQueue<>>(seed, kind, most, steps, no_window) == log);
      CHECK(run<Degree, PairingQueue<>>(seed, kind, most, steps, no_window) == log);
      CHECK(run<Degree, CalendarQueue<>>(seed, kind, most, steps, 0.1) == log);
      CHECK(run<Degree, DaryQueue<>>(seed, kind, most, steps, 1.5) == log);
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

// --- degeneracies

TEST_CASE("many values at one value at one time: thousands of swaps at one instant", "[sorted_list][degeneracy]") {
  Log log;
  List<1> list(Recorder{&log});
  const std::uint32_t n = 80;
  std::vector<List<1>::Entry> entries;
  for (std::uint32_t id = 0; id < n; ++id) {
    const double speed = static_cast<double>((id * 37) % n);
    entries.push_back({{{{-speed, speed}}, 0}, id});  // all are zero at 1
  }
  list.assign(entries, 0);
  Simulator simulator(0, list);
  while (simulator.step()) {
    REQUIRE(simulator.now() == 1);
    REQUIRE(log.size() <= n * (n - 1) / 2);
    if (log.size() % 16 == 0) simulator.audit();
  }
  CHECK(log.size() == n * (n - 1) / 2);
  simulator.audit();
  for (std::uint32_t i = 0; i < n; ++i) CHECK(list.entries()[i].motion.position.c[1] == i);
}

TEST_CASE("many parabolas meet in one point with one slope", "[sorted_list][degeneracy]") {
  Log log;
  List<2> list(Recorder{&log});
  Model<2> model;
  std::vector<List<2>::Entry> entries;
  for (std::uint32_t id = 0; id < 30; ++id) {
    const double a = (static_cast<double>((id * 7) % 30) - 15) / 4;
    model.motions[id] = {{{a, 3 - 2 * a, a}}, 0};  // a (t - 1)^2 + 3 t
    entries.push_back({model.motions[id], id});
  }
  list.assign(entries, 0);
  CHECK(list.next_time() == never);  // they touch, and none passes another
  require_order(list, model, 0);
  require_order(list, model, 1);
  list.audit(1);
}

TEST_CASE("a touch without crossing is no event", "[sorted_list][degeneracy]") {
  Log log;
  List<2> list(Recorder{&log});
  list.insert(0, {}, 0);
  list.insert(1, {{{1, -2, 1}}, 0}, 0);  // (t - 1)^2
  CHECK(list.next_time() == never);
  // A hair lower it crosses twice; a hair higher it does not.
  list.update(1, {{{next_down(1), -2, 1}}, 0}, 0);
  CHECK(list.next_time() < 1);
  Simulator simulator(0, list);
  simulator.advance_to(2);
  CHECK(log.size() == 2);
  CHECK(log[0].time < 1);
  CHECK(log[1].time > 1);
  list.update(1, {{{next_up(1), -2, 1}}, 0}, 0.5);
  CHECK(list.next_time() == never);
}

TEST_CASE("a crossing of third order is one swap", "[sorted_list][degeneracy]") {
  Log log;
  List<3> list(Recorder{&log});
  list.insert(0, {}, 0);
  list.insert(1, {{{1, -3, 3, -1}}, 0}, 0);  // -(t - 1)^3
  Simulator simulator(0, list);
  simulator.advance_to(5);
  CHECK(log == Log{{1, 0, 1}});
}

TEST_CASE("equal motions stay in the order of rank, then id, and make no events", "[sorted_list][degeneracy]") {
  Log log;
  List<2> list(Recorder{&log});
  const Motion<2> motion{{{0.1, 0.2, 0.3}}, 0.4};
  for (const std::uint32_t id : {4, 0, 5, 1, 3, 2}) list.insert(id, motion, 1);
  CHECK(ids(list) == std::vector<std::uint32_t>{3, 4, 5, 0, 1, 2});
  CHECK(list.next_time() == never);
  // Values at rest in one place since different times are equal too.
  List<1> resting(Recorder{&log});
  for (const std::uint32_t id : {1, 2, 0}) resting.insert(id, {{{7, 0}}, static_cast<double>(id)}, 3);
  CHECK(ids(resting) == std::vector<std::uint32_t>{0, 1, 2});
  CHECK(resting.next_time() == never);
  // A third one that passes through keeps them so.
  list.insert(9, {{{-10, 3, 0.3}}, 0.4}, 1);
  Simulator simulator(1, list);
  simulator.advance_to(50);
  CHECK(ids(list) == std::vector<std::uint32_t>{3, 4, 5, 0, 1, 2, 9});
  CHECK(log.size() == 6);
  simulator.audit();
}

TEST_CASE("values that meet at time zero stand in their order just after", "[sorted_list][degeneracy]") {
  Log log;
  List<1> list(Recorder{&log});
  std::vector<List<1>::Entry> entries{{{{{0, 2}}, 0}, 0}, {{{{0, -1}}, 0}, 1}, {{{{0, 0}}, 0}, 2}};
  list.assign(entries, 0);
  CHECK(ids(list) == std::vector<std::uint32_t>{1, 2, 0});
  CHECK(list.next_time() == never);
  // The same from before: then they swap, at zero.
  list.assign(entries, -1);
  CHECK(ids(list) == std::vector<std::uint32_t>{0, 2, 1});
  CHECK(list.next_time() == 0);
  Simulator simulator(-1, list);
  simulator.advance_to(0);
  CHECK(ids(list) == std::vector<std::uint32_t>{1, 2, 0});
  CHECK(log.size() == 3);
  // And if one is put there by a change at zero.
  list.insert(3, {{{0, 1}}, 0}, 0);
  CHECK(ids(list) == std::vector<std::uint32_t>{1, 2, 3, 0});
}

TEST_CASE("values at rest make no events", "[sorted_list][degeneracy]") {
  Log log;
  List<2> list(Recorder{&log});
  for (std::uint32_t id = 0; id < 50; ++id) list.insert(id, {{{static_cast<double>(id % 7), 0, 0}}, 0}, 0);
  CHECK(list.next_time() == never);
  CHECK(list.queue().size() == 0);
  list.audit(0);
  list.audit(1e9);
}

TEST_CASE("a list at clock 1e9 swaps as at clock 0, to the bit", "[sorted_list][degeneracy]") {
  const std::uint64_t seed = 230;
  CAPTURE(seed);
  Random random(seed);
  for (int round = 0; round < 10; ++round) {
    Log early;
    Log late;
    List<1> first(Recorder{&early});
    List<1> second(Recorder{&late});
    for (std::uint32_t id = 0; id < 20; ++id) {
      // Speeds whose differences are powers of two: times that both clocks can tell.
      Motion<1> motion{{{random.integer(-64, 64) / 16.0, random.one_in(2) ? 1.0 : -1.0}}, 0};
      first.insert(id, motion, 0);
      motion.start = 1e9;
      second.insert(id, motion, 1e9);
    }
    Simulator at_zero(0, first);
    Simulator at_1e9(1e9, second);
    at_zero.advance_to(4);
    at_1e9.advance_to(1e9 + 4);
    for (Swap& s : early) s.time += 1e9;
    CAPTURE(round);
    CHECK(early.size() > 10);
    CHECK(early == late);
    at_1e9.audit();
  }
}

TEST_CASE("values of 1e-6 pass next to values of 1e6", "[sorted_list][degeneracy]") {
  Log log;
  List<2> list(Recorder{&log});
  Model<2> model;
  for (std::uint32_t id = 0; id < 24; ++id) {
    const double size = id % 2 ? 1e6 : 1e-6;
    const double sign = id % 4 < 2 ? 1 : -1;
    model.motions[id] = {{{sign * size * (1 + id * 0.01), -sign * size * (2 + id * 0.03), id % 3 ? 0 : size * 0.1}}, 0};
    list.insert(id, model.motions[id], 0);
  }
  Simulator simulator(0, list);
  while (simulator.step(3)) {
    simulator.audit();
    if (simulator.next_time() > simulator.now()) require_order(list, model, simulator.now());
  }
  CHECK(log.size() > 50);
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
