// Bodies of several parts in worlds: they meet others when their parts do, are seen by queries, and are saved, the same
// with every broad phase.
#include "collision/queries/casts.hpp"
#include "collision/queries/future.hpp"
#include "collision/queries/nearest.hpp"
#include "kds/framework/snapshot.hpp"
#include "tests/collision/world/compound_scenes.hpp"

#include <catch2/catch.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace kds::collision::test_compounds {
namespace {

using namespace tests;

Eigen::Quaterniond identity() { return Eigen::Quaterniond::Identity(); }

}  // namespace

TEMPLATE_TEST_CASE_SIG("compounds: worlds report what their parts do, by any broad phase", "[world][compound]",
                       ((int Degree), Degree), 1, 2) {
  std::size_t reported = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    INFO("seed " << seed);
    const Scene<Degree> scene = mixed_scene<Degree>(seed, false);
    const std::vector<Told> expected = told_by_parts(scene);
    std::vector<Event> first;
    for (const auto method : all_methods) {
      INFO("method " << static_cast<int>(method));
      const auto log = run(scene, with_method(method), {.audit = seed % 4 == 0});
      const bool as_parts = told(log) == expected;
      CHECK(as_parts);
      check_turns(log);
      if (method == all_methods.front()) first = log;
      const bool same = log == first;
      CHECK(same);
    }
    for (const int kdop : {14, 18, 26}) {
      WorldOptions options = with_method(BroadPhaseKind::kinetic_sap);
      options.kdop = kdop;
      const bool same = run(scene, options, {.audit = seed % 4 == 1}) == first;
      CHECK(same);
    }
    reported += expected.size();
  }
  CHECK(reported > 250);
}

TEMPLATE_TEST_CASE_SIG("compounds: scripts and jumps, the same log by any broad phase", "[world][compound]",
                       ((int Degree), Degree), 1, 2) {
  std::size_t reported = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    INFO("seed " << seed);
    const Scene<Degree> scene = mixed_scene<Degree>(seed, true);
    std::vector<Event> first;
    for (const auto method : all_methods) {
      INFO("method " << static_cast<int>(method));
      const auto log = run(scene, with_method(method), {.polls_per_second = seed % 2 == 0 ? 7.0 : 0.0});
      check_turns(log);
      if (method == all_methods.front()) first = log;
      const bool same = log == first;
      CHECK(same);
    }
    reported += first.size();
  }
  CHECK(reported > 150);
}

TEST_CASE("compounds: a box cut in two meets the others when the whole one does", "[world][compound]") {
  std::size_t reported = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    INFO("seed " << seed);
    Random random(seed);
    SceneOptions options;
    options.shapes = seed % 2 == 0 ? Shapes::spheres : Shapes::boxes;
    options.numbers = seed % 3 == 0 ? Numbers::coarse : Numbers::fine;
    options.scripts = seed % 5 == 0;
    Scene<2> whole = SceneMaker(random, options).scene<2>();
    Scene<2> cut = whole;
    for (std::size_t i = 0; i < whole.bodies.size(); i += 2) {
      const Vector3d half(0.5 + 0.125 * random.integer(0, 4), 0.75, 0.125 * random.integer(2, 9));
      whole.bodies[i].shape = Box{half};
      cut.bodies[i].shape = cut_box(half, 0.25 * random.integer(-3, 3));
      whole.bodies[i].orientation = cut.bodies[i].orientation = identity();
    }
    const auto of_whole = told(run(whole, with_method(BroadPhaseKind::grid)));
    const auto of_cut = told(run(cut, with_method(BroadPhaseKind::grid)));
    const bool same = of_whole == of_cut;
    CHECK(same);
    reported += of_cut.size();
  }
  CHECK(reported > 300);
}

TEST_CASE("compounds are saved, and go on as they would have", "[world][compound][snapshot]") {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    INFO("seed " << seed);
    const bool elastic = seed % 2 == 0;
    const Scene<2> scene = elastic ? gas(seed, Parts::all, true) : mixed_scene<2>(seed, true);
    EventLog<2> log;
    World<2> world(with_method(BroadPhaseKind::grid, elastic ? Response::elastic : Response::none), &log);
    for (const auto& each : scene.bodies) world.add_body(each);
    world.advance_to(1);
    const Snapshot saved = save(world);
    const std::size_t before = log.events.size();
    world.advance_to(3);
    EventLog<2> again;
    World<2> other(with_method(BroadPhaseKind::kinetic_sap, elastic ? Response::elastic : Response::none), &again);
    restore(saved, other);
    other.audit();
    CHECK(other.shape(0).parts->size() == world.shape(0).parts->size());
    other.advance_to(3);
    const std::vector<Event> rest(log.events.begin() + static_cast<std::ptrdiff_t>(before), log.events.end());
    const bool same = again.events == rest;
    CHECK(same);
    CHECK(rest.size() > 3);
  }
}

