// The planes of the difference of two hulls: those that are not found are closed for certain, against all of them.
#include "collision/narrow_phase/difference_planes.hpp"

#include "collision/narrow_phase/hull_distance.hpp"
#include "collision/narrow_phase/narrow_phase.hpp"
#include "collision/shapes/convex_hull.hpp"
#include "collision/shapes/rotation.hpp"
#include "tests/support/random_hulls.hpp"
#include "tests/support/random_numbers.hpp"
#include "tests/support/random_vectors.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace test_difference_planes {
namespace {

using namespace kds;
using namespace kds::collision;
using certificates::PointMotion;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using kds::tests::Random;
using kds::tests::random_vector;

/// On a ball, on a lattice, so that faces and edges of two are often parallel, or nearly in a plane.
Shape random_hull(Random& random) {
  const auto kind = random.below(4);
  const std::size_t count = 4 + random.below(kind < 2 ? 40 : 12);
  return kds::tests::hull_of_random([&] {
    std::vector<Vector3d> points;
    for (std::size_t i = 0; i < count; ++i) {
      Vector3d p = random_vector(random, 1);
      if (kind < 2) p.normalize();
      if (kind == 2) p = kds::tests::on_lattice(p);
      if (kind == 3) p[2] *= 0x1p-20;
      points.push_back(p);
    }
    return points;
  });
}

Quaterniond random_orientation(Random& random) {
  if (random.one_in(3)) return Quaterniond::Identity();
  return Quaterniond(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1), random.between(-1, 1))
      .normalized();
}

template <int Degree>
struct Solid {
  PlacedShape shape;
  PointMotion<Degree> motion;
  ConvexCore core{shape.shape};
  std::vector<Vector3d> places = [this] {
    std::vector<Vector3d> turned;
    for (const Vector3d& p : core.points()) turned.push_back(rotated(shape.rotation, p));
    return turned;
  }();

  TranslatingShape<Degree> body() const { return {shape, motion}; }
};

template <int Degree>
struct Pair {
  Solid<Degree> a, b;
  double horizon;
  certificates::HullDifference hulls{{a.shape.rotation, a.core.points()}, {b.shape.rotation, b.core.points()}};
  std::array<std::vector<Vector3d>, 2> places{a.places, b.places};
  QuickMotion<Degree> motion{a.motion, b.motion, 0, horizon, a.shape.bounding_radius + b.shape.bounding_radius};

  DifferencePlanes<Degree> planes() const { return {a.shape, a.core, b.shape, b.core, hulls, places, motion}; }
};

template <int Degree>
Pair<Degree> random_pair(Random& random) {
  const auto random_path = [&](const Vector3d& at) {
    PointMotion<Degree> path{{at, random_vector(random, 0.5) - 0.7 * at}, 0};
    if constexpr (Degree == 2) path.coefficients[2] = random.one_in(2) ? Vector3d(0, 0, 0) : random_vector(random, 1);
    return path;
  };
  return {{place(random_hull(random), random_orientation(random)), random_path({0, 0, 0})},
          {place(random_hull(random), random_orientation(random)),
           random_path(random_vector(random, 2) + Vector3d(0, 0, 1.5))},
          random.between(2, 4)};
}

/// Of the planes that are not found, how many are not surely closed at some of the times between.
template <int Degree>
int missing(const Pair<Degree>& pair, const DifferencePlanes<Degree>& found, const DifferencePlanes<Degree>& all,
            double from, double until) {
  int wrong = 0;
  for (const auto& plane : all.found()) {
    const auto same = [&](const auto& other) { return other.number == plane.number; };
    if (!plane.known || std::any_of(found.found().begin(), found.found().end(), same)) continue;
    for (int i = 0; i <= 20; ++i) {
      const double tau = std::min(until, from + (until - from) * i / 20);
      wrong += pair.motion.surely_closed(plane.along, 1, plane.height, tau) ? 0 : 1;
    }
  }
  return wrong;
}

template <int Degree>
void check_planes(std::uint64_t seed) {
  CAPTURE(Degree, seed);
  Random random(seed);
  int inside = 0;
  std::size_t found = 0, there = 0;
  for (int round = 0; round < 60; ++round) {
    CAPTURE(round);
    const Pair<Degree> pair = random_pair<Degree>(random);
    auto all = pair.planes();
    all.find_all([](const auto&) { return true; });
    const double contact = first_contact(pair.a.body(), pair.b.body(), 0, pair.horizon, ContactMode::transparent);
    if (contact == never) continue;
    const double parted = std::min(pair.horizon, first_separation(pair.a.body(), pair.b.body(), contact, pair.horizon));
    // Times at which they touch, are deep in each other, and are apart again by a little.
    const double between = contact + random.between(0, 1) * (parted - contact);
    const std::array<std::array<double, 2>, 4> stretches{
        {{contact, contact}, {contact, between}, {between, parted}, {contact, std::min(pair.horizon, parted + 1e-9)}}};
    for (const auto& [from, until] : stretches) {
      CAPTURE(from, until);
      if (!(pair.motion.tau(until) <= pair.motion.end())) continue;
      auto planes = pair.planes();
      while (planes.find_more(from, until)) {
      }
      CHECK(missing(pair, planes, all, from, until) == 0);
      ++inside;
      if (from == until) found += planes.found().size(), there += all.found().size();
    }
    auto one = pair.planes();
    const auto outmost = one.outmost(contact);
    const auto of_all = all.outmost(contact);
    CHECK(outmost.normal == of_all.normal);
    CHECK(outmost.height == of_all.height);
  }
  CHECK(inside > 60);
  CHECK(5 * found < there);
}

}  // namespace

TEST_CASE("planes of a difference that are not found are closed for certain", "[narrow-phase][hull]") {
  check_planes<1>(31);
  check_planes<2>(32);
}

/// Of corners in a plane, but for roundings, the weights of four are any numbers.
TEST_CASE("the nearest point of a flat hull is the sum of its corners", "[narrow-phase][hull]") {
  const std::uint64_t seed = 33;
  CAPTURE(seed);
  Random random(seed);
  for (int round = 0; round < 2000; ++round) {
    CAPTURE(round);
    const Vector3d u = random_vector(random, 1), v = random_vector(random, 1);
    std::vector<Vector3d> corners;
    for (int i = 0; i < 8; ++i) corners.push_back(random.between(-1, 1) * u + random.between(-1, 1) * v);
    const auto farthest = [&](const Vector3d& along) {
      return *std::max_element(corners.begin(), corners.end(),
                               [&](const Vector3d& x, const Vector3d& y) { return along.dot(x) < along.dot(y); });
    };
    const auto nearest = nearest_to_origin(farthest, corners[0]);
    Vector3d sum = Vector3d::Zero();
    for (std::size_t i = 0; i < nearest.corners.size(); ++i) sum += nearest.weights[i] * nearest.corners[i];
    CHECK((sum - nearest.point).norm() < 1e-9);
  }
}

}  // namespace test_difference_planes
