// A simulator with pieces and two lists, rolled back, run again and loaded elsewhere; and what is no snapshot of it.
#include "kds/events/pairing_queue.hpp"
#include "kds/framework/snapshot.hpp"
#include "kds/pieces.hpp"
#include "kds/simulator.hpp"
#include "tests/structures/logged_lists.hpp"
#include "tests/structures/random_values.hpp"

#include <catch2/catch.hpp>

#include <cstddef>
#include <cstdint>
#include <sstream>
#include <stdexcept>
#include <string>

namespace test_simulator_snapshots {
namespace {

using namespace kds;
using namespace kds::tests;

struct Run {
  MovingSet<Motion<2>> set;
  KineticLog log;
  Pieces<Motion<2>> pieces{set};
  LoggedList<2> list;
  LoggedList<2, PairingQueue<>> other;
  Simulator<Pieces<Motion<2>>, LoggedList<2>, LoggedList<2, PairingQueue<>>> simulator{0, pieces, list, other};

  explicit Run(std::uint64_t seed, Id n) : list(set, 0, {}, {&log}), other(set, 0, {}, {&log}) {
    Random random(seed);
    for (Id id = 0; id < n; ++id) {
      set.insert(id, random_motion<2>(random, Kind::generic, 0), 0);
      pieces.plan(id, 1 + random.unit(), random_motion<2>(random, Kind::generic, 1), 0);
    }
  }
  /// Ten edits and the events between.
  void go_on(std::uint64_t seed) {
    Random random(seed);
    for (int i = 0; i < 10; ++i) {
      simulator.advance_to(simulator.now() + random.between(0, 0.3));
      const Id id = static_cast<Id>(random.below(set.end_id()));
      set.update(id, random_motion<2>(random, Kind::generic, simulator.now()), simulator.now());
    }
    simulator.audit();
  }
};

}  // namespace

TEST_CASE("rolled back and run again, and loaded elsewhere, a simulator makes the same events bit for bit",
          "[framework][snapshot]") {
  const std::uint64_t seed = 530;
  CAPTURE(seed);
  Run run(seed, 40);
  run.simulator.set_window(0.7);
  run.go_on(1);
  const Snapshot middle = save(run.simulator, run.set);
  const std::size_t before = run.log.size();
  run.go_on(2);
  const Snapshot end = save(run.simulator, run.set);
  const KineticLog expected(run.log.begin() + static_cast<std::ptrdiff_t>(before), run.log.end());
  REQUIRE(expected.size() > 100);

  run.log.clear();
  restore(middle, run.simulator, run.set);
  CHECK(save(run.simulator, run.set) == middle);
  run.simulator.audit();
  run.go_on(2);
  CHECK(run.log == expected);
  CHECK(save(run.simulator, run.set) == end);

  std::stringstream file;
  write(file, middle);
  Run elsewhere(seed + 1, 3);  // of the same types, and another past
  restore(read_snapshot(file), elsewhere.simulator, elsewhere.set);
  elsewhere.log.clear();
  elsewhere.go_on(2);
  CHECK(elsewhere.log == expected);
  CHECK(save(elsewhere.simulator, elsewhere.set) == end);
  CHECK(elsewhere.list.measures() == run.list.measures());
  CHECK(elsewhere.simulator.counters() == run.simulator.counters());
}

TEST_CASE("snapshots that are damaged, cut or of other parts are refused", "[framework][snapshot]") {
  Run run(540, 5);
  const Snapshot good = save(run.simulator, run.set);
  std::stringstream file;
  write(file, good);
  const std::string letters = file.str();
  for (const std::size_t at : {std::size_t{2}, std::size_t{9}, letters.size() / 2, letters.size() - 1}) {
    std::string bad = letters;
    bad[at] = static_cast<char>(bad[at] ^ 4);
    std::stringstream in(bad);
    CHECK_THROWS_AS(read_snapshot(in), std::runtime_error);
  }
  for (const std::size_t length : {std::size_t{0}, std::size_t{12}, letters.size() - 1}) {
    std::stringstream in(letters.substr(0, length));
    CHECK_THROWS_AS(read_snapshot(in), std::runtime_error);
  }
  CHECK_THROWS_WITH(restore(good, run.set), Catch::Contains("expected MovingSet, found Simulator"));
  CHECK_THROWS_AS(restore(good, run.simulator), std::runtime_error);
  CHECK_THROWS_AS(restore(save(run.set), run.set, run.set), std::runtime_error);
}

}  // namespace test_simulator_snapshots
