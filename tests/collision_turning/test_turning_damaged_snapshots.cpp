// Snapshots of bodies that turn that have been damaged, everywhere and in several ways: they are refused, or give a
// world that runs.
#include "collision/world.hpp"
#include "kds/framework/snapshot.hpp"
#include "tests/support/damaged_bytes.hpp"

#include <catch2/catch.hpp>

#include <chrono>
#include <cstddef>
#include <exception>
#include <stdexcept>
#include <string>
#include <vector>

namespace test_turning_damaged_snapshots {
namespace {

using namespace kds;
using namespace kds::collision;
using Eigen::Vector3d;

/// How far a damaged world is run: it need not be right, but it must come to an end.
constexpr int most_steps = 20;
/// So long a single damaged snapshot may take, in s.
constexpr double most_seconds = 20;
/// One byte of so many is damaged, others by each kind of damage.
constexpr std::size_t every = 3;

WorldOptions box() {
  WorldOptions options;
  options.response = Response::elastic;
  options.walls = Walls{Vector3d::Constant(-4), Vector3d::Constant(4)};
  return options;
}

/// A ball, a box, which precesses, and a capsule, a top: in flight, or put down to come to rest.
template <int Degree>
void fill(TurningWorld<Degree>& world, bool fall) {
  using Motion = certificates::RigidMotion<Degree>;
  const std::vector<Shape> shapes{Sphere{0.5}, Box{{0.4, 0.5, 0.3}}, Capsule{0.3, 0.4}};
  for (int i = 0; i < 3; ++i) {
    Motion motion;
    motion.path.coefficients[0] = Vector3d(2 * i - 2, 0.1 * i, fall ? -3.4 : 0);
    if (!fall) {
      motion.path.coefficients[1] = Vector3d(1 - i, 0, 0);
      motion.angular_velocity = Vector3d(1, 0.5, 0.25 * i);
    } else if constexpr (Degree == 2) {
      motion.path.coefficients[2] = Vector3d(0, 0, -5);
    }
    world.add_body({.shape = shapes[std::size_t(i)], .motion = {motion}, .restitution = 0.3, .friction = 0.5});
  }
}

template <int Degree>
void use(TurningWorld<Degree>& world) {
  try {
    world.audit();
  } catch (const std::exception&) {
  }
  try {
    for (int i = 0; i < most_steps && world.step(world.now() + 1); ++i) {
    }
    save(world);
    if (world.contains(0)) world.remove_body(0);
    for (int i = 0; i < most_steps && world.step(world.now() + 1); ++i) {
    }
  } catch (const std::exception&) {
  }
}

template <int Degree>
void damage_everywhere(bool fall, double until) {
  using Clock = std::chrono::steady_clock;
  TurningWorld<Degree> saved(box());
  fill(saved, fall);
  saved.advance_to(until);
  const Snapshot snapshot = save(saved);
  std::size_t refused = 0, accepted = 0, first = 0;
  for (const kds::tests::Damage& damage : kds::tests::all_damages()) {
    for (std::size_t at = first++ % every; at < snapshot.bytes().size(); at += every) {
      const std::vector<char> bytes = damage.of(snapshot.bytes(), at);
      if (bytes == snapshot.bytes()) continue;
      INFO(damage.name << " at byte " << at << " of " << bytes.size());
      const auto begun = Clock::now();
      TurningWorld<Degree> world(box());
      try {
        restore(Snapshot(bytes), world);
      } catch (const std::runtime_error& error) {
        ++refused;
        if (std::string(error.what()).find("snapshot: ") != 0) FAIL(error.what());
        continue;
      }
      ++accepted;
      use(world);
      const double seconds = std::chrono::duration<double>(Clock::now() - begun).count();
      if (seconds > most_seconds) FAIL("it took " << seconds << " s");
    }
  }
  CHECK(refused > 300);
  CHECK(accepted > 300);
}

TEST_CASE("damaged: bodies that turn on lines", "[turning][snapshot][damaged]") { damage_everywhere<1>(false, 0.7); }
TEST_CASE("damaged: bodies that turn on parabolas", "[turning][snapshot][damaged]") {
  damage_everywhere<2>(false, 0.7);
}
TEST_CASE("damaged: bodies that turn and come to rest", "[turning][snapshot][damaged]") {
  damage_everywhere<2>(true, 3);
}

}  // namespace
}  // namespace test_turning_damaged_snapshots
