// On curves, too, all broad phases give the same events in the same order, bit for bit, however they are asked.
#include "tests/collision_splines/random_curves.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <cstdint>

namespace kds::collision::test_methods_agree {
namespace {

using namespace tests;

constexpr std::array all_shapes{Shapes::spheres, Shapes::boxes, Shapes::turned_boxes, Shapes::tetrahedra,
                                Shapes::mixture};

std::vector<Event> without_pairs(std::vector<Event> events) {
  std::erase_if(events, is_pair_event);
  return events;
}

void require_equal(const std::vector<Event>& found, const std::vector<Event>& expected) {
  for (std::size_t i = 0; i < std::min(found.size(), expected.size()); ++i) {
    INFO("event " << i);
    REQUIRE(found[i] == expected[i]);
  }
  REQUIRE(found.size() == expected.size());
}

/// Returns how many events there were. The world is audited after each event with the default method.
template <int Degree>
std::size_t compare_methods(const Scene<Degree>& scene, WorldOptions options) {
  options.report_pairs = true;
  options.broad_phase = BroadPhaseKind::all_pairs;
  const auto reference = run(scene, options);
  for (const BroadPhaseKind kind : all_methods) {
    INFO("method " << static_cast<int>(kind));
    options.broad_phase = kind;
    options.rate = 60;
    require_equal(run(scene, options), reference);
  }
  options.report_pairs = false;
  options.broad_phase = BroadPhaseKind::kinetic_sap;
  options.kdop = 14;
  require_equal(run(scene, options), without_pairs(reference));
  options.kdop = WorldOptions{}.kdop;
  options.broad_phase = BroadPhaseKind::automatic;
  options.window = 0.37;
  require_equal(run(scene, options, {.audit = true}), without_pairs(reference));
  return without_pairs(reference).size();
}

template <int Degree>
std::size_t compare_all(SceneOptions scene, const WorldOptions& options, std::uint64_t seeds) {
  std::size_t events = 0;
  for (const Numbers numbers : {Numbers::fine, Numbers::coarse}) {
    for (const Shapes shapes : all_shapes) {
      for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        INFO("degree " << Degree << ", " << name(shapes) << ", " << (numbers == Numbers::fine ? "fine" : "coarse")
                       << " numbers, seed " << seed);
        Random random(seed);
        scene.shapes = shapes;
        scene.numbers = numbers;
        events += compare_methods(curved_scene<Degree>(random, scene), options);
      }
    }
  }
  return events;
}

TEMPLATE_TEST_CASE_SIG("Curves: methods agree where bodies pass through each other", "[splines]",
                       ((int Degree), Degree), 3, 5) {
  CHECK(compare_all<Degree>({.bodies = 10, .side = 5, .scripts = true, .end_time = 2}, {}, 2) > 300);
}

TEMPLATE_TEST_CASE_SIG("Curves: methods agree where bodies bounce between walls", "[splines]", ((int Degree), Degree),
                       3, 5) {
  WorldOptions options;
  options.response = Response::elastic;
  options.walls = Walls{Vector3d::Constant(-2), Vector3d::Constant(7)};
  CHECK(compare_all<Degree>({.bodies = 8, .side = 5, .heterogeneous = true, .end_time = 1.5}, options, 1) > 100);
}

TEST_CASE("Curves: methods agree on quartics", "[splines]") {
  CHECK(compare_all<4>({.bodies = 8, .side = 4, .end_time = 1.5}, {}, 1) > 50);
}

TEST_CASE("Curves: many bodies at once, in the grid and by sorted lists", "[splines]") {
  const std::uint64_t seed = 7;
  CAPTURE(seed);
  Random random(seed);
  const auto scene = curved_scene<3>(random, {.bodies = 300, .side = 16, .end_time = 0.5});
  WorldOptions options;
  options.response = Response::elastic;
  options.broad_phase = BroadPhaseKind::all_pairs;
  const auto reference = run(scene, options);
  CHECK(reference.size() > 50);
  for (const BroadPhaseKind kind : all_methods) {
    INFO("method " << static_cast<int>(kind));
    options.broad_phase = kind;
    options.rate = 100;
    require_equal(run(scene, options), reference);
  }
}

}  // namespace
}  // namespace kds::collision::test_methods_agree
