// Half-spaces and bodies that turn: when they meet, against the height of the lowest corner in long doubles.
#include "collision/narrow_phase/narrow_phase.hpp"
#include "collision/shapes/convex_hull.hpp"
#include "collision/shapes/polytope.hpp"
#include "kds/arithmetic/lattice.hpp"
#include "tests/collision/sample_meshes.hpp"
#include "tests/collision_turning/narrow_phase/check_meetings.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <variant>
#include <vector>

namespace test_turning_half_space {
namespace {

using namespace kds;
using namespace kds::collision;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using kds::tests::first_meeting;
using kds::tests::motion_of;
using kds::tests::Random;
using kds::tests::random_hull;
using kds::tests::random_vector;

template <int Degree>
using Solid = kds::tests::TurningSolid<Degree>;

/// The points of a shape in its body, and the radius about each that belongs to it.
struct Corners {
  std::vector<Vector3d> points;
  double radius = 0;
};

Corners corners_of(const Shape& shape) {
  if (const auto* const ball = std::get_if<Sphere>(&shape)) return {{Vector3d::Zero()}, ball->radius};
  if (const auto* const capsule = std::get_if<Capsule>(&shape)) {
    return {{{0, 0, -capsule->half_length}, {0, 0, capsule->half_length}}, capsule->radius};
  }
  if (const auto* const hull = std::get_if<ConvexHull>(&shape)) {
    const auto points = hull->polytope->points();
    return {{points.begin(), points.end()}, 0};
  }
  Corners corners;
  if (const auto* const mesh = std::get_if<MeshShape>(&shape)) {
    for (const Vector3d& x : mesh->mesh->vertices()) corners.points.emplace_back(mesh->scale * x);
    return corners;
  }
  const Vector3d& half = std::get<Box>(shape).half_extents;
  for (int i = 0; i < 8; ++i) {
    corners.points.emplace_back(i & 1 ? half[0] : -half[0], i & 2 ? half[1] : -half[1], i & 4 ? half[2] : -half[2]);
  }
  return corners;
}

/// How far a body is above a half-space, in long doubles: negative where its lowest corner is below the plane.
template <int Degree>
class Height {
 public:
  using Oracle = kds::tests::TurningOracle;
  using Number = Oracle::Number;

  Height(const Solid<Degree>& plane, const Solid<Degree>& body)
      : plane_(plane), body_(body), corners_(corners_of(body.shape)) {}

  double operator()(double t) const {
    const auto& plane = std::get<HalfSpace>(plane_.shape);
    const auto a = Oracle::pose(plane_.motion, t), b = Oracle::pose(body_.motion, t);
    Oracle::Vector n{};
    Number square = 0;
    for (std::size_t d = 0; d < 3; ++d) {
      for (std::size_t k = 0; k < 3; ++k) n[d] += a.axes[k][d] * plane.normal[static_cast<Eigen::Index>(k)];
      square += n[d] * n[d];
    }
    Number lowest = std::numeric_limits<Number>::infinity();
    for (const Vector3d& x : corners_.points) {
      Number height = 0;
      for (std::size_t d = 0; d < 3; ++d) {
        Number at = b.centre[d] - a.centre[d];
        for (std::size_t k = 0; k < 3; ++k) at += b.axes[k][d] * x[static_cast<Eigen::Index>(k)];
        height += n[d] / std::sqrt(square) * at;
      }
      lowest = std::min(lowest, height);
    }
    return static_cast<double>(lowest - plane.offset - corners_.radius);
  }

