// Meshes against meshes, boxes and balls: against brute force, and against static distances that share no code with
// the tests over time.
#include "collision/narrow_phase/ball_touch.hpp"
#include "collision/narrow_phase/convex_touch.hpp"
#include "collision/narrow_phase/mesh_contact.hpp"
#include "collision/narrow_phase/separating_axes.hpp"
#include "tests/collision/sample_meshes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace {

using namespace kds::collision;
using namespace kds::collision::samples;

constexpr double infinity = std::numeric_limits<double>::infinity();

// ---- Static distances in long double -------------------------------------------------------------------------------

using Long = long double;
using Vector3l = Eigen::Matrix<Long, 3, 1>;
using Corners = std::array<Vector3l, 3>;

Long segment_distance(const Vector3l& p, const Vector3l& u, const Vector3l& q, const Vector3l& v) {
  const Vector3l w = p - q;
  const Long uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), uw = u.dot(w), vw = v.dot(w);
  Long best = std::numeric_limits<Long>::infinity();
  const auto consider = [&](Long s, Long t) {
    best = std::min(best, (w + std::clamp<Long>(s, 0, 1) * u - std::clamp<Long>(t, 0, 1) * v).norm());
  };
  const Long determinant = uu * vv - uv * uv;
  if (determinant > 0) {
    const Long s = (uv * vw - vv * uw) / determinant;
    if (s >= 0 && s <= 1) consider(s, (uv * s + vw) / vv);
  }
  for (const Long s : {0.0L, 1.0L}) consider(s, (uv * s + vw) / vv);
  for (const Long t : {0.0L, 1.0L}) consider((uv * t - uw) / uu, t);
  return best;
}

Long point_distance(const Vector3l& p, const Corners& t) {
  const Vector3l normal = (t[1] - t[0]).cross(t[2] - t[0]);
  bool inside = true;
  Long best = std::numeric_limits<Long>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3l edge = t[(i + 1) % 3] - t[i];
    inside = inside && normal.cross(edge).dot(p - t[i]) >= 0;
    const Long along = std::clamp<Long>(edge.dot(p - t[i]) / edge.dot(edge), 0, 1);
    best = std::min(best, (p - t[i] - along * edge).norm());
  }
  return inside ? std::abs(normal.dot(p - t[0])) / normal.norm() : best;
}

bool crosses(const Vector3l& p, const Vector3l& q, const Corners& t) {
  const auto volume = [](const Vector3l& a, const Vector3l& b, const Vector3l& c, const Vector3l& d) {
    return (b - a).cross(c - a).dot(d - a);
  };
  if ((volume(t[0], t[1], t[2], p) > 0) == (volume(t[0], t[1], t[2], q) > 0)) return false;
  const bool first = volume(p, q, t[0], t[1]) > 0;
  return (volume(p, q, t[1], t[2]) > 0) == first && (volume(p, q, t[2], t[0]) > 0) == first;
}

Long triangle_distance(const Corners& a, const Corners& b) {
  Long best = std::numeric_limits<Long>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    if (crosses(a[i], a[(i + 1) % 3], b) || crosses(b[i], b[(i + 1) % 3], a)) return 0;
    best = std::min({best, point_distance(a[i], b), point_distance(b[i], a)});
    for (std::size_t j = 0; j < 3; ++j) {
      best = std::min(best, segment_distance(a[i], a[(i + 1) % 3] - a[i], b[j], b[(j + 1) % 3] - b[j]));
    }
  }
  return best;
}

std::vector<PlacedTriangle> triangles_of(const PlacedShape& shape) {
  const auto& [mesh, scale] = std::get<MeshShape>(shape.shape);
  const auto vertices = mesh->placed_vertices(shape.rotation, scale);
  std::vector<PlacedTriangle> triangles;
  for (const auto& [a, b, c] : mesh->triangles()) triangles.push_back({{vertices[a], vertices[b], vertices[c]}});
  return triangles;
}

template <int Degree>
Vector3l exact_place(const RelativeMotion<Degree>& motion, Long tau) {
  Vector3l place = motion.coefficients[Degree].template cast<Long>();
  for (std::size_t i = Degree; i-- > 0;) place = place * tau + motion.coefficients[i].template cast<Long>();
  return place;
}

Corners corners(const PlacedTriangle& t, const Vector3l& offset) {
  return {t.vertices[0].cast<Long>() + offset, t.vertices[1].cast<Long>() + offset,
          t.vertices[2].cast<Long>() + offset};
}

/// Distance of the surfaces of two meshes; of a mesh and a ball's surface, 0 inside the ball.
Long distance(const PlacedShape& a, const PlacedShape& b, const Vector3l& offset) {
  Long best = std::numeric_limits<Long>::infinity();
  const Vector3l nowhere = Vector3l::Zero();
  if (const auto* ball = std::get_if<Sphere>(&b.shape)) {
    for (const auto& t : triangles_of(a)) best = std::min(best, point_distance(offset, corners(t, nowhere)));
    return std::max<Long>(best - ball->radius, 0);
  }
  const auto of_b = triangles_of(b);
  for (const auto& t : triangles_of(a)) {
    for (const auto& u : of_b) best = std::min(best, triangle_distance(corners(t, nowhere), corners(u, offset)));
  }
  return best;
}

