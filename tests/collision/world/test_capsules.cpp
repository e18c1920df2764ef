// Capsules in worlds: they bounce, lie and slide, pass through each other, and are saved, the same with every broad
// phase.
#include "kds/framework/snapshot.hpp"
#include "tests/collision/world/resting_scenes.hpp"

#include <catch2/catch.hpp>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace kds::collision::test_capsules {
namespace {

using namespace tests;

const Eigen::Quaterniond along_x(0.5, 0.5, 0.5, 0.5);

BodyDescription<2> capsule(double radius, double half_length, const Vector3d& place,
                           const Eigen::Quaterniond& turned = Eigen::Quaterniond::Identity()) {
  auto result = body<2>(Capsule{radius, half_length}, motion<2>(place, zero, weight));
  result.orientation = turned;
  return result;
}

Vector3d place_of(const World<2>& world, BodyId id) { return world.motion(id).position(world.now()); }

}  // namespace

TEST_CASE("capsules bounce: normal and speed are those of what they hit", "[world][capsule]") {
  const auto scene = [](World<2>& world) {
    world.add_body(floor_box());
    world.add_body(capsule(0.5, 1, {0, 0, 1.75}, along_x));  // lying
    world.add_body(capsule(0.5, 1, {9, 0, 2.75}));           // upright
    world.advance_to(1);
  };
  with_all_methods(elastic(), scene, [](World<2>& world, EventLog<2>& log) {
    const auto contacts = log.of(Kind::contact);
    REQUIRE(contacts.size() == 2);
    for (const Event& contact : contacts) {
      CHECK(contact.time() == 0.5);  // 1.25 = 5 t^2
      CHECK(contact.contact.normal == Vector3d::UnitZ());
      CHECK(contact.contact.feature_a == Feature::face(5));
    }
    CHECK(contacts[0].contact.feature_b == Feature::edge(0, 1));
    CHECK(contacts[1].contact.feature_b == Feature::vertex(0));
    CHECK(contacts[0].contact.point == Vector3d(0, 0, 0));
    CHECK(place_of(world, 1) == Vector3d(0, 0, 1.75));  // back where they came from
    CHECK(place_of(world, 2) == Vector3d(9, 0, 2.75));
  });
}

TEST_CASE("capsules come to lie, on a floor, on each other and on a mesh", "[world][capsule]") {
  const auto cube = std::make_shared<const Mesh>(std::vector<Vector3d>{{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}},
                                                 std::vector<Mesh::Triangle>{{0, 1, 2}, {0, 2, 3}});
  const auto scene = [&](World<2>& world) {
    world.add_body(floor_box());
    world.add_body(fixed_body<2>(MeshShape{cube, 1}, motion<2>({20, 0, 1})));
    world.add_body(bouncy(capsule(0.5, 1, {0, 0, 2}, along_x), 0));
    world.add_body(bouncy(capsule(0.25, 1, {0, 0, 4}), 0));  // falls on the other, and stands there
    world.add_body(bouncy(capsule(0.5, 1, {20, 0, 3}, along_x), 0));
    world.add_body(bouncy(capsule(0.5, 1, {10, 0, 3}, Eigen::Quaterniond(0.9, 0.1, 0.3, -0.3).normalized()), 0.5));
    world.advance_to(20);
  };
  with_all_methods(elastic(), scene, [](World<2>& world, EventLog<2>&) {
    for (const BodyId id : {2, 3, 4, 5}) {
      INFO("body " << id);
      CHECK(at_rest(world, id));
    }
    CHECK(world.resting(0, 2));
    CHECK(world.resting(2, 3));
    CHECK(world.resting(1, 4));
    CHECK(world.resting(0, 5));
    CHECK(place_of(world, 2)[2] == Approx(0.5).margin(1e-9));
    CHECK(place_of(world, 3)[2] == Approx(2.25).margin(1e-9));
    CHECK(place_of(world, 4)[2] == Approx(1.5).margin(1e-9));
  });
}

TEST_CASE("a capsule that slides off an edge leaves it", "[world][capsule]") {
  const auto scene = [](World<2>& world) {
    world.add_body(fixed_body<2>(Box{{2, 2, 1}}, motion<2>({0, 0, -1})));
    auto sliding = bouncy(capsule(0.5, 1, {0, 0, 0.5}, along_x), 0);
    sliding.motion[0].coefficients[1] = Vector3d(0, 1, 0);
    world.add_body(sliding);
    world.advance_to(1);
  };
  with_all_methods(elastic(), scene, [](World<2>& world, EventLog<2>&) {
    CHECK(world.resting(0, 1));
    CHECK(place_of(world, 1)[2] == Approx(0.5).margin(1e-12));
    world.advance_to(4);
    CHECK_FALSE(world.resting(0, 1));
    CHECK(place_of(world, 1)[2] < -1);
  });
}

TEST_CASE("capsules pass through each other, and are told to", "[world][capsule]") {
  std::vector<Event> first;
  for (const auto method : all_methods) {
    WorldOptions options;
    options.broad_phase = method;
    options.rate = 16;
    EventLog<1> log;
    World<1> world(options, &log);
    world.add_body(body<1>(Capsule{0.5, 1}, motion<1>({0, 0, 0})));
    auto crossing = body<1>(Capsule{0.25, 2}, motion<1>({0, 3, 0}, {0, -1, 0}));
    crossing.orientation = along_x;
    world.add_body(crossing);
    world.add_body(body<1>(Capsule{0.5, 0}, motion<1>({5, 0, 1}, {-1, 0, 0})));  // a ball
    world.advance_to(10);
    if (method == all_methods.front()) first = log.events;
    const bool same = log.events == first;
    CHECK(same);
    const auto contacts = log.of(Kind::contact);
    REQUIRE(contacts.size() >= 2);
    CHECK(contacts[0].time() == 2.25);
    CHECK(log.of(Kind::separation)[0].time() == 3.75);
    CHECK(log.count(Kind::separation) == contacts.size());
  }
}

TEST_CASE("capsules are saved and go on as they would have", "[world][capsule][snapshot]") {
  const auto fill = [](World<2>& world) {
    world.add_body(floor_box());
    world.add_body(capsule(0.5, 1, {0, 0, 2}, along_x));
    world.add_body(capsule(0.25, 0.75, {0.125, 0, 4}, Eigen::Quaterniond(0.9, 0.1, 0.3, -0.3).normalized()));
    world.add_body(bouncy(capsule(0.25, 0, {3, 0, 1}), 0.5));
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
  CHECK(std::get<Capsule>(other.shape(2).shape).half_length == 0.75);
}

}  // namespace kds::collision::test_capsules
