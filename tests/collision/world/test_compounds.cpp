// Bodies of several parts in worlds: they meet others when their parts do, bounce, come to rest, and are saved, the same
// with every broad phase.
#include "collision/narrow_phase/part_pairs.hpp"
#include "collision/queries/casts.hpp"
#include "collision/queries/future.hpp"
#include "collision/queries/nearest.hpp"
#include "collision/shapes/bending_mesh.hpp"
#include "collision/shapes/mesh_script.hpp"
#include "kds/framework/snapshot.hpp"
#include "tests/collision/sample_compounds.hpp"
#include "tests/collision/world/resting_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <tuple>
#include <utility>
#include <vector>

namespace kds::collision::test_compounds {
namespace {

using namespace tests;

Eigen::Quaterniond identity() { return Eigen::Quaterniond::Identity(); }

/// What happens between two bodies, without its place.
using Told = std::tuple<double, BodyId, BodyId, Kind>;

std::vector<Told> told(const std::vector<Event>& events) {
  std::vector<Told> result;
  for (const Event& e : events) result.emplace_back(e.time(), e.a, e.b, e.kind);
  std::sort(result.begin(), result.end());
  return result;
}

/// What a world reports of two bodies on one piece of motion each, as their parts have it, each pair by itself: the
/// contacts of the two begin when one begins and no other lasts, and end when none lasts.
template <int Degree>
void tell_parts(const Scene<Degree>& scene, BodyId a, BodyId b, std::vector<Told>& result) {
  const PlacedShape shape_a = place(scene.bodies[a].shape, scene.bodies[a].orientation);
  const PlacedShape shape_b = place(scene.bodies[b].shape, scene.bodies[b].orientation);
  std::map<double, int> changes;  // of how many pairs of parts are in contact
  for (const PlacedShape& part_a : parts_of(shape_a)) {
    for (const PlacedShape& part_b : parts_of(shape_b)) {
      const TranslatingShape<Degree> x{part_a, scene.bodies[a].motion[0]}, y{part_b, scene.bodies[b].motion[0]};
      double t = 0;
      while (t <= scene.end_time) {
        const double begin = first_contact(x, y, t, scene.end_time, ContactMode::transparent);
        if (begin == never) break;
        t = first_separation(x, y, begin, scene.end_time);
        ++changes[begin];
        if (t != never) --changes[t];
      }
    }
  }
  int before = 0;
  for (const auto& [time, change] : changes) {
    const int after = before + change;
    if (before == 0 && after > 0) result.emplace_back(time, a, b, time == 0 ? Kind::overlap : Kind::contact);
    if (before > 0 && after == 0) result.emplace_back(time, a, b, Kind::separation);
    before = after;
  }
}

template <int Degree>
std::vector<Told> told_by_parts(const Scene<Degree>& scene) {
  std::vector<Told> result;
  for (BodyId a = 0; a < scene.bodies.size(); ++a) {
    for (BodyId b = a + 1; b < scene.bodies.size(); ++b) tell_parts(scene, a, b, result);
  }
  std::sort(result.begin(), result.end());
  return result;
}

/// Contacts and separations of each pair take turns.
void check_turns(const std::vector<Event>& events) {
  std::map<std::pair<BodyId, BodyId>, bool> together;
  for (const Event& e : events) {
    const bool begins = e.kind == Kind::contact || e.kind == Kind::overlap;
    if (!begins && e.kind != Kind::separation) continue;
    bool& now = together[{e.a, e.b}];
    CHECK(now != begins);
    now = begins;
  }
}

template <int Degree>
Scene<Degree> mixed_scene(std::uint64_t seed, bool scripts) {
  Random random(seed);
  SceneOptions options;
  options.shapes = seed % 2 == 0 ? Shapes::mixture : Shapes::turned_boxes;
  options.numbers = seed % 3 == 0 ? Numbers::coarse : Numbers::fine;
  options.scripts = scripts;
  options.bodies = 12;
  return compound_scene<Degree>(random, options, seed % 2 == 0 ? Parts::all : Parts::solids);
}

WorldOptions with_method(BroadPhaseKind method, Response response = Response::none) {
  WorldOptions options;
  options.broad_phase = method;
  options.response = response;
  options.rate = 16;
  return options;
}

/// Whether two bodies overlap by more than roundings: as one body may touch another in several places, it is moved out
/// of one after the other.
bool deep(const World<2>& world, BodyId a, BodyId b) {
  constexpr double roundings = 1e-9;
  const PlacedShape shape_a = world.shape(a), shape_b = world.shape(b);
  const auto path = world.motion(a);
  auto moved = world.motion(b);
  for (int i = 0; i < 6; ++i) {
    const TranslatingShape<2> x{shape_a, path}, y{shape_b, moved};
    if (!in_contact(x, y, world.now())) return false;
    moved.coefficients[0] += roundings * contact_at(x, y, world.now()).normal;
  }
  return true;
}

double energy(const World<2>& world) {
  double sum = 0;
  for (BodyId id = 0; id < world.size(); ++id) {
    if (!world.fixed(id)) sum += 0.5 * world.mass(id) * world.motion(id).velocity(world.now()).squaredNorm();
  }
  return sum;
}
Vector3d momentum(const World<2>& world) {
  Vector3d sum = zero;
  for (BodyId id = 0; id < world.size(); ++id) sum += world.mass(id) * world.motion(id).velocity(world.now());
  return sum;
}

/// Bodies on a lattice, every other one a compound, that fly about and do not overlap at the start.
Scene<2> gas(std::uint64_t seed, Parts kinds, bool falls = false) {
  Random random(seed);
  Scene<2> scene;
  for (int i = 0; i < 18; ++i) {
    Vector3d at(3.5 * (i % 3), 3.5 * (i / 3 % 3), 3.5 * (i / 9)), velocity;
    for (int d = 0; d < 3; ++d) velocity[d] = random.between(-2, 2) - 0.4 * (at[d] - 3);
    const Shape shape = i % 2 == 0 ? Shape(random_compound(random, kinds, 3, 0.6))
                                   : i % 3 == 0 ? Shape(Sphere{0.7}) : i % 3 == 1 ? Shape(Box{{0.5, 0.8, 0.6}})
                                                                                  : Shape(Capsule{0.4, 0.5});
    auto b = body<2>(shape, motion<2>(at, velocity, falls ? weight : zero), random.between(0.5, 2));
    b.orientation = unit_quaternion(random.between(0.1, 1), 0.5, 0.25, -0.5);
    scene.bodies.push_back(b);
  }
  return scene;
}

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

TEST_CASE("compounds bounce: momentum and energy stay, and none comes into another", "[world][compound]") {
  std::size_t contacts = 0;
  for (const Parts kinds : {Parts::boxes, Parts::solids, Parts::all}) {
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      INFO("seed " << seed << ", parts " << static_cast<int>(kinds));
      const Scene<2> scene = gas(seed, kinds);
      std::vector<Event> first;
      for (const auto method : all_methods) {
        EventLog<2> log;
        World<2> world(with_method(method, Response::elastic), &log);
        for (const auto& each : scene.bodies) world.add_body(each);
        world.advance_to(0);
        REQUIRE(log.count(Kind::overlap) == 0);
        const double before = energy(world);
        const Vector3d momentum_before = momentum(world);
        for (double t = 0.25; t <= 4; t += 0.25) {
          world.advance_to(t);
          world.audit();
          if (method != all_methods.front()) continue;
          for (BodyId a = 0; a < scene.bodies.size(); ++a) {
            for (BodyId b = a + 1; b < scene.bodies.size(); ++b) CHECK(!deep(world, a, b));
          }
        }
        CHECK(energy(world) == Approx(before).epsilon(1e-12));
        CHECK((momentum(world) - momentum_before).norm() < 1e-12 * (1 + momentum_before.norm()));
        CHECK(log.count(Kind::rebound_suppressed) == 0);
        if (method == all_methods.front()) first = log.events;
        const bool same = log.events == first;
        CHECK(same);
      }
      contacts += first.size();
    }
  }
  CHECK(contacts > 200);
}

TEST_CASE("compounds fall in a heap and come to lie", "[world][compound]") {
  for (const Parts kinds : {Parts::solids, Parts::all}) {
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
      INFO("seed " << seed << ", parts " << static_cast<int>(kinds));
      const Scene<2> heap = gas(seed, kinds, true);
      const auto scene = [&](World<2>& world) {
        world.add_body(fixed_body<2>(Box{{50, 50, 1}}, motion<2>({0, 0, -3})));
        for (auto each : heap.bodies) world.add_body(bouncy(each, 0.5));
        world.advance_to(4);
      };
      with_all_methods(elastic(), scene, [&](World<2>& world, EventLog<2>& log) {
        CHECK(log.count(Kind::contact) > 20);
        for (BodyId a = 0; a < world.size(); ++a) {
          for (BodyId b = a + 1; b < world.size(); ++b) CHECK(!deep(world, a, b));
        }
      });
    }
  }
}

