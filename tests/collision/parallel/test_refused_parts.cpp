// States in parts that are wrong are refused; those that are right, also the states of worlds, have all there is to
// have.
#include "collision/parallel/parallel_world.hpp"
#include "kds/framework/snapshot.hpp"
#include "tests/collision/parallel/parallel_log.hpp"
#include "tests/collision/parallel/states_in_parts.hpp"
#include "tests/collision/parallel/thread_processes.hpp"
#include "tests/collision/random_scenes.hpp"
#include "tests/support/damaged_bytes.hpp"
#include "tests/support/throws.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace kds::collision::test_refused_parts {
namespace {

using Eigen::Vector3d;
using tests::Event;
using tests::ParallelLog;
using tests::run_by;
using tests::share_of;
using tests::StateInParts;
using tests::ThreadProcesses;
using Log = tests::WholeLog<certificates::PointMotion<1>>;
using Blocks = std::vector<std::vector<char>>;

/// A scene of all that is divided, at 0.5: sensors that are attached, ignored pairs, scripts, bodies that enter later,
/// free slots, a timer.
struct Mixed {
  WorldOptions options = tests::with_response(Response::elastic);
  std::function<void(World<1>&)> fill = [](World<1>& world) {
    for (int i = 0; i < 12; ++i) {
      auto ball = tests::ball<1>(0.4, Vector3d(i, 0.1 * i, 0), Vector3d(i % 2 == 0 ? 1 : -1, 0, 0));
      if (i == 4) ball.motion.push_back(tests::motion<1>(Vector3d(4, 2, 0), Vector3d(0, -1, 0), Vector3d::Zero(), 1.5));
      if (i == 5) ball.motion.front().start = 1;
      if (i == 6) ball.shape = Box{{0.3, 0.4, 0.5}};
      if (i == 7) ball.sensor = true;
      world.add_body(ball);
    }
    for (const BodyId owner : {2u, 3u}) {
      BodyDescription<1> sensor{.shape = Sphere{0.8}, .sensor = true, .attached_to = owner};
      world.add_body(sensor);
    }
    world.ignore_pair(1, 2);
    world.ignore_pair(8, 9);
    world.remove_body(11);
    world.set_timer(0.75);
  };

  StateInParts saved(std::size_t count, std::size_t in_block) const {
    StateInParts state(count);
    run_by(count, [&](Processes* processes, std::size_t rank) {
      ParallelWorld<1> divided(options, {.threads = 1, .domains = 3, .halo = 0.5}, nullptr, processes);
      fill(divided.whole());
      divided.advance_to(0.5);
      if (divided.domains() != 3) throw std::runtime_error("it is not divided");
      state.save(divided, rank, in_block);
    });
    return state;
  }
};

/// A world that is to load; afterwards it must be as it was.
template <class Load>
std::string refusal(const Mixed& mixed, std::size_t count, const Load& load) {
  std::vector<std::string> messages(count);
  run_by(count, [&](Processes* processes, std::size_t rank) {
    ParallelWorld<1> world(mixed.options, {.threads = 1, .domains = 2, .halo = 0.5}, nullptr, processes);
    for (int i = 0; i < 4; ++i) world.add_body(tests::ball<1>(0.5, Vector3d(3 * i, 0, 0)));
    world.advance_to(0.25);
    try {
      load(world, rank);
    } catch (const std::runtime_error& error) {
      messages[rank] = error.what();
    }
    if (messages[rank].empty()) return;
    if (world.size() != 4 || world.now() != 0.25) throw std::logic_error("it is changed");
    world.advance_to(0.5);
    world.whole().audit();
  });
  const auto own = std::find_if(messages.begin(), messages.end(), [](const std::string& what) {
    return !what.empty() && what.find("another process") == std::string::npos;
  });
  const bool some = own != messages.end();
  for (const std::string& what : messages) CHECK(what.empty() != some);  // all refuse, or none
  return some ? *own : "";
}

}  // namespace

TEST_CASE("Saved parts: what is missing, there twice, or of another state is refused by all", "[parallel]") {
  const Mixed mixed;
  const StateInParts state = mixed.saved(2, 4);
  const Blocks blocks = state.blocks();
  REQUIRE(blocks.size() >= 4);
  for (const std::size_t count : {1u, 3u}) {
    const auto refusal_of = [&](const Snapshot& rest, const Blocks& given) {
      return refusal(mixed, count, [&](ParallelWorld<1>& world, std::size_t rank) {
        world.load_parts(rest, share_of(given, rank, count));
      });
    };
    CHECK(refusal_of(state.rest, blocks).empty());
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      Blocks wrong = blocks;
      wrong.erase(wrong.begin() + static_cast<std::ptrdiff_t>(i));
      const std::string what = refusal_of(state.rest, wrong);
      CHECK((what == "snapshot: the parts have not the bodies of the scene" ||
             (count == 1 && what == "snapshot: a pair overlaps of which a body is missing")));
      wrong = blocks;
      wrong.push_back(blocks[i]);
      CHECK_FALSE(refusal_of(state.rest, wrong).empty());
      wrong = blocks;
      wrong[i].pop_back();
      CHECK(refusal_of(state.rest, wrong) == "snapshot: it ends before its time");
      wrong = blocks;
      wrong[i].push_back(0);
      CHECK(refusal_of(state.rest, wrong) == "snapshot: there is more in a part than bodies");
    }
    Mixed other = mixed;
    other.options.walls = Walls{Vector3d::Constant(-100), Vector3d::Constant(100)};
    CHECK(refusal_of(other.saved(2, 4).rest, blocks) == "snapshot: it is of a world with other options: walls");
    const std::string thrown = refusal(mixed, count, [&](ParallelWorld<1>& world, std::size_t rank) {
      world.load_parts(state.rest, [&](std::vector<char>&) -> bool {
        if (rank == count - 1) throw std::runtime_error("cannot be read");
        return false;
      });
    });
    CHECK(thrown == "cannot be read");
  }
  World<1> alone(mixed.options);
  kds::tests::throws<std::runtime_error>([&] { restore(state.rest, alone); },
                                         "snapshot: it is of a scene in parts, and its bodies are in these");
}

