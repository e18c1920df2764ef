// Convex hulls in worlds: they bounce, lie, lean on what is round, meet meshes, and are saved, the same with every
// broad phase.
#include "collision/shapes/convex_hull.hpp"
#include "kds/framework/snapshot.hpp"
#include "tests/collision/world/resting_scenes.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace kds::collision::test_hulls {
namespace {

using namespace tests;

const std::vector<Vector3d> octahedron{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};

std::vector<Vector3d> box_corners(const Vector3d& half) {
  std::vector<Vector3d> corners;
  for (int k = 0; k < 8; ++k) {
    corners.emplace_back(k & 1 ? half[0] : -half[0], k & 2 ? half[1] : -half[1], k & 4 ? half[2] : -half[2]);
  }
  return corners;
}

BodyDescription<2> falling(const Shape& shape, const Vector3d& place,
                           const Eigen::Quaterniond& turned = Eigen::Quaterniond::Identity()) {
  auto result = body<2>(shape, motion<2>(place, zero, weight));
  result.orientation = turned;
  return result;
}

Vector3d place_of(const World<2>& world, BodyId id) { return world.motion(id).position(world.now()); }

}  // namespace

TEST_CASE("hulls bounce: normal and features are those of what they hit", "[world][hull]") {
  const auto scene = [](World<2>& world) {
    world.add_body(floor_box());
    world.add_body(falling(convex_hull(octahedron), {0, 0, 2.25}));                                      // on its tip
    world.add_body(falling(convex_hull(box_corners({0.5, 0.5, 1})), {9, 0, 2.25}));                      // on a face
    world.add_body(falling(convex_hull({{1, 0, 0}, {-1, 0, 0}, {0, 1, 1}, {0, -1, 1}}), {0, 9, 1.25}));  // on an edge
    world.advance_to(1);
  };
  with_all_methods(elastic(), scene, [](World<2>& world, EventLog<2>& log) {
    const auto contacts = log.of(Kind::contact);
    REQUIRE(contacts.size() == 3);
    for (const Event& contact : contacts) {
      CHECK(contact.time() == 0.5);  // 1.25 = 5 t^2
      CHECK(contact.contact.normal == Vector3d::UnitZ());
      CHECK(contact.contact.feature_a == Feature::face(5));
    }
    CHECK(contacts[0].contact.feature_b == Feature::vertex(5));
    CHECK(contacts[1].contact.feature_b.kind == Feature::Kind::face);
    CHECK(contacts[2].contact.feature_b == Feature::edge(0, 1));
    CHECK(contacts[0].contact.point == Vector3d(0, 0, 0));
    CHECK(place_of(world, 1) == Vector3d(0, 0, 2.25));  // back where they came from
    CHECK(place_of(world, 2) == Vector3d(9, 0, 2.25));
  });
}

TEST_CASE("a heap of hulls goes the way of the same heap of boxes", "[world][hull]") {
  const auto heap = [](const auto& shape) {
    return [shape](World<2>& world) {
      world.add_body(floor_box());
      for (int i = 0; i < 4; ++i) {
        world.add_body(
            bouncy(falling(shape(Vector3d(0.5, 0.5, 0.25)), {0.25 * (i % 2), 0.125 * (i % 3), 1 + 1.5 * i}), 0.25));
      }
      world.add_body(bouncy(falling(Sphere{0.5}, {0.25, 0.25, 8}), 0.25));
      world.advance_to(5);
    };
  };
  EventLog<2> of_boxes;
  World<2> boxes(elastic(), &of_boxes);
  heap([](const Vector3d& half) { return Shape(Box{half}); })(boxes);
  const auto hulls = heap([](const Vector3d& half) { return Shape(convex_hull(box_corners(half))); });
  with_all_methods(elastic(), hulls, [&](World<2>& world, EventLog<2>& log) {
    CHECK(log.of(Kind::contact).size() == of_boxes.of(Kind::contact).size());
    for (BodyId id = 1; id <= 4; ++id) {
      INFO("body " << id);
      CHECK(at_rest(world, id));
      CHECK((place_of(world, id) - place_of(boxes, id)).norm() < 1e-9);
    }
  });
}

