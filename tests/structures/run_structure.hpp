// Runs a structure made of a rule through random edits and advances, with audits, windows and a snapshot.
#pragma once

#include "kds/framework/kinetic.hpp"
#include "kds/framework/snapshot.hpp"
#include "kds/simulator.hpp"
#include "tests/structures/random_values.hpp"
#include "tests/structures/to_log.hpp"

#include <catch2/catch.hpp>

#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

namespace kds::tests {

template <class Element>
Element restarted_at(const Element& element, double t) {
  if constexpr (requires { element.restarted(t); }) {
    return element.restarted(t);
  } else {
    return restarted(element, t);
  }
}

struct RunOptions {
  int steps = 20;
  std::size_t first = 8;  ///< elements at the beginning
  std::size_t most = 16;
  double window = never;
  std::size_t check_one_in = 1;  ///< events of which one is checked
};

/// Makes random edits of random elements (made by `make(random, kind, now)`), and calls check(rule, set, now) when all
/// events of a time are done, which gives the number of things that are wrong; their sum. Half way the run is saved,
/// gone on with, rolled back and gone on with again: what differs counts as wrong as well. The events go into `log`.
template <class Rule, class Make, class Check>
int run_structure(std::uint64_t seed, Kind kind, RunOptions options, const Rule& rule, Make&& make, Check&& check,
                  std::vector<KineticEvent>& log) {
  using Element = typename Rule::Element;
  Random random(seed);
  MovingSet<Element> set;
  const double start = beginning(kind);
  for (std::size_t i = 0; i < options.first; ++i) set.insert(static_cast<Id>(2 * i), make(random, kind, start), start);
  Kinetic<Rule, ToLog> structure(set, start, rule, {&log});
  Simulator simulator(start, structure);
  if (options.window < never) simulator.set_window(options.window);
  int wrong = 0;
  const auto edit = [&](Random& draw) {
    const double now = simulator.now();
    const std::size_t choice = draw.below(5);
    const std::vector<Id> ids = set.ids();
    if (ids.empty() || (choice == 0 && ids.size() < options.most)) {
      Id id = static_cast<Id>(draw.below(2 * options.most));
      while (set.contains(id)) id = static_cast<Id>(draw.below(2 * options.most));
      set.insert(id, !ids.empty() && draw.one_in(4) ? set[ids.front()] : make(draw, kind, now), now);
      return;
    }
    const Id id = ids[draw.below(ids.size())];
    if (choice == 1) return set.remove(id, now);
    if (choice == 2) return set.update(id, set[ids[draw.below(ids.size())]], now);  // one with another for ever
    if (choice == 3) return set.update(id, restarted_at(set[id], now), now);
    set.update(id, make(draw, kind, now), now);
  };
  const auto go_on = [&](Random draw, int steps) {
    for (int step = 0; step < steps; ++step) {
      const double target = simulator.now() + random_delay(draw, kind);
      while (simulator.step(target)) {
        simulator.audit();
        if (simulator.next_time() > simulator.now() && log.size() % options.check_one_in == 0) {
          wrong += check(structure.rule(), set, simulator.now());
        }
        if (log.size() > 100000) return void(++wrong);
      }
      simulator.advance_to(target);
      edit(draw);
      simulator.audit();
      wrong += check(structure.rule(), set, simulator.now());
    }
  };
  wrong += check(structure.rule(), set, start);
  simulator.audit();
  go_on(Random(seed + 1), options.steps / 2);
  const Snapshot middle = save(simulator, set);
  const std::size_t before = log.size();
  go_on(Random(seed + 2), options.steps / 2);
  const std::vector<KineticEvent> first(log.begin() + static_cast<std::ptrdiff_t>(before), log.end());
  const Snapshot end = save(simulator, set);
  log.resize(before);
  restore(middle, simulator, set);
  go_on(Random(seed + 2), options.steps / 2);
  wrong += !std::equal(first.begin(), first.end(), log.begin() + static_cast<std::ptrdiff_t>(before), log.end());
  wrong += !(save(simulator, set) == end);
  return wrong;
}

}  // namespace kds::tests