// ---- Brute force over all pairs of triangles -----------------------------------------------------------------------

/// Every pair's own object for a and b; `visit(i, j, touch)`.
template <int Degree, class Visit>
void every_touch(const PlacedShape& a, const PlacedShape& b, const RelativeMotion<Degree>& motion, const Visit& visit) {
  const auto gap = contact_gap(motion, a.bounding_radius + b.bounding_radius);
  const auto of_a = triangles_of(a);
  if (const auto* ball = std::get_if<Sphere>(&b.shape)) {
    // The same horizon is not known here: only degree 1, which does not use it.
    for (std::uint32_t i = 0; i < of_a.size(); ++i) {
      visit(i, 0u, BallTouch<Degree>(of_a[i], PlacedBall{ball->radius}, motion, gap, 0x1p200, {0, 0x1p200}));
    }
  } else if (std::holds_alternative<Box>(b.shape)) {
    const PlacedBox box{b.half_axes, b.rotation};
    for (std::uint32_t i = 0; i < of_a.size(); ++i) {
      visit(i, 0u, ConvexTouch<Degree, PlacedBox>(of_a[i], box, motion, gap));
    }
  } else {
    const auto of_b = triangles_of(b);
    for (std::uint32_t i = 0; i < of_a.size(); ++i) {
      for (std::uint32_t j = 0; j < of_b.size(); ++j) {
        visit(i, j, ConvexTouch<Degree, PlacedTriangle>(of_a[i], of_b[j], motion, gap));
      }
    }
  }
}

/// The first contact at or after tau0 by looking at every pair.
template <int Degree>
std::optional<MeshTouch> brute_force(const PlacedShape& a, const PlacedShape& b, const RelativeMotion<Degree>& motion,
                                     double tau0, ContactMode mode) {
  std::optional<MeshTouch> best;
  every_touch(a, b, motion, [&](std::uint32_t i, std::uint32_t j, const auto& touch) {
    double tau = touch.first_inside(tau0);
    while (mode == ContactMode::resolved && tau < infinity && !touch.approaching(tau)) {
      tau = touch.turning(tau, touch.leave(tau));
      if (tau < infinity) tau = touch.first_inside(tau);
    }
    if (tau < infinity && (!best || tau < best->tau)) best = {tau, i, j};
  });
  return best;
}

/// The first time at or after tau at which no pair touches.
template <int Degree>
double brute_force_free(const PlacedShape& a, const PlacedShape& b, const RelativeMotion<Degree>& motion, double tau) {
  for (bool moved = true; moved && tau < infinity;) {
    moved = false;
    every_touch(a, b, motion, [&](std::uint32_t, std::uint32_t, const auto& touch) {
      if (tau == infinity || touch.first_inside(tau) != tau) return;
      tau = touch.leave(tau);
      moved = true;
    });
  }
  return tau;
}

PlacedShape random_shape(Random& random, int kind) {
  const double scale = random.uniform(0.5, 1.5);
  switch (kind) {
    case 0:
      return placed(torus(8, 4), scale, random.orientation());
    case 1:
      return placed(cuboid({0.5, 0.7, 0.3}), scale, random.orientation());
    case 2:
      return placed(ball_mesh(1), scale, random.orientation());
    case 3:
      return place(Box{{0.5 * scale, 0.3 * scale, 0.8 * scale}}, random.orientation());
    default:
      return place(Sphere{0.6 * scale}, Eigen::Quaterniond::Identity());
  }
}

template <int Degree>
void against_brute_force(std::uint64_t seed, int trials) {
  INFO("seed " << seed << ", degree " << Degree);
  Random random(seed);
  int met = 0;
  for (int trial = 0; trial < trials; ++trial) {
    const PlacedShape a = random_shape(random, static_cast<int>(random.below(3)));
    const PlacedShape b = random_shape(random, static_cast<int>(random.below(Degree == 1 ? 5 : 4)));
    auto motion = encounter<Degree>(random, random.uniform(0.5, 3), 1.5);
    if (trial % 10 == 0) motion.coefficients[0] *= 0.1;  // begins in contact, as a rule
    const MeshPair<Degree> pair(a, b, motion);
    for (const ContactMode mode : {ContactMode::transparent, ContactMode::resolved}) {
      const double tau0 = trial % 3 == 0 ? random.uniform(0, 1) : 0.0;
      INFO("trial " << trial << ", kind " << b.shape.index() << ", tau0 " << tau0);
      const auto found = pair.first_contact(tau0, infinity, mode);
      const auto expected = brute_force(a, b, motion, tau0, mode);
      REQUIRE(found.has_value() == expected.has_value());
      if (!found) continue;
      ++met;
      REQUIRE(found->tau == expected->tau);
      REQUIRE(found->triangle_a == expected->triangle_a);
      REQUIRE(found->triangle_b == expected->triangle_b);
      if (mode == ContactMode::transparent) {
        REQUIRE(pair.touching(found->tau));
        const double free = pair.first_free_time(found->tau, infinity);
        REQUIRE(free == brute_force_free(a, b, motion, found->tau));
        if (free < infinity) REQUIRE_FALSE(pair.touching(free));
        if (found->tau > tau0) REQUIRE_FALSE(pair.touching(std::nextafter(found->tau, 0)));
      }
    }
  }
  CHECK(met > trials / 2);
}

}  // namespace

