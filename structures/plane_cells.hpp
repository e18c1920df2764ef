// The cells into which segments and lines divide the plane.
#pragma once

#include "kds/arithmetic/exact.hpp"
#include "kds/audit.hpp"
#include "structures/box_tree.hpp"
#include "structures/line_crossing.hpp"
#include "structures/tree_box.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace kds::structures {

/// A closed segment, or a whole line, that divides the plane.
struct Divider {
  Id id;              ///< the caller's name for it
  DirectedLine line;  ///< that it is on
  /// Its two ends, in any order; a segment of no length divides nothing. None: the whole line.
  std::optional<std::array<LinePoint, 2>> ends{};
  TreeBox<2> box{};  ///< contains the segment: of a line nothing is asked
};

/// The planar subdivision that segments and lines make, in any position: they may cross, touch, meet in one point, lie
/// on one another or be the same. Vertices are where two of them meet, and the ends of segments; edges lie between
/// neighbouring vertices of a divider, each once. What a line has beyond its outermost vertices divides no cell from
/// another here. A cell is a connected part of what is left of the plane; its border is a loop of edges around it and
/// one around each group of dividers within it. An edge that ends within a cell is in its loop on both sides.
///
/// Half-edges are numbered such that 2 e and 2 e + 1 are the two of an edge; each has its cell to the left.
///
/// All is decided exactly. (A doubly connected edge list, with the cells around groups found by a sweep: [deBerg08]
/// chapter 2.) Cost: for n segments whose boxes overlap in k pairs, and m lines, O((n + k + m (n + m)) log
/// n).
class PlaneCells {
 public:
  using Index = std::uint32_t;
  static constexpr Index outside = 0;  ///< the cell without bound

  /// One side of an edge.
  struct HalfEdge {
    Index from;  ///< vertex
    Index next;  ///< in the loop
    Index cell;
    Index divider;  ///< place in dividers()
  };

  explicit PlaneCells(std::vector<Divider> dividers);

  const std::vector<Divider>& dividers() const { return dividers_; }
  /// From left to right, and from below to above where x is the same.
  const std::vector<LinePoint>& vertices() const { return vertices_; }
  const std::vector<HalfEdge>& half_edges() const { return half_edges_; }
  std::size_t edges() const { return half_edges_.size() / 2; }
  Index to(Index half_edge) const { return half_edges_[half_edge ^ 1].from; }
  /// The number of cells, `outside` included.
  std::size_t size() const { return loops_.size(); }
  /// One half-edge of each loop of a cell: of the one around it, counter-clockwise, which `outside` has not, and of
  /// those around groups of dividers within it, clockwise.
  const std::vector<Index>& loops(Index cell) const { return loops_[cell]; }

  /// The half-edges of a loop, in order.
  std::vector<Index> loop(Index half_edge) const;
  /// The area of a cell; of `outside` the negative of all that is within. Less than n 2^-bits off, n being the number
  /// of half-edges of its loops.
  Exact area(Index cell, int bits) const;

  /// Throws AuditFailure unless vertices are in order, edges on their lines, directions around each vertex
  /// counter-clockwise, loops closed and in one cell, and V - E + F = 1 + the number of connected groups.
  void audit() const;

 private:
  static constexpr Index none = std::numeric_limits<Index>::max();

  /// An edge leads from left to right, or up; `line` likewise.
  const DirectedLine& line(Index edge) const { return dividers_[half_edges_[2 * edge].divider].line; }
  bool is_within(const LinePoint& point, const Divider& divider) const {
    return !divider.ends || (order((*divider.ends)[0], point) <= 0 && order(point, (*divider.ends)[1]) <= 0);
  }
  void direct();
  void find_vertices();
  void meet(Index a, Index b, std::vector<std::pair<LinePoint, Index>>& found) const;
  void join_edges(const std::vector<std::vector<Index>>& of_divider);
  void link();
  void find_cells();

  std::vector<Divider> dividers_;
  std::vector<LinePoint> vertices_;
  std::vector<HalfEdge> half_edges_;
  std::vector<std::vector<Index>> around_;  ///< of each vertex, the half-edges from there, counter-clockwise
  std::vector<std::vector<Index>> loops_;   ///< of each cell
};

// ---------------------------------------------------------------------------------------------------------------

inline PlaneCells::PlaneCells(std::vector<Divider> dividers) : dividers_(std::move(dividers)) {
  direct();
  find_vertices();
  link();
  find_cells();
}

/// Leaves out what has no length, and lets lines lead from left to right, or up.
inline void PlaneCells::direct() {
  std::erase_if(dividers_, [](const Divider& divider) {
    const auto& v = divider.line.direction;
    return (v[0] == 0 && v[1] == 0) || (divider.ends && order((*divider.ends)[0], (*divider.ends)[1]) == 0);
  });
  for (Divider& divider : dividers_) {
    auto& v = divider.line.direction;
    if (v[0] < 0 || (v[0] == 0 && v[1] < 0)) v = {-v[0], -v[1]};
    if (!divider.ends) continue;
    auto& [first, last] = *divider.ends;
    if (order(first, last) > 0) std::swap(first, last);
  }
}