TEST_CASE("hulls come to lie on a mesh, and balls and capsules on hulls", "[world][hull]") {
  const auto plate = std::make_shared<const Mesh>(std::vector<Vector3d>{{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}},
                                                  std::vector<Mesh::Triangle>{{0, 1, 2}, {0, 2, 3}});
  const auto scene = [&](World<2>& world) {
    world.add_body(fixed_body<2>(MeshShape{plate, 1}, motion<2>({0, 0, 0})));
    world.add_body(fixed_body<2>(convex_hull(box_corners({3, 3, 0.5})), motion<2>({20, 0, -0.5})));
    world.add_body(bouncy(falling(convex_hull(box_corners({0.5, 0.5, 1})), {0, 0, 3}), 0));
    world.add_body(bouncy(falling(Sphere{0.5}, {20, 0, 2}), 0));
    world.add_body(bouncy(falling(Capsule{0.5, 1}, {21, 1, 2}, {0.5, 0.5, 0.5, 0.5}), 0));
    world.advance_to(6);
  };
  with_all_methods(elastic(), scene, [](World<2>& world, EventLog<2>& log) {
    CHECK(world.resting(0, 2));
    CHECK(place_of(world, 2)[2] == Approx(1).margin(1e-9));
    CHECK(world.resting(1, 3));
    CHECK(place_of(world, 3)[2] == Approx(0.5).margin(1e-9));
    CHECK(world.resting(1, 4));
    for (const Event& contact : log.of(Kind::contact)) {
      if (contact.b == 2) CHECK(contact.contact.feature_b.kind == Feature::Kind::face);
    }
  });
}

TEST_CASE("what is inside of a hull is in contact with it until it has come out", "[world][hull]") {
  const auto ring = std::make_shared<const Mesh>(std::vector<Vector3d>{{0, 0, 0}, {0.5, 0, 0}, {0, 0.5, 0}},
                                                 std::vector<Mesh::Triangle>{{0, 1, 2}});
  EventLog<1> log;
  World<1> world({}, &log);
  world.add_body(body<1>(MeshShape{ring, 1}, motion<1>({0, 0, 0}, {0, 0, 1})));
  world.add_body(body<1>(convex_hull(box_corners({2, 2, 2})), motion<1>({0, 0, 0})));
  world.advance_to(5);
  REQUIRE(log.of(Kind::overlap).size() == 1);
  REQUIRE(log.of(Kind::separation).size() == 1);
  CHECK(log.of(Kind::separation)[0].time() == Approx(2).margin(1e-9));
}

/// When a mesh that passes through a hull ceases to touch it, with all of that moved by `away` along each axis.
std::vector<double> partings(std::uint64_t seed, double away) {
  samples::Random random(seed);
  const auto coarse = [&](double high) {  // and so exact wherever it is
    return Vector3d(random.vector(high).unaryExpr([](double x) { return std::round(x * 256) / 256; }));
  };
  const Vector3d place = coarse(1) + Vector3d::Constant(away);
  auto passing = body<1>(MeshShape{samples::ball_mesh(0), 1}, motion<1>(place, coarse(2)));
  passing.orientation = random.orientation();
  EventLog<1> log;
  World<1> world({}, &log);
  world.add_body(body<1>(convex_hull(box_corners({1, 1, 0.5})), motion<1>(Vector3d::Constant(away))));
  world.add_body(passing);
  world.advance_to(20);
  std::vector<double> times;
  for (const Event& event : log.of(Kind::separation)) times.push_back(event.time());
  return times;
}

TEST_CASE("far from the origin a mesh parts from a hull when it does near it", "[world][hull]") {
  std::size_t parted = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    CAPTURE(seed);
    const std::vector<double> near = partings(seed, 0);
    const std::vector<double> far = partings(seed, 0x1p17);
    REQUIRE(far.size() == near.size());
    for (std::size_t i = 0; i < near.size(); ++i) CHECK(far[i] == Approx(near[i]).margin(1e-6));
    parted += near.size();
  }
  CHECK(parted > 50);
}

TEST_CASE("hulls are saved and go on as they would have", "[world][hull][snapshot]") {
  const auto fill = [](World<2>& world) {
    world.add_body(floor_box());
    world.add_body(falling(convex_hull(octahedron), {0, 0, 2}));
    world.add_body(
        falling(convex_hull(octahedron), {0.125, 0, 5}, Eigen::Quaterniond(0.9, 0.1, 0.3, -0.3).normalized()));
  };
  EventLog<2> log, again;
  World<2> world(elastic(), &log);
  fill(world);
  world.advance_to(0.75);
  const Snapshot snapshot = save(world);
  const std::size_t before = log.events.size();
  world.advance_to(3);
  World<2> other(elastic(), &again);
  restore(snapshot, other);
  CHECK(save(other) == snapshot);
  other.advance_to(3);
  CHECK(log.events.size() > before + 3);
  const bool same =
      std::vector<Event>(log.events.begin() + static_cast<std::ptrdiff_t>(before), log.events.end()) == again.events;
  CHECK(same);
  CHECK(std::get<ConvexHull>(other.shape(2).shape).polytope->structure().faces.size() == 8);
}

}  // namespace kds::collision::test_hulls
