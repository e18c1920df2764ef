// The classes of which a world is made, without the engine that runs it: edits and queries, and that all parts agree.
#include "collision/world/world_parts.hpp"

#include "collision/world/edits/edits.hpp"
#include "collision/world/membership.hpp"
#include "collision/world/motion_updates.hpp"
#include "collision/world/queries.hpp"
#include "kds/audit.hpp"
#include "tests/collision/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace kds::collision::test_world_parts {
namespace {

using namespace tests;
using Motion = certificates::PointMotion<1>;

/// A world that nobody runs: the clock stands still.
struct Standing {
  explicit Standing(const WorldOptions& options) : parts(options) {}

  /// What the engine does before it looks for the next event.
  void settle() {
    membership.enter_waiting(~std::size_t{0});
    parts.pairs.test();
  }
  std::vector<BodyId> near(const Vector3d& min, const Vector3d& max) const {
    std::vector<BodyId> found;
    queries.visit_overlapping(min, max, [&](BodyId id) { found.push_back(id); });
    return found;
  }

  WorldParts<Motion> parts;
  CallersClock callers;
  Guard guard{parts.volumes.calling()};
  MotionUpdates<Motion> motions{parts};
  Membership<Motion> membership{parts, motions};
  Edits<Motion> edits{parts, motions, membership, guard, callers};
  Queries<Motion> queries{parts, motions, guard, callers};
};

TEST_CASE("WorldParts: bodies enter, move, jump, change their masks and leave, and all parts agree", "[world]") {
  for (const auto& [kind, name, what] : broad_phases) {
    const std::uint64_t seed = 20260101;
    INFO(name << ", seed " << seed);
    WorldOptions options;
    options.broad_phase = kind;
    options.rate = 10;
    Standing world(options);
    Random random(seed);
    const auto place = [&] {  // One by one: the order in which arguments are evaluated is the compiler's choice.
      const double x = random.between(-9, 9), y = random.between(-9, 9), z = random.between(-9, 9);
      return Vector3d(x, y, z);
    };
    std::vector<BodyId> ids;
    std::vector<Vector3d> places;
    for (int round = 0; round < 200; ++round) {
      const std::size_t chosen = ids.empty() ? 0 : random.below(static_cast<std::uint32_t>(ids.size()));
      switch (ids.size() < 10 ? 0 : random.below(4)) {
        case 0:
          places.push_back(place());
          ids.push_back(world.edits.add_body(ball<1>(1, places.back())));
          break;
        case 1: {
          places[chosen] = place();
          const Motion there = motion<1>(places[chosen]);
          world.edits.update_motion(ids[chosen], {&there, 1});
          break;
        }
        case 2:
          world.edits.set_filter(ids[chosen], 1 + random.below(3), random.below(4));
          break;
        default:
          world.edits.remove_body(ids[chosen]);
          ids.erase(ids.begin() + static_cast<std::ptrdiff_t>(chosen));
          places.erase(places.begin() + static_cast<std::ptrdiff_t>(chosen));
      }
      world.settle();
      world.parts.audit(0);
      const Vector3d low = place(), high = low + Vector3d::Constant(4);
      std::vector<BodyId> expected;
      for (std::size_t i = 0; i < ids.size(); ++i) {
        const auto apart = (places[i].array() + 1 < low.array()) || (places[i].array() - 1 > high.array());
        if (!apart.any()) expected.push_back(ids[i]);
      }
      std::sort(expected.begin(), expected.end());
      REQUIRE(world.near(low, high) == expected);
    }
  }
}

TEST_CASE("WorldParts: the audit sees a body whose motion only the bodies know", "[world]") {
  WorldOptions options;
  options.broad_phase = BroadPhaseKind::all_pairs;
  options.walls = Walls{{-9, -9, -9}, {9, 9, 9}};
  Standing world(options);
  const BodyId id = world.edits.add_body(ball<1>(1, {0, 0, 0}, {1, 0, 0}));
  world.settle();
  world.parts.audit(0);
  world.parts.bodies.move(body_slot(id), motion<1>({0, 0, 0}, {4, 0, 0}));
  CHECK_THROWS_AS(world.parts.audit(0), AuditFailure);
  world.motions.set(body_slot(id), motion<1>({0, 0, 0}, {4, 0, 0}), false);
  world.parts.audit(0);
}

TEST_CASE("MotionUpdates: parts learn of a motion after its report, or when the next edit begins", "[world]") {
  WorldOptions options;
  Standing world(options);
  const BodyId id = world.edits.add_body(ball<1>(1, {0, 0, 0}));
  const BodyId other = world.edits.add_body(ball<1>(1, {5, 0, 0}));
  world.settle();
  const auto flies_off = [&](const Vector3d& velocity) {
    world.motions.set_after_report(body_slot(id), motion<1>({0, 0, 0}, velocity));
    CHECK(world.motions.awaiting_report() == body_slot(id));
  };
  flies_off({0, 1, 0});
  world.edits.set_mass(other, 2);
  CHECK(world.motions.awaiting_report() == no_body);
  world.parts.pairs.test();
  world.parts.audit(0);
  flies_off({0, 0, 1});
  world.edits.remove_body(id);  // It need not be told of first.
  CHECK(world.motions.awaiting_report() == no_body);
  CHECK(world.near({-1, -1, -1}, {1, 1, 1}).empty());
}

}  // namespace
}  // namespace kds::collision::test_world_parts
