// Snapshots of bodies that turn that have been damaged, everywhere and in several ways, and scenes in parts: they are
// refused, or give a world that runs.
#include "collision/parallel/parallel_world.hpp"
#include "collision/parallel/saved_bodies.hpp"
#include "collision/world.hpp"
#include "kds/framework/snapshot.hpp"
#include "tests/collision/parallel/states_in_parts.hpp"
#include "tests/collision_turning/rest_scenes.hpp"
#include "tests/support/damaged_bytes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
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
constexpr std::size_t every = 5;
constexpr std::size_t every_in_parts = 23;  ///< of which each makes domains

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

/// Two stacks of crates far from each other, in two domains, saved in parts: the one rests, the other is about to.
struct Stacks {
  WorldOptions options{.response = Response::elastic};
  ParallelOptions parallel{.threads = 1, .domains = 2, .halo = 0.5};

  Stacks() { options.shortest_flight = 0.02; }
  static void fill(TurningWorld<2>& world) {
    for (const double x : {0.0, 12.0}) {
      for (int k = 0; k < 2; ++k)
        world.add_body(kds::tests::rest::body(Box{{0.5, 0.5, 0.5}}, {x, 0, 0.5 + k + 0.05 * x}));
    }
    world.add_body(kds::tests::rest::ground());
  }
  collision::tests::StateInParts saved(double until) const {
    collision::tests::StateInParts state(1);
    ParallelTurningWorld<2> divided(options, parallel);
    fill(divided.whole());
    divided.advance_to(until);
    REQUIRE(divided.domains() == 2);
    state.save(divided, 0, 2);
    return state;
  }
  /// Of a state that is loaded by several processes; nothing if it is not refused.
  std::string refusal(const Snapshot& rest, const std::vector<std::vector<char>>& blocks, std::size_t processes) const {
    std::vector<std::string> said(processes);
    collision::tests::run_by(processes, [&](Processes* others, std::size_t rank) {
      ParallelTurningWorld<2> world(options, parallel, nullptr, others);
      try {
        world.load_parts(rest, collision::tests::share_of(blocks, rank, processes));
      } catch (const std::runtime_error& error) {
        said[rank] = error.what();
        if (world.size() != 0) throw std::logic_error("it is changed");
        return;
      }
      use(world.whole());
    });
    return said.front();
  }
};

TEST_CASE("damaged: parts of a scene in which bodies that turn rest on each other", "[turning][parallel][damaged]") {
  const Stacks stacks;
  const auto state = stacks.saved(0.4);
  const auto blocks = state.blocks();
  REQUIRE(stacks.refusal(state.rest, blocks, 1).empty());
  std::size_t refused = 0, accepted = 0, first = 0;
  for (const kds::tests::Damage& damage : kds::tests::all_damages()) {
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      for (std::size_t at = first++ % every_in_parts; at < blocks[i].size(); at += every_in_parts) {
        INFO(damage.name << " at byte " << at << " of block " << i);
        auto wrong = blocks;
        wrong[i] = damage.of(blocks[i], at);
        const std::string said = stacks.refusal(state.rest, wrong, 1);
        said.empty() ? ++accepted : ++refused;
        if (!said.empty() && said.find("snapshot: ") != 0) FAIL(said);
      }
    }
  }
  CHECK(refused > 100);
  CHECK(accepted > 100);
}

TEST_CASE("damaged: a body that turns and rests on one that does not rest on it is refused", "[turning][parallel]") {
  const Stacks stacks;
  const auto state = stacks.saved(0.4);
  const auto blocks = state.blocks();
  std::size_t links = 0;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    SavedBodies<certificates::RigidMotion<2>> saved;
    kds::detail::Reader reader(blocks[i]);
    reader(saved);
    for (std::size_t k = 0; k < saved.parcel.resting.size(); ++k) {
      const auto* const resting = saved.parcel.resting[k].state();
      if (!resting || resting->links.size() < 2) continue;  // It lies on the ground alone.
      ++links;
      for (const bool forgets_all : {true, false}) {
        auto other = saved;
        auto changed = *resting;
        for (auto& link : changed.links) link.pair.rests = !link.pair.rests;
        changed.rests = changed.links.front().pair.rests;
        other.parcel.resting[k] = forgets_all ? TurningRestProgress() : TurningRestProgress(changed);
        kds::detail::Writer writer;
        writer(other);
        auto wrong = blocks;
        wrong[i] = writer.take();
        for (const std::size_t processes : {1u, 3u}) {
          CHECK(stacks.refusal(state.rest, wrong, processes) ==
                "snapshot: a body rests on one that is not there, or does not rest on it");
        }
      }
    }
  }
  CHECK(links > 0);
  for (const std::size_t processes : {1u, 3u}) CHECK(stacks.refusal(state.rest, blocks, processes).empty());
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
