// What the kinetic sorted list does where motions meet in number, touch, coincide, or differ in scale.
#include "kds/events/calendar_queue.hpp"
#include "kds/simulator.hpp"
#include "tests/structures/random_values.hpp"
#include "tests/structures/recorded_list.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstdint>
#include <vector>

namespace test_sorted_list_degeneracies {
namespace {

using namespace kds;
using namespace kds::tests;

}  // namespace

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

}  // namespace test_sorted_list_degeneracies
