// Drawings of structures: a heap, a tournament, sorted ends of intervals, a triangulation of four points.
#pragma once

#include "certificates/in_circle.hpp"
#include "certificates/order.hpp"
#include "certificates/plane_motion.hpp"
#include "examples/course/drawing.hpp"
#include "examples/course/mesh_edges.hpp"
#include "examples/course/page.hpp"
#include "kds/framework/kinetic_rule.hpp"
#include "kds/roots/failure_time.hpp"
#include "kds/simulator.hpp"
#include "structures/delaunay.hpp"
#include "structures/sorted_list.hpp"
#include "structures/tournament.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace kds::course {

/// The middle of a node of a complete binary tree whose nodes are numbered from 1, row by row, and the row below the
/// top. Leaves in the last of so many rows are one unit apart.
inline Drawing::Place tree_place(Id element, std::size_t node, int rows) {
  const int row = static_cast<int>(std::bit_width(node)) - 1;
  const double width = static_cast<double>(std::size_t{1} << (rows - 1 - row));
  const auto column = static_cast<double>(node - (std::size_t{1} << row));
  return {.element = element, .x = {(column + 0.5) * width}, .y = {-static_cast<double>(row)}};
}

/// The places of a heap; a link is "the child is not greater than its parent".
template <class HeapRule>
Drawing drawing_of_heap(const HeapRule& heap, const MovingSet<typename HeapRule::Element>& values, double now) {
  Drawing drawing{.title = "Heap"};
  const auto& order = heap.heap();
  const auto rows = static_cast<int>(std::bit_width(order.size()));
  for (std::size_t i = 0; i < order.size(); ++i) {
    drawing.places.push_back(tree_place(order[i], i + 1, rows));
    if (i == 0) continue;
    const auto certificate = heap.certificate(static_cast<Slot>(i), values);
    drawing.join((i - 1) / 2, failure_time(*certificate, now));
  }
  return drawing;
}

/// The matches of a tournament, the final on top, and its entrants; a link to a loser is "it is not greater than the
/// winner".
template <int Degree>
Drawing drawing_of_tournament(const structures::Tournament<Degree>& tournament, double now) {
  Drawing drawing{.title = "Tournament"};
  const int rows = static_cast<int>(std::bit_width(tournament.end_node())) - 1;
  std::vector<std::size_t> place(tournament.end_node());
  for (std::size_t node = 1; node < tournament.end_node(); ++node) {
    const Id winner = tournament.winner_of(node);
    if (winner == nobody) continue;
    place[node] = drawing.places.size();
    drawing.places.push_back(tree_place(winner, node, rows));
    if (node == 1) continue;
    const Id above = tournament.winner_of(node / 2);
    drawing.join(
        place[node / 2],
        above == winner
            ? never
            : failure_time(certificates::Order<Degree>{tournament.motion(winner), tournament.motion(above)}, now));
  }
  return drawing;
}

/// Ends of intervals in their order on an axis. The ends of element i are 2 i, the lower, and 2 i + 1.
template <class SortedList>
Drawing drawing_of_ends(const SortedList& list, int axis, double now) {
  Drawing drawing{
      .title = std::string("Ends on the axis of ") + "xyz"[axis], .kind = Drawing::Kind::ruler, .axis = axis};
  for (const auto& end : list.entries()) {
    const auto i = drawing.places.size();
    drawing.places.push_back({end.id / 2, {static_cast<double>(i)}, {0}, end.id % 2 == 0 ? -1 : 1});
    if (i == 0) continue;
    drawing.join(i - 1, failure_time(certificates::Order{list.entries()[i - 1].motion, end.motion}, now));
  }
  return drawing;
}

/// The ends of boxes on an axis in their order, drawn at each of their swaps until `end`.
template <class Box>
void draw_ends(Page& page, const std::vector<Box>& boxes, int axis, double end) {
  // As sweep and prune has them: of two ends that stay equal, a lower one comes last.
  struct LowerLast : structures::NoSwapListener {
    static std::uint32_t rank(std::uint32_t id) { return ~id & 1; }
  };
  structures::SortedList<decltype(Box::min)::degree, LowerLast> ends;
  for (Id id = 0; id < boxes.size(); ++id) {
    ends.insert(2 * id, boxes[id].min.axis(axis), page.begin());
    ends.insert(2 * id + 1, boxes[id].max.axis(axis), page.begin());
  }
  Simulator simulator(page.begin(), ends);
  do {
    page.draws(simulator.now(), drawing_of_ends(ends, axis, simulator.now()));
  } while (simulator.step(end));
}

/// The triangulation of four points p, q, r and s. While they are corners of a quadrilateral, the link between its
/// triangles is the certificate that the circle through three has not the fourth inside, and that circle is drawn.
template <class Path>
Drawing drawing_of_four(std::string title, const structures::DelaunayRule<Path>& delaunay,
                        const MovingSet<Path>& points, double now) {
  Drawing drawing{.title = std::move(title), .kind = Drawing::Kind::plane};
  for (Id id = 0; id < 4; ++id) {
    const auto x = about<double>(points[id].axis(0), 0).c, y = about<double>(points[id].axis(1), 0).c;
    const std::string name(1, static_cast<char>('p' + id));
    drawing.places.push_back({.x = {x.begin(), x.end()}, .y = {y.begin(), y.end()}, .name = name});
  }
  double fails = never;
  for (Slot slot = 0; slot < 4 * delaunay.mesh().end_triangle(); ++slot) {
    detail::with_certificate(delaunay.certificate(slot, points), [&](const auto& certificate) {
      if constexpr (std::is_same_v<std::decay_t<decltype(certificate)>, certificates::InCircle<Path>>) {
        const double time = failure_time(certificate, now);
        if (!drawing.circle.empty() && time >= fails) return;
        fails = time;
        drawing.circle.clear();
        for (const Path* path : {&certificate.a, &certificate.b, &certificate.c, &certificate.d}) {
          std::size_t id = 0;
          while (&points[static_cast<Id>(id)] != path) ++id;
          drawing.circle.push_back(id);
        }
      }
    });
  }
  const Edges edges = edges_of(delaunay.mesh());
  const auto joined = [&](Id a, Id b) { return std::binary_search(edges.begin(), edges.end(), std::array{a, b}); };
  for (const auto& [a, b] : edges) {
    // The two others are not joined if this edge is between the triangles.
    const Id c = a > 0 ? 0 : b > 1 ? 1 : 2, d = 6 - a - b - c;
    drawing.links.push_back({a, b, edges.size() == 5 && !joined(std::min(c, d), std::max(c, d)) ? fails : never});
  }
  return drawing;
}

}  // namespace kds::course
