// What the kinetic tournament does where motions meet in number, touch, coincide, or run at a large clock.
#include "kds/simulator.hpp"
#include "structures/tournament.hpp"
#include "tests/structures/random_values.hpp"

#include <catch2/catch.hpp>

#include <cstddef>
#include <cstdint>

namespace test_tournament_degeneracies {
namespace {

using namespace kds;
using namespace kds::tests;
using structures::Tournament;

}  // namespace

TEST_CASE("many entrants meet at one value at one time", "[tournament][degeneracy]") {
  Tournament<1> tournament;
  const std::uint32_t n = 200;
  for (std::uint32_t id = 0; id < n; ++id) {
    const double speed = (id * 37) % n;
    tournament.insert(id, {{{-speed, speed}}, 0}, 0);
  }
  CHECK(tournament.motion(*tournament.winner()).position.c[1] == 0);
  Simulator simulator(0, tournament);
  std::size_t events = 0;
  while (simulator.step()) {
    REQUIRE(simulator.now() == 1);
    REQUIRE(++events < 10 * n);
    simulator.audit();
  }
  CHECK(tournament.motion(*tournament.winner()).position.c[1] == n - 1);
}

TEST_CASE("a touch from below takes no lead", "[tournament][degeneracy]") {
  Tournament<2> tournament;
  tournament.insert(0, {}, 0);
  tournament.insert(1, {{{-1, 2, -1}}, 0}, 0);  // -(t - 1)^2
  CHECK(tournament.winner() == 0);
  CHECK(tournament.next_time() == never);
  tournament.update(1, {{{next_up(-1), 2, -1}}, 0}, 0);
  CHECK(tournament.next_time() < 1);
  Simulator simulator(0, tournament);
  CHECK(simulator.step());
  CHECK(tournament.winner() == 1);
  CHECK(simulator.step());
  CHECK(tournament.winner() == 0);
  CHECK_FALSE(simulator.step());
}

TEST_CASE("of equal motions the least id wins, however they came", "[tournament][degeneracy]") {
  Tournament<2> tournament;
  const Motion<2> motion{{{0.1, 0.2, 0.3}}, 0.4};
  for (const std::uint32_t id : {6, 2, 9, 4}) tournament.insert(id, motion, 0);
  CHECK(tournament.winner() == 2);
  CHECK(tournament.next_time() == never);
  tournament.insert(1, motion, 5);
  CHECK(tournament.winner() == 1);
  tournament.remove(1, 6);
  tournament.remove(2, 6);
  CHECK(tournament.winner() == 4);
  tournament.audit(6);
}

TEST_CASE("a lead that changes at time zero, and entrants at rest", "[tournament][degeneracy]") {
  Tournament<1> tournament;
  tournament.insert(0, {{{0, 0}}, 0}, -1);
  tournament.insert(1, {{{0, 1}}, 0}, -1);
  tournament.insert(2, {{{0, 0}}, 3}, -1);
  CHECK(tournament.winner() == 0);
  CHECK(tournament.next_time() == 0);
  Simulator simulator(-1, tournament);
  simulator.advance_to(0);
  CHECK(tournament.winner() == 1);
  tournament.remove(1, 0);
  CHECK(tournament.winner() == 0);
  CHECK(tournament.next_time() == never);
  // Put in at zero with the same values: decided at 0+, no event.
  tournament.insert(1, {{{0, 1}}, 0}, 0);
  CHECK(tournament.winner() == 1);
  CHECK(tournament.next_time() == never);
}

TEST_CASE("leads at clock 1e9 change as at clock 0, to the bit", "[tournament][degeneracy]") {
  const std::uint64_t seed = 320;
  CAPTURE(seed);
  Random random(seed);
  int events = 0;
  for (int round = 0; round < 10; ++round) {
    Tournament<1> early;
    Tournament<1> late;
    for (std::uint32_t id = 0; id < 20; ++id) {
      Motion<1> motion{{{random.integer(-64, 64) / 16.0, random.one_in(2) ? 1.0 : -1.0}}, 0};
      early.insert(id, motion, 0);
      motion.start = 1e9;
      late.insert(id, motion, 1e9);
    }
    while (early.next_time() != never) {
      CHECK(late.next_time() == early.next_time() + 1e9);
      early.process();
      late.process();
      CHECK(late.winner() == early.winner());
      ++events;
    }
    CHECK(late.next_time() == never);
  }
  CHECK(events > 20);
}

}  // namespace test_tournament_degeneracies
