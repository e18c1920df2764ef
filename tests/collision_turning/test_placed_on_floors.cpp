// What is placed on something, with nothing but rounding between the two, stays on it: in worlds of both kinds.
#include "collision/shapes/compound.hpp"
#include "collision/shapes/convex_hull.hpp"
#include "collision/shapes/heightfield.hpp"
#include "collision/world.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace test_placed_on_floors {
namespace {

using namespace kds;
using namespace kds::collision;
using certificates::PointMotion;
using certificates::RigidMotion;
using Eigen::Vector3d;

constexpr double gravity = 10;

/// What should not happen here.
template <class Motion>
struct Log : BasicWorldListener<Motion> {
  int contacts = 0, let_through = 0;
  void contact(BasicWorld<Motion>&, const PairEvent&) override { ++contacts; }
  void overlap(BasicWorld<Motion>&, const PairEvent&) override { ++let_through; }
  void passes(BasicWorld<Motion>&, const PairEvent&) override { ++let_through; }
};

template <class Motion>
Motion falling(const Vector3d& place, double start) {
  const auto path = PointMotion<2>::parabola(place, Vector3d::Zero(), Vector3d(0, 0, -gravity), start);
  if constexpr (std::is_same_v<Motion, PointMotion<2>>) {
    return path;
  } else {
    return {path};
  }
}
template <class Motion>
Motion standing(const Vector3d& place) {
  const auto path = PointMotion<2>::line(place, Vector3d::Zero());
  if constexpr (std::is_same_v<Motion, PointMotion<2>>) {
    return path;
  } else {
    return {path};
  }
}

std::vector<Vector3d> corners(const Vector3d& half) {
  std::vector<Vector3d> result;
  for (int i = 0; i < 8; ++i) {
    result.emplace_back((i & 1 ? 1 : -1) * half[0], (i & 2 ? 1 : -1) * half[1], (i & 4 ? 1 : -1) * half[2]);
  }
  return result;
}

Mesh mesh_of_box(double radius) {
  std::vector<Mesh::Triangle> triangles;
  for (const auto& [a, b, c, d] : {std::array<std::uint32_t, 4>{0, 2, 3, 1},
                                   {4, 5, 7, 6},
                                   {0, 1, 5, 4},
                                   {2, 6, 7, 3},
                                   {0, 4, 6, 2},
                                   {1, 3, 7, 5}}) {
    triangles.push_back({a, b, c}), triangles.push_back({a, c, d});
  }
  return Mesh(corners(Vector3d::Constant(radius)), triangles);
}

Shape compound_of(const Box& box) {
  const std::vector<CompoundPart> parts{{.shape = box}};
  return compound(parts);
}

/// Their upper side is at z = 0.
std::vector<std::pair<std::string, std::pair<Shape, Vector3d>>> floors() {
  const std::vector<double> flat(25, 0.0);
  return {{"half-space", {HalfSpace{Vector3d(0, 0, 1), 0}, Vector3d::Zero()}},
          {"box", {Box{Vector3d(50, 50, 1)}, Vector3d(0, 0, -1)}},
          {"hull", {convex_hull(corners({50, 50, 1})), Vector3d(0, 0, -1)}},
          {"mesh", {MeshShape{std::make_shared<const Mesh>(heightfield(flat, 5, 50, 50))}, Vector3d::Zero()}},
          {"compound", {compound_of(Box{Vector3d(50, 50, 1)}), Vector3d(0, 0, -1)}}};
}

/// Their lower side is at z = -radius.
std::vector<std::pair<std::string, Shape>> solids(double radius) {
  const Vector3d half = Vector3d::Constant(radius);
  return {{"ball", Sphere{radius}},
          {"box", Box{half}},
          {"capsule", Capsule{0.5 * radius, 0.5 * radius}},
          {"hull", convex_hull(corners(half))},
          {"mesh", MeshShape{std::make_shared<const Mesh>(mesh_of_box(radius))}},
          {"compound", compound_of(Box{half})}};
}

/// Its sides lean inwards; its centre of mass is its origin.
Shape pyramid(double radius) {
  std::vector<Vector3d> points{{0, 0, 3 * radius}};
  for (const double x : {-radius, radius}) {
    for (const double y : {-radius, radius}) points.emplace_back(x, y, -radius);
  }
  return convex_hull(points);
}

template <class Motion>
void check_stays(const std::string& floor_name, const std::pair<Shape, Vector3d>& floor, const std::string& name,
                 const Shape& shape, double radius, const Vector3d& origin, double enters) {
  INFO(floor_name << ", " << name << " of radius " << radius << " at " << origin.transpose() << ", from " << enters
                  << " s on");
  using World = BasicWorld<Motion>;
  Log<Motion> log;
  World world({.response = Response::elastic}, &log);
  world.add_body(
      {.shape = floor.first, .motion = {standing<Motion>(origin + floor.second)}, .fixed = true, .restitution = 0.5});
  world.advance_to(enters);
  const Vector3d place = origin + Vector3d(0.3, 0.4, radius);
  const BodyId body = world.add_body({.shape = shape, .motion = {falling<Motion>(place, enters)}, .restitution = 0.5});
  world.advance_to(enters + 1);
  const Vector3d end = path_of(world.motion(body)).position(world.now());
  CHECK((end - place).norm() < 1e-4 * std::max(radius, 1.0));
  CHECK(log.let_through == 0);
  CHECK(log.contacts < 200);
}

/// Three bodies above each other, which lie on each other up to roundings. Balls may roll off, but nothing sinks in.
template <class Motion>
void check_stack(const std::string& floor_name, const std::pair<Shape, Vector3d>& floor, const Shape& low,
                 const Shape& high, double radius, const Vector3d& origin) {
  INFO(floor_name << ", " << kind_name(low) << ", " << kind_name(high) << " and " << kind_name(low) << " of radius "
                  << radius << " at " << origin.transpose());
  using World = BasicWorld<Motion>;
  Log<Motion> log;
  World world({.response = Response::elastic}, &log);
  const auto add = [&](const Shape& shape, const Motion& motion, bool fixed) {
    typename World::Description body{.shape = shape, .motion = {motion}, .fixed = fixed, .restitution = 0.3};
    if constexpr (std::is_same_v<Motion, RigidMotion<2>>) body.friction = 0.4;
    return world.add_body(body);
  };
  add(floor.first, standing<Motion>(origin + floor.second), true);
  std::vector<BodyId> bodies;
  for (int i = 0; i < 3; ++i) {
    const Vector3d place = origin + Vector3d(0.3, 0.4, (2 * i + 1) * radius);
    bodies.push_back(add(i == 1 ? high : low, falling<Motion>(place, 0), false));
  }
  world.advance_to(1);
  CHECK(log.let_through == 0);
  for (const BodyId body : bodies) {
    CHECK(path_of(world.motion(body)).position(1)[2] - origin[2] > (1 - 1e-3) * radius);
  }
}

template <class Motion>
void check_all_stacks() {
  for (const auto& [floor_name, floor] : floors()) {
    for (const double radius : {0.5, 0.028}) {
      for (const auto& [low_name, low] : solids(radius)) {
        for (const auto& [high_name, high] : solids(radius)) {
          if (low_name == "capsule" || high_name == "capsule") continue;
          if (radius < 0.1 && low_name != high_name) continue;  // of small ones those of one shape are enough
          // A mesh meets other floors in the middle of two triangles, not of a face: so crates rock, which takes long.
          const bool rocks = std::is_same_v<Motion, RigidMotion<2>> && floor_name != "half-space";
          if (rocks && (low_name == "mesh" || high_name == "mesh")) continue;
          check_stack<Motion>(floor_name, floor, low, high, radius, Vector3d(0.1, 0.2, 0));
        }
      }
    }
  }
}

template <class Motion>
void check_all_stay() {
  for (const auto& [floor_name, floor] : floors()) {
    for (const double radius : {7.3, 0.5, 0.028, 1e-3}) {
      auto shapes = solids(radius);
      shapes.emplace_back("pyramid", pyramid(radius));
      for (const auto& [name, shape] : shapes) {
        check_stays<Motion>(floor_name, floor, name, shape, radius, Vector3d::Zero(), 0);
        check_stays<Motion>(floor_name, floor, name, shape, radius, Vector3d(1000.3, -200.7, 55.1), 0.5);
      }
    }
  }
}

}  // namespace

