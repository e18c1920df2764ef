// Balls and boxes that turn: when they meet, against the definition in long doubles.
#include "collision/motions.hpp"
#include "collision/narrow_phase/narrow_phase.hpp"

#include "kds/arithmetic/lattice.hpp"
#include "tests/collision_turning/narrow_phase/turning_oracle.hpp"
#include "tests/collision_turning/narrow_phase/turning_solids.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace test_turning_contact {
namespace {

using namespace kds;
using namespace kds::collision;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using kds::tests::motion_of;
using kds::tests::Random;
using kds::tests::random_vector;
using kds::tests::TurningOracle;

template <int Degree>
using Body = MovingShape<certificates::RigidMotion<Degree>>;

/// What is asked of two bodies that turn.
template <int Degree>
struct Test {
  static double first_contact(const Body<Degree>& a, const Body<Degree>& b, double t0, double horizon,
                              ContactMode mode) {
    return collision::first_contact(a, b, t0, horizon, mode);
  }
  static double apart_until(const Body<Degree>& a, const Body<Degree>& b, double t0, double horizon) {
    PairMemory memory;
    return estimated_first_contact(a, b, t0, horizon, ContactMode::transparent, memory).time;
  }
  static bool in_contact(const Body<Degree>& a, const Body<Degree>& b, double t) {
    return collision::in_contact(a, b, t);
  }
  static double first_separation(const Body<Degree>& a, const Body<Degree>& b, double t0, double horizon) {
    return collision::first_separation(a, b, t0, horizon);
  }
  static Contact contact_at(const Body<Degree>& a, const Body<Degree>& b, double t) {
    return collision::contact_at(a, b, t);
  }
};

template <int Degree>
using Solid = kds::tests::TurningSolid<Degree>;

template <int Degree>
double gap(const Solid<Degree>& a, const Solid<Degree>& b, double t) {
  return static_cast<double>(TurningOracle::gap(a.motion, a.shape, b.motion, b.shape, t));
}

/// What is wrong with the time of a first contact.
struct Verdict {
  bool missed = false;  ///< they overlap before
  bool wrong = false;   ///< they are apart there
  bool unsure = false;  ///< the exact predicate does not say so
};

template <int Degree>
Verdict judge(const Solid<Degree>& a, const Solid<Degree>& b, double t0, double horizon, double contact) {
  Verdict verdict;
  const double scale = a.placed.bounding_radius + b.placed.bounding_radius;
  // Of times, the oracle knows neither more than they have bits.
  const double speed = a.motion.path.velocity(t0).norm() + b.motion.path.velocity(t0).norm() +
                       scale * (a.motion.angular_velocity.norm() + b.motion.angular_velocity.norm());
  const double tolerance = 1e-13 * (scale + a.motion.path.position(t0).norm() + b.motion.path.position(t0).norm()) +
                           1e-15 * speed * (std::abs(t0) + std::abs(horizon));
  const double until = std::min(contact, horizon);
  if (contact == t0) return {false, gap(a, b, t0) > tolerance, !Test<Degree>::in_contact(a.body(), b.body(), t0)};
  const int samples = 400;
  std::vector<double> width;
  for (int i = 0; i <= samples; ++i) width.push_back(gap(a, b, t0 + (until - t0) * i / samples));
  for (int i = 1; i < samples; ++i) {
    const auto k = static_cast<std::size_t>(i);
    verdict.missed = verdict.missed || width[k] < -tolerance;
    if (width[k] > width[k - 1] || width[k] > width[k + 1]) continue;
    double low = t0 + (until - t0) * (i - 1) / samples, high = t0 + (until - t0) * (i + 1) / samples;
    for (int round = 0; round < 60; ++round) {
      const double left = low + (high - low) * 0.382, right = low + (high - low) * 0.618;
      (gap(a, b, left) < gap(a, b, right) ? high : low) = gap(a, b, left) < gap(a, b, right) ? right : left;
    }
    verdict.missed = verdict.missed || gap(a, b, low) < -tolerance;
  }
  if (contact == never) {
    verdict.unsure = Test<Degree>::in_contact(a.body(), b.body(), horizon);
    return verdict;
  }
  verdict.wrong = std::abs(gap(a, b, contact)) > tolerance && contact > t0;
  verdict.unsure = !Test<Degree>::in_contact(a.body(), b.body(), contact) ||
                   (contact > t0 && Test<Degree>::in_contact(a.body(), b.body(), next_down(contact)));
  return verdict;
}

Quaterniond random_orientation(Random& random) {
  switch (random.below(4)) {
    case 0:
      return Quaterniond::Identity();
    case 1:  // a quarter turn
      return Quaterniond(1, 1, 0, 0);
    default:
      return Quaterniond(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
  }
}

/// Two bodies that come near each other at a time of about 1; in some, what they have of spins, axes or sizes is alike.
template <int Degree>
std::array<Solid<Degree>, 2> random_pair(Random& random) {
  const auto shape = [&]() -> Shape {
    if (random.one_in(4)) return Sphere{random.between(0.2, 1)};
    if (random.one_in(4)) return Box{Vector3d(random.between(1, 3), 0.02, 0.05)};  // a rod
    if (random.one_in(4)) return Box{Vector3d(1, 1, 1)};
    return Box{Vector3d(random.between(0.1, 1), random.between(0.1, 1), random.between(0.1, 1))};
  };
  const double rate = std::pow(10.0, random.between(-2, 1.7));
  const auto motion = [&](const Vector3d& meets) {
    const Vector3d velocity = random.one_in(5) ? Vector3d(Vector3d::Zero()) : random_vector(random, 2);
    Vector3d spin = random.one_in(4) ? Vector3d(Vector3d::Zero()) : random_vector(random, rate);
    if (random.one_in(4)) spin = Vector3d::Unit(static_cast<int>(random.below(3))) * rate;
    auto m = motion_of<Degree>(meets - velocity, velocity, spin, random.one_in(2) ? 0 : -random.between(0, 3));
    if constexpr (Degree == 2) m.path.coefficients[2] = random_vector(random, 1);
    m.orientation = random_orientation(random);
    return m;
  };
  Solid<Degree> a{shape(), motion(Vector3d::Zero())};
  const Vector3d beside = random_vector(random, 1.5);
  Solid<Degree> b{shape(), motion(beside)};
  if (random.one_in(6)) b.motion.angular_velocity = a.motion.angular_velocity;
  if (random.one_in(6)) b.motion.orientation = a.motion.orientation;
  if (std::holds_alternative<Sphere>(a.shape) && std::holds_alternative<Sphere>(b.shape)) {
    b = {Box{Vector3d(0.5, 0.6, 0.7)}, b.motion};
  }
  return {a, b};
}

}  // namespace

TEST_CASE("the end of a rod that turns meets the floor at the time of its sine", "[turning]") {
  // The rod's centre is at height 0.5, and its half length 1: corner heights are 0.5 - sin t +- 0.0625 cos t.
  const Solid<1> rod{Box{Vector3d(1, 1, 0.0625)}, motion_of<1>({0, 0, 0.5}, {0, 0, 0}, {0, 1, 0})};
  const Solid<1> floor{Box{Vector3d(4, 4, 1)}, motion_of<1>({0, 0, -1}, {0, 0, 0}, {0, 0, 0})};
  const double length = std::hypot(1.0, 0.0625);
  const double expected = std::asin(0.5 / length) - std::atan2(0.0625, 1.0);
  const double t = Test<1>::first_contact(rod.body(), floor.body(), 0, 10, ContactMode::transparent);
  CHECK(std::abs(t - expected) < 1e-15);
  const Contact contact = Test<1>::contact_at(floor.body(), rod.body(), t);
  CHECK((contact.normal - Vector3d::UnitZ()).norm() < 1e-15);
  CHECK(std::abs(contact.point[0] - length * std::cos(t + std::atan2(0.0625, 1.0))) < 1e-14);
  CHECK(std::abs(contact.point[1]) < 1e-15);
  CHECK(contact.feature_a == Feature::face(5));
  CHECK(contact.feature_b.kind == Feature::Kind::edge);
  const double out = Test<1>::first_separation(rod.body(), floor.body(), t, 10);
  CHECK(std::abs(out - (M_PI - expected)) < 1e-14);  // the other way round: at the same height, coming up
}

TEST_CASE("a ball beside a box that turns is met by its corner, by its edge, by its face", "[turning]") {
  const Solid<1> box{Box{Vector3d(1, 1, 1)}, motion_of<1>({0, 0, 0}, {0, 0, 0}, {0, 0, 1})};
  // The edge is sqrt(2) from the axis, and is there at pi / 4.
  const Solid<1> touched{Sphere{0.25}, motion_of<1>({std::sqrt(2.0) + 0.25 - 0x1p-30, 0, 0}, {0, 0, 0}, {0, 0, 0})};
  const Solid<1> beside{Sphere{0.25}, motion_of<1>({std::sqrt(2.0) + 0.25 + 0x1p-30, 0, 0}, {0, 0, 0}, {0, 0, 0})};
  const double t = Test<1>::first_contact(touched.body(), box.body(), 0, 10, ContactMode::transparent);
  CHECK(std::abs(t - M_PI / 4) < 1e-4);
  CHECK(std::abs(gap(touched, box, t)) < 1e-15);
  CHECK(Test<1>::first_contact(beside.body(), box.body(), 0, 100, ContactMode::transparent) == never);
  // A ball that comes down on the face that turns below it: when does not depend on how it turns.
  const Solid<1> falling{Sphere{0.25}, motion_of<1>({0.5, 0.25, 3}, {0, 0, -1}, {3, 4, 5})};
  CHECK(Test<1>::first_contact(falling.body(), box.body(), 0, 10, ContactMode::transparent) == 1.75);
}

TEST_CASE("boxes that slide on each other and turn alike are not in contact", "[turning]") {
  // Face on face, exactly: nothing penetrates, however they turn about the normal.
  const Solid<1> below{Box{Vector3d(1, 2, 3)}, motion_of<1>({0, 0, 0}, {0, 0, 0}, {0, 0, 0.7})};
  const Solid<1> above{Box{Vector3d(2, 1, 1)}, motion_of<1>({0.125, 0, 4}, {0.25, 0, 0}, {0, 0, -11})};
  CHECK(Test<1>::first_contact(below.body(), above.body(), 0, 50, ContactMode::transparent) == never);
  const Solid<1> alike{Box{Vector3d(2, 1, 1)}, motion_of<1>({0.125, 0, 4}, {0.25, 0, 0}, {0, 0, 0.7})};
  CHECK(Test<1>::first_contact(below.body(), alike.body(), 0, 50, ContactMode::transparent) == never);
  const Solid<1> deeper{Box{Vector3d(2, 1, 1)}, motion_of<1>({0.125, 0, next_down(4)}, {0.25, 0, 0}, {0, 0, 0.7})};
  CHECK(Test<1>::first_contact(below.body(), deeper.body(), 0, 50, ContactMode::transparent) == 0);
  CHECK(Test<1>::first_contact(below.body(), deeper.body(), 0, 5, ContactMode::resolved) == never);
}

TEST_CASE("fast thin rods meet a thin plate wherever they pass it", "[turning]") {
  const std::uint64_t seed = 411;
  CAPTURE(seed);
  Random random(seed);
  for (int round = 0; round < 40; ++round) {
    const double rate = std::pow(10.0, random.between(-2, 2.5));
    Solid<1> rod{Box{Vector3d(1, 0.01, 0.01)}, motion_of<1>({0, 0, 1.5}, {0, 0, -1}, random_vector(random, rate))};
    rod.motion.orientation = random_orientation(random);
    const Solid<1> plate{Box{Vector3d(3, 3, 0.01)}, motion_of<1>({0, 0, 0}, {0, 0, 0}, {0, 0, 0})};
    const double t = Test<1>::first_contact(rod.body(), plate.body(), 0, 2, ContactMode::transparent);
    const Verdict verdict = judge(rod, plate, 0, 2, t);
    CAPTURE(round, rate, t);
    CHECK(t < 2);
    CHECK_FALSE(verdict.missed);
    CHECK_FALSE(verdict.wrong);
    CHECK_FALSE(verdict.unsure);
  }
}

TEMPLATE_TEST_CASE_SIG("bodies that turn meet when the definition says so", "[turning]", ((int Degree), Degree), 1, 2) {
  const std::uint64_t seed = 420 + Degree;
  CAPTURE(Degree, seed);
  Random random(seed);
  int contacts = 0;
  for (int round = 0; round < 300; ++round) {
    const auto [a, b] = random_pair<Degree>(random);
    CAPTURE(round, kind_name(a.shape), kind_name(b.shape));
    const double t = Test<Degree>::first_contact(a.body(), b.body(), 0, 2, ContactMode::transparent);
    contacts += t < never && t > 0;
    const Verdict verdict = judge(a, b, 0, 2, t);
    CHECK_FALSE(verdict.missed);
    CHECK_FALSE(verdict.wrong);
    CHECK_FALSE(verdict.unsure);
    // The same of the bodies in the other order, from later on, and never before what doubles prove.
    CHECK(Test<Degree>::first_contact(b.body(), a.body(), 0, 2, ContactMode::transparent) == t);
    const double later = std::min(t, 2.0) * random.unit();
    CHECK(Test<Degree>::first_contact(a.body(), b.body(), later, 2, ContactMode::transparent) == t);
    CHECK(Test<Degree>::apart_until(a.body(), b.body(), later, 2) <= std::max(t, later));
    if (t == never) continue;
    const double parted = Test<Degree>::first_separation(a.body(), b.body(), t, 4);
    CHECK(parted > t);
    if (parted == never) continue;
    CHECK_FALSE(Test<Degree>::in_contact(a.body(), b.body(), parted));
    CHECK(Test<Degree>::in_contact(a.body(), b.body(), next_down(parted)));
    CHECK(gap(a, b, parted) > -1e-11);
    for (int i = 1; i < 20; ++i) CHECK(gap(a, b, t + (parted - t) * i / 20) < 1e-11);
  }
  CHECK(contacts > 60);
}

}  // namespace test_turning_contact
