// Accuracy at any clock, place, speed, size and mass, against exact arithmetic; energy and momentum over many contacts;
// and samplers, which must see nothing that the engine does not know. The benchmarks bench_far, bench_drift and
// bench_accuracy do the same at length (docs/accuracy.md).
#include "tests/benchmarks/accuracy/bounces.hpp"
#include "tests/benchmarks/accuracy/contacts.hpp"
#include "tests/benchmarks/accuracy/encounters.hpp"
#include "tests/benchmarks/accuracy/gas.hpp"
#include "tests/benchmarks/accuracy/mesh_bounds.hpp"
#include "tests/benchmarks/accuracy/samplers.hpp"
#include "tests/collision/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <vector>

namespace test_accuracy {
namespace {

using namespace accuracy;

template <int Degree>
TimeErrors meet(const Setting& setting, int boxes, int pairs) {
  TimeErrors errors;
  for (int seed = 1; seed <= pairs; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    const auto shape = [&](bool box, double size) -> Shape {
      if (!box) return Sphere{size * random.between(0.5, 1)};
      return Box{{size * random.between(0.3, 0.6), size * random.between(0.3, 0.6), size * random.between(0.3, 0.6)}};
    };
    const Shape a = shape(boxes > 0, setting.size_a);
    const Shape b = shape(boxes > 1, setting.size_b);
    compare(encounter<Degree>(random, setting, a, b), setting, errors);
  }
  return errors;
}

TEST_CASE("Times of contact are the first doubles after the exact instants, at any clock, place, speed and size",
          "[accuracy]") {
  for (const Setting& setting : settings()) {
    for (const int boxes : {0, 1, 2}) {
      INFO(setting.name << ", boxes: " << boxes);
      for (const TimeErrors& errors : {meet<1>(setting, boxes, 6), meet<2>(setting, boxes, 3)}) {
        CHECK(errors.contacts >= 2);
        CHECK(errors.wrong == 0);
        CHECK(errors.not_first == 0);
        CHECK(errors.least_ulps >= 0);
        CHECK(errors.most_ulps <= 1);  // below 1, but for the rounding of the quotient
      }
    }
  }
}

TEST_CASE("Contacts of meshes are never late, and early by the contact gap, at any clock, place, speed and size",
          "[accuracy]") {
  const auto cube = kds::collision::samples::cuboid();
  for (const Setting& setting : settings()) {
    INFO(setting.name);
    EarlyContacts straight, curved;
    for (int seed = 1; seed <= 5; ++seed) {
      Random random(static_cast<std::uint64_t>(seed));
      const auto shapes = [&](auto&& e) {
        e.a.orientation = Eigen::Quaterniond(random.between(0.1, 1), 0.6, 0.3, 0.2).normalized();
        e.b.orientation = Eigen::Quaterniond(random.between(0.1, 1), -0.4, 0.1, 0.7).normalized();
        return e;
      };
      const kds::collision::MeshShape a{cube, 0.5 * setting.size_a}, b{cube, 0.6 * setting.size_b};
      compare(shapes(encounter<1>(random, setting, a, b)), setting, straight);
      if (seed <= 2) compare(shapes(encounter<2>(random, setting, a, b)), setting, curved);
    }
    CHECK(straight.contacts >= 2);
    for (const EarlyContacts& errors : {straight, curved}) {
      CHECK(errors.missed == 0);
      CHECK(errors.late == 0);
      // The gap, and what the roundings that it pays for (45 of its 64) may add to it.
      CHECK(errors.most_of_gap < 1 + 45.0 / 64);
      CHECK(errors.most_of_bound < 1 + 45.0 / 64);
    }
  }
}

/// Sums of errors that are random and unbiased stay within 5 standard errors.
template <int Degree>
void check_drift(const char* what, const GasOptions& options, std::uint64_t contacts) {
  INFO(what << ", degree " << Degree << ", seed " << options.seed);
  Gas<Degree> gas(options);
  gas.run_to(contacts);
  const Drift& drift = gas.drift();
  CHECK(gas.world().counters().rebounds_suppressed == 0);
  CHECK(std::abs(drift.energy) < 5 * std::sqrt(drift.energy_square));
  // On parabolas of one acceleration restarts round speeds with a slight bias: some 8 standard errors in 200 000.
  CHECK(drift.momentum.norm() < (Degree == 1 ? 5 : 15) * std::sqrt(drift.momentum_square));
  // 32 roundings of the pair's energy at a contact: see test_impulse.cpp.
  CHECK(drift.worst_energy < 32 * 0x1p-53);
  // All in all: a restart rounds position and velocity of one ball, on parabolas; a wall changes nothing.
  const auto counters = gas.world().counters();
  const Long restarts = static_cast<Long>(counters.motion_updates);
  const Long of_restarts = Degree == 1 ? 0 : 4 * 0x1p-53L * std::sqrt(restarts) / static_cast<Long>(options.balls);
  CHECK(std::abs(drift.all_energy) < 5 * std::sqrt(drift.energy_square) + 5 * of_restarts + 0x1p-60L);
}

TEST_CASE("Energy and momentum of an elastic gas drift as a root of the number of contacts", "[accuracy]") {
  constexpr std::uint64_t contacts = 10'000;
  check_drift<1>("near", {.balls = 32}, contacts);
  check_drift<1>("mass ratio 1e3", {.balls = 32, .mass_ratio = 1e3}, contacts);
  check_drift<1>("mass ratio 1e6", {.balls = 32, .mass_ratio = 1e6}, contacts);
  check_drift<1>("clock 1e9", {.balls = 32, .start_time = 1e9}, contacts);
  check_drift<1>("coordinates 1e8", {.balls = 32, .offset = 1e8}, contacts);
  check_drift<1>("speed 1e-9", {.balls = 32, .speed = 1e-9}, contacts);
  check_drift<1>("speed 1e9", {.balls = 32, .speed = 1e9}, contacts);
  check_drift<2>("gravity", {.balls = 32, .gravity = 1}, contacts);
}

TEST_CASE("Bounces between masses of ratio 100^k count the digits of pi", "[accuracy]") {
  for (const auto& [ratio, digits] : {std::pair(1e2, 31), std::pair(1e4, 314), std::pair(1e6, 3141)}) {
    INFO("mass ratio " << ratio);
    const Bounces found(ratio);
    const auto exact = exact_bounces(ratio);
    REQUIRE(exact.size() == static_cast<std::size_t>(digits));
    REQUIRE(found.times().size() == exact.size());
    CHECK(found.rebounds_suppressed() == 0);
    double worst = 0;
    for (std::size_t i = 0; i < exact.size(); ++i) {
      worst = std::max(worst, std::abs(found.times()[i] - exact[i]) / exact[i]);
    }
    // Each contact rounds speeds by some 2^-53. The last two balls to meet are almost equally fast, some ten times less
    // than the heavy one comes in with, so what has added up there moves the time ten times as much.
    CHECK(worst < 0x1p-53 * 16 * digits);
    const double energy =
        0.5 * (ratio * found.heavy_speed() * found.heavy_speed() + found.light_speed() * found.light_speed());
    CHECK(energy == Approx(0.5 * ratio).epsilon(0x1p-53 * 4 * std::sqrt(digits)));
  }
}

TEMPLATE_TEST_CASE_SIG("Samplers see what the engine knows, and nothing else", "[accuracy]", ((int Degree), Degree), 1,
                       2) {
  using namespace kds::collision;
  namespace samples = kds::collision::tests;
  std::size_t contacts = 0;
  std::size_t found = 0;
  for (const auto shapes : {samples::Shapes::spheres, samples::Shapes::turned_boxes, samples::Shapes::rings}) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      INFO(samples::name(shapes) << ", seed " << seed);
      Random random(seed);
      samples::SceneMaker maker(random, {.shapes = shapes, .bodies = 30, .side = 12, .end_time = 2});
      const auto scene = maker.template scene<Degree>();
      ContactList<Degree> truth;
      World<Degree> world({}, &truth);
      std::vector<PlacedShape> placed;
      std::vector<kds::certificates::PointMotion<Degree>> paths;
      for (const auto& body : scene.bodies) {
        world.add_body(body);
        placed.push_back(place(body.shape, body.orientation));
        paths.push_back(body.motion[0]);
      }
      world.advance_to(scene.end_time);

      PollingSampler<Degree> polling(placed, paths, scene.end_time);
      DiscreteSampler<Degree> discrete(placed, paths);
      std::vector<Report> polled, sampled;
      constexpr int rate = 500;
      for (int k = 1; k <= rate * scene.end_time; ++k) {
        polling.sample(static_cast<double>(k) / rate, polled);
        discrete.sample(static_cast<double>(k) / rate, sampled);
      }
      for (auto* reports : {&polled, &sampled}) {
        std::sort(reports->begin(), reports->end(), [](const Report& x, const Report& y) {
          return std::tie(x.time, x.a, x.b) < std::tie(y.time, y.a, y.b);
        });
      }
      REQUIRE(polled.size() == sampled.size());
      CHECK(std::equal(polled.begin(), polled.end(), sampled.begin(),
                       [](const Report& x, const Report& y) { return x.time == y.time && x.a == y.a && x.b == y.b; }));
      const Errors errors = compare<Degree>(truth.contacts, sampled, placed, paths);
      CHECK(errors.phantom == 0);
      CHECK(errors.time_max <= 1.0 / rate + 1e-9);
      contacts += errors.contacts;
      found += errors.contacts - errors.missed;
    }
  }
  CHECK(contacts > 30);
  CHECK(static_cast<double>(found) > 0.8 * static_cast<double>(contacts));
}

}  // namespace

}  // namespace test_accuracy
