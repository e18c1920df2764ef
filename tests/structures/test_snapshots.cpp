// Lists and tournaments saved at any moment, rolled back, loaded elsewhere, and what is refused.
#include "kds/events/dary_queue.hpp"
#include "kds/events/pairing_queue.hpp"
#include "kds/framework/snapshot.hpp"
#include "kds/simulator.hpp"
#include "structures/sorted_list.hpp"
#include "structures/tournament.hpp"
#include "tests/structures/random_values.hpp"
#include "tests/structures/rule_list.hpp"

#include <catch2/catch.hpp>

#include <cstdint>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace test_snapshots {
namespace {

using namespace kds;
using namespace kds::tests;
using structures::SortedList;
using structures::Tournament;

/// What there is to see after an event: the time, and the order or the winner.
struct Seen {
  double time;
  std::vector<std::uint32_t> ids;
  friend bool operator==(const Seen&, const Seen&) = default;
};

template <class List>
std::vector<std::uint32_t> ids_of(const List& list) {
  std::vector<std::uint32_t> ids;
  for (const auto& entry : list.entries()) ids.push_back(entry.id);
  return ids;
}
template <int Degree, class Queue, class Solver>
std::vector<std::uint32_t> ids_of(const Tournament<Degree, Queue, Solver>& tournament) {
  const auto winner = tournament.winner();
  return winner ? std::vector<std::uint32_t>{*winner} : std::vector<std::uint32_t>{};
}

/// A structure with its clock, and what it is to hold.
template <class Structure, int Degree>
struct Run {
  static constexpr std::size_t most = 14;
  Structure structure;
  Simulator<Structure> simulator;
  Model<Degree> model;
  Kind kind;
  std::vector<Seen> log;

  Run(std::uint64_t seed, Kind k, double window = never) : simulator(beginning(k), structure), kind(k) {
    Random random(seed);
    for (std::uint32_t id = 0; id < most; id += 2) {
      model.motions[id] = random_motion<Degree>(random, kind, simulator.now());
      structure.insert(id, model.motions[id], simulator.now());
    }
    if (window < never) simulator.set_window(window);
  }

  /// Some events, which may end amidst those of one time.
  void some_events(std::size_t count) {
    while (count-- > 0 && simulator.step()) log.push_back({simulator.now(), ids_of(structure)});
  }
  void edits(std::uint64_t seed, int count) {
    Random random(seed);
    while (count-- > 0) {
      const double target = simulator.now() + random_delay(random, kind);
      while (simulator.step(target)) log.push_back({simulator.now(), ids_of(structure)});
      simulator.advance_to(target);
      apply(random_change(random, kind, target, most, model), structure, target);
      if (random.one_in(2)) some_events(random.below(4));
    }
    simulator.audit();
    log.push_back({simulator.now(), ids_of(structure)});
  }
};

/// Number of things that were not as they were the first time.
template <int Degree, class Structure, class Other>
int differences(std::uint64_t seed, Kind kind, double window) {
  int wrong = 0;
  Run<Structure, Degree> run(seed, kind, window);
  for (std::uint64_t round = 0; round < 4; ++round) {
    run.edits(seed + round, 3);
    run.some_events(round);
    const Snapshot middle = save(run.simulator);
    const auto model = run.model;
    run.log.clear();
    run.edits(seed + 100 + round, 5);
    const auto expected = run.log;
    const Snapshot end = save(run.simulator);
    const Counters counted = run.simulator.counters();

    run.log.clear();
    run.model = model;
    restore(middle, run.simulator);
    wrong += !(save(run.simulator) == middle);
    run.simulator.audit();
    run.edits(seed + 100 + round, 5);
    wrong += run.log != expected;
    wrong += !(save(run.simulator) == end);
    wrong += !(run.simulator.counters() == counted);

    std::stringstream file;
    write(file, middle);
    Run<Other, Degree> elsewhere(seed + 1000, kind);
    elsewhere.edits(seed + 1001, 2);
    restore(read_snapshot(file), elsewhere.simulator);
    elsewhere.log.clear();
    elsewhere.model = model;
    elsewhere.edits(seed + 100 + round, 5);
    wrong += elsewhere.log != expected;
    wrong += !(save(elsewhere.simulator) == end);
  }
  return wrong;
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("lists and tournaments run again from a snapshot bit for bit", "[snapshot]",
                       ((int Degree), Degree), 1, 2, 3) {
  using ById = RuleList<Degree, structures::NoSwapListener, PairingQueue<>>;
  using ById2 = RuleList<Degree, structures::NoSwapListener, DaryQueue<>>;
  for (const Kind kind : all_kinds) {
    for (std::uint64_t seed = 700; seed < 703; ++seed) {
      CAPTURE(Degree, static_cast<int>(kind), seed);
      const double window = seed % 2 == 0 ? 0.4 : never;
      CHECK(differences<Degree, SortedList<Degree>, SortedList<Degree>>(seed, kind, window) == 0);
      CHECK(differences<Degree, ById, ById2>(seed, kind, window) == 0);
      CHECK(differences<Degree, Tournament<Degree>, Tournament<Degree, PairingQueue<>>>(seed, kind, window) == 0);
    }
  }
}

TEST_CASE("a snapshot of something else is refused, and nothing has changed", "[snapshot]") {
  const std::uint64_t seed = 710;
  Run<SortedList<2>, 2> list(seed, Kind::generic);
  Run<SortedList<1>, 1> lines(seed, Kind::generic);
  Run<Tournament<2>, 2> tournament(seed, Kind::generic);
  list.edits(seed, 3);
  const Snapshot before = save(list.simulator);
  CHECK_THROWS_WITH(restore(save(lines.simulator), list.simulator),
                    Catch::Contains("expected SortedList of degree 2") && Catch::Contains("List of degree 1"));
  CHECK_THROWS_WITH(restore(save(tournament.simulator), list.simulator), Catch::Contains("found Tournament"));
  CHECK_THROWS_WITH(restore(before, list.structure), Catch::Contains("found Simulator"));
  // Of the right parts, but with something missing, or something more: half of it loads.
  std::vector<char> bytes = before.bytes();
  std::size_t refused = 0;
  for (std::size_t length = 0; length < bytes.size(); length += 7) {
    const Snapshot cut(std::vector<char>(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length)));
    try {
      restore(cut, list.simulator);
    } catch (const std::runtime_error&) {
      ++refused;
    }
  }
  CHECK(refused == (bytes.size() + 6) / 7);
  bytes.push_back(0);
  CHECK_THROWS_WITH(restore(Snapshot(bytes), list.simulator), Catch::Contains("more in it"));
  CHECK(save(list.simulator) == before);
  list.simulator.audit();
  list.edits(seed + 1, 5);
}

TEST_CASE("entries of another length and optional values that are not there", "[snapshot]") {
  std::vector<double> doubles{1, 2, 3};
  std::vector<float> floats{1, 2, 3, 4};
  detail::Writer writer;
  writer(doubles);
  const std::vector<char> bytes = writer.take();
  detail::Reader reader(bytes);
  CHECK_THROWS_WITH(reader(floats), Catch::Contains("other types"));
  detail::Writer optional_writer;
  std::vector<std::optional<std::uint32_t>> some{1u, std::nullopt, 3u}, loaded{std::nullopt, 2u};
  optional_writer(some);
  const std::vector<char> optional_bytes = optional_writer.take();
  detail::Reader optional_reader(optional_bytes);
  optional_reader(loaded);
  CHECK(loaded == some);
  CHECK(optional_reader.at_end());
}

}  // namespace test_snapshots