/// Adds the vertices that two dividers have in common, and with them on which they are.
inline void PlaneCells::meet(Index a, Index b, std::vector<std::pair<LinePoint, Index>>& found) const {
  const Divider &p = dividers_[a], &q = dividers_[b];
  const auto add = [&](const LinePoint& point) {
    if (!is_within(point, p) || !is_within(point, q)) return;
    found.emplace_back(point, a);
    found.emplace_back(point, b);
  };
  if (turn(p.line, q.line) != 0) return add(LinePoint::crossing(p.line, q.line));
  for (const Divider* divider : {&p, &q}) {
    if (!divider->ends || side((*divider->ends)[0], divider == &p ? q.line : p.line) != 0) continue;
    for (const LinePoint& end : *divider->ends) add(end);
  }
}

inline void PlaneCells::find_vertices() {
  std::vector<std::pair<LinePoint, Index>> found;  // a point, and a divider that it is on
  BoxTree<TreeBox<2>> tree;
  const auto count = static_cast<Index>(dividers_.size());
  for (Index i = 0; i < count; ++i) {
    if (!dividers_[i].ends) {
      for (Index j = 0; j < count; ++j) {
        if (dividers_[j].ends || j < i) meet(i, j, found);
      }
      continue;
    }
    for (const LinePoint& end : *dividers_[i].ends) found.emplace_back(end, i);
    tree.visit(dividers_[i].box, [&](Id j) { meet(i, j, found); });
    tree.insert(i, dividers_[i].box);
  }
  std::vector<Index> in_order(found.size());
  for (Index i = 0; i < in_order.size(); ++i) in_order[i] = i;
  std::sort(in_order.begin(), in_order.end(),
            [&](Index a, Index b) { return order(found[a].first, found[b].first) < 0; });
  std::vector<std::vector<Index>> of_divider(dividers_.size());
  for (const Index i : in_order) {
    if (vertices_.empty() || order(vertices_.back(), found[i].first) != 0) vertices_.push_back(found[i].first);
    std::vector<Index>& on = of_divider[found[i].second];
    const auto vertex = static_cast<Index>(vertices_.size() - 1);
    if (on.empty() || on.back() != vertex) on.push_back(vertex);
  }
  join_edges(of_divider);
}

/// Edges lie between neighbouring vertices of a divider; of those that are the same, the first one's stays. Vertices of
/// no edge, where lines cross that meet nothing else, are left out.
inline void PlaneCells::join_edges(const std::vector<std::vector<Index>>& of_divider) {
  std::vector<std::array<Index, 3>> edges;  // from, to, divider
  for (Index i = 0; i < of_divider.size(); ++i) {
    for (std::size_t k = 1; k < of_divider[i].size(); ++k) edges.push_back({of_divider[i][k - 1], of_divider[i][k], i});
  }
  std::sort(edges.begin(), edges.end());
  const auto same = [](const auto& a, const auto& b) { return a[0] == b[0] && a[1] == b[1]; };
  edges.erase(std::unique(edges.begin(), edges.end(), same), edges.end());
  std::vector<Index> number(vertices_.size(), none);
  for (const auto& [from, to, divider] : edges) number[from] = number[to] = 0;
  Index count = 0;
  for (Index i = 0; i < vertices_.size(); ++i) {
    if (number[i] == none) continue;
    if (count != i) vertices_[count] = std::move(vertices_[i]);
    number[i] = count++;
  }
  vertices_.erase(vertices_.begin() + count, vertices_.end());
  for (const auto& [from, to, divider] : edges) {
    half_edges_.push_back({number[from], none, none, divider});
    half_edges_.push_back({number[to], none, none, divider});
  }
}

/// Sorts half-edges around vertices, and finds the next of each: at its end, the one clockwise of where it comes from.
inline void PlaneCells::link() {
  around_.resize(vertices_.size());
  for (Index h = 0; h < half_edges_.size(); ++h) around_[half_edges_[h].from].push_back(h);
  for (std::vector<Index>& around : around_) {
    // Even ones lead to the right, or up; odd ones to the left, or down. Within a half-plane `turn` is an order.
    std::sort(around.begin(), around.end(),
              [&](Index a, Index b) { return a % 2 != b % 2 ? a % 2 < b % 2 : turn(line(a / 2), line(b / 2)) > 0; });
    for (std::size_t k = 0; k < around.size(); ++k) {
      half_edges_[around[(k + 1) % around.size()] ^ 1].next = around[k];
    }
  }
}

