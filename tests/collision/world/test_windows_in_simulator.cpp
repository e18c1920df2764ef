// Worlds in a simulator, with windows of their own and of the simulator: nothing depends on these, nor on broad phases.
#include "certificates/plane_motion.hpp"
#include "kds/framework/history.hpp"
#include "kds/framework/kinetic.hpp"
#include "kds/simulator.hpp"
#include "structures/delaunay.hpp"
#include "structures/sorted_list.hpp"
#include "tests/collision/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <cstdint>
#include <optional>
#include <ostream>
#include <utility>
#include <vector>

namespace kds::collision::test_windows_in_simulator {
namespace {

using namespace tests;
using Path = certificates::PlaneMotion<1>;

struct Times {
  std::vector<double>* log;
  void swapped(std::uint32_t, std::uint32_t, double t) { log->push_back(t); }
  static std::uint32_t rank(std::uint32_t) { return 0; }
  template <class Rule>
  void operator()(const Rule&, const KineticEvent& event) const {
    log->push_back(event.time);
  }
};

/// What is told in a run, by structure.
struct Told {
  std::vector<Event> bouncing, passing;
  std::vector<double> swaps, flips;
  friend bool operator==(const Told&, const Told&) = default;
};

/// How two worlds search for events, and how far the simulator asks them to; `never` is no window.
struct Setting {
  BroadPhaseKind method = BroadPhaseKind::automatic;
  double bouncing = never, passing = never, simulator = never;
};

constexpr double end = 2;  // s

/// Balls that bounce between walls, balls that pass through each other, numbers in order and a triangulation, which
/// have nothing to do with each other.
class Four {
 public:
  explicit Four(const Setting& setting, std::uint64_t seed = 1)
      : bouncing(options(setting, setting.bouncing, Response::elastic), &bouncing_log),
        passing(options(setting, setting.passing, Response::none), &passing_log) {
    Random random(seed);
    for (std::uint32_t i = 0; i < 12; ++i) {
      const auto moving = [&](double size) {
        return motion<1>({2.0 * (i % 4) + random.between(-0.5, 0.5), 2.0 * (i / 4) + random.between(-0.5, 0.5), 0},
                         {random.between(-size, size), random.between(-size, size), 0});
      };
      bouncing.add_body(body<1>(Sphere{0.4}, moving(3)));
      passing.add_body(body<1>(Sphere{0.4}, moving(6)));
      const auto [p, v] = moving(2).coefficients;
      list.insert(i, Motion<1>{{{p[0], v[0]}}, 0}, 0);
      points.add({{Polynomial<1>{{p[0], v[0]}}, Polynomial<1>{{p[1], v[1]}}}, 0}, 0);
    }
    triangles.emplace(points, 0, structures::DelaunayRule<Path>{}, Times{&told_.flips});
    simulator.emplace(0, list, bouncing, *triangles, passing);
    if (setting.simulator < never) simulator->set_window(setting.simulator);
  }
  Four(const Four&) = delete;

  Told told() const {
    Told all = told_;
    all.bouncing = bouncing_log.events;
    all.passing = passing_log.events;
    return all;
  }
  void forget() {
    for (auto* log : {&bouncing_log, &passing_log}) log->events.clear();
    told_ = {};
  }

  EventLog<1> bouncing_log, passing_log;
  World<1> bouncing, passing;
  MovingSet<Path> points;
  std::optional<Kinetic<structures::DelaunayRule<Path>, Times>> triangles;
  structures::SortedList<1, Times> list{Times{&told_.swaps}};
  std::optional<
      Simulator<structures::SortedList<1, Times>, World<1>, Kinetic<structures::DelaunayRule<Path>, Times>, World<1>>>
      simulator;

 private:
  static WorldOptions options(const Setting& setting, double window, Response response) {
    WorldOptions options = with_response(response);
    options.broad_phase = setting.method;
    options.rate = 30;
    options.window = window;
    if (response == Response::elastic) options.walls = Walls{{-1, -1, -1}, {7, 5, 1}};
    return options;
  }

