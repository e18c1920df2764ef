// Two surfaces, or one twice, over a stretch of time: what their leaves have in features.
#pragma once

#include "collision/deforming/box_overlap.hpp"
#include "collision/deforming/crossing_features.hpp"
#include "collision/deforming/feature_nearness.hpp"
#include "collision/deforming/surface_contact.hpp"
#include "collision/vectors.hpp"
#include "kds/number_text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <cstdint>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>

namespace kds::collision {

/// What the walks over pairs of nodes (SurfaceSearch, SurfaceTouching) have in common.
template <int Degree>
class SurfacePair {
 public:
  using Surface = MovingSurface<Degree>;
  using Kind = SurfaceContact::Kind;

 protected:
  struct NodePair {
    std::uint32_t a, b;
    friend auto operator<=>(const NodePair&, const NodePair&) = default;
  };

  SurfacePair(const Surface& a, const Surface& b, const SurfaceQuery& query, bool itself);

  bool are_leaves(NodePair n) const { return a_.tree().nodes()[n.a].is_leaf && b_.tree().nodes()[n.b].is_leaf; }
  bool overlap(NodePair n, OverlapSpan& span, double widening) const {
    return overlap_span<Degree>(a_.boxes()[n.a], b_.boxes()[n.b], widening, span);
  }
  const SurfaceElement& element_a(NodePair n) const { return a_.tree().elements()[a_.tree().nodes()[n.a].first]; }
  const SurfaceElement& element_b(NodePair n) const { return b_.tree().elements()[b_.tree().nodes()[n.b].first]; }

  /// Calls visit(pair) for the pairs that two nodes are split into.
  template <class Visit>
  void split(NodePair n, const Visit& visit) const;

  /// Calls visit(kind, vertices, face) for the pairs of features that two leaves own; the vertex before its face, the
  /// edge of a before that of b.
  template <class Visit>
  void for_features(NodePair leaves, const Visit& visit) const;
  /// Calls visit(kind, edge and face) for the pairs of an edge that one leaf owns and the face of the other: kind
  /// vertex_face for an edge of a.
  template <class Visit>
  void for_edges_and_faces(NodePair leaves, const Visit& visit) const;

  /// The surface of the first feature: that of the vertex, or a.
  const Surface& first_of(Kind kind) const { return kind == Kind::face_vertex ? b_ : a_; }
  const Surface& second_of(Kind kind) const { return kind == Kind::face_vertex ? a_ : b_; }
  /// How many of the vertices are of the first feature.
  static std::size_t count_of_first(Kind kind) { return kind == Kind::edge_edge ? 2 : 1; }

  certificates::ControlPoints<Degree> control_points(Kind kind, const std::array<std::uint32_t, 4>& vertices,
                                                     std::size_t of_first) const;
  SurfaceContact described(Kind kind, const std::array<std::uint32_t, 4>& vertices, std::uint32_t face,
                           const certificates::FeatureContact& touch) const;
  /// Two features at a time, as if they touched there.
  template <certificates::Patch patch>
  FeatureNearness nearness(const certificates::ControlPoints<Degree>& control, double t) const {
    return nearness_at<patch, Degree>(control, a_.part(t), t, tolerance_.thickness,
                                      a_.uncertainty() + b_.uncertainty());
  }

  /// Whether features that do not approach at `from` come nearer before they have left: looked at at times that double
  /// from one to the next, so that of a flight on a parabola three quarters of its height are seen.
  template <certificates::Patch patch>
  bool comes_nearer(const certificates::ControlPoints<Degree>& control, const FeatureNearness& now) const {
    constexpr double shortest = 0x1p-40;  // of the time there is; shorter flights do not count as leaving
    for (double part = shortest; part <= 1; part *= 2) {
      const double gap = nearness<patch>(control, query_.from + part * (query_.until - query_.from)).gap;
      if (gap > 0.5 * band(now.size)) return false;
      if (gap < now.gap - now.noise) return true;
    }
    return false;
  }

  /// How far beyond the radii features of a pair of this size count as touching: what feature_contact.cpp takes for the
  /// tolerance.
  double band(double size) const {
    return std::max(std::min(tolerance_.absolute, tolerance_.relative * size), 0x1p-38 * size);
  }

  /// An edge that goes through a face at t, as if its nearer end touched the face; or nothing. Precondition: `places`
  /// are those of the edge's ends and of the corners.
  std::optional<SurfaceContact> crossing(Kind kind, const std::array<std::uint32_t, 5>& vertices, std::uint32_t face,
                                         double t) const;
  /// A vertex that lies inside the other surface, a solid, at t; or nothing.
  std::optional<SurfaceContact> inside(double t) const;

