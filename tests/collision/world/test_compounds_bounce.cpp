// Bodies of several parts that bounce, come to lie, and meet meshes that bend, the same with every broad phase.
#include "collision/shapes/bending_mesh.hpp"
#include "collision/shapes/mesh_script.hpp"
#include "tests/collision/world/compound_scenes.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace kds::collision::test_compounds_bounce {
namespace {

using namespace tests;

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

}  // namespace

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
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
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
  CHECK(near == 4 * all_methods.size());
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
        const Vector3d at(2.5 + 4 * (i % 2), 2.5 + 4.0 * (i / 2), 3);
        scene.bodies.push_back(body<2>(shape, motion<2>(at, {x, y, 0}, weight)));
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

}  // namespace kds::collision::test_compounds_bounce
