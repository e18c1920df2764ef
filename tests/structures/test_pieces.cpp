// Motions in pieces, as a structure of a simulator.
#include "kds/pieces.hpp"
#include "kds/simulator.hpp"
#include "tests/structures/logged_lists.hpp"

#include <catch2/catch.hpp>

#include <stdexcept>

namespace {

using namespace kds;
using namespace kds::tests;

}  // namespace

TEST_CASE("a zigzag in pieces is that of edits by hand", "[framework][pieces]") {
  const auto zigzag = [](bool planned) {
    MovingSet<Motion<1>> set;
    Log log;
    List<1> list(set, 0, {}, {&log});
    Pieces<Motion<1>> pieces(set);
    set.insert(0, {{{0.5, 0}}, 0}, 0);
    set.insert(1, {{{0, 1}}, 0}, 0);
    Simulator simulator(0, pieces, list);
    for (int k = 1; k < 8; ++k) {
      const Motion<1> motion{{{k % 2 == 1 ? 1.0 : 0.0, k % 2 == 1 ? -1.0 : 1.0}}, 1.0 * k};
      if (planned) {
        pieces.plan(1, k, motion, simulator.now());
      } else {
        simulator.advance_to(k);
        set.update(1, motion, k);
      }
    }
    while (simulator.step()) simulator.audit();
    CHECK(pieces.counters().events == (planned ? 7 : 0));
    return log;
  };
  const Log log = zigzag(true);
  CHECK(log.size() == 8);
  CHECK(log == zigzag(false));
}

TEST_CASE("plans are refused out of order, and go with their element", "[framework][pieces]") {
  MovingSet<Motion<1>> set;
  Pieces<Motion<1>> pieces(set);
  set.insert(0, {}, 0);
  pieces.plan(0, 2, {{{0, 1}}, 2}, 0);
  CHECK_THROWS_AS(pieces.plan(0, 2, {}, 0), std::invalid_argument);
  CHECK_THROWS_AS(pieces.plan(0, 1, {}, 0), std::invalid_argument);
  CHECK_THROWS_AS(pieces.plan(0, never, {}, 0), std::invalid_argument);
  CHECK_THROWS_AS(pieces.plan(3, 4, {}, 0), std::out_of_range);
  CHECK_THROWS_AS(pieces.plan(0, 4, {{{0, never}}, 0}, 0), std::invalid_argument);
  CHECK(pieces.planned(0) == 1);
  CHECK_THROWS_AS(set.update(0, {}, 3), std::logic_error);  // It would pass over a seam.
  set.remove(0, 1);
  CHECK(pieces.planned(0) == 0);
  CHECK(pieces.next_time() == never);
}

TEST_CASE("a thousand seams at one time need no deep stack and leave the right order", "[framework][pieces]") {
  MovingSet<Motion<1>> set;
  Pieces<Motion<1>> pieces(set);
  const Id n = 1000;
  Log log;
  List<1> list(set, 0, {}, {&log});
  for (Id id = 0; id < n; ++id) {
    set.insert(id, {{{1.0 * id, 0}}, 0}, 0);
    pieces.plan(id, 1, {{{1.0 * id, -2.0 * id}}, 1}, 0);
  }
  Simulator simulator(0, list, pieces);
  simulator.advance_to(1);
  CHECK(log.empty());
  simulator.advance_to(2);
  simulator.audit();
  CHECK(list.rule().order.front() == n - 1);
  CHECK(log.size() == n * (n - 1) / 2);
}