 private:
  const Solid<Degree>& plane_;
  const Solid<Degree>& body_;
  Corners corners_;
};

const MeshShape& sample_mesh(std::size_t which) {
  static const std::vector<MeshShape> meshes{
      {samples::torus(12, 8), 0.5}, {samples::ball_mesh(2), 0.75}, {samples::cuboid(Vector3d(0.5, 0.25, 0.75))}};
  return meshes[which % meshes.size()];
}

Shape random_body(Random& random) {
  if (random.one_in(8)) return Sphere{random.between(0.2, 1)};
  if (random.one_in(4)) return Capsule{random.between(0.05, 0.5), random.between(0, 1)};
  if (random.one_in(3)) return Box{Vector3d(0.5, random.between(0.1, 1), random.one_in(2) ? 0.5 : 0.02)};
  if (random.one_in(2)) return random_hull(random);
  return sample_mesh(random.below(3));
}

/// A half-space that may move, and in some cases is aligned with the axes.
template <int Degree>
Solid<Degree> random_half_space(Random& random) {
  const Vector3d normal =
      random.one_in(3) ? Vector3d(Vector3d::Unit(static_cast<int>(random.below(3)))) : random_vector(random, 1);
  const Vector3d velocity = random.one_in(2) ? Vector3d(Vector3d::Zero()) : random_vector(random, 1);
  auto motion = motion_of<Degree>(random_vector(random, 0.5), velocity, Vector3d::Zero(), -random.between(0, 1));
  if (random.one_in(2)) {
    motion.orientation = Quaterniond(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1), 0.5);
  }
  return {HalfSpace{normal.normalized(), random.between(-1, 0)}, motion};
}

template <int Degree>
Solid<Degree> random_solid(Random& random, double rate) {
  const Vector3d velocity = random.one_in(5) ? Vector3d(Vector3d::Zero()) : random_vector(random, 2);
  Vector3d spin = random.one_in(5) ? Vector3d(Vector3d::Zero()) : random_vector(random, rate);
  if (random.one_in(4)) spin = Vector3d::Unit(static_cast<int>(random.below(3))) * rate;
  auto motion = motion_of<Degree>(random_vector(random, 1) - velocity, velocity, spin, -random.between(0, 3));
  if constexpr (Degree == 2) motion.path.coefficients[2] = random_vector(random, 1);
  if (!random.one_in(3)) {
    motion.orientation = Quaterniond(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1), 0.5);
  }
  return {random_body(random), motion};
}

template <int Degree>
void check_meeting(const Solid<Degree>& plane, const Solid<Degree>& body, double horizon, int samples, int& meetings) {
  const double found = first_meeting(plane, body, 0, horizon);
  CHECK(first_meeting(body, plane, 0, horizon) == found);
  const auto size = [&](const Solid<Degree>& s) {
    return s.motion.path.position(0).norm() + s.motion.path.velocity(0).norm() * horizon;
  };
  const double radius = body.placed.bounding_radius;
  const double speed = plane.motion.path.velocity(0).norm() + body.motion.path.velocity(0).norm() + 4 * horizon +
                       radius * body.motion.angular_velocity.norm();
  const double tolerance =
      1e-13 * (1 + radius + size(plane) + size(body)) + 2e-15 * speed * (horizon - body.motion.start());
  const Height<Degree> height(plane, body);
  const auto verdict = kds::tests::check_first_time(height, 0, horizon, found, tolerance, samples);
  CHECK_FALSE(verdict.missed);
  CHECK_FALSE(verdict.wrong);
  // Proofs never go past it, and get somewhere.
  double proven = 0;
  for (int step = 0; step < 1000 && proven < std::min(found, horizon); ++step) {
    const ContactEstimate next =
        certified_first_contact(plane.body(), body.body(), proven, horizon, ContactMode::transparent);
    CHECK(next.time <= found);
    if (next.exact) CHECK(next.time == found);
    proven = next.time;
  }
  CHECK(proven >= std::min(found, horizon));
  if (found == never) {
    CHECK_FALSE(in_contact(plane.body(), body.body(), horizon));
    return;
  }
  ++meetings;
  CHECK(in_contact(plane.body(), body.body(), found));
  if (found > 0) CHECK_FALSE(in_contact(plane.body(), body.body(), next_down(found)));
  const double parted = first_separation(plane.body(), body.body(), found, horizon);
  const double until = parted == never ? horizon : parted;
  for (int i = 1; i < samples; ++i) CHECK(height(found + (until - found) * i / samples) <= tolerance);
  if (parted == never) return;
  CHECK_FALSE(in_contact(plane.body(), body.body(), parted));
  if (parted > found) CHECK(in_contact(plane.body(), body.body(), next_down(parted)));
  CHECK(std::abs(height(parted)) <= tolerance);
}

template <int Degree>
void check_pairs(std::uint32_t seed, int pairs) {
  Random random(seed);
  int meetings = 0;
  for (int i = 0; i < pairs; ++i) {
    const auto plane = random_half_space<Degree>(random);
    const auto body = random_solid<Degree>(random, std::pow(10.0, random.between(-2, 1.2)));
    INFO("seed " << seed << ", pair " << i << ", with a " << kind_name(body.shape));
    check_meeting(plane, body, 2, 100, meetings);
  }
  CHECK(meetings > pairs / 4);
}

}  // namespace

