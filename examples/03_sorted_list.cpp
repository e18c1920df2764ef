// You learn: to keep moving values sorted: a certificate for each two neighbours, a swap when one fails.
// How to run: build/dev/examples/03_sorted_list, then open the page that it names
// What you see: 10 swaps later, at t = 8: d e b c a
#include "examples/course/facts.hpp"
#include "examples/list_in_forty_lines.hpp"
#include "kds/framework/kinetic.hpp"
#include "kds/simulator.hpp"

#include <iostream>
#include <string>
#include <vector>

using namespace kds;
using List = examples::ListRule<Motion<2>>;  // the rule that its author writes: 40 lines

int main(int argc, char** argv) {
  course::Page page(course::View::line, "03 The sorted list",
                    "Values, each on a parabola, and their order. Each two neighbours have a certificate, "
                    "lower \u2264 upper. When one fails the two swap, and up to three certificates are new; "
                    "nothing happens in between.", 0, 8);
  page.legend.event = "a swap";

  // The elements. A set of elements has no clock; edits are given their time, here 0. The page may give other motions.
  MovingSet<Motion<2>> values;
  const std::vector<Motion<2>> usual{
      {{{1, 0.2, 0.09}}, 0}, {{{2.5, 1.9, -0.24}}, 0}, {{{4, -0.4, 0.11}}, 0}, {{{5.2, -1.7, 0.14}}, 0},
      {{{7, 0.5, -0.14}}, 0},
  };
  for (const auto& motion : page.motions(argc, argv, usual)) {
    const Id id = values.add(motion, 0);
    page.element(id, std::string(1, static_cast<char>('a' + id)));
    page.moves(id, motion, 0);
  }

  // The state at a time, for the page.
  const auto known = [&](const List& list, double now) {
    return course::State{.text = "Order: " + page.names(list.order),
                         .order = list.order,
                         .certificates = course::certificates_of(list, values.end_id(), values, now, page)};
  };
  int swaps = 0;
  const auto swapped = [&](const List& list, const KineticEvent& event) {
    // The slot is the lower of the two; after the swap it stands above the other.
    const Id up = event.slot, down = list.order[list.place[up] - 1];
    std::cout << "t = " << event.time << ": " << page.name(up) << " passes " << page.name(down) << ", now "
              << page.names(list.order) << '\n';
    page.event(event.time, page.name(up) + " passes " + page.name(down), {up, down}, known(list, event.time));
    ++swaps;
  };

  // The structure takes up the elements of the set; the simulator is the clock.
  Kinetic<List, decltype(swapped)> list(values, 0, {}, swapped);
  Simulator simulator(0, list);
  std::cout << "t = 0: " << page.names(list.rule().order) << '\n';
  page.starts(known(list.rule(), 0));
  simulator.advance_to(8);
  simulator.audit();  // checks every certificate with exact signs; throws if one does not hold

  std::cout << swaps << " swaps later, at t = 8: " << page.names(list.rule().order) << '\n';
  page.standings = {course::standing::sorted_list(list.measures())};
  page.write(argc, argv, "03_sorted_list");
}
