// Replays of periodic worlds.
#include "io/periodic_recorder.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace test_periodic_recorder {
namespace {

using namespace kds::collision;
using Eigen::Vector3d;
using kds::io::PeriodicRecorder;
using nlohmann::json;

/// Where the page draws a body at t, by its data.
Vector3d drawn_at(const json& body, double t) {
  std::vector<double> piece;
  for (const auto& each : body["motion"]) {
    if (each[0].get<double>() <= t) piece = each.get<std::vector<double>>();
  }
  Vector3d x = Vector3d::Zero();
  for (std::size_t k = (piece.size() - 1) / 3; k-- > 0;) {
    x = x * (t - piece[0]) + Vector3d(piece[1 + 3 * k], piece[2 + 3 * k], piece[3 + 3 * k]);
  }
  return x;
}

TEST_CASE("periodic recorder: a body leaves the box at one end and comes in at the other") {
  struct Told final : PeriodicListener<1> {
    int wraps = 0;
    void wrapped(PeriodicWorld<1>&, BodyId, const Offset&) override { ++wraps; }
  } told;
  PeriodicOptions options;
  options.min = {0, 0, 0};
  options.max = {8, 8, 8};
  options.world.start_time = 1;
  PeriodicRecorder<1> recorder(options, &told);
  PeriodicWorld<1> world(options, &recorder);
  using Motion = PeriodicWorld<1>::Motion;
  world.add_body({.shape = Sphere{1}, .motion = {Motion::line({2, 4, 4}, {2, 0, 0}, 1)}});
  world.add_body({.shape = Sphere{0.5}, .motion = {Motion::line({4, 1, 4}, {0, 0, 0}, 1)}});
  recorder.look(world);
  world.advance_to(6);
  const json data = json::parse(recorder.to_json(world, "box"));
  CHECK(told.wraps == 1);
  CHECK(data["domain"]["walls"] == false);
  REQUIRE(data["bodies"].size() == 2);  // and no images
  CHECK(data["bodies"][0]["motion"].size() == 2);
  for (const auto& [t, x] : {std::pair(0.0, 2.0), {2.5, 7.0}, {5.0, 4.0}}) {
    CHECK((drawn_at(data["bodies"][0], t) - Vector3d(x, 4, 4)).norm() < 1e-6);
  }
}

template <int Degree>
void compare(std::uint64_t seed, double shear_rate) {
  INFO("seed " << seed);
  std::mt19937_64 random(seed);
  const auto uniform = [&](double low, double high) { return low + (high - low) * double(random() >> 11) * 0x1p-53; };
  PeriodicOptions options;
  options.max = {9, 9, 9};
  options.shear_rate = shear_rate;
  PeriodicRecorder<Degree> recorder(options);
  PeriodicWorld<Degree> world(options, &recorder);
  for (int i = 0; i < 27; ++i) {
    const Vector3d at = 3 * Vector3d(i % 3, i / 3 % 3, i / 9) + Vector3d::Constant(1.5);
    BodyDescription<Degree> body{.shape = Sphere{uniform(0.3, 1.2)}};
    body.motion = {{{at, Vector3d(uniform(-3, 3), uniform(-3, 3), uniform(-3, 3))}}};
    world.add_body(body);
  }
  recorder.look(world);
  std::vector<std::vector<Vector3d>> places;
  std::vector<BodyId> there;
  for (BodyId id = 0; id < 27; ++id) there.push_back(id);
  for (int k = 1; k <= 40; ++k) {
    world.advance_to(0.1 * k);
    places.emplace_back();
    for (const BodyId id : there) places.back().push_back(world.position(id));
  }
  const json data = json::parse(recorder.to_json(world, "gas"));
  REQUIRE(data["bodies"].size() == 27);
  CHECK(data["touches"].size() == world.counters().contacts);
  CHECK(data["touches"].size() > 20);
  CHECK(world.counters().wraps > 20);
  std::vector<std::size_t> of_place(27);
  for (std::size_t i = 0; i < 27; ++i) {
    of_place[i] = std::stoul(data["bodies"][i]["name"].get<std::string>().substr(5));
  }
  for (std::size_t k = 0; k < places.size(); ++k) {
    for (std::size_t i = 0; i < 27; ++i) {
      const Vector3d drawn = drawn_at(data["bodies"][i], 0.1 * double(k + 1));
      CHECK((drawn - places[k][of_place[i]]).norm() < 0.01);  // a thousandth of its size, and digits of a float
    }
  }
}

TEST_CASE("periodic recorder: all bodies are where the world has them, at all times") {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    compare<1>(seed, 0);
    compare<1>(seed, 0.5);
    compare<2>(seed, 0);
  }
}

}  // namespace
}  // namespace test_periodic_recorder
