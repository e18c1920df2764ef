// Distances of points, segments and triangles in long doubles, and who goes through whom: by all pairs, with none of
// the library's code.
#pragma once

#include "collision/shapes/mesh.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

namespace kds::collision::tests {

using Long = long double;
using LongVector = Eigen::Matrix<Long, 3, 1>;

/// Corners at one time, and the faces and edges between them: of a ball one corner, of a capsule two and an edge.
struct BruteSurface {
  std::vector<LongVector> corners;
  std::vector<Mesh::Triangle> faces;
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;

  void add_edges_of_faces() {
    for (const auto& [a, b, c] : faces) {
      for (const auto& [x, y] : {std::pair{a, b}, std::pair{b, c}, std::pair{c, a}}) edges.emplace(std::minmax(x, y));
    }
  }
};

inline Long distance_to_segment(const LongVector& p, const LongVector& a, const LongVector& b) {
  const LongVector along = b - a;
  const Long squared = along.squaredNorm();
  const Long x = squared > 0 ? std::clamp<Long>((p - a).dot(along) / squared, 0, 1) : 0;
  return (a + x * along - p).norm();
}

/// Of a point from the inside of a triangle, where its foot is within; else infinity.
inline Long height_over(const LongVector& p, const LongVector& a, const LongVector& b, const LongVector& c) {
  const LongVector n = (b - a).cross(c - a);
  const Long area = n.squaredNorm();
  if (!(area > 0)) return INFINITY;
  const Long wb = n.dot((p - a).cross(c - a)) / area, wc = n.dot((b - a).cross(p - a)) / area;
  return wb >= 0 && wc >= 0 && wb + wc <= 1 ? std::abs(n.dot(p - a)) / std::sqrt(area) : INFINITY;
}

/// Of two segments from each other, where the closest points are within both; else infinity.
inline Long distance_across(const LongVector& a, const LongVector& b, const LongVector& c, const LongVector& d) {
  const LongVector u = b - a, v = d - c, n = u.cross(v);
  const Long squared = n.squaredNorm();
  if (!(squared > 0)) return INFINITY;
  const Long s = (c - a).cross(v).dot(n) / squared, t = (c - a).cross(u).dot(n) / squared;
  return s >= 0 && s <= 1 && t >= 0 && t <= 1 ? std::abs(n.dot(c - a)) / std::sqrt(squared) : INFINITY;
}

/// The least distance of two surfaces that do not go through each other.
inline Long brute_distance(const BruteSurface& x, const BruteSurface& y) {
  Long least = INFINITY;
  const auto of_corners = [&](const BruteSurface& of, const BruteSurface& other) {
    for (const LongVector& p : of.corners) {
      for (const LongVector& q : other.corners) least = std::min(least, (p - q).norm());
      for (const auto& [a, b] : other.edges) {
        least = std::min(least, distance_to_segment(p, other.corners[a], other.corners[b]));
      }
      for (const auto& [a, b, c] : other.faces) {
        least = std::min(least, height_over(p, other.corners[a], other.corners[b], other.corners[c]));
      }
    }
  };
  of_corners(x, y), of_corners(y, x);
  for (const auto& [a, b] : x.edges) {
    for (const auto& [c, d] : y.edges) {
      least = std::min(least, distance_across(x.corners[a], x.corners[b], y.corners[c], y.corners[d]));
    }
  }
  return least;
}

/// Whether an edge of one goes through a face of the other.
inline bool go_through(const BruteSurface& x, const BruteSurface& y) {
  const auto edges_through = [](const BruteSurface& of, const BruteSurface& other) {
    for (const auto& [i, j] : of.edges) {
      const LongVector &p = of.corners[i], &q = of.corners[j];
      for (const auto& [a, b, c] : other.faces) {
        const LongVector &u = other.corners[a], &v = other.corners[b], &w = other.corners[c];
        const auto volume = [](const LongVector& o, const LongVector& r, const LongVector& s, const LongVector& t) {
          return (r - o).cross(s - o).dot(t - o);
        };
        if (volume(u, v, w, p) * volume(u, v, w, q) >= 0) continue;
        const Long ab = volume(p, q, u, v), bc = volume(p, q, v, w), ca = volume(p, q, w, u);
        if ((ab > 0 && bc > 0 && ca > 0) || (ab < 0 && bc < 0 && ca < 0)) return true;
      }
    }
    return false;
  };
  return edges_through(x, y) || edges_through(y, x);
}

}  // namespace kds::collision::tests
