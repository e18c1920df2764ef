// All broad phases, asked rarely or often, must give the same events in the same order, bit for bit.
#include "tests/collision/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <cstdint>

namespace kds::collision::test_methods_agree {
namespace {

using namespace tests;

constexpr std::array all_shapes{Shapes::spheres, Shapes::boxes, Shapes::turned_boxes, Shapes::tetrahedra,
                                Shapes::cubes,   Shapes::rings, Shapes::mixture};

/// Everything but the pairs of bounding volumes.
std::vector<Event> contacts(std::vector<Event> events) {
  std::erase_if(events, is_pair_event);
  return events;
}

void require_equal(const std::vector<Event>& found, const std::vector<Event>& expected) {
  for (std::size_t i = 0; i < std::min(found.size(), expected.size()); ++i) {
    INFO("event " << i);
    REQUIRE(found[i] == expected[i]);
  }
  if (found.size() > expected.size()) FAIL("one too many: " << found[expected.size()]);
  if (found.size() < expected.size()) FAIL("one is missing: " << expected[found.size()]);
}

/// What was compared, so that a test knows that it has compared something.
struct Compared {
  std::size_t contacts = 0;
  std::size_t pairs = 0;
};

template <int Degree>
void compare_methods(const Scene<Degree>& scene, WorldOptions options, Compared& compared) {
  options.report_pairs = true;
  options.broad_phase = BroadPhaseKind::kinetic_sap;
  const auto reference = run(scene, options);
  const auto expected = contacts(reference);
  compared.contacts += expected.size();
  compared.pairs += reference.size() - expected.size();
  const auto check = [&](const char* what, const WorldOptions& changed, const Drive& drive = {}) {
    INFO(what);
    require_equal(run(scene, changed, drive), changed.report_pairs ? reference : expected);
  };
  WorldOptions other = options;
  for (const int k : {14, 18, 26}) {
    INFO("k-DOPs, k = " << k);
    other.kdop = k;
    other.report_pairs = false;
    check("kinetic-sap", other);
  }
  other = options;
  other.broad_phase = BroadPhaseKind::all_pairs;
  check("all-pairs", other);
  other.broad_phase = BroadPhaseKind::grid;
  check("grid", other);
  other.broad_phase = BroadPhaseKind::automatic;
  check("auto", other);
  other.broad_phase = BroadPhaseKind::sap;
  for (const double rate : {3.0, 60.0, 1000.0}) {
    INFO("rate " << rate);
    other.rate = rate;
    check("sap", other);
  }
  other.report_pairs = false;
  other.rate = 7;
  check("sap without pairs", other);
}

template <int Degree>
void compare_drives(const Scene<Degree>& scene, WorldOptions options, Compared& compared) {
  options.report_pairs = true;
  const auto reference = run(scene, options);
  compared.contacts += contacts(reference).size();
  for (const double rate : {1.0, 7.0, 64.0, 500.0}) {
    INFO("polled " << rate << " times a second");
    require_equal(run(scene, options, {.polls_per_second = rate}), reference);
  }
  {
    INFO("audit after every step");
    require_equal(run(scene, options, {.audit = true}), reference);
  }
  WorldOptions other = options;
  for (const double window : {0.01, 0.37, 1.0}) {
    INFO("window " << window);
    other.window = window;
    require_equal(run(scene, other), reference);
    require_equal(run(scene, other, {.polls_per_second = 20}), reference);
  }
}

/// Calls f(scene) for many scenes.
template <int Degree, class F>
void for_scenes(const SceneOptions& base, int seeds, F&& f) {
  SceneOptions options = base;
  for (const Numbers numbers : {Numbers::fine, Numbers::coarse}) {
    for (const Shapes shapes : all_shapes) {
      for (int seed = 1; seed <= seeds; ++seed) {
        INFO("degree " << Degree << ", " << name(shapes) << ", " << (numbers == Numbers::fine ? "fine" : "coarse")
                       << " numbers, seed " << seed);
        Random random(static_cast<std::uint64_t>(seed));
        options.shapes = shapes;
        options.numbers = numbers;
        f(SceneMaker(random, options).template scene<Degree>());
      }
    }
  }
}

TEMPLATE_TEST_CASE_SIG("Methods agree where bodies pass through each other", "[methods]", ((int Degree), Degree), 1,
                       2) {
  Compared compared;
  for_scenes<Degree>({.scripts = true}, 12, [&](const Scene<Degree>& scene) { compare_methods(scene, {}, compared); });
  CHECK(compared.contacts > 1000);
  CHECK(compared.pairs > 1000);
}

TEMPLATE_TEST_CASE_SIG("Methods agree where bodies bounce", "[methods]", ((int Degree), Degree), 1, 2) {
  Compared compared;
  for_scenes<Degree>({.heterogeneous = true}, 12, [&](const Scene<Degree>& scene) {
    WorldOptions options;
    options.response = Response::elastic;
    compare_methods(scene, options, compared);
  });
  CHECK(compared.contacts > 500);
}

TEMPLATE_TEST_CASE_SIG("Methods agree where bodies bounce between walls", "[methods]", ((int Degree), Degree), 1, 2) {
  Compared compared;
  for_scenes<Degree>({.bodies = 8}, 6, [&](const Scene<Degree>& scene) {
    WorldOptions options;
    options.response = Response::elastic;
    options.walls = Walls{Vector3d::Constant(-2), Vector3d::Constant(8)};
    compare_methods(scene, options, compared);
  });
  CHECK(compared.contacts > 500);
}

TEMPLATE_TEST_CASE_SIG("It does not matter how often the world is asked, nor how far it looks ahead", "[methods]",
                       ((int Degree), Degree), 1, 2) {
  Compared compared;
  SECTION("passing through") {
    for_scenes<Degree>({.scripts = true}, 2, [&](const Scene<Degree>& scene) { compare_drives(scene, {}, compared); });
  }
  SECTION("bouncing") {
    for_scenes<Degree>({.heterogeneous = true}, 2, [&](const Scene<Degree>& scene) {
      WorldOptions options;
      options.response = Response::elastic;
      options.walls = Walls{Vector3d::Constant(-2), Vector3d::Constant(8)};
      compare_drives(scene, options, compared);
    });
  }
  CHECK(compared.contacts > 100);
}

}  // namespace
}  // namespace kds::collision::test_methods_agree
