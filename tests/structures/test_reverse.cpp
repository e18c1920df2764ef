// Time that runs backwards, and a past with edits: against the exact order, and against the run forward.
#include "certificates/plane_motion.hpp"
#include "certificates/point_motion.hpp"
#include "examples/list_in_forty_lines.hpp"
#include "kds/framework/history.hpp"
#include "kds/framework/reverse.hpp"
#include "kds/pieces.hpp"
#include "structures/closest_pair.hpp"
#include "structures/convex_hull.hpp"
#include "structures/delaunay.hpp"
#include "structures/heap.hpp"
#include "structures/sorted_list.hpp"
#include "structures/tournament.hpp"
#include "tests/structures/random_values.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <tuple>
#include <vector>

namespace test_reverse {
namespace {

using namespace kds;
using namespace kds::tests;
using certificates::PlaneMotion;
using examples::ListRule;

/// Two that changed places, and when, in time that runs forward.
struct Swap {
  Id low, high;
  double time;
  friend bool operator<(const Swap& a, const Swap& b) {
    return std::tie(a.low, a.high, a.time) < std::tie(b.low, b.high, b.time);
  }
};

template <int Degree>
struct ToSwaps {
  const MovingSet<Motion<Degree>>* set;
  std::vector<Swap>* log;
  void operator()(const ListRule<Motion<Degree>>& rule, const KineticEvent& event) const {
    const Id a = event.slot, b = rule.order[rule.place[a] - 1];  // the slot is that of the one that stood left
    log->push_back({std::min(a, b), std::max(a, b), set->backwards() ? -event.time : event.time});
  }
};

std::uint32_t no_rank(std::uint32_t) { return 0; }

template <int Degree>
Model<Degree> model_of(const MovingSet<Motion<Degree>>& set) {
  Model<Degree> model;
  for (const Id id : set.ids()) model.motions[id] = set[id];
  return model;
}

/// There and back again, by steps; the number of things that were wrong.
template <int Degree>
int mistakes_of_lists(std::uint64_t seed, Kind kind, double window) {
  Random random(seed);
  MovingSet<Motion<Degree>> set;
  const double start = beginning(kind);
  structures::SortedList<Degree> tuned;
  structures::Tournament<Degree> tournament;
  for (Id id = 0; id < 12; ++id) {
    const auto motion = id > 0 && random.one_in(5) ? set[id - 1] : random_motion<Degree>(random, kind, start);
    set.insert(id, motion, start);
    tuned.insert(id, motion, start);
    tournament.insert(id, motion, start);
  }
  std::vector<Swap> log;
  Kinetic<ListRule<Motion<Degree>>, ToSwaps<Degree>> list(set, start, {}, {&set, &log});
  Kinetic<structures::HeapRule<structures::ByValue<Motion<Degree>>>> heap(set, start);
  Simulator simulator(start, list, tuned, tournament, heap);
  if (window < never) simulator.set_window(window);
  const std::vector<Id> first = list.rule().order;
  int wrong = 0;
  const auto compare = [&] {
    const auto model = model_of(set);
    const auto order = model.order(simulator.now(), no_rank);
    wrong += list.rule().order != order;
    for (std::size_t i = 0; i < order.size(); ++i) wrong += tuned.entries()[i].id != order[i];
    wrong += tournament.winner() != model.greatest(simulator.now());
    const certificates::Order<Degree> beaten{set[order.back()], set[*heap.rule().top()]};
    wrong += exact_sign(beaten, simulator.now()) != 0;  // one with the greatest, or the greatest itself
    simulator.audit();
  };
  const auto go_to = [&](double t) {
    while (simulator.step(t)) {
      simulator.audit();
      if (simulator.next_time() > simulator.now()) compare();
      if (log.size() > 10000) return void(++wrong);
    }
    simulator.advance_to(t);
    compare();
  };
  const double end = start + (kind == Kind::coarse ? 10 : kind == Kind::lattice || kind == Kind::resting ? 3 : 1.7);
  go_to(end);
  std::vector<Swap> forward = log;
  reverse(simulator, set);
  wrong += simulator.now() != -end;
  wrong += time_of(simulator, set) != end;
  log.clear();
  go_to(-start);
  std::vector<Swap> backward = log;
  // Within [start, end): those just after the start are undone last of all; what happened at the end and the start
  // themselves is on one side of them forward, on the other side backward.
  const auto inner = [&](std::vector<Swap>& swaps) {
    std::erase_if(swaps, [&](const Swap& s) { return s.time <= start || s.time >= end; });
    std::sort(swaps.begin(), swaps.end());
  };
  inner(forward);
  inner(backward);
  if (kind == Kind::coarse) forward = backward = {};  // Most swaps are within a spacing of doubles from an end.
  wrong += forward.size() != backward.size();
  for (std::size_t i = 0; i < std::min(forward.size(), backward.size()); ++i) {
    const Swap f = forward[i], b = backward[i];
    wrong += f.low != b.low || f.high != b.high || !(b.time == f.time || next_up(b.time) == f.time);
  }
  reverse(simulator, set);
  go_to(start);
  wrong += list.rule().order != first;
  go_to(end);
  return wrong;
}

}  // namespace

TEST_CASE("a reversed motion is the motion at the negative time, exactly", "[reverse]") {
  Random random(800);
  int wrong = 0;
  for (const Kind kind : all_kinds) {
    for (int i = 0; i < 50; ++i) {
      const auto motion = random_motion<3>(random, kind, beginning(kind));
      const auto back = reversed(motion);
      wrong += !(reversed(back) == motion);
      const double t = beginning(kind) + random.between(-2, 2);
      const auto there = about<Exact>(motion, t);
      const auto mirrored = about<Exact>(back, -t);
      for (std::size_t k = 0; k <= 3; ++k) {
        wrong += ((k % 2 == 0 ? there.c[k] - mirrored.c[k] : there.c[k] + mirrored.c[k]).sign()) != 0;
      }
    }
  }
  CHECK(wrong == 0);
  certificates::PointMotion<2> path{{Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(4, 0, 6), Eigen::Vector3d(7, 8, 9)}, 5};
  CHECK(reversed(path).position(-7) == path.position(7));
  CHECK(reversed(path).velocity(-7) == -path.velocity(7));
  CHECK(reversed(reversed(path)) == path);
  CHECK(!std::signbit(reversed(path).coefficients[1][1]));
}

TEMPLATE_TEST_CASE_SIG("lists, heaps and tournaments go back the way they came", "[reverse]", ((int Degree), Degree), 1,
                       2, 3) {
  for (const Kind kind : all_kinds) {
    for (std::uint64_t seed = 810; seed < 816; ++seed) {
      CAPTURE(Degree, static_cast<int>(kind), seed);
      CHECK(mistakes_of_lists<Degree>(seed, kind, seed % 2 == 0 ? 0.3 : never) == 0);
    }
  }
}

TEST_CASE("hull, triangulation and closest pair go back the way they came", "[reverse]") {
  using Path = PlaneMotion<2>;
  for (std::uint64_t seed = 820; seed < 823; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    MovingSet<Path> points;
    const auto coordinate = [&] {
      return Polynomial<2>{{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)}};
    };
    for (Id id = 0; id < 16; ++id) points.insert(id, {{coordinate(), coordinate()}, random.between(-1, 1)}, 0);
    Kinetic<structures::ConvexHullRule<Path>> hull(points, 0);
    Kinetic<structures::DelaunayRule<Path>> delaunay(points, 0);
    Kinetic<structures::ClosestPairRule<Path>> pair(delaunay, 0);
    Simulator simulator(0, hull, delaunay, pair);
    const auto hull_at_first = hull.rule().hull();
    const auto edges = [&] {
      std::vector<std::pair<Id, Id>> result;
      const auto& mesh = delaunay.rule().mesh();
      for (structures::TriangleMesh::Edge h = 0; h < 3 * mesh.end_triangle(); ++h) {
        if (mesh.origin(h) < mesh.target(h)) result.emplace_back(mesh.origin(h), mesh.target(h));
      }
      std::sort(result.begin(), result.end());
      return result;
    };
    const auto edges_at_first = edges();
    const auto closest_at_first = pair.rule().pair();
    const auto events = [&] { return simulator.counters().events; };
    simulator.advance_to(1.5);
    const auto forward = events();
    CHECK(forward > 50);
    reverse(simulator, points);
    int steps = 0;
    while (simulator.step(0)) {
      if (++steps % 8 == 0) simulator.audit();
    }
    simulator.advance_to(0);
    simulator.audit();
    CHECK(hull.rule().hull() == hull_at_first);
    CHECK(edges() == edges_at_first);
    CHECK(pair.rule().pair() == closest_at_first);
    CHECK(delaunay.rule().rebuilds() == 0);
    reverse(simulator, points);
    simulator.advance_to(1.5);
    simulator.audit();
  }
}