TEST_CASE("compounds: a heap of boxes cut in two goes the way of the whole boxes", "[world][compound]") {
  const auto heap = [](World<2>& world, const auto& shape) {
    world.add_body(floor_box());
    for (int i = 0; i < 3; ++i) {
      const Vector3d at(0.25 * (i % 2), 0.125 * (i % 3), 1 + 1.5 * i);
      world.add_body(bouncy(body<2>(shape(Vector3d(0.5, 0.5, 0.25)), motion<2>(at, zero, weight)), 0.25));
    }
    world.add_body(bouncy(ball<2>(0.5, {0.25, 0.25, 8}, zero, weight), 0.25));
    world.advance_to(5);
    world.audit();
  };
  World<2> boxes(elastic()), cut(elastic());
  heap(boxes, [](const Vector3d& half) { return Shape(Box{half}); });
  heap(cut, [](const Vector3d& half) { return Shape(cut_box(half, 0.25)); });
  for (BodyId id = 1; id <= 3; ++id) {
    INFO("body " << id);
    CHECK(at_rest(cut, id));
    // In a cluster they are kept apart by a millionth of their size, as meshes are.
    CHECK((cut.motion(id).position(5) - boxes.motion(id).position(5)).norm() < 1e-6);
  }
}

TEST_CASE("compounds: a ball comes to lie between two parts, and a table on its legs", "[world][compound]") {
  // A groove of two planks that lean against each other, and a plate on four legs.
  const Eigen::Quaterniond left = unit_quaternion(std::cos(0.3), 0, std::sin(0.3), 0), right = left.conjugate();
  const std::vector<CompoundPart> groove{{Box{{2, 4, 0.25}}, {-1.6, 0, 0.6}, left},
                                         {Box{{2, 4, 0.25}}, {1.6, 0, 0.6}, right}};
  std::vector<CompoundPart> table{{Box{{1, 1, 0.125}}, {0, 0, 1}}};
  for (const double x : {-0.75, 0.75}) {
    for (const double y : {-0.75, 0.75}) table.push_back({Box{{0.125, 0.125, 0.5}}, {x, y, 0.375}});
  }
  const auto scene = [&](World<2>& world) {
    world.add_body(floor_box());
    world.add_body(fixed_body<2>(compound(groove), motion<2>({0, 0, 2})));
    world.add_body(bouncy(ball<2>(0.5, {0.5, 0, 6}, zero, weight), 0.25));
    world.add_body(bouncy(body<2>(compound(table), motion<2>({10, 0, 2}, zero, weight)), 0.25));
    world.add_body(bouncy(body<2>(Box{{0.5, 0.5, 0.5}}, motion<2>({10, 0, 5}, zero, weight)), 0.25));
    world.advance_to(9);
  };
  with_all_methods(elastic(), scene, [](World<2>& world, EventLog<2>&) {
    CHECK(world.resting(1, 2));
    CHECK(std::abs(world.motion(2).position(9)[0]) < 1e-6);
    CHECK(world.resting(0, 3));
    CHECK(world.motion(3).position(9)[2] == Approx(0.125).margin(1e-9));
    CHECK(world.resting(3, 4));
    CHECK(world.motion(4).position(9)[2] == Approx(1.75).margin(1e-9));
    for (BodyId id = 2; id <= 4; ++id) {
      INFO("body " << id);
      CHECK(world.motion(id).velocity(9).norm() < 1e-3);  // a tremble of a millionth of its size
    }
  });
}