/// Each loop is around a cell, or, clockwise, around a connected group of edges. The latter has the half-plane to the
/// left of the group's first vertex on its left. What is just below that vertex tells in which cell the group is.
inline void PlaneCells::find_cells() {
  struct Below {
    using is_transparent = void;
    const PlaneCells* cells;
    bool operator()(Index a, Index b) const {
      if (a == b) return false;
      const Index from_a = cells->half_edges_[2 * a].from, from_b = cells->half_edges_[2 * b].from;
      if (from_a == from_b) return turn(cells->line(a), cells->line(b)) > 0;
      return from_a < from_b ? side(cells->vertices_[from_b], cells->line(a)) > 0
                             : side(cells->vertices_[from_a], cells->line(b)) < 0;
    }
    bool operator()(Index edge, const LinePoint& point) const { return side(point, cells->line(edge)) > 0; }
    bool operator()(const LinePoint& point, Index edge) const { return side(point, cells->line(edge)) < 0; }
  };
  loops_.resize(1);
  const auto take = [&](Index half_edge, Index cell) {
    loops_[cell].push_back(half_edge);
    for (const Index h : loop(half_edge)) half_edges_[h].cell = cell;
  };
  std::set<Index, Below> crossed(Below{this});  // edges at the place of the sweep, from below to above
  for (Index vertex = 0; vertex < vertices_.size(); ++vertex) {
    const std::vector<Index>& around = around_[vertex];
    for (const Index h : around) {
      if (h % 2 == 1) crossed.erase(h / 2);
    }
    if (around.back() % 2 == 0 && half_edges_[around.back()].cell == none) {
      // The first vertex of a group: loops that have been found before have taken in all that lead from another.
      const auto above = crossed.lower_bound(vertices_[vertex]);
      take(around.back(), above == crossed.begin() ? outside : half_edges_[2 * *std::prev(above)].cell);
    }
    for (const Index h : around) {
      if (half_edges_[h].cell == none) {
        loops_.emplace_back();
        take(h, static_cast<Index>(loops_.size() - 1));
      }
      if (h % 2 == 0) crossed.insert(h / 2);
    }
  }
}

inline std::vector<PlaneCells::Index> PlaneCells::loop(Index half_edge) const {
  std::vector<Index> result;
  Index h = half_edge;
  do {
    result.push_back(h);
    h = half_edges_[h].next;
  } while (h != half_edge);
  return result;
}

inline Exact PlaneCells::area(Index cell, int bits) const {
  Exact twice;
  for (const Index first : loops_[cell]) {
    for (const Index h : loop(first)) {
      const RatioPoint<Exact>&a = vertices_[half_edges_[h].from].exact(), &b = vertices_[to(h)].exact();
      twice = twice + truncated_quotient(a.x * b.y - a.y * b.x, a.w * b.w, bits);
    }
  }
  return scaled(twice, -1);
}

inline void PlaneCells::audit() const {
  const auto fail = [](const std::string& what) { throw AuditFailure("PlaneCells: " + what); };
  for (std::size_t i = 1; i < vertices_.size(); ++i) {
    if (order(vertices_[i - 1], vertices_[i]) >= 0) fail("vertices are not in order");
  }
  std::vector<Index> group(vertices_.size());
  for (Index i = 0; i < group.size(); ++i) group[i] = i;
  const auto root = [&](Index i) {
    while (group[i] != i) i = group[i] = group[group[i]];
    return i;
  };
  std::size_t groups = vertices_.size();
  for (Index h = 0; h < half_edges_.size(); ++h) {
    const HalfEdge& half_edge = half_edges_[h];
    if (side(vertices_[half_edge.from], line(h / 2)) != 0) fail("a vertex is not on the line of its edge");
    if (half_edges_[half_edge.next].from != to(h)) fail("a loop has a gap");
    if (half_edges_[half_edge.next].cell != half_edge.cell) fail("a loop is in two cells");
    if (h % 2 == 1 && half_edge.from <= half_edges_[h - 1].from) fail("an edge has no length");
    const Index a = root(half_edge.from), b = root(to(h));
    group[a] = b;
    groups -= a != b;
  }
  for (const std::vector<Index>& around : around_) {
    if (around.empty()) fail("a vertex is on no edge");
    for (std::size_t k = 0; k < around.size(); ++k) {
      const Index h = around[k], after = around[(k + 1) % around.size()];
      if (half_edges_[after ^ 1].next != h) fail("the half-edges of a vertex are not linked in their order");
      if (k + 1 == around.size()) continue;
      if (h % 2 > after % 2 || (h % 2 == after % 2 && turn(line(h / 2), line(after / 2)) <= 0))
        fail("the half-edges of a vertex are not in order");
    }
  }
  std::size_t in_loops = 0;
  for (Index cell = 0; cell < loops_.size(); ++cell) {
    for (const Index first : loops_[cell]) {
      if (half_edges_[first].cell != cell) fail("a loop is in another cell");
      in_loops += loop(first).size();
    }
  }
  if (in_loops != half_edges_.size()) fail("a half-edge is in no loop");
  if (vertices_.size() + size() != edges() + 1 + groups) fail("Euler's formula does not hold");
}

}  // namespace kds::structures
