// Capsules against meshes: against all triangles one by one, against distances in long double, and where they lie along
// faces and edges.
#include "collision/narrow_phase/capsule_touch.hpp"
#include "collision/narrow_phase/narrow_phase.hpp"
#include "tests/collision/narrow_phase/mesh_distances.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace test_capsule_touch {
namespace {

using namespace kds::collision;
using namespace kds::collision::samples;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using kds::certificates::PointMotion;

constexpr double infinity = std::numeric_limits<double>::infinity();

PlacedCapsule core_of(const PlacedShape& shape) {
  const auto& capsule = std::get<Capsule>(shape.shape);
  return {capsule.half_length * shape.rotation.col(2), capsule.radius};
}

/// Between the surface of a mesh and that of a capsule; not above 0 where they overlap.
Long capsule_distance(const PlacedShape& mesh, const PlacedShape& capsule, const Vector3l& offset) {
  const PlacedCapsule core = core_of(capsule);
  const Vector3l from = offset - core.half.cast<Long>();
  const Vector3l to = offset + core.half.cast<Long>();
  Long best = infinity;
  for (const PlacedTriangle& each : triangles_of(mesh)) {
    const Corners t = corners(each, Vector3l::Zero());
    if (crosses(from, to, t)) return -core.radius;
    best = std::min({best, point_distance(from, t), point_distance(to, t)});
    for (std::size_t i = 0; i < 3; ++i) {
      best = std::min(best, segment_distance(from, to - from, t[i], t[(i + 1) % 3] - t[i]));
    }
  }
  return best - core.radius;
}

/// Capsules of every slenderness, many of them parallel, or nearly so, to what is in the mesh.
PlacedShape random_capsule(Random& random, const Quaterniond& of_mesh) {
  static constexpr std::array radii{0.5, 0.3, 0.1, 1e-3, 1e-9};
  static constexpr std::array lengths{1.0, 0.5, 3.0, 1e-3};
  const Capsule capsule{radii[random.below(radii.size())], lengths[random.below(lengths.size())]};
  if (random.below(2) == 0) return place(capsule, random.orientation());
  const std::array axes{Quaterniond::Identity(), Quaterniond(0.5, 0.5, 0.5, 0.5), Quaterniond(0.5, -0.5, -0.5, -0.5)};
  const Quaterniond along = of_mesh * axes[random.below(axes.size())];
  if (random.below(2) == 0) return place(capsule, along);
  const double tilt = std::ldexp(1.0, -static_cast<int>(random.below(54)));
  return place(capsule, (along * Quaterniond(1, tilt, -0.5 * tilt, 0)).normalized());
}

PlacedShape random_mesh(Random& random, const Quaterniond& turned) {
  switch (random.below(3)) {
    case 0:
      return placed(cuboid({0.5, 0.7, 0.3}), 1.5, turned);
    case 1:
      return placed(torus(8, 4), 1, turned);
    default:
      return placed(ball_mesh(1), 1, turned);
  }
}

}  // namespace

TEST_CASE("capsule and mesh: trees give what all triangles give, bit for bit", "[capsule]") {
  Random random(71);
  int met = 0;
  for (int trial = 0; trial < 150; ++trial) {
    INFO("trial " << trial);
    const Quaterniond turned = random.orientation();
    const PlacedShape a = random_mesh(random, turned);
    const PlacedShape b = random_capsule(random, turned);
    auto motion = encounter<1>(random, random.uniform(0.5, 3), 1.5);
    if (trial % 10 == 0) motion.coefficients[0] *= 0.1;  // begins in contact, as a rule
    const MeshPair<1> pair(a, b, motion);
    const auto gap = contact_gap(motion, a.bounding_radius + b.bounding_radius);
    const auto of_a = triangles_of(a);
    double first = infinity;
    std::uint32_t lowest = 0;
    for (std::uint32_t i = 0; i < of_a.size(); ++i) {
      const CapsuleTouch<1> touch(of_a[i], core_of(b), motion, gap, false, 0x1p200, {0, 0x1p200});
      const double tau = touch.first_inside(0);
      if (tau < first) first = tau, lowest = i;
    }
    const auto found = pair.first_contact(0, infinity, ContactMode::transparent);
    REQUIRE(found.has_value() == (first < infinity));
    if (!found) continue;
    ++met;
    REQUIRE(found->tau == first);
    REQUIRE(found->triangle_a == lowest);
    REQUIRE(pair.touching(first));
    if (first > 0) REQUIRE_FALSE(pair.touching(std::nextafter(first, 0)));
  }
  CHECK(met > 75);
}

