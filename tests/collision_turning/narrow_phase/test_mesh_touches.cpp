// Meshes that turn: what the search for a contact hands on, and triangles that part, whose roundings are not asked.
#include "collision/narrow_phase/turning/point_rates.hpp"
#include "collision/narrow_phase/turning/turning_triangles.hpp"
#include "collision/narrow_phase/turning/ways_apart.hpp"

#include "tests/collision/sample_meshes.hpp"
#include "tests/collision_turning/narrow_phase/turning_solids.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

namespace test_mesh_touches {
namespace {

using namespace kds;
using namespace kds::collision;
using Eigen::Vector3d;
using kds::tests::Random;
using kds::tests::random_vector;
using Motion = certificates::RigidMotion<2>;
using Solid = kds::tests::TurningSolid<2>;
using Corners = std::array<Vector3d, 3>;

bool same(const Contact& x, const Contact& y) {
  return x.point == y.point && x.normal == y.normal && x.feature_a == y.feature_a && x.feature_b == y.feature_b;
}

/// Two triangles that touch at the time 0, up to roundings, and part or approach at a speed there.
struct Touching {
  Corners a, b;
  Motion motion_a, motion_b;
};

Touching touching(Random& random, double speed) {
  const auto motion = [&](const Vector3d& place) {
    Motion m = kds::tests::random_turning_motion(random, place, 1);
    return m.restarted(0);
  };
  Touching pair;
  pair.motion_a = motion(random_vector(random, 1));
  pair.motion_b = motion(Vector3d::Zero());
  const auto in = [](const Motion& m, const Vector3d& x) { return Vector3d(m.direction(x, 0).vector); };
  const auto back = [](const Motion& m, const Vector3d& x) {
    Vector3d result;
    for (int d = 0; d < 3; ++d) result[d] = m.direction(Vector3d::Unit(d), 0).vector.dot(x);
    return result;
  };
  for (Vector3d& x : pair.a) x = random_vector(random, 1);
  for (Vector3d& x : pair.b) x = random_vector(random, 1);
  Corners &a = pair.a, &b = pair.b;
  Vector3d n, on_a, on_b;  // in the world, about the centre of each
  if (random.one_in(2)) {  // a corner of b and the face of a
    n = in(pair.motion_a, Vector3d(a[1] - a[0]).cross(Vector3d(a[2] - a[0]))).normalized();
    on_a = in(pair.motion_a, 0.3 * a[0] + 0.3 * a[1] + 0.4 * a[2]);
    for (std::size_t k = 1; k < 3; ++k) {
      const Vector3d out = in(pair.motion_b, b[k] - b[0]);
      if (out.dot(n) < 0) b[k] = b[0] + back(pair.motion_b, out - 2 * out.dot(n) * n);
    }
    on_b = in(pair.motion_b, b[0]);
  } else {  // two edges
    const Vector3d u = in(pair.motion_a, a[1] - a[0]), v = in(pair.motion_b, b[1] - b[0]);
    n = u.cross(v).normalized();
    on_a = in(pair.motion_a, 0.4 * a[0] + 0.6 * a[1]), on_b = in(pair.motion_b, 0.7 * b[0] + 0.3 * b[1]);
    const Vector3d third_a = in(pair.motion_a, a[2] - a[0]), third_b = in(pair.motion_b, b[2] - b[0]);
    if (third_a.dot(n) > 0) a[2] = a[0] + back(pair.motion_a, third_a - 2 * third_a.dot(n) * n);
    if (third_b.dot(n) < 0) b[2] = b[0] + back(pair.motion_b, third_b - 2 * third_b.dot(n) * n);
  }
  auto& path = pair.motion_b.path.coefficients;
  path[0] = pair.motion_a.path.coefficients[0] + on_a - on_b - random.between(-1, 1) * 0x1p-52 * n;
  const Vector3d at = pair.motion_a.path.coefficients[0] + on_a;
  const double parting = PointRates<2>(pair.motion_a, pair.motion_b, 0).velocity(at).dot(n);
  path[1] += (speed - parting) * n;
  return pair;
}

}  // namespace

TEST_CASE("triangles that part are clear but for roundings, and such that approach are not", "[turning]") {
  const std::uint64_t seed = 9301;
  CAPTURE(seed);
  Random random(seed);
  int clear_pairs = 0, penetrated = 0;
  for (int round = 0; round < 400; ++round) {
    CAPTURE(round);
    const double speed = std::pow(10.0, random.between(-4, 0));
    const Touching parts = touching(random, speed);
    const TurningTriangles<2> pair(parts.motion_a, parts.a, parts.motion_b, parts.b);
    const double until = std::min(1.0, pair.clear_until(pair.frame(0), 1));
    if (until > 0) {
      ++clear_pairs;
      const WaysApart<TurningTriangles<2>> ways(pair);
      for (const double x : {1e-6 / speed, 0.1, 0.5, 0.9, 1.0}) {
        const double t = x * until;
        if (t * speed > 1e-10 && t < until) CHECK_FALSE(ways.penetrate(t));
      }
      // What they penetrate by at first does not count: they part there.
      const auto mesh_of = [](const Corners& corners) {
        const std::vector<Vector3d> vertices(corners.begin(), corners.end());
        return MeshShape{std::make_shared<const Mesh>(vertices, std::vector<Mesh::Triangle>{{0, 1, 2}})};
      };
      const Solid a{mesh_of(parts.a), parts.motion_a}, b{mesh_of(parts.b), parts.motion_b};
      const double meet = first_contact(a.body(), b.body(), 0, until, ContactMode::transparent);
      if (meet != never) {
        ++penetrated;
        CHECK(meet * speed < 1e-10);
        const Contact contact = contact_at(a.body(), b.body(), meet);
        CHECK(contact.normal.dot(PointRates<2>(a.motion, b.motion, meet).velocity(contact.point)) > 0.5 * speed);
      }
      CHECK(first_contact(a.body(), b.body(), 0, until, ContactMode::resolved) == never);
    }
    const Touching approach = touching(random, -speed);
    const TurningTriangles<2> meets(approach.motion_a, approach.a, approach.motion_b, approach.b);
    CHECK(meets.clear_until(meets.frame(0), 1) == 0);
  }
  CHECK(clear_pairs > 300);
  CHECK(penetrated > 50);
}

TEST_CASE("edges in the plane of a triangle are left to exact signs, though they part", "[turning]") {
  const Corners floor{Vector3d(0, 0, 0), Vector3d(4, 0, 0), Vector3d(0, 4, 0)};
  const Corners wall{Vector3d(1, 1, 0), Vector3d(2, 1, 0), Vector3d(1, 1, 2)};
  const auto motion = [](const Vector3d& velocity) { return kds::tests::motion_of<2>({0, 0, 0}, velocity, {0, 0, 0}); };
  const Motion still = motion({0, 0, 0}), up = motion({0, 0, 1});
  const TurningTriangles<2> flush(still, floor, up, wall);
  CHECK(flush.clear_until(flush.frame(0), 1) == 0);
  const Corners leaning{Vector3d(1, 1, 0), Vector3d(2, 1, 0.5), Vector3d(1, 1, 2)};
  const TurningTriangles<2> corner(still, floor, up, leaning);
  CHECK(corner.clear_until(corner.frame(0), 1) > 0.5);
}

TEST_CASE("where meshes touch is the same whether the search hands it on or not", "[turning]") {
  const std::uint64_t seed = 9302;
  CAPTURE(seed);
  Random random(seed);
  const std::vector<Shape> shapes{MeshShape{samples::torus(8, 4), 1}, MeshShape{samples::cuboid({0.5, 0.75, 1})},
                                  Box{{0.5, 0.25, 1}}, Sphere{0.5}, Capsule{0.25, 0.75}};
  int handed_on = 0, contacts = 0;
  for (int round = 0; round < 250; ++round) {
    CAPTURE(round);
    const auto body = [&](const Vector3d& place) {
      const Shape& shape = shapes[random.one_in(2) ? 0 : static_cast<std::size_t>(random.between(0, 4.99))];
      return Solid{shape, kds::tests::random_turning_motion(random, place, 1)};
    };
    Solid a = body({0, 0, 0});
    a.shape = shapes[random.one_in(4) ? 1 : 0], a.placed = place(a.shape, Eigen::Quaterniond::Identity());
    Solid b = body(random_vector(random, 2));
    if (random.one_in(8)) {  // face on face
      a = Solid{shapes[1], a.motion}, b = Solid{shapes[1], a.motion};
      b.motion.path.coefficients[0] += Vector3d(a.motion.direction({0, 0, 2.5}, a.motion.path.start).vector);
      b.motion.path.coefficients[1] -= Vector3d(a.motion.direction({0, 0, 1}, a.motion.path.start).vector);
    }
    for (const ContactMode mode : {ContactMode::resolved, ContactMode::transparent}) {
      FoundTouch found;
      const double t = first_contact(a.body(), b.body(), 0, 2, mode, &found);
      if (t == never) continue;
      ++contacts;
      handed_on += found.time == t;
      CHECK(same(contact_at(a.body(), b.body(), t, found), contact_at(a.body(), b.body(), t)));
    }
  }
  CHECK(contacts > 100);
  CHECK(handed_on > contacts / 2);
}

}  // namespace test_mesh_touches