TEST_CASE("Trees give what all pairs of triangles give, bit for bit") {
  against_brute_force<1>(1, 60);
  against_brute_force<1>(2, 60);
  against_brute_force<2>(3, 40);
}

namespace {

/// Before the contact that is reported the surfaces are apart, and at it they are nearer than a few gaps: sampled with
/// static distances. If none is reported they are apart at all times.
template <int Degree>
void against_distances(std::uint64_t seed, int trials) {
  INFO("seed " << seed << ", degree " << Degree);
  Random random(seed);
  int met = 0;
  for (int trial = 0; trial < trials; ++trial) {
    INFO("trial " << trial);
    const PlacedShape a = random_shape(random, 1 + static_cast<int>(random.below(2)));
    const int kind = static_cast<int>(random.below(3));
    const PlacedShape b = random_shape(random, kind == 2 ? 4 : 1 + kind);
    const auto motion = encounter<Degree>(random, 3, 1.5);
    const MeshPair<Degree> pair(a, b, motion);
    const double radii = a.bounding_radius + b.bounding_radius;
    const auto found = pair.first_contact(0, 2, ContactMode::transparent);
    const int samples = 40;
    const Long last = found ? found->tau : 2.0;
    for (int i = 0; i < samples; ++i) {
      const Long tau = last * i / samples;
      const Vector3l place = exact_place(motion, tau);
      if (place.norm() > radii) continue;
      REQUIRE(distance(a, b, place) > 0);
    }
    if (!found) continue;
    ++met;
    const double gap = contact_gap(motion, radii)(found->tau);
    const Long at_contact = distance(a, b, exact_place<Degree>(motion, found->tau));
    REQUIRE(at_contact <= 20 * gap);
    // Never late: up to 2^-40 before there is something between them.
    REQUIRE(distance(a, b, exact_place<Degree>(motion, found->tau * (1 - 0x1p-40L))) > 0);
    // And soon after, unless it grazes, they penetrate: the contact is true.
    const auto where = pair.where(found->tau);
    const double speed = -where.normal.dot(motion.velocity(found->tau));
    if (speed > 0.1) REQUIRE(distance(a, b, exact_place<Degree>(motion, found->tau + 20 * gap / speed)) <= 0);
    // The point lies on both surfaces.
    const auto of_a = triangles_of(a);
    Long off = infinity;
    for (const auto& t : of_a)
      off = std::min(off, point_distance(where.point.template cast<Long>(), corners(t, Vector3l::Zero())));
    REQUIRE(off <= 1e-12L);
  }
  CHECK(met > trials / 4);
}

}  // namespace

TEST_CASE("Before a contact surfaces are apart, and at it they are near") {
  against_distances<1>(11, 60);
  against_distances<2>(12, 60);
}

// ---- Watertight ----------------------------------------------------------------------------------------------------

namespace {

/// A needle whose tip is its model's origin and whose body stretches along -z.
std::shared_ptr<const Mesh> needle() {
  return std::make_shared<const Mesh>(
      std::vector<Vector3d>{{0, 0, 0}, {0.1, 0, -1}, {-0.05, 0.09, -1}, {-0.05, -0.09, -1}},
      std::vector<Mesh::Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}});
}

template <int Degree>
struct Shot {
  PlacedShape target;
  PlacedShape bullet;
  RelativeMotion<Degree> motion;
  double arrival;  ///< when the bullet's tip or edge is at the place aimed at
};

template <int Degree>
void check(const Shot<Degree>& shot) {
  const MeshPair<Degree> pair(shot.target, shot.bullet, shot.motion);
  const auto found = pair.first_contact(0, infinity, ContactMode::resolved);
  REQUIRE(found);
  // The place aimed at is a point of the surface, up to a few roundings.
  REQUIRE(found->tau <= shot.arrival * (1 + 0x1p-48));
  REQUIRE(pair.touching(shot.arrival));
}

/// Turns z to a direction.
Eigen::Quaterniond towards(const Vector3d& direction) {
  const Vector3d axis = Vector3d::UnitZ().cross(direction);
  const double angle = std::atan2(axis.norm(), direction[2]);
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis.norm() > 0 ? axis.normalized() : Vector3d::UnitX()));
}