TEST_CASE("compounds: queries see their parts", "[world][compound]") {
  // Two posts, and a beam across them: one can pass below.
  const std::vector<CompoundPart> parts{
      {Box{{0.5, 0.5, 2}}, {-3, 0, 0}}, {Box{{0.5, 0.5, 2}}, {3, 0, 0}}, {Box{{3.5, 0.5, 0.5}}, {0, 0, 2.5}}};
  const Compound gate = compound(parts);
  for (const auto method : all_methods) {
    World<2> world(with_method(method));
    const BodyId id = world.add_body(body<2>(gate, motion<2>({0, 10, 0}, {0, -1, 0})));
    world.advance_to(2);  // y = 8
    CHECK(!cast(world, Ray{{0, 0, 0}, {0, 20, 0}}));
    const auto post = cast(world, Ray{{3, 0, 0}, {3, 20, 0}});
    REQUIRE(post);
    CHECK((post->body == id && post->contact.normal == Vector3d::UnitY()));
    CHECK(post->contact.point.isApprox(Vector3d(3, 7.5, 0)));
    CHECK(!cast(world, placed_ball(1.5), {{0, 0, 0}, {0, 20, 0}}));
    CHECK(cast(world, placed_ball(3), {{0, 0, 0}, {0, 20, 0}}));
    const PlacedShape other = place(gate, unit_quaternion(1, 0, 1, 0));
    const auto all = cast_all(world, other, {{0, 0, 0}, {0, 20, 0}});
    REQUIRE(all.size() == 1);
    CHECK(all[0].contact.time == Approx(7.0 / 20).epsilon(1e-15));
    CHECK(overlapping(world, placed_ball(1), {0, 8, 0}).empty());
    CHECK(overlapping(world, placed_ball(1), {2, 8, 0}) == std::vector<BodyId>{id});
    CHECK(overlapping(world, place(compound(std::vector{CompoundPart{Box{{1, 1, 1}}, {0, 0, 9}}}), identity()),
                      {0, 8, -7}) == std::vector<BodyId>{id});
    const auto near = nearest(world, {1, 8, 0}, 1);
    REQUIRE(near.size() == 1);
    CHECK((near[0].distance == 1.5 && near[0].point == Vector3d(2.5, 8, 0)));
    CHECK(nearest(world, {0, 8, 2.5}, 1)[0].distance == 0);
    const auto meets = next_contact(world, placed_ball(0.5), motion<2>({3, 0, 0}), 9);
    REQUIRE(meets);
    CHECK(meets->contact.time == 9);
    CHECK(!next_contact(world, placed_ball(0.5), motion<2>({0, 0, 0}), 99));
  }
}

TEST_CASE("compounds: one is removed while its contact is told", "[world][compound]") {
  for (const Response response : {Response::none, Response::elastic, Response::callback}) {
    const Scene<2> scene = gas(3, Parts::all);
    std::vector<Event> first;
    for (const auto method : all_methods) {
      EventLog<2> log;
      World<2> world(with_method(method, response), &log);
      int removed = 0;
      log.then = [&](World<2>& w, const Event& e) {
        if (e.kind != Kind::contact) return;
        if (w.contains(e.a) && removed < 4 && e.a % 2 == 0) {
          w.remove_body(e.a);
          ++removed;
          auto again = scene.bodies[e.a % 18];
          again.motion[0].coefficients[0] += Vector3d(0, 0, 20);
          w.add_body(again);
        } else if (response == Response::callback && w.contains(e.a) && w.contains(e.b)) {
          for (const BodyId id : {e.a, e.b}) {
            const auto path = w.motion(id).restarted(w.now());
            w.update_motion(id, motion<2>(path.coefficients[0], -path.coefficients[1], zero, w.now()));
          }
        }
      };
      for (const auto& each : scene.bodies) world.add_body(each);
      for (double t = 0.5; t <= 4; t += 0.5) world.advance_to(t), world.audit();
      CHECK(removed == 4);
      if (method == all_methods.front()) first = log.events;
      const bool same = log.events == first;
      CHECK(same);
    }
  }
}

TEST_CASE("compounds: masks, sensors and half-spaces", "[world][compound]") {
  const std::vector<CompoundPart> parts{{Box{{0.5, 0.5, 0.5}}, {-2, 0, 0}}, {Box{{0.5, 0.5, 0.5}}, {2, 0, -1}}};
  const Compound two = compound(parts);
  const auto scene = [&](World<2>& world) {
    world.add_body(fixed_body<2>(HalfSpace{Vector3d::UnitZ()}, motion<2>(zero)));
    world.add_body(bouncy(body<2>(two, motion<2>({0, 0, 4}, zero, weight)), 0));
    auto sensor = body<2>(two, motion<2>({0, 9, 3.5}, {0, 0, -1}));
    sensor.sensor = true;
    world.add_body(sensor);
    auto blind = body<2>(two, motion<2>({0, 20, 3.5}, {0, 0, -1}));
    blind.collides_with = 2;
    world.add_body(blind);
    world.advance_to(6);
  };
  with_all_methods(elastic(), scene, [](World<2>& world, EventLog<2>& log) {
    CHECK(world.resting(0, 1));
    CHECK(world.motion(1).position(6)[2] == Approx(1.5).margin(1e-9));
    const auto contacts = log.of(Kind::contact);
    REQUIRE(contacts.size() == 2);
    CHECK((contacts[1].b == 2 && contacts[1].time() == 2));
    CHECK(log.count(Kind::separation) == 0);
  });
}

}  // namespace kds::collision::test_compounds
