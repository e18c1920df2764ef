#include "io/run.hpp"
#include "io/scene_reader.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace test_run {

using namespace kds::io;

namespace {

/// Counts how often the clock is told of, and ends a run that has no end.
class CountingSink final : public EventSink {
 public:
  void on_time(double time) override {
    if (++count > 10'000) throw std::runtime_error("the clock stands still");
    last = time;
  }

  int count = 0;
  double last = 0;
};

/// Keeps what it is told.
class Record final : public EventSink {
 public:
  void on_event(const Event& event) override { events.push_back(event); }
  void on_motion(std::uint32_t, const MotionPiece& piece) override { pieces.push_back(piece); }

  std::vector<Event> events;
  std::vector<MotionPiece> pieces;
};

/// A rod that turns at 1 rad/s, and a ball at 1.5 from its middle.
Scene rod_and_ball(const std::string& response) {
  return parse_scene(R"({"scene": 1, "end_time": 3, "response": ")" + response + R"(", "bodies": [
    {"name": "rod", "shape": {"box": {"half_extents": [2,0.125,0.125]}}, "inertia": 1.5,
     "motion": [{"start": 0, "position": [[0,0,0]], "angular_velocity": [0,0,1]}]},
    {"name": "ball", "shape": {"sphere": {"radius": 0.25}}, "motion": [{"start": 0, "position": [[0,1.5,0]]}]}]})",
                     "scene.json");
}

Scene one_ball(const std::string& end_time) {
  return parse_scene(R"({"scene": 1, "end_time": )" + end_time + R"(, "bodies": [
    {"name": "a", "shape": {"sphere": {"radius": 1}}, "motion": [{"start": 0, "position": [[0,0,0], [1,0,0]]}]}]})",
                     "scene.json");
}

}  // namespace

TEST_CASE("run: progress is steady, however short the run") {
  const std::string end_time = GENERATE("1e20", "1", "1e-300", "1e-307", "5e-324");
  INFO(end_time);
  CountingSink sink;
  const Scene scene = one_ball(end_time);
  run(scene, {.steady_progress = true}, sink);
  CHECK(sink.last == scene.end_time);
  CHECK(sink.count <= 101);
}

TEST_CASE("run: results are asked for at the rate") {
  CountingSink sink;
  run(one_ball("2"), {.rate = 60}, sink);
  CHECK(sink.last == 2);
  CHECK(sink.count == 120);
}

TEST_CASE("run: a rod that turns meets a ball when the ball is 3/8 from its axis, and leaves it when it is again") {
  const std::string broad_phase = GENERATE("auto", "grid", "kinetic-sap", "sap", "all-pairs");
  INFO(broad_phase);
  Record record;
  run(rod_and_ball("none"), {.broad_phase = broad_phase, .rate = 60}, record);
  REQUIRE(record.events.size() == 2);
  const Event& meeting = record.events[0];
  CHECK(meeting.kind == EventKind::contact);
  CHECK(meeting.time == Approx(std::acos(0.25)).epsilon(1e-15));
  CHECK(meeting.normal.isApprox(Eigen::Vector3d(-std::sqrt(0.9375), 0.25, 0), 1e-14));
  CHECK(to_string(meeting.feature_a) == "f3");
  CHECK(record.events[1].kind == EventKind::separation);
  CHECK(record.events[1].time == Approx(std::acos(-0.25)).epsilon(1e-15));
  CHECK(record.pieces.empty());
}

TEST_CASE("run: a contact of bodies that turn changes paths and angular velocities") {
  Record record;
  const RunResult result = run(rod_and_ball("elastic"), {}, record);
  CHECK(result.contacts == 1);
  REQUIRE(record.pieces.size() == 2);
  const MotionPiece& rod = record.pieces[0];
  const MotionPiece& ball = record.pieces[1];
  CHECK(rod.start() == record.events.at(0).time);
  const Eigen::AngleAxisd turned(rod.start(), Eigen::Vector3d::UnitZ());
  CHECK(rod.orientation.angularDistance(Eigen::Quaterniond(turned)) < 1e-15);
  CHECK(ball.angular_velocity.isZero(0));
  const double energy = 0.5 * (rod.path.coefficients[1].squaredNorm() + ball.path.coefficients[1].squaredNorm()) +
                        0.5 * 1.5 * rod.angular_velocity.squaredNorm();
  CHECK(energy == Approx(0.75).epsilon(1e-15));
}