/// Places on shared edges and vertices of a mesh: its vertices, the middles of its edges, and others on them.
Vector3d aim(Random& random, const PlacedShape& target) {
  const auto triangles = triangles_of(target);
  const auto& t = triangles[random.below(static_cast<std::uint32_t>(triangles.size()))];
  const std::size_t i = random.below(3);
  const double part = std::array{0.0, 0.5, 1.0 / 3, random.uniform(0, 1)}[random.below(4)];
  return (1 - part) * t.vertices[i] + part * t.vertices[(i + 1) % 3];
}

}  // namespace

TEST_CASE("No vertex slips between triangles that share an edge or a vertex, at any scale") {
  for (const double scale : {1e-6, 1e-3, 1.0, 1e3, 1e6}) {
    for (const double far : {1.0, 1e4}) {
      const std::uint64_t seed = 100;
      INFO("seed " << seed << ", scale " << scale << ", distance " << far);
      Random random(seed);
      const std::array meshes{ball_mesh(2), cuboid(), torus(8, 4)};
      for (int trial = 0; trial < 60; ++trial) {
        INFO("trial " << trial);
        Shot<1> shot;
        shot.target = placed(meshes[static_cast<std::size_t>(trial % 3)], scale, random.orientation());
        const Vector3d place = aim(random, shot.target);
        // From outside, along a direction that meets the surface.
        Vector3d direction = random.direction();
        if (direction.dot(place) > 0) direction = -direction;
        if (trial % 2 == 0) direction = -place.normalized();
        const double size = scale * std::array{1e-3, 1.0, 30.0}[random.below(3)];
        shot.bullet = placed(needle(), size, towards(direction));
        const double distance = far * (3 * scale + 3 * size);
        const double speed = std::array{1e-3, 1.0, 1e3}[random.below(3)];
        shot.arrival = distance / speed;
        shot.motion.coefficients = {place - distance * direction, speed * direction};
        check(shot);
      }
    }
  }
}

TEST_CASE("No edge slips between triangles that share an edge or a vertex") {
  const std::uint64_t seed = 101;
  INFO("seed " << seed);
  Random random(seed);
  const std::array meshes{ball_mesh(2), cuboid(), torus(8, 4)};
  for (int trial = 0; trial < 300; ++trial) {
    INFO("trial " << trial);
    Shot<1> shot;
    shot.target = placed(meshes[static_cast<std::size_t>(trial % 3)], 1, random.orientation());
    const double size = random.uniform(0.1, 2);
    shot.bullet = placed(cuboid(), size, random.orientation());
    const Vector3d there = aim(random, shot.target);
    const Vector3d on_bullet = aim(random, shot.bullet);
    const Vector3d direction = random.direction();
    const double distance = 10;
    shot.arrival = distance;
    shot.motion.coefficients = {there - on_bullet - distance * direction, direction};
    check(shot);
  }
}

TEST_CASE("A ball does not slip through a shared edge or vertex, however small") {
  const std::uint64_t seed = 102;
  INFO("seed " << seed);
  Random random(seed);
  const std::array meshes{ball_mesh(2), cuboid(), torus(8, 4)};
  for (int trial = 0; trial < 300; ++trial) {
    INFO("trial " << trial);
    Shot<1> shot;
    shot.target = placed(meshes[static_cast<std::size_t>(trial % 3)], 1, random.orientation());
    shot.bullet = place(Sphere{std::array{1e-9, 1e-3, 1.0}[random.below(3)]}, Eigen::Quaterniond::Identity());
    const Vector3d direction = random.direction();
    shot.arrival = 10;
    shot.motion.coefficients = {aim(random, shot.target) - 10 * direction, direction};
    check(shot);
  }
}

TEST_CASE("Nothing slips through on a curved path") {
  const std::uint64_t seed = 103;
  INFO("seed " << seed);
  Random random(seed);
  const std::array meshes{ball_mesh(2), cuboid(), torus(8, 4)};
  for (int trial = 0; trial < 300; ++trial) {
    INFO("trial " << trial);
    Shot<2> shot;
    shot.target = placed(meshes[static_cast<std::size_t>(trial % 3)], 1, random.orientation());
    Vector3d on_bullet = Vector3d::Zero();
    if (trial % 2 == 0) {
      shot.bullet = placed(cuboid(), 0.7, random.orientation());
      on_bullet = aim(random, shot.bullet);
    } else {
      shot.bullet = place(Sphere{std::array{1e-6, 1e-3, 0.5}[random.below(3)]}, Eigen::Quaterniond::Identity());
    }
    // Through the place aimed at when tau = arrival, from far away.
    shot.arrival = 2;
    const Vector3d velocity = 5 * random.direction();
    const Vector3d bend = std::array{1e-6, 1e-2, 1.0}[random.below(3)] * random.direction();
    shot.motion.coefficients = {aim(random, shot.target) - on_bullet - 2 * velocity + 4 * bend, velocity - 4 * bend,
                                bend};
    check(shot);
  }
}

