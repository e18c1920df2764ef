// Not one of these reads a recorded state or event: all start from the motions.
#include "certificates/order.hpp"
#include "collision/broad_phase/box_overlap.hpp"
#include "collision/world.hpp"
#include "examples/smallest_gap.hpp"
#include "kds/framework/kinetic.hpp"
#include "kds/simulator.hpp"
#include "structures/convex_hull.hpp"
#include "structures/delaunay.hpp"
#include "structures/sorted_list.hpp"
#include "structures/spatial_triangulation.hpp"
#include "structures/tournament.hpp"
#include "tests/examples/course/boxes_of_page.hpp"
#include "tests/examples/course/expected_states.hpp"

#include <algorithm>
#include <tuple>

namespace kds::tests {

namespace {

using certificates::Order;
using Path = certificates::PlaneMotion<2>;

/// The tuned list, given the pieces of motion at their seams, run up to t.
Expected sorted(const CoursePage& page, double t) {
  structures::SortedList<2> list;
  const double begin = page.data()["begin"];
  std::vector<std::tuple<double, Id, Motion<2>>> seams;
  for (Id id = 0; id < page.size(); ++id) {
    for (const json& piece : page.pieces(id)) {
      const Motion<2> motion = CoursePage::motion(piece, "y");
      if (&piece == &page.pieces(id)[0]) {
        list.insert(id, motion, begin);
      } else {
        seams.emplace_back(piece["since"], id, motion);
      }
    }
  }
  std::sort(seams.begin(), seams.end(), [](const auto& a, const auto& b) { return std::get<0>(a) < std::get<0>(b); });
  Simulator simulator(begin, list);
  for (const auto& [since, id, motion] : seams) {
    if (since > t) break;
    simulator.advance_to(since);
    list.update(id, motion, since);
  }
  simulator.advance_to(t);
  Expected expected;
  expected.order.emplace();
  for (const auto& entry : list.entries()) expected.order->push_back(entry.id);
  // While pieces are to come the list knows more of failures than it should.
  if (seams.empty()) expected.fails = list.next_time();
  return expected;
}

Expected highest_of_sorted(const CoursePage& page, double t) {
  Expected expected = sorted(page, t);
  expected.marked = std::vector{expected.order->back()};
  return expected;
}

/// The ball is below the ceiling, by the sign of their difference.
Expected sign(const CoursePage& page, double t) {
  Expected expected;
  const Motion<2> ball = page.value(0, t), ceiling = page.value(1, t);
  const bool below = sign_after(Order<2>{ball, ceiling}, t) >= 0;
  expected.text = below ? "f \u2265 0" : "f < 0";
  return expected;
}

/// A tournament that is run up to t.
Expected highest(const CoursePage& page, double t) {
  structures::Tournament<2> tournament;
  const double begin = page.data()["begin"];
  for (Id id = 0; id < page.size(); ++id) tournament.insert(id, page.value(id, begin), begin);
  Simulator simulator(begin, tournament);
  simulator.advance_to(t);
  Expected expected;
  expected.marked = std::vector{*tournament.winner()};
  return expected;
}

MovingSet<Path>& fill(MovingSet<Path>& points, const CoursePage& page, double t) {
  for (Id id = 0; id < page.size(); ++id) points.insert(id, page.path(id, t), t);
  return points;
}

/// Built from nothing at t: no event has had a part in it.
Expected hull(const CoursePage& page, double t) {
  MovingSet<Path> points;
  const Kinetic<structures::ConvexHullRule<Path>> hull(fill(points, page, t), t);
  Expected expected;
  expected.outline = hull.rule().hull();
  return expected;
}

Expected delaunay(const CoursePage& page, double t) {
  MovingSet<Path> points;
  const Kinetic<structures::DelaunayRule<Path>> delaunay(fill(points, page, t), t);
  const auto& mesh = delaunay.rule().mesh();
  Expected expected;
  expected.edges.emplace();
  expected.fails = delaunay.next_time();
  for (structures::TriangleMesh::Edge h = 0; h < 3 * mesh.end_triangle(); ++h) {
    const Id a = mesh.in_use(h / 3) ? mesh.origin(h) : nobody;
    if (a != nobody && mesh.target(h) != nobody && a < mesh.target(h)) expected.edges->emplace_back(a, mesh.target(h));
  }
  std::sort(expected.edges->begin(), expected.edges->end());
  return expected;
}

/// In space, built from nothing at t: it is unique.
Expected delaunay_in_space(const CoursePage& page, double t) {
  using Point = certificates::PointMotion<1>;
  MovingSet<Point> points;
  for (Id id = 0; id < page.size(); ++id) points.insert(id, CoursePage::path_in_space(page.piece(id, t)), t);
  const Kinetic<structures::SpatialDelaunayRule<Point>> delaunay(points, t);
  Expected expected;
  expected.fails = delaunay.next_time();
  expected.edges.emplace();
  for (Id a = 0; a < page.size(); ++a) {
    for (const Id b : delaunay.rule().neighbours(a)) {
      if (a < b && b != nobody) expected.edges->emplace_back(a, b);
    }
  }
  return expected;
}

/// All pairs of boxes, by exact signs.
Expected overlaps(const CoursePage& page, double t) {
  const auto boxes = boxes_of(page, t);
  Expected expected;
  expected.edges.emplace();
  for (Id a = 0; a < boxes.size(); ++a) {
    for (Id b = a + 1; b < boxes.size(); ++b) {
      const collision::BoxOverlap<2> overlap(boxes[a], boxes[b]);
      const auto apart = overlap.separations();
      if (std::all_of(apart.begin(), apart.end(), [&](const auto& side) { return sign_after(side, t) < 0; })) {
        expected.edges->emplace_back(a, b);
      }
    }
  }
  return expected;
}

/// A world of its own, by another broad phase, run up to t at once.
Expected contacts(const CoursePage& page, double t) {
  using namespace collision;
  struct Counter final : WorldListener<2> {
    int contacts = 0;
    void contact(World<2>&, const PairEvent&) override { ++contacts; }
  } counter;
  const auto walls = page.data()["walls"].get<std::vector<double>>();
  WorldOptions options{.response = Response::elastic, .broad_phase = BroadPhaseKind::kinetic_sap};
  options.walls = Walls{{walls[0], walls[1], -2}, {walls[2], walls[3], 2}};
  World<2> world(options, &counter);
  for (Id id = 0; id < page.size(); ++id) {
    const Path path = CoursePage::path(page.pieces(id)[0]);
    const double radius = page.element(id)["radius"];
    certificates::PointMotion<2> motion;
    for (std::size_t i = 0; i <= 2; ++i) motion.coefficients[i] = {path.coordinate[0].c[i], path.coordinate[1].c[i], 0};
    world.add_body({.shape = Sphere{radius}, .motion = {motion}, .mass = radius * radius * radius});
  }
  world.advance_to(t);
  Expected expected;
  for (Id id = 0; id < page.size(); ++id) {
    const auto at = world.motion(id).position(t);
    expected.positions.push_back({at[0], at[1], 0});
  }
  expected.text = std::to_string(counter.contacts) + " contacts";
  return expected;
}

/// The values between the last two elements, which are the borders.
Expected band(const CoursePage& page, double t) {
  Expected expected;
  expected.marked.emplace();
  const Motion<2> low = page.value(page.size() - 2, t), high = page.value(page.size() - 1, t);
  for (Id id = 0; id + 2 < page.size(); ++id) {
    const Motion<2> x = page.value(id, t);
    if (sign_after(Order<2>{low, x}, t) >= 0 && sign_after(Order<2>{x, high}, t) > 0) expected.marked->push_back(id);
  }
  return expected;
}

/// All neighbours of the order, by exact signs.
Expected smallest_gap(const CoursePage& page, double t) {
  Expected expected = sorted(page, t);
  expected.fails.reset();  // of a tournament as well
  std::vector<Motion<2>> x;
  for (const Id id : *expected.order) x.push_back(page.value(id, t));
  std::size_t best = 0;
  for (std::size_t i = 1; i + 1 < x.size(); ++i) {
    if (sign_after(examples::Narrower{x[best], x[best + 1], x[i], x[i + 1]}, t) < 0) best = i;
  }
  expected.marked = std::vector{(*expected.order)[best], (*expected.order)[best + 1]};
  std::sort(expected.marked->begin(), expected.marked->end());
  return expected;
}

}  // namespace

const std::map<std::string, std::function<Expected(const CoursePage&, double)>>& expectations() {
  static const std::map<std::string, std::function<Expected(const CoursePage&, double)>> all{
      {"01_moving_points", sorted},          {"02_one_certificate", sign},  {"03_sorted_list", sorted},
      {"04_your_own_motion", highest_of_sorted}, {"05_tournament", highest},    {"06_convex_hull", hull},
      {"07_delaunay", delaunay},             {"08_degeneracies", sorted},   {"09_sweep_and_prune", overlaps},
      {"10_contacts", contacts},             {"11_your_own_structure", band}, {"12_smallest_gap", smallest_gap},
      {"13_delaunay_in_space", delaunay_in_space}};
  return all;
}

}  // namespace kds::tests
