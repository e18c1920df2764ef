// The proof of elastic runs on runs worked out by hand, and on what must not pass for one.
#include "tests/support/exact_elastic.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace oracle::test_exact_elastic {
namespace {

using Kind = ElasticEvent::Kind;
using Triple = std::array<double, 3>;

Piece path(const Triple& place, const Triple& speed, double start = 0) { return {start, {place, speed}}; }

ElasticBody ball(double radius, const Triple& place, const Triple& speed) {
  return {Sphere{radius}, path(place, speed), radius};
}

ElasticBody box(const Triple& half, const Triple& place, const Triple& speed) {
  Box shape;
  shape.half_extents = half;
  const double diagonal = std::sqrt(half[0] * half[0] + half[1] * half[1] + half[2] * half[2]) * (1 + 0x1p-45);
  return {shape, path(place, speed), diagonal};
}

/// Ball 1 flies at ball 0, which rests: they meet at t = 1 and exchange their speeds.
ElasticRun two_balls() {
  ElasticRun run;
  run.bodies = {ball(1, {0, 0, 0}, {0, 0, 0}), ball(1, {4, 0, 0}, {-2, 0, 0})};
  run.end = 3;
  run.events = {{Kind::contact, 0, 1, 1, {1, 0, 0}, {path({0, 0, 0}, {-2, 0, 0}, 1), path({2, 0, 0}, {0, 0, 0}, 1)}}};
  return run;
}

bool complains(const ElasticRun& run, const std::string& part) {
  const std::string found = prove(run).complaint;
  INFO("found: " << found);
  CHECK(found.find(part) != std::string::npos);
  return found.find(part) != std::string::npos;
}

TEST_CASE("A right bounce is proved, one that is left out, early or late is not", "[exact_elastic]") {
  CHECK(prove(two_balls()).complaint == "");
  CHECK(prove(two_balls()).grazes == 0);

  ElasticRun missed = two_balls();
  missed.events.clear();
  CHECK(complains(missed, "body 0 meets body 1 at 1, which the log does not have"));
  missed.end = 1;
  CHECK(complains(missed, "body 0 meets body 1 at 1"));
  missed.end = std::nextafter(1.0, 0);
  CHECK(prove(missed).complaint == "");

  ElasticRun early = two_balls();
  early.events[0].time = std::nextafter(1.0, 0);
  for (Piece& piece : early.events[0].motions) piece.start = early.events[0].time;
  CHECK(complains(early, "comes later or never"));
  ElasticRun late = two_balls();
  late.events[0].time = std::nextafter(1.0, 2);
  CHECK(complains(late, "which the log does not have"));
}

TEST_CASE("What an impulse may not do is seen", "[exact_elastic]") {
  const auto after = [](const Piece& a, const Piece& b) {
    ElasticRun run = two_balls();
    run.events[0].motions = {a, b};
    return run;
  };
  CHECK(complains(after(path({0, 0, 0}, {-2, 0, 0}, 1), path({2, 0, 0}, {0x1p-40, 0, 0}, 1)), "part at"));
  CHECK(complains(after(path({0, 0, 0}, {0, 0, 0}, 1), path({2, 0, 0}, {2, 0, 0}, 1)), "momentum"));
  CHECK(complains(after(path({0, 0, 0}, {-2, 1, 0}, 1), path({2, 0, 0}, {0, -1, 0}, 1)), "along the normal"));
  CHECK(complains(after(path({0, 0, 0}, {-2, 0, 0}, 1), path({2.5, 0, 0}, {0, 0, 0}, 1)), "jumps"));
  CHECK(complains(after(path({0, 0, 0}, {-2, 0, 0}, 0), path({2, 0, 0}, {0, 0, 0}, 1)), "begins at"));

  ElasticRun turned = two_balls();
  turned.events[0].normal = {0.6, 0.8, 0};
  CHECK(complains(turned, "separates nothing"));
  turned.events[0].normal = {2, 0, 0};
  CHECK(complains(turned, "no unit vector"));
  ElasticRun lossy = two_balls();
  lossy.bodies[1].restitution = 0.5;
  CHECK(complains(lossy, "part at"));
  lossy.events[0].motions = {path({0, 0, 0}, {-1.5, 0, 0}, 1), path({2, 0, 0}, {-0.5, 0, 0}, 1)};
  CHECK(prove(lossy).complaint == "");
  ElasticRun fixed = two_balls();
  fixed.bodies[0].fixed = true;
  CHECK(complains(fixed, "has changed"));
  fixed.events[0].motions = {path({0, 0, 0}, {0, 0, 0}), path({2, 0, 0}, {2, 0, 0}, 1)};
  CHECK(prove(fixed).complaint == "");
}

TEST_CASE("Masses share an impulse", "[exact_elastic]") {
  // Of speed -2 at mass 3 and rest at mass 1: the common speed is -1.5, so that they go on with -3 and -1.
  ElasticRun run = two_balls();
  run.bodies[1].mass = 3;
  CHECK(complains(run, "momentum"));
  run.events[0].motions = {path({0, 0, 0}, {-3, 0, 0}, 1), path({2, 0, 0}, {-1, 0, 0}, 1)};
  CHECK(prove(run).complaint == "");
}

TEST_CASE("Walls turn the bounding ball back", "[exact_elastic]") {
  ElasticRun run = two_balls();
  run.end = 2.5;
  run.walls = ElasticWalls{{-4, -4, -4}, {6, 4, 4}, 0.5};
  CHECK(complains(run, "body 0 reaches wall 0 at 2.5"));
  run.events.push_back(
      {Kind::wall, 0, 0, 2.5, {-1, 0, 0}, {path({-3, 0, 0}, {1, 0, 0}, 2.5), run.events[0].motions[1]}});
  CHECK(prove(run).complaint == "");
  run.events[1].motions[0].coefficients[1] = {2, 0, 0};
  CHECK(complains(run, "from wall 0"));
  run.events[1].motions[0].coefficients[1] = {1, 0.5, 0};
  CHECK(complains(run, "from wall 0"));
}

TEST_CASE("Boxes meet at a face, and may slide along one another", "[exact_elastic]") {
  ElasticRun run;
  run.bodies = {box({1, 1, 1}, {0, 0, 0}, {0, 0, 0}), box({0.5, 1, 2}, {3, 1, 0}, {-3, 0, 0})};
  run.end = 1;
  CHECK(complains(run, "body 0 meets body 1 at 0.5"));
  run.events = {
      {Kind::contact, 0, 1, 0.5, {1, 0, 0}, {path({0, 0, 0}, {-3, 0, 0}, 0.5), path({1.5, 1, 0}, {0, 0, 0}, 0.5)}}};
  CHECK(prove(run).complaint == "");
  run.bodies[1].motion = path({3, 2, 0}, {-3, 0, 0});
  run.events.clear();
  CHECK(prove(run).complaint == "");
  run.bodies[1].motion = path({3, 2 - 0x1p-40, 0}, {-3, 0, 0});
  CHECK(complains(run, "body 0 meets body 1 at 0.5"));
  // In it by a rounding, it may slide over it, and it may be turned back at the edge.
  run.bodies[1].motion = path({3, 2 - 0x1p-52, 0}, {-3, 0, 0});
  CHECK(prove(run).complaint == "");
  CHECK(prove(run).grazes == 1);
}

TEST_CASE("A ball meets the face, the edge and the corner of a box", "[exact_elastic]") {
  ElasticRun run;
  run.end = 3;
  run.bodies = {box({1, 1, 1}, {0, 0, 0}, {0, 0, 0}), ball(1, {4, 0, 0}, {-1, 0, 0})};
  CHECK(complains(run, "body 0 meets body 1 at 2,"));
  // With the centre 3/5 above the edge, 4/5 are left of the radius of 1; 1/3 and 2/3 above a corner, 2/3.
  run.bodies[1].motion = path({4, 1.5, 0}, {-1, 0, 0});
  run.bodies[1].shape = Sphere{0.625};
  run.bodies[1].bounding_radius = 0.625;
  CHECK(complains(run, "body 0 meets body 1 at 2.625,"));
  run.bodies[1].motion = path({4, 1.25, 1.5}, {-1, 0, 0});
  run.bodies[1].shape = Sphere{0.75};
  run.bodies[1].bounding_radius = 0.75;
  CHECK(complains(run, "body 0 meets body 1 at 2.5,"));
  run.bodies[1].motion = path({4, 1.625, 1.625}, {-1, 0, 0});
  CHECK(prove(run).complaint == "");
}

TEST_CASE("An overlap at the start is told, passes, and counts again once they have been apart", "[exact_elastic]") {
  // Ball 1 leaves ball 0 at t = 1.5, is at the wall at 2.5, and back at 3.5.
  ElasticRun run;
  run.bodies = {ball(1, {0, 0, 0}, {0, 0, 0}), ball(1, {0.5, 0, 0}, {1, 0, 0})};
  run.bodies[0].fixed = true;
  run.walls = ElasticWalls{{-4, -4, -4}, {4, 4, 4}};
  const Piece resting = run.bodies[0].motion;
  run.end = 3;
  CHECK(complains(run, "overlap at the start, which is not told"));
  run.events = {{Kind::overlap, 0, 1, 0, {1, 0, 0}, {resting, run.bodies[1].motion}},
                {Kind::wall, 1, 1, 2.5, {1, 0, 0}, {resting, path({3, 0, 0}, {-1, 0, 0}, 2.5)}}};
  CHECK(prove(run).complaint == "");
  run.end = 3.5;
  CHECK(complains(run, "body 0 meets body 1 at 3.5"));
  run.events.push_back({Kind::contact, 0, 1, 3.5, {1, 0, 0}, {resting, path({2, 0, 0}, {1, 0, 0}, 3.5)}});
  CHECK(prove(run).complaint == "");

  // With the wall so near that they never part, ball 1 goes through ball 0, and out on its other side.
  run.walls->max[0] = 2;
  run.end = 3.5;
  run.events.resize(1);
  run.events.push_back({Kind::wall, 1, 1, 0.5, {1, 0, 0}, {resting, path({1, 0, 0}, {-1, 0, 0}, 0.5)}});
  CHECK(prove(run).complaint == "");

  ElasticRun apart = two_balls();
  apart.events.insert(apart.events.begin(),
                      {Kind::overlap, 0, 1, 0, {1, 0, 0}, {apart.bodies[0].motion, apart.bodies[1].motion}});
  CHECK(complains(apart, "that is none"));
}

TEST_CASE("Events at one time are in the order of walls, then of pairs, and bodies without a part go on",
          "[exact_elastic]") {
  ElasticRun run = two_balls();
  run.bodies.push_back(ball(1, {0, 8, 0}, {0, 0, 0}));
  run.bodies.push_back(ball(1, {4, 8, 0}, {-2, 0, 0}));
  const Piece moved_0 = path({0, 0, 0}, {-2, 0, 0}, 1), moved_1 = path({2, 0, 0}, {0, 0, 0}, 1);
  const Piece moved_2 = path({0, 8, 0}, {-2, 0, 0}, 1), moved_3 = path({2, 8, 0}, {0, 0, 0}, 1);
  const Piece& old_0 = run.bodies[0].motion;
  const Piece& old_1 = run.bodies[1].motion;
  const Piece& old_2 = run.bodies[2].motion;
  const Piece& old_3 = run.bodies[3].motion;
  const std::vector<Piece> both{moved_0, moved_1, moved_2, moved_3};
  run.events = {{Kind::contact, 0, 1, 1, {1, 0, 0}, {moved_0, moved_1, old_2, old_3}},
                {Kind::contact, 2, 3, 1, {1, 0, 0}, both}};
  CHECK(prove(run).complaint == "");
  run.events[0].motions = both;
  CHECK(complains(run, "has no part"));
  run.events = {{Kind::contact, 2, 3, 1, {1, 0, 0}, {old_0, old_1, moved_2, moved_3}},
                {Kind::contact, 0, 1, 1, {1, 0, 0}, both}};
  CHECK(complains(run, "body 0 meets body 1 at 1, which the log does not have"));
  run.events.resize(1);
  run.events[0] = {Kind::contact, 0, 1, 1, {1, 0, 0}, {moved_0, moved_1, old_2, old_3}};
  CHECK(complains(run, "body 2 meets body 3 at 1"));
  run.end = 1;
  run.cut = true;
  CHECK(prove(run).complaint == "");
}

TEST_CASE("Two fixed bodies meet once and pass", "[exact_elastic]") {
  ElasticRun run = two_balls();
  run.bodies[0].fixed = run.bodies[1].fixed = true;
  run.end = 10;
  run.events[0].motions = {run.bodies[0].motion, run.bodies[1].motion};
  CHECK(prove(run).complaint == "");
  run.events.clear();
  CHECK(complains(run, "body 0 meets body 1 at 1"));
}

Piece parabola(const Triple& place, const Triple& speed, const Triple& bend, double start = 0) {
  return {start, {place, speed, bend}};
}

TEST_CASE("Bodies that fall meet where their parabolas do, also after they have left what they overlapped",
          "[exact_elastic]") {
  // Thrown up out of the floor, z = 1 + (t - 1/4) (17/4 - t): apart from t = 1/4 on, back at 17/4.
  ElasticRun run;
  run.bodies = {box({4, 4, 1}, {0, 0, -1}, {0, 0, 0}), box({1, 1, 1}, {0, 0, 0}, {0, 0, 0})};
  run.bodies[0].fixed = true;
  run.bodies[0].motion = parabola({0, 0, -1}, {0, 0, 0}, {0, 0, 0});
  run.bodies[1].motion = parabola({0, 0, -0.0625}, {0, 0, 4.5}, {0, 0, -1});
  run.end = 4.5;
  run.events = {{Kind::overlap, 0, 1, 0, {0, 0, 1}, {run.bodies[0].motion, run.bodies[1].motion}}};
  CHECK(complains(run, "body 0 meets body 1 at 4.25"));
  run.events.push_back(
      {Kind::contact, 0, 1, 4.25, {0, 0, 1}, {run.bodies[0].motion, parabola({0, 0, 1}, {0, 0, 4}, {0, 0, -1}, 4.25)}});
  CHECK(prove(run).complaint == "");
  run.events[1].motions[1].coefficients[1][2] = 3;
  CHECK(complains(run, "part at"));
  run.events[1].motions[1].coefficients[1][2] = 4;
  run.events[1].motions[1].coefficients[2][2] = 0;
  CHECK(complains(run, "acceleration"));
  run.events[1].motions[1].coefficients[2][2] = -1;
  // The top is at z = 5 at t = 9/4: a ceiling at 7 is not reached by the ball around it, one at 6.5 is.
  run.walls = ElasticWalls{{-8, -8, -8}, {8, 8, 7}};
  CHECK(prove(run).complaint == "");
  run.walls->max[2] = 6.5;
  CHECK(complains(run, "body 1 reaches wall 5 at 1.7"));
}

TEST_CASE("Balls whose parabolas touch do not meet, those that come nearer do", "[exact_elastic]") {
  ElasticRun run;
  run.bodies = {ball(1, {0, 0, 0}, {0, 0, 0}), ball(1, {0, 0, 3}, {0, 0, 0})};
  run.bodies[0].motion = parabola({0, 0, 0}, {0, 0, 0}, {0, 0, 0});
  run.bodies[1].motion = parabola({0, 0, 3}, {0, 0, -2}, {0, 0, 1});  // 2 + (t - 1)^2
  run.end = 3;
  CHECK(prove(run).complaint == "");
  run.bodies[1].motion.coefficients[0][2] = 3 - 0x1p-20;  // first at t = 1 - 2^-10
  CHECK(complains(run, "body 0 meets body 1 at 0.9990234375"));
}

}  // namespace
}  // namespace oracle::test_exact_elastic