  const Surface& a_;
  const Surface& b_;
  bool itself_;
  SurfaceQuery query_;
  OverlapSpan span_;  ///< of the query
  certificates::ContactTolerance tolerance_;
  double box_reach_;

 private:
  std::optional<SurfaceContact> inside(const Surface& of_vertices, const Surface& solid, double t) const;
  Eigen::Vector3d place(const Surface& surface, std::uint32_t v, double t) const {
    return t == surface.begin() ? surface.control_points(0)[v] : surface.position(v, t);
  }
  static Feature feature_of(const Surface& surface, const std::uint32_t* vertices, const double* weights,
                            std::size_t count, std::uint32_t face);
  Eigen::Vector3d point_at(const Surface& surface, const std::uint32_t* vertices, const double* weights,
                           std::size_t count, double t) const;
};

// ---------------------------------------------------------------------------------------------------------------------

template <int Degree>
SurfacePair<Degree>::SurfacePair(const Surface& a, const Surface& b, const SurfaceQuery& query, bool itself)
    : a_(a), b_(b), itself_(itself), query_(query) {
  const double t0 = a.begin();
  const double t1 = a.end();
  if (b.begin() != t0 || b.end() != t1) {
    throw std::invalid_argument("surface contact: the two surfaces are of different stretches of time");
  }
  query_.from = std::max(query_.from, t0);
  query_.until = std::min(query_.until, t1);
  if (!(query_.from <= query_.until)) {
    throw std::invalid_argument("surface contact: from " + number_text(query.from) + " until " +
                                number_text(query.until) + " is no part of the stretch of time");
  }
  if (!(query_.tolerance >= 0)) throw std::invalid_argument("surface contact: the tolerance must be >= 0");
  // Three roundings, outward.
  span_ = {a.part(query_.from) * (1 - 0x1p-50), std::min(1.0, a.part(query_.until) * (1 + 0x1p-50))};
  if (query_.until == t1) span_.end = 1;
  tolerance_.relative = query_.tolerance;
  tolerance_.absolute = query_.absolute_tolerance;
  // A vertex meant is within sqrt(3) of what its coordinates may be off.
  tolerance_.thickness = (a.radius() + b.radius() + 1.74 * (a.uncertainty() + b.uncertainty())) * (1 + 0x1p-50);
  box_reach_ = tolerance_.thickness * (1 + 0x1p-47);
  if (!query_.approaching) return;
  if (!(query_.absolute_tolerance < std::numeric_limits<double>::infinity()) || query_.overlaps) {
    throw std::invalid_argument(
        "surface contact: `approaching` is for an absolute tolerance, and where overlaps are known");
  }
  box_reach_ += query_.absolute_tolerance;
}

template <int Degree>
template <class Visit>
void SurfacePair<Degree>::split(NodePair n, const Visit& visit) const {
  const auto& node_a = a_.tree().nodes()[n.a];
  const auto& node_b = b_.tree().nodes()[n.b];
  if (itself_ && n.a == n.b) {
    visit({node_a.first, node_a.first});
    visit({node_a.first, node_a.first + 1});
    visit({node_a.first + 1, node_a.first + 1});
    return;
  }
  const auto size = [](const ControlBox<Degree>& box) {
    double sum = 0;
    for (std::size_t d = 0; d < 3; ++d) sum += box.max[0][d] - box.min[0][d];
    return sum;
  };
  if (node_b.is_leaf || (!node_a.is_leaf && size(a_.boxes()[n.a]) >= size(b_.boxes()[n.b]))) {
    visit({node_a.first, n.b});
    visit({node_a.first + 1, n.b});
  } else {
    visit({n.a, node_b.first});
    visit({n.a, node_b.first + 1});
  }
}

template <int Degree>
template <class Visit>
void SurfacePair<Degree>::for_features(NodePair leaves, const Visit& visit) const {
  if (itself_ && leaves.a == leaves.b) return;  // they share vertices
  const SurfaceElement& x = element_a(leaves);
  const SurfaceElement& y = element_b(leaves);
  const auto vertices_and_face = [&](Kind kind, const SurfaceElement& of_vertices, const SurfaceElement& face) {
    if (!face.is_face()) return;
    const auto& [a, b, c] = face.vertices;
    for (std::size_t k = 0; k < of_vertices.corners; ++k) {
      if (!(of_vertices.owned_vertices >> k & 1)) continue;
      const std::uint32_t v = of_vertices.vertices[k];
      if (itself_ && (v == a || v == b || v == c)) continue;
      visit(kind, std::array{v, a, b, c}, face.index);
    }
  };
  vertices_and_face(Kind::vertex_face, x, y);
  vertices_and_face(Kind::face_vertex, y, x);
  for (std::size_t i = 0; i < x.corners; ++i) {
    if (!(x.owned_edges >> i & 1)) continue;
    const std::uint32_t a = x.vertices[i];
    const std::uint32_t b = x.vertices[(i + 1) % 3];
    for (std::size_t j = 0; j < y.corners; ++j) {
      if (!(y.owned_edges >> j & 1)) continue;
      const std::uint32_t c = y.vertices[j];
      const std::uint32_t d = y.vertices[(j + 1) % 3];
      if (itself_ && (a == c || a == d || b == c || b == d)) continue;
      visit(Kind::edge_edge, std::array{a, b, c, d}, 0);
    }
  }
}

template <int Degree>
template <class Visit>
void SurfacePair<Degree>::for_edges_and_faces(NodePair leaves, const Visit& visit) const {
  if (itself_ && leaves.a == leaves.b) return;
  const auto edges_and_face = [&](Kind kind, const SurfaceElement& of_edges, const SurfaceElement& face) {
    if (!face.is_face()) return;
    const auto& [a, b, c] = face.vertices;
    for (std::size_t k = 0; k < of_edges.corners; ++k) {
      if (!(of_edges.owned_edges >> k & 1)) continue;
      const std::uint32_t v = of_edges.vertices[k];
      const std::uint32_t w = of_edges.vertices[(k + 1) % 3];
      if (itself_ && (v == a || v == b || v == c || w == a || w == b || w == c)) continue;
      visit(kind, std::array{v, w, a, b, c}, face.index);
    }
  };
  edges_and_face(Kind::vertex_face, element_a(leaves), element_b(leaves));
  edges_and_face(Kind::face_vertex, element_b(leaves), element_a(leaves));
}

template <int Degree>
certificates::ControlPoints<Degree> SurfacePair<Degree>::control_points(Kind kind,
                                                                        const std::array<std::uint32_t, 4>& vertices,
                                                                        std::size_t of_first) const {
  certificates::ControlPoints<Degree> control;
  for (std::size_t i = 0; i <= Degree; ++i) {
    const auto points = first_of(kind).control_points(i);
    const auto others = second_of(kind).control_points(i);
    for (std::size_t k = 0; k < 4; ++k) control[i][k] = k < of_first ? points[vertices[k]] : others[vertices[k]];
  }
  return control;
}

template <int Degree>
std::optional<SurfaceContact> SurfacePair<Degree>::crossing(Kind kind, const std::array<std::uint32_t, 5>& vertices,
                                                            std::uint32_t face, double t) const {
  const auto& [v, w, a, b, c] = vertices;
  const Surface& of_edge = first_of(kind);
  const Surface& of_face = second_of(kind);
  const Eigen::Vector3d p = place(of_edge, v, t), q = place(of_edge, w, t);
  const Eigen::Vector3d at_a = place(of_face, a, t), at_b = place(of_face, b, t), at_c = place(of_face, c, t);
  if (!goes_through(p, q, at_a, at_b, at_c)) return std::nullopt;
  const Eigen::Vector3d across = cross(at_b - at_a, at_c - at_a);
  const Eigen::Vector3d n = normalized(across);
  const double of_p = dot(n, p - at_a), of_q = dot(n, q - at_a);
  const bool first = std::abs(of_p) <= std::abs(of_q);
  // Where the edge goes through the face, by areas.
  const double along = std::abs(of_p) / (std::abs(of_p) + std::abs(of_q));
  const Eigen::Vector3d on = p + along * (q - p) - at_a;
  const double area = norm(across);
  const double wb = std::clamp(dot(n, cross(on, at_c - at_a)) / area, 0.0, 1.0);
  const double wc = std::clamp(dot(n, cross(at_b - at_a, on)) / area, 0.0, 1 - wb);
  certificates::FeatureContact touch;
  touch.status = certificates::FeatureContactStatus::at_start;
  touch.time = t;
  touch.distance = std::abs(first ? of_p : of_q);
  touch.normal = (first ? of_p : of_q) > 0 ? Eigen::Vector3d(-n) : n;  // where that end of the edge came from
  touch.weights = {1, 1 - wb - wc, wb, wc};
  return described(kind, {first ? v : w, a, b, c}, face, touch);
}

template <int Degree>
std::optional<SurfaceContact> SurfacePair<Degree>::inside(double t) const {
  if (b_.solid()) {
    if (auto found = inside(a_, b_, t)) return found;
  }
  return a_.solid() ? inside(b_, a_, t) : std::nullopt;
}

template <int Degree>
std::optional<SurfaceContact> SurfacePair<Degree>::inside(const Surface& of_vertices, const Surface& solid,
                                                          double t) const {
  for (const SurfaceElement& x : of_vertices.tree().elements()) {
    for (std::size_t k = 0; k < x.corners; ++k) {
      if (!(x.owned_vertices >> k & 1)) continue;
      const Eigen::Vector3d p = place(of_vertices, x.vertices[k], t);
      // The face whose plane is nearest.
      double depth = std::numeric_limits<double>::infinity();
      Eigen::Vector3d out = Eigen::Vector3d::UnitX();
      bool inside = true;
      for (const SurfaceElement& y : solid.tree().elements()) {
        const Eigen::Vector3d a = place(solid, y.vertices[0], t);
        const Eigen::Vector3d b = place(solid, y.vertices[1], t), c = place(solid, y.vertices[2], t);
        inside = side_of_plane(a, b, c, p) < 0;
        if (!inside) break;
        const Eigen::Vector3d n = normalized(cross(b - a, c - a));
        if (const double d = dot(n, a - p); d < depth) depth = d, out = n;
      }
      if (!inside) continue;
      SurfaceContact contact;
      contact.kind = Kind::inside;
      contact.status = certificates::FeatureContactStatus::at_start;
      const bool of_a = &of_vertices == &a_;
      contact.contact = {t, p, of_a ? Eigen::Vector3d(-out) : out, {}, {}};
      (of_a ? contact.contact.feature_a : contact.contact.feature_b) = Feature::vertex(x.vertices[k]);
      contact.vertices[0] = x.vertices[k];
      contact.weights[0] = 1;
      contact.distance = depth;
      return contact;
    }
  }
  return std::nullopt;
}

template <int Degree>
Eigen::Vector3d SurfacePair<Degree>::point_at(const Surface& surface, const std::uint32_t* vertices,
                                              const double* weights, std::size_t count, double t) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < count; ++k) sum += weights[k] * surface.position(vertices[k], t);
  return sum;
}

