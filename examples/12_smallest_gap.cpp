// You learn: to stand one structure on another: the solution of the exercise in 11.
// How to run: build/dev/examples/12_smallest_gap, then open the page that it names
// What you see: the smallest gap has been checked after every event
#include "examples/course/facts.hpp"
#include "examples/smallest_gap.hpp"
#include "kds/framework/kinetic.hpp"
#include "kds/simulator.hpp"

#include <iostream>
#include <stdexcept>
#include <string>

using namespace kds;
using examples::Narrower;
using examples::SmallestGapRule;
using List = examples::ListRule<Motion<2>>;

/// Whether no gap is smaller: all pairs, by exact signs.
bool right(const SmallestGapRule& rule, const MovingSet<Motion<2>>& x, double now) {
  const auto [low, high] = *rule.pair();
  const auto& order = rule.inner().order;
  for (std::size_t i = 0; i + 1 < order.size(); ++i) {
    if (sign_after(certificates::Order<2>{x[order[i]], x[order[i + 1]]}, now) < 0) return false;
    const bool swapped = rule.inner().place[low] > rule.inner().place[high];
    const Narrower narrower{x[swapped ? high : low], x[swapped ? low : high], x[order[i]], x[order[i + 1]]};
    if (sign_after(narrower, now) < 0) return false;
  }
  return true;
}

int main(int argc, char** argv) {
  const double end = 9;
  course::Page page(course::View::line, "12 The smallest gap",
                    "The two values that are closest to each other. A sorted list knows the neighbours; a tournament "
                    "of their gaps, which stands on it, the smallest. The certificates of both are listed.", 0, end);
  page.legend.event = "a swap, or a match that turns";
  page.legend.marked = "the two that are closest";

  MovingSet<Motion<2>> values;
  const Motion<2> motions[] = {{{{0, 1.3, -0.05}}, 0},  {{{3.2, 0.3, -0.02}}, 0}, {{{4.5, -1, 0.16}}, 0},
                               {{{6.8, 0.5, -0.07}}, 0}, {{{9, -1.8, 0.17}}, 0}};
  for (const auto& motion : motions) {
    const Id id = values.add(motion, 0);
    page.element(id, std::string(1, static_cast<char>('a' + id)));
    page.moves(id, motion, 0);
  }

  const auto known = [&](const SmallestGapRule& rule, double now) {
    const auto [low, high] = *rule.pair();
    auto certificates = course::certificates_of(rule.inner(), values.end_id(), values, now, page);
    for (auto& held : course::certificates_of(rule, rule.end_slot(), values, now, page)) certificates.push_back(held);
    return course::State{.text = "Closest: " + page.name(low) + " and " + page.name(high),
                         .order = rule.inner().order,
                         .marked = {low, high},
                         .certificates = certificates};
  };
  std::string passes;
  const auto passed = [&](const List& list, const KineticEvent& event) {
    passes = page.name(event.slot) + " passes " + page.name(list.order[list.place[event.slot] - 1]);
  };
  // An event without a slot is one of the list, of which the list's own listener has been told before.
  const auto happened = [&](const SmallestGapRule& rule, const KineticEvent& event) {
    const auto [low, high] = *rule.pair();
    std::string text = page.name(low) + " and " + page.name(high) + " are the closest now";
    if (event.effect == Effect::internal) text = "a match is lost, but not the last";
    if (event.slot == no_slot) text = passes;
    page.event(event.time, text, {low, high}, known(rule, event.time));
  };
  Kinetic<List, decltype(passed)> list(values, 0, {}, passed);
  Kinetic<SmallestGapRule, decltype(happened)> gap(list, 0, {}, happened);
  Simulator simulator(0, list, gap);
  page.starts(known(gap.rule(), 0));
  while (simulator.step(end)) {
    simulator.audit();
    if (simulator.next_time() > simulator.now() && !right(gap.rule(), values, simulator.now())) {
      throw std::logic_error("there is a smaller gap");
    }
  }
  const Measures measures = gap.measures();
  std::cout << measures.followed + measures.events << " events, " << measures.external << " of them another pair\n"
            << "the smallest gap has been checked after every event\n";
  page.standings = {course::standing::smallest_gap(measures)};
  page.write(argc, argv, "12_smallest_gap");
}
