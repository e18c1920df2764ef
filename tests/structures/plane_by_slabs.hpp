// The cells into which segments and lines divide the plane, by brute force in rational numbers: vertical slabs between
// all vertices, and the trapezoids in them, joined where no edge is between them.
#pragma once

#include "tests/support/exact_rational.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace kds::tests {

/// Shares no code with the library.
class PlaneBySlabs {
 public:
  using Number = oracle::Rational;
  using Vector = std::array<Number, 2>;
  /// A segment on a line, or the whole line. Numbers stay short as long as those of the line have no denominator.
  struct Part {
    Vector point, direction;
    std::optional<std::array<Vector, 2>> ends;

    bool is_empty() const { return ends && (*ends)[0] == (*ends)[1]; }
  };
  using Edge = std::pair<Vector, Vector>;  ///< from left to right, or up

  explicit PlaneBySlabs(const std::vector<Part>& parts) {
    for (const Part& part : parts) {
      if (part.is_empty()) continue;
      std::set<Vector> on;
      for (const Part& other : parts) {
        if (!other.is_empty()) add_common(part, other, on);
      }
      for (auto i = on.begin(); i != on.end(); ++i) {
        if (i != on.begin()) edges.insert({*std::prev(i), *i}), line_of_[{*std::prev(i), *i}] = part;
      }
    }
    for (const auto& [from, to] : edges) vertices.insert(from), vertices.insert(to);
    find_areas();
  }

  std::set<Vector> vertices;
  std::set<Edge> edges;
  std::vector<oracle::Integer> areas;  ///< of cells with a bound, in 2^-200, in order; less than 2^-150 off

  /// An area in 2^-200, less than one off.
  static oracle::Integer rounded(const Number& area) {
    const int shift = area.exponent() + 200;
    const oracle::Integer& n = area.odd_numerator();
    return (shift >= 0 ? oracle::Integer(n << shift) : oracle::Integer(n >> -shift)) / area.odd_denominator();
  }

 private:
  static Number cross(const Vector& a, const Vector& b) { return a[0] * b[1] - a[1] * b[0]; }
  static Vector minus(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1]}; }
  static bool has(const Part& part, const Vector& point) {
    if (cross(part.direction, minus(point, part.point)).sign() != 0) return false;
    if (!part.ends) return true;
    const auto& [from, to] = *part.ends;
    return std::min(from, to) <= point && point <= std::max(from, to);
  }
  static void add_common(const Part& a, const Part& b, std::set<Vector>& on) {
    const Vector &v = a.direction, &u = b.direction;
    const Number turn = cross(v, u);
    std::vector<Vector> points;
    if (turn.sign() != 0) {
      const Number share = cross(minus(b.point, a.point), u) / turn;
      points.push_back({a.point[0] + v[0] * share, a.point[1] + v[1] * share});
    } else {
      for (const Part* part : {&a, &b}) {
        if (part->ends) points.insert(points.end(), part->ends->begin(), part->ends->end());
      }
    }
    for (const Vector& point : points) {
      if (has(a, point) && has(b, point)) on.insert(point);
    }
  }

  Number height(const Edge& edge, const Number& x) const {
    const Part& line = line_of_.at(edge);
    return line.point[1] + line.direction[1] * (x - line.point[0]) / line.direction[0];
  }

  std::size_t root(std::size_t i) {
    while (joined_[i] != i) i = joined_[i];
    return i;
  }
  void join(std::size_t a, std::size_t b) { joined_[root(a)] = root(b); }

  /// Between two edges of a slab, or beyond the last ones; `low` and `high` on one side of the slab.
  struct Gap {
    std::size_t number;
    std::optional<Number> low, high;
  };

  void find_areas() {
    std::set<Number> places;
    for (const Vector& vertex : vertices) places.insert(vertex[0]);
    joined_.assign(1, 0);  // 0: outside
    std::vector<oracle::Integer> area(1);
    std::vector<Gap> before{{0, std::nullopt, std::nullopt}};  // on the left of `x`
    for (auto x = places.begin(); x != places.end(); ++x) {
      std::vector<Gap> after, at_end;
      const auto end = std::next(x);
      if (end == places.end()) {
        after.push_back({0, std::nullopt, std::nullopt});
      } else {
        std::vector<std::array<Number, 3>> heights;  // of the edges in the slab, at its sides; and the sum of these
        for (const Edge& edge : edges) {
          if (edge.first[0] > *x || *end > edge.second[0]) continue;
          const Number left = height(edge, *x), right = height(edge, *end);
          heights.push_back({left, right, left + right});
        }
        std::sort(heights.begin(), heights.end(), [](const auto& a, const auto& b) { return a[2] < b[2]; });
        for (std::size_t i = 0; i <= heights.size(); ++i) {
          Gap left{0, std::nullopt, std::nullopt}, right = left;
          if (i > 0) left.low = heights[i - 1][0], right.low = heights[i - 1][1];
          if (i < heights.size()) left.high = heights[i][0], right.high = heights[i][1];
          if (i > 0 && i < heights.size()) {
            left.number = right.number = joined_.size();
            joined_.push_back(left.number);
            area.push_back(rounded((*end - *x) * ((*left.high - *left.low) + (*right.high - *right.low)) / Number(2)));
          }
          after.push_back(left), at_end.push_back(right);
        }
      }
      join_across(*x, before, after);
      before = std::move(at_end);
    }
    std::vector<std::optional<oracle::Integer>> sums(joined_.size());
    for (std::size_t i = 1; i < joined_.size(); ++i) {
      auto& sum = sums[root(i)];
      sum = sum.value_or(0) + area[i];
    }
    for (std::size_t i = 0; i < sums.size(); ++i) {
      if (sums[i] && i != root(0)) areas.push_back(*sums[i]);
    }
    std::sort(areas.begin(), areas.end());
  }

  /// Joins the gaps on both sides of a vertical line where they have more than a point in common that no edge covers.
  void join_across(const Number& x, const std::vector<Gap>& left, const std::vector<Gap>& right) {
    std::set<Number> heights;
    for (const auto* gaps : {&left, &right}) {
      for (const Gap& gap : *gaps) {
        if (gap.low) heights.insert(*gap.low);
      }
    }
    std::vector<Edge> vertical;
    for (const Edge& edge : edges) {
      if (edge.first[0] != x || edge.second[0] != x) continue;
      vertical.push_back(edge);
      heights.insert(edge.first[1]), heights.insert(edge.second[1]);
    }
    // One height within each piece of the line between two of them, and one beyond each end.
    std::vector<Number> within{heights.empty() ? Number(0) : *heights.begin() - Number(1)};
    for (auto y = heights.begin(); y != heights.end(); ++y) {
      const auto next = std::next(y);
      within.push_back(next == heights.end() ? *y + Number(1) : (*y + *next) / Number(2));
    }
    const auto gap_at = [](const std::vector<Gap>& gaps, const Number& y) {
      for (const Gap& gap : gaps) {
        if ((!gap.low || *gap.low < y) && (!gap.high || y < *gap.high)) return gap.number;
      }
      return std::size_t{0};
    };
    for (const Number& y : within) {
      const bool covered = std::any_of(vertical.begin(), vertical.end(),
                                       [&](const Edge& edge) { return edge.first[1] < y && y < edge.second[1]; });
      if (!covered) join(gap_at(left, y), gap_at(right, y));
    }
  }

  std::map<Edge, Part> line_of_;
  std::vector<std::size_t> joined_;
};

}  // namespace kds::tests