TEST_CASE("Mesh sizes of 1e-6 next to 1e6") {
  const std::uint64_t seed = 104;
  INFO("seed " << seed);
  Random random(seed);
  const auto sphere = ball_mesh(2);
  for (int trial = 0; trial < 100; ++trial) {
    INFO("trial " << trial);
    Shot<1> shot;
    shot.target = placed(sphere, 1e6, random.orientation());
    const Vector3d there = aim(random, shot.target);
    const Vector3d direction = -there.normalized();
    shot.bullet = trial % 2 == 0 ? placed(torus(8, 4), 1e-6, random.orientation())
                                 : place(Sphere{1e-6}, Eigen::Quaterniond::Identity());
    const double distance = std::array{1e-5, 1.0, 1e6}[random.below(3)];
    shot.arrival = distance;
    shot.motion.coefficients = {there - distance * direction, direction};
    // The bullet's centre is on the surface at its arrival; half of the ring is beyond it by then.
    const MeshPair<1> pair(shot.target, shot.bullet, shot.motion);
    const auto found = pair.first_contact(0, infinity, ContactMode::resolved);
    REQUIRE(found);
    REQUIRE(found->tau <= distance);
    REQUIRE(found->tau >= distance - 1.1e-6 - 1e-8);
  }
}

TEST_CASE("Bodies that hardly move against each other are decided at once") {
  const PlacedShape ring = placed(torus(30, 20));
  const PlacedShape ball = place(Sphere{0.5}, Eigen::Quaterniond::Identity());
  for (const PlacedShape& other : {ring, ball}) {
    for (const double speed : {0.0, 1e-300, 1e-17}) {
      for (const double bend : {0.0, 1e-17}) {
        // Speeds that are nothing but the rounding of the bodies' own.
        const MeshPair<2> pair(
            ring, other,
            {{Vector3d{1.1, 1.2, 1.3}, speed * Vector3d::UnitX(), bend * Vector3d::UnitY()}, {0, 1e-16, 1e-17}});
        const auto soon = pair.first_contact(0, 1e6, ContactMode::resolved);
        CHECK_FALSE(soon);
        CHECK_NOTHROW(pair.first_contact(0, infinity, ContactMode::resolved));
        CHECK(pair.first_free_time(0, infinity) == 0);
      }
    }
  }
}

// ---- Laws ----------------------------------------------------------------------------------------------------------

TEST_CASE("The answer does not depend on the window or on the order of the bodies") {
  const std::uint64_t seed = 200;
  INFO("seed " << seed);
  Random random(seed);
  int met = 0;
  for (int trial = 0; trial < 100; ++trial) {
    const PlacedShape a = random_shape(random, static_cast<int>(random.below(3)));
    const PlacedShape b = random_shape(random, static_cast<int>(random.below(3)));
    const auto motion = encounter<2>(random, 3, 1);
    const MeshPair<2> pair(a, b, motion);
    const auto found = pair.first_contact(0, infinity, ContactMode::resolved);
    if (!found) continue;
    ++met;
    const auto same = [&](double tau0, double tau1) {
      const auto again = pair.first_contact(tau0, tau1, ContactMode::resolved);
      REQUIRE(again);
      REQUIRE(again->tau == found->tau);
      REQUIRE(again->triangle_a == found->triangle_a);
      REQUIRE(again->triangle_b == found->triangle_b);
    };
    same(0, found->tau);
    same(random.uniform(0, 1) * found->tau, 100);
    same(found->tau, found->tau);
    REQUIRE_FALSE(pair.first_contact(0, std::nextafter(found->tau, 0), ContactMode::resolved));

    RelativeMotion<2> reverse = motion;
    for (auto& c : reverse.coefficients) c = -c;
    const MeshPair<2> swapped(b, a, reverse);
    const auto mirrored = swapped.first_contact(0, infinity, ContactMode::resolved);
    REQUIRE(mirrored);
    REQUIRE(mirrored->tau == found->tau);
    if (mirrored->triangle_a != found->triangle_b || mirrored->triangle_b != found->triangle_a) continue;  // a tie
    const auto there = swapped.where(found->tau);
    const auto here = pair.where(found->tau);
    REQUIRE((there.normal + here.normal).norm() < 1e-9);
    REQUIRE(there.feature_a == here.feature_b);
    REQUIRE(there.feature_b == here.feature_a);
  }
  CHECK(met > 50);
}

