// Meshes that turn nearly alike, so near each other that only their slow relative motion tells how long they are apart.
#include "collision/motions.hpp"
#include "collision/narrow_phase/narrow_phase.hpp"
#include "collision/narrow_phase/turning/turning_triangles.hpp"
#include "collision/narrow_phase/turning/ways_apart.hpp"

#include "tests/collision/sample_meshes.hpp"
#include "tests/collision_turning/narrow_phase/turning_solids.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace test_turning_alike {
namespace {

using namespace kds;
using namespace kds::collision;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using kds::tests::motion_of;
using kds::tests::Random;
using kds::tests::random_vector;

template <int Degree>
using Solid = kds::tests::TurningSolid<Degree>;

template <int Degree>
double meet(const Solid<Degree>& a, const Solid<Degree>& b, double horizon) {
  return first_contact(a.body(), b.body(), 0, horizon, ContactMode::transparent);
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("meshes that turn nearly alike meet when boxes do, bit for bit", "[turning]",
                       ((int Degree), Degree), 1, 2) {
  int contacts = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    CAPTURE(Degree, seed);
    Random random(seed);
    // b is beyond a face of a, by a gap that is as small as 1e-11, and comes nearer, slowly or by its own turn.
    const Vector3d half_a(random.between(0.2, 1), random.between(0.2, 1), random.between(0.2, 1));
    const Vector3d half_b(random.between(0.2, 1), random.between(0.2, 1), random.between(0.2, 1));
    const double gap = std::pow(10.0, random.between(-11, -4)), rate = std::pow(10.0, random.between(-1, 1));
    const double unlike = random.one_in(4) ? 0 : std::pow(10.0, random.between(-12, -4));
    auto of_a = motion_of<Degree>(Vector3d::Zero(), Vector3d::Zero(), rate * random_vector(random, 1).normalized());
    if (random.one_in(2)) of_a.angular_velocity = {0, 0, rate};
    of_a.orientation = random.one_in(2) ? Quaterniond::Identity() : Quaterniond(1, 0, 0, random.between(-1, 1));
    auto of_b = of_a;
    of_b.angular_velocity += unlike * random_vector(random, 1);
    of_b.path.coefficients[0][2] = half_a[2] + half_b[2] + gap;
    of_b.path.coefficients[1][2] = random.one_in(3) ? 0 : -random.between(0.2, 3) * gap;
    if (Degree == 2 && random.one_in(3)) of_b.path.coefficients[2 % (Degree + 1)][2] = -gap * random.between(0.1, 1);
    if (random.one_in(4)) of_b.path.coefficients[1] += random_vector(random, gap);
    const double horizon = 2;
    const double t = meet<Degree>({Box{half_a}, of_a}, {Box{half_b}, of_b}, horizon);
    const Solid<Degree> mesh_a{MeshShape{samples::cuboid(half_a)}, of_a};
    const Solid<Degree> mesh_b{MeshShape{samples::cuboid(half_b)}, of_b};
    contacts += t < never;
    CHECK(meet(mesh_a, mesh_b, horizon) == t);
    CHECK(meet(mesh_b, mesh_a, horizon) == t);
  }
  CHECK(contacts > 20);
}

TEST_CASE("triangles that turn nearly alike are proven to be apart for long across a narrow gap", "[turning]") {
  const std::array<Vector3d, 3> corners{Vector3d(-0.5, -0.5, 0), Vector3d(0.5, -0.5, 0), Vector3d(0, 0.5, 0)};
  struct Case {
    double gap, unlike, speed, at_least;  // of b, which comes down; s
  };
  // From a that is all that moves: by its own turn, a corner of b leaves the plane in which it is by about unlike^2.
  for (const Case& c :
       {Case{1e-9, 1e-7, 0, 0.05}, Case{1e-10, 1e-12, 0, 2}, Case{1e-9, 0, 1e-9, 0.49}, Case{1e-6, 1e-3, 1e-6, 0.03}}) {
    CAPTURE(c.gap, c.unlike, c.speed);
    auto of_a = motion_of<2>(Vector3d::Zero(), Vector3d::Zero(), {0, 0, 1});
    auto of_b = motion_of<2>({0, 0, c.gap}, {0, 0, -c.speed}, {0, 0, 1 + c.unlike});
    of_a.orientation = of_b.orientation = Quaterniond(1, 0, 0, 0.3);
    const TurningTriangles<2> pair(of_a, corners, of_b, corners);
    const double until = pair.apart_until(0, 3);
    CHECK(until >= c.at_least);
    if (c.speed > 0) CHECK(until <= c.gap / c.speed);
  }
}

TEST_CASE("what is proven of triangles that turn nearly alike holds", "[turning]") {
  int meetings = 0, long_proofs = 0;
  for (std::uint64_t seed = 1; seed <= 1500; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    const auto flat = [&] {  // a triangle that is nearly in the plane z = 0 of its body
      std::array<Vector3d, 3> corners;
      const double steep = random.one_in(3) ? 0 : std::pow(10.0, random.between(-9, -1));
      for (Vector3d& x : corners) x = random_vector(random, 1).cwiseProduct(Vector3d(1, 1, steep));
      return corners;
    };
    const double gap = std::pow(10.0, random.between(-9, -2)), rate = std::pow(10.0, random.between(-1, 1.5));
    auto of_a = motion_of<2>(Vector3d::Zero(), random_vector(random, random.one_in(2) ? 0 : 1), Vector3d::Zero());
    of_a.angular_velocity = rate * (random.one_in(2) ? Vector3d::UnitZ() : Vector3d(random_vector(random, 1)));
    auto of_b = of_a;
    of_b.path.coefficients[0] += Vector3d(0, 0, gap) + random_vector(random, random.one_in(2) ? 0 : gap);
    of_b.path.coefficients[1] += random_vector(random, gap * random.between(0, 4));
    if (random.one_in(3)) of_b.path.coefficients[2] += random_vector(random, gap);
    of_b.angular_velocity += rate * std::pow(10.0, random.between(-10, -1.3)) * random_vector(random, 1);
    const TurningTriangles<2> pair(of_a, flat(), of_b, flat());
    const double horizon = 2;
    const WaysApart<TurningTriangles<2>> ways(pair);
    if (ways.penetrate(0)) continue;
    // Exact signs alone, from now on in short steps, tell when they meet.
    double meet = never;
    for (double t = 0; t < horizon && meet == never; t += 1.0 / 16)
      meet = ways.first_penetration(t, t + 1.0 / 16, true);
    meetings += meet < never;
    for (double t = 0; t < std::min(meet, horizon);) {
      const double until = std::min(pair.apart_until(t, horizon), horizon);
      CHECK(until <= meet);
      long_proofs += until - t > 0.25 / rate;
      t = std::max(until, t + 1.0 / 32);
    }
  }
  CHECK(meetings > 200);
  CHECK(long_proofs > 200);
}

}  // namespace test_turning_alike
