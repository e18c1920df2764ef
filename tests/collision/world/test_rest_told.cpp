// What rests on what, as listeners are told.
#include "tests/collision/world/resting_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace kds::collision::test_rest_told {
namespace {

using namespace tests;
using Eigen::Vector3d;

/// One word an event.
struct Words final : WorldListener<2> {
  using World = collision::World<2>;
  void rests(World& world, const PairEvent& e) override { add("rests", e, world); }
  void wakes(World& world, const PairEvent& e) override { add("wakes", e, world); }
  void passes(World& world, const PairEvent& e) override { add("passes", e, world); }
  void rests_at_wall(World&, const WallEvent& e) override { add("rests", e); }
  void wakes_at_wall(World&, const WallEvent& e) override { add("wakes", e); }

  void add(const std::string& word, const PairEvent& e, const World& world) {
    words.push_back(word + " " + std::to_string(e.a) + " " + std::to_string(e.b));
    last = e.contact;
    CHECK(e.contact.time == world.now());
  }
  void add(const std::string& word, const WallEvent& e) {
    words.push_back(word + " " + std::to_string(e.body) + " at " + std::to_string(e.wall));
    last = e.contact;
  }
  std::vector<std::string> take() { return std::exchange(words, {}); }

  std::vector<std::string> words;
  Contact last;
};

using Strings = std::vector<std::string>;

TEST_CASE("Rest told: a ball comes to rest, is kicked, and lands again", "[resting]") {
  Words words;
  World<2> world(elastic(), &words);
  world.add_body(floor_box());
  const BodyId ball_id = world.add_body(bouncy(ball<2>(1, {2, 3, 4}, zero, weight), 0.5));
  world.advance_to(20);
  CHECK(words.take() == Strings{"rests 0 1"});
  CHECK(words.last.normal == Vector3d(0, 0, 1));
  CHECK((words.last.point - Vector3d(2, 3, 0)).norm() < 1e-9);
  auto kicked = world.free_motion(ball_id).restarted(20);
  kicked.coefficients[1] = Vector3d(1, 0, 2);
  world.update_motion(ball_id, kicked);
  world.advance_to(20.01);
  CHECK(words.take() == Strings{"wakes 0 1"});
  world.advance_to(40);
  CHECK(words.take() == Strings{"rests 0 1"});
  world.remove_body(0);
  world.advance_to(41);
  CHECK(words.take() == Strings{"wakes 0 1"});
}

TEST_CASE("Rest told: at a wall", "[resting]") {
  Words words;
  WorldOptions options = elastic();
  options.walls = Walls{Vector3d(-9, -9, 0), Vector3d(9, 9, 9), 0};
  World<2> world(options, &words);
  world.add_body(bouncy(ball<2>(1, {2, 3, 4}, zero, weight), 0.5));
  world.advance_to(20);
  CHECK(words.take() == Strings{"rests 0 at 4"});
  CHECK(words.last.normal == Vector3d(0, 0, -1));
  CHECK((words.last.point - Vector3d(2, 3, 0)).norm() < 1e-9);
  auto kicked = world.free_motion(0).restarted(20);
  kicked.coefficients[1] = Vector3d(0, 0, 2);
  world.update_motion(0, kicked);
  world.advance_to(20.01);
  CHECK(words.take() == Strings{"wakes 0 at 4"});
}

TEST_CASE("Rest told: what is squeezed passes", "[resting]") {
  Words words;
  World<2> world(elastic(), &words);
  world.add_body(fixed_body<2>(Box{{50, 50, 1}}, motion<2>({0, 0, -1})));
  world.add_body(fixed_body<2>(Box{{50, 50, 1}}, motion<2>({0, 0, 6}, {0, 0, -1})));
  world.add_body(bouncy(ball<2>(1, {0, 0, 2}, zero, weight), 0));
  world.advance_to(20);
  const Strings told = words.take();
  REQUIRE(!told.empty());
  CHECK(std::count_if(told.begin(), told.end(), [](const std::string& word) { return word.starts_with("passes"); }) >=
        1);
}

}  // namespace
}  // namespace kds::collision::test_rest_told
