// For how long a plane separates two bodies that turn: against the definition.
#include "collision/narrow_phase/turning/loosely_turning.hpp"
#include "collision/narrow_phase/turning/turning_mesh_sides.hpp"
#include "collision/narrow_phase/turning/turning_nodes.hpp"
#include "collision/shapes/outer_points.hpp"

#include "tests/collision/sample_meshes.hpp"
#include "tests/collision_turning/narrow_phase/turning_mesh_oracle.hpp"
#include "tests/collision_turning/narrow_phase/turning_oracle.hpp"
#include "tests/collision_turning/narrow_phase/turning_solids.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

namespace test_plane_between {
namespace {

using namespace kds;
using namespace kds::collision;
using Eigen::Vector3d;
using kds::tests::motion_of;
using kds::tests::Random;
using kds::tests::random_vector;
using Motion = certificates::RigidMotion<2>;

Motion random_motion(Random& random, const Vector3d& place) {
  return kds::tests::random_turning_motion(random, place, 1);
}

/// Towards the origin from where it is at time 0, so that most meet soon.
void send_to_origin(Motion& motion, double speed) {
  const Vector3d velocity = -speed * motion.path.position(0);
  motion.path.coefficients[0] += motion.path.start * velocity;
  motion.path.coefficients[1] += velocity;
}

/// Registers of eight floats, where there are any, give the bits that those of four do.
float checked_part(const NodesView<2>& view, const OuterPoints& a, const OuterPoints& b) {
  const float part = separated_part(view, a, b);
  const auto places = [](const OuterPoints& points) {
    return PointsTogether{points.x(), points.y(), points.z(), static_cast<int>(points.size())};
  };
  const float four = collision::detail::gaps_by_four.separated_part(view.floats, places(a), places(b), nullptr);
  CHECK(std::memcmp(&four, &part, sizeof part) == 0);
  return part;
}

/// The part of the time ahead at which it ends, seconds.
double end_of(const NodesView<2>& view, double t, double horizon, float part) {
  return std::min(horizon, t + view.ahead * static_cast<double>(part));
}

}  // namespace

TEST_CASE("boxes and balls are apart for as long as a plane is proven to separate them", "[turning]") {
  const std::uint64_t seed = 567;
  CAPTURE(seed);
  Random random(seed);
  int proven = 0, ended = 0, missed = 0, apart = 0;
  for (int round = 0; round < 1500; ++round) {
    const double size = std::ldexp(1.0, random.integer(-40, 40));
    const bool rod = random.one_in(2);  // which turns above a plate until it strikes it
    Motion a = random_motion(random, Vector3d::Zero());
    Motion b = random_motion(random, random_vector(random, 3));
    if (rod) {
      for (Motion* const motion : {&a, &b}) motion->path.coefficients.fill(Vector3d::Zero());
      a.angular_velocity.setZero(), a.orientation.setIdentity();
      b.path.coefficients[0][2] = random.between(0.1, 1);
    } else {
      send_to_origin(b, random.between(0, 6));
    }
    for (Motion* const motion : {&a, &b}) {
      for (Vector3d& coefficient : motion->path.coefficients) coefficient *= size;
    }
    const auto half = [&] {
      const double x = random.between(0.1, 1), y = random.between(0.1, 1), z = random.between(0.1, 1);
      return Vector3d(size * Vector3d(x, y, z));
    };
    Box box_a{half()}, box_b{half()};
    if (rod) box_a.half_extents = size * Vector3d(2, 2, 0.02), box_b.half_extents = size * Vector3d(1, 0.02, 0.02);
    const Sphere ball{size * random.between(0.1, 1)};
    const bool with_ball = !rod && random.one_in(3);
    const BoxOfPair side_a(box_a), side_b(box_b);
    const BallOfPair side_ball(ball);
    const double t = random.between(0, 0.5), horizon = t + 1;
    const NodesView<2> view(a, b, {a, b}, side_a.units(), with_ball ? side_ball.units() : side_b.units(), t, horizon);
    const OuterPoints& points_b = with_ball ? side_ball.outer_points() : side_b.outer_points();
    const float part = checked_part(view, side_a.outer_points(), points_b);
    const Shape shape_b = with_ball ? Shape(ball) : Shape(box_b);
    const auto gap = [&](double when) {
      return static_cast<double>(kds::tests::TurningOracle::gap(a, box_a, b, shape_b, when)) / size;
    };
    CAPTURE(round, part);
    const bool clear = gap(t) > 0.05;
    apart += clear;
    missed += clear && part == 0;
    if (!(part > 0)) continue;
    ++proven;
    const double until = end_of(view, t, horizon, part);
    for (int i = 0; i <= 20; ++i) CHECK(gap(t + (until - t) * i / 20) > 0);
    ended += part < 1;
  }
  CHECK(proven > 700);
  CHECK(ended > 200);
  CHECK(missed * 50 < apart);  // a plane is found
}

TEST_CASE("between bodies that turn within bounds a plane lasts for as long as these allow", "[turning]") {
  const std::uint64_t seed = 571;
  CAPTURE(seed);
  Random random(seed);
  // Two cubes, one above the other, that spin about the vertical, and so come no nearer by what is known for certain.
  const PlacedShape cube = place(Box{Vector3d::Ones()}, Eigen::Quaterniond::Identity());
  const double both = 2 * std::sqrt(3.0), spin = 0.5;
  int lasting = 0;
  for (int round = 0; round < 300; ++round) {
    const double gap = random.between(0.05, 0.5), speed = random.one_in(2) ? 0 : random.between(0, 1);
    const auto some = [&](double most) { return random.one_in(2) ? 0 : random.between(0, most); };
    LooselyTurning<2> a, b;
    for (LooselyTurning<2>* const body : {&a, &b}) {
      body->motion = motion_of<2>(Vector3d::Zero(), Vector3d::Zero(), Vector3d(0, 0, spin), 0);
    }
    b.motion.path.coefficients[0][2] = 2 + gap, b.motion.path.coefficients[1][2] = -speed;
    a.path = a.motion.path, b.path = b.motion.path;
    a.off = b.off = some(0.1), a.rate_error = b.rate_error = some(0.2), a.bend = b.bend = some(2);
    const double until = apart_until(cube, a, cube, b);
    // Where gap - off - fall s - bend / 2 s^2 is zero.
    const double f0 = gap - both * a.off, fall = speed + both * a.rate_error, bend = both * a.bend;
    const auto root = [&](double least) {
      const double f = f0 - least, time = f > 0 ? 2 * f / (fall + std::sqrt(fall * fall + 2 * bend * f)) : 0;
      return std::min(time, 1 / (2 * spin));  // no more than a radian of both
    };
    CAPTURE(round, gap, speed, a.off, a.rate_error, a.bend, f0);
    CHECK(until <= root(0));
    CHECK(until >= 0.99 * root(1e-3));  // of which the margin for roundings is a half
    lasting += until > 0.1;
  }
  CHECK(lasting > 150);
}

TEST_CASE("a plane does not outlast bodies that approach by their accelerations alone", "[turning]") {
  const std::uint64_t seed = 569;
  CAPTURE(seed);
  Random random(seed);
  int proven = 0, ended = 0;
  for (int round = 0; round < 300; ++round) {
    const double gap = std::pow(10.0, random.between(-4, -1)), acceleration = random.between(0.5, 5);
    const bool with_ball = random.one_in(2), first_falls = random.one_in(2);
    const Box plate{Vector3d(1, 1, 0.5)}, cube{Vector3d(0.5, 0.5, 0.5)};
    const Sphere ball{0.5};
    // One spins about the axis along which they approach, which brings no part of it nearer.
    const double rate = random.between(0, 2);
    Motion a = motion_of<2>(Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero(), 0);
    Motion b = motion_of<2>(Vector3d(0, 0, 1 + gap), Vector3d::Zero(), Vector3d(0, 0, rate), 0);
    (first_falls ? a : b).path.coefficients[2][2] = (first_falls ? 0.5 : -0.5) * acceleration;
    const BoxOfPair side_a(plate), side_cube(cube);
    const BallOfPair side_ball(ball);
    const NodesView<2> view(a, b, {a, b}, side_a.units(), with_ball ? side_ball.units() : side_cube.units(), 0, 1);
    const float part =
        checked_part(view, side_a.outer_points(), with_ball ? side_ball.outer_points() : side_cube.outer_points());
    if (!(part > 0)) continue;
    ++proven;
    const double meet = std::sqrt(2 * gap / acceleration), until = end_of(view, 0, 1, part);
    CAPTURE(round, part, meet, until);
    CHECK(until < meet);
    ended += part < 1;
  }
  CHECK(proven > 200);
  CHECK(ended > 100);
}

TEST_CASE("meshes do not penetrate for as long as a plane is proven to separate them", "[turning]") {
  using Oracle = kds::tests::TurningMeshOracle;
  const std::uint64_t seed = 568;
  CAPTURE(seed);
  Random random(seed);
  int proven = 0, ended = 0;
  for (const auto& mesh : {samples::torus(8, 4), samples::torus(16, 5)}) {  // of corners, and of boxes
    const MeshShape shape{mesh, 1};
    const MeshOfPair side(shape);
    for (int round = 0; round < (mesh->triangles().size() > 64 ? 15 : 60); ++round) {
      const Motion a = random_motion(random, Vector3d::Zero());
      Motion b = random_motion(random, random_vector(random, 1.5));
      send_to_origin(b, random.between(0, 6));
      const double t = random.between(0, 0.5), horizon = t + 1;
      const NodesView<2> view(a, b, {a, b}, side.units(), side.units(), t, horizon);
      const float part = checked_part(view, side.outer_points(), side.outer_points());
      if (!(part > 0)) continue;
      ++proven;
      CAPTURE(round, part);
      const auto placed = [&](const Motion& motion, double when) {
        std::vector<Oracle::Triangle> triangles;
        for (const Mesh::Triangle& triangle : mesh->triangles()) {
          Oracle::Triangle corners;
          for (std::size_t i = 0; i < 3; ++i) corners[i] = Oracle::point(motion, mesh->vertices()[triangle[i]], when);
          triangles.push_back(corners);
        }
        return triangles;
      };
      const double until = end_of(view, t, horizon, part);
      for (const double when : {0.5 * (t + until), until}) {
        CHECK(Oracle::depth(placed(a, when), placed(b, when)) <= 0);
      }
      ended += part < 1;
    }
  }
  CHECK(proven > 15);
  CHECK(ended > 5);
}

}  // namespace test_plane_between