TEST_CASE("A quadratic motion without acceleration is a linear motion") {
  Random random(201);
  for (int trial = 0; trial < 50; ++trial) {
    const PlacedShape a = random_shape(random, 0);
    const PlacedShape b = random_shape(random, static_cast<int>(random.below(5)));
    const auto linear = encounter<1>(random, 3, 1);
    RelativeMotion<2> quadratic{{linear.coefficients[0], linear.coefficients[1], Vector3d::Zero()}};
    const auto x = MeshPair<1>(a, b, linear).first_contact(0, infinity, ContactMode::resolved);
    const auto y = MeshPair<2>(a, b, quadratic).first_contact(0, infinity, ContactMode::resolved);
    REQUIRE(x.has_value() == y.has_value());
    if (x) REQUIRE(x->tau == y->tau);
    // And nearly one with hardly any.
    quadratic.coefficients[2] = 1e-13 * random.direction();
    const auto z = MeshPair<2>(a, b, quadratic).first_contact(0, 10, ContactMode::resolved);
    if (x && z) REQUIRE(x->tau == Approx(z->tau).epsilon(1e-6));
  }
}

TEST_CASE("A solid box meets a mesh when the mesh of the box does") {
  Random random(202);
  int met = 0;
  for (int trial = 0; trial < 100; ++trial) {
    const PlacedShape a = random_shape(random, static_cast<int>(random.below(3)));
    const Vector3d half{random.uniform(0.2, 1), random.uniform(0.2, 1), random.uniform(0.2, 1)};
    const auto orientation = random.orientation();
    const PlacedShape solid = place(Box{half}, orientation);
    const PlacedShape hollow = placed(cuboid(half), 1, orientation);
    const auto motion = encounter<2>(random, 4, 1);
    const auto x = MeshPair<2>(a, solid, motion).first_contact(0, 2, ContactMode::resolved);
    const auto y = MeshPair<2>(a, hollow, motion).first_contact(0, 2, ContactMode::resolved);
    REQUIRE(x.has_value() == y.has_value());
    if (!x) continue;
    ++met;
    REQUIRE(x->tau == Approx(y->tau).epsilon(1e-10));
  }
  CHECK(met > 50);
}

// ---- Known cases ---------------------------------------------------------------------------------------------------

TEST_CASE("Equal cubes that are aligned meet face to face") {
  for (const double speed : {1e-6, 1.0, 1e6}) {
    for (const double offset : {0.0, 0.5, 1.0}) {
      const PlacedShape cube = placed(cuboid());
      RelativeMotion<1> motion{{Vector3d{10, offset, 0}, Vector3d{-speed, 0, 0}}};
      const MeshPair<1> pair(cube, cube, motion);
      const auto found = pair.first_contact(0, infinity, ContactMode::resolved);
      REQUIRE(found);
      CHECK(found->tau == Approx(8 / speed).epsilon(1e-13));
      CHECK(found->tau <= 8 / speed);
      const auto where = pair.where(found->tau);
      CHECK(where.normal[0] == Approx(1));
      CHECK(where.point[0] == Approx(1));
      CHECK(pair.first_free_time(found->tau, infinity) == Approx(12 / speed).epsilon(1e-12));
    }
  }
}

