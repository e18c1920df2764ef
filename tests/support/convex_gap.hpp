// How far two solids are apart, or how deep in each other, by brute force in long doubles: all features with all.
#pragma once

#include "collision/shapes/polytope.hpp"
#include "collision/shapes/shape.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <variant>
#include <vector>

namespace kds::tests {

/// The hull of points, grown by a radius. Its faces are all triples of points with the others on one side.
class ConvexGap {
 public:
  using Number = long double;
  using Vector = std::array<Number, 3>;
  struct Pose {
    Vector centre;
    std::array<Vector, 3> columns;
  };

  explicit ConvexGap(const collision::Shape& shape) {
    if (const auto* const ball = std::get_if<collision::Sphere>(&shape)) {
      points_ = {{0, 0, 0}};
      radius_ = ball->radius;
    } else if (const auto* const capsule = std::get_if<collision::Capsule>(&shape)) {
      points_ = {{0, 0, -Number(capsule->half_length)}, {0, 0, Number(capsule->half_length)}};
      radius_ = capsule->radius;
    } else if (const auto* const box = std::get_if<collision::Box>(&shape)) {
      const auto& h = box->half_extents;
      for (int i = 0; i < 8; ++i) points_.push_back({i & 1 ? h[0] : -h[0], i & 2 ? h[1] : -h[1], i & 4 ? h[2] : -h[2]});
    } else {
      for (const auto& p : std::get<collision::ConvexHull>(shape).polytope->points()) {
        points_.push_back({p[0], p[1], p[2]});
      }
    }
    find_faces();
  }

  /// Positive: the distance. Negative: how far at least one has to be moved.
  static Number between(const ConvexGap& a, const Pose& pose_a, const ConvexGap& b, const Pose& pose_b) {
    const Seen x(a, pose_a), y(b, pose_b);
    const Number radii = a.radius_ + b.radius_;
    if (!(radii > 0)) return widest(x, y);
    if (x.faces.size() + y.faces.size() > 0) {
      if (const Number wide = widest(x, y); wide < 0) return wide - radii;
    }
    return nearest(x, y) - radii;
  }

 private:
  using Triple = std::array<std::size_t, 3>;
  using Pair = std::array<std::size_t, 2>;

  static Vector minus(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
  static Vector plus(const Vector& a, const Vector& b, Number s) {
    return {a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]};
  }
  static Number dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
  static Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  }
  static Number length(const Vector& a) { return std::sqrt(dot(a, a)); }