TEST_CASE("backwards elements may be edited and saved, and a structure that was left behind says so", "[reverse]") {
  MovingSet<Motion<1>> set;
  set.insert(0, {{{0, 1}}, 0}, 0);
  set.insert(1, {{{1, 0}}, 0}, 0);
  Kinetic<ListRule<Motion<1>>> list(set, 0);
  Kinetic<ListRule<Motion<1>>> left_behind(set, 0);
  Simulator simulator(0, list);
  Simulator other(0, left_behind);
  simulator.advance_to(3);
  other.advance_to(3);
  const Snapshot forward = save(simulator, set);
  reverse(simulator, set);
  const Snapshot back = save(simulator, set);
  CHECK(list.next_time() == -1);
  CHECK_THROWS_WITH(left_behind.extend_horizon(-3, 9), Catch::Contains("turned round without it"));
  other.turn_round();
  set.insert(2, reversed(Motion<1>{{{-5, 0}}, 0}), -3);
  CHECK(list.rule().order == std::vector<Id>{2, 1, 0});
  simulator.advance_to(-0.5);
  CHECK(list.rule().order == std::vector<Id>{2, 0, 1});
  restore(forward, simulator, set);
  CHECK_FALSE(set.backwards());
  CHECK(list.rule().order == std::vector<Id>{1, 0});
  CHECK(list.next_time() == never);
  restore(back, simulator, set);
  CHECK(list.next_time() == -1);
  static_assert(!ReversibleStructure<Pieces<Motion<1>>>);
  static_assert(!Reversible<Bounded>);
}

