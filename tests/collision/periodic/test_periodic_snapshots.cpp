// Periodic worlds that are loaded: from bytes that are damaged, or of another box.
#include "collision/periodic/periodic_world.hpp"
#include "kds/audit.hpp"
#include "kds/framework/snapshot.hpp"
#include "tests/collision/periodic/periodic_scenes.hpp"
#include "tests/support/damaged_bytes.hpp"

#include <catch2/catch.hpp>

#include <cstddef>
#include <exception>
#include <stdexcept>
#include <string>
#include <vector>

namespace test_periodic_snapshots {
namespace {

using namespace kds;
using namespace kds::collision;
using Eigen::Vector3d;

/// How far a world that has been loaded from damaged bytes is run.
constexpr int most_steps = 30;
/// One byte of so many is damaged, others by each kind of damage.
constexpr std::size_t every = 4;

PeriodicOptions cube() {
  PeriodicOptions options;
  options.max = Vector3d(4, 4, 4);
  return options;
}

/// Four balls, of which one has been removed, so that a slot is free.
template <int Degree>
void fill(PeriodicWorld<Degree>& world, const PeriodicOptions& options) {
  for (const auto& ball : periodic_scenes::random_balls<Degree>(4, options, 5)) world.add_body(ball);
  world.advance_to(0.75);
  world.remove_body(0);
  world.advance_to(1.5);
}

/// It says what is wrong with it, or runs.
template <int Degree>
void use(PeriodicWorld<Degree>& world) {
  try {
    world.audit();
  } catch (const AuditFailure&) {
  }
  try {
    for (int i = 0; i < most_steps && world.step(world.now() + 1); ++i) {
    }
    save(world);
    if (world.contains(1)) world.remove_body(1);
    world.add_body({.shape = Sphere{0.125}, .motion = {{{Vector3d(0.125, 0.25, 0.375), Vector3d(1, 0, 0)}, 0}}});
    world.advance_to(world.now() + 0.5);
  } catch (const std::exception&) {
  }
}

template <int Degree>
void damage_everywhere(const PeriodicOptions& options) {
  PeriodicWorld<Degree> saved(options);
  fill(saved, options);
  const Snapshot snapshot = save(saved);
  PeriodicWorld<Degree> kept(options);
  restore(snapshot, kept);
  const Snapshot before = save(kept);
  std::size_t refused = 0, accepted = 0, first = 0;
  for (const kds::tests::Damage& damage : kds::tests::all_damages()) {
    for (std::size_t at = first++ % every; at < snapshot.bytes().size(); at += every) {
      const std::vector<char> bytes = damage.of(snapshot.bytes(), at);
      if (bytes == snapshot.bytes()) continue;
      INFO(damage.name << " at byte " << at << " of " << bytes.size());
      PeriodicWorld<Degree> world(options);
      try {
        restore(Snapshot(bytes), world);
      } catch (const std::runtime_error& error) {
        ++refused;
        if (std::string(error.what()).find("snapshot: ") != 0) FAIL(error.what());
        if (refused % 8 != 0) continue;
        CHECK_THROWS_AS(restore(Snapshot(bytes), kept), std::runtime_error);
        CHECK(save(kept) == before);
        continue;
      }
      ++accepted;
      use(world);
    }
  }
  CHECK(refused > 300);
  CHECK(accepted > 300);
}

TEST_CASE("periodic world: damaged snapshots are refused, or give worlds that run", "[periodic][snapshot][damaged]") {
  damage_everywhere<1>(cube());
  PeriodicOptions sheared = cube();
  sheared.shear_rate = 0.5;
  damage_everywhere<2>(sheared);
}

TEST_CASE("periodic world: a snapshot of another box is refused, and changes nothing", "[periodic][snapshot]") {
  PeriodicOptions options = cube();
  options.boundaries[2] = Boundary::walls;
  PeriodicWorld<1> saved(options);
  fill(saved, options);
  const Snapshot snapshot = save(saved);
  PeriodicOptions seeded = options;
  seeded.seed = 2;
  PeriodicWorld<1> same(seeded);
  restore(snapshot, same);
  CHECK(same.now() == saved.now());
  CHECK(same.size() == saved.size());
  same.audit();
  const auto refuses = [&](const std::string& what, auto change) {
    PeriodicOptions changed = options;
    change(changed);
    PeriodicWorld<1> other(changed);
    const Snapshot before = save(other);
    std::string said;
    try {
      restore(snapshot, other);
    } catch (const std::runtime_error& error) {
      said = error.what();
    }
    CHECK(said == "snapshot: it is of a periodic world with other options: " + what);
    CHECK(save(other) == before);
  };
  refuses("min", [](PeriodicOptions& to) { to.min[0] = -1; });
  refuses("max", [](PeriodicOptions& to) { to.max[1] = 5; });
  refuses("boundaries", [](PeriodicOptions& to) { to.boundaries[0] = Boundary::open; });
  refuses("shear_rate", [](PeriodicOptions& to) { to.shear_rate = 1; });
  refuses("wall_temperatures", [](PeriodicOptions& to) { to.wall_temperatures[4] = 1; });
  refuses("elastic_within", [](PeriodicOptions& to) { to.elastic_within = 1; });
}

TEST_CASE("periodic world: bodies that are far beyond an end come back at once, or are refused", "[periodic]") {
  // At the clock 1 doubles are 2^-52 apart, in which such a body goes 2^18 periods, or 2^48.
  for (const double speed : {0x1p72, 0x1p102}) {
    PeriodicOptions options = cube();
    options.world.start_time = 1;
    PeriodicWorld<1> world(options);
    const BodyId id =
        world.add_body({.shape = Sphere{0.5}, .motion = {{{Vector3d(2, 2, 2), Vector3d(speed, 0, 0)}, 1}}});
    if (speed < 0x1p80) {
      world.advance_to(1 + 0x1p-48);
      CHECK(std::abs(world.position(id)[0] - 2) <= 2 + world.lattice().period(0) / 4);
      CHECK(double(world.crossings(id)[0]) == 0x1p22);
    } else {
      CHECK_THROWS_WITH(world.advance_to(1 + 0x1p-48), Catch::Contains("more than 2^31 periods"));
    }
  }
}

}  // namespace
}  // namespace test_periodic_snapshots
