// Whose the horizon is, and work that structures put off.
#include "kds/framework/history.hpp"
#include "kds/simulator.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <cstdint>
#include <set>
#include <utility>
#include <vector>

namespace test_horizons {
namespace {

using namespace kds;
using kds::tests::Random;

using Log = std::vector<std::pair<double, char>>;

/// Its events are given beforehand. Those beyond the horizon are not told.
struct Script {
  char name;
  Log& log;
  std::set<double> events;
  double horizon = never;

  double next_time() const { return events.empty() || *events.begin() > horizon ? never : *events.begin(); }
  void process() {
    log.emplace_back(*events.begin(), name);
    events.erase(events.begin());
  }
  void extend_horizon(double, double to) { horizon = to; }
  void audit(double) const {}
  Counters counters() const { return {}; }
};

/// The same, but tells all.
struct KnowsAll : Script {
  double next_time() const { return events.empty() ? never : *events.begin(); }
};

/// Its edits are events if there is an odd number of them at a time, and otherwise work without an event.
struct PutsOff {
  std::vector<std::vector<int>>& taken_up;
  std::vector<int> edits = {};
  double edited_at = never;

  void edit(int edit, double now) {
    edits.push_back(edit);
    edited_at = now;
  }
  double next_time() const { return edited_at; }
  bool process() {
    edited_at = never;
    taken_up.push_back(std::exchange(edits, {}));
    return taken_up.back().size() % 2 == 1;
  }
  void extend_horizon(double, double) {}
  void audit(double) const {}
  Counters counters() const { return {}; }
  template <class Archive>
  void archive(Archive& archive) {
    archive(edits, edited_at);
  }
};

static_assert(KineticStructure<Script> && KineticStructure<KnowsAll> && KineticStructure<PutsOff>);

}  // namespace

TEST_CASE("a structure that knows all its events, and one that knows none beyond the horizon", "[simulator]") {
  for (const double window : {0.1, 0.5, 1.0, 3.0}) {
    Log log;
    KnowsAll a{{'a', log, {0.75, 1.25, 2.5, 7.0}}};
    Script b{'b', log, {1.0, 2.0, 6.0}};
    Simulator simulator(0, a, b);
    simulator.set_window(window);
    if (window < 0.75) CHECK(simulator.next_time() == never);
    while (simulator.step(6.5)) {
    }
    CHECK(log == Log{{0.75, 'a'}, {1.0, 'b'}, {1.25, 'a'}, {2.0, 'b'}, {2.5, 'a'}, {6.0, 'b'}});
  }
}

TEST_CASE("a simulator tells its structures of its horizon, also those that have had another", "[simulator]") {
  Log log;
  Script a{'a', log, {0.5, 5.0}};
  {
    Simulator windows(0, a);
    windows.set_window(1);
    windows.advance_to(0.75);
  }
  CHECK(a.horizon == 1);
  Simulator simulator(0.75, a);
  CHECK(a.horizon == never);
  simulator.advance_to(6);
  CHECK(log.size() == 2);
}

TEST_CASE("work that is put off is done on the way to the next event, and is none", "[simulator]") {
  std::vector<std::vector<int>> taken_up;
  Log log;
  PutsOff puts_off{taken_up};
  Script script{'s', log, {1.0, 2.0}};
  Simulator simulator(0, puts_off, script);
  puts_off.edit(1, 0);
  puts_off.edit(2, 0);
  CHECK(simulator.next_time() == 0);
  CHECK_FALSE(simulator.step(0.5));
  CHECK(taken_up == std::vector<std::vector<int>>{{1, 2}});
  CHECK(simulator.now() == 0);
  CHECK(simulator.next_time() == 1);
  puts_off.edit(3, 0);
  puts_off.edit(4, 0);
  CHECK(simulator.step());
  CHECK(log == Log{{1.0, 's'}});
  puts_off.edit(5, 1);
  CHECK(simulator.step());
  CHECK(simulator.now() == 1);
  CHECK(log.size() == 1);
  CHECK(taken_up == std::vector<std::vector<int>>{{1, 2}, {3, 4}, {5}});
}

TEST_CASE("edits between which a step has found nothing are repeated apart", "[simulator][history]") {
  for (const std::uint64_t every : {1u, 2u, 3u, 5u, 1000u}) {
    for (std::uint64_t seed = 1; seed <= 50; ++seed) {
      INFO("a snapshot every " << every << ", seed " << seed);
      Random random(seed);
      std::vector<std::vector<int>> taken_up;
      PutsOff puts_off{taken_up};
      Simulator simulator(0, puts_off);
      History history(every, simulator);
      for (int i = 0; i < 40; ++i) {
        switch (random.below(5)) {
          case 0:
            history.advance_to(simulator.now() + random.integer(0, 1));
            break;
          case 1:
            history.step(simulator.now() + random.integer(-1, 2));
            break;
          default:
            history.edit([&, i] { puts_off.edit(i, simulator.now()); });
        }
      }
      while (history.step()) {
      }
      const auto all = taken_up;
      const std::uint64_t events = history.events();
      const double now = simulator.now();
      if (every == 1000) {
        taken_up.clear();
        history.roll_back(now);  // from the beginning
        CHECK(taken_up == all);
        CHECK(history.events() == events);
      }
      while (history.step_back()) {
      }
      CHECK(history.events() == 0);
    }
  }
}

}  // namespace test_horizons
