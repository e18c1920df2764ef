// Closed meshes whose edges lie in each other's faces at all times: they meet when the solids do that they bound.
#include "collision/narrow_phase/narrow_phase.hpp"
#include "collision/shapes/convex_hull.hpp"
#include "collision/shapes/polytope.hpp"
#include "kds/arithmetic/lattice.hpp"
#include "tests/collision/sample_meshes.hpp"
#include "tests/collision_turning/narrow_phase/turning_solids.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace test_flush_meshes {
namespace {

using namespace kds;
using namespace kds::collision;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using kds::tests::motion_of;
using kds::tests::Random;
using Solid = kds::tests::TurningSolid<2>;
using Quads = std::vector<std::array<std::uint32_t, 4>>;

MeshShape mesh_of(std::vector<Vector3d> corners, const Quads& quads, bool mirrored = false) {
  std::vector<Mesh::Triangle> triangles;
  for (const auto& [a, b, c, d] : quads) {
    if (mirrored) {
      triangles.push_back({a, b, d}), triangles.push_back({b, c, d});
    } else {
      triangles.push_back({a, b, c}), triangles.push_back({a, c, d});
    }
  }
  return MeshShape{std::make_shared<const Mesh>(std::move(corners), std::move(triangles))};
}

const Quads faces_of_box{{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};

/// Corner i is on the upper side of axis d where bit d of i is set. The upper side may be smaller.
std::vector<Vector3d> corners_of_box(const Vector3d& half, double above = 1) {
  std::vector<Vector3d> corners;
  for (int i = 0; i < 8; ++i) {
    const double wide = i & 4 ? above : 1;
    corners.emplace_back((i & 1 ? wide : -wide) * half[0], (i & 2 ? wide : -wide) * half[1],
                         i & 4 ? half[2] : -half[2]);
  }
  return corners;
}
MeshShape box_mesh(const Vector3d& half, bool mirrored = false, double above = 1) {
  return mesh_of(corners_of_box(half, above), faces_of_box, mirrored);
}

/// A solid block with a pit in its upper side, which goes down to z = 0: open above, closed as a mesh.
MeshShape block_with_pit(double pit, double outside, double height) {
  std::vector<Vector3d> corners;
  for (const auto& [wide, z] : {std::pair{outside, -1.0}, {outside, height}, {pit, height}, {pit, 0.0}}) {
    for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
      corners.emplace_back(x * wide, y * wide, z);
  }
  Quads quads{{0, 3, 2, 1}, {12, 13, 14, 15}};
  for (std::uint32_t ring = 0; ring < 12; ring += 4) {
    for (std::uint32_t k = 0; k < 4; ++k) {
      const std::uint32_t next = (k + 1) % 4;
      quads.push_back({ring + k, ring + next, ring + 4 + next, ring + 4 + k});
    }
  }
  return mesh_of(corners, quads);
}

Solid moving(const Shape& shape, const Vector3d& place, const Vector3d& velocity = Vector3d::Zero(),
             const Quaterniond& orientation = Quaterniond::Identity(), const Vector3d& spin = Vector3d::Zero()) {
  Solid solid{shape, motion_of<2>(place, velocity, spin)};
  solid.motion.orientation = orientation;
  return solid;
}

double meet(const Solid& a, const Solid& b, double t0 = 0, double horizon = 20,
            ContactMode mode = ContactMode::transparent) {
  return first_contact(a.body(), b.body(), t0, horizon, mode);
}

/// They meet at t, whichever of them is asked, and part at `parts`, if that is given.
void check_meet(const Solid& a, const Solid& b, double t, std::optional<double> parts = std::nullopt) {
  for (const auto& [first, second] : {std::pair(&a, &b), {&b, &a}}) {
    for (const ContactMode mode : {ContactMode::transparent, ContactMode::resolved}) {
      CHECK(meet(*first, *second, 0, 20, mode) == t);
      CHECK(meet(*first, *second, 0.5 * std::min(t, 20.0), 20, mode) == t);
    }
    if (t == never) continue;
    CHECK(in_contact(first->body(), second->body(), t));
    CHECK_FALSE(in_contact(first->body(), second->body(), next_down(t)));
    if (!parts) continue;
    CHECK(first_separation(first->body(), second->body(), t, 20) == *parts);
    CHECK(in_contact(first->body(), second->body(), next_down(*parts)));
    CHECK_FALSE(in_contact(first->body(), second->body(), *parts));
  }
}

/// As above, of meshes, by what the solids of their outlines do.
void check_as_solids(const Solid& mesh_a, const Solid& mesh_b, const Solid& a, const Solid& b) {
  const double t = meet(a, b);
  if (t == never) return check_meet(mesh_a, mesh_b, never);
  check_meet(mesh_a, mesh_b, t, first_separation(a.body(), b.body(), t, 20));
}

Vector3d lattice_point(Random& random, int size) {
  const auto coordinate = [&] {
    return static_cast<double>(random.below(static_cast<std::uint64_t>(2 * size + 1))) - size;
  };
  const double x = coordinate(), y = coordinate(), z = coordinate();
  return {x, y, z};
}

}  // namespace

TEST_CASE("a crate that is a mesh falls on one of the same outline as boxes do", "[turning]") {
  const Vector3d one = Vector3d::Ones(), down(0, 0, -1);
  const bool mirrored_a = GENERATE(false, true), mirrored_b = GENERATE(false, true);
  struct Case {
    std::string name;
    Vector3d half_b, place;
    double expected;
  };
  const std::vector<Case> cases{{"centre to centre", one, {0, 0, 3}, 1},
                                {"shifted by half an edge, two sides flush", one, {1, 0, 3}, 1},
                                {"shifted both ways", one, {0.5, -1, 3}, 1},
                                {"smaller, flush with one side", {0.5, 0.5, 1}, {0.5, 0, 3}, 1},
                                {"smaller, in a corner", {0.5, 0.5, 1}, {0.5, 0.5, 3}, 1},
                                {"a bar of the same width", {1, 0.25, 1}, {0, 0, 3}, 1},
                                {"wider one way", {1, 2, 1}, {0, 0, 3}, 1},
                                {"edge on edge", one, {2, 0, 3}, never},
                                {"edge on a part of an edge", one, {2, 1, 3}, never},
                                {"corner on corner", one, {2, 2, 3}, never},
                                {"beside, and below the other's upper side", one, {0, 2, 1}, never}};
  for (const Case& each : cases) {
    INFO(each.name << (mirrored_a ? ", a mirrored" : "") << (mirrored_b ? ", b mirrored" : ""));
    const Solid mesh_a = moving(box_mesh(one, mirrored_a), {0, 0, 0}), box_a = moving(Box{one}, {0, 0, 0});
    const Solid mesh_b = moving(box_mesh(each.half_b, mirrored_b), each.place, down);
    const Solid box_b = moving(Box{each.half_b}, each.place, down);
    REQUIRE(meet(box_a, box_b) == each.expected);
    check_as_solids(mesh_a, mesh_b, box_a, box_b);
    const Solid hull_b = moving(convex_hull(corners_of_box(each.half_b)), each.place, down);
    CHECK(meet(mesh_a, hull_b) == each.expected);
    CHECK(meet(hull_b, mesh_a) == each.expected);
    CHECK(meet(mesh_a, box_b) == each.expected);
    CHECK(meet(box_b, mesh_a) == each.expected);
  }
}

TEST_CASE("flush crates meet where doubles do not tell their places exactly", "[turning]") {
  const Vector3d half(0.1, 0.3, 0.7);
  const Solid box_a = moving(Box{half}, {0.3, 0.7, -0.1}, {0.1, 0, 0}), mesh_a = moving(box_mesh(half), {0, 0, 0});
  Solid box_b = moving(Box{half}, {0.3, 0.7, 2.9}, {0.1, 0, 0.3});
  box_b.motion.path.coefficients[2] = Vector3d(0, 0, -4.9);
  check_as_solids({mesh_a.shape, box_a.motion}, {mesh_a.shape, box_b.motion}, box_a, box_b);
  const double t = meet({mesh_a.shape, box_a.motion}, {mesh_a.shape, box_b.motion});
  CHECK(t > 0);
  CHECK(t < 2);
}

TEST_CASE("flush crates that are turned, or turn together, meet as boxes do", "[turning]") {
  // Of length 30^(1/2): so the rotation times 30 is of whole numbers, and takes the third axis to `up` / 30.
  const Quaterniond turn(1, 2, 3, 4);
  const Vector3d up(22, 20, 4), half = Vector3d::Constant(15);
  REQUIRE(std::abs(up.norm() - 30) < 1e-12);
  const Solid box_a = moving(Box{half}, {0, 0, 0}, {0, 0, 0}, turn);
  const Solid box_b = moving(Box{half}, 1.5 * up, -0.5 * up, turn);
  const Solid mesh_a = moving(box_mesh(half), {0, 0, 0}, {0, 0, 0}, turn);
  const Solid mesh_b = moving(box_mesh(half, true), 1.5 * up, -0.5 * up, turn);
  REQUIRE(meet(box_a, box_b) == 1);
  check_as_solids(mesh_a, mesh_b, box_a, box_b);

  const Vector3d one = Vector3d::Ones(), spin(0, 0, 0.7);
  const auto spinning = [&](const Shape& shape, const Vector3d& place, const Vector3d& velocity) {
    return moving(shape, place, velocity, Quaterniond::Identity(), spin);
  };
  check_as_solids(spinning(box_mesh(one), {0, 0, 0}, {0, 0, 0}), spinning(box_mesh(one, true), {0, 0, 3}, {0, 0, -1}),
                  spinning(Box{one}, {0, 0, 0}, {0, 0, 0}), spinning(Box{one}, {0, 0, 3}, {0, 0, -1}));
  // A quarter of a turn in a second, but not both alike: their sides are never in one plane for long.
  const Solid turning_box = spinning(Box{one}, {0, 0, 3}, {0, 0, -1}), still_box = moving(Box{one}, {0, 0, 0});
  check_as_solids(moving(box_mesh(one), {0, 0, 0}), spinning(box_mesh(one), {0, 0, 3}, {0, 0, -1}), still_box,
                  turning_box);
}

TEST_CASE("what slides along a face, or in a pit or a room of its size, is free until it comes to the end",
          "[turning]") {
  const Vector3d one = Vector3d::Ones();
  const Solid crate = moving(box_mesh(one), {0, 0, 0});
  // Side by side, with faces in one plane, which face each other and which do not.
  for (const Vector3d& velocity : {Vector3d(0, 1, 0), Vector3d(0, 0, -1), Vector3d(0, 0.25, -0.5)}) {
    for (const Vector3d& place : {Vector3d(2, -4, 0), Vector3d(2, 0, 0), Vector3d(2, 0, 4), Vector3d(-2, 1, 1)}) {
      check_meet(crate, moving(box_mesh(one, true), place, velocity), never);
    }
  }
  // On its upper side, and off it.
  check_meet(crate, moving(box_mesh(one), {-1, 0, 2}, {1, 0, 0}), never);
  // Down a pit, from above its rim to its ground. Beside it there is no way down.
  const Solid pit = moving(block_with_pit(1, 2, 3), {0, 0, 0});
  check_meet(pit, moving(box_mesh(one), {0, 0, 5}, {0, 0, -1}), 4, 7);
  check_meet(pit, moving(box_mesh(one, true), {0, 0, 3}, {0, 0, -0.5}), 4, 10);
  check_meet(pit, moving(box_mesh(one), {1, 0, 5}, {0, 0, -1}), 1, 7);
  check_meet(pit, moving(box_mesh({0.5, 1, 1}), {-0.5, 0, 5}, {0, 0, -1}), 4, 7);
  // Inside of another, which is as wide as it: a surface does not hold what is inside of it from all sides.
  const Solid room = moving(box_mesh({5, 1, 1}), {0, 0, 0});
  check_meet(room, moving(box_mesh(one), {0, 0, 0}, {1, 0, 0}), 4, 6);
  check_meet(room, moving(box_mesh({1, 0.5, 1}), {0, 0.5, 0}, {1, 0, 0}), 4, 6);
  check_meet(room, moving(box_mesh({1, 0.5, 0.5}), {0, 0.5, 0.5}, {1, 0, 0}), 4, 6);
}

TEST_CASE("a crate falls on a smaller or a wider base of the same outline", "[turning]") {
  const Vector3d one = Vector3d::Ones();
  // The upper side of the frustum is as wide as the crate.
  const std::vector<Vector3d> frustum = corners_of_box({2, 2, 1}, 0.5);
  const Solid base = moving(mesh_of(frustum, faces_of_box), {0, 0, 0});
  const Solid hull = moving(convex_hull(frustum), {0, 0, 0});
  for (const Vector3d& place : {Vector3d(0, 0, 3), Vector3d(1, 0, 3), Vector3d(1, 1, 3), Vector3d(2, 0, 3)}) {
    check_as_solids(base, moving(box_mesh(one), place, {0, 0, -1}), hull, moving(Box{one}, place, {0, 0, -1}));
    check_as_solids(base, moving(mesh_of(frustum, faces_of_box, true), place, {0, 0, -1}), hull,
                    moving(convex_hull(frustum), place, {0, 0, -1}));
  }
}

TEST_CASE("sheets and open boxes are their surfaces: face on face they go through each other", "[turning]") {
  const std::vector<Vector3d> square{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  const MeshShape sheet = mesh_of(square, {{0, 1, 2, 3}});
  check_meet(moving(sheet, {0, 0, 0}), moving(sheet, {0, 0, 1}, {0, 0, -1}), never);
  Quads tray = faces_of_box;
  tray.erase(tray.begin());
  const Solid open = moving(mesh_of(corners_of_box(Vector3d::Ones()), tray), {0, 0, 0});
  check_meet(open, moving(box_mesh(Vector3d::Ones()), {0, 0, 3}, {0, 0, -1}), never);
  check_meet(open, moving(box_mesh(Vector3d::Ones()), {0.25, 0, 3}, {0, 0, -1}), 1, 5);
}

TEST_CASE("what begins in each other meets at once, and again after it has parted", "[turning]") {
  const Vector3d one = Vector3d::Ones();
  const Solid crate = moving(box_mesh(one), {0, 0, 0});
  CHECK(meet(crate, moving(box_mesh(one), {0, 0, 1}, {0, 0, 1})) == 0);
  CHECK(meet(crate, moving(box_mesh(one), {0, 0, 1}, {0, 0, 1}), 0, 20, ContactMode::resolved) == never);
  CHECK(meet(crate, moving(box_mesh(one), {0, 0, 1}, {0, 0, 0})) == 0);
  CHECK(meet(crate, moving(box_mesh(one), {0, 0, 0}, {0, 0, 0})) == never);  // neither enters the other
  // Laid on it, so that it begins to fall there.
  Solid laid = moving(box_mesh(one), {0, 0, 2});
  laid.motion.path.coefficients[2] = Vector3d(0, 0, -5);
  CHECK(meet(crate, laid) == 0);
  const double pressed = meet(crate, laid, 0, 20, ContactMode::resolved);
  CHECK(pressed > 0);
  CHECK(pressed < 1e-5);
  CHECK(contact_at(crate.body(), laid.body(), pressed).normal == Vector3d(0, 0, 1));
  // As after a bounce: in it by a rounding, on the way up and down again.
  Solid thrown = moving(box_mesh(one), {0, 0, next_down(2)}, {0, 0, 1});
  thrown.motion.path.coefficients[2] = Vector3d(0, 0, -0.5);
  CHECK(meet(crate, thrown) == 0);
  const double again = meet(crate, thrown, 0, 20, ContactMode::resolved);
  CHECK(std::abs(again - 2) < 1e-14);
  const Contact contact = contact_at(crate.body(), thrown.body(), again);
  CHECK(contact.normal == Vector3d(0, 0, 1));
  CHECK(contact.point[2] == 1);
  CHECK(contact_at(thrown.body(), crate.body(), again).normal == Vector3d(0, 0, -1));
}

TEST_CASE("crates with corners on a lattice meet as boxes do", "[turning]") {
  const std::uint64_t seed = 731;
  CAPTURE(seed);
  Random random(seed);
  int contacts = 0, free = 0;
  for (int round = 0; round < 150; ++round) {
    const auto half = [&] { return Vector3d(lattice_point(random, 1) * 0.5 + Vector3d::Constant(1)); };
    const Vector3d half_a = half(), half_b = half(), place = lattice_point(random, 4) * 0.5;
    Vector3d velocity = Vector3d::Unit(static_cast<int>(random.below(3))) * (random.one_in(2) ? 0.5 : -0.5);
    if (random.one_in(4)) velocity += Vector3d(0.25, 0, 0);
    const Vector3d from = place - 8 * velocity;
    const Solid box_a = moving(Box{half_a}, {0, 0, 0}), box_b = moving(Box{half_b}, from, velocity);
    if (in_contact(box_a.body(), box_b.body(), 0)) continue;
    CAPTURE(round, half_a.transpose(), half_b.transpose(), from.transpose(), velocity.transpose());
    const Solid mesh_a = moving(box_mesh(half_a, random.one_in(2)), {0, 0, 0});
    const Solid mesh_b = moving(box_mesh(half_b, random.one_in(2)), from, velocity);
    check_meet(mesh_a, mesh_b, meet(box_a, box_b));
    (meet(box_a, box_b) < never ? contacts : free) += 1;
  }
  CHECK(contacts > 40);
  CHECK(free > 15);
}

TEST_CASE("convex meshes with corners on a lattice meet as hulls do", "[turning]") {
  const std::uint64_t seed = 732;
  CAPTURE(seed);
  Random random(seed);
  int contacts = 0, free = 0;
  for (int round = 0; round < 200; ++round) {
    const auto hull = [&] {
      for (;;) {
        std::vector<Vector3d> points;
        for (std::uint64_t i = 0, count = 4 + random.below(8); i < count; ++i)
          points.push_back(lattice_point(random, 1));
        try {
          return Shape(convex_hull(points));
        } catch (const std::invalid_argument&) {  // flat
        }
      }
    };
    const Shape a = hull(), b = hull();
    const Vector3d velocity = Vector3d::Unit(static_cast<int>(random.below(3))) * (random.one_in(2) ? 1 : -1);
    const Vector3d from = lattice_point(random, 2) - 4 * velocity;
    const Solid hull_a = moving(a, {0, 0, 0}), hull_b = moving(b, from, velocity);
    if (in_contact(hull_a.body(), hull_b.body(), 0)) continue;
    CAPTURE(round, from.transpose(), velocity.transpose());
    const Solid mesh_a = moving(surface_of(a), {0, 0, 0}), mesh_b = moving(surface_of(b), from, velocity);
    const double t = meet(hull_a, hull_b);
    CHECK(meet(mesh_a, mesh_b) == t);
    CHECK(meet(mesh_b, mesh_a, 0, 20, ContactMode::resolved) == t);
    CHECK(meet(mesh_a, hull_b) == t);
    (t < never ? contacts : free) += 1;
  }
  CHECK(contacts > 40);
  CHECK(free > 20);
}

}  // namespace test_flush_meshes
