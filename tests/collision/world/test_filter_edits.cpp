// Bodies whose masks and groups change while the world runs, and pairs that are ignored for some time.
#include "kds/framework/snapshot.hpp"
#include "tests/collision/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

namespace kds::collision::test_filter_edits {
namespace {

using namespace tests;

constexpr double end = 6;  // s
constexpr BodyId balls = 14;

struct Filter {
  std::uint32_t category = 1;
  std::uint32_t collides_with = ~0u;
  std::uint32_t group = 0;

  bool meets(const Filter& other) const {
    return (category & other.collides_with) != 0 && (other.category & collides_with) != 0 &&
           (group == 0 || group != other.group);
  }
};
/// A body gets another filter; or, if there are two bodies, the pair is ignored or no longer.
struct Change {
  double time;
  BodyId body;
  Filter filter{};
  std::optional<BodyId> other{};
  bool ignored = false;

  void make(World<1>& world) const {
    if (other) return world.ignore_pair(body, *other, ignored);
    world.set_filter(body, filter.category, filter.collides_with);
    world.set_group(body, filter.group);
  }
};
struct Scene {
  std::vector<BodyDescription<1>> bodies;
  std::vector<Change> changes;  ///< by time
};

/// Balls that cross each other's ways, as many changes of filters as there are balls, and as many of pairs.
Scene random_scene(std::uint64_t seed) {
  Random random(seed);
  const auto vector = [&](double most) {
    return Vector3d(random.between(-most, most), random.between(-most, most), random.between(-most, most));
  };
  const auto mask = [&] { return static_cast<std::uint32_t>(random.between(1, 8)); };
  Scene scene;
  for (BodyId i = 0; i < balls; ++i) scene.bodies.push_back(ball<1>(random.between(1, 2.5), vector(4), vector(1)));
  for (BodyId i = 0; i < balls; ++i) {
    const auto group = static_cast<std::uint32_t>(random.between(0, 3));
    scene.changes.push_back(
        {random.between(0, end), static_cast<BodyId>(random.between(0, balls)), {mask(), mask(), group}});
  }
  for (BodyId i = 0; i < balls; ++i) {
    const auto other = static_cast<BodyId>(random.between(0, balls));
    if (other == i) continue;
    const double from = random.between(0, end), to = random.between(from, end);
    scene.changes.push_back({.time = from, .body = i, .other = other, .ignored = true});
    scene.changes.push_back({.time = to, .body = other, .other = i, .ignored = false});
  }
  std::sort(scene.changes.begin(), scene.changes.end(), [](auto& x, auto& y) { return x.time < y.time; });
  return scene;
}

/// How a run is made; its log must not depend on it.
struct Way {
  BroadPhaseKind method = BroadPhaseKind::all_pairs;
  bool by_timers = false;  ///< changes are made in callbacks
  bool snapshots = false;
  bool looks_ahead = false;
};

struct Changer final : WorldListener<1> {
  const std::vector<Change>* changes = nullptr;
  std::vector<Event>* events = nullptr;

