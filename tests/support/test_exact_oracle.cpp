// The oracle against cases worked out by hand, and against its own plain question at random times.
#include "tests/support/exact_oracle.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

namespace test_exact_oracle {
namespace {

using namespace oracle;

constexpr double infinity = std::numeric_limits<double>::infinity();

using Coefficients = std::vector<std::array<double, 3>>;

Body ball(double radius, Coefficients motion, double start = 0) {
  return {Sphere{radius}, {{start, std::move(motion)}}};
}
Body box(std::array<double, 3> half, Coefficients motion, Matrix orientation = identity()) {
  return {Box{half, orientation}, {{0, std::move(motion)}}};
}
Body cube(Coefficients motion, Matrix orientation = identity()) {
  return box({1, 1, 1}, std::move(motion), orientation);
}

/// One stretch, from `begin` to `end`.
void require_one(const std::vector<Stretch>& found, const Rational& begin, const std::optional<Rational>& end,
                 bool at_start = false) {
  REQUIRE(found.size() == 1);
  CHECK(found[0].begin.compare(begin) == 0);
  CHECK(found[0].at_start == at_start);
  REQUIRE(found[0].end.has_value() == end.has_value());
  if (end) CHECK(found[0].end->compare(*end) == 0);
}

/// One whose ends are irrational: where `increasing`, a function that rises through zero, does so.
void require_root(const Instant& instant, const std::function<Rational(const Rational&)>& increasing) {
  instant.narrow();
  REQUIRE_FALSE(instant.is_rational());
  CHECK(increasing(instant.low()) < 0);
  CHECK(increasing(instant.high()) > 0);
  CHECK((instant.high() - instant.low()) * (Integer(1) << 60) <= abs(instant.high()));
}

}  // namespace

// --- spheres

TEST_CASE("spheres head-on", "[oracle]") {
  const Body a = ball(1, {{0, 0, 0}});
  const Body b = ball(1, {{10, 0, 0}, {-1, 0, 0}});
  require_one(contacts(a, b, 0), 8, Rational(12));
  require_one(contacts(b, a, 0), 8, Rational(12));
  require_one(contacts(a, b, 0, 10), 8, std::nullopt);
  require_one(contacts(a, b, 10), 10, Rational(12), true);
  CHECK(first_contact(a, b, 0)->ceiling() == 8);
  CHECK(gap(a, b, 0) == 8);
  CHECK(gap(a, b, 9) == -1);
}

TEST_CASE("the end of the time looked at belongs to it", "[oracle]") {
  const Body a = ball(1, {{0, 0, 0}});
  const Body b = ball(1, {{10, 0, 0}, {-1, 0, 0}});
  require_one(contacts(a, b, 0, 8), 8, std::nullopt);
  CHECK(contacts(a, b, 0, std::nextafter(8.0, 0.0)).empty());
  require_one(contacts(a, b, 0, 12), 8, Rational(12));
  CHECK(contacts(a, b, 12).empty());
}

TEST_CASE("spheres that graze do not meet, an ulp nearer they do", "[oracle]") {
  const Body a = ball(1, {{0, 0, 0}});
  CHECK(contacts(a, ball(1, {{10, 2, 0}, {-1, 0, 0}}), 0).empty());
  CHECK(contacts(a, ball(1, {{10, std::nextafter(2.0, 3.0), 0}, {-1, 0, 0}}), 0).empty());
  const auto found = contacts(a, ball(1, {{10, std::nextafter(2.0, 0.0), 0}, {-1, 0, 0}}), 0);
  REQUIRE(found.size() == 1);
  // y = 2 - 2^-52, so the half width of the stretch is the root of 4 - y^2 = 2^-50 - 2^-104.
  const Rational y = 2 - Rational(1, Integer(1) << 52);
  require_root(found[0].begin, [&](const Rational& t) { return Rational(4 - y * y - (10 - t) * (10 - t)); });
  CHECK(found[0].begin.compare(10) == -1);
  CHECK(found[0].end->compare(10) == 1);
}

TEST_CASE("a parabola that touches", "[oracle]") {
  const Body a = ball(1, {{0, 0, 0}});
  // y = 2 + (t - 1)^2
  CHECK(contacts(a, ball(1, {{0, 3, 0}, {0, -2, 0}, {0, 1, 0}}), 0).empty());
  // y = 2 - 2^-40 + (t - 1)^2
  const Rational dip(1, Integer(1) << 20);
  require_one(contacts(a, ball(1, {{0, 3 - 0x1p-40, 0}, {0, -2, 0}, {0, 1, 0}}), 0), 1 - dip, 1 + dip);
}

TEST_CASE("a parabola that comes back makes two contacts", "[oracle]") {
  // y = (t - 2)^2 - 3 against a sum of radii of 2: |y| < 2 for 1 < (t - 2)^2 < 5.
  const auto found = contacts(ball(1, {{0, 0, 0}}), ball(1, {{0, 1, 0}, {0, -4, 0}, {0, 1, 0}}), 0);
  REQUIRE(found.size() == 2);
  CHECK(found[0].at_start);
  CHECK(found[0].end->compare(1) == 0);
  CHECK(found[1].begin.compare(3) == 0);
  CHECK_FALSE(found[1].at_start);
  require_root(*found[1].end, [](const Rational& t) { return Rational((t - 2) * (t - 2) - 5); });
}

TEST_CASE("through each other's centre and tangent there is no break", "[oracle]") {
  // |y| = (t - 2)^2 comes to nothing and grows again: one stretch.
  require_one(contacts(ball(0.5, {{0, 0, 0}}), ball(0.5, {{0, 4, 0}, {0, -4, 0}, {0, 1, 0}}), 0), 1, Rational(3));
  // |r|^2 - 4 = (t - 1)^2 ((t - 1)^2 - 4): inside, the gap comes up to zero at t = 1 and falls again. Still one
  // stretch.
  const Body rising = ball(1, {{0, -1, 0}, {0, -2, 0}, {0, 1, 0}});  // y = (t - 1)^2 - 2
  require_one(contacts(ball(1, {{0, 0, 0}}), rising, 0), 0, Rational(3), true);
}

TEST_CASE("starting at a touch", "[oracle]") {
  const Body a = ball(1, {{0, 0, 0}});
  CHECK(contacts(a, ball(1, {{2, 0, 0}}), 0).empty());                                             // at rest
  CHECK(contacts(a, ball(1, {{2, 0, 0}, {1, 0, 0}}), 0).empty());                                  // parting
  CHECK(contacts(a, ball(1, {{2, 0, 0}, {0, 1, 0}}), 0).empty());                                  // sliding by
  require_one(contacts(a, ball(1, {{2, 0, 0}, {-1, 0, 0}}), 0), 0, Rational(4), true);             // meeting
  require_one(contacts(a, ball(1, {{2, 0, 0}, {0, 0, 0}, {-1, 0, 0}}), 0), 0, Rational(2), true);  // drawn together
}

TEST_CASE("bodies that move alike keep their state", "[oracle]") {
  const Coefficients motion{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
  Coefficients beside = motion;
  beside[0][0] += 2;
  require_one(contacts(ball(1, motion), ball(1, motion), 0), 0, std::nullopt, true);
  CHECK(contacts(ball(1, motion), ball(1, beside), 0).empty());
  require_one(contacts(ball(1, motion), ball(std::nextafter(1.0, 2.0), beside), 0), 0, std::nullopt, true);
  // The same path, written about another start: 1 + 4 (t + 1) + 7 (t + 1)^2 = 12 + 18 t + 7 t^2 and so on.
  const Coefficients later{{12, 2 + 5 + 8, 3 + 6 + 9}, {18, 5 + 16, 6 + 18}, {7, 8, 9}};
  Coefficients early = motion;
  early[0][0] += 2;
  CHECK(contacts(ball(1, early, -1), ball(1, later), 0).empty());
}

TEST_CASE("a clock at 1e9 costs no accuracy", "[oracle]") {
  const Body a = ball(1, {{0, 0, 0}}, 1e9);
  const Body b = ball(1, {{10, 0, 0}, {-1, 0, 0}}, 1e9);
  require_one(contacts(a, b, 1e9, 2e9), Rational(1'000'000'008), Rational(1'000'000'012));
}

TEST_CASE("sizes of 1e-6 and 1e6 together", "[oracle]") {
  const auto found = contacts(ball(1e6, {{0, 0, 0}}), ball(1e-6, {{1e6 + 1, 0, 0}, {-1, 0, 0}}), 0, 10);
  require_one(found, 1 - rational(1e-6), std::nullopt);
}

// --- spheres and boxes

TEST_CASE("a sphere meets a face", "[oracle]") {
  require_one(contacts(cube({{0, 0, 0}}), ball(1, {{5, 0.5, 0}, {-1, 0, 0}}), 0), 3, Rational(7));
  require_one(contacts(ball(1, {{5, 0.5, 0}, {-1, 0, 0}}), cube({{0, 0, 0}}), 0), 3, Rational(7));
  CHECK(contacts(cube({{0, 0, 0}}), ball(1, {{5, 2, 0}, {-1, 0, 0}}), 0).empty());  // slides on another face
}

TEST_CASE("a sphere meets an edge", "[oracle]") {
  // The centre goes along x = y, beyond the edge by (4 - t) (1, 1): 2 (4 - t)^2 = 1.
  const auto found = contacts(cube({{0, 0, 0}}), ball(1, {{5, 5, 0}, {-1, -1, 0}}), 0);
  REQUIRE(found.size() == 1);
  require_root(found[0].begin, [](const Rational& t) { return Rational(1 - 2 * (4 - t) * (4 - t)); });
  require_root(*found[0].end, [](const Rational& t) { return Rational(2 * (t - 6) * (t - 6) - 1); });
}

TEST_CASE("a sphere meets a corner", "[oracle]") {
  const auto found = contacts(cube({{0, 0, 0}}), ball(1, {{5, 5, 5}, {-1, -1, -1}}), 0);
  REQUIRE(found.size() == 1);
  require_root(found[0].begin, [](const Rational& t) { return Rational(1 - 3 * (4 - t) * (4 - t)); });
  require_root(*found[0].end, [](const Rational& t) { return Rational(3 * (t - 6) * (t - 6) - 1); });
}

TEST_CASE("a sphere that grazes a corner does not meet it, an ulp larger it does", "[oracle]") {
  // Past the corner (1, 1, 1) at the distance |(2, 2, 1)| = 3, along (1, -1, 0).
  const Coefficients past{{1 + 2 - 8, 1 + 2 + 8, 2}, {1, -1, 0}};
  CHECK(contacts(cube({{0, 0, 0}}), ball(3, past), 0).empty());
  const auto found = contacts(cube({{0, 0, 0}}), ball(std::nextafter(3.0, 4.0), past), 0);
  REQUIRE(found.size() == 1);
  CHECK(found[0].begin.compare(8) == -1);
  CHECK(found[0].end->compare(8) == 1);
}

TEST_CASE("a sphere small beside a box, inside it, and out again", "[oracle]") {
  const Body room = box({10, 10, 10}, {{0, 0, 0}});
  const Body grain = ball(0.125, {{0, 0, 0}, {1, 0, 0}});
  require_one(contacts(room, grain, 0), 0, Rational(81, 8), true);
  CHECK(gap(room, grain, 0) == -10.125);
  CHECK(gap(room, grain, 20) == 9.875);
}

TEST_CASE("a sphere and a turned box", "[oracle]") {
  // cos = 3/5, sin = 4/5, so the edge farthest along x is at (7/5, 1/5), and the face below it has the normal
  // (4/5, -3/5): coming along y = 0 a small ball meets the face, where 4/5 x = 1 + r; along y = 1/5, the edge.
  const Matrix turned = rotation({2, 0, 0, 1});
  CHECK(turned[0] == Vector{Rational(3, 5), Rational(-4, 5), 0});
  CHECK(turned[1] == Vector{Rational(4, 5), Rational(3, 5), 0});
  const auto face = contacts(cube({{0, 0, 0}}, turned), ball(0.25, {{8, 0, 0}, {-1, 0, 0}}), 0);
  REQUIRE(face.size() == 1);
  CHECK(face[0].begin.compare(Rational(103, 16)) == 0);
  const Body high = ball(0.25, {{8, 1, 0}, {-1, 0, 0}});
  const auto edge = contacts(box({1, 1, 1}, {{0, 0.8, 0}}, turned), high, 0);
  REQUIRE(edge.size() == 1);
  // 0.8 is a little more than 4/5, so the ball passes a little below the edge's height.
  const Rational below = rational(0.8) + Rational(1, 5) - 1;
  require_root(edge[0].begin,
               [&](const Rational& t) { return Rational(1, 16) - square(below) - square(8 - t - Rational(7, 5)); });
}

// --- boxes

TEST_CASE("boxes meet face to face, and slide without meeting", "[oracle]") {
  require_one(contacts(cube({{0, 0, 0}}), cube({{6, 0.5, 0}, {-1, 0, 0}}), 0), 4, Rational(8));
  CHECK(contacts(cube({{0, 0, 0}}), cube({{6, 2, 0}, {-1, 0, 0}}), 0).empty());
  require_one(contacts(cube({{0, 0, 0}}), cube({{6, std::nextafter(2.0, 0.0), 0}, {-1, 0, 0}}), 0), 4, Rational(8));
  require_one(contacts(cube({{0, 0, 0}}), cube({{0, 0, 0}}), 0), 0, std::nullopt, true);
}

TEST_CASE("boxes meet corner to corner, edge to edge, and touch there in passing", "[oracle]") {
  require_one(contacts(cube({{0, 0, 0}}), cube({{4, 4, 4}, {-1, -1, -1}}), 0), 2, Rational(6));
  CHECK(contacts(cube({{0, 0, 0}}), cube({{-2, 6, 0}, {1, -1, 0}}), 0).empty());  // along the edge's bisector
  CHECK(contacts(cube({{0, 0, 0}}), cube({{-2, 6, 2}, {1, -1, 0}}), 0).empty());
  CHECK(contacts(cube({{0, 0, 0}}), cube({{0, 3, 0}, {0, -2, 0}, {0, 1, 0}}), 0).empty());  // y = 2 + (t - 1)^2
}

TEST_CASE("turned boxes", "[oracle]") {
  // About z: 7/5 wide along x.
  const Matrix about_z = rotation({2, 0, 0, 1});
  require_one(contacts(cube({{0, 0, 0}}), cube({{10, 0, 0}, {-1, 0, 0}}, about_z), 0), Rational(38, 5),
              Rational(62, 5));
  // One about x, one about y, meeting along z: an edge along x meets an edge along y, which only their product sees.
  const Matrix about_x = rotation({2, 1, 0, 0});
  const Matrix about_y = rotation({2, 0, 1, 0});
  const Body a = cube({{0, 0, 0}}, about_x);
  const Body b = cube({{0, 0, 10}, {0, 0, -1}}, about_y);
  require_one(contacts(a, b, 0), Rational(36, 5), Rational(64, 5));
  CHECK(gap(a, b, Rational(31, 5)) == Approx(1.0));
  // A quaternion that is not normalised means the same.
  const Matrix longer = rotation({6, 0, 0, 3});
  CHECK(longer == about_z);
}

// --- pieces

TEST_CASE("a piece holds until the next one starts", "[oracle]") {
  const Body still = ball(1, {{0, 0, 0}});
  Body stopped{Sphere{1}, {{0, {{10, 0, 0}, {-1, 0, 0}}}, {7.5, {{2.5, 0, 0}}}}};
  CHECK(contacts(still, stopped, 0).empty());
  stopped.motion[1].start = 8;  // stops as it touches
  stopped.motion[1].coefficients[0][0] = 2;
  CHECK(contacts(still, stopped, 0).empty());
  Body bounced{Sphere{1}, {{0, {{10, 0, 0}, {-1, 0, 0}}}, {9, {{1, 0, 0}, {1, 0, 0}}}}};
  require_one(contacts(still, bounced, 0), 8, Rational(10));
  // In contact before and after a seam: one stretch.
  Body onward{Sphere{1}, {{0, {{10, 0, 0}, {-1, 0, 0}}}, {10, {{0, 0, 0}, {0, 2, 0}}}}};
  require_one(contacts(still, onward, 0), 8, Rational(11));
}

TEST_CASE("a jump begins and ends contact at its own time", "[oracle]") {
  const Body still = ball(1, {{0, 0, 0}});
  const Body jumping{Sphere{1}, {{0, {{10, 0, 0}}}, {0.5, {{1, 0, 0}}}, {0.75, {{-9, 0, 0}}}}};
  require_one(contacts(still, jumping, 0), Rational(1, 2), Rational(3, 4));
  require_one(contacts(still, jumping, 0, 0.5), Rational(1, 2), std::nullopt);
  require_one(contacts(still, jumping, 0.625, 0.6875), Rational(5, 8), std::nullopt, true);
}

TEST_CASE("all contacts come in order of time, then of bodies", "[oracle]") {
  const std::vector<Body> bodies{ball(1, {{0, 0, 0}}), ball(1, {{10, 0, 0}, {-1, 0, 0}}), ball(1, {{5, 0, 0}}),
                                 ball(1, {{13, 0, 0}})};
  const auto found = all_contacts(bodies, 0, 8.5);
  REQUIRE(found.size() == 2);
  CHECK((found[0].a == 1 && found[0].b == 2));
  CHECK(found[0].stretch.begin.compare(3) == 0);
  CHECK((found[1].a == 0 && found[1].b == 1));
}

// --- against the plain question

TEST_CASE("at random times the stretches agree with the plain question, and with a swap of the bodies", "[oracle]") {
  const std::uint64_t seed = GENERATE(1, 2, 3);
  CAPTURE(seed);
  std::mt19937_64 random(seed);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
  };
  const auto body = [&]() -> Body {
    Body made{Sphere{uniform(0.5, 1.5)}, {}};
    if (random() % 2) {
      made.shape = Box{{uniform(0.3, 1.5), uniform(0.3, 1.5), uniform(0.3, 1.5)},
                       random() % 3 ? rotation({uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), 1}) : identity()};
    }
    for (int piece = 0; piece < 2; ++piece) {
      Coefficients c{{uniform(-3, 3), uniform(-3, 3), uniform(-3, 3)},
                     {uniform(-3, 3), uniform(-3, 3), uniform(-3, 3)}};
      if (random() % 2) c.push_back({uniform(-2, 2), uniform(-2, 2), uniform(-2, 2)});
      made.motion.push_back({piece == 0 ? uniform(-1, 0) : uniform(0.2, 1.8), std::move(c)});
    }
    return made;
  };
  for (int pair = 0; pair < 12; ++pair) {
    const Body a = body();
    const Body b = body();
    const auto found = contacts(a, b, 0, 2);
    const auto swapped = contacts(b, a, 0, 2);
    REQUIRE(found.size() == swapped.size());
    for (std::size_t i = 0; i < found.size(); ++i) CHECK(found[i].begin == swapped[i].begin);
    for (int i = 0; i < 8; ++i) {
      const Rational t = rational(uniform(0, 2));
      const bool inside = std::any_of(found.begin(), found.end(), [&](const Stretch& s) {
        return s.begin.compare(t) <= 0 && (!s.end || s.end->compare(t) > 0);
      });
      CAPTURE(pair, approximate(t));
      CHECK(inside == (gap(a, b, t) < 0));
      CHECK(inside == !contacts(a, b, approximate(t), approximate(t)).empty());
    }
  }
}

