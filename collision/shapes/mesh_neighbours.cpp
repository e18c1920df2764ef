#include "collision/shapes/mesh_neighbours.hpp"

#include "collision/shapes/hull_structure.hpp"
#include "collision/vectors.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace kds::collision {
namespace {

using Eigen::Vector3d;
using Triangle = std::array<std::uint32_t, 3>;

std::vector<std::uint32_t> lowest_at_same_place(std::span<const Vector3d> vertices) {
  std::vector<std::uint32_t> order(vertices.size());
  std::iota(order.begin(), order.end(), 0U);
  const auto key = [&](std::uint32_t i) {
    const Vector3d& v = vertices[i];
    return std::tuple(v[0], v[1], v[2]);
  };
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t i, std::uint32_t j) { return key(i) != key(j) ? key(i) < key(j) : i < j; });
  std::vector<std::uint32_t> lowest(vertices.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    const bool same = k > 0 && vertices[order[k]] == vertices[order[k - 1]];
    lowest[order[k]] = same ? lowest[order[k - 1]] : order[k];
  }
  return lowest;
}

/// The edge of a triangle, by the places of its ends.
struct TriangleEdge {
  std::uint32_t low, high;
  std::uint32_t triangle;
  std::uint32_t edge;

  bool same_edge(const TriangleEdge& other) const { return low == other.low && high == other.high; }
};

std::vector<TriangleEdge> edges_of_triangles(std::span<const Triangle> triangles,
                                             std::span<const std::uint32_t> place_of) {
  std::vector<TriangleEdge> sides;
  sides.reserve(3 * triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    for (std::uint32_t i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax(place_of[triangles[t][i]], place_of[triangles[t][(i + 1) % 3]]);
      sides.push_back({low, high, t, i});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const TriangleEdge& x, const TriangleEdge& y) {
    return std::tie(x.low, x.high, x.triangle, x.edge) < std::tie(y.low, y.high, y.triangle, y.edge);
  });
  return sides;
}

/// The direction from an edge to a point, across the edge.
Vector3d across_edge(const Vector3d& begin, const Vector3d& end, const Vector3d& point) {
  const Vector3d along = normalized(Vector3d(end - begin));
  const Vector3d way = point - begin;
  return normalized(Vector3d(way - dot(way, along) * along));
}

/// Whether two triangles with a common edge lie in one plane, on either side of the edge. Exact: a plane through the
/// edge and a point that is not in theirs has them on its two sides.
bool in_one_plane(const Vector3d& begin, const Vector3d& end, const Vector3d& of_one, const Vector3d& of_other) {
  if (side_of_plane(begin, end, of_one, of_other) != 0) return false;
  const Vector3d out = begin + cross(Vector3d(end - begin), across_edge(begin, end, of_one));
  if (side_of_plane(begin, end, of_one, out) == 0) return false;
  return side_of_plane(begin, end, out, of_one) * side_of_plane(begin, end, out, of_other) < 0;
}

}  // namespace

MeshNeighbours::MeshNeighbours(std::span<const Vector3d> vertices, std::span<const Triangle> triangles)
    : beyond_(triangles.size(), Triangle{none, none, none}),
      flat_(triangles.size()),
      place_of_(lowest_at_same_place(vertices)),
      first_(vertices.size() + 1) {
  const std::vector<TriangleEdge> sides = edges_of_triangles(triangles, place_of_);
  const auto opposite = [&](const TriangleEdge& side) { return triangles[side.triangle][(side.edge + 2) % 3]; };
  std::vector<char> flat_all_round(vertices.size(), 1);
  std::vector<std::array<std::uint32_t, 2>> joined;  // from and to
  for (std::size_t first = 0, next = 0; first < sides.size(); first = next) {
    while (next < sides.size() && sides[next].same_edge(sides[first])) ++next;
    const auto [low, high, t, e] = sides[first];
    joined.push_back({low, high}), joined.push_back({high, low});
    const Vector3d &begin = vertices[low], &end = vertices[high];
    for (std::size_t k = first; k < next; ++k) {
      const TriangleEdge& side = sides[k];
      const Vector3d own = across_edge(begin, end, vertices[opposite(side)]);
      double least = 1;
      bool flat = false;
      for (std::size_t j = first; j < next; ++j) {
        if (j == k || place_of_[opposite(sides[j])] == place_of_[opposite(side)]) continue;
        const Vector3d& other = vertices[opposite(sides[j])];
        flat = flat || in_one_plane(begin, end, vertices[opposite(side)], other);
        const double cosine = dot(own, across_edge(begin, end, other));
        if (beyond_[side.triangle][side.edge] != none && !(cosine < least)) continue;
        least = cosine;
        beyond_[side.triangle][side.edge] = opposite(sides[j]);
      }
      if (flat) flat_[side.triangle] |= static_cast<std::uint8_t>(1 << side.edge);
      if (!flat) flat_all_round[low] = flat_all_round[high] = 0;
    }
  }
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (flat_all_round[place_of_[triangles[t][i]]]) flat_[t] |= static_cast<std::uint8_t>(8 << i);
    }
  }
  std::sort(joined.begin(), joined.end());
  around_.reserve(joined.size());
  for (const auto& [from, to] : joined) {
    ++first_[from + 1];
    around_.push_back(to);
  }
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
}

}  // namespace kds::collision
