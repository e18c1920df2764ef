// Convex hulls with balls, boxes, capsules and hulls: when they meet, against distances by brute force, and against the
// exact tests of boxes.
#include "collision/narrow_phase/narrow_phase.hpp"
#include "collision/narrow_phase/pair_tests.hpp"
#include "collision/shapes/convex_hull.hpp"
#include "kds/arithmetic/lattice.hpp"
#include "tests/support/convex_gap.hpp"
#include "tests/support/first_time_check.hpp"
#include "tests/support/random_hulls.hpp"
#include "tests/support/random_numbers.hpp"
#include "tests/support/random_vectors.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace test_hull_contact {
namespace {

using namespace kds;
using namespace kds::collision;
using certificates::PointMotion;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using kds::tests::ConvexGap;
using kds::tests::Random;
using kds::tests::random_vector;

/// Corners of a lattice, so that faces and edges of two are often parallel; or anywhere; or nearly in a plane.
Shape random_hull(Random& random) {
  return kds::tests::hull_of_random([&random] {
    std::vector<Vector3d> points;
    const auto kind = random.below(3);
    const int count = 4 + static_cast<int>(random.below(5));
    for (int i = 0; i < count; ++i) {
      Vector3d p = random_vector(random, 1);
      if (kind == 0) p = kds::tests::on_lattice(p);
      if (kind == 1) p[2] *= 0x1p-20;
      points.push_back(p);
    }
    return points;
  });
}

Shape random_solid(Random& random) {
  switch (random.below(4)) {
    case 0:
      return Sphere{random.between(0.2, 1)};
    case 1:
      return Capsule{random.between(0.1, 0.5), random.between(0.2, 1)};
    case 2:
      return Box{Vector3d(0.5, random.between(0.2, 1), random.one_in(2) ? 0.5 : random.between(0.2, 1))};
    default:
      return random_hull(random);
  }
}

Quaterniond random_orientation(Random& random) {
  if (random.one_in(3)) return Quaterniond::Identity();
  if (random.one_in(3)) return Quaterniond(0.5, 0.5, 0.5, 0.5);
  return Quaterniond(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1), random.between(-1, 1))
      .normalized();
}

template <int Degree>
struct Solid {
  PlacedShape shape;
  PointMotion<Degree> motion;
  ConvexGap gap{shape.shape};

  TranslatingShape<Degree> body() const { return {shape, motion}; }
  ConvexGap::Pose pose(double t) const {
    ConvexGap::Pose pose{};
    for (std::size_t d = 0; d < 3; ++d) {
      const auto i = static_cast<Eigen::Index>(d);
      for (std::size_t k = Degree + 1; k-- > 0;) {
        pose.centre[d] = pose.centre[d] * (static_cast<long double>(t) - motion.start) + motion.coefficients[k][i];
        if (k < 3) pose.columns[k][d] = shape.rotation(i, static_cast<Eigen::Index>(k));
      }
      for (std::size_t k = 0; k < 3; ++k) pose.columns[k][d] = shape.rotation(i, static_cast<Eigen::Index>(k));
    }
    return pose;
  }
};

template <int Degree>
double gap(const Solid<Degree>& a, const Solid<Degree>& b, double t) {
  return static_cast<double>(ConvexGap::between(a.gap, a.pose(t), b.gap, b.pose(t)));
}

/// A path near the origin at a time of about 1.
template <int Degree>
PointMotion<Degree> random_path(Random& random, const Vector3d& meets) {
  const Vector3d velocity = random.one_in(4) ? Vector3d(0, 0, random.one_in(2) ? -1 : 1) : random_vector(random, 2);
  PointMotion<Degree> path{{meets - velocity, velocity}, 0};
  if constexpr (Degree == 2) {
    path.coefficients[2] = random.one_in(2) ? Vector3d(0, 0, 0) : random_vector(random, 1);
  }
  if (random.one_in(4)) path = path.restarted(-1000);
  return path;
}

template <int Degree>
void check_pairs(std::uint32_t seed, int pairs) {
  Random random(seed);
  int meetings = 0;
  for (int i = 0; i < pairs; ++i) {
    const Vector3d beside =
        random.one_in(3) ? Vector3d(random_vector(random, 2).array().round()) : random_vector(random, 2);
    const Solid<Degree> a{place(random_hull(random), random_orientation(random)),
                          random_path<Degree>(random, {0, 0, 0})};
    const Solid<Degree> b{place(random_solid(random), random_orientation(random)), random_path<Degree>(random, beside)};
    INFO("seed " << seed << ", pair " << i << ", with a " << kind_name(b.shape.shape));
    const double horizon = 4;
    const double found = first_contact(a.body(), b.body(), 0, horizon, ContactMode::transparent);
    CHECK(first_contact(b.body(), a.body(), 0, horizon, ContactMode::transparent) == found);
    const double size = a.shape.bounding_radius + b.shape.bounding_radius + a.motion.coefficients[0].norm() +
                        b.motion.coefficients[0].norm();
    const double tolerance = 1e-14 * size * (a.motion.start < -100 || b.motion.start < -100 ? 10 : 1);
    const auto width = [&](double t) { return gap(a, b, t); };
    const auto verdict = kds::tests::check_first_time(width, 0, horizon, found, tolerance, 60);
    CHECK_FALSE(verdict.missed);
    CHECK_FALSE(verdict.wrong);
    PairMemory memory;
    const auto estimate = estimated_first_contact(a.body(), b.body(), 0, horizon, ContactMode::transparent, memory);
    CHECK(estimate.time <= found);
    if (found == never) continue;
    ++meetings;
    CHECK(in_contact(a.body(), b.body(), found));
    if (found > 0) CHECK_FALSE(in_contact(a.body(), b.body(), next_down(found)));
    const double parted = first_separation(a.body(), b.body(), found, horizon);
    if (parted != never) {
      CHECK(std::abs(width(parted)) < tolerance);
      CHECK_FALSE(in_contact(a.body(), b.body(), parted));
      CHECK(width(0.5 * (found + parted)) < tolerance);
    }
    if (found == 0) continue;
    // A plane across the normal through the point has the one on one side and the other on the other.
    const Contact contact = contact_at(a.body(), b.body(), found);
    CHECK(std::abs(contact.normal.norm() - 1) < 1e-12);
    const auto far = [&](const Solid<Degree>& s, const Vector3d& along) {
      const auto feature = supporting_feature(s.shape, along);
      return along.dot(s.motion.position(found) + feature.vertices[0] - contact.point);
    };
    CHECK(std::abs(far(a, contact.normal)) < 1e-6 * size);
    CHECK(std::abs(far(b, -contact.normal)) < 1e-6 * size);
  }
  CHECK(meetings > pairs / 5);
}

}  // namespace