TEST_CASE("run: where both have friction, a ball that spins is driven on by the floor") {
  const std::string floor =
      GENERATE(R"({"box": {"half_extents": [9,9,1]}})", R"({"half_space": {"normal": [0,0,1], "offset": 1}})");
  INFO(floor);
  Record record;
  const Scene scene = parse_scene(R"({"scene": 1, "end_time": 2, "response": "elastic", "friction": 0.25, "bodies": [
    {"name": "floor", "shape": )" + floor +
                                      R"(, "fixed": true, "motion": [{"start": 0, "position": [[0,0,-1]]}]},
    {"name": "ball", "shape": {"sphere": {"radius": 0.5}},
     "motion": [{"start": 0, "position": [[0,0,1.5], [0,0,-1]], "angular_velocity": [0,8,0]}]}]})",
                                  "scene.json");
  run(scene, {}, record);
  REQUIRE(record.pieces.size() == 2);
  // It slips at 4, more than what friction can stop: 1/4 of the impulse of 2, and the moment is 1/10.
  const MotionPiece& ball = record.pieces[1];
  CHECK((ball.path.coefficients[1] - Eigen::Vector3d(0.5, 0, 1)).norm() < 1e-14);
  CHECK((ball.angular_velocity - Eigen::Vector3d(0, 5.5, 0)).norm() < 1e-13);
}

TEST_CASE("run: a door that turns about its hinge meets a ball") {
  Record record;
  const Scene scene = parse_scene(R"({"scene": 1, "end_time": 2, "response": "elastic", "bodies": [
    {"name": "door", "shape": {"box": {"half_extents": [1,0.0625,1]}}, "fixed": true, "motion": [
      {"start": 0, "position": [[0,0,0]], "angular_velocity": [0,0,1], "pivot": [-1,0,0]}]},
    {"name": "ball", "shape": {"sphere": {"radius": 0.25}}, "motion": [{"start": 0, "position": [[0,1.5,0]]}]}]})",
                                  "scene.json");
  run(scene, {}, record);
  REQUIRE(record.events.size() == 1);
  // The ball's centre is at 1.5 cos t from the middle plane of the door.
  CHECK(record.events[0].time == Approx(std::acos(0.3125 / 1.5)).epsilon(1e-14));
  REQUIRE(record.pieces.size() == 2);
  CHECK((record.pieces[1].path.coefficients[1] - 2 * 1.5 * std::sin(record.events[0].time) * record.events[0].normal)
            .norm() < 1e-14);
}

TEST_CASE("run: a body that precesses tells its pieces, and turns as its inertia says") {
  const auto scene = [](const std::string& inertia) {
    return parse_scene(R"({"scene": 1, "end_time": 3, "response": "elastic", "bodies": [
      {"name": "a", "shape": {"sphere": {"radius": 1}}, "inertia": )" +
                           inertia + R"(, "motion": [
        {"start": 0, "position": [[0,0,0]], "angular_velocity": [1,0,1]}]}]})",
                       "scene.json");
  };
  Record fixed_axis;
  run(scene("[1,1,1]"), {}, fixed_axis);
  CHECK(fixed_axis.pieces.empty());
  Record record;
  const RunResult result = run(scene("[1,1,2]"), {}, record);
  CHECK(record.events.empty());
  CHECK(record.pieces.size() == result.rotation_pieces + 1);
  // The axis of the top goes round the angular momentum, (1, 0, 2), at |L| / I1.
  const double angle = std::sqrt(5.0) * 3;
  const Eigen::Vector3d about = Eigen::Vector3d(1, 0, 2).normalized();
  const Eigen::Vector3d expected = Eigen::AngleAxisd(angle, about) * Eigen::Vector3d::UnitZ();
  const MotionPiece last = record.pieces.back().restarted(3);
  CHECK((last.orientation.normalized() * Eigen::Vector3d::UnitZ() - expected).norm() <= 1e-3);
  Record fine;
  CHECK(run(scene("[1,1,2]"), {.orientation_error = 1e-5}, fine).rotation_pieces > 5 * result.rotation_pieces);
}

TEST_CASE("run: a body that is turned by its script meets what is beside it") {
  Record record;
  const Scene scene = parse_scene(R"({"scene": 1, "end_time": 3, "bodies": [
    {"name": "rod", "shape": {"box": {"half_extents": [2,0.5,0.5]}}, "motion": [
      {"start": 0, "position": [[0,0,0]]},
      {"start": 1, "position": [[0,0,0]], "orientation": [0.7071067811865476,0,0,0.7071067811865476]},
      {"start": 2, "position": [[0,0,0]], "orientation": [1,0,0,0]}]},
    {"name": "ball", "shape": {"sphere": {"radius": 0.5}}, "motion": [{"start": 0, "position": [[0,2,0]]}]}]})",
                                  "scene.json");
  run(scene, {}, record);
  REQUIRE(record.events.size() == 2);
  CHECK(record.events[0].kind == EventKind::contact);
  CHECK(record.events[0].time == 1);
  CHECK(record.events[1].kind == EventKind::separation);
  CHECK(record.events[1].time == 2);
}

}  // namespace test_run
