// Motions in pieces, as a structure of a simulator.
#include "kds/pieces.hpp"
#include "kds/simulator.hpp"
#include "tests/structures/logged_lists.hpp"

#include <catch2/catch.hpp>

#include <functional>
#include <stdexcept>
#include <vector>

namespace test_pieces {
namespace {

using namespace kds;
using namespace kds::tests;

}  // namespace

TEST_CASE("a zigzag in pieces is that of edits by hand", "[framework][pieces]") {
  const auto zigzag = [](bool planned) {
    MovingSet<Motion<1>> set;
    KineticLog log;
    LoggedList<1> list(set, 0, {}, {&log});
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
  const KineticLog log = zigzag(true);
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
  KineticLog log;
  LoggedList<1> list(set, 0, {}, {&log});
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

namespace {

/// A list whose events call a function.
struct Calls {
  std::function<void(double)> function;
  void operator()(const examples::ListRule<Motion<1>>&, const KineticEvent& event) const { function(event.time); }
};

}  // namespace

TEST_CASE("the listener of an event may remove the element of a seam of its time", "[framework][pieces]") {
  MovingSet<Motion<1>> set;
  Pieces<Motion<1>> pieces(set);
  set.insert(0, {{{0, 1}}, 0}, 0);
  set.insert(1, {{{1, 0}}, 0}, 0);
  for (const Id id : {0u, 1u}) pieces.plan(id, 1, {{{5, 0}}, 1}, 0);
  pieces.plan(1, 2, {{{3, 0}}, 2}, 0);
  Kinetic<examples::ListRule<Motion<1>>, Calls> list(set, 0);
  list.listener().function = [&](double t) { set.remove(0, t); };
  Simulator simulator(0, pieces, list);
  simulator.advance_to(1);
  CHECK(set.ids() == std::vector<Id>{1});
  CHECK(set[1] == Motion<1>{{{5, 0}}, 1});
  CHECK(pieces.planned(0) == 0);
  CHECK(pieces.counters().events == 1);
  simulator.audit();
  set.insert(2, {}, 2);  // The seams of its time come before it, as ever.
  CHECK(set[1] == Motion<1>{{{3, 0}}, 2});
}

TEST_CASE("a seam at whose time a listener throws is made when the run goes on", "[framework][pieces]") {
  MovingSet<Motion<1>> set;
  Pieces<Motion<1>> pieces(set);
  set.insert(0, {{{0, 1}}, 0}, 0);
  set.insert(1, {{{1, 0}}, 0}, 0);
  pieces.plan(1, 1, {{{5, 0}}, 1}, 0);
  pieces.plan(1, 2, {{{3, 0}}, 2}, 0);
  Kinetic<examples::ListRule<Motion<1>>, Calls> list(set, 0);
  list.listener().function = [](double) { throw std::runtime_error("no more"); };
  Simulator simulator(0, pieces, list);
  CHECK_THROWS_WITH(simulator.step(), "no more");
  CHECK(pieces.planned(1) == 2);
  list.listener().function = [](double) {};
  simulator.advance_to(1);
  CHECK(set[1] == Motion<1>{{{5, 0}}, 1});
  set.insert(2, {}, 2);
  CHECK(set[1] == Motion<1>{{{3, 0}}, 2});
  simulator.advance_to(2);
  simulator.audit();
}

}  // namespace test_pieces