  void find_faces() {
    const std::size_t n = points_.size();
    if (n == 2) edges_.push_back({0, 1});
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        for (std::size_t k = j + 1; k < n; ++k) {
          if (i >= j || i == k) continue;
          const Vector m = cross(minus(points_[j], points_[i]), minus(points_[k], points_[i]));
          const Number size = length(m);
          if (!(size > 0)) continue;
          Number low = 0, high = 0;
          for (const Vector& p : points_) {
            const Number height = dot(m, minus(p, points_[i])) / size;
            low = std::min(low, height), high = std::max(high, height);
          }
          if (low < -1e-15L && high > 1e-15L) continue;
          faces_.push_back({i, j, k});
          for (const Pair& e : {Pair{i, j}, Pair{j, k}, Pair{i, k}}) {
            if (std::find(edges_.begin(), edges_.end(), e) == edges_.end()) edges_.push_back(e);
          }
        }
      }
    }
  }

  struct Seen {
    Seen(const ConvexGap& solid, const Pose& pose) : faces(solid.faces_), edges(solid.edges_) {
      for (const Vector& p : solid.points_) {
        Vector x = pose.centre;
        for (std::size_t d = 0; d < 3; ++d) x = plus(x, pose.columns[d], p[d]);
        points.push_back(x);
      }
    }
    std::vector<Vector> points;
    const std::vector<Triple>& faces;
    const std::vector<Pair>& edges;
  };

  /// Along the best of all normals of faces and products of edges.
  static Number widest(const Seen& a, const Seen& b) {
    Number best = -std::numeric_limits<Number>::infinity();
    const auto along = [&](const Vector& n, Number least) {
      const Number size = length(n);
      if (!(size > least)) return;
      Number low_a = 1e300L, high_a = -1e300L, low_b = 1e300L, high_b = -1e300L;
      for (const Vector& x : a.points) low_a = std::min(low_a, dot(n, x)), high_a = std::max(high_a, dot(n, x));
      for (const Vector& x : b.points) low_b = std::min(low_b, dot(n, x)), high_b = std::max(high_b, dot(n, x));
      best = std::max(best, std::max(low_a - high_b, low_b - high_a) / size);
    };
    for (const Seen* s : {&a, &b}) {
      for (const Triple& f : s->faces) {
        along(cross(minus(s->points[f[1]], s->points[f[0]]), minus(s->points[f[2]], s->points[f[0]])), 0);
      }
    }
    for (const Pair& e : a.edges) {
      const Vector u = minus(a.points[e[1]], a.points[e[0]]);
      for (const Pair& g : b.edges) {
        const Vector v = minus(b.points[g[1]], b.points[g[0]]);
        along(cross(u, v), 1e-9L * length(u) * length(v));
      }
    }
    return best;
  }

  static Number to_segment(const Vector& x, const Vector& p, const Vector& q) {
    const Vector u = minus(q, p);
    const Number part = std::clamp(dot(minus(x, p), u) / dot(u, u), Number(0), Number(1));
    return length(minus(x, plus(p, u, part)));
  }
  static Number to_triangle(const Vector& x, const Vector& p, const Vector& q, const Vector& r) {
    const Vector m = cross(minus(q, p), minus(r, p));
    const std::array<Vector, 3> c{p, q, r};
    bool over = true;
    for (std::size_t k = 0; k < 3; ++k) {
      over = over && dot(cross(m, minus(c[(k + 1) % 3], c[k])), minus(x, c[k])) >= 0;
    }
    if (over) return std::abs(dot(m, minus(x, p))) / length(m);
    return std::min({to_segment(x, p, q), to_segment(x, q, r), to_segment(x, r, p)});
  }
  static Number of_segments(const Vector& p, const Vector& q, const Vector& r, const Vector& s) {
    Number best = std::min({to_segment(p, r, s), to_segment(q, r, s), to_segment(r, p, q), to_segment(s, p, q)});
    const Vector u = minus(q, p), v = minus(s, r), w = minus(r, p), n = cross(u, v);
    const Number square = dot(n, n);
    if (!(square > 1e-18L * dot(u, u) * dot(v, v))) return best;
    const Number along_u = dot(cross(w, v), n) / square, along_v = dot(cross(w, u), n) / square;
    if (along_u >= 0 && along_u <= 1 && along_v >= 0 && along_v <= 1) {
      best = std::min(best, std::abs(dot(w, n)) / std::sqrt(square));
    }
    return best;
  }

  static Number nearest(const Seen& a, const Seen& b) {
    Number best = std::numeric_limits<Number>::infinity();
    for (const auto& [s, other] : {std::pair{&a, &b}, std::pair{&b, &a}}) {
      for (const Vector& x : other->points) {
        for (const Vector& y : s->points) best = std::min(best, length(minus(x, y)));
        for (const Triple& f : s->faces) {
          best = std::min(best, to_triangle(x, s->points[f[0]], s->points[f[1]], s->points[f[2]]));
        }
        for (const Pair& e : s->edges) best = std::min(best, to_segment(x, s->points[e[0]], s->points[e[1]]));
      }
    }
    for (const Pair& e : a.edges) {
      for (const Pair& g : b.edges) {
        best = std::min(best, of_segments(a.points[e[0]], a.points[e[1]], b.points[g[0]], b.points[g[1]]));
      }
    }
    return best;
  }

  std::vector<Vector> points_;
  std::vector<Triple> faces_;
  std::vector<Pair> edges_;
  Number radius_ = 0;
};

}  // namespace kds::tests