  void contact(World<1>&, const PairEvent& e) override { events->push_back({Kind::contact, e.a, e.b, e.contact}); }
  void overlap(World<1>&, const PairEvent& e) override { events->push_back({Kind::overlap, e.a, e.b, e.contact}); }
  void separation(World<1>&, const PairEvent& e) override {
    events->push_back({Kind::separation, e.a, e.b, e.contact});
  }
  void rests(World<1>&, const PairEvent& e) override { events->push_back({Kind::rests, e.a, e.b, e.contact}); }
  void wakes(World<1>&, const PairEvent& e) override { events->push_back({Kind::wakes, e.a, e.b, e.contact}); }
  void timer(World<1>& world, TimerId timer) override { (*changes)[timer].make(world); }
};

std::vector<Event> run(const Scene& scene, const Way& way, Response response) {
  std::vector<Event> events;
  Changer changer;
  changer.changes = &scene.changes, changer.events = &events;
  WorldOptions options = with_response(response);
  options.broad_phase = way.method;
  options.rate = 5;
  auto world = std::make_unique<World<1>>(options, &changer);
  for (const auto& body : scene.bodies) world->add_body(body);
  for (const Change& change : scene.changes) {
    if (way.by_timers) {
      world->set_timer(change.time);
      continue;
    }
    world->advance_to(change.time);
    if (way.looks_ahead && way.method != BroadPhaseKind::sap) world->next_time();
    change.make(*world);
    if (way.looks_ahead && way.method != BroadPhaseKind::sap) world->next_time();
    if (way.looks_ahead) world->audit();
    if (!way.snapshots) continue;
    const Snapshot saved = save(*world);
    world = std::make_unique<World<1>>(options, &changer);
    restore(saved, *world);
  }
  world->advance_to(end);
  world->audit();
  return events;
}

/// When two balls penetrate, by the roots of the square of their distance, in doubles.
std::optional<std::pair<double, double>> meeting(const BodyDescription<1>& a, const BodyDescription<1>& b) {
  const Vector3d x = b.motion[0].coefficients[0] - a.motion[0].coefficients[0];
  const Vector3d v = b.motion[0].coefficients[1] - a.motion[0].coefficients[1];
  const double r = std::get<Sphere>(a.shape).radius + std::get<Sphere>(b.shape).radius;
  const double root = x.dot(v) * x.dot(v) - v.dot(v) * (x.dot(x) - r * r);
  if (root <= 0) return std::nullopt;
  return std::pair((-x.dot(v) - std::sqrt(root)) / v.dot(v), (-x.dot(v) + std::sqrt(root)) / v.dot(v));
}

using Expected = std::tuple<double, Kind, BodyId, BodyId>;

/// A pair is in contact while the balls penetrate, their filters meet, and it is not ignored.
std::vector<Expected> expected_of(const Scene& scene) {
  std::vector<Expected> expected;
  for (BodyId a = 0; a < balls; ++a) {
    for (BodyId b = a + 1; b < balls; ++b) {
      const auto span = meeting(scene.bodies[a], scene.bodies[b]);
      if (!span) continue;
      std::array<Filter, 2> filters;
      bool ignored = false;
      bool touches = false;
      const auto go = [&](double from, double to) {
        const bool allowed = filters[0].meets(filters[1]) && !ignored;
        const auto note = [&](double t, Kind kind) {
          expected.emplace_back(t, kind, a, b);
          touches = kind != Kind::separation;
        };
        const bool now = allowed && span->first <= from && from < span->second;
        if (touches != now) note(from, now ? Kind::overlap : Kind::separation);
        if (allowed && span->first > from && span->first <= to) note(span->first, Kind::contact);
        if (touches && span->second <= to) note(span->second, Kind::separation);
      };
      double t = 0;
      for (const Change& change : scene.changes) {
        const bool of_a = change.body == a || change.other == a, of_b = change.body == b || change.other == b;
        if (change.other ? !(of_a && of_b) : !(of_a || of_b)) continue;
        go(t, change.time);
        if (change.other) {
          ignored = change.ignored;
        } else {
          filters[of_a ? 0 : 1] = change.filter;
        }
        t = change.time;
      }
      go(t, end);
    }
  }
  std::sort(expected.begin(), expected.end());
  return expected;
}

TEST_CASE("Filters that change begin and end contacts, as brute force finds them") {
  constexpr double rounding = 1e-9;  // s: far above that of the roots, far below the distance of random events
  std::size_t by_change = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    CAPTURE(seed);
    const Scene scene = random_scene(seed);
    const auto expected = expected_of(scene);
    auto events = run(scene, {}, Response::none);
    std::sort(events.begin(), events.end(), [](const Event& x, const Event& y) {
      return std::tuple(x.time(), x.kind, x.a, x.b) < std::tuple(y.time(), y.kind, y.a, y.b);
    });
    REQUIRE(events.size() == expected.size());
    for (std::size_t i = 0; i < events.size(); ++i) {
      const auto& [time, kind, a, b] = expected[i];
      CAPTURE(i, time);
      CHECK(std::abs(events[i].time() - time) < rounding);
      CHECK(std::tuple(events[i].kind, events[i].a, events[i].b) == std::tuple(kind, a, b));
      by_change += kind == Kind::overlap && time > 0;
    }
  }
  CHECK(by_change > 200);
}

TEST_CASE("Filters change alike, whatever the broad phase, in callbacks and with snapshots in between") {
  const auto response = GENERATE(Response::none, Response::elastic);
  std::size_t count = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    CAPTURE(seed);
    const Scene scene = random_scene(seed);
    const auto expected = run(scene, {}, response);
    count += expected.size();
    for (const auto& [method, name, what] : broad_phases) {
      INFO(name);
      for (const Way& way : {Way{.method = method}, Way{.method = method, .by_timers = true},
                             Way{.method = method, .snapshots = true}, Way{.method = method, .looks_ahead = true}}) {
        CHECK(run(scene, way, response) == expected);
      }
    }
  }
  CHECK(count > 20);
}

