// Listeners and edits that throw while a history runs.
#include "examples/list_in_forty_lines.hpp"
#include "kds/framework/history.hpp"
#include "kds/framework/kinetic.hpp"
#include "kds/framework/moving_set.hpp"
#include "kds/simulator.hpp"

#include <catch2/catch.hpp>

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <vector>

namespace test_history_exceptions {
namespace {

using namespace kds;
using Value = Motion<2>;

/// Throws at one of the events.
struct Throws {
  int* heard;
  int at;
  template <class Rule>
  void operator()(const Rule& /*rule*/, const KineticEvent& /*event*/) const {
    if (++*heard == at) throw std::runtime_error("a listener");
  }
};

/// Six values that pass each other.
struct Values : MovingSet<Value> {
  Values() {
    for (int i = 0; i < 6; ++i) add({{{double(i), 3 - 1.125 * i, 0.0625 * i * i}}, 0}, 0);
  }
};

/// The listener throws at the event `at`, counted from 1.
struct Run {
  explicit Run(int at) : list(values, 0, {}, Throws{&heard, at}) {}

  /// Whether there was an event; an exception of the listener is one.
  bool step() {
    try {
      return history.step(10);
    } catch (const std::runtime_error&) {
      return true;
    }
  }
  Snapshot state() { return save(simulator, set); }

  int heard = 0;
  Values values;
  MovingSet<Value>& set = values;
  Kinetic<examples::ListRule<Value>, Throws> list;
  Simulator<Kinetic<examples::ListRule<Value>, Throws>> simulator{0, list};
  History<decltype(simulator), MovingSet<Value>> history{1000, simulator, set};
};

TEST_CASE("history: an event whose listener throws has happened, and is undone and repeated as any other",
          "[history]") {
  constexpr int steps = 6;
  const int at = GENERATE(1, 3, 6);
  Run calm(0), run(at);
  std::vector<Snapshot> states{run.state()};
  for (int i = 0; i < steps; ++i) {
    REQUIRE(calm.step());
    REQUIRE(run.step());
    states.push_back(run.state());
    CHECK(run.state() == calm.state());
  }
  CHECK(run.history.events() == steps);
  const auto edit = [](Run& changed) {
    changed.history.edit([&] { changed.values.update(2, {{{0, 1, 0}}, 0}, changed.simulator.now()); });
    while (changed.step()) {
    }
  };
  edit(calm), edit(run);
  const Snapshot last = run.state();
  CHECK(last == calm.state());
  run.history.roll_back(run.simulator.now());  // Nothing is to be undone.
  CHECK(run.state() == last);
  const auto events = run.history.events();
  for (auto i = events; i > steps; --i) REQUIRE(run.history.step_back());
  for (int i = steps; i > 0; --i) {
    REQUIRE(run.history.step_back());
    CHECK(run.state() == states[std::size_t(i - 1)]);
    CHECK(run.history.events() == std::uint64_t(i - 1));
  }
}

TEST_CASE("history: what an edit did before it threw is there after a roll-back", "[history]") {
  Run run(0);
  for (int i = 0; i < 3; ++i) REQUIRE(run.step());
  const auto edit = [&] {
    run.values.remove(4, run.simulator.now());
    throw std::runtime_error("an edit");
  };
  CHECK_THROWS_AS(run.history.edit(edit), std::runtime_error);
  CHECK(run.history.events() == 3);
  REQUIRE(run.step());
  const Snapshot last = run.state();
  run.history.roll_back(run.simulator.now());
  CHECK(run.state() == last);
  CHECK(run.values.size() == 5);
}

}  // namespace
}  // namespace test_history_exceptions
