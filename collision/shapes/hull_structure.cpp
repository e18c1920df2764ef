#include "collision/shapes/hull_structure.hpp"

#include "certificates/zonotope_separation.hpp"
#include "kds/arithmetic/ball.hpp"
#include "kds/arithmetic/exact.hpp"
#include "kds/motion.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace kds::collision {
namespace {

using Eigen::Vector3d;
using Index = std::uint32_t;

template <class Number>
certificates::detail::Triple<Number> from_to(const Vector3d& a, const Vector3d& b) {
  return {difference<Number>(b[0], a[0]), difference<Number>(b[1], a[1]), difference<Number>(b[2], a[2])};
}

template <class Number>
Number determinant(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d) {
  using namespace certificates::detail;
  return inner_product(cross_product(from_to<Number>(a, b), from_to<Number>(a, c)), from_to<Number>(a, d));
}

bool collinear(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  using namespace certificates::detail;
  const auto quick = cross_product(from_to<Ball<double>>(a, b), from_to<Ball<double>>(a, c));
  if (std::any_of(quick.begin(), quick.end(), [](const auto& x) { return certain_sign(x) != 0; })) return false;
  const auto exact = cross_product(from_to<Exact>(a, b), from_to<Exact>(a, c));
  return std::all_of(exact.begin(), exact.end(), [](const Exact& x) { return x.sign() == 0; });
}

/// A triangulated surface that grows with the points.
class GrowingHull {
 public:
  explicit GrowingHull(std::span<const Vector3d> points) : points_(points) {
    const std::array<Index, 4> first = simplex();
    const auto [a, b, c, d] = first;
    const bool outward = side_of_plane(points[a], points[b], points[c], points[d]) < 0;
    const std::array<Index, 3> base = outward ? std::array{a, b, c} : std::array{a, c, b};
    triangles_.push_back({base, {}, true});
    std::vector<Directed> rim;
    for (std::size_t k = 0; k < 3; ++k) rim.push_back({base[(k + 1) % 3], base[k], 0, k});
    close(rim, d);
    for (Index i = 0; i < points.size(); ++i) {
      if (std::find(first.begin(), first.end(), i) == first.end()) add(i);
    }
  }

  struct Triangle {
    std::array<Index, 3> corners;
    std::array<std::size_t, 3> neighbours;  ///< across the edge from corner k to the next
    bool there;
  };
  const std::vector<Triangle>& triangles() const { return triangles_; }

 private:
  /// An edge of a hole: the triangle that is to come runs along it from here to there; the one beyond it, and the place
  /// of the edge in that one.
  struct Directed {
    Index from, to;
    std::size_t beyond, place;
  };

  std::array<Index, 4> simplex() const {
    const auto n = static_cast<Index>(points_.size());
    const auto first_of = [n](const auto& which) {
      Index i = 0;
      while (i < n && !which(i)) ++i;
      return i;
    };
    const Index b = first_of([&](Index i) { return points_[i] != points_[0]; });
    if (b >= n) throw InvalidHull("has no volume: all points are one");
    const Index c = first_of([&](Index i) { return !collinear(points_[0], points_[b], points_[i]); });
    if (c >= n) throw InvalidHull("has no volume: all points lie in a line");
    const Index d =
        first_of([&](Index i) { return side_of_plane(points_[0], points_[b], points_[c], points_[i]) != 0; });
    if (d >= n) throw InvalidHull("has no volume: all points lie in a plane");
    return {0, b, c, d};
  }

  bool sees(std::size_t triangle, Index point) const {
    const auto& [a, b, c] = triangles_[triangle].corners;
    return side_of_plane(points_[a], points_[b], points_[c], points_[point]) > 0;
  }