namespace {

template <int Degree>
void against_distances(std::uint64_t seed, int trials) {
  Random random(seed);
  int met = 0, within = 0, without = 0, deep = 0;
  for (int trial = 0; trial < trials; ++trial) {
    INFO("seed " << seed << ", degree " << Degree << ", trial " << trial);
    const Quaterniond turned = random.below(2) == 0 ? Quaterniond::Identity() : random.orientation();
    const PlacedShape a = random_mesh(random, turned);
    const PlacedShape b = random_capsule(random, turned);
    const auto motion = encounter<Degree>(random, 3, 1.5);
    const MeshPair<Degree> pair(a, b, motion);
    const double radii = a.bounding_radius + b.bounding_radius;
    const auto gap = contact_gap(motion, radii);
    const auto found = pair.first_contact(0, 4, ContactMode::transparent);
    if (found && found->tau == 0) continue;  // they overlap at once
    const Long last = found ? found->tau : 4.0;
    constexpr int samples = 40;
    bool free = true;
    for (int i = 0; i < samples; ++i) {
      const Long tau = last * i / samples;
      free = free && capsule_distance(a, b, exact_place(motion, tau)) > 0;
    }
    CHECK(free);
    // At any time: contact where they overlap, and none where they are farther apart than contacts may be.
    bool right = true;
    for (int i = 0; i < samples; ++i) {
      const double tau = 4.0 * i / samples;
      const Long apart = capsule_distance(a, b, exact_place<Degree>(motion, tau));
      const bool touching = pair.touching(tau);
      within += apart <= 0;
      deep += apart == -core_of(b).radius;
      without += apart > 0;
      right = right && (apart > 0 || touching) && (apart <= farthest_contact * gap(tau) || !touching);
    }
    CHECK(right);
    if (!found) continue;
    ++met;
    const double tau = found->tau;
    CHECK(capsule_distance(a, b, exact_place<Degree>(motion, tau)) <= 4 * gap(tau));
    CHECK(capsule_distance(a, b, exact_place<Degree>(motion, tau * (1 - 0x1p-40L))) > 0);
    const auto where = pair.where(tau);
    const double speed = -where.normal.dot(motion.velocity(tau));
    if (speed > 0.1) CHECK(capsule_distance(a, b, exact_place<Degree>(motion, tau + 20 * gap(tau) / speed)) <= 0);
    Long off = infinity;  // the point lies on both surfaces
    for (const auto& t : triangles_of(a)) {
      off = std::min(off, point_distance(where.point.template cast<Long>(), corners(t, Vector3l::Zero())));
    }
    CHECK(off <= 1e-8L);
    const Vector3l half = core_of(b).half.cast<Long>();
    const Vector3l from_end = where.point.template cast<Long>() - exact_place<Degree>(motion, tau) + half;
    const Long along = std::clamp<Long>(from_end.dot(half) / (2 * half.dot(half)), 0, 1);
    CHECK(std::abs((from_end - 2 * along * half).norm() - core_of(b).radius) <= 1e-8L);
    const double free_again = pair.first_free_time(tau, 100);
    CHECK(free_again > tau);
    if (free_again < infinity) CHECK_FALSE(pair.touching(free_again));
  }
  CHECK(met > trials / 4);
  CHECK(within > trials);
  CHECK(without > trials);
  CHECK(deep > trials / 4);
}

}  // namespace

TEST_CASE("capsule and mesh: contacts are where the distances are", "[capsule]") {
  against_distances<1>(72, 250);
  against_distances<2>(73, 150);
}

