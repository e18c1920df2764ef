// The arena in a world.
#include "tests/benchmarks/speed/arena.hpp"

#include "collision/world.hpp"

#include <cstddef>
#include <ranges>
#include <stdexcept>

namespace speed {

using namespace kds::collision;
using Eigen::Vector3d;

Arena::Start Arena::start(std::uint32_t body, std::uint32_t life) const {
  std::uint64_t state = (seed * 0x9E3779B97F4A7C15 + body) * 0x9E3779B97F4A7C15 + life;
  const auto between = [&state](double low, double high) {  // splitmix64
    std::uint64_t z = state += 0x9E3779B97F4A7C15;
    z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9;
    z = (z ^ z >> 27) * 0x94D049BB133111EB;
    return low + (high - low) * (static_cast<double>((z ^ z >> 31) >> 11) * 0x1p-53);
  };
  Start at;
  for (int d = 0; d < 3; ++d) at.position[d] = between(low[d] + 2, high[d] - 2);
  for (int d = 0; d < 3; ++d) at.velocity[d] = d < 2 ? between(-1, 1) : between(-0.2, 0.2);
  at.velocity *= (is_target(body) ? between(2, 8) : between(150, 450)) / at.velocity.norm();
  return at;
}

namespace {

class Game final : public WorldListener<1> {
 public:
  Game(const Arena& arena, std::vector<Hit>& hits)
      : arena_(arena), hits_(hits), hits_of_(arena.targets), lives_(arena.bodies()) {}

  /// Also the one that has just been removed: it gets its slot again if the last one that was is the first.
  void add(World<1>& world, std::uint32_t body) {
    const bool target = arena_.is_target(body);
    const auto [position, velocity] = arena_.start(body, lives_[body]++);
    if (target) hits_of_[body] = 0;
    const BodyId id = world.add_body({.shape = Sphere{target ? Arena::target_radius : Arena::bullet_radius},
                                      .motion = {World<1>::Motion{{position, velocity}, world.now()}},
                                      .restitution = 1,
                                      .category = target ? 1u : 2u,
                                      .collides_with = target ? 2u : 1u});
    if (body_slot(id) != body) throw std::logic_error("the arena's bodies are numbered by their slots");
  }

  void contact(World<1>& world, const PairEvent& event) override { hit(world, event); }
  void overlap(World<1>& world, const PairEvent& event) override { hit(world, event); }
  void wall(World<1>& world, const WallEvent& event) override {
    if (arena_.is_target(body_slot(event.body))) return;
    ++walls_;
    kill(world, event.body);
  }

  void replace_the_dead(World<1>& world) {
    for (const std::uint32_t body : dead_ | std::views::reverse) add(world, body);
    dead_.clear();
  }

  std::uint64_t walls() const { return walls_; }

 private:
  void hit(World<1>& world, const PairEvent& event) {
    const auto target = body_slot(event.a);
    hits_.push_back({event.contact.time, target, body_slot(event.b)});
    kill(world, event.b);
    if (++hits_of_[target] == Arena::lives) kill(world, event.a);
  }
  void kill(World<1>& world, BodyId id) {
    dead_.push_back(body_slot(id));
    world.remove_body(id);
  }

  const Arena& arena_;
  std::vector<Hit>& hits_;
  std::vector<int> hits_of_;
  std::vector<std::uint32_t> lives_;
  std::vector<std::uint32_t> dead_;
  std::uint64_t walls_ = 0;
};

}  // namespace

ArenaOutcome run_arena(const Arena& arena, std::vector<Hit>& hits) {
  const double begun = kds::benchmarks::thread_seconds();
  Game game(arena, hits);
  World<1> world({.response = Response::none, .walls = Walls{arena.low, arena.high}}, &game);
  for (std::uint32_t body = 0; body < arena.bodies(); ++body) game.add(world, body);
  world.advance_to(0);
  const double set_up = kds::benchmarks::thread_seconds();
  for (std::uint64_t frame = 1; frame <= arena.frames(); ++frame) {
    world.advance_to(arena.end_of(frame));
    game.replace_the_dead(world);
  }
  const double done = kds::benchmarks::thread_seconds();
  return {set_up - begun, done - set_up, game.walls(), world.counters().pair_tests};
}

}  // namespace speed
