// Crates that are meshes: on floors and on each other they do as boxes do.
#include "collision/shapes/mesh.hpp"
#include "collision/world.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <memory>
#include <vector>

namespace test_mesh_crates {
namespace {

using namespace kds;
using namespace kds::collision;
using certificates::RigidMotion;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using Turning = BasicWorld<RigidMotion<2>>;

struct Log : Turning::Listener {
  int contacts = 0, passed = 0;
  std::vector<Vector3d> points;

  void contact(Turning&, const PairEvent& event) override {
    ++contacts;
    points.push_back(event.contact.point);
  }
  void passes(Turning&, const PairEvent&) override { ++passed; }
};

constexpr double half = 0.5;

/// Each face of two triangles, so that a crate that lies flat touches the floor with both of them.
Shape crate() {
  std::vector<Vector3d> corners;
  for (int i = 0; i < 8; ++i) {
    corners.emplace_back((i & 1) != 0 ? half : -half, (i & 2) != 0 ? half : -half, (i & 4) != 0 ? half : -half);
  }
  const std::vector<Mesh::Triangle> triangles{{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                                              {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return MeshShape{std::make_shared<const Mesh>(corners, triangles), 1};
}

struct Result {
  Log log;
  std::vector<Vector3d> places;
  bool rest = true;
};

/// So many of a shape fall on the floor, a box, and on each other.
void drop(Result& result, const Shape& shape, int count, const Quaterniond& orientation, double gap, double until) {
  Turning world({.response = Response::elastic}, &result.log);
  const auto add = [&](const Shape& what, double height, bool fixed, const Quaterniond& turned) {
    RigidMotion<2> motion{{{Vector3d(0, 0, height), Vector3d::Zero(), Vector3d(0, 0, fixed ? 0 : -9.81 / 2)}}};
    motion.orientation = turned;
    return world.add_body({.shape = what, .motion = {motion}, .fixed = fixed, .restitution = 0.3, .friction = 0.5});
  };
  add(Box{Vector3d(5, 5, 0.5)}, -0.5, true, Quaterniond::Identity());
  for (int i = 0; i < count; ++i) add(shape, half + i * 2 * half + (i + 1) * gap, false, orientation);
  world.advance_to(until);
  world.audit();
  for (BodyId id = 1; id <= static_cast<BodyId>(count); ++id) {
    result.places.push_back(world.motion(id).path.position(until));
    result.rest = result.rest && world.resting(id - 1, id);
  }
}

}  // namespace

TEST_CASE("a mesh that falls flat on a box touches it in the middle of its face", "[meshes][rest]") {
  Result crates;
  drop(crates, crate(), 1, Quaterniond::Identity(), 0.125, 0.2);
  REQUIRE(!crates.log.points.empty());
  CHECK(crates.log.points[0].norm() < 1e-12);
}

TEST_CASE("crates that are meshes come to rest on a box, and on each other, as boxes do", "[meshes][rest]") {
  for (const int count : {1, 3}) {
    CAPTURE(count);
    Result crates, boxes;
    drop(crates, crate(), count, Quaterniond::Identity(), 0, 1);
    drop(boxes, Box{Vector3d(half, half, half)}, count, Quaterniond::Identity(), 0, 1);
    CHECK(crates.rest);
    CHECK(boxes.rest);
    CHECK(crates.log.passed == 0);
    CHECK(crates.log.contacts <= 2 * boxes.log.contacts);
    for (std::size_t i = 0; i < crates.places.size(); ++i) {
      CHECK((crates.places[i] - boxes.places[i]).norm() < 1e-5);
    }
  }
}

TEST_CASE("a crate that is a mesh tumbles as a box does, and comes to rest", "[meshes][rest]") {
  const Quaterniond turned(1, 0.1, 0.03, 0);
  Result crates, boxes;
  drop(crates, crate(), 1, turned, 0.25, 3);
  drop(boxes, Box{Vector3d(half, half, half)}, 1, turned, 0.25, 3);
  CHECK(crates.rest);
  CHECK(boxes.rest);
  CHECK(crates.log.contacts <= 2 * boxes.log.contacts);
  CHECK(std::abs(crates.places[0][2] - half) < 1e-5);
}

}  // namespace test_mesh_crates