TEST_CASE("hulls and other solids meet when their distance says so", "[narrow-phase][hull]") {
  check_pairs<1>(1, 120);
  check_pairs<2>(2, 120);
}

TEST_CASE("a hull of the corners of a box meets as the box does, to the bit", "[narrow-phase][hull]") {
  Random random(5);
  int meetings = 0;
  for (int i = 0; i < 300; ++i) {
    const Vector3d half(random.between(0.2, 1), 0.5, 0.5);
    std::vector<Vector3d> corners;
    for (int k = 0; k < 8; ++k) {
      corners.emplace_back(k & 1 ? half[0] : -half[0], k & 2 ? half[1] : -half[1], k & 4 ? half[2] : -half[2]);
    }
    // Quarter turns are exact, so that both are the same solid.
    const Quaterniond turned = random.one_in(2) ? Quaterniond::Identity() : Quaterniond(0.5, 0.5, 0.5, 0.5);
    const PlacedShape box = place(Box{half}, turned), hull = place(convex_hull(corners), turned);
    const PlacedShape other = place(random.one_in(3)   ? Shape(Sphere{0.25})
                                    : random.one_in(2) ? Shape(Capsule{0.25, 0.5})
                                                       : Shape(Box{Vector3d(0.5, 0.25, 1)}),
                                    random.one_in(2) ? Quaterniond::Identity() : Quaterniond(0.5, 0.5, 0.5, 0.5));
    const auto path_a = random_path<2>(random, {0, 0, 0});
    const auto path_b = random_path<2>(random, Vector3d(random_vector(random, 3).array().round() / 2));
    const TranslatingShape<2> a{box, path_a}, c{hull, path_a}, b{other, path_b};
    INFO("pair " << i << " with a " << kind_name(other.shape));
    for (const ContactMode mode : {ContactMode::transparent, ContactMode::resolved}) {
      const double of_box = first_contact(a, b, 0, 4, mode);
      CHECK(first_contact(c, b, 0, 4, mode) == of_box);
      CHECK(first_contact(b, c, 0, 4, mode) == of_box);
      meetings += of_box != never;
      if (of_box != never) CHECK(first_separation(c, b, of_box, 8) == first_separation(a, b, of_box, 8));
    }
  }
  CHECK(meetings > 100);
}

TEST_CASE("hulls that touch or slide on each other do not penetrate", "[narrow-phase][hull]") {
  const std::vector<Vector3d> cube{{-1, -1, -1}, {1, -1, -1}, {-1, 1, -1}, {1, 1, -1},
                                   {-1, -1, 1},  {1, -1, 1},  {-1, 1, 1},  {1, 1, 1}};
  const std::vector<Vector3d> diamond{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  const PlacedShape a = place(convex_hull(cube), Quaterniond::Identity());
  const PlacedShape b = place(convex_hull(diamond), Quaterniond::Identity());
  const PlacedShape ball = placed_ball(1);
  const PointMotion<1> still{{Vector3d(0, 0, 0), Vector3d(0, 0, 0)}, 0};
  const auto first = [&](const PlacedShape& other, const Vector3d& from, const Vector3d& velocity) {
    const PointMotion<1> path{{from, velocity}, 0};
    return first_contact<PointMotion<1>>({a, still}, {other, path}, 0, 100, ContactMode::transparent);
  };
  CHECK(first(a, {2, 5, 0}, {0, -1, 0}) == never);           // face along face
  CHECK(first(a, {next_down(2.0), 5, 0}, {0, -1, 0}) == 3);  // and by a unit in the last place
  CHECK(first(a, {2, 2, 5}, {0, 0, -1}) == never);           // edge along edge
  CHECK(first(b, {2, 5, 0}, {0, -1, 0}) == never);           // corner along a face
  CHECK(first(b, {2, 1.5, 5}, {0, 0, -1}) == never);
  CHECK(first(b, {1.5, 1.5, 5}, {0, 0, -1}) == never);  // edge along edge, not parallel: 45 degrees
  CHECK(first(b, {1.5, next_down(1.5), 5}, {0, 0, -1}) != never);
  CHECK(first(ball, {2, 5, 0}, {0, -1, 0}) == never);
  CHECK(first(ball, {next_down(2.0), 5, 0}, {0, -1, 0}) != never);
  CHECK(first(ball, {0, 5, 0}, {0, -1, 0}) == 3);
  CHECK(first(b, {0, 5, 0}, {0, -1, 0}) == 3);
}

}  // namespace test_hull_contact
