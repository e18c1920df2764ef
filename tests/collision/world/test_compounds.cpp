// Bodies of several parts in worlds: they meet others when their parts do, bounce, come to rest, and are saved, the same
// with every broad phase.
#include "collision/narrow_phase/part_pairs.hpp"
#include "collision/queries/casts.hpp"
#include "collision/queries/future.hpp"
#include "collision/queries/nearest.hpp"
#include "kds/framework/snapshot.hpp"
#include "tests/collision/sample_compounds.hpp"
#include "tests/collision/world/resting_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace kds::collision::test_compounds {
namespace {

using namespace tests;

constexpr auto identity = [] { return Eigen::Quaterniond::Identity(); };

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

template <class F>
void throws(F&& f, const std::string& what) {
  INFO(what);
  try {
    f();
    FAIL("nothing was thrown");
  } catch (const std::invalid_argument& error) {
    INFO(error.what());
    CHECK(std::string(error.what()).find(what) != std::string::npos);
  }
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
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      INFO("seed " << seed << ", parts " << static_cast<int>(kinds));
      const Scene<2> heap = gas(seed, kinds, true);
      const auto scene = [&](World<2>& world) {
        world.add_body(fixed_body<2>(Box{{50, 50, 1}}, motion<2>({0, 0, -3})));
        for (auto each : heap.bodies) world.add_body(bouncy(each, 0.5));
        world.advance_to(6);
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

}  // namespace kds::collision::test_compounds