TEST_CASE("capsule and mesh: tip, side and end on a cube of triangles", "[capsule]") {
  const PlacedShape cube = placed(cuboid(), 0.5, Quaterniond::Identity());  // reaches 0.5 to all sides
  const Quaterniond along_x(0.5, 0.5, 0.5, 0.5);
  const PointMotion<1> still{{Vector3d::Zero(), Vector3d::Zero()}, 0};
  const auto meet = [&](const PlacedShape& capsule, const Vector3d& from, const Vector3d& velocity, double expected,
                        const Vector3d& point, const char* feature) {
    INFO("from " << from.transpose());
    const PointMotion<1> path{{from, velocity}, 0};
    const TranslatingShape<1> a{cube, still};
    const TranslatingShape<1> b{capsule, path};
    const double t = first_contact(a, b, 0, 100, ContactMode::resolved);
    CHECK(t <= expected);
    CHECK(t > expected - 1e-13);
    CHECK(first_contact(b, a, 0, 100, ContactMode::resolved) == t);
    const Contact contact = contact_at(a, b, t);
    CHECK((contact.normal + velocity.normalized()).norm() < 1e-12);
    CHECK((contact.point - point).norm() < 1e-12);
    CHECK(to_string(contact.feature_b) == feature);
    // Turned back, they do not meet again.
    const PointMotion<1> back{{path.position(t), -velocity}, t};
    CHECK(first_contact(a, TranslatingShape<1>{capsule, back}, t, 100, ContactMode::resolved) == infinity);
  };
  const PlacedShape upright = place(Capsule{0.25, 0.5}, Quaterniond::Identity());
  const PlacedShape lying = place(Capsule{0.25, 0.25}, along_x);
  const PlacedShape beam = place(Capsule{0.25, 5}, along_x);
  meet(upright, {0.25, 0.125, 4}, {0, 0, -1}, 2.75, {0.25, 0.125, 0.5}, "v0");
  meet(lying, {0.125, 0.25, 4}, {0, 0, -1}, 3.25, {0.125, 0.25, 0.5}, "e0-1");
  const double corner = 0.25 * std::sqrt(0.5);  // along an edge of the cube, from outside
  meet(beam, {0.25, 4, 4}, {0, -1, -1}, 3.5 - corner, {-0.5, 0.5, 0.5},
       "e0-1");  // the lowest triangle has a corner there
  // Beside the cube, and along it: nothing.
  const auto passes = [&](const PlacedShape& capsule, const Vector3d& from, const Vector3d& velocity) {
    const PointMotion<1> path{{from, velocity}, 0};
    return first_contact(TranslatingShape<1>{cube, still}, TranslatingShape<1>{capsule, path}, 0, 100,
                         ContactMode::resolved) == infinity;
  };
  CHECK(passes(lying, {-9, 0, 0.76}, {1, 0, 0}));
  CHECK_FALSE(passes(lying, {-9, 0, 0.74}, {1, 0, 0}));
  CHECK(passes(upright, {9, 0, 1.26}, {-1, 0, 0}));
  CHECK_FALSE(passes(upright, {9, 0, 1.24}, {-1, 0, 0}));
}

TEST_CASE("capsule and mesh: one that rises and turns back meets again", "[capsule]") {
  const PlacedShape cube = placed(cuboid(), 0.5, Quaterniond::Identity());
  const PlacedShape lying = place(Capsule{0.25, 0.25}, Quaterniond(0.5, 0.5, 0.5, 0.5));
  const PointMotion<2> still{{Vector3d::Zero()}, 0};
  const PointMotion<2> up{{Vector3d(0.125, 0.25, 0.75), Vector3d(0, 0, 2), Vector3d(0, 0, -1)}, 0};
  const PointMotion<2> down{{Vector3d(0.125, 0.25, 0.75), Vector3d::Zero(), Vector3d(0, 0, -1)}, 0};
  const TranslatingShape<2> a{cube, still};
  const double again = first_contact(a, TranslatingShape<2>{lying, up}, 0, 100, ContactMode::resolved);
  CHECK(again == Approx(2).epsilon(1e-12));
  CHECK(first_contact(a, TranslatingShape<2>{lying, down}, 0, 100, ContactMode::resolved) == 0);
}

}  // namespace test_capsule_touch
