// You learn: two structures that keep the greatest of moving values, and that one question has several proofs.
// How to run: build/dev/examples/05_tournament, then open the page that it names
// What you see: tournament and heap agree: f, d, b, e, c, f
#include "examples/course/facts.hpp"
#include "examples/course/structure_drawings.hpp"
#include "kds/framework/kinetic.hpp"
#include "kds/simulator.hpp"
#include "structures/heap.hpp"
#include "structures/tournament.hpp"

#include <iostream>
#include <string>
#include <vector>

using namespace kds;
using HeapRule = structures::HeapRule<structures::ByValue<Motion<2>>>;

int main(int argc, char** argv) {
  course::Page page(course::View::line, "05 Who is the highest",
                    "The highest of some rockets. A heap keeps nobody above its parent: a certificate for each but the "
                    "top; a tournament has one for each match. Most swaps of a sorted list never happen here.",
                    0, 10);
  page.legend.event = "parent and child change places";
  page.legend.marked = "the highest: the upper envelope";
  // Height, speed, half the acceleration; all lit at time 0. The page may give other motions.
  const std::vector<Motion<2>> rockets{
      {{{0.5, 0.3, 0.095}}, 0}, {{{3, 2.4, -0.27}}, 0},   {{{1, 1.4, 0.0}}, 0},
      {{{6, 0.2, -0.1}}, 0},    {{{2.2, 2.3, -0.175}}, 0}, {{{9, -4.6, 0.58}}, 0},
  };

  // The heap is written on the framework and shares a set of elements. The tournament is a structure by itself: the
  // same clock runs both.
  MovingSet<Motion<2>> values;
  structures::Tournament<2> tournament;
  for (const auto& motion : page.motions(argc, argv, rockets)) {
    const Id id = values.add(motion, 0);
    tournament.insert(id, motion, 0);
    page.element(id, std::string(1, static_cast<char>('a' + id)));
    page.moves(id, motion, 0);
  }

  const auto known = [&](const HeapRule& heap, double now) {
    const auto end = static_cast<Slot>(heap.size());
    return course::State{.text = "The highest is " + page.name(*heap.top()),
                         .marked = {*heap.top()},
                         .certificates = course::certificates_of(heap, end, values, now, page)};
  };
  std::string tops;
  const auto moved = [&](const HeapRule& heap, const KineticEvent& event) {
    const Id up = heap.heap()[(event.slot - 1) / 2], down = heap.heap()[event.slot];
    const bool top = event.effect == Effect::external;  // the greatest value has changed, not only its proof
    if (top) tops += ", " + page.name(up);
    page.event(event.time, page.name(up) + (top ? " is the highest now" : " goes above " + page.name(down)), {up, down},
               known(heap, event.time));
  };
  Kinetic<HeapRule, decltype(moved)> heap(values, 0, {}, moved);
  Simulator simulator(0, heap, tournament);
  tops = page.name(*heap.rule().top());
  page.starts(known(heap.rule(), 0));
  const auto draw = [&](double now) {
    page.draws(now, course::drawing_of_heap(heap.rule(), values, now));
    page.draws(now, course::drawing_of_tournament(tournament, now));
  };
  draw(0);

  bool agree = true;
  while (simulator.step(10)) {
    draw(simulator.now());
    // Where the top changes both have events at the same time: they are compared after all events of that time.
    if (simulator.next_time() > simulator.now()) agree = agree && heap.rule().top() == tournament.winner();
  }
  simulator.audit();
  const Measures measures = heap.measures();
  std::cout << "tournament and heap " << (agree ? "agree" : "differ") << ": " << tops << '\n'
            << "heap: " << measures.events << " events, " << measures.external << " changes of the top, at most "
            << measures.most_held << " certificates\n"
            << "tournament: " << tournament.counters().events << " events\n";
  page.standings = {course::standing::heap(measures), course::standing::tournament(tournament.measures())};
  page.write(argc, argv, "05_tournament");
}
