// Fast bodies that live shortly, among slow ones: the same events on every broad phase, whatever callbacks change, and
// few boxes and tests a life.
#include "collision/world.hpp"
#include "kds/framework/snapshot.hpp"
#include "tests/collision/event_log.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <cstdint>
#include <memory>
#include <vector>

namespace kds::collision::test_bullets {
namespace {

using namespace tests;
using kds::tests::Random;
using Motion = World<1>::Motion;

constexpr double side = 12;
constexpr double frame = 1.0 / 60;

/// Of many targets, so that the grid follows bullets through the cells of these.
class Game {
 public:
  Game(std::uint64_t seed, BroadPhaseKind kind, bool edits, Response response = Response::none)
      : random_(seed),
        edits_(edits),
        options_{.response = response,
                 .broad_phase = kind,
                 .walls = Walls{Vector3d::Constant(-side), Vector3d::Constant(side)}},
        world_(std::make_unique<World<1>>(options_, &log_)) {
    log_.then = [this](World<1>& world, const Event& event) { react(world, event); };
    for (int i = 0; i < 300; ++i) add(*world_, i >= 180);
  }
  Game(const Game&) = delete;
  Game& operator=(const Game&) = delete;

  void run_frame() {
    world_->advance_to(world_->now() + frame);
    for (; missing_bullets_ > 0; --missing_bullets_) add(*world_, true);
    for (; missing_targets_ > 0; --missing_targets_) add(*world_, false);
    world_->audit(world_->now());
  }
  void load_own_snapshot() {
    const Snapshot snapshot = save(*world_);
    world_ = std::make_unique<World<1>>(options_, &log_);
    restore(snapshot, *world_);
  }

  const std::vector<Event>& events() const { return log_.events; }
  WorldCounters counters() const { return world_->counters(); }
  std::uint64_t lives = 0, changes = 0;

 private:
  void add(World<1>& world, bool bullet) {
    const auto in = [&](double size) { return random_.between(-size, size); };
    Vector3d velocity(in(1), in(1), in(1));
    if (random_.one_in(8)) velocity[random_.integer(0, 2)] = 0;
    velocity *= bullet ? random_.between(100, 400) : 3;
    world.add_body({.shape = Sphere{bullet ? 0.02 : 0.5},
                    .motion = {Motion{{{in(side - 1), in(side - 1), in(side - 1)}, velocity}, world.now()}},
                    .category = bullet ? 2u : 1u,
                    .collides_with = bullet ? 1u : ~0u});
    ++lives;
  }
  void remove(World<1>& world, BodyId id) {
    ++(world.category(id) == 2 ? missing_bullets_ : missing_targets_);
    world.remove_body(id);
  }

  void react(World<1>& world, const Event& event) {
    if (event.kind == Kind::separation) return;
    const bool first = event.kind == Kind::wall || world.category(event.b) != 2;
    const BodyId id = first ? event.a : event.b;
    if (world.category(id) == 2 && !random_.one_in(8)) return remove(world, id);
    if (!edits_ || !world.contains(id)) return;
    ++changes;
    switch (random_.integer(0, 5)) {
      case 0:
        return remove(world, id);
      case 1:  // a jump
        return world.update_motion(id, Motion{{{random_.between(-side, side), 0, 0}, {1, 2, 3}}, world.now()});
      case 2: {
        Motion back = world.motion(id).restarted(world.now());
        back.coefficients[1] *= -random_.between(0.1, 2);
        return world.update_motion(id, back);
      }
      case 3:
        return world.set_filter(id, world.category(id), random_.one_in(2) ? ~0u : 1u);
      case 4:
        if (event.kind != Kind::wall && world.contains(event.a) && world.contains(event.b)) {
          world.ignore_pair(event.a, event.b, !world.ignores_pair(event.a, event.b));
        }
        return;
      default:
        return add(world, random_.one_in(2));
    }
  }

  Random random_;
  bool edits_;
  WorldOptions options_;
  EventLog<1> log_;
  std::unique_ptr<World<1>> world_;
  int missing_bullets_ = 0, missing_targets_ = 0;
};

TEST_CASE("Bullets hit what they hit on every broad phase, whatever changes and from snapshots",
          "[world][broad_phase]") {
  std::size_t contacts = 0;
  std::uint64_t changes = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const Response response = seed % 3 == 0 ? Response::elastic : Response::none;
    INFO("seed " << seed);
    Game expected(seed, BroadPhaseKind::all_pairs, true, response);
    Game grid(seed, BroadPhaseKind::grid, true, response);
    Game loaded(seed, BroadPhaseKind::automatic, true, response);
    for (int i = 1; i <= 18; ++i) {
      for (Game* const game : {&expected, &grid, &loaded}) game->run_frame();
      if (i % 3 == 0) loaded.load_own_snapshot();
    }
    const bool same = grid.events() == expected.events(), same_loaded = loaded.events() == expected.events();
    REQUIRE(same);
    REQUIRE(same_loaded);
    contacts += expected.counters().contacts;
    changes += expected.changes;
  }
  CHECK(contacts > 300);
  CHECK(changes > 300);
}

TEST_CASE("A bullet has few boxes and few tests in its life", "[world][broad_phase]") {
  Game game(1, BroadPhaseKind::grid, false);
  for (int i = 0; i < 60; ++i) game.run_frame();  // until the grid knows how long bullets live
  const auto before = game.counters();
  const std::uint64_t lives_before = game.lives;
  for (int i = 0; i < 60; ++i) game.run_frame();
  const auto work = game.counters() - before;
  const auto lives = static_cast<double>(game.lives - lives_before);
  REQUIRE(lives > 1000);
  CHECK(static_cast<double>(work.broad_phase.box_updates) < 2 * lives);
  CHECK(static_cast<double>(work.pair_tests) < 2 * lives);
}

}  // namespace
}  // namespace kds::collision::test_bullets