TEST_CASE("Crates that are meshes of one outline bounce on each other, and do not turn", "[world]") {
  using World = TurningWorld<2>;
  for (const double restitution : {1.0, 0.5}) {
    Log<RigidMotion<2>> log;
    World world({.response = Response::elastic}, &log);
    const Shape crate = MeshShape{std::make_shared<const Mesh>(mesh_of_box(0.5))};
    world.add_body({.shape = crate, .motion = {standing<RigidMotion<2>>({0.1, 0.2, 0})}, .fixed = true});
    std::vector<BodyId> bodies;
    for (const double height : {1.25, 2.5, 3.75}) {
      const auto motion = falling<RigidMotion<2>>({0.1, 0.2, height}, 0);
      bodies.push_back(world.add_body({.shape = crate, .motion = {motion}, .restitution = restitution}));
    }
    world.advance_to(2);
    CAPTURE(restitution);
    CHECK(log.let_through == 0);
    CHECK(log.contacts > 6);
    double below = 0;
    for (const BodyId body : bodies) {
      const RigidMotion<2>& motion = world.motion(body);
      const Vector3d place = path_of(motion).position(2);
      CHECK(place[2] > below + 1 - 1e-3);
      CHECK((place - Vector3d(0.1, 0.2, place[2])).norm() < 1e-9);
      CHECK(motion.angular_velocity.norm() < 1e-9);
      below = place[2];
    }
  }
}

TEST_CASE("Bodies placed on a floor stay on it", "[world]") { check_all_stay<PointMotion<2>>(); }

TEST_CASE("Bodies that can turn, placed on a floor, stay on it", "[world]") { check_all_stay<RigidMotion<2>>(); }

TEST_CASE("Bodies stacked on a floor stay above it", "[world]") { check_all_stacks<PointMotion<2>>(); }

TEST_CASE("Bodies that can turn, stacked on a floor, stay above it", "[world]") { check_all_stacks<RigidMotion<2>>(); }

}  // namespace test_placed_on_floors
