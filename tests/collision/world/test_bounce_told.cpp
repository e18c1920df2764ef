// What callbacks see and may do while a bounce off a wall is told: bodies are removed, moved and added, and neighbours
// asked for. Fast ones that ignore each other, as in a game, so that the grid learns from those that are removed.
#include "collision/world.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <tuple>
#include <vector>

namespace kds::collision::test_bounce_told {
namespace {

using Eigen::Vector3d;
using kds::tests::Random;
using Motion = World<1>::Motion;

struct Told {
  double time;
  std::size_t kind;  // 0 to 5: a wall; 6 a contact, 7 an overlap, 8 a separation
  BodyId a, b;
  std::vector<BodyId> near;
  friend bool operator==(const Told& x, const Told& y) = default;
};

/// Targets that bounce, and bullets that are removed at walls and by hits, and replaced.
class Game final : public WorldListener<1> {
 public:
  explicit Game(std::uint64_t seed, bool throws = false) : random_(seed), throws_(throws) {}

  void add(World<1>& world, bool bullet) {
    const auto in = [&](double size) { return random_.between(-size, size); };
    const Vector3d position(in(9), in(9), in(4));
    const Vector3d velocity(in(1), in(1), random_.one_in(3) ? 0.0 : in(0.3));
    const BodyId id = world.add_body({.shape = Sphere{bullet ? 0.02 : 0.5},
                                      .motion = {Motion{{position, (bullet ? 100 : 3) * velocity}, world.now()}},
                                      .category = bullet ? 2u : 1u,
                                      .collides_with = bullet ? 1u : 2u});
    if (bullets_.size() <= body_slot(id)) bullets_.resize(body_slot(id) + 1);
    bullets_[body_slot(id)] = bullet;
  }

  void contact(World<1>& world, const PairEvent& event) override { hit(world, 6, event); }
  void overlap(World<1>& world, const PairEvent& event) override { hit(world, 7, event); }
  void separation(World<1>&, const PairEvent& event) override {
    told.push_back({event.contact.time, 8, std::min(event.a, event.b), std::max(event.a, event.b), {}});
  }
  void wall(World<1>& world, const WallEvent& event) override {
    Told one{event.contact.time, static_cast<std::size_t>(event.wall), event.body, event.body, {}};
    if (random_.one_in(2)) {  // what it and its like will meet, with its new motion
      const Motion motion = world.motion(event.body);
      const auto box = box_around<1>(motion, Vector3d::Constant(-0.1), Vector3d::Constant(0.1));
      world.visit_swept(box, world.now() + 0.01, [&](BodyId id) { one.near.push_back(id); });
      asked_itself += std::count(one.near.begin(), one.near.end(), event.body);
      ++asked;
    }
    told.push_back(one);
    if (throws_ && random_.one_in(10)) throw std::runtime_error("a callback that fails");
    const bool bullet = is_bullet(event.body);
    switch (random_.below(bullet ? 3 : 8)) {
      case 0:
        world.remove_body(event.body);
        add(world, bullet);
        break;
      case 1:
        add(world, bullet);  // before, so that the bounce is taken up first
        world.remove_body(event.body);
        break;
      case 2:
        world.update_motion(event.body, world.motion(event.body).restarted(world.now()));
        break;
      default:
        break;
    }
  }

  std::vector<Told> told;
  std::ptrdiff_t asked = 0, asked_itself = 0;

 private:
  bool is_bullet(BodyId id) const { return bullets_[body_slot(id)] != 0; }
  void hit(World<1>& world, std::size_t kind, const PairEvent& event) {
    told.push_back({event.contact.time, kind, event.a, event.b, {}});
    const BodyId bullet = is_bullet(event.a) ? event.a : event.b;
    if (!random_.one_in(3)) return;
    world.remove_body(bullet);
    add(world, true);
  }

  Random random_;
  std::vector<char> bullets_;  // by slot
  bool throws_;
};

Game run(BroadPhaseKind kind, std::uint64_t seed, bool throws = false) {
  Game game(seed, throws);
  World<1> world(
      {.response = Response::none, .broad_phase = kind, .walls = Walls{Vector3d(-10, -10, -5), Vector3d(10, 10, 5)}},
      &game);
  for (int i = 0; i < 30; ++i) game.add(world, false);
  for (int i = 0; i < 120; ++i) game.add(world, true);
  for (int frame = 1; frame <= 30; ++frame) {
    for (bool done = false; !done;) {
      try {
        world.advance_to(frame / 60.0);
        done = true;
      } catch (const std::runtime_error&) {
      }
    }
    world.audit();
  }
  return game;
}

TEST_CASE("Bodies that are removed, moved and asked about as they bounce off walls: all methods agree",
          "[world][bounce_told]") {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    for (const bool throws : {false, true}) {
      INFO("seed " << seed << (throws ? ", callbacks that throw" : ""));
      const Game expected = run(BroadPhaseKind::all_pairs, seed, throws);
      for (const auto kind : {BroadPhaseKind::automatic, BroadPhaseKind::grid, BroadPhaseKind::kinetic_sap}) {
        const Game found = run(kind, seed, throws);
        REQUIRE(found.told.size() == expected.told.size());
        CHECK(found.told == expected.told);
      }
      CHECK(expected.asked > 100);
      CHECK(expected.asked_itself == expected.asked);
      CHECK(std::count_if(expected.told.begin(), expected.told.end(), [](const Told& t) { return t.kind == 6; }) > 10);
    }
  }
}

}  // namespace
}  // namespace kds::collision::test_bounce_told
