// Edits of a set whose events, elements or structures are in their way.
#include "examples/list_in_forty_lines.hpp"
#include "kds/bounded.hpp"
#include "kds/framework/kinetic.hpp"
#include "kds/framework/snapshot.hpp"
#include "kds/simulator.hpp"

#include <catch2/catch.hpp>

#include <functional>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

namespace test_edits {
namespace {

using namespace kds;
using examples::ListRule;
using Value = Motion<1>;

/// A list whose events call a function.
struct Calls {
  std::function<void(double)> function;
  void operator()(const ListRule<Value>&, const KineticEvent& event) const { function(event.time); }
};

/// Two that meet at 1, and what is called then, once.
struct Meeting {
  MovingSet<Value> set;
  Kinetic<ListRule<Value>, Calls> list{set, 0};
  Simulator<Kinetic<ListRule<Value>, Calls>> simulator{0, list};

  explicit Meeting(std::function<void(MovingSet<Value>&, double)> function) {
    set.insert(0, {{{0, 1}}, 0}, 0);
    set.insert(1, {{{1, 0}}, 0}, 0);
    list.listener().function = [this, function, called = false](double t) mutable {
      if (!std::exchange(called, true)) function(set, t);
    };
  }
  void check(std::size_t size) {
    CHECK(set.size() == size);
    CHECK(set.ids().size() == size);
    CHECK(list.rule().order.size() == size);
    simulator.advance_to(1);
    simulator.audit();
  }
};

Value at_rest(double x) { return {{{x, 0}}, 0}; }

/// A rule that throws when it repairs, and leaves its structure in pieces.
struct Breaks : ListRule<Value> {
  Effect repair(Slot, Repair<Value>&) { throw std::runtime_error("broken"); }
};

}  // namespace

TEST_CASE("an element gets an id of its own, whatever listeners add at its time", "[framework]") {
  Meeting meeting([](auto& set, double t) {
    for (int i = 0; i < 3; ++i) set.add(at_rest(10 + i), t);
  });
  CHECK(meeting.set.add(at_rest(5), 1) == 5);
  CHECK(meeting.set[5] == at_rest(5));
  CHECK(meeting.list.rule().order == std::vector<Id>{1, 0, 5, 2, 3, 4});
  meeting.check(6);
}

TEST_CASE("an id that a listener takes at the time of an insertion is used", "[framework]") {
  Meeting meeting([](auto& set, double t) { set.insert(7, at_rest(10), t); });
  CHECK_THROWS_WITH(meeting.set.insert(7, at_rest(5), 1), "MovingSet: id 7 is used twice");
  CHECK(meeting.set[7] == at_rest(10));
  meeting.check(3);
}

TEST_CASE("elements of a set may be given to its edits", "[framework]") {
  MovingSet<Value> set;
  Kinetic<ListRule<Value>> list(set, 0);
  set.add({{{3, 7}}, 0}, 0);
  for (Id id = 1; id < 40; ++id) CHECK(set.add(set[0], 0) == id);
  set.insert(1000, set[39], 0);
  for (const Id id : set.ids()) CHECK(set[id] == Value{{{3, 7}}, 0});
  list.audit(0);

  // The motion is the one that it was given as, even if a listener moves and adds elements first.
  Meeting meeting([](auto& set, double t) {
    set.update(1, at_rest(-4), t);
    for (int i = 0; i < 100; ++i) set.add(at_rest(10 + i), t);
  });
  meeting.set.update(0, meeting.set[1], 1);
  CHECK(meeting.set[0] == at_rest(1));
  meeting.check(102);
}

TEST_CASE("an edit that a structure cannot take up changes neither elements nor structures", "[framework]") {
  MovingSet<Value> set;
  set.insert(0, {{{0, 1}}, 0}, 0);
  set.insert(1, {{{1, 0}}, 0}, 0);
  Kinetic<ListRule<Value>> whole(set, 0);
  SECTION("because its rule has thrown") {
    Kinetic<Breaks> broken(set, 0);
    while (whole.next_time() <= 1) whole.process();
    CHECK_THROWS_WITH(broken.process(), "broken");
    for (int i = 0; i < 2; ++i) {
      CHECK_THROWS_WITH(set.insert(5, at_rest(5), 1), Catch::Contains("or has thrown"));
      CHECK_THROWS_AS(set.update(1, at_rest(5), 1), std::logic_error);
      CHECK_THROWS_AS(set.remove(1, 1), std::logic_error);
    }
  }
  SECTION("because its elements have been turned round without it") {
    while (whole.next_time() <= 1) whole.process();
    set.turn_round();
    for (int i = 0; i < 2; ++i) {
      CHECK_THROWS_AS(set.insert(5, at_rest(5), 1), std::logic_error);
      CHECK_THROWS_AS(set.update(1, at_rest(5), 1), std::logic_error);
      CHECK_THROWS_AS(set.remove(1, 1), std::logic_error);
    }
    set.turn_round();
  }
  CHECK(set.ids() == std::vector<Id>{0, 1});
  CHECK(set[1] == at_rest(1));
  CHECK(whole.rule().order == std::vector<Id>{1, 0});
  set.update(1, at_rest(2), 1);  // The broken structure is gone.
  CHECK(whole.rule().order == std::vector<Id>{0, 1});
  whole.audit(1);
}

TEST_CASE("a sample that a structure cannot take up leaves the others as they were", "[framework][bounded]") {
  struct Stubborn : ListRule<Bounded> {
    const bool* refuses;
    auto certificate(Slot left, const MovingSet<Bounded>& x) const {
      return *refuses ? throw std::runtime_error("broken") : ListRule<Bounded>::certificate(left, x);
    }
  };
  MovingSet<Bounded> set;
  set.sample_with([](Id id, double t) { return Bounded{1.0 * id, 0.25, t}; }, 0.5);
  for (Id id = 0; id < 2; ++id) set.insert(id, {1.0 * id, 0.25, 0}, 0);
  Kinetic<ListRule<Bounded>> whole(set, 0);
  {
    bool refuses = false;
    Stubborn rule;
    rule.refuses = &refuses;
    Kinetic<Stubborn> broken(set, 0, rule);
    refuses = true;
    CHECK_THROWS_WITH(broken.extend_horizon(0, 0), "broken");
    refuses = false;
    CHECK_THROWS_AS(set.resample(0, 0), std::logic_error);
  }
  set.resample(0, 0);
  CHECK(whole.rule().order == std::vector<Id>{0, 1});
  whole.audit(0);
}

TEST_CASE("free ids are used again where one asks for them, and are saved", "[edits]") {
  MovingSet<Value> set;
  Kinetic<ListRule<Value>> list(set, 0);
  Simulator simulator(0, list);
  for (Id id = 0; id < 10; ++id) CHECK(set.add({{{1.0 * id, 0}}, 0}, 0) == id);
  CHECK(set.free_id() == 10);
  set.remove(4, 0);
  set.remove(7, 0);
  set.insert(7, {{{7, 0}}, 0}, 0);  // without asking
  const Snapshot before = save(simulator, set);
  CHECK(set.free_id() == 4);
  CHECK(set.add({{{3, 1}}, 0}, 0) == 10);  // never that of another
  set.insert(set.free_id(), {{{4, 0}}, 0}, 0);
  CHECK(set.free_id() == 11);
  restore(before, simulator, set);
  CHECK(set.free_id() == 4);
  const std::size_t bytes = before.bytes().size();
  for (int i = 0; i < 10000; ++i) {  // ten alive
    set.insert(set.free_id(), {{{0.5 + i % 7, 1}}, 0}, 0);
    set.remove(static_cast<Id>(i % 10 == 4 ? 3 : i % 10), 0);
    if (!set.contains(3)) set.insert(3, {{{3, 0}}, 0}, 0), set.remove(static_cast<Id>((i + 5) % 10), 0);
  }
  simulator.audit();
  CHECK(set.end_id() <= 11);
  CHECK(save(simulator, set).bytes().size() < 2 * bytes);
}

TEST_CASE("a handle is that of one element, though its id is given to others", "[edits]") {
  MovingSet<Value> set;
  Kinetic<ListRule<Value>> list(set, 0);
  Simulator simulator(0, list);
  const Value at_one = at_rest(1), at_two = at_rest(2);
  const ElementHandle first = set.enter(at_one, 0);
  CHECK((first.id == 0 && set.contains(first) && set.id(first) == 0 && set.handle(0) == first));
  const Snapshot before = save(simulator, set);
  set.remove(first, 0);
  CHECK(!set.contains(first));
  CHECK_THROWS_AS(set.handle(0), std::out_of_range);
  const ElementHandle second = set.enter(at_two, 0);
  CHECK((second.id == first.id && second != first && set.contains(second) && !set.contains(first)));
  CHECK_THROWS_WITH(set.remove(first, 0), Catch::Contains("id 0 and generation 0 has been removed"));
  CHECK_THROWS_AS(set.update(first, at_one, 0), std::out_of_range);
  CHECK_THROWS_AS(set.id(first), std::out_of_range);
  CHECK_THROWS_AS(set.id({7, 0}), std::out_of_range);
  CHECK(set[0] == at_two);
  set.update(second, at_one, 0);
  CHECK(set[0] == at_one);
  set.remove(0, 0);  // by its id
  CHECK(!set.contains(second));
  set.insert(0, at_two, 0);
  CHECK((set.handle(0) != first && set.handle(0) != second));
  restore(before, simulator, set);
  CHECK((set.contains(first) && !set.contains(second)));
  CHECK_THROWS_AS(set.enter({{{std::numeric_limits<double>::infinity(), 0}}, 0}, 0), std::invalid_argument);
  CHECK((set.size() == 1 && set.free_id() == 1));
}

TEST_CASE("an edit by handle does not meet another element that a listener puts in its place", "[edits]") {
  bool exchanged = false;
  Meeting meeting([&](auto& set, double t) {
    set.remove(0, t);
    exchanged = set.enter(at_rest(9), t).id == 0;
  });
  const ElementHandle first = meeting.set.handle(0);
  CHECK_THROWS_AS(meeting.set.update(first, at_rest(5), 1), std::out_of_range);  // processes what is due at 1
  CHECK(exchanged);
  CHECK(meeting.set[0] == at_rest(9));
  CHECK_THROWS_AS(meeting.set.remove(first, 1), std::out_of_range);
  meeting.check(2);
}

TEST_CASE("memory follows the elements alive, however many have been", "[edits]") {
  MovingSet<Value> set;
  Kinetic<ListRule<Value>> list(set, 0);
  Simulator simulator(0, list);
  std::vector<ElementHandle> alive;
  int stale = 0;
  for (int i = 0; i < 20000; ++i) {
    alive.push_back(set.enter({{{0.5 + i % 7, 1}}, 0}, 0));
    if (alive.size() <= 10) continue;
    const ElementHandle oldest = alive.front();
    alive.erase(alive.begin());
    set.remove(oldest, 0);
    stale += set.contains(oldest);
  }
  CHECK(stale == 0);
  simulator.audit();
  CHECK(set.end_id() == 11);
  CHECK(save(simulator, set).bytes().size() < 2000);
}

}  // namespace test_edits
