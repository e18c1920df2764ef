// Cubic bodies that fall on fixed ones and rest, slide and strike each other there: nothing sinks in.
#include "tests/collision/parallel/tables.hpp"

#include <catch2/catch.hpp>

#include <cstdint>
#include <initializer_list>

namespace kds::collision::test_rest_audited {
namespace {

using namespace tests;

/// Audits at many times. Returns how many contacts came to rest.
std::uint64_t audit_tables(const TableMotions& motions, std::initializer_list<std::uint64_t> seeds) {
  std::uint64_t held = 0;
  for (const std::uint64_t seed : seeds) {
    const auto scene = TableMaker<3>(seed, motions).scene();
    INFO("seed " << seed << ", curved " << motions.curved << ", moving ground " << motions.moving_ground);
    World<3> world(scene.options);
    scene.fill(world);
    for (int i = 1; i <= 100; ++i) {
      world.advance_to(scene.end_time * i / 100);
      REQUIRE_NOTHROW(world.audit());
    }
    held += world.counters().rebounds_suppressed;
  }
  return held;
}

}  // namespace

TEST_CASE("Curves: a body that joins a cluster does not curve into it, and none meets a wall without end",
          "[splines][resting]") {
  CHECK(audit_tables({.curved = true}, {17, 43, 88, 113, 190}) > 50);
}

TEST_CASE("Curves: what rests on a ground that curves does not sink in", "[splines][resting]") {
  CHECK(audit_tables({.curved = true, .moving_ground = true}, {5, 9, 21, 28, 29, 38}) > 50);
}

TEST_CASE("Curves: a cluster that is carried by one fixed body does not sink into another", "[splines][resting]") {
  CHECK(audit_tables({.moving_ground = true}, {5, 139}) > 10);
}

}  // namespace kds::collision::test_rest_audited
