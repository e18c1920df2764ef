// You learn: to keep the convex hull of moving points, and to tell events of the hull from those of its proof.
// How to run: build/dev/examples/06_convex_hull, then open the page that it names
// What you see: 52 events, 18 changes of the hull
#include "examples/course/arcs.hpp"
#include "examples/course/facts.hpp"
#include "examples/course/mesh_edges.hpp"
#include "kds/framework/kinetic.hpp"
#include "kds/simulator.hpp"
#include "structures/convex_hull.hpp"

#include <algorithm>
#include <iostream>
#include <string>
#include <vector>

using namespace kds;
using Path = certificates::PlaneMotion<2>;
using Hull = structures::ConvexHullRule<Path>;

/// The elements that are in one list and not in the other.
std::vector<Id> without(const std::vector<Id>& ids, const std::vector<Id>& others) {
  std::vector<Id> rest;
  for (const Id id : ids) {
    if (std::find(others.begin(), others.end(), id) == others.end()) rest.push_back(id);
  }
  return rest;
}

int main(int argc, char** argv) {
  const double end = 10;
  course::Page page(course::View::plane, "06 Convex hull",
                    "Points on parabolas, and the rubber band around them. It is proved by a triangulation: every "
                    "triangle turns left, and so does the outline. Most events change only that proof.", 0, end);
  page.legend.outline = "the hull";
  page.legend.edges = "its proof";
  page.play_time = 24;

  MovingSet<Path> points;
  for (const Path& path : page.motions(argc, argv, course::arcs(10, 6, end))) {
    const Id id = points.add(path, 0);
    page.element(id, std::string(1, static_cast<char>('a' + id)));
    page.moves(id, path, 0);
  }

  // Four slots a triangle: its edges, and its area or, outside the hull, where its edge leads.
  const auto known = [&](const Hull& hull, double now) {
    const Slot slots = 4 * hull.mesh().end_triangle();
    return course::State{.text = "The hull: " + page.names(hull.hull()),
                         .outline = hull.hull(),
                         .edges = course::edges_of(hull.mesh()),
                         .certificates = course::certificates_of(hull, slots, points, now, page)};
  };
  std::vector<Id> before;
  int changes = 0;
  const auto happened = [&](const Hull& hull, const KineticEvent& event) {
    const std::vector<Id> after = hull.hull();
    const std::vector<Id> in = without(after, before), out = without(before, after);
    std::string text = "an edge inside is flipped";
    if (!in.empty()) text = page.names(in) + " comes to the hull";
    if (!out.empty()) text = (in.empty() ? "" : text + ", ") + page.names(out) + " leaves it";
    if (!in.empty() || !out.empty()) {
      ++changes;
      std::cout << "t = " << event.time << ": " << text << ": " << page.names(after) << '\n';
    }
    std::vector<Id> members = in;
    members.insert(members.end(), out.begin(), out.end());
    page.event(event.time, text, members, known(hull, event.time));
    before = after;
  };

  Kinetic<Hull, decltype(happened)> hull(points, 0, {}, happened);
  Simulator simulator(0, hull);
  before = hull.rule().hull();
  page.starts(known(hull.rule(), 0));
  while (simulator.step(end)) simulator.audit();  // after each event: exact
  const Measures measures = hull.measures();
  std::cout << measures.events << " events, " << changes << " changes of the hull\n"
            << "an event: " << static_cast<double>(measures.touched) / static_cast<double>(measures.events)
            << " certificates on average, " << measures.most_touched << " at most\n";
  page.standings = {course::standing::convex_hull(measures)};
  page.write(argc, argv, "06_convex_hull");
}