TEST_CASE("two boxes penetrate where a point lies inside both", "[oracle]") {
  const std::uint64_t seed = 11;
  CAPTURE(seed);
  std::mt19937_64 random(seed);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
  };
  const auto distance_to = [](const Box& b, const std::array<double, 3>& centre, const std::array<double, 3>& p) {
    double most = -infinity;  // in the box's axes, beyond its faces
    for (std::size_t i = 0; i < 3; ++i) {
      double along = 0;
      for (std::size_t j = 0; j < 3; ++j) along += approximate(b.orientation[j][i]) * (p[j] - centre[j]);
      most = std::max(most, std::abs(along) - b.half_extents[i]);
    }
    return most;
  };
  int witnessed = 0;
  for (int i = 0; i < 200; ++i) {
    const Box a{{1, 0.5, 1.5}, rotation({uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), 1})};
    const Box b{{0.7, 1.2, 0.4}, rotation({uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), 1})};
    const std::array<double, 3> at{uniform(-2.5, 2.5), uniform(-2, 2), uniform(-2, 2)};
    bool common = false;
    for (int j = 0; j < 400 && !common; ++j) {
      const std::array<double, 3> p{uniform(-1.9, 1.9), uniform(-1.9, 1.9), uniform(-1.9, 1.9)};
      common = distance_to(a, {0, 0, 0}, p) < -1e-9 && distance_to(b, at, p) < -1e-9;
    }
    witnessed += common;
    if (common) CHECK(penetrate(a, b, {rational(at[0]), rational(at[1]), rational(at[2])}));
  }
  CHECK(witnessed > 40);
}

}  // namespace test_exact_oracle
