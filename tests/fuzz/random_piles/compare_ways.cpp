// The same scene in other ways: events must be the same, bit for bit.
#include "collision/world.hpp"
#include "kds/framework/snapshot.hpp"
#include "tests/fuzz/random_piles/measure.hpp"

#include <array>
#include <bit>
#include <cstdio>
#include <memory>
#include <string>

namespace kds::piles {
namespace {

using collision::BodyId;
using collision::BroadPhaseKind;
using collision::PairEvent;
using collision::WallEvent;
using collision::World;

struct Event {
  char kind = ' ';
  std::uint64_t a = 0;
  std::uint64_t b = 0;
  std::array<std::uint64_t, 4> bits{};  ///< of the time and the normal

  friend bool operator==(const Event&, const Event&) = default;
  double time() const { return std::bit_cast<double>(bits[0]); }
};

struct Log : collision::WorldListener<2> {
  std::vector<Event> events;

  void note(char kind, BodyId a, std::uint64_t b, const collision::Contact& c) {
    Event event{kind, std::uint64_t{a}, b, {std::bit_cast<std::uint64_t>(c.time)}};
    for (int d = 0; d < 3; ++d) event.bits[static_cast<std::size_t>(d) + 1] = std::bit_cast<std::uint64_t>(c.normal[d]);
    events.push_back(event);
  }
  void contact(World<2>&, const PairEvent& e) override { note('c', e.a, std::uint64_t{e.b}, e.contact); }
  void overlap(World<2>&, const PairEvent& e) override { note('o', e.a, std::uint64_t{e.b}, e.contact); }
  void rebound_suppressed(World<2>&, const PairEvent& e) override { note('h', e.a, std::uint64_t{e.b}, e.contact); }
  void wall(World<2>&, const WallEvent& e) override {
    note('w', e.body, static_cast<std::uint64_t>(e.wall), e.contact);
  }
  void rebound_suppressed_at_wall(World<2>&, const WallEvent& e) override {
    note('H', e.body, static_cast<std::uint64_t>(e.wall), e.contact);
  }
  void moved(World<2>& world, BodyId id) override {
    collision::Contact c{.time = world.now()};
    c.normal = world.motion(id).position(world.now());
    note('m', id, 0, c);
  }
};

struct Run {
  Log log{};
  std::unique_ptr<World<2>> world{};

  Run(const Scene& scene, BroadPhaseKind kind, bool empty = false) {
    world = std::make_unique<World<2>>(
        collision::WorldOptions{.response = collision::Response::elastic, .broad_phase = kind, .walls = scene.walls},
        &log);
    if (empty) return;
    for (const Description& body : scene.bodies) world->add_body(body);
  }
  void until(double t, std::uint64_t most_steps) {
    while (most_steps-- > 0 && world->step(t)) {
    }
  }
};

void compare(const char* what, const Log& expected, const Log& found, Result& result) {
  const std::size_t n = std::min(expected.events.size(), found.events.size());
  std::size_t i = 0;
  while (i < n && expected.events[i] == found.events[i]) ++i;
  if (i == n && expected.events.size() == found.events.size()) return;
  char text[200] = "one log ends";
  double time = 0;
  if (i < n) {
    const Event& e = expected.events[i];
    const Event& f = found.events[i];
    time = e.time();
    std::snprintf(text, sizeof text, "event %zu: %c %llu %llu at %.17g, and %c %llu %llu at %.17g", i, e.kind,
                  static_cast<unsigned long long>(e.a), static_cast<unsigned long long>(e.b), e.time(), f.kind,
                  static_cast<unsigned long long>(f.a), static_cast<unsigned long long>(f.b), f.time());
  }
  result.findings.push_back({what, time, 1, text});
}

}  // namespace

void compare_ways(const Scene& scene, const Budget& budget, Result& result) {
  Run first(scene, BroadPhaseKind::automatic);
  first.until(scene.seconds, budget.steps);
  for (const BroadPhaseKind kind : {BroadPhaseKind::all_pairs, BroadPhaseKind::grid, BroadPhaseKind::kinetic_sap}) {
    Run other(scene, kind);
    other.until(scene.seconds, budget.steps);
    compare("other broad phase", first.log, other.log, result);
  }
  // Saved where half of the steps have been made, which is where most is going on.
  Run saved(scene, BroadPhaseKind::automatic);
  saved.until(scene.seconds, result.events / 2);
  Run loaded(scene, BroadPhaseKind::automatic, true);
  loaded.log.events = saved.log.events;
  try {
    kds::restore(kds::save(*saved.world), *loaded.world);
  } catch (const std::exception& failure) {
    result.findings.push_back({"snapshot", saved.world->now(), 1, failure.what()});
    return;
  }
  loaded.until(scene.seconds, budget.steps);
  compare("loaded world", first.log, loaded.log, result);
}

}  // namespace kds::piles
