// Bodies that have just met: estimates of their next contact are never late, and lead to it.
#include "collision/narrow_phase/narrow_phase.hpp"
#include "collision/shapes/convex_hull.hpp"

#include "tests/collision_turning/narrow_phase/turning_solids.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstdint>

namespace test_turning_estimates {
namespace {

using namespace kds;
using namespace kds::collision;
using certificates::RigidMotion;
using Eigen::Vector3d;
using kds::tests::Random;
using kds::tests::random_vector;
using Solid = kds::tests::TurningSolid<2>;

constexpr double gravity = 10;
constexpr double horizon = 4;

struct Found {
  int met = 0;      ///< pairs that met
  int overlap = 0;  ///< that overlapped by a rounding then
  int proved = 0;   ///< of which an estimate told something, without the exact time of the next contact
  int again = 0;    ///< that met again
};

Shape random_solid(Random& random) {
  const Vector3d half(random.between(0.1, 1), random.between(0.1, 1), random.between(0.1, 1));
  if (random.below(2) == 0) return Box{half};
  std::vector<Vector3d> points;
  for (int signs = 0; signs < 8; ++signs) {
    points.emplace_back(signs & 1 ? half[0] : -half[0], signs & 2 ? half[1] : -half[1], signs & 4 ? half[2] : -half[2]);
  }
  return convex_hull(points);
}

/// The point of b at x moves away from that of a at this speed along the normal, from t on.
RigidMotion<2> rebound(const Solid& a, const Solid& b, const Contact& contact, double t, double speed) {
  RigidMotion<2> motion = b.motion.restarted(t);
  const auto velocity = [&](const RigidMotion<2>& m) -> Vector3d {
    return m.path.velocity(t) + m.angular_velocity.cross(contact.point - m.path.position(t));
  };
  const double now = contact.normal.dot(velocity(motion) - velocity(a.motion));
  motion.path.coefficients[1] += (speed - now) * contact.normal;
  return motion;
}

/// From one estimate to the next.
void check_estimates(const Solid& a, const Solid& b, double t, Found& found) {
  const double exact = first_contact(a.body(), b.body(), t, horizon, ContactMode::resolved);
  found.overlap += in_contact(a.body(), b.body(), t);
  found.again += exact != never;
  PairMemory memory;
  ContactEstimate next = estimated_first_contact(a.body(), b.body(), t, horizon, ContactMode::resolved, memory);
  found.proved += !next.exact && next.time > t;
  for (int steps = 0; !next.exact && steps < 1000; ++steps) {
    CHECK(next.time <= exact);
    next = certified_first_contact(a.body(), b.body(), next.time, horizon, ContactMode::resolved);
  }
  CHECK(next.exact);
  CHECK(next.time == exact);
}

/// Two bodies that meet, and part with speeds from a millimetre a second on, or hardly part at all.
void check_scene(Random& random, bool on_plane, bool flat, Found& found) {
  Solid a{on_plane ? Shape(HalfSpace{Vector3d::UnitZ(), 0}) : random_solid(random), {}};
  Solid b{random_solid(random), {}};
  a.motion.path = {{Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero()}};
  b.motion.path = {{Vector3d(0.3, 0.2, 3) + random_vector(random, 0.1), random_vector(random, flat ? 0 : 0.2),
                    Vector3d(0, 0, -gravity / 2)}};
  if (!flat) {
    const Eigen::Vector4d turn(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1), 1);
    b.motion.orientation = Eigen::Quaterniond(turn).normalized();
    b.motion.angular_velocity = random_vector(random, std::pow(10.0, random.between(-4, 1)));
    if (!on_plane) a.motion.angular_velocity = random_vector(random, std::pow(10.0, random.between(-4, 1)));
  }
  const double t = first_contact(a.body(), b.body(), 0, horizon, ContactMode::resolved);
  if (t == never) return;
  ++found.met;
  const Contact contact = contact_at(a.body(), b.body(), t);
  const double speed = random.below(8) == 0 ? 0.0 : std::pow(10.0, random.between(-6, 0.5));
  b.motion = rebound(a, b, contact, t, speed);
  if (!flat) b.motion.angular_velocity += random_vector(random, std::pow(10.0, random.between(-6, 0)));
  check_estimates(a, b, t, found);
}

void check_scenes(bool on_plane, bool flat, std::uint64_t first, std::uint64_t seeds) {
  Found found;
  for (std::uint64_t seed = first; seed < first + seeds; ++seed) {
    INFO("seed " << seed);
    Random random(seed);
    check_scene(random, on_plane, flat, found);
  }
  INFO(found.met << " met, " << found.overlap << " overlapped, " << found.proved << " proved, " << found.again
                 << " met again");
  CHECK(found.met > static_cast<int>(seeds / 2));
  CHECK(found.proved > found.met / 3);
  CHECK(found.again > found.met / 3);
  if (!flat) CHECK(found.overlap > found.met / 10);
}

}  // namespace

TEST_CASE("estimates of bodies that have just met lead to their next contact", "[narrow-phase][turning]") {
  check_scenes(false, false, 1, 150);
}
TEST_CASE("estimates of what has just met a half-space lead to its next contact", "[narrow-phase][turning]") {
  check_scenes(true, false, 1, 150);
}
TEST_CASE("estimates of what lands flat lead to the next contact", "[narrow-phase][turning]") {
  check_scenes(false, true, 1, 60);
  check_scenes(true, true, 1, 60);
}

// Each look is from the beginning of the motion, so there must be few of them.
TEST_CASE("what overlaps by a rounding, without a contact, is looked at a few times, however long", "[turning]") {
  constexpr double height = 0.7, half = 0.3, until = 60, rate = 10;
  Solid plane{HalfSpace{Vector3d::UnitZ(), height}, {}}, box{Box{Vector3d(0.5, 0.5, half)}, {}};
  plane.motion.path = {{Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero()}};
  box.motion.path = {{Vector3d(0, 0, next_down(height + half)), Vector3d::Zero(), Vector3d::Zero()}};
  box.motion.angular_velocity = {0, 0, rate};
  REQUIRE(in_contact(plane.body(), box.body(), 0));
  PairMemory memory;
  ContactEstimate next = estimated_first_contact(plane.body(), box.body(), 0, until, ContactMode::resolved, memory);
  int looks = 1;
  for (double last = 0; !next.exact && looks < 100; ++looks) {
    CHECK(next.time > last);
    last = next.time;
    next = certified_first_contact(plane.body(), box.body(), last, until, ContactMode::resolved);
  }
  CHECK(next.exact);
  CHECK(next.time == never);
  CHECK(looks < 20);  // of a quarter of a radian each they would be 2 400
}

}  // namespace test_turning_estimates