/// The corner, the edge or all of it on which the point with the weights lies; nothing of a ball.
template <int Degree>
Feature SurfacePair<Degree>::feature_of(const Surface& surface, const std::uint32_t* vertices, const double* weights,
                                        std::size_t count, std::uint32_t face) {
  if (surface.tree().vertices() == 1) return {};
  std::array<std::uint32_t, 3> used{};
  std::size_t n = 0;
  for (std::size_t k = 0; k < count; ++k) {
    if (weights[k] != 0) used[n++] = vertices[k];
  }
  if (n == 1) return Feature::vertex(used[0]);
  if (n == 2 && !surface.tree().is_diagonal(used[0], used[1])) return Feature::edge(used[0], used[1]);
  return Feature::face(face);
}

template <int Degree>
SurfaceContact SurfacePair<Degree>::described(Kind kind, const std::array<std::uint32_t, 4>& vertices,
                                              std::uint32_t face, const certificates::FeatureContact& touch) const {
  SurfaceContact result;
  result.kind = kind;
  result.status = touch.status;
  result.latest = touch.latest;
  result.distance = touch.distance;
  result.vertices = vertices;
  result.weights = touch.weights;
  Eigen::Vector3d normal = -touch.normal;  // from the first feature, the vertex or the first edge, to the second
  if (kind == Kind::face_vertex) {
    std::rotate(result.vertices.begin(), result.vertices.begin() + 1, result.vertices.end());
    std::rotate(result.weights.begin(), result.weights.begin() + 1, result.weights.end());
    normal = touch.normal;
  }
  const std::size_t of_a = result.vertices_of_a();
  const std::uint32_t* const v = result.vertices.data();
  const double* const w = result.weights.data();
  Contact& contact = result.contact;
  contact.time = touch.time;
  contact.normal = normal;
  contact.feature_a = feature_of(a_, v, w, of_a, face);
  contact.feature_b = feature_of(b_, v + of_a, w + of_a, 4 - of_a, face);
  contact.point = point_at(a_, v, w, of_a, touch.time) + normal * a_.radius();
  return result;
}

}  // namespace kds::collision
