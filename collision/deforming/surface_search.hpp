// The walk over pairs of nodes of two surfaces, and the tests of the features in their leaves.
#pragma once

#include "collision/deforming/box_overlap.hpp"
#include "collision/deforming/crossing_features.hpp"
#include "collision/deforming/surface_contact.hpp"
#include "collision/vectors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <queue>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

namespace kds::collision {

/// Two surfaces, or one twice, over a stretch of time. See surface_contact.hpp for laws and method.
template <int Degree>
class SurfaceSearch {
 public:
  using Surface = MovingSurface<Degree>;

  SurfaceSearch(const Surface& a, const Surface& b, const SurfaceQuery& query) : SurfaceSearch(a, b, query, false) {}
  SurfaceSearch(const Surface& surface, const SurfaceQuery& query) : SurfaceSearch(surface, surface, query, true) {}

  /// Calls found(contact) for contacts of features, pairs of leaves in the order in which their boxes may begin to
  /// overlap, until that is later than the time that it last returned.
  template <class Found>
  void earliest_first(const Found& found) const;

  /// Calls found(contact) for each pair of features that touch, and each overlap at the start.
  template <class Found>
  void all(const Found& found) const;

 private:
  using Status = certificates::FeatureContactStatus;
  using Kind = SurfaceContact::Kind;
  struct NodePair {
    std::uint32_t a, b;
    friend auto operator<=>(const NodePair&, const NodePair&) = default;
  };
  struct Waiting {
    double begin;
    NodePair nodes;
    friend auto operator<=>(const Waiting&, const Waiting&) = default;
  };

  SurfaceSearch(const Surface& a, const Surface& b, const SurfaceQuery& query, bool itself);

  bool are_leaves(NodePair n) const { return a_.tree().nodes()[n.a].is_leaf && b_.tree().nodes()[n.b].is_leaf; }
  bool overlap(NodePair n, OverlapSpan& span) const {
    return overlap_span<Degree>(a_.boxes()[n.a], b_.boxes()[n.b], box_reach_, span);
  }

  /// Calls visit(pair) for the pairs that two nodes are split into, of those that may overlap in the span.
  template <class Visit>
  void split(NodePair n, const Visit& visit) const;

  /// Calls found(contact) for the pairs of features of two leaves.
  template <class Found>
  void test(NodePair leaves, bool at_start, const Found& found) const;
  template <class Found>
  void test_vertices(const Surface& of_vertices, const SurfaceElement& x, const SurfaceElement& face, Kind kind,
                     const Found& found) const;
  template <class Found>
  void test_edges(const SurfaceElement& x, const SurfaceElement& y, const Found& found) const;
  /// Edges of x that go through the face at the start.
  template <class Found>
  void test_crossings(const Surface& of_edges, const SurfaceElement& x, const SurfaceElement& face, Kind kind,
                      const Found& found) const;
  /// Vertices of x, which is used by a leaf, inside the other, a solid, at the start.
  template <class Found>
  void test_insides(const Surface& of_vertices, const Surface& solid, const Found& found) const;

  certificates::ControlPoints<Degree> control_points(const Surface& first, const Surface& second,
                                                     const std::array<std::uint32_t, 4>& vertices,
                                                     std::size_t of_first) const;
  SurfaceContact described(Kind kind, const std::array<std::uint32_t, 4>& vertices, std::uint32_t face,
                           const certificates::FeatureContact& touch) const;
  Feature feature_of(const std::uint32_t* vertices, const double* weights, std::size_t count, std::uint32_t face) const;
  Eigen::Vector3d point_at(const Surface& surface, const std::uint32_t* vertices, const double* weights,
                           std::size_t count, double t) const;

