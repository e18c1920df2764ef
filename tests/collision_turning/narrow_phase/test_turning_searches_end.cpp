// Pairs whose searches used to be the longest: solids and meshes that turn nearly alike at tiny gaps, and those that
// overlap for good without approaching.
#include "collision/narrow_phase/narrow_phase.hpp"
#include "collision/shapes/convex_hull.hpp"
#include "kds/arithmetic/lattice.hpp"

#include "tests/collision/sample_meshes.hpp"
#include "tests/collision_turning/narrow_phase/check_meetings.hpp"
#include "tests/collision_turning/narrow_phase/turning_solids.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

namespace test_turning_searches_end {
namespace {

using namespace kds;
using namespace kds::collision;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using kds::tests::first_meeting;
using kds::tests::motion_of;
using kds::tests::Random;
using kds::tests::random_vector;

template <int Degree>
using Solid = kds::tests::TurningSolid<Degree>;

std::shared_ptr<const Mesh> large_triangle() {
  return std::make_shared<const Mesh>(std::vector<Vector3d>{{-2, -2, 0}, {3, -2, 0}, {0, 3, 0}},
                                      std::vector<Mesh::Triangle>{{0, 1, 2}});
}

/// A shape, and how far from its centre it reaches along a direction.
struct Sample {
  Shape shape;
  std::vector<Vector3d> corners;
  double radius = 0;

  double reach(const Vector3d& along) const {
    double most = -never;
    for (const Vector3d& x : corners) most = std::max(most, x.dot(along));
    return most + radius;
  }
};
std::vector<Vector3d> cube_corners() {
  std::vector<Vector3d> corners;
  for (unsigned i = 0; i < 8; ++i) corners.emplace_back(i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5);
  return corners;
}
Sample sample(std::size_t kind) {
  const std::vector<Vector3d> octahedron{{0.5, 0, 0},  {-0.5, 0, 0}, {0, 0.5, 0},
                                         {0, -0.5, 0}, {0, 0, 0.5},  {0, 0, -0.5}};
  switch (kind) {
    case 0:
      return {Box{Vector3d(0.5, 0.5, 0.5)}, cube_corners()};
    case 1:
      return {Capsule{0.25, 0.5}, {{0, 0, 0.5}, {0, 0, -0.5}}, 0.25};
    case 2:
      return {convex_hull(octahedron), octahedron};
    case 3:
      return {MeshShape{samples::cuboid({0.5, 0.5, 0.5})}, cube_corners()};
    case 4:
      return {MeshShape{large_triangle()}, {{-2, -2, 0}, {3, -2, 0}, {0, 3, 0}}};
    default:
      return {Sphere{0.25}, {Vector3d::Zero()}, 0.25};
  }
}

/// Two that turn alike but for 2^-10 to 2^-60, at rates from 1e-3 to 1e15 rad/s, b beside a at a gap of 2^-20 to 2^-52,
/// or as deep in it.
template <int Degree>
struct Pair {
  Solid<Degree> a, b;
  double horizon;
};
template <int Degree>
Pair<Degree> nearly_alike(Random& random) {
  const Sample of_a = sample(random.below(5)), of_b = sample(random.below(6));
  const Vector3d along = random.one_in(4) ? Vector3d(random_vector(random, 1).normalized())
                                          : Vector3d::Unit(static_cast<int>(random.below(3)));
  const double gap = (random.one_in(4) ? -1 : 1) * std::ldexp(1.0, -random.integer(20, 52));
  const double rate =
      std::ldexp(random.between(1, 2), random.one_in(2) ? random.integer(-10, 3) : random.integer(4, 49));
  const double unlike = std::ldexp(1.0, -random.integer(10, 60));
  Quaterniond turned = Quaterniond::Identity();
  if (random.one_in(2))
    turned = Quaterniond(Eigen::AngleAxisd(random.between(-2, 2), random_vector(random, 1).normalized()));
  const Vector3d offset = turned * Vector3d((of_a.reach(along) + of_b.reach(-along) + gap) * along);
  Vector3d spin = rate * random_vector(random, 1).normalized();
  if (random.one_in(3)) spin = rate * (turned * along);
  auto motion_a = motion_of<Degree>(Vector3d::Zero(), Vector3d::Zero(), spin);
  motion_a.orientation = turned;
  auto motion_b = motion_a;
  motion_b.path.coefficients[0] = offset;
  if (random.one_in(2)) motion_b.path.coefficients[1] = spin.cross(offset);
  switch (random.below(5)) {
    case 0:
      motion_b.angular_velocity *= 1 + unlike;
      break;
    case 1:
      motion_b.angular_velocity += unlike * random_vector(random, rate);
      break;
    case 2:
      motion_b.path.start = -unlike / rate;
      break;
    case 3:
      motion_b.orientation.coeffs() += unlike * Eigen::Vector4d(random.unit(), random.unit(), random.unit(), 0);
      break;
    default:
      motion_b.path.coefficients[1] += unlike * random_vector(random, rate);
  }
  return {{of_a.shape, motion_a}, {of_b.shape, motion_b}, random.between(0.2, 1) / rate};
}

template <int Degree>
bool overlap(const Pair<Degree>& pair, double t) {
  return in_contact(pair.a.body(), pair.b.body(), t);
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("what turns nearly alike at tiny gaps meets when signs say so", "[turning]",
                       ((int Degree), Degree), 1, 2) {
  int meetings = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    CAPTURE(Degree, seed);
    Random random(seed);
    const Pair<Degree> pair = nearly_alike<Degree>(random);
    const double found = first_meeting(pair.a, pair.b, 0, pair.horizon);
    const double end = std::min(found, pair.horizon);
    if (found != never) CHECK(overlap(pair, found));
    if (found > 0) CHECK_FALSE(overlap(pair, next_down(end)));
    for (int i = 0; i < 4 && end > 0; ++i) CHECK_FALSE(overlap(pair, end * std::pow(random.between(0, 0.99), 3)));
    const double resolved = first_meeting(pair.a, pair.b, 0, pair.horizon, ContactMode::resolved);
    CHECK(resolved >= found);
    meetings += found > 0 && found != never;
  }
  CHECK(meetings > 20);
}

TEST_CASE("what goes through a triangle for good is passed over, and that ends", "[turning][capsule]") {
  // Its core is in the surface: no smaller radius parts them, so nothing tells when the two are deeper in each other.
  const double spin = GENERATE(0.0, 1.0, 1e6);
  CAPTURE(spin);
  const double horizon = 20 / std::max(1.0, spin);
  const Solid<1> surface{MeshShape{large_triangle()}, motion_of<1>({0, 0, 0}, {0, 0, 0}, {0, 0, spin})};
  for (const Shape& shape : {Shape(Capsule{0.25, 0.5}), Shape(Sphere{0.25})}) {
    Solid<1> through{shape, motion_of<1>({0.25, 0, 0}, {0, 0, 0}, {0, 0, 0.5 * spin})};
    CHECK(first_meeting(surface, through, 0, horizon) == 0);
    CHECK(first_meeting(surface, through, 0, horizon, ContactMode::resolved) == never);
    CHECK(first_separation(surface.body(), through.body(), 0, horizon) == never);
    through.motion.path.coefficients[1] = {0.5 / horizon, 0, 0};  // and along the surface
    CHECK(first_meeting(surface, through, 0, horizon, ContactMode::resolved) == never);
  }
}

}  // namespace test_turning_searches_end
