// Lists, tournaments, sets and pieces that are loaded from damaged bytes: they refuse them, or run.
#include "kds/events/dary_queue.hpp"
#include "kds/framework/snapshot.hpp"
#include "kds/pieces.hpp"
#include "kds/simulator.hpp"
#include "structures/sorted_list.hpp"
#include "structures/tournament.hpp"
#include "tests/structures/random_values.hpp"
#include "tests/support/damaged_bytes.hpp"

#include <catch2/catch.hpp>

#include <cstddef>
#include <cstdint>
#include <exception>
#include <stdexcept>
#include <string>
#include <vector>

namespace test_damaged_snapshots {
namespace {

using namespace kds;
using namespace kds::tests;

/// How far a damaged structure is run: it need not be right, but it must say so or come to an end.
constexpr int most_steps = 30;

struct Outcome {
  std::size_t refused = 0, accepted = 0;
};

/// `make(use)` calls use(simulator, parts...) on a run of its own, begun anew; the simulator is saved with the parts.
template <class Make>
Outcome damage_everywhere(const Make& make) {
  Outcome outcome;
  Snapshot snapshot;
  make([&](auto& simulator, auto&... parts) {
    while (simulator.now() < 0.5 && simulator.step(1)) {
    }
    snapshot = save(simulator, parts...);
  });
  for (const Damage& damage : all_damages()) {
    for (std::size_t at = 0; at < snapshot.bytes().size(); ++at) {
      const std::vector<char> bytes = damage.of(snapshot.bytes(), at);
      if (bytes == snapshot.bytes()) continue;
      INFO(damage.name << " at byte " << at << " of " << bytes.size());
      make([&](auto& simulator, auto&... parts) {
        const Snapshot before = save(simulator, parts...);
        try {
          restore(Snapshot(bytes), simulator, parts...);
        } catch (const std::runtime_error& error) {
          ++outcome.refused;
          if (std::string(error.what()).find("snapshot: ") != 0) FAIL(error.what());
          if (!(save(simulator, parts...) == before)) FAIL("it has changed");
          simulator.audit();
          return;
        }
        ++outcome.accepted;
        try {
          simulator.audit();
        } catch (const AuditFailure&) {
        }
        try {
          for (int i = 0; i < most_steps && simulator.step(); ++i) {
          }
        } catch (const std::logic_error& error) {
          // Quick answers are promised for lists that are in order, which a damaged one need not be; in builds that
          // check them (docs/testing.md) that is noticed. So is an event that is due before the clock.
          const std::string what = error.what();
          if (what.find("certificate ") != 0 && what.find("Simulator: the clock stands at ") != 0) throw;
        }
      });
    }
  }
  return outcome;
}

/// A list or tournament of its own elements.
template <class Structure, int Degree>
void check_alone() {
  const std::uint64_t seed = 720;
  const Outcome outcome = damage_everywhere([&](const auto& use) {
    Random random(seed);
    Structure structure;
    Simulator simulator(0, structure);
    for (std::uint32_t id = 0; id < 5; ++id) {
      structure.insert(2 * id, random_motion<Degree>(random, Kind::generic, 0), 0);
    }
    use(simulator);
  });
  CHECK(outcome.refused > 100);
  CHECK(outcome.accepted > 100);
}

TEST_CASE("damaged snapshots of lists are refused, or give lists that run", "[snapshot][damaged]") {
  check_alone<structures::SortedList<1>, 1>();
  check_alone<structures::SortedList<2>, 2>();
}

TEST_CASE("damaged snapshots of tournaments are refused, or give tournaments that run", "[snapshot][damaged]") {
  check_alone<structures::Tournament<1>, 1>();
  check_alone<structures::Tournament<2>, 2>();
}

TEST_CASE("damaged snapshots of sets and pieces are refused, or give sets that run", "[snapshot][damaged]") {
  const std::uint64_t seed = 721;
  const Outcome outcome = damage_everywhere([&](const auto& use) {
    Random random(seed);
    MovingSet<Motion<1>> values;
    Pieces<Motion<1>> pieces(values);
    Simulator simulator(0, pieces);
    for (std::uint32_t id = 0; id < 4; ++id) {
      values.add(random_motion<1>(random, Kind::generic, 0), 0);
      pieces.plan(id, 0.25 + id, random_motion<1>(random, Kind::generic, 0), 0);
      pieces.plan(id, 2.25 + id, random_motion<1>(random, Kind::generic, 0), 0);
    }
    values.remove(1, 0);
    use(simulator, values);
  });
  CHECK(outcome.refused > 100);
  CHECK(outcome.accepted > 100);
}

}  // namespace

}  // namespace test_damaged_snapshots
