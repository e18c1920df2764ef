// Scripts that are replaced and appended to, timers, user data, masses: what callers change while the world runs.
#include "kds/framework/snapshot.hpp"
#include "tests/collision/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace kds::collision::test_edits {
namespace {

using namespace tests;
using Catch::Matchers::Contains;
using Path = certificates::PointMotion<1>;

/// From the place of the last piece, with another velocity.
std::vector<Path> zigzag(int pieces) {
  std::vector<Path> path{Path::line({0, 0, 0}, {1, 0, 0}, 0)};
  for (int i = 1; i < pieces; ++i) {
    path.push_back(Path::line(path.back().position(i), {i % 2 == 0 ? 1. : -0.5, 0.25 * i, 0}, i));
  }
  return path;
}

TEST_CASE("A stream of pieces, appended as they start, gives the events of the whole script") {
  constexpr int pieces = 12;
  const auto path = zigzag(pieces);
  const auto run = [&](bool streams, bool snapshots) {
    struct Streamer final : WorldListener<1> {
      const std::vector<Path>* path = nullptr;
      std::vector<Event> events;
      std::size_t next = 2;
      std::vector<double> started;
      void contact(World<1>&, const PairEvent& e) override { events.push_back({Kind::contact, e.a, e.b, e.contact}); }
      void separation(World<1>&, const PairEvent& e) override {
        events.push_back({Kind::separation, e.a, e.b, e.contact});
      }
      void piece(World<1>& world, BodyId body) override {
        started.push_back(world.now());
        if (path && next < path->size()) world.append_motion(body, {&(*path)[next++], 1});
      }
    } streamer;
    WorldOptions options;
    options.report_pieces = true;
    auto world = std::make_unique<World<1>>(options, &streamer);
    auto flying = ball<1>(0.5, zero, zero);
    flying.motion = path;
    if (streams) flying.motion.resize(2), streamer.path = &path;
    world->add_body(flying);
    Random random(3);
    for (int i = 0; i < 40; ++i) {
      world->add_body(ball<1>(0.4, {random.between(-1, 4), random.between(-1, 16), 0.1}, zero));
    }
    for (const double t : {3.0, 5.5, 14.0}) {
      world->advance_to(t);
      if (!snapshots) continue;
      const Snapshot saved = save(*world);
      world = std::make_unique<World<1>>(options, &streamer);
      restore(saved, *world);
    }
    CHECK(streamer.started.size() == pieces - 1);
    for (std::size_t i = 0; i < streamer.started.size(); ++i) CHECK(streamer.started[i] == static_cast<double>(i + 1));
    return streamer.events;
  };
  const auto whole = run(false, false);
  CHECK(whole.size() > 10);
  CHECK(run(true, false) == whole);
  CHECK(run(true, true) == whole);
}

TEST_CASE("A body given a script takes up the piece of now, and then those to come") {
  World<1> world(WorldOptions{});
  const BodyId id = world.add_body(ball<1>(0.5, zero, zero));
  world.advance_to(2.5);
  const auto path = zigzag(5);
  world.update_motion(id, path);
  CHECK(world.motion(id) == path[2]);
  world.advance_to(3);
  CHECK(world.motion(id) == path[3]);
  world.update_motion(id, Path::line({7, 0, 0}, zero, 3));
  world.advance_to(9);
  CHECK(world.motion(id).position(9) == Vector3d(7, 0, 0));
}

TEST_CASE("Scripts that make no sense are refused, and change nothing") {
  World<1> world(WorldOptions{});
  const BodyId id = world.add_body(ball<1>(0.5, zero, {1, 0, 0}));
  world.advance_to(1);
  const Snapshot before = save(world);
  const auto line = [](double start) { return Path::line(zero, zero, start); };
  using Pieces = std::vector<Path>;
  CHECK_THROWS_WITH(world.update_motion(id, Pieces{}), "World::update_motion: motion: has no piece");
  CHECK_THROWS_WITH(world.update_motion(id, Pieces{line(0), line(2), line(2)}),
                    "World::update_motion: motion[2].start: pieces must be sorted by start");
  CHECK_THROWS_WITH(world.update_motion(id, Pieces{line(1.5), line(2)}), Contains("after the clock"));
  CHECK_THROWS_WITH(world.update_motion(id, Pieces{line(0), line(std::numeric_limits<double>::quiet_NaN())}),
                    Contains("motion[1]"));
  CHECK_THROWS_WITH(world.append_motion(id, Pieces{line(1)}), Contains("motion[0].start"));
  CHECK_THROWS_WITH(world.append_motion(id, Pieces{line(3), line(2)}), Contains("motion[1].start"));
  CHECK_THROWS_AS(world.append_motion(id + 1, Pieces{line(3)}), std::out_of_range);
  world.append_motion(id, Pieces{});
  CHECK(save(world) == before);
  world.append_motion(id, Pieces{line(3)});
  CHECK_THROWS_WITH(world.append_motion(id, Pieces{line(3)}), Contains("the last piece, 3"));
}

TEST_CASE("Timers ring at their times, in the order in which they were set, and after a snapshot too") {
  struct Told final : WorldListener<1> {
    std::vector<std::pair<double, TimerId>> rung;
    bool again = true;
    void timer(World<1>& world, TimerId timer) override {
      rung.emplace_back(world.now(), timer);
      if (timer == 1 && again) world.set_timer(world.now()), again = false;
    }
  } told;
  auto world = std::make_unique<World<1>>(WorldOptions{}, &told);
  CHECK(world->set_timer(2) == 0);
  CHECK(world->set_timer(1) == 1);
  CHECK(world->set_timer(2) == 2);
  CHECK(world->set_timer(1.5) == 3);
  CHECK(world->cancel_timer(3));
  CHECK_FALSE(world->cancel_timer(3));
  CHECK_FALSE(world->cancel_timer(77));
  CHECK(world->next_time() == 1);
  CHECK_THROWS_AS(world->set_timer(-1), std::invalid_argument);
  CHECK_THROWS_AS(world->set_timer(never), std::invalid_argument);
  world->advance_to(1);
  const Snapshot saved = save(*world);
  world = std::make_unique<World<1>>(WorldOptions{}, &told);
  restore(saved, *world);
  CHECK(world->set_timer(1e3) == 5);
  CHECK(world->step());
  CHECK(world->now() == 2);
  world->advance_to(1e6);
  using Rung = std::vector<std::pair<double, TimerId>>;
  CHECK(told.rung == Rung{{1, 1}, {1, 4}, {2, 0}, {2, 2}, {1e3, 5}});
}

TEST_CASE("A timer rings after the piece that starts then and before the contact of that time") {
  struct Told final : WorldListener<1> {
    std::string order;
    void piece(World<1>&, BodyId) override { order += 'p'; }
    void timer(World<1>&, TimerId) override { order += 't'; }
    void contact(World<1>&, const PairEvent&) override { order += 'c'; }
  } told;
  WorldOptions options;
  options.report_pieces = true;
  options.broad_phase = GENERATE(BroadPhaseKind::grid, BroadPhaseKind::kinetic_sap, BroadPhaseKind::all_pairs);
  World<1> world(options, &told);
  auto piecewise = ball<1>(1, {50, 0, 0}, zero);
  piecewise.motion.push_back(Path::line({50, 0, 0}, {1, 0, 0}, 2));
  world.add_body(piecewise);
  world.add_body(ball<1>(1, {0, 0, 0}, {1, 0, 0}));
  world.add_body(ball<1>(1, {6, 0, 0}, {-1, 0, 0}));
  world.set_timer(2);
  world.advance_to(3);
  CHECK(told.order == "ptc");
}

TEST_CASE("Events carry the data of users, also of bodies that have been removed") {
  struct Told final : WorldListener<1> {
    std::vector<std::pair<std::uint64_t, std::uint64_t>> of_contacts, of_separations;
    std::vector<std::uint64_t> of_walls;
    void contact(World<1>&, const PairEvent& e) override { of_contacts.emplace_back(e.user_data_a, e.user_data_b); }
    void separation(World<1>&, const PairEvent& e) override {
      of_separations.emplace_back(e.user_data_a, e.user_data_b);
    }
    void wall(World<1>&, const WallEvent& e) override { of_walls.push_back(e.user_data); }
  } told;
  WorldOptions options;
  options.walls = Walls{{-10, -10, -10}, {10, 10, 10}, 1};
  World<1> world(options, &told);
  auto left = ball<1>(1, {-3, 0, 0}, {1, 0, 0});
  left.user_data = 0xfeedfacecafebeef;
  const BodyId a = world.add_body(left);
  const BodyId b = world.add_body(ball<1>(1, {3, 0, 0}, {-1, 0, 0}));
  CHECK(world.user_data(a) == 0xfeedfacecafebeef);
  world.set_user_data(b, 7);
  world.advance_to(2.5);
  using Pairs = std::vector<std::pair<std::uint64_t, std::uint64_t>>;
  CHECK(told.of_contacts == Pairs{{0xfeedfacecafebeef, 7}});
  world.remove_body(a);
  const BodyId next = world.add_body(ball<1>(1, {0, 6, 0}, zero));  // in the same slot
  world.set_user_data(next, 1);
  world.advance_to(20);
  CHECK(told.of_separations == Pairs{{0xfeedfacecafebeef, 7}});
  CHECK(told.of_walls == std::vector<std::uint64_t>{7});
  World<1> loaded(options);
  restore(save(world), loaded);
  CHECK(loaded.user_data(b) == 7);
}

TEST_CASE("Partners of a body are those that it touches or rests on") {
  const auto partners = [](const auto& world, BodyId id) {
    std::vector<BodyId> found;
    world.visit_partners(id, [&](BodyId other) { found.push_back(other); });
    return found;
  };
  World<1> ghosts(WorldOptions{});
  for (const double x : {0.0, 1.5, 3.0, 9.0}) ghosts.add_body(ball<1>(1, {x, 0, 0}, zero));
  CHECK(partners(ghosts, 1).empty());  // not known before a step
  ghosts.advance_to(1);
  CHECK(partners(ghosts, 1) == std::vector<BodyId>{0, 2});
  CHECK(partners(ghosts, 3).empty());

  World<2> pile(with_response(Response::elastic));
  auto floor = body<2>(Box{{5, 5, 1}}, motion<2>({0, 0, -1}, zero, zero));
  floor.fixed = true;
  pile.add_body(floor);
  for (const double z : {0.75, 2.0}) {
    auto box = body<2>(Box{{0.5, 0.5, 0.5}}, motion<2>({0, 0, z}, zero, {0, 0, -5}));
    box.restitution = 0;
    pile.add_body(box);
  }
  pile.advance_to(3);
  CHECK(partners(pile, 1) == std::vector<BodyId>{0, 2});
  CHECK(partners(pile, 2) == std::vector<BodyId>{1});
  CHECK_THROWS_AS(partners(pile, 9), std::out_of_range);
}

TEST_CASE("A mass and a restitution that change count from the next contact on") {
  World<1> world(with_response(Response::elastic));
  const BodyId a = world.add_body(ball<1>(1, {-3, 0, 0}, {1, 0, 0}));
  const BodyId b = world.add_body(ball<1>(1, {3, 0, 0}, {-1, 0, 0}));
  world.advance_to(1);
  world.set_mass(a, 3);
  CHECK(world.mass(a) == 3);
  world.advance_to(2.5);
  CHECK(world.motion(a).velocity(2.5)[0] == Approx(0));
  CHECK(world.motion(b).velocity(2.5)[0] == Approx(2));
  world.update_motion(b, Path::line({10, 0, 0}, {-1, 0, 0}, 2.5));
  world.set_restitution(a, 0.5);
  CHECK(world.restitution(a) == 0.5);
  world.advance_to(20);
  CHECK(world.motion(b).velocity(20)[0] - world.motion(a).velocity(20)[0] == Approx(0.5));
  CHECK_THROWS_WITH(world.set_mass(a, 0), Contains("World::set_mass: mass"));
  CHECK_THROWS_WITH(world.set_restitution(a, 1.5), Contains("in [0, 1]"));
  auto rock = ball<1>(1, {0, 50, 0}, zero);
  rock.fixed = true;
  CHECK_THROWS_WITH(world.set_mass(world.add_body(rock), 2), Contains("is fixed"));
}

TEST_CASE("A mass that changes in a stack leaves all at rest") {
  World<2> world(with_response(Response::elastic));
  auto floor = body<2>(Box{{5, 5, 1}}, motion<2>({0, 0, -1}, zero, zero));
  floor.fixed = true;
  world.add_body(floor);
  for (int i = 0; i < 4; ++i) {
    auto box = body<2>(Box{{0.5, 0.5, 0.5}}, motion<2>({0, 0, 0.6 + 1.1 * i}, zero, {0, 0, -5}));
    box.restitution = 0.3;
    world.add_body(box);
  }
  world.advance_to(8);
  std::vector<double> heights;
  for (BodyId id = 1; id <= 4; ++id) heights.push_back(world.motion(id).position(8)[2]);
  for (const double mass : {100.0, 1e-3, 7.0}) {
    world.set_mass(2, mass);
    world.advance_to(world.now() + 1);
    world.audit();
    for (BodyId id = 1; id <= 4; ++id) {
      CHECK(world.motion(id).position(world.now())[2] == Approx(heights[id - 1]).margin(1e-9));
      CHECK(world.resting(id - 1, id));
    }
  }
}

}  // namespace
}  // namespace kds::collision::test_edits