TEST_CASE("compounds: what is put into a corner touches all of it, and lies there", "[world][compound]") {
  const std::vector<CompoundPart> corner{{Box{{2, 2, 0.5}}, {0, 0, -0.5}},
                                         {Box{{0.5, 2, 2}}, {-2.5, 0, 1}},
                                         {Box{{2, 0.5, 2}}, {0, -2.5, 1}}};
  std::size_t near = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    INFO("seed " << seed);
    Random random(seed);
    const double w = random.between(0.1, 1), x = random.between(-1, 1), y = random.between(-1, 1);
    const Eigen::Quaterniond turned = unit_quaternion(w, x, y, random.between(-1, 1));
    const double half = random.between(0.1, 0.4);
    const Eigen::Matrix3d axes = turned.toRotationMatrix();
    const auto scene = [&](World<2>& world) {
      auto base = fixed_body<2>(compound(corner), motion<2>({1.25, -0.5, 3.1}));
      base.orientation = turned;
      world.add_body(base);
      const Vector3d place = base.motion[0].coefficients[0] + axes * Vector3d(half - 2, half - 2, half);
      auto guest = bouncy(body<2>(Box{{half, half, half}}, motion<2>(place, zero, axes * Vector3d(-1, -1, -5))), 0);
      guest.orientation = turned;
      world.add_body(guest);
      world.advance_to(1);
      near += (world.motion(1).position(1) - place).norm() < 1e-6;
    };
    with_all_methods(elastic(), scene, [&](World<2>& world, EventLog<2>& log) {
      CHECK(log.count(Kind::overlap) == 0);
      CHECK(world.resting(0, 1));
    });
  }
  CHECK(near == 20 * all_methods.size());
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

