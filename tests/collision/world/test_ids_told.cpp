// All that a world tells and answers names bodies by their ids. Where nothing was removed an id is the slot, so the
// worlds here are ones whose slots have all been reused.
#include "collision/world.hpp"
#include "kds/framework/snapshot.hpp"
#include "tests/collision/event_log.hpp"
#include "tests/collision/random_scenes.hpp"
#include "tests/collision/world/resting_scenes.hpp"

#include <catch2/catch.hpp>

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <tuple>
#include <vector>

namespace kds::collision::test_ids_told {
namespace {

using namespace tests;

/// Who takes part. The next body that is added gets the next slot.
enum : BodySlot { ground, lower, upper, blow, bouncing, first, second, gone, gone_sensor, sensor, passing, bodies };

/// Writes down who is told of, by slot; what is said of a body with another generation than all have is wrong.
class Told final : public WorldListener<2> {
 public:
  explicit Told(std::uint32_t generation) : generation_(generation) {}

  using Line = std::tuple<std::string, BodySlot, BodySlot, double>;
  std::vector<Line> lines;
  std::map<std::string, std::size_t> counts;
  std::size_t wrong = 0;

  void contact(World<2>& w, const PairEvent& e) override { note(w, "contact", e.a, e.b); }
  void separation(World<2>& w, const PairEvent& e) override { note(w, "separation", e.a, e.b); }
  void overlap(World<2>& w, const PairEvent& e) override {
    note(w, "overlap", e.a, e.b);
    // What is still to be told of these is not told any more: neither their overlaps nor that they have ended.
    if (body_slot(e.b) != second) return;
    w.remove_body(id(gone));
    w.remove_body(id(gone_sensor));
  }
  void rebound_suppressed(World<2>& w, const PairEvent& e) override { note(w, "rebound_suppressed", e.a, e.b); }
  void wall(World<2>& w, const WallEvent& e) override { note(w, "wall", e.body, e.body); }
  void rebound_suppressed_at_wall(World<2>& w, const WallEvent& e) override {
    note(w, "rebound_suppressed_at_wall", e.body, e.body);
  }
  void pair_began(World<2>& w, BodyId a, BodyId b, double) override { note(w, "pair_began", a, b); }
  void pair_ended(World<2>& w, BodyId a, BodyId b, double) override { note(w, "pair_ended", a, b); }
  void moved(World<2>& w, BodyId a) override { note(w, "moved", a, a); }

  BodyId id(BodySlot slot) const { return body_id(generation_, slot); }

 private:
  void note(const World<2>& world, const std::string& what, BodyId a, BodyId b) {
    wrong += body_generation(a) != generation_;
    wrong += body_generation(b) != generation_;
    lines.emplace_back(what, body_slot(a), body_slot(b), world.now());
    ++counts[what];
  }