/// The new ball stands where the old one stood, flies off the other ball, which it just touches, and is turned back at
/// once: where sorted lists tell of boxes, the pair begins only then.
TEST_CASE("An overlap that a filter has let begin is told once, whatever else changes at that instant") {
  using Edit = void (*)(World<1>&);
  constexpr std::size_t first_jump = 3;
  const std::array<Edit, 5> edits{
      [](World<1>& world) { world.set_group(1, 1); },
      [](World<1>& world) { world.set_filter(0, 3, ~0u); },
      [](World<1>& world) { world.ignore_pair(1, 2); },
      [](World<1>& world) {
        world.update_motion(1, motion<1>({1.25, 0, 0}, {1, 0, 0}, zero, 0.5));
      },  // a jump
      [](World<1>& world) {
        world.update_motion(1, motion<1>({1.25, 0, 0}, {1, 0, 0}, zero, 0.5));
        world.set_group(1, 1);
      },
  };
  const auto run = [&](BroadPhaseKind method, Response response, bool sensor, std::size_t i) {
    CAPTURE(static_cast<int>(method), static_cast<int>(response), sensor, i);
    EventLog<1> log;
    int told = 0;
    log.then = [&](World<1>& world, const Event& event) {
      if (event.kind == Kind::overlap && ++told == 1) edits[i](world);
    };
    World<1> world({.response = response, .broad_phase = method, .rate = 16}, &log);
    auto alone = ball<1>(1, {0, 0, 0});
    alone.collides_with = 0;
    auto passing = ball<1>(1, {1, 0, 0}, {1, 0, 0});
    passing.sensor = sensor;
    world.add_body(alone);
    world.add_body(passing);
    world.add_body(ball<1>(1, {0, 9, 0}));
    world.advance_to(0.5);
    world.set_filter(0, 1, ~0u);
    world.advance_to(4);
    const bool passes = sensor || response == Response::none;
    CHECK(log.count(Kind::overlap) == (passes || i < first_jump ? 1 : 2));  // who jumps enters anew, if contacts count
    CHECK(log.count(Kind::contact) == 0);
    CHECK(log.count(Kind::separation) == (passes ? 1 : 0));
    world.audit();
  };
  for (const auto method : all_methods) {
    for (const auto response : {Response::none, Response::elastic}) {
      for (const bool sensor : {false, true}) {
        for (std::size_t i = 0; i < edits.size(); ++i) run(method, response, sensor, i);
      }
    }
  }
}

TEST_CASE("A body that gets the slot of one whose filter has changed at that instant begins anew") {
  EventLog<1> log;
  WorldOptions options = with_response(Response::none);
  options.broad_phase = GENERATE(BroadPhaseKind::all_pairs, BroadPhaseKind::grid, BroadPhaseKind::kinetic_sap);
  World<1> world(options, &log);
  auto first = ball<1>(0.5, {1.5, 0, 0});
  first.group = 1;
  auto other = ball<1>(1, zero);
  other.group = 1;
  world.add_body(first);
  const BodyId still = world.add_body(other);
  world.advance_to(1);
  world.set_group(0, 0);
  world.remove_body(0);
  const BodyId second = world.add_body(body<1>(Sphere{0.5}, motion<1>({1.5, 0, 0}, {3, 0, 0}, zero, 1)));
  REQUIRE(body_slot(second) == 0);
  CHECK(log.events.empty());
  log.then = [&](World<1>& w, const Event& e) {
    if (e.kind == Kind::overlap) w.update_motion(second, World<1>::Motion::line({1.5, 0, 0}, {-3, 0, 0}, 1));
  };
  world.add_body(ball<1>(0.5, {1.75, 0, 0}));  // in contact with the second
  world.advance_to(1.1);
  REQUIRE(log.events.size() == 2);
  CHECK(log.events[1].kind == Kind::contact);
  CHECK(log.events[1].a == still);
  CHECK(log.events[1].b == second);
}

TEST_CASE("A ball whose mask leaves out the floor under it wakes and falls, and rests on if it does not") {
  struct Told final : WorldListener<2> {
    std::vector<std::pair<BodyId, BodyId>> woken;
    void wakes(World<2>&, const PairEvent& e) override { woken.emplace_back(e.a, e.b); }
  } told;
  WorldOptions options = with_response(Response::elastic);
  options.broad_phase = GENERATE(BroadPhaseKind::grid, BroadPhaseKind::kinetic_sap, BroadPhaseKind::automatic);
  World<2> world(options, &told);
  BodyDescription<2> floor = body<2>(Box{{5, 5, 1}}, motion<2>({0, 0, -1}, zero, zero));
  floor.fixed = true;
  floor.category = 2;
  world.add_body(floor);
  auto falling = body<2>(Sphere{0.5}, motion<2>({0, 0, 0.75}, zero, {0, 0, -5}));
  falling.restitution = 0.25;
  const BodyId ball = world.add_body(falling);
  world.advance_to(5);
  REQUIRE(world.resting(0, ball));
  world.set_filter(ball, 1, ~4u);  // The floor is not concerned.
  world.advance_to(6);
  CHECK(told.woken.empty());
  CHECK(world.resting(0, ball));
  world.set_filter(ball, 1, ~2u);
  world.advance_to(7);
  CHECK(told.woken == std::vector<std::pair<BodyId, BodyId>>{{0, ball}});
  CHECK_FALSE(world.resting(0, ball));
  CHECK(world.motion(ball).position(7)[2] == Approx(0.5 - 5));
  world.audit();
}

}  // namespace
}  // namespace kds::collision::test_filter_edits