namespace {

struct Past {
  MovingSet<Motion<2>> set;
  Pieces<Motion<2>> pieces{set};
  Kinetic<ListRule<Motion<2>>> list{set, 0};
  structures::SortedList<2> tuned;
  Simulator<Pieces<Motion<2>>, Kinetic<ListRule<Motion<2>>>, structures::SortedList<2>> simulator{0, pieces, list,
                                                                                                  tuned};
};

}  // namespace

TEST_CASE("a history brings back any earlier state bit for bit, edits and plans included", "[reverse][history]") {
  for (std::uint64_t seed = 830; seed < 836; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    Past past;
    const bool windows = seed % 2 == 0;
    if (windows) past.simulator.set_window(0.4);
    const auto state = [&] { return save(past.simulator, past.set); };
    const auto motion = [&] { return random_motion<2>(random, Kind::generic, past.simulator.now()); };
    History history(1 + random.below(20), past.simulator, past.set);
    struct Moment {
      double time;
      std::uint64_t events;
      Snapshot elements, all;
    };
    std::vector<Snapshot> before;  // each event
    std::vector<Moment> moments;
    int wrong = 0;
    const auto edit = [&](std::size_t choice) {
      const double now = past.simulator.now();
      const Motion<2> next = motion();
      const Id id = past.set.end_id() == 0 ? 0 : static_cast<Id>(random.below(past.set.end_id()));
      history.edit([&past, choice, now, next, id] {
        if (choice == 0) {
          past.tuned.insert(past.set.add(next, now), next, now);
        } else if (choice == 1) {
          past.pieces.plan(id, now + 0.25 + past.pieces.planned(id), next, now);
        } else {
          past.set.update(id, next, now);
          past.tuned.update(id, next, now);
        }
      });
    };
    for (int i = 0; i < 10; ++i) edit(0);
    for (int round = 0; round < 60; ++round) {
      const double target = past.simulator.now() + random.between(0, 0.3);
      for (Snapshot due = state(); history.step(target); due = state()) before.push_back(due);
      history.advance_to(target);
      wrong += before.size() != history.events();
      if (random.one_in(3)) edit(random.below(4));
      moments.push_back({target, history.events(), save(past.set), state()});
      if (random.one_in(6)) {
        for (std::size_t k = random.below(30); k > 0 && history.events() > 0; --k) {
          wrong += !history.step_back();
          wrong += history.events() + 1 != before.size();
          wrong += !(state() == before.back());
          before.pop_back();
        }
        while (!moments.empty() && moments.back().time > past.simulator.now()) moments.pop_back();
        if (!moments.empty() && moments.back().time == past.simulator.now()) moments.pop_back();
      } else if (random.one_in(6) && !moments.empty()) {
        moments.resize(1 + random.below(moments.size()));
        history.roll_back(moments.back().time);
        wrong += history.events() != moments.back().events;
        wrong += !(save(past.set) == moments.back().elements);
        if (!windows) wrong += !(state() == moments.back().all);
        before.resize(history.events());
      }
      past.simulator.audit();
    }
    CHECK(wrong == 0);
    for (int i = 0; i < 40; ++i) history.advance_to(past.simulator.now() + 0.1);
    CHECK(history.snapshots() > 1);
    const double now = past.simulator.now();
    CHECK_THROWS_AS(history.roll_back(now + 1), std::invalid_argument);
    CHECK_THROWS_AS(history.roll_back(-1), std::invalid_argument);
    const std::size_t kept = history.snapshots();
    history.forget_before(now / 2);
    CHECK(history.snapshots() < kept);
    history.roll_back(now / 2);
    past.simulator.audit();
    while (history.step_back()) {
    }
  }
}

TEST_CASE("a history refuses times that are not to be reached before it does anything", "[reverse][history]") {
  Past past;
  past.set.insert(0, {{{0, 1}}, 0}, 0);
  past.set.insert(1, {{{1, 0}}, 0}, 0);
  History history(3, past.simulator, past.set);
  history.advance_to(0.5);
  for (const double t : {never, -never, std::nan(""), 0.25}) {
    CHECK_THROWS_AS(history.advance_to(t), std::invalid_argument);
  }
  CHECK(past.simulator.now() == 0.5);
  CHECK(history.events() == 0);
}

TEST_CASE("a replay that throws is over", "[reverse][history]") {
  Past past;
  History history(10, past.simulator, past.set);
  bool refuses = false;
  for (const double t : {1, 2, 3}) {
    history.advance_to(t);
    history.edit([&] {
      if (refuses) throw std::runtime_error("no more");
    });
  }
  refuses = true;
  CHECK_THROWS_WITH(history.roll_back(2), "no more");
  CHECK_FALSE(history.replaying());
}

}  // namespace test_reverse