TEST_CASE("Saved parts: a World's state is one with all bodies in the rest", "[parallel]") {
  const Mixed mixed;
  Log right;
  World<1> world(mixed.options, &right);
  mixed.fill(world);
  world.advance_to(0.5);
  const Snapshot saved = save(world);
  const std::size_t before = right.events.size();
  world.advance_to(3);
  const std::vector<Event> later(right.events.begin() + static_cast<std::ptrdiff_t>(before), right.events.end());
  CHECK(later.size() > 5);
  for (const std::size_t count : {1u, 3u}) {
    run_by(count, [&](Processes* processes, std::size_t rank) {
      ParallelLog log;
      ParallelWorld<1> divided(mixed.options, {.threads = 1, .domains = 3, .halo = 0.5}, &log, processes);
      divided.load_parts(saved, {});
      StateInParts again(count);
      again.save(divided, rank, 1);
      divided.advance_to(3);
      if (rank > 0) return;
      Log after;
      World<1> loaded(mixed.options, &after);
      restore(again.rest, loaded);
      loaded.advance_to(3);
      if (after.events != later) throw std::runtime_error("the events of what was saved again differ");
      if (log.events != later) throw std::runtime_error("the events differ");
    });
  }
  // And of one that is saved in parts: attachments, ignored pairs, free slots and timers are there again.
  // Those who have loaded it and save it again at once keep together what is attached.
  const StateInParts first = mixed.saved(3, 5);
  const Blocks first_blocks = first.blocks();
  StateInParts state(2);
  ThreadProcesses(2).run([&](Processes& processes) {
    ParallelWorld<1> divided(mixed.options, {.threads = 1, .domains = 3, .halo = 0.5}, nullptr, &processes);
    divided.load_parts(first.rest, share_of(first_blocks, processes.rank(), 2));
    state.save(divided, processes.rank(), 1);
  });
  const Blocks blocks = state.blocks();
  CHECK(blocks.size() == 11);
  ParallelWorld<1> alone(mixed.options, {.threads = 1, .domains = 1});
  alone.load_parts(state.rest, share_of(blocks, 0, 1));
  Log log;
  World<1> loaded(mixed.options, &log);
  restore(save(alone.whole()), loaded);
  CHECK(loaded.add_body(tests::ball<1>(0.1, Vector3d(0, 50, 0))) == body_id(1, 11));
  loaded.advance_to(3);
  CHECK(log.events == later);
}

TEST_CASE("Saved parts: damaged anywhere they are refused, or a world comes of it", "[parallel][damaged]") {
  const Mixed mixed;
  const StateInParts state = mixed.saved(1, 6);
  const Blocks blocks = state.blocks();
  std::size_t refused = 0, accepted = 0;
  const auto load = [&](const Snapshot& rest, const Blocks& given) {
    ParallelWorld<1> world(mixed.options, {.threads = 1, .domains = 2, .halo = 0.5});
    try {
      world.load_parts(rest, share_of(given, 0, 1));
    } catch (const std::runtime_error& error) {
      ++refused;
      if (std::string(error.what()).find("snapshot: ") != 0) FAIL(error.what());
      CHECK(world.size() == 0);
      return;
    }
    ++accepted;
    try {
      world.whole().audit();
      world.advance_to(world.now() + 0.5);
      world.whole().audit();
    } catch (const std::exception&) {  // What it says of itself is right or wrong, but it must say it.
    }
  };
  for (const kds::tests::Damage& damage : kds::tests::all_damages()) {
    for (std::size_t at = 0; at < state.rest.bytes().size(); ++at) {
      INFO(damage.name << " at byte " << at << " of the rest");
      load(Snapshot(damage.of(state.rest.bytes(), at)), blocks);
    }
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      for (std::size_t at = 0; at < blocks[i].size(); ++at) {
        INFO(damage.name << " at byte " << at << " of block " << i);
        Blocks wrong = blocks;
        wrong[i] = damage.of(blocks[i], at);
        load(state.rest, wrong);
      }
    }
  }
  CHECK(refused > 1000);
  CHECK(accepted > 1000);
}

}  // namespace kds::collision::test_refused_parts