  std::uint32_t generation_;
};

BodyDescription<2> as_sensor(BodyDescription<2> description) {
  description.sensor = true;
  return description;
}

/// One of everything that can be told, in order of their slots.
std::vector<BodyDescription<2>> scene() {
  std::vector<BodyDescription<2>> all(bodies);
  all[ground] = fixed_body<2>(Box{{2, 2, 1}}, motion<2>({0, 0, 1}));
  all[lower] = bouncy(ball<2>(1, {0, 0, 3.5}, zero, weight), 0.5);
  all[upper] = bouncy(ball<2>(1, {0, 0, 6}, zero, weight), 0.5);
  all[blow] = ball<2>(1, {40, 0, 5}, {-2, 0, 0});  // strikes the upper one when both have come to rest
  all[bouncing] = bouncy(ball<2>(1, {-10, 0, 3}, zero, weight), 0.5);
  all[first] = ball<2>(1, {-20, 0, 9});
  all[second] = ball<2>(1, {-20, 1, 9});
  all[gone] = ball<2>(1, {-20, 0.25, 9});
  all[gone_sensor] = as_sensor(ball<2>(1, {-20, 0.5, 9}));
  all[sensor] = as_sensor(ball<2>(1, {-30, 0, 9}));
  all[passing] = ball<2>(1, {-30, 3, 9}, {0, -0.5, 0});
  return all;
}

void fill(World<2>& world, std::uint32_t generation) {
  for (std::uint32_t i = 0; i < generation; ++i) {
    for (BodySlot slot = 0; slot < bodies; ++slot) world.add_body(ball<2>(1, zero));
    for (BodySlot slot = bodies; slot-- > 0;) world.remove_body(body_id(i, slot));  // so that 0 is given first
  }
  BodySlot slot = 0;
  for (const auto& description : scene()) REQUIRE(world.add_body(description) == body_id(generation, slot++));
}

TEST_CASE("Ids: everything told in a world of reused slots names bodies by their ids", "[world][ids]") {
  for (const auto method : all_methods) {
    CAPTURE(static_cast<int>(method));
    std::vector<Told::Line> lines;
    for (const std::uint32_t generation : {0u, 3u}) {
      WorldOptions options = with_response(Response::elastic);
      options.broad_phase = method;
      options.rate = method == BroadPhaseKind::sap ? 16 : 0;  // frames a second
      options.report_pairs = true;
      options.walls = Walls{{-50, -50, 0}, {50, 50, 50}, 1};
      Told told(generation);
      World<2> world(options, &told);
      fill(world, generation);
      world.advance_to(4);
      world.audit();
      REQUIRE(world.touching(told.id(sensor), told.id(passing)));
      world.advance_to(12);  // it has passed
      CHECK(world.resting(told.id(ground), told.id(lower)));
      CHECK(world.resting_at_wall(told.id(bouncing), 4));
      world.advance_to(40);
      CHECK(told.wrong == 0);
      for (const char* what : {"contact", "separation", "overlap", "rebound_suppressed", "wall",
                               "rebound_suppressed_at_wall", "pair_began", "pair_ended", "moved"}) {
        INFO(what);
        CHECK(told.counts[what] > 0);
      }
      CHECK(told.counts["overlap"] == 1);
      CHECK(told.counts["separation"] == 1);
      if (generation == 0) {
        lines = told.lines;
      } else {
        CHECK(told.lines == lines);
      }
    }
  }
}

TEST_CASE("Ids: what is removed and what is asked for is named by id in a world of reused slots", "[world][ids]") {
  Told told(2);
  World<2> world(with_response(Response::elastic), &told);
  fill(world, 2);
  world.advance_to(4);
  std::vector<BodyId> named;
  const auto visit = [&](BodyId id) { named.push_back(id); };
  const Vector3d at(-30, 1, 9);
  world.visit_overlapping(at, at, visit);
  CHECK(named == std::vector{told.id(sensor), told.id(passing)});
  named.clear();
  world.visit_swept(box_around<2>(motion<2>(at), zero, zero), 4.5, visit);
  CHECK(named == std::vector{told.id(sensor), told.id(passing)});

  world.remove_body(told.id(sensor));
  const BodyId next = world.add_body(ball<2>(1, {-30, 20, 9}));
  REQUIRE(next == body_id(3, sensor));
  world.advance_to(5);
  CHECK(told.counts["separation"] == 1);  // of the one that has gone
  CHECK(told.wrong == 0);

  auto boxed = ball<2>(1, {-30, 30, 9});
  boxed.box = [](double t, const certificates::PointMotion<2>& path) {
    return box_around<2>(path.restarted(t), Vector3d::Constant(-1), Vector3d::Constant(1));
  };
  world.remove_body(next);
  const BodyId last = world.add_body(boxed);
  CHECK_THROWS_WITH(save(world), Catch::Contains("body " + std::to_string(last) + " "));
}

}  // namespace
}  // namespace kds::collision::test_ids_told
