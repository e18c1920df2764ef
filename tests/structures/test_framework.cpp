// The framework, with the list of the examples: against the exact order, with edits and audits.
#include "certificates/plane_certificates.hpp"
#include "kds/events/dary_queue.hpp"
#include "kds/events/pairing_queue.hpp"
#include "kds/simulator.hpp"
#include "structures/delaunay.hpp"
#include "structures/sorted_list.hpp"
#include "tests/structures/logged_lists.hpp"
#include "tests/structures/random_values.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <cstdint>
#include <stdexcept>
#include <variant>
#include <vector>

namespace test_framework {
namespace {

using namespace kds;
using namespace kds::tests;
using examples::ListRule;

std::uint32_t no_rank(std::uint32_t) { return 0; }

template <int Degree>
void apply(const Change<Degree>& change, MovingSet<Motion<Degree>>& set, double now) {
  using What = typename Change<Degree>::What;
  if (change.what == What::insert) set.insert(change.id, change.motion, now);
  if (change.what == What::remove) set.remove(change.id, now);
  if (change.what == What::update) set.update(change.id, change.motion, now);
}

/// Random changes and advances; the number of states that were wrong.
template <int Degree, class Queue>
int mistakes(std::uint64_t seed, Kind kind, double window, KineticLog& log) {
  Random random(seed);
  Model<Degree> model;
  MovingSet<Motion<Degree>> set;
  double now = beginning(kind);
  for (std::uint32_t id = 0; id < 10; ++id) {
    model.motions[2 * id] = random_motion<Degree>(random, kind, now);
    set.insert(2 * id, model.motions[2 * id], now);
  }
  LoggedList<Degree, Queue> list(set, now, {}, {&log});
  Simulator simulator(now, list);
  if (window < never) simulator.set_window(window);
  int wrong = 0;
  const auto compare = [&] { wrong += list.rule().order != model.order(simulator.now(), no_rank); };
  for (int step = 0; step < 30; ++step) {
    const double target = now + random_delay(random, kind);
    while (simulator.step(target)) {
      simulator.audit();
      if (simulator.next_time() > simulator.now()) compare();
    }
    simulator.advance_to(target);
    now = target;
    apply(random_change(random, kind, now, 20, model), set, now);
    simulator.audit();
    compare();
  }
  return wrong;
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("a list in forty lines is in exact order after every event and edit", "[framework]",
                       ((int Degree), Degree), 1, 2, 3) {
  for (const Kind kind : all_kinds) {
    for (std::uint64_t seed = 500; seed < 503; ++seed) {
      CAPTURE(Degree, static_cast<int>(kind), seed);
      KineticLog log, same;
      CHECK(mistakes<Degree, CalendarQueue<>>(seed, kind, never, log) == 0);
      CHECK(mistakes<Degree, PairingQueue<>>(seed, kind, 0.3, same) == 0);
      CHECK(log == same);
      same.clear();
      CHECK(mistakes<Degree, DaryQueue<>>(seed, kind, 2, same) == 0);
      CHECK(log == same);
    }
  }
}

namespace {

/// Counts the certificates that are known to be positive when they are made.
struct CountingSolver : CertifiedSolver {
  static inline std::uint64_t turned = 0;
  template <Certificate C>
  double after_turn(const C& certificate, double now, double horizon) const {
    ++turned;
    return CertifiedSolver::after_turn(certificate, now, horizon);
  }
};

/// Says of each of n values whether it is positive; what proves it turns round when it fails. If it lies, each
/// certificate says that it is the negative of any other.
template <bool lies = false>
struct SignRule {
  struct Side {
    static constexpr int degree = 2;
    const Motion<2>& x;
    double sign;
    template <class Number>
    auto polynomial(double epoch) const {
      return about<Number>(x, epoch) * sign;
    }
    bool is_negative_of(const Side& other) const { return lies || (&x == &other.x && sign == -other.sign); }
  };
  using Element = Motion<2>;
  static constexpr const char* name = "Sign";
  std::vector<double> signs;

  std::variant<std::monostate, Side> certificate(Slot slot, const MovingSet<Element>& x) const {
    if (!x.contains(slot)) return {};
    return Side{x[slot], signs[slot]};
  }
  std::array<Id, 1> members(Slot slot) const { return {slot}; }
  Effect repair(Slot slot, Repair<Element>& repair) {
    signs[slot] = -signs[slot];
    repair.certify(slot ^ 1);  // of another value, which has not turned
    return Effect::external;
  }
  void insert(Id id, Repair<Element>& repair) {
    signs.resize(repair.elements().end_id());
    signs[id] = repair.sign(Side{repair[id], 1}) >= 0 ? 1 : -1;
    repair.certify(id);
  }
  void remove(Id id, Repair<Element>& repair) { repair.retire(id); }
};

/// How many certificates of a run were known to be positive, and how many events there were.
template <class Rule, class Make>
std::array<std::uint64_t, 2> turned_and_events(Id n, Make&& make) {
  Random random(515);
  MovingSet<typename Rule::Element> set;
  for (Id id = 0; id < n; ++id) set.insert(id, make(random), 0);
  Kinetic<Rule, NoListener, DefaultEventQueue, CountingSolver> structure(set, 0);
  Simulator simulator(0, structure);
  CountingSolver::turned = 0;
  simulator.advance_to(2);
  simulator.audit();
  return {CountingSolver::turned, structure.measures().events};
}

}  // namespace

TEST_CASE("the negative of a certificate that has failed is known to be positive", "[framework]") {
  const auto value = [](Random& random) { return random_motion<2>(random, Kind::generic, 0); };
  const auto [swapped, swaps] = turned_and_events<examples::ListRule<Motion<2>>>(40, value);
  CHECK(swaps > 100);
  CHECK(swapped == swaps);
  const auto [turned, turns] = turned_and_events<SignRule<>>(40, value);
  CHECK(turns > 10);
  CHECK(turned == turns);
  // Of the certificates that a flip makes, that of the new edge, if it is between points.
  const auto path = [](Random& random) {
    const auto x = random_motion<1>(random, Kind::generic, 0), y = random_motion<1>(random, Kind::generic, 0);
    return certificates::PlaneMotion<1>{{x.position, y.position}, 0};
  };
  const auto [flipped, flips] = turned_and_events<structures::DelaunayRule<certificates::PlaneMotion<1>>>(30, path);
  CHECK(flips > 50);
  CHECK(flipped > flips / 2);
  CHECK(flipped <= flips);
}

#ifdef KDS_CHECK_QUICK_ANSWERS
TEST_CASE("a certificate that is not the negative that it says it is, is found", "[framework][hooks]") {
  const auto value = [](Random& random) { return random_motion<2>(random, Kind::generic, 0); };
  using Catch::Contains;
  CHECK_THROWS_WITH(
      turned_and_events<SignRule<true>>(40, value),
      Contains("Side") && Contains("is_negative_of is true, but the sum of the two formulas is not zero"));
}
#endif

TEST_CASE("the list of the framework swaps when the tuned one does, and keeps to its measures", "[framework]") {
  const std::uint64_t seed = 510;
  CAPTURE(seed);
  Random random(seed);
  MovingSet<Motion<2>> set;
  std::vector<structures::SortedList<2>::Entry> entries;
  const std::uint64_t n = 60;
  for (Id id = 0; id < n; ++id) {
    const auto motion = random_motion<2>(random, Kind::generic, 0);
    set.insert(id, motion, 0);
    entries.push_back({motion, id});
  }
  KineticLog log;
  LoggedList<2> list(set, 0, {}, {&log});
  structures::SortedList<2> tuned;
  tuned.assign(entries, 0);
  Simulator simulator(0, list, tuned);
  std::uint64_t swaps = 0;
  int apart = 0;
  while (simulator.step()) {
    ++swaps;
    apart += list.next_time() < tuned.next_time();
    if (swaps % 2 == 0) apart += list.next_time() != tuned.next_time();
  }
  CHECK(apart == 0);
  CHECK(swaps == 2 * log.size());
  const Measures m = list.measures();
  CHECK(m.events == log.size());
  CHECK(m.events > n);
  CHECK(m.external == m.events);  // efficient: every event is a change of the order
  CHECK(m.most_touched == 3);     // responsive
  CHECK(m.touched <= 3 * m.events);
  CHECK(m.most_per_element == 2);  // local
  CHECK(m.held == n - 1);          // compact
  CHECK(m.most_held == n - 1);
  CHECK(list.counters().events == m.events);
  Measures same = tuned.measures();
  CHECK(same.touched <= m.touched);  // a rule may mark the last place, which has no certificate
  same.touched = m.touched;
  CHECK(same == m);
}

TEST_CASE("several structures share one set, and each hears of each edit", "[framework]") {
  MovingSet<Motion<1>> set;
  KineticLog first_log, second_log;
  LoggedList<1> first(set, 0, {}, {&first_log});
  set.insert(7, {{{0, 1}}, 0}, 0);
  LoggedList<1> second(set, 0, {}, {&second_log});  // Comes later, and takes up what is there.
  set.insert(3, {{{2, 0}}, 0}, 0);
  Simulator simulator(0, first, second);
  CHECK(first.rule().order == std::vector<Id>{7, 3});
  CHECK(second.rule().order == std::vector<Id>{7, 3});
  CHECK(first.next_time() == 2);
  simulator.advance_to(5);
  CHECK(first.rule().order == std::vector<Id>{3, 7});
  CHECK(first_log.size() == 1);
  CHECK(first_log == second_log);
  set.update(7, {{{-1, 0}}, 5}, 5);
  CHECK(second.rule().order == std::vector<Id>{7, 3});
  set.remove(3, 5);
  CHECK(first.rule().order == std::vector<Id>{7});
  CHECK(set.size() == 1);
  simulator.audit();
}

// --- errors of use

TEST_CASE("a set refuses what cannot be, and changes nothing", "[framework]") {
  MovingSet<Motion<1>> set;
  KineticLog log;
  LoggedList<1> list(set, 0, {}, {&log});
  set.insert(0, {{{0, 1}}, 0}, 0);
  set.insert(1, {{{1, 0}}, 0}, 0);
  Simulator simulator(0, list);
  CHECK_THROWS_WITH(set.insert(1, {}, 0), "MovingSet: id 1 is used twice");
  CHECK_THROWS_AS(set.insert(nobody, {}, 0), std::invalid_argument);
  CHECK_THROWS_WITH(set.update(4, {}, 0), "MovingSet: no element with id 4");
  CHECK_THROWS_AS(set.remove(4, 0), std::out_of_range);
  CHECK_THROWS_WITH(set.update(1, {{{std::nan(""), 0}}, 0}, 0), "MovingSet: the motion of id 1 is not finite");
  CHECK_THROWS_AS(set.insert(5, {}, never), std::invalid_argument);
  // The two meet at 1: an edit at 2 would be one of a state that is not right.
  CHECK_THROWS_WITH(set.insert(5, {}, 2), Catch::Contains("would pass over an event at 1"));
  simulator.advance_to(3);
  CHECK_THROWS_AS(set.insert(5, {}, 0.5), std::logic_error);
  CHECK(set.size() == 2);
  CHECK(list.rule().order == std::vector<Id>{1, 0});
  simulator.audit();
}

namespace {

/// Edits the elements from within repair(), as it must not.
struct Meddler : ListRule<Motion<1>> {
  MovingSet<Motion<1>>* set;
  Effect repair(Slot slot, Repair<Motion<1>, Change>& repair) {
    set->remove(0, repair.now());
    return ListRule<Motion<1>>::repair(slot, repair);
  }
};

/// Turns an element round at each swap, as it may.
struct TurnRound {
  MovingSet<Motion<1>>* set;
  int edits = 0;
  void operator()(const ListRule<Motion<1>>&, const KineticEvent& event) {
    ++edits;
    Motion<1> motion = restarted((*set)[0], event.time);
    motion.position.c[1] = -motion.position.c[1];
    set->update(0, motion, event.time);
  }
};

}  // namespace

TEST_CASE("a rule may not edit the elements, a listener may", "[framework]") {
  MovingSet<Motion<1>> set;
  set.insert(0, {{{0, 1}}, 0}, 0);
  set.insert(1, {{{1, 0}}, 0}, 0);
  set.insert(2, {{{-1, 0}}, 0}, 0);
  {
    Meddler rule;
    rule.set = &set;
    Kinetic<Meddler> list(set, 0, rule);
    CHECK_THROWS_AS(list.process(), std::logic_error);
  }
  Kinetic<ListRule<Motion<1>>, TurnRound> list(set, 0, {}, {&set});
  Simulator simulator(0, list);
  while (simulator.step(20)) simulator.audit();
  CHECK(list.listener().edits >= 2);
  CHECK(set[0].start > 0);
}

TEST_CASE("a structure of none and of one has no events", "[framework]") {
  MovingSet<Motion<1>> set;
  KineticLog log;
  LoggedList<1> list(set, 0, {}, {&log});
  Simulator simulator(0, list);
  CHECK_FALSE(simulator.step());
  CHECK(list.measures() == Measures{});
  set.insert(9, {{{0, 1}}, 0}, 0);
  CHECK(list.next_time() == never);
  CHECK(list.measures().held == 0);
  simulator.audit();
  set.remove(9, 0);
  CHECK(list.rule().order.empty());
  simulator.audit();
}

TEST_CASE("an audit finds a clock that has run past an event", "[framework]") {
  MovingSet<Motion<1>> set;
  set.insert(0, {{{0, 1}}, 0}, 0);
  set.insert(1, {{{1, 0}}, 0}, 0);
  KineticLog log;
  LoggedList<1> list(set, 0, {}, {&log});
  CHECK_NOTHROW(list.audit(1));
  CHECK_THROWS_WITH(list.audit(2), Catch::Contains("ListRule: slot 0"));
  list.process();
  CHECK_NOTHROW(list.audit(2));
  CHECK_THROWS_AS(list.audit(0), AuditFailure);
}

TEST_CASE("a repair that repairs nothing is named", "[framework]") {
  struct Idle : ListRule<Motion<1>> {
    Effect repair(Slot, Repair<Motion<1>, Change>&) { return Effect::external; }
  };
  MovingSet<Motion<1>> set;
  Kinetic<Idle> list(set, 0);
  set.insert(4, {{{0, 1}}, 0}, 0);
  set.insert(7, {{{1, 0}}, 0}, 0);
  Simulator simulator(0, list);
  CHECK_THROWS_WITH(simulator.advance_to(5),
                    Catch::Contains("ListRule: slot 4: repair() does not end: it has been called 1009 times at 1"));
}

TEST_CASE("a right rule may repair as often as it has pairs, at one time", "[framework]") {
  const Id n = 100;
  std::uint64_t at_once = 0;
  const auto count = [&](const ListRule<Motion<1>>&, const KineticEvent& event) {
    at_once += event.time == 0x1p52 + 1;
  };
  MovingSet<Motion<1>> late;  // all meet half a second after a clock whose doubles are a second apart
  for (Id id = 0; id < n; ++id) late.insert(id, {{{0.0 + id, -2.0 * id}}, 0x1p52}, 0x1p52);
  Kinetic<ListRule<Motion<1>>, decltype(count)> reversed(late, 0x1p52, {}, count);
  Simulator simulator(0x1p52, reversed);
  simulator.advance_to(0x1p52 + 1);
  simulator.audit();
  CHECK(at_once == n * (n - 1) / 2);
}

}  // namespace test_framework