  const Surface& a_;
  const Surface& b_;
  bool itself_;
  SurfaceQuery query_;
  OverlapSpan span_;  ///< of the query
  certificates::ContactTolerance tolerance_;
  double box_reach_;
};

// ---------------------------------------------------------------------------------------------------------------------

template <int Degree>
SurfaceSearch<Degree>::SurfaceSearch(const Surface& a, const Surface& b, const SurfaceQuery& query, bool itself)
    : a_(a), b_(b), itself_(itself), query_(query) {
  const double t0 = a.begin();
  const double t1 = a.end();
  if (b.begin() != t0 || b.end() != t1) {
    throw std::invalid_argument("surface contact: the two surfaces are of different stretches of time");
  }
  query_.from = std::max(query_.from, t0);
  query_.until = std::min(query_.until, t1);
  if (!(query_.from <= query_.until)) {
    throw std::invalid_argument("surface contact: from " + std::to_string(query.from) + " until " +
                                std::to_string(query.until) + " is no part of the stretch of time");
  }
  if (!(query_.tolerance >= 0)) throw std::invalid_argument("surface contact: the tolerance must be >= 0");
  // Three roundings, outward.
  span_ = {a.part(query_.from) * (1 - 0x1p-50), std::min(1.0, a.part(query_.until) * (1 + 0x1p-50))};
  if (query_.until == t1) span_.end = 1;
  tolerance_.relative = query_.tolerance;
  // A vertex meant is within sqrt(3) of what its coordinates may be off.
  tolerance_.thickness = (a.radius() + b.radius() + 1.74 * (a.uncertainty() + b.uncertainty())) * (1 + 0x1p-50);
  box_reach_ = tolerance_.thickness * (1 + 0x1p-47);
}

template <int Degree>
template <class Found>
void SurfaceSearch<Degree>::earliest_first(const Found& found) const {
  std::priority_queue<Waiting, std::vector<Waiting>, std::greater<>> queue;
  double last = span_.end;  // no contact after this is of interest
  const auto report = [&](const SurfaceContact& contact) {
    const double t = found(contact);
    last = std::min(last, std::max(a_.part(t) * (1 + 0x1p-50), span_.begin));
  };
  if (query_.overlaps) {
    if (b_.solid()) test_insides(a_, b_, report);
    if (a_.solid()) test_insides(b_, a_, report);
  }
  const auto wait = [&](NodePair n) {
    OverlapSpan span = span_;
    if (overlap(n, span) && span.begin <= last) queue.push({span.begin, n});
  };
  wait({0, 0});
  while (!queue.empty()) {
    const Waiting next = queue.top();
    if (next.begin > last) return;
    queue.pop();
    if (are_leaves(next.nodes)) {
      test(next.nodes, next.begin == span_.begin, report);
    } else {
      split(next.nodes, wait);
    }
  }
}

template <int Degree>
template <class Found>
void SurfaceSearch<Degree>::all(const Found& found) const {
  if (query_.overlaps) {
    if (b_.solid()) test_insides(a_, b_, found);
    if (a_.solid()) test_insides(b_, a_, found);
  }
  std::vector<NodePair> stack{{0, 0}};
  while (!stack.empty()) {
    const NodePair n = stack.back();
    stack.pop_back();
    OverlapSpan span = span_;
    if (!overlap(n, span)) continue;
    if (are_leaves(n)) {
      test(n, span.begin == span_.begin, found);
    } else {
      split(n, [&](NodePair half) { stack.push_back(half); });
    }
  }
}

template <int Degree>
template <class Visit>
void SurfaceSearch<Degree>::split(NodePair n, const Visit& visit) const {
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
template <class Found>
void SurfaceSearch<Degree>::test(NodePair leaves, bool at_start, const Found& found) const {
  if (itself_ && leaves.a == leaves.b) return;  // its features share vertices
  const SurfaceElement& x = a_.tree().elements()[a_.tree().nodes()[leaves.a].first];
  const SurfaceElement& y = b_.tree().elements()[b_.tree().nodes()[leaves.b].first];
  test_vertices(a_, x, y, Kind::vertex_face, found);
  test_vertices(b_, y, x, Kind::face_vertex, found);
  test_edges(x, y, found);
  if (at_start && query_.overlaps) {
    test_crossings(a_, x, y, Kind::vertex_face, found);
    test_crossings(b_, y, x, Kind::face_vertex, found);
  }
}

template <int Degree>
certificates::ControlPoints<Degree> SurfaceSearch<Degree>::control_points(const Surface& first, const Surface& second,
                                                                          const std::array<std::uint32_t, 4>& vertices,
                                                                          std::size_t of_first) const {
  certificates::ControlPoints<Degree> control;
  for (std::size_t i = 0; i <= Degree; ++i) {
    const auto points = first.control_points(i);
    const auto others = second.control_points(i);
    for (std::size_t k = 0; k < 4; ++k) control[i][k] = k < of_first ? points[vertices[k]] : others[vertices[k]];
  }
  return control;
}

template <int Degree>
template <class Found>
void SurfaceSearch<Degree>::test_vertices(const Surface& of_vertices, const SurfaceElement& x,
                                          const SurfaceElement& face, Kind kind, const Found& found) const {
  if (!face.is_face()) return;
  const Surface& of_faces = kind == Kind::vertex_face ? b_ : a_;
  const auto& [a, b, c] = face.vertices;
  for (std::size_t k = 0; k < x.corners; ++k) {
    if (!(x.owned_vertices >> k & 1)) continue;
    const std::uint32_t v = x.vertices[k];
    if (itself_ && (v == a || v == b || v == c)) continue;
    const std::array<std::uint32_t, 4> vertices{v, a, b, c};
    const auto touch = certificates::vertex_face_contact<Degree>(control_points(of_vertices, of_faces, vertices, 1),
                                                                 a_.begin(), a_.end(), query_.from, tolerance_);
    if (touch && touch.time <= query_.until) found(described(kind, vertices, face.index, touch));
  }
}

template <int Degree>
template <class Found>
void SurfaceSearch<Degree>::test_edges(const SurfaceElement& x, const SurfaceElement& y, const Found& found) const {
  for (std::size_t i = 0; i < x.corners; ++i) {
    if (!(x.owned_edges >> i & 1)) continue;
    const std::uint32_t a = x.vertices[i];
    const std::uint32_t b = x.vertices[(i + 1) % 3];
    for (std::size_t j = 0; j < y.corners; ++j) {
      if (!(y.owned_edges >> j & 1)) continue;
      const std::array<std::uint32_t, 4> vertices{a, b, y.vertices[j], y.vertices[(j + 1) % 3]};
      if (itself_ && (a == vertices[2] || a == vertices[3] || b == vertices[2] || b == vertices[3])) continue;
      const auto touch = certificates::edge_edge_contact<Degree>(control_points(a_, b_, vertices, 2), a_.begin(),
                                                                 a_.end(), query_.from, tolerance_);
      if (touch && touch.time <= query_.until) found(described(Kind::edge_edge, vertices, 0, touch));
    }
  }
}

template <int Degree>
template <class Found>
void SurfaceSearch<Degree>::test_crossings(const Surface& of_edges, const SurfaceElement& x, const SurfaceElement& face,
                                           Kind kind, const Found& found) const {
  if (!face.is_face()) return;
  const Surface& of_faces = kind == Kind::vertex_face ? b_ : a_;
  const auto at = [&](const Surface& surface, std::uint32_t v) {
    return query_.from == surface.begin() ? surface.control_points(0)[v] : surface.position(v, query_.from);
  };
  const auto& [a, b, c] = face.vertices;
  for (std::size_t k = 0; k < x.corners; ++k) {
    if (!(x.owned_edges >> k & 1)) continue;
    const std::uint32_t v = x.vertices[k];
    const std::uint32_t w = x.vertices[(k + 1) % 3];
    if (itself_ && (v == a || v == b || v == c || w == a || w == b || w == c)) continue;
    const Eigen::Vector3d p = at(of_edges, v), q = at(of_edges, w);
    const Eigen::Vector3d at_a = at(of_faces, a), at_b = at(of_faces, b), at_c = at(of_faces, c);
    if (!goes_through(p, q, at_a, at_b, at_c)) continue;
    // The nearer end, as if it touched the face.
    const Eigen::Vector3d n = normalized(cross(at_b - at_a, at_c - at_a));
    const double of_p = dot(n, p - at_a), of_q = dot(n, q - at_a);
    const bool first = std::abs(of_p) <= std::abs(of_q);
    const Eigen::Vector3d x_on = p + (q - p) * (of_p / (of_p - of_q));
    certificates::FeatureContact touch;
    touch.status = Status::at_start;
    touch.time = query_.from;
    touch.normal = (first ? of_p : of_q) > 0 ? Eigen::Vector3d(-n) : n;  // from the face to where the vertex has to go
    touch.distance = std::abs(first ? of_p : of_q);
    // Where the edge goes through the face, by areas.
    const double area = dot(n, cross(at_b - at_a, at_c - at_a));
    const double wb = dot(n, cross(x_on - at_a, at_c - at_a)) / area;
    const double wc = dot(n, cross(at_b - at_a, x_on - at_a)) / area;
    touch.weights = {1, 1 - wb - wc, wb, wc};
    found(described(kind, {first ? v : w, a, b, c}, face.index, touch));
  }
}

template <int Degree>
template <class Found>
void SurfaceSearch<Degree>::test_insides(const Surface& of_vertices, const Surface& solid, const Found& found) const {
  const auto at = [&](const Surface& surface, std::uint32_t v) { return surface.position(v, query_.from); };
  OverlapSpan span{span_.begin, span_.begin};
  if (!overlap_span<Degree>(of_vertices.boxes()[0], solid.boxes()[0], box_reach_, span)) return;
  for (const SurfaceElement& x : of_vertices.tree().elements()) {
    for (std::size_t k = 0; k < x.corners; ++k) {
      if (!(x.owned_vertices >> k & 1)) continue;
      const Eigen::Vector3d p = at(of_vertices, x.vertices[k]);
      // The face whose plane is nearest.
      double depth = std::numeric_limits<double>::infinity();
      Eigen::Vector3d out = Eigen::Vector3d::UnitX();
      bool inside = true;
      for (const SurfaceElement& y : solid.tree().elements()) {
        const Eigen::Vector3d a = at(solid, y.vertices[0]), b = at(solid, y.vertices[1]), c = at(solid, y.vertices[2]);
        inside = side_of_plane(a, b, c, p) < 0;
        if (!inside) break;
        const Eigen::Vector3d n = normalized(cross(b - a, c - a));
        if (const double d = dot(n, a - p); d < depth) depth = d, out = n;
      }
      if (!inside) continue;
      SurfaceContact contact;
      contact.kind = Kind::inside;
      contact.status = Status::at_start;
      const bool of_a = &of_vertices == &a_;
      contact.contact = {query_.from, p, of_a ? Eigen::Vector3d(-out) : out, {}, {}};
      (of_a ? contact.contact.feature_a : contact.contact.feature_b) = Feature::vertex(x.vertices[k]);
      contact.vertices[0] = x.vertices[k];
      contact.weights[0] = 1;
      contact.distance = depth;
      return found(contact), void();
    }
  }
}

template <int Degree>
Eigen::Vector3d SurfaceSearch<Degree>::point_at(const Surface& surface, const std::uint32_t* vertices,
                                                const double* weights, std::size_t count, double t) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < count; ++k) sum += weights[k] * surface.position(vertices[k], t);
  return sum;
}

/// The corner, the edge or all of it on which the point with the weights lies.
template <int Degree>
Feature SurfaceSearch<Degree>::feature_of(const std::uint32_t* vertices, const double* weights, std::size_t count,
                                          std::uint32_t face) const {
  std::array<std::uint32_t, 3> used{};
  std::size_t n = 0;
  for (std::size_t k = 0; k < count; ++k) {
    if (weights[k] != 0) used[n++] = vertices[k];
  }
  if (n == 1) return Feature::vertex(used[0]);
  return n == 2 ? Feature::edge(used[0], used[1]) : Feature::face(face);
}

template <int Degree>
SurfaceContact SurfaceSearch<Degree>::described(Kind kind, const std::array<std::uint32_t, 4>& vertices,
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
  contact.feature_a = feature_of(v, w, of_a, face);
  contact.feature_b = feature_of(v + of_a, w + of_a, 4 - of_a, face);
  contact.point = point_at(a_, v, w, of_a, touch.time) + normal * a_.radius();
  return result;
}

}  // namespace kds::collision