  Told told_;
};

/// Each run by itself, and the number of its events.
std::pair<Told, std::uint64_t> alone(std::uint64_t seed = 1) {
  Four four({}, seed);
  std::uint64_t events = 0;
  while (four.bouncing.step(end)) ++events;
  while (four.passing.step(end)) ++events;
  Simulator list(0, four.list);
  while (list.step(end)) ++events;
  Simulator triangles(0, *four.triangles);
  while (triangles.step(end)) ++events;
  return {four.told(), events};
}

/// Every combination of windows and broad phases; frames go on for ever, and so need a window of the simulator.
std::vector<Setting> settings() {
  std::vector<Setting> result;
  for (const auto method : all_methods) {
    for (const double simulator : {never, 0.1, 1.0}) {
      if (method == BroadPhaseKind::sap && simulator == never) continue;
      for (const double bouncing : {never, 0.1, 1.0}) {
        for (const double passing : {never, 0.1, 1.0}) result.push_back({method, bouncing, passing, simulator});
      }
    }
  }
  return result;
}

std::ostream& operator<<(std::ostream& out, const Setting& setting) {
  return out << "broad phase " << static_cast<int>(setting.method) << ", windows of the worlds " << setting.bouncing
             << " and " << setting.passing << ", of the simulator " << setting.simulator;
}

Told after(double t, Told all) {
  for (auto* log : {&all.bouncing, &all.passing}) std::erase_if(*log, [&](const Event& e) { return e.time() <= t; });
  for (auto* log : {&all.swaps, &all.flips}) std::erase_if(*log, [&](double time) { return time <= t; });
  return all;
}

Told joined(Told first, const Told& second) {
  const auto append = [](auto& log, const auto& more) { log.insert(log.end(), more.begin(), more.end()); };
  append(first.bouncing, second.bouncing);
  append(first.passing, second.passing);
  append(first.swaps, second.swaps);
  append(first.flips, second.flips);
  return first;
}

}  // namespace

TEST_CASE("Worlds and structures in one simulator have the events that each has alone", "[world][simulator]") {
  const auto [expected, events] = alone();
  CHECK(expected.bouncing.size() > 20);
  CHECK(expected.passing.size() > 5);
  CHECK(expected.swaps.size() > 10);
  CHECK(expected.flips.size() > 10);
  for (const Setting& setting : settings()) {
    INFO(setting);
    Four four(setting);
    std::uint64_t steps = 0;
    CHECK_FALSE(four.simulator->step(0));  // Bodies enter, and no event comes of it.
    for (;; ++steps) {
      const double next = four.simulator->next_time();
      if (!four.simulator->step(end)) break;
      CHECK((next == never || four.simulator->now() == next));
      four.simulator->audit();
    }
    CHECK(steps == events);
    CHECK(four.told() == expected);
  }
}

TEST_CASE("Worlds and structures go back in time together, whatever the windows", "[world][simulator][history]") {
  const auto [expected, events] = alone();
  for (const auto method : all_methods) {
    for (const Setting& setting : {Setting{method, never, 0.1, 1}, Setting{method, 1, never, 0.1},
                                   Setting{method, 0.1, 1, method == BroadPhaseKind::sap ? 0.3 : never}}) {
      INFO(setting);
      Four four(setting);
      History history(7, *four.simulator, four.points);
      while (history.step(end)) {
      }
      CHECK(history.events() == events);
      for (const double back : {1.5, 0.25}) {
        history.roll_back(back);
        four.simulator->audit();
        four.forget();
        while (history.step(end)) {
        }
        CHECK(history.events() == events);
        CHECK(four.told() == after(back, expected));
      }
      std::uint64_t back = 0;
      while (history.step_back()) ++back;
      CHECK(back == events);
      CHECK(history.events() == 0);
      four.forget();
      while (history.step(end)) {
      }
      CHECK(four.told() == expected);
    }
  }
}

TEST_CASE("Worlds and structures are saved, and go on with other windows and broad phases", "[world][simulator]") {
  const Told expected = alone().first;
  const auto all = settings();
  Random random(4);
  for (int i = 0; i < 40; ++i) {
    const Setting &first = all[random.below(all.size())], &second = all[random.below(all.size())];
    INFO(first << ", then " << second);
    Four four(first), other(second);
    if (first.simulator == never && second.method == BroadPhaseKind::sap) continue;
    for (std::uint64_t steps = random.below(100); steps > 0; --steps) four.simulator->step(end);
    if (random.one_in(2)) four.simulator->next_time();
    restore(save(*four.simulator, four.points), *other.simulator, other.points);
    if (random.one_in(2) && second.simulator < never) other.simulator->set_window(second.simulator);
    other.simulator->audit();
    while (other.simulator->step(end)) {
    }
    CHECK(joined(four.told(), other.told()) == expected);
  }
}

TEST_CASE("Edits of worlds in a simulator make no steps of their own, and are repeated as they were made",
          "[world][simulator][history]") {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    std::optional<std::pair<Told, std::uint64_t>> expected;
    for (const Setting& setting : settings()) {
      INFO("seed " << seed << ", " << setting);
      Four four(setting, seed);
      History history(1'000'000, *four.simulator, four.points);
      Random random(seed);
      const auto change = [&four](World<1>& world, BodyId id, const Vector3d& to, const Vector3d& velocity,
                                  bool jumps) {
        const double t = four.simulator->now();
        world.advance_to(t);
        world.update_motion(id, motion<1>(jumps ? to : world.motion(id).position(t), velocity, zero, t));
      };
      for (int i = 0; i < 40; ++i) {
        if (random.one_in(3)) history.advance_to(four.simulator->now() + random.between(0, end / 20));
        if (random.one_in(3)) history.step(end);
        for (auto edits = random.below(4); edits > 0; --edits) {
          World<1>& world = random.one_in(2) ? four.bouncing : four.passing;
          const auto id = static_cast<BodyId>(random.below(12));
          const Vector3d to(random.between(0, 6), random.between(0, 4), 0);
          const Vector3d velocity(random.between(-3, 3), random.between(-3, 3), 0);
          history.edit([=, &world, jumps = random.one_in(3)] { change(world, id, to, velocity, jumps); });
          if (random.one_in(3)) history.step(four.simulator->now());
          if (random.one_in(3)) four.simulator->next_time();
        }
      }
      while (history.step(end)) {
      }
      four.simulator->audit();
      if (!expected) expected.emplace(four.told(), history.events());
      CHECK(four.told() == expected->first);
      CHECK(history.events() == expected->second);
      four.forget();
      history.roll_back(four.simulator->now());  // from the beginning
      CHECK(four.told() == expected->first);
      CHECK(history.events() == expected->second);
    }
    CHECK(expected->first.bouncing.size() > 20);
    CHECK(expected->first.passing.size() > 5);
  }
}

}  // namespace kds::collision::test_windows_in_simulator
