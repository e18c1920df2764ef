// You learn: degenerate cases without a tolerance: touches, three at one point, equal for ever, four on a circle.
// How to run: build/dev/examples/08_degeneracies, then open the page that it names
// What you see: 3 events at t = 4, none at t = 2, none between the equal ones
#include "examples/course/facts.hpp"
#include "examples/course/structure_drawings.hpp"
#include "examples/list_in_forty_lines.hpp"
#include "kds/framework/kinetic.hpp"
#include "kds/simulator.hpp"
#include "structures/delaunay.hpp"

#include <iostream>
#include <map>
#include <string>
#include <vector>

using namespace kds;
using List = examples::ListRule<Motion<2>>;
using Path = certificates::PlaneMotion<2>;

/// Four points: how many flips of their triangulation there are, which the page shows under this title.
std::uint64_t flips(const std::vector<Path>& paths, course::Page& page, const std::string& title) {
  MovingSet<Path> points;
  for (const Path& path : paths) points.add(path, 0);
  Kinetic<structures::DelaunayRule<Path>> delaunay(points, 0);
  Simulator simulator(0, delaunay);
  do {
    page.draws(simulator.now(), course::drawing_of_four(title, delaunay.rule(), points, simulator.now()));
  } while (simulator.step(8));
  simulator.audit();
  return delaunay.measures().external;
}

int main(int argc, char** argv) {
  course::Page page(course::View::line, "08 Degeneracies",
                    "The state at t is the one just after t, and its signs are exact. So b may touch a without an "
                    "event (a double root); c, d and e meet in one point and turn round in three swaps of one time; "
                    "f and g are equal for ever and stand in the order of their numbers. Below, four points of the "
                    "plane: while they stay on one circle nothing happens; where they only pass, an edge is flipped.",
                    0, 8);
  page.legend.event = "a swap";
  const std::vector<Motion<2>> usual{
      {{{1, 0, 0}}, 0},      // a is at rest
      {{{2, -1, 0.25}}, 0},  // b: (t - 2)^2 / 4 above a, touches it at t = 2
      {{{8, -1, 0}}, 0},     // c, d, e: all at 4 when t = 4
      {{{4, 0, 0}}, 0},         {{{0.75, 1, -0.046875}}, 0},
      {{{7, 0.5, -0.0625}}, 0},  // f, g: one parabola, written about 0 and about 4
      {{{8, 0, -0.0625}}, 4},
  };
  MovingSet<Motion<2>> values;
  for (const auto& motion : page.motions(argc, argv, usual)) {
    const Id id = values.add(motion, 0);
    page.element(id, std::string(1, static_cast<char>('a' + id)));
    page.moves(id, motion, 0);
  }

  const auto known = [&](const List& list, double now) {
    return course::State{.text = "Order: " + page.names(list.order),
                         .order = list.order,
                         .certificates = course::certificates_of(list, values.end_id(), values, now, page)};
  };
  std::map<double, int> events;
  int of_equals = 0;
  const auto swapped = [&](const List& list, const KineticEvent& event) {
    const Id up = event.slot, down = list.order[list.place[up] - 1];
    ++events[event.time];
    of_equals += up + down == 5 + 6 && up >= 5;
    page.event(event.time, page.name(up) + " passes " + page.name(down), {up, down}, known(list, event.time));
  };
  Kinetic<List, decltype(swapped)> list(values, 0, {}, swapped);
  Simulator simulator(0, list);
  page.starts(known(list.rule(), 0));
  simulator.advance_to(8);
  simulator.audit();
  for (const auto& [time, count] : events) std::cout << "t = " << time << ": events: " << count << '\n';
  std::cout << events[4] << " events at t = 4, " << (events[2] == 0 ? "none" : "some") << " at t = 2, "
            << (of_equals == 0 ? "none" : "some") << " between the equal ones\n";

  // The corners of a growing square stay on one circle: either diagonal is right, so there is no flip. If one corner is
  // faster, it comes to lie outside the circle of the others at t = 4; before, it is inside.
  const Path corner{{Polynomial<2>{{1, 0.25, 0}}, Polynomial<2>{{1, 0.25, 0}}}, 0};
  const auto turned = [](const Path& path, double x, double y) {
    Path result = path;
    for (double& c : result.coordinate[0].c) c *= x;
    for (double& c : result.coordinate[1].c) c *= y;
    return result;
  };
  std::vector<Path> square{corner, turned(corner, -1, 1), turned(corner, -1, -1), turned(corner, 1, -1)};
  const auto flips_of = [&](const std::string& title) {
    return flips(page.motions_of_drawing(argc, argv, title, square), page, title);
  };
  std::cout << "a growing square: " << flips_of("Four on a circle for ever") << " flips\n";
  square[0] = Path{{Polynomial<2>{{0.5, 0.375, 0}}, Polynomial<2>{{0.5, 0.375, 0}}}, 0};
  std::cout << "one corner overtakes the circle of the others at t = 4: " << flips_of("Four on a circle once")
            << " flip\n";
  page.standings = {course::standing::sorted_list(list.measures())};
  page.write(argc, argv, "08_degeneracies");
}
