// The kinetic heap against the exact maximum and the exact order of each parent and child.
#include "kds/testing/trial.hpp"
#include "structures/heap.hpp"
#include "tests/structures/random_values.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <vector>

namespace test_heap {
namespace {

using namespace kds;
using namespace kds::tests;
using structures::ByValue;
using structures::Heap;
using structures::HeapRule;
using testing::Findings;
using testing::TrialOptions;
using testing::try_rule;

template <int Degree>
oracle::Value value(const Motion<Degree>& motion) {
  return {{motion.position.c.begin(), motion.position.c.end()}, motion.start};
}

/// The top is a greatest value, and no child exceeds its parent.
template <int Degree>
int check_heap(const HeapRule<ByValue<Motion<Degree>>>& rule, const MovingSet<Motion<Degree>>& set, double now) {
  if (rule.size() != set.size()) return 1;
  int wrong = 0;
  for (const Id id : set.ids()) wrong += oracle::compare_after(value(set[id]), value(set[*rule.top()]), now) > 0;
  for (std::size_t i = 1; i < rule.size(); ++i) {
    const Id child = rule.heap()[i], parent = rule.heap()[(i - 1) / 2];
    wrong += oracle::compare_after(value(set[child]), value(set[parent]), now) > 0;
  }
  return wrong;
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("a kinetic heap has a greatest value on top, exactly", "[heap]", ((int Degree), Degree), 1, 2,
                       3) {
  std::size_t events = 0;
  for (const Kind kind : all_kinds) {
    for (std::uint64_t seed = 600; seed < 603; ++seed) {
      CAPTURE(Degree, static_cast<int>(kind), seed);
      const TrialOptions options{seed, kind, 24, 3 + 6 * (seed % 3), 24, seed % 2 == 0 ? never : 0.4};
      const Findings found =
          try_rule(options, HeapRule<ByValue<Motion<Degree>>>{}, random_motion<Degree>, check_heap<Degree>);
      CHECK(found.first == "");
      events += found.events.size();
    }
  }
  CHECK(events > 20);
}

TEMPLATE_TEST_CASE_SIG("a heap is right where many children pass many parents at one time", "[heap][degeneracy]",
                       ((int Degree), Degree), 1, 2) {
  std::size_t together = 0;  // events at the time of the one before
  for (std::uint64_t seed = 620; seed < 720; ++seed) {
    CAPTURE(Degree, seed);
    const Findings found = try_rule({seed, Kind::coarse, 24, 3 + 6 * (seed % 3), 24},
                                    HeapRule<ByValue<Motion<Degree>>>{}, random_motion<Degree>, check_heap<Degree>);
    REQUIRE(found.first == "");
    for (std::size_t i = 1; i < found.events.size(); ++i) {
      together += found.events[i].time == found.events[i - 1].time;
    }
  }
  CHECK(together > 100);
}

TEST_CASE("a heap keeps to its measures", "[heap]") {
  const std::uint64_t seed = 610;
  CAPTURE(seed);
  Random random(seed);
  MovingSet<Motion<1>> set;
  const Id n = 200;
  for (Id id = 0; id < n; ++id) set.insert(id, {{{random.between(-1, 1), random.between(-1, 1)}}, 0}, 0);
  Heap<1> heap(set, 0);
  Simulator simulator(0, heap);
  while (simulator.step()) {
  }
  const Measures m = heap.measures();
  CHECK(m.held == n - 1);
  CHECK(m.most_held == n - 1);     // compact
  CHECK(m.most_per_element == 3);  // local
  CHECK(m.most_touched <= 5);      // responsive
  CHECK(m.external > 3);
  CHECK(m.external < n);  // Each line is greatest at most once.
  CHECK(m.events < 3 * n * std::log2(n));
  CHECK(set[*heap.rule().top()].position.c[1] > 0.9);
}

TEST_CASE("a heap of values that all meet at one time is turned over there", "[heap][degeneracy]") {
  MovingSet<Motion<1>> set;
  const Id n = 100;
  for (Id id = 0; id < n; ++id) set.insert(id, {{{-1.0 * id, 1.0 * id}}, 0}, 0);
  Heap<1> heap(set, 0);
  CHECK(heap.rule().top() == 0);
  Simulator simulator(0, heap);
  while (simulator.step()) {
    if (simulator.now() != 1) FAIL("an event at " << simulator.now());
  }
  simulator.audit();
  CHECK(heap.rule().top() == n - 1);
  CHECK(heap.measures().events < n * n / 2);
}

TEMPLATE_TEST_CASE_SIG("a child that is passed at the time at which it came under its parent passes it again later",
                       "[heap][degeneracy]", ((int Degree), Degree), 1, 2, 3) {
  // Times are a second apart. 1 and 2 overtake 0 within the first; 1 does it first, and comes on top of 2, which is
  // ahead of it by the end of that second, though slower.
  const double start = 0x1p52;
  for (const double late : {0.0, 1.0}) {  // the start of 2: the same line from another time
    MovingSet<Motion<Degree>> set;
    set.insert(0, {{{10, -8}}, start}, start);
    set.insert(1, {{{1, 3}}, start}, start);
    set.insert(2, {{{4.5 + 0.5 * late, 0.5}}, start + late}, start);
    if constexpr (Degree >= 2) {
      for (const Id id : {0u, 1u, 2u}) {
        auto motion = set[id];
        const double elapsed = start - motion.start;
        motion.position.c[0] += 3 * elapsed * elapsed;  // an acceleration in common, and still the same difference
        motion.position.c[1] -= 6 * elapsed;
        motion.position.c[2] = 3;
        set.update(id, motion, start);
      }
    }
    Heap<Degree> heap(set, start);
    REQUIRE(heap.rule().heap() == std::vector<Id>{0, 1, 2});
    Simulator simulator(start, heap);
    for (const Id greatest : {2u, 1u, 1u}) {
      simulator.advance_to(simulator.now() + 1);
      CAPTURE(Degree, late, simulator.now() - start);
      CHECK(heap.rule().top() == greatest);
      CHECK(check_heap<Degree>(heap.rule(), set, simulator.now()) == 0);
      CHECK_NOTHROW(simulator.audit());
    }
    CHECK(heap.measures().events == 3);
  }
}

TEST_CASE("values that move together make no event in a heap", "[heap][degeneracy]") {
  MovingSet<Motion<2>> set;
  for (Id id = 0; id < 20; ++id) set.insert(id, {{{0.1, 0.2, 0.3}}, 0.4}, 0);
  Heap<2> heap(set, 0);
  CHECK(heap.next_time() == never);
  heap.audit(5);
  set.remove(*heap.rule().top(), 5);
  CHECK(heap.rule().size() == 19);
  heap.audit(5);
}

}  // namespace test_heap
