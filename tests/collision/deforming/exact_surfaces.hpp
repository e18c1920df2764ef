// First contacts of surfaces by all pairs of features, over exact numbers.
#pragma once

#include "collision/deforming/moving_surface.hpp"
#include "collision/deforming/surface_contact.hpp"
#include "tests/certificates/check_certificate.hpp"
#include "tests/certificates/exact_features.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace kds::tests {

/// Vertices by control points, and triangles: what a surface is made from, without its tree.
template <int Degree>
struct BentSurface {
  std::array<std::vector<Eigen::Vector3d>, std::size_t{Degree} + 1> control;
  std::vector<collision::Mesh::Triangle> triangles;

  std::set<std::pair<std::uint32_t, std::uint32_t>> edges() const {
    std::set<std::pair<std::uint32_t, std::uint32_t>> all;
    for (const auto& [a, b, c] : triangles) {
      for (const auto& [x, y] : {std::pair{a, b}, std::pair{b, c}, std::pair{c, a}}) all.emplace(std::minmax(x, y));
    }
    return all;
  }
};

/// The path of a vertex over [t0, t1].
template <int Degree>
Path exact_path(const BentSurface<Degree>& surface, std::uint32_t vertex, double t0, double t1) {
  const oracle::Rational duration = oracle::rational(t1) - oracle::rational(t0);
  const oracle::Polynomial s({-oracle::rational(t0) / duration, oracle::Rational(1) / duration});
  const oracle::Polynomial r = oracle::Polynomial(oracle::Rational(1)) - s;
  Path path;
  for (std::size_t d = 0; d < 3; ++d) {
    const auto b = [&](std::size_t i) {
      return oracle::Polynomial(oracle::rational(surface.control[i][vertex][static_cast<int>(d)]));
    };
    if constexpr (Degree == 1) {
      path[d] = b(0) * r + b(1) * s;
    } else {
      path[d] = b(0) * r * r + oracle::Polynomial(oracle::Rational(2)) * b(1) * r * s + b(2) * s * s;
    }
  }
  return path;
}

/// Whether the boxes around four paths tell at once that they do not touch.
template <int Degree>
bool far_apart(const BentSurface<Degree>& a, const BentSurface<Degree>& b, const std::array<std::uint32_t, 4>& v,
               std::size_t of_a) {
  for (int d = 0; d < 3; ++d) {
    std::array<double, 2> low{1e300, 1e300}, high{-1e300, -1e300};
    for (std::size_t k = 0; k < 4; ++k) {
      const bool first = k < of_a;
      for (const auto& points : first ? a.control : b.control) {
        low[first ? 0 : 1] = std::min(low[first ? 0 : 1], points[v[k]][d]);
        high[first ? 0 : 1] = std::max(high[first ? 0 : 1], points[v[k]][d]);
      }
    }
    if (low[0] > high[1] || low[1] > high[0]) return true;
  }
  return false;
}

/// Calls pair(kind, vertices, of_a) for all pairs of features, of a surface with itself those without a common vertex.
template <int Degree, class Pair>
void for_all_features(const BentSurface<Degree>& a, const BentSurface<Degree>& b, bool itself, const Pair& pair) {
  const auto shared = [&](std::uint32_t v, const collision::Mesh::Triangle& t) {
    return itself && std::find(t.begin(), t.end(), v) != t.end();
  };
  for (std::uint32_t v = 0; v < a.control[0].size(); ++v) {
    for (const auto& t : b.triangles) {
      if (!shared(v, t)) pair(Features::vertex_face, std::array{v, t[0], t[1], t[2]}, 1);
    }
  }
  if (!itself) {
    for (std::uint32_t v = 0; v < b.control[0].size(); ++v) {
      for (const auto& t : a.triangles) pair(Features::vertex_face, std::array{t[0], t[1], t[2], v}, 3);
    }
  }
  for (const auto& [p, q] : a.edges()) {
    for (const auto& [r, s] : b.edges()) {
      if (itself && (std::pair(p, q) >= std::pair(r, s) || p == r || p == s || q == r || q == s)) continue;
      pair(Features::edge_edge, std::array{p, q, r, s}, 2);
    }
  }
}

/// The four paths, the vertex before its face.
template <int Degree>
std::array<Path, 4> paths_of(const BentSurface<Degree>& a, const BentSurface<Degree>& b,
                             const std::array<std::uint32_t, 4>& v, std::size_t of_a, double t0, double t1) {
  std::array<Path, 4> p;
  for (std::size_t k = 0; k < 4; ++k) p[k] = exact_path(k < of_a ? a : b, v[k], t0, t1);
  if (of_a == 3) std::rotate(p.begin(), p.begin() + 3, p.end());
  return p;
}

/// The first time at which two surfaces touch, or one touches itself.
template <int Degree>
std::optional<oracle::Instant> first_touch(const BentSurface<Degree>& a, const BentSurface<Degree>& b, bool itself,
                                           double t0, double t1, double from) {
  std::optional<oracle::Instant> first;
  for_all_features(a, b, itself, [&](Features kind, const std::array<std::uint32_t, 4>& v, std::size_t of_a) {
    if (far_apart(a, b, v, of_a)) return;
    const auto touch =
        ExactFeatures(kind, paths_of(a, b, v, of_a, t0, t1)).first_touch(from, first ? first->ceiling() : t1);
    if (touch && (!first || *touch < *first)) first = touch;
  });
  return first;
}

/// What is wrong with a contact that is reported, or nothing: not where, not near, not pointing from a to b.
template <int Degree>
std::string complaint(const collision::SurfaceContact& found, const BentSurface<Degree>& a,
                      const BentSurface<Degree>& b, double t0, double t1, double allowed) {
  const std::size_t of_a = found.vertices_of_a();
  const auto paths = paths_of(a, b, found.vertices, of_a, t0, t1);
  const auto kind =
      found.kind == collision::SurfaceContact::Kind::edge_edge ? Features::edge_edge : Features::vertex_face;
  const auto p = places(paths, oracle::rational(found.contact.time));
  if (squared_distance(kind, p) > oracle::square(oracle::rational(found.distance))) return "farther than it says";
  if (!(found.distance <= allowed)) return "farther than the tolerance";
  if (!(std::abs(found.contact.normal.norm() - 1) < 1e-12)) return "normal";
  return "";
}

}  // namespace kds::tests