TEST_CASE("Features, points and normals of simple contacts") {
  const PlacedShape cube = placed(cuboid());
  const auto turned = [](double degrees, const Vector3d& axis) {
    return Eigen::Quaterniond(Eigen::AngleAxisd(degrees * std::numbers::pi / 180, axis.normalized()));
  };
  SECTION("vertex on face") {
    const PlacedShape tip = placed(needle(), 1, turned(180, Vector3d::UnitX()));
    const MeshPair<1> pair(cube, tip, {{Vector3d{0.3, 0.1, 5}, Vector3d{0, 0, -1}}});
    const auto found = pair.first_contact(0, infinity, ContactMode::resolved);
    REQUIRE(found);
    CHECK(found->tau == Approx(4));
    const auto where = pair.where(found->tau);
    CHECK(to_string(where.feature_b) == "v0");
    CHECK(where.feature_a.kind == Feature::Kind::face);
    CHECK((where.point - Vector3d{0.3, 0.1, 1}).norm() < 1e-12);
    CHECK((where.normal - Vector3d::UnitZ()).norm() < 1e-12);
  }
  SECTION("edge on edge") {
    const PlacedShape diamond = placed(cuboid(), 1, turned(45, Vector3d::UnitX()));
    const PlacedShape other = placed(cuboid(), 1, turned(45, Vector3d::UnitY()));
    const MeshPair<1> pair(diamond, other, {{Vector3d{0.1, 0.2, 5}, Vector3d{0, 0, -1}}});
    const auto found = pair.first_contact(0, infinity, ContactMode::resolved);
    REQUIRE(found);
    CHECK(found->tau == Approx(5 - 2 * std::sqrt(2)));
    const auto where = pair.where(found->tau);
    CHECK(where.feature_a.kind == Feature::Kind::edge);
    CHECK(where.feature_b.kind == Feature::Kind::edge);
    CHECK((where.point - Vector3d{0.1, 0, std::sqrt(2)}).norm() < 1e-12);
  }
  SECTION("ball on face, edge, vertex") {
    const PlacedShape ball = place(Sphere{0.5}, Eigen::Quaterniond::Identity());
    const auto meet = [&](const Vector3d& start, const Vector3d& velocity) {
      const MeshPair<1> pair(cube, ball, {{start, velocity}});
      const auto found = pair.first_contact(0, infinity, ContactMode::resolved);
      REQUIRE(found);
      return std::pair(found->tau, pair.where(found->tau));
    };
    const auto [face_time, face] = meet({0.2, 0.3, 5}, {0, 0, -1});
    CHECK(face_time == Approx(3.5));
    CHECK(face.feature_a.kind == Feature::Kind::face);
    CHECK(face.feature_b.kind == Feature::Kind::none);
    CHECK((face.point - Vector3d{0.2, 0.3, 1}).norm() < 1e-12);
    const auto [edge_time, edge] = meet({1.3, 0.2, 5}, {0, 0, -1});
    CHECK(edge_time == Approx(5 - 1 - 0.4));
    CHECK(to_string(edge.feature_a) == "e5-7");
    CHECK((edge.normal - Vector3d{0.6, 0, 0.8}).norm() < 1e-9);
    const auto [vertex_time, vertex] = meet({1.3, 1, 5}, {0, 0, -1});
    CHECK(vertex_time == Approx(5 - 1 - 0.4));
    CHECK(to_string(vertex.feature_a) == "v7");
  }
  SECTION("box on mesh") {
    const PlacedShape box = place(Box{{1, 1, 1}}, Eigen::Quaterniond::Identity());
    const PlacedShape tip = placed(needle());
    const MeshPair<1> pair(tip, box, {{Vector3d{0.5, 0.5, 5}, Vector3d{0, 0, -1}}});
    const auto found = pair.first_contact(0, infinity, ContactMode::resolved);
    REQUIRE(found);
    CHECK(found->tau == Approx(4));
    const auto where = pair.where(found->tau);
    CHECK(to_string(where.feature_a) == "v0");
    CHECK(to_string(where.feature_b) == "f4");
    CHECK(where.normal[2] == Approx(1));
  }
}

TEST_CASE("After an impulse bodies that part are not in contact, and meet again when they turn") {
  const PlacedShape cube = placed(cuboid());
  SECTION("straight away") {
    const MeshPair<1> pair(cube, cube, {{Vector3d{2, 0.3, 0.1}, Vector3d{1, 0, 0}}});
    CHECK_FALSE(pair.first_contact(0, infinity, ContactMode::resolved));
    CHECK(pair.first_contact(0, infinity, ContactMode::transparent)->tau == 0);
  }
  SECTION("towards each other from within the gap") {
    const MeshPair<1> pair(cube, cube, {{Vector3d{2, 0.3, 0.1}, Vector3d{-1, 0, 0}}});
    CHECK(pair.first_contact(0, infinity, ContactMode::resolved)->tau == 0);
  }
  SECTION("sliding along each other") {
    const MeshPair<1> pair(cube, cube, {{Vector3d{2, 0.3, 0.1}, Vector3d{0, 0.01, 0.02}}});
    const auto found = pair.first_contact(0, 1, ContactMode::resolved);
    CHECK_FALSE(found);
  }
  SECTION("at rest") {
    const MeshPair<1> pair(cube, cube, {{Vector3d{2, 0.3, 0.1}, Vector3d::Zero()}});
    CHECK_FALSE(pair.first_contact(0, infinity, ContactMode::resolved));
    CHECK(pair.first_contact(0, infinity, ContactMode::transparent)->tau == 0);
    CHECK(pair.first_free_time(0, infinity) == infinity);
  }
  SECTION("a throw that comes back") {
    const MeshPair<2> pair(cube, cube, {{Vector3d{0.1, 0.2, 2}, Vector3d{0, 0, 3}, Vector3d{0, 0, -5}}});
    CHECK(pair.first_contact(0, infinity, ContactMode::resolved)->tau == Approx(0.6));
  }
  SECTION("a throw that turns within the gap") {
    const MeshPair<2> pair(cube, cube, {{Vector3d{0.1, 0.2, 2}, Vector3d{0, 0, 1e-8}, Vector3d{0, 0, -5}}});
    CHECK(pair.first_contact(0, infinity, ContactMode::resolved)->tau == Approx(1e-9).epsilon(1e-6));
  }
  SECTION("the same for a ball") {
    const PlacedShape ball = place(Sphere{0.5}, Eigen::Quaterniond::Identity());
    const Vector3d down{0, 0, -5};
    CHECK_FALSE(MeshPair<1>(cube, ball, {{Vector3d{0.3, 0.2, 1.5}, Vector3d{0.1, 0, 1}}})
                    .first_contact(0, infinity, ContactMode::resolved));
    CHECK(MeshPair<2>(cube, ball, {{Vector3d{0.3, 0.2, 1.5}, Vector3d{0, 0, 3}, down}})
              .first_contact(0, infinity, ContactMode::resolved)
              ->tau == Approx(0.6));
    CHECK(MeshPair<2>(cube, ball, {{Vector3d{0.3, 0.2, 1.5}, Vector3d{0, 0, 1e-8}, down}})
              .first_contact(0, infinity, ContactMode::resolved)
              ->tau == Approx(1e-9).epsilon(1e-6));
    // Over an edge and over a vertex.
    for (const Vector3d& start : {Vector3d{1.3, 0.2, 1.4}, Vector3d{1.3, 1, 1.4}}) {
      CHECK(MeshPair<2>(cube, ball, {{start, Vector3d{0, 0, 1e-8}, down}})
                .first_contact(0, infinity, ContactMode::resolved)
                ->tau == Approx(1e-9).epsilon(1e-6));
    }
  }
}

