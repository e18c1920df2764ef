// The default broad phase in a world: it changes its mind, and nobody notices.
#include "collision/broad_phase/few_boxes.hpp"
#include "tests/collision/event_log.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <set>
#include <string>
#include <vector>

namespace kds::collision::test_adaptive_broad_phase {
namespace {

using namespace tests;
using kds::tests::Random;

struct Run {
  std::vector<Event> events;
  std::set<std::string> used;  ///< broad phases
};

/// Balls in a box, of which many come and go, until there have been more and fewer than are compared each with all
/// others.
Run run_crowd(BroadPhaseKind kind, double window) {
  WorldOptions options;
  options.broad_phase = kind;
  options.window = window;
  options.response = Response::elastic;
  options.walls = Walls{Vector3d::Zero(), Vector3d::Constant(9)};
  EventLog<1> log;
  World<1> world(options, &log);
  Random random(5);
  Run result;
  std::vector<BodyId> there;
  constexpr int most = static_cast<int>(FewBoxes<1>::most);
  int put = 0;
  for (const int count : {most - 4, most + 20, most - 10, most / 2 - 8, most + 6, 5}) {
    while (static_cast<int>(there.size()) > count) {
      const auto which = there.begin() + static_cast<std::ptrdiff_t>(random.below(there.size()));
      world.remove_body(*which);
      there.erase(which);
    }
    while (static_cast<int>(there.size()) < count) {
      BodyDescription<1> ball;
      ball.shape = Sphere{0.5};
      const auto place = [&] { return random.between(0.6, 8.4); };
      const auto speed = [&] { return random.one_in(4) ? 0 : random.between(-2, 2); };
      ball.motion = {{{Vector3d(place(), place(), place()), Vector3d(speed(), speed(), speed())}, world.now()}};
      there.push_back(world.add_body(ball));
      ++put;
    }
    for (int i = 0; i < 10; ++i) {
      world.advance_to(world.now() + 0.2);
      world.audit();
      result.used.insert(std::string(world.broad_phase()));
    }
  }
  REQUIRE(put > most + 60);
  result.events = log.events;
  return result;
}

TEST_CASE("Changes between a few boxes and the kinetic grid lose no event and add none", "[broad_phase]") {
  for (const double window : {0.3, never}) {
    INFO("window " << window);
    const Run grid = run_crowd(BroadPhaseKind::grid, window);
    const Run chosen = run_crowd(BroadPhaseKind::automatic, window);
    CHECK(chosen.used == std::set<std::string>{"few-boxes", "grid"});
    CHECK(grid.events.size() > 400);
    CHECK(chosen.events == grid.events);
  }
}

}  // namespace
}  // namespace kds::collision::test_adaptive_broad_phase
