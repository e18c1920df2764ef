// You learn: to keep a Delaunay triangulation in space, and what its proof consists of.
// How to run: build/dev/examples/13_delaunay_in_space, then open the page that it names
// What you see: the triangulation was that of points at rest after every event
#include "examples/course/facts.hpp"
#include "examples/course/mesh_edges.hpp"
#include "kds/framework/kinetic.hpp"
#include "kds/simulator.hpp"
#include "structures/spatial_triangulation.hpp"

#include <cstdint>
#include <iostream>
#include <random>
#include <stdexcept>
#include <string>

using namespace kds;
using Path = certificates::PointMotion<1>;
using Delaunay = structures::SpatialDelaunayRule<Path>;

/// How many tetrahedra there are between points.
std::size_t tetrahedra(const Delaunay& delaunay) {
  std::size_t count = 0;
  for (std::uint32_t t = 0; t < delaunay.mesh().end_tetrahedron(); ++t) {
    count += delaunay.mesh().in_use(t) && delaunay.mesh().finite(t);
  }
  return count;
}

int main(int argc, char** argv) {
  const double end = 10;
  course::Page page(course::View::space, "13 Delaunay triangulation in space",
                    "No point is inside the sphere through the corners of a tetrahedron. Where five points come onto one "
                    "sphere, two tetrahedra become three, or three two: an edge comes or goes. Drag to look around.",
                    0, end);
  page.legend.edges = "an edge";
  page.play_time = 30;

  // Straight paths, each from a random place of the unit cube most of the way to another.
  MovingSet<Path> points;
  std::mt19937 random(5);
  const auto place = [&] {
    const double x = random() * 0x1p-32, y = random() * 0x1p-32, z = random() * 0x1p-32;
    return Eigen::Vector3d(x, y, z);
  };
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d from = place(), to = place();
    const Path path = Path::line(from, (to - from) * 0.8 / end);
    const Id id = points.add(path, 0);
    page.element(id, std::string(1, static_cast<char>('a' + id)));
    page.moves(id, path, 0);
  }

  const auto known = [&](const Delaunay& delaunay, double now) {
    const course::Edges edges = course::edges_of(delaunay.mesh());
    const Slot slots = Delaunay::stride * delaunay.mesh().end_tetrahedron();
    return course::State{.text = std::to_string(tetrahedra(delaunay)) + " tetrahedra, " +
                                 std::to_string(edges.size()) + " edges",
                         .edges = edges,
                         .certificates = course::certificates_of(delaunay, slots, points, now, page)};
  };
  course::Edges before;
  int flips = 0;
  const auto happened = [&](const Delaunay& delaunay, const KineticEvent& event) {
    const course::Edges after = course::edges_of(delaunay.mesh());
    auto [text, members] = course::change_of(before, after, page);
    flips += !text.empty();
    if (text.empty()) text = "a facet or edge of the hull turns";
    page.event(event.time, text, members, known(delaunay, event.time));
    before = after;
  };

  Kinetic<Delaunay, decltype(happened)> delaunay(points, 0, {}, happened);
  Simulator simulator(0, delaunay);
  before = course::edges_of(delaunay.rule().mesh());
  page.starts(known(delaunay.rule(), 0));
  while (simulator.step(end)) {
    // The triangulation is unique, so one that is built at this time from nothing has the same edges.
    if (simulator.next_time() == simulator.now()) continue;
    const Kinetic<Delaunay> anew(points, simulator.now());
    if (course::edges_of(anew.rule().mesh()) != before) throw std::logic_error("the triangulation is another");
  }
  simulator.audit();
  const Measures measures = delaunay.measures();
  std::cout << measures.events << " events, in " << flips << " of them edges come or go; at most " << measures.most_held
            << " certificates\nthe triangulation was that of points at rest after every event\n";
  page.standings = {course::standing::delaunay_in_space(measures)};
  page.write(argc, argv, "13_delaunay_in_space");
}