TEST_CASE("compounds meet meshes that bend when their parts do, and bounce off them", "[world][compound]") {
  // A sheet that heaves, and bodies of two parts that fall on it.
  std::vector<Vector3d> low, high;
  std::vector<Mesh::Triangle> triangles;
  for (std::uint32_t i = 0; i < 4; ++i) {
    for (std::uint32_t j = 0; j < 4; ++j) {
      low.emplace_back(3.0 * i, 3.0 * j, 0), high.emplace_back(3.0 * i, 3.0 * j, (i + j) % 2 == 0 ? 0.5 : 0.25);
      if (i == 3 || j == 3) continue;
      const std::uint32_t k = 4 * i + j;
      triangles.push_back({k, k + 4, k + 5}), triangles.push_back({k, k + 5, k + 1});
    }
  }
  const auto script = std::make_shared<const MeshScript>(
      std::vector<MeshScript::Keyframe>{{0, low}, {1, high}, {2, low}, {3, high}}, triangles);
  for (const Response response : {Response::none, Response::elastic}) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      INFO("seed " << seed << ", response " << static_cast<int>(response));
      Random random(seed);
      Scene<2> scene;
      scene.end_time = 2.5;
      scene.bodies.push_back(fixed_body<2>(BendingMesh{script}, motion<2>(zero)));
      for (int i = 0; i < 4; ++i) {
        const double x = random.between(-0.3, 0.3), y = random.between(-0.3, 0.3);
        const Shape shape = random_compound(random, Parts::solids, 2, 0.5);
        scene.bodies.push_back(body<2>(shape, motion<2>({2.5 + 4 * (i % 2), 2.5 + 4.0 * (i / 2), 3}, {x, y, 0}, weight)));
      }
      std::vector<Event> first;
      for (const auto method : all_methods) {
        const auto log = run(scene, with_method(method, response), {.audit = true});
        if (method == all_methods.front()) first = log;
        const bool same = log == first;
        CHECK(same);
      }
      if (response == Response::none) {
        check_turns(first);
        const bool as_parts = told(first) == told_by_parts(scene);
        CHECK(as_parts);
        continue;
      }
      World<2> world(with_method(BroadPhaseKind::grid, response));
      for (const auto& each : scene.bodies) world.add_body(each);
      world.advance_to(scene.end_time);
      CHECK(first.size() >= 4);
      for (BodyId id = 1; id <= 4; ++id) {
        CHECK(world.motion(id).position(2.5)[2] > -0.1);
        CHECK(!deep(world, 0, id));
      }
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