TEST_CASE("A mesh touches with its surface: what is inside touches nothing") {
  const PlacedShape shell = placed(ball_mesh(2));
  for (const PlacedShape& inner : {placed(cuboid(), 0.1), place(Sphere{0.1}, Eigen::Quaterniond::Identity())}) {
    const MeshPair<1> pair(shell, inner, {{Vector3d::Zero(), Vector3d::UnitX()}});
    CHECK_FALSE(pair.touching(0));
    const auto found = pair.first_contact(0, infinity, ContactMode::resolved);
    REQUIRE(found);
    CHECK(found->tau > 0.5);
  }
}

// ---- On the clock --------------------------------------------------------------------------------------------------

namespace {

using kds::certificates::PointMotion;

template <int Degree>
void on_the_clock(std::uint64_t seed, double epoch) {
  INFO("seed " << seed << ", epoch " << epoch << ", degree " << Degree);
  Random random(seed);
  int met = 0;
  for (int trial = 0; trial < 40; ++trial) {
    INFO("trial " << trial);
    const PlacedShape shape_a = random_shape(random, static_cast<int>(random.below(5)));
    const PlacedShape shape_b = random_shape(random, static_cast<int>(random.below(3)));
    const auto relative = encounter<Degree>(random, 3, 1);
    PointMotion<Degree> path_a, path_b;
    for (std::size_t i = 0; i <= Degree; ++i) {
      path_a.coefficients[i] = random.vector(1);
      path_b.coefficients[i] = path_a.coefficients[i] + relative.coefficients[i];
    }
    path_a.start = path_b.start = epoch;
    const MovingShape<Degree> a{shape_a, path_a};
    const MovingShape<Degree> b{shape_b, path_b};
    using Test = MeshContact<Degree>;
    const double begin = Test::first_contact(a, b, epoch, infinity, ContactMode::transparent);
    REQUIRE(begin == Test::first_contact(b, a, epoch, infinity, ContactMode::transparent));
    if (begin == infinity) continue;
    ++met;
    REQUIRE(begin >= epoch);
    REQUIRE(Test::in_contact(a, b, begin));
    if (begin > epoch) REQUIRE_FALSE(Test::in_contact(a, b, std::nextafter(begin, -infinity)));
    REQUIRE(Test::first_contact(a, b, epoch, begin, ContactMode::transparent) == begin);
    const Contact contact = Test::contact_at(a, b, begin);
    const Contact reverse = Test::contact_at(b, a, begin);
    REQUIRE(contact.normal.norm() == Approx(1));
    REQUIRE((contact.normal + reverse.normal).norm() < 1e-9);
    REQUIRE(contact.normal.dot(path_b.velocity(begin) - path_a.velocity(begin)) < 0);
    const double end = Test::first_separation(a, b, begin, infinity);
    REQUIRE(end > begin);
    if (end == infinity) continue;
    REQUIRE_FALSE(Test::in_contact(a, b, end));
    const Contact last = Test::contact_at(a, b, end);
    REQUIRE(last.normal.norm() == Approx(1));
    // An elastic impulse: nothing more of this contact.
    const double t = begin;
    PointMotion<Degree> after_a = path_a.restarted(t);
    PointMotion<Degree> after_b = path_b.restarted(t);
    const double approach = contact.normal.dot(after_b.coefficients[1] - after_a.coefficients[1]);
    after_b.coefficients[1] -= 2 * approach * contact.normal;
    const double next = Test::first_contact({shape_a, after_a}, {shape_b, after_b}, t, infinity, ContactMode::resolved);
    REQUIRE((next == infinity || next > t));
  }
  CHECK(met > 10);
}

}  // namespace

TEST_CASE("Contact begins and ends on the clock, at any time of day") {
  for (const double epoch : {0.0, 1.0, 1e3, 1e6, 1e9}) {
    on_the_clock<1>(301, epoch);
    on_the_clock<2>(302, epoch);
  }
}
