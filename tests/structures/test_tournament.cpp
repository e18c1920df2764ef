// The kinetic tournament against the exact maximum of its motions, at every event and between events.
#include "kds/events/calendar_queue.hpp"
#include "kds/events/dary_queue.hpp"
#include "kds/events/pairing_queue.hpp"
#include "kds/simulator.hpp"
#include "structures/tournament.hpp"
#include "tests/structures/random_values.hpp"

#include <catch2/catch.hpp>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <ostream>
#include <stdexcept>
#include <vector>

namespace test_tournament {
namespace {

using namespace kds;
using namespace kds::tests;
using structures::Tournament;

struct Lead {
  std::optional<std::uint32_t> winner;
  double time;
  friend bool operator==(const Lead&, const Lead&) = default;
  friend std::ostream& operator<<(std::ostream& out, const Lead& lead) {
    return out << (lead.winner ? static_cast<int>(*lead.winner) : -1) << " at " << lead.time;
  }
};
using Log = std::vector<Lead>;

template <class T, int Degree>
void require_winner(const T& tournament, const Model<Degree>& model, double t) {
  const std::optional<std::uint32_t> expected = model.motions.empty() ? std::nullopt : std::optional(model.greatest(t));
  if (tournament.winner() != expected) {
    CAPTURE(t);
    REQUIRE(tournament.winner() == expected);
  }
}

/// Runs random changes and advances; returns the winner after every event, however small.
template <int Degree, class Queue>
Log run(std::uint64_t seed, Kind kind, std::size_t most, int steps, double window) {
  Random random(seed);
  Log log;
  Tournament<Degree, Queue> tournament;
  Model<Degree> model;
  double now = beginning(kind);
  for (std::size_t i = 0; i < most / 2; ++i) {
    const auto id = static_cast<std::uint32_t>(2 * i);
    model.motions[id] = random_motion<Degree>(random, kind, now);
    tournament.insert(id, model.motions[id], now);
  }
  Simulator simulator(now, tournament);
  if (window < never) simulator.set_window(window);
  require_winner(tournament, model, now);
  for (int step = 0; step < steps; ++step) {
    const double target = now + random_delay(random, kind);
    const bool look_before = random.one_in(4);
    while (true) {
      const double next = simulator.next_time();
      if (look_before && next <= target && next_down(next) >= simulator.now()) {
        require_winner(tournament, model, next_down(next));
      }
      if (!simulator.step(target)) break;
      log.push_back({tournament.winner(), simulator.now()});
      simulator.audit();
      if (simulator.next_time() > simulator.now()) require_winner(tournament, model, simulator.now());
      REQUIRE(log.size() < 100000);
    }
    simulator.advance_to(target);
    now = target;
    require_winner(tournament, model, now);
    apply(random_change(random, kind, now, most, model), tournament, now);
    tournament.audit(now);
    require_winner(tournament, model, now);
  }
  REQUIRE(tournament.size() == model.motions.size());
  return log;
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("a kinetic tournament knows the exact maximum, whatever its queue and horizon", "[tournament]",
                       ((int Degree), Degree), 1, 2, 3) {
  for (const Kind kind : all_kinds) {
    for (std::uint64_t seed = 300; seed < 304; ++seed) {
      CAPTURE(Degree, static_cast<int>(kind), seed);
      const std::size_t most = 3 + 7 * (seed % 4);
      const int steps = 40;
      const Log log = run<Degree, CalendarQueue<>>(seed, kind, most, steps, never);
      CHECK(run<Degree, DaryQueue<>>(seed, kind, most, steps, never) == log);
      CHECK(run<Degree, PairingQueue<>>(seed, kind, most, steps, never) == log);
      CHECK(run<Degree, CalendarQueue<>>(seed, kind, most, steps, 0.1) == log);
      CHECK(run<Degree, DaryQueue<>>(seed, kind, most, steps, 1.5) == log);
    }
  }
}

TEST_CASE("changes in the midst of a tournament's events of one time come out right", "[tournament]") {
  const std::uint64_t seed = 310;
  CAPTURE(seed);
  Random random(seed);
  int amidst = 0;
  for (int round = 0; round < 150; ++round) {
    CAPTURE(round);
    Tournament<2> tournament;
    Model<2> model;
    for (std::uint32_t id = 0; id < 12; ++id) {
      model.motions[id] = random_motion<2>(random, Kind::lattice, 0);
      tournament.insert(id, model.motions[id], 0);
    }
    Simulator simulator(0, tournament);
    for (int event = 0; event < 20 && simulator.step(); ++event) {
      const double now = simulator.now();
      amidst += simulator.next_time() == now;
      if (random.one_in(2)) {
        apply(random_change(random, Kind::lattice, now, 16, model), tournament, now);
        tournament.audit(now);
      }
      if (simulator.next_time() > now) require_winner(tournament, model, now);
    }
  }
  CHECK(amidst > 50);
}

TEST_CASE("the winner of lines is the upper envelope", "[tournament]") {
  // Tangents to a parabola: each is the greatest for a while, in the order of its slope.
  Tournament<1> tournament;
  for (std::uint32_t i = 0; i < 16; ++i) {
    const double slope = i;
    tournament.insert((i * 5) % 16, {{{-slope * slope / 2, slope}}, 0}, 0);
  }
  Simulator simulator(0, tournament);
  std::uint32_t leads = 0;
  std::optional<std::uint32_t> winner = tournament.winner();
  while (simulator.step()) {
    if (tournament.winner() == winner) continue;
    winner = tournament.winner();
    CHECK(simulator.now() == leads + 0.5);
    ++leads;
    CHECK(tournament.motion(*winner).position.c[1] == leads);
  }
  CHECK(leads == 15);
}

TEST_CASE("a kinetic tournament keeps to its measures", "[tournament]") {
  const std::uint64_t seed = 320;
  CAPTURE(seed);
  Random random(seed);
  for (const std::uint32_t n : {1u, 2u, 13u, 64u}) {
    CAPTURE(n);
    Tournament<2> tournament;
    for (std::uint32_t id = 0; id < n; ++id) tournament.insert(id, random_motion<2>(random, Kind::generic, 0), 0);
    Simulator simulator(0, tournament);
    std::uint64_t events = 0, changes = 0;
    for (auto before = tournament.winner(); simulator.step(); before = tournament.winner()) {
      ++events;
      changes += tournament.winner() != before;
    }
    const auto rounds = static_cast<std::uint64_t>(std::bit_width(n - 1));
    const Measures m = tournament.measures();
    CHECK(m.events == events);
    CHECK(m.external == changes);
    CHECK(m.touched >= m.events);
    CHECK(m.most_touched <= rounds);  // responsive
    CHECK(m.touched <= rounds * m.events);
    CHECK(m.most_per_element <= rounds);  // local
    CHECK(m.held == n - 1);               // compact
    CHECK(m.most_held == n - 1);
    if (n == 64) {
      CHECK(m.events > m.external);
      CHECK(m.external > 1);
      CHECK(m.most_per_element == rounds);  // The winner has played in each.
      // An event goes on only to matches that the old winner had won: two on average, if any may win.
      CHECK(m.touched <= 3 * m.events);
    }
    tournament.remove(0, simulator.now());
    CHECK(tournament.measures().held == (n < 2 ? 0 : n - 2));
    CHECK(tournament.measures().most_held == n - 1);
  }
}

// --- misuse

TEST_CASE("a tournament of none and of one", "[tournament]") {
  Tournament<1> tournament;
  CHECK_FALSE(tournament.winner().has_value());
  CHECK(tournament.next_time() == never);
  CHECK_FALSE(tournament.contains(0));
  tournament.audit(0);
  tournament.extend_horizon(0, 1);
  tournament.insert(5, {{{1, 1}}, 0}, 0);
  CHECK(tournament.winner() == 5);
  CHECK(tournament.next_time() == never);
  tournament.audit(0);
  tournament.remove(5, 0);
  CHECK_FALSE(tournament.winner().has_value());
  CHECK(tournament.size() == 0);
  tournament.audit(0);
}

TEST_CASE("a tournament refuses ids used twice or not known, and motions that are not finite", "[tournament]") {
  Tournament<2> tournament;
  const Motion<2> motion{{{1, 2, 3}}, 0};
  tournament.insert(3, motion, 0);
  CHECK_THROWS_AS(tournament.insert(3, motion, 0), std::invalid_argument);
  CHECK_THROWS_WITH(tournament.insert(3, motion, 0), "Tournament: id 3 is used twice");
  CHECK_THROWS_AS(tournament.insert(std::numeric_limits<std::uint32_t>::max(), motion, 0), std::invalid_argument);
  CHECK_THROWS_AS(tournament.remove(4, 0), std::out_of_range);
  CHECK_THROWS_WITH(tournament.remove(4, 0), "Tournament: no element with id 4");
  CHECK_THROWS_AS(tournament.remove(4000000000u, 0), std::out_of_range);
  CHECK_THROWS_AS(tournament.update(2, motion, 0), std::out_of_range);
  for (const double bad : {std::nan(""), -std::numeric_limits<double>::infinity()}) {
    for (std::size_t i = 0; i < 4; ++i) {
      Motion<2> broken = motion;
      (i < 3 ? broken.position.c[i] : broken.start) = bad;
      CHECK_THROWS_AS(tournament.insert(6, broken, 0), std::invalid_argument);
      CHECK_THROWS_AS(tournament.update(3, broken, 0), std::invalid_argument);
      CHECK_THROWS_WITH(tournament.insert(6, broken, 0), "Tournament: the motion of id 6 is not finite");
    }
  }
  CHECK(tournament.size() == 1);
  CHECK(tournament.winner() == 3);
  CHECK(tournament.motion(3) == motion);
  tournament.audit(0);
}

TEST_CASE("a tournament's audit finds a clock that has run past an event", "[tournament]") {
  Tournament<1> tournament;
  tournament.insert(0, {{{1, 0}}, 0}, 0);
  tournament.insert(1, {{{0, 1}}, 0}, 0);
  CHECK_NOTHROW(tournament.audit(0.5));
  CHECK_NOTHROW(tournament.audit(1));
  CHECK_THROWS_AS(tournament.audit(2), AuditFailure);
  tournament.process();
  CHECK(tournament.winner() == 1);
  CHECK_NOTHROW(tournament.audit(2));
  CHECK_THROWS_AS(tournament.audit(0), AuditFailure);
}

TEST_CASE("a tournament counts its events and certificates", "[tournament]") {
  Tournament<1> tournament;
  for (std::uint32_t id = 0; id < 8; ++id) tournament.insert(id, {{{-1.0 * id, 1.0 * id}}, 0}, 0);
  const auto before = tournament.counters();
  CHECK(before.events == 0);
  CHECK(before.certificates >= 7);
  Simulator simulator(0, tournament);
  simulator.advance_to(2);
  CHECK(tournament.counters().events >= 3);
  CHECK(tournament.counters().certificates > before.certificates);
}

TEST_CASE("a motion of the tournament may be given to its changes", "[tournament]") {
  Tournament<1> tournament;
  tournament.insert(0, {{{3, 7}}, 0}, 0);
  for (std::uint32_t id = 1; id < 300; ++id) tournament.insert(id, tournament.motion(id - 1), 0);
  tournament.update(1, tournament.motion(299), 0);
  for (std::uint32_t id = 0; id < 300; ++id) CHECK(tournament.motion(id) == Motion<1>{{{3, 7}}, 0});
  tournament.audit(0);
}

}  // namespace test_tournament