  void add(Index point) {
    std::vector<std::size_t> seeing;
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
      if (triangles_[i].there && sees(i, point)) seeing.push_back(i);
    }
    for (const std::size_t i : seeing) triangles_[i].there = false;
    std::vector<Directed> rim;
    for (const std::size_t i : seeing) {
      const Triangle& t = triangles_[i];
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t beyond = t.neighbours[k];
        if (!triangles_[beyond].there) continue;
        const auto& far = triangles_[beyond].corners;
        const auto place =
            static_cast<std::size_t>(std::find(far.begin(), far.end(), t.corners[(k + 1) % 3]) - far.begin());
        rim.push_back({t.corners[k], t.corners[(k + 1) % 3], beyond, place});
      }
    }
    if (!rim.empty()) close(rim, point);
  }

  /// Fills a hole with the triangles that its rim, one cycle of edges, makes with a point.
  void close(const std::vector<Directed>& rim, Index point) {
    std::map<Index, std::size_t> begins, ends;  // by the corners of the rim: the triangle that begins, or ends, there
    const std::size_t first = triangles_.size();
    for (std::size_t k = 0; k < rim.size(); ++k) {
      const Directed& edge = rim[k];
      triangles_.push_back({{edge.from, edge.to, point}, {edge.beyond, 0, 0}, true});
      triangles_[edge.beyond].neighbours[edge.place] = first + k;
      begins[edge.from] = ends[edge.to] = first + k;
    }
    for (std::size_t k = 0; k < rim.size(); ++k) {
      triangles_[first + k].neighbours[1] = begins.at(rim[k].to);
      triangles_[first + k].neighbours[2] = ends.at(rim[k].from);
    }
  }

  std::span<const Vector3d> points_;
  std::vector<Triangle> triangles_;
};

/// Triangles in one plane that hang together have the same number.
std::vector<std::size_t> planes_of(const std::vector<GrowingHull::Triangle>& triangles,
                                   std::span<const Vector3d> points) {
  constexpr auto unknown = static_cast<std::size_t>(-1);
  std::vector<std::size_t> plane(triangles.size(), unknown);
  std::size_t count = 0;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    if (!triangles[i].there || plane[i] != unknown) continue;
    const auto& [a, b, c] = triangles[i].corners;
    const auto in_plane = [&points, &p = points[a], &q = points[b], &r = points[c]](Index other) {
      return side_of_plane(p, q, r, points[other]) == 0;
    };
    std::vector<std::size_t> found{i};
    plane[i] = count;
    for (std::size_t k = 0; k < found.size(); ++k) {
      for (const std::size_t next : triangles[found[k]].neighbours) {
        if (plane[next] != unknown) continue;
        const auto& corners = triangles[next].corners;
        if (!std::all_of(corners.begin(), corners.end(), in_plane)) continue;
        plane[next] = count;
        found.push_back(next);
      }
    }
    ++count;
  }
  return plane;
}

}  // namespace

int side_of_plane(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d) {
  if (const int s = certain_sign(determinant<Ball<double>>(a, b, c, d))) return s;
  return determinant<Exact>(a, b, c, d).sign();
}

HullStructure structure_of_hull(std::span<const Vector3d> points) {
  const GrowingHull hull(points);
  const auto& triangles = hull.triangles();
  const std::vector<std::size_t> plane = planes_of(triangles, points);
  // Around a corner there are three planes or more; around what is on an edge two, and in a face one.
  std::vector<std::set<std::size_t>> around(points.size());
  std::map<std::size_t, std::map<Index, Index>> next;  // along the boundary of each plane
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    if (!triangles[i].there) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const Index from = triangles[i].corners[k];
      around[from].insert(plane[i]);
      if (plane[triangles[i].neighbours[k]] != plane[i]) next[plane[i]][from] = triangles[i].corners[(k + 1) % 3];
    }
  }
  const auto is_corner = [&](Index i) { return around[i].size() >= 3; };
  HullStructure result;
  for (Index i = 0; i < points.size(); ++i) {
    if (is_corner(i)) result.corners.push_back(i);
  }
  for (const auto& [number, boundary] : next) {
    const auto lowest =
        std::find_if(boundary.begin(), boundary.end(), [&](const auto& step) { return is_corner(step.first); });
    std::vector<Index> face;
    Index at = lowest->first;
    do {
      if (is_corner(at)) face.push_back(at);
      at = boundary.at(at);
    } while (at != lowest->first);
    result.faces.push_back(std::move(face));
  }
  std::sort(result.faces.begin(), result.faces.end());
  std::map<std::array<Index, 2>, std::array<Index, 2>> edges;
  for (Index f = 0; f < result.faces.size(); ++f) {
    const std::vector<Index>& face = result.faces[f];
    for (std::size_t k = 0; k < face.size(); ++k) {
      const Index from = face[k], to = face[(k + 1) % face.size()];
      edges[{std::min(from, to), std::max(from, to)}][from < to ? 0 : 1] = f;
    }
  }
  for (const auto& [ends, faces] : edges) result.edges.push_back({ends, faces});
  return result;
}

}  // namespace kds::collision