TEST_CASE("turning bodies meet a half-space when their lowest corner says so", "[narrow-phase][turning][half_space]") {
  check_pairs<1>(1, 150);
  check_pairs<2>(2, 150);
}

TEST_CASE("turning bodies meet a half-space: slowly and fast, begun long ago", "[narrow-phase][turning][half_space]") {
  Random random(7);
  int meetings = 0;
  for (const double rate : {1e-9, 1e-4, 100.0, 1e4}) {
    for (int i = 0; i < 20; ++i) {
      const auto plane = random_half_space<1>(random);
      auto body = random_solid<1>(random, rate);
      body.motion = body.motion.restarted(-1000);
      INFO("rate " << rate << ", pair " << i << ", with a " << kind_name(body.shape));
      check_meeting(plane, body, rate > 10 ? 20 / rate : 2, 100, meetings);
    }
  }
  CHECK(meetings > 10);
}

TEST_CASE("a half-space is met as a box of which it is a face, to the bit", "[narrow-phase][turning][half_space]") {
  Random random(3);
  int meetings = 0;
  const Solid<2> floor{HalfSpace{Vector3d::UnitZ(), 0}, motion_of<2>({0, 0, 0}, {0, 0, 0}, {0, 0, 0})};
  const Solid<2> block{Box{Vector3d(64, 64, 8)}, motion_of<2>({0, 0, -8}, {0, 0, 0}, {0, 0, 0})};
  for (int i = 0; i < 60; ++i) {
    auto body = random_solid<2>(random, 5);
    if (std::holds_alternative<MeshShape>(body.shape)) continue;  // of which a box meets the surface
    body.motion.path.coefficients[0] += Vector3d(0, 0, 2);
    body.motion.path.coefficients[1] = Vector3d(0, 0, -1);
    INFO("pair " << i << ", with a " << kind_name(body.shape));
    const double found = first_meeting(floor, body, 0, 4);
    CHECK(first_meeting(block, body, 0, 4) == found);
    if (found > 0 && found != never) {
      ++meetings;
      CHECK(first_meeting(floor, body, 0, 4, ContactMode::resolved) ==
            first_meeting(block, body, 0, 4, ContactMode::resolved));
      const Contact on_floor = contact_at(floor.body(), body.body(), found);
      const Contact on_block = contact_at(block.body(), body.body(), found);
      CHECK(on_floor.normal == Vector3d::UnitZ());
      CHECK((on_floor.normal - on_block.normal).norm() < 1e-9);
      CHECK((on_floor.point - on_block.point).norm() < 1e-9);
      CHECK(on_floor.feature_b == on_block.feature_b);
      const Contact turned = contact_at(body.body(), floor.body(), found);
      CHECK((turned.normal == -on_floor.normal && turned.point == on_floor.point));
    }
  }
  CHECK(meetings > 10);
}

TEST_CASE("a mesh meets a half-space as the hull of its vertices, to the bit", "[narrow-phase][turning][half_space]") {
  Random random(5);
  int meetings = 0;
  for (int i = 0; i < 60; ++i) {
    const auto mesh = i % 2 == 0 ? samples::ball_mesh(2) : samples::torus(12, 8);
    const std::vector<Vector3d> points(mesh->vertices().begin(), mesh->vertices().end());
    const auto plane = random_half_space<1>(random);
    auto motion = random_solid<1>(random, std::pow(10.0, random.between(-1, 1))).motion;
    const Vector3d out = std::get<HalfSpace>(plane.shape).normal;
    motion.path.coefficients[0] += 3 * (plane.motion.orientation.normalized() * out);
    motion.path.coefficients[1] -= plane.motion.orientation.normalized() * out;
    const Solid<1> surface{MeshShape{mesh}, motion}, hull{convex_hull(points), motion};
    INFO("pair " << i);
    for (const double t0 : {0.0, 0.5}) {
      const double found = first_meeting(plane, surface, t0, 4);
      CHECK(first_meeting(plane, hull, t0, 4) == found);
      meetings += found > t0 && found != never;
      if (found == never) continue;
      CHECK(first_separation(plane.body(), surface.body(), found, 4) ==
            first_separation(plane.body(), hull.body(), found, 4));
    }
  }
  CHECK(meetings > 20);
}

