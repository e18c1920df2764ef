// You learn: to keep a Delaunay triangulation; its certificates are of degree 8 where points move on parabolas.
// How to run: build/dev/examples/07_delaunay, then open the page that it names
// What you see: 100 flips, 7 other events
#include "examples/course/arcs.hpp"
#include "examples/course/facts.hpp"
#include "examples/course/mesh_edges.hpp"
#include "kds/framework/kinetic.hpp"
#include "kds/simulator.hpp"
#include "structures/delaunay.hpp"

#include <iostream>
#include <string>

using namespace kds;
using Path = certificates::PlaneMotion<2>;
using Delaunay = structures::DelaunayRule<Path>;

int main(int argc, char** argv) {
  const double end = 10;
  course::Page page(course::View::plane, "07 Delaunay triangulation",
                    "No point is inside the circle through the corners of a triangle. Where four points come onto "
                    "one circle, an edge is flipped. The broken circle belongs to the certificate that fails next. "
                    "The lines between Voronoi cells join the middles of such circles.",
                    0, end);
  page.legend.edges = "an edge";
  page.play_time = 30;

  MovingSet<Path> points;
  for (const Path& path : page.motions(argc, argv, course::arcs(11, 71, end))) {
    const Id id = points.add(path, 0);
    page.element(id, std::string(1, static_cast<char>('a' + id)));
    page.moves(id, path, 0);
  }

  const auto known = [&](const Delaunay& delaunay, double now) {
    const Slot slots = 4 * delaunay.mesh().end_triangle();
    const course::Edges edges = course::edges_of(delaunay.mesh());
    return course::State{.text = std::to_string(edges.size()) + " edges, hull: " + page.names(delaunay.hull()),
                         .outline = delaunay.hull(),
                         .edges = edges,
                         .triangles = course::triangles_of(delaunay.mesh()),
                         .certificates = course::certificates_of(delaunay, slots, points, now, page)};
  };
  course::Edges before;
  const auto flipped = [&](const Delaunay& delaunay, const KineticEvent& event) {
    const course::Edges after = course::edges_of(delaunay.mesh());
    auto [text, members] = course::change_of(before, after, page);
    if (text.empty()) text = "a hull edge leads another way";
    page.event(event.time, text, members, known(delaunay, event.time));
    before = after;
  };

  Kinetic<Delaunay, decltype(flipped)> delaunay(points, 0, {}, flipped);
  Simulator simulator(0, delaunay);
  before = course::edges_of(delaunay.rule().mesh());
  page.starts(known(delaunay.rule(), 0));
  while (simulator.step(end)) simulator.audit();

  const Measures measures = delaunay.measures();
  std::cout << measures.external << " flips, " << measures.events - measures.external << " other events, at most "
            << measures.most_held << " certificates\n";
  page.standings = {course::standing::delaunay(measures)};
  page.write(argc, argv, "07_delaunay");
}