TEST_CASE("a capsule of length 0 meets a half-space as the ball, to the bit", "[narrow-phase][turning][half_space]") {
  Random random(6);
  int meetings = 0;
  for (int i = 0; i < 40; ++i) {
    const auto plane = random_half_space<2>(random);
    const auto motion = random_solid<2>(random, 5).motion;
    const double radius = random.between(0.1, 1);
    const double found = first_meeting(plane, Solid<2>{Sphere{radius}, motion}, 0, 2);
    CHECK(first_meeting(plane, Solid<2>{Capsule{radius, 0}, motion}, 0, 2) == found);
    meetings += found > 0 && found != never;
  }
  CHECK(meetings > 5);
}

TEST_CASE("turning bodies graze a half-space, by gaps of any size", "[narrow-phase][turning][half_space]") {
  // The edges of the box are 5 from the axis about which it turns, exactly; the end of the capsule, too.
  const std::vector<Shape> shapes{Box{Vector3d(3, 4, 1)}, Capsule{1, 4}, MeshShape{samples::cuboid(Vector3d(3, 4, 1))}};
  for (const Shape& shape : shapes) {
    for (const double rate : {0.5, 30.0}) {
      auto motion = motion_of<1>({0, 0, 0}, {0, 0, 0}, {0, 0, rate});
      if (std::holds_alternative<Capsule>(shape)) motion.orientation = Quaterniond(1, 1, 0, 0);
      const Solid<1> body{shape, motion};
      for (const double gap : {0.1, 1e-4, 1e-8, 1e-12, 0x1p-49, 0.0}) {
        INFO(kind_name(shape) << ", rate " << rate << ", gap " << gap);
        const auto wall = [](double at) {
          return Solid<1>{HalfSpace{-Vector3d::UnitX(), -at}, motion_of<1>({0, 0, 0}, {0, 0, 0}, {0, 0, 0})};
        };
        CHECK(first_meeting(wall(5 + gap), body, 0, 20) == never);
        const Solid<1> nearer = wall(5 - std::max(gap, 0x1p-49));
        const double found = first_meeting(nearer, body, 0, 20);
        REQUIRE(found != never);
        CHECK(std::abs(Height<1>(nearer, body)(found)) < 1e-13);
      }
    }
  }
  // A flat mesh that lies in the plane, and turns in it, is not in the half-space.
  const MeshShape sheet{std::make_shared<const Mesh>(std::vector<Vector3d>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                                                     std::vector<Mesh::Triangle>{{0, 1, 2}})};
  const auto lies_at = [&](double z) { return Solid<1>{sheet, motion_of<1>({0, 0, z}, {1, 0, 0}, {0, 0, 2})}; };
  const Solid<1> floor{HalfSpace{Vector3d::UnitZ(), 0.5}, motion_of<1>({0, 0, 0.25}, {0, 0, 0}, {0, 0, 0})};
  CHECK(first_meeting(floor, lies_at(0.75), 0, 10) == never);
  CHECK_FALSE(in_contact(floor.body(), lies_at(0.75).body(), 1));
  CHECK(first_separation(floor.body(), lies_at(0.75).body(), 1, 10) == 1);
  CHECK(first_meeting(floor, lies_at(next_down(0.75)), 1, 10) == 1);
}

TEST_CASE("what is in a half-space by a rounding is in contact as soon as it sinks, or when it comes back",
          "[narrow-phase][turning][half_space]") {
  const std::vector<Shape> shapes{Box{Vector3d(0.5, 0.5, 0.25)}, Capsule{0.125, 0.125},
                                  MeshShape{samples::cuboid(Vector3d(0.5, 0.5, 0.25))}};
  const Solid<2> floor{HalfSpace{Vector3d::UnitZ(), 0}, motion_of<2>({0, 0, 0}, {0, 0, 0}, {0, 0, 0})};
  for (const Shape& shape : shapes) {
    INFO(kind_name(shape));
    const auto next = [&](double rises, double acceleration) {
      auto motion = motion_of<2>({0, 0, 0.25 - 0x1p-50}, {1, 0, rises}, {0, 0, 1});
      motion.path.coefficients[2] = Vector3d(0, 0, acceleration / 2);
      return first_meeting(floor, Solid<2>{shape, motion}, 0, 2, ContactMode::resolved);
    };
    CHECK(next(0, 0) == never);
    CHECK(next(0, 1) == never);
    CHECK((next(0, -1) > 1e-9 && next(0, -1) < 1e-5));
    CHECK(std::abs(next(0.5, -1) - 1) < 1e-12);
  }
}

}  // namespace test_turning_half_space
