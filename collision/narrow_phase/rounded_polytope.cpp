#include "collision/narrow_phase/rounded_polytope.hpp"

#include "collision/narrow_phase/zonotope_cells.hpp"
#include "collision/precise_vector.hpp"
#include "collision/shapes/rotation.hpp"
#include "collision/vectors.hpp"

#include <cmath>

namespace kds::collision {
namespace {

using certificates::DifferenceEdge;
using certificates::DifferencePart;
using certificates::DifferenceSide;
using certificates::HullDifference;
using Eigen::Vector3d;

std::vector<Vector3d> places_of(const ConvexCore& core, const PlacedShape& shape) {
  std::vector<Vector3d> places;
  places.reserve(core.points().size());
  for (const Vector3d& p : core.points()) places.push_back(rotated(shape.rotation, p));
  return places;
}

/// A direction of the difference in double-doubles: the difference of points is exact, the matrix makes some 2^-100.
PreciseVector precise_direction(const HullDifference& hulls, const DifferenceEdge& edge) {
  const certificates::TurnedPoints& body = edge.of_b ? hulls.b : hulls.a;
  const PreciseVector way = precise_difference(body.points[edge.to], body.points[edge.from]);
  return body.turn * (edge.of_b ? way * -1.0 : way);
}

/// The same as a unit vector: known to ten roundings.
Vector3d unit_direction(const HullDifference& hulls, const DifferenceEdge& edge) {
  const certificates::TurnedPoints& body = edge.of_b ? hulls.b : hulls.a;
  const Vector3d way = body.points[edge.to] - body.points[edge.from];
  return normalized(rotated(body.turn, edge.of_b ? Vector3d(-way) : way));
}

/// A vector that was made of others, unit up to some roundings; `known`: it is that. `lengths`: the product of the
/// lengths of what was multiplied, whose cancellation leaves 2^-95 of it.
Vector3d unit_vector(const PreciseVector& v, double lengths, bool& known) {
  const Vector3d rounded = v.rounded();
  known = norm(rounded) >= unknown_normal * lengths;
  return known ? normalized(rounded) : Vector3d(Vector3d::Zero());
}

/// Exactly. Where axes are exact, balls know their products to be zero.
bool parallel(const HullDifference& hulls, const std::array<DifferenceEdge, 2>& edges) {
  const auto quick = hulls.normal<Ball<double>>(edges);
  if (std::any_of(quick.begin(), quick.end(), [](const auto& x) { return certain_sign(x) != 0; })) return false;
  if (std::all_of(quick.begin(), quick.end(), [](const auto& x) { return x.is_zero(); })) return true;
  const auto n = hulls.normal<Exact>(edges);
  return n[0].sign() == 0 && n[1].sign() == 0 && n[2].sign() == 0;
}

/// An edge as doubles see it: its direction, and those in its two faces that lead away from it, which for a segment are
/// left out.
struct SeenEdge {
  Vector3d along = Vector3d::Zero();
  std::array<Vector3d, 2> inward{Vector3d::Zero(), Vector3d::Zero()};
  std::size_t faces = 0;
};

/// Unit vectors known to 2^-48: normals and the ways between points are known to some roundings, and so are their
/// products, which are at right angles.
std::vector<SeenEdge> seen_edges(const ConvexCore& core, const PlacedShape& shape, double sign) {
  const HullStructure& structure = core.structure();
  std::vector<Vector3d> normals;
  for (const std::vector<std::uint32_t>& face : structure.faces) {
    const auto [a, b, c] = spanning_corners(face);
    normals.push_back(unit_normal(core.points()[a], core.points()[b], core.points()[c]));
  }
  std::vector<SeenEdge> edges;
  for (const HullEdge& edge : structure.edges) {
    const Vector3d u = normalized(core.points()[edge.ends[1]] - core.points()[edge.ends[0]]);
    SeenEdge& seen = edges.emplace_back();
    seen.along = sign * rotated(shape.rotation, u);
    if (edge.faces[0] == HullStructure::no_face) continue;
    seen.faces = 2;
    seen.inward[0] = sign * rotated(shape.rotation, cross(normals[edge.faces[0]], u));
    seen.inward[1] = sign * rotated(shape.rotation, cross(u, normals[edge.faces[1]]));
  }
  return edges;
}

/// Whether an edge may be the farthest part of a polytope along n, a vector across it of length up to 1.
bool may_support(const SeenEdge& edge, const Vector3d& n) {
  constexpr double rounding = 0x1p-44;
  for (std::size_t k = 0; k < edge.faces; ++k) {
    if (dot(edge.inward[k], n) > rounding) return false;
  }
  return true;
}

}  // namespace

/// Error bounds: QuickMotion has room for axes that are off by some roundings and for the heights of points, sums of
/// six products; see RoundedZonotope.
template <int Degree>
RoundedPolytope<Degree>::RoundedPolytope(const Body& a, const Body& b, double now, double horizon, bool all_planes)
    : a_(a),
      b_(b),
      core_a_(a.shape.shape),
      core_b_(b.shape.shape),
      hulls_{{a.shape.rotation, core_a_.points()}, {b.shape.rotation, core_b_.points()}},
      radius_(core_a_.radius() + core_b_.radius()),
      motion_(a.motion, b.motion, now, horizon, a.shape.bounding_radius + b.shape.bounding_radius),
      window_{0, 0},
      all_planes_(all_planes) {
  const Vector3d above = a.shape.high - b.shape.low;
  const Vector3d below = b.shape.high - a.shape.low;
  for (int d = 0; d < 3; ++d) {
    const auto k = static_cast<std::size_t>(d);
    coordinates_[k] = motion_.along(Vector3d::Unit(d));
    motion_.note_parting(coordinates_[k], std::max(above[d], below[d]));
  }
  window_ = {0, motion_.end()};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto d = static_cast<Eigen::Index>(k);
    if (!near(coordinates_[k], 1, above[d]) || !near(coordinates_[k], -1, below[d])) return;
  }
  places_ = {places_of(core_a_, a.shape), places_of(core_b_, b.shape)};
  add_planes();
}

/// Whether b's place may be below a plane; cuts the window.
template <int Degree>
bool RoundedPolytope<Degree>::near(const Along& along, double side, double within) {
  if (motion_.clip(along, side, within, window_)) return true;
  apart_ = motion_.whole();
  window_ = after_end();
  return !apart_ || all_planes_;
}

template <int Degree>
auto RoundedPolytope<Degree>::one_point(std::uint32_t i) -> Points {
  points_.push_back(i);
  const auto end = static_cast<std::uint32_t>(points_.size());
  return {end - 1, end};
}

/// All that may be the farthest along a vector, of a length up to 1 that is known to 2^-47: heights are known to that
/// and some roundings of what a point's coordinates can be.
template <int Degree>
auto RoundedPolytope<Degree>::farthest_points(const ConvexCore& core, std::span<const Vector3d> places,
                                              const Vector3d& along) -> Points {
  constexpr double rounding = 0x1p-44;
  double most = -never, size = 0;
  for (const std::uint32_t i : core.structure().corners) {
    most = std::max(most, dot(along, places[i]));
    size = std::max(size, places[i].cwiseAbs().maxCoeff());
  }
  const auto begin = static_cast<std::uint32_t>(points_.size());
  for (const std::uint32_t i : core.structure().corners) {
    if (dot(along, places[i]) >= most - rounding * size) points_.push_back(i);
  }
  return {begin, static_cast<std::uint32_t>(points_.size())};
}

template <int Degree>
void RoundedPolytope<Degree>::add_planes() {
  const HullStructure& of_a = core_a_.structure();
  const HullStructure& of_b = core_b_.structure();
  for (const std::vector<std::uint32_t>& face : of_a.faces) {
    const auto [p, q, r] = spanning_corners(face);
    const std::array<DifferenceEdge, 2> edges{{{false, p, q}, {false, p, r}}};
    const auto farthest = [this, corner = p](const Vector3d& n) -> std::array<Points, 2> {
      const Points on_face = one_point(corner);
      return {on_face, farthest_points(core_b_, places_[1], -n)};
    };
    if (!add_plane(edges, farthest)) return;
  }
  for (const std::vector<std::uint32_t>& face : of_b.faces) {  // seen from outside of -B they turn the other way
    const auto [p, q, r] = spanning_corners(face);
    const std::array<DifferenceEdge, 2> edges{{{true, p, r}, {true, p, q}}};
    const auto farthest = [this, corner = p](const Vector3d& n) -> std::array<Points, 2> {
      const Points on_a = farthest_points(core_a_, places_[0], n);
      return {on_a, one_point(corner)};
    };
    if (!add_plane(edges, farthest)) return;
  }
  if (of_b.edges.empty()) return;
  constexpr double maybe_parallel = 0x1p-44;  // the edges are known to 2^-48
  const std::vector<SeenEdge> edges_a = seen_edges(core_a_, a_.shape, 1);
  const std::vector<SeenEdge> edges_b = seen_edges(core_b_, b_.shape, -1);
  for (std::size_t i = 0; i < edges_a.size(); ++i) {
    for (std::size_t j = 0; j < edges_b.size(); ++j) {
      const Vector3d product = cross(edges_a[i].along, edges_b[j].along);
      for (const double side : {1.0, -1.0}) {
        const Vector3d n = side * product;
        if (!may_support(edges_a[i], n) || !may_support(edges_b[j], n)) continue;
        const auto [a0, a1] = of_a.edges[i].ends;
        const auto [b0, b1] = of_b.edges[j].ends;
        const DifferenceEdge u{false, side > 0 ? a0 : a1, side > 0 ? a1 : a0}, v{true, b0, b1};
        if (norm(product) < maybe_parallel && parallel(hulls_, {u, v})) continue;
        // -B: directions and ends of b are turned round. The product of its edge as it is in the difference is n.
        const auto farthest = [&](const Vector3d&) -> std::array<Points, 2> {
          const Points of_a_points = farthest_points(core_a_, places_[0], n);
          return {of_a_points, farthest_points(core_b_, places_[1], -n)};
        };
        if (!add_plane({u, v}, farthest)) return;
      }
    }
  }
}

/// False if b's place is never below it. `farthest(normal)`: points of both.
template <int Degree>
template <class Farthest>
bool RoundedPolytope<Degree>::add_plane(const std::array<DifferenceEdge, 2>& edges, const Farthest& farthest) {
  Plane plane{edges, {}, {}, false, {}, 0};
  const PreciseVector u = precise_direction(hulls_, edges[0]), v = precise_direction(hulls_, edges[1]);
  plane.normal = unit_vector(cross(u, v), norm(u.rounded()) * norm(v.rounded()), plane.known);
  plane.farthest = farthest(plane.normal);
  double of_a = -never, of_b = -never;
  for (std::uint32_t k = plane.farthest[0].begin; k < plane.farthest[0].end; ++k) {
    of_a = std::max(of_a, dot(plane.normal, places_[0][points_[k]]));
  }
  for (std::uint32_t k = plane.farthest[1].begin; k < plane.farthest[1].end; ++k) {
    of_b = std::max(of_b, -dot(plane.normal, places_[1][points_[k]]));
  }
  plane.height = of_a + of_b;
  plane.along = motion_.along(plane.normal);
  planes_.push_back(plane);
  return !plane.known || near(plane.along, 1, plane.height + radius_);
}

template <int Degree>
auto RoundedPolytope<Degree>::outmost(const Vector3d& place) const -> Outmost {
  Outmost result{Vector3d::UnitX(), -never};
  for (const Plane& plane : planes_) {
    if (!plane.known) continue;
    const double height = dot(plane.normal, place) - plane.height;
    if (height > result.height) result = {plane.normal, height};
  }
  return result;
}

// ---- Pieces ----------------------------------------------------------------------------------------------------

template <int Degree>
RoundedPolytope<Degree>::Piece::Piece(const RoundedPolytope& pair) : pair_(&pair), solid_(true), window_(pair.window_) {
  for (const Plane& plane : pair.planes_) {
    if (!plane.known || pair.motion_.clip(plane.along, 1, plane.height, window_)) continue;
    window_ = pair.motion_.whole() ? TimeWindow{1, 0} : pair.after_end();
    if (!possible()) return;
  }
}

template <int Degree>
RoundedPolytope<Degree>::Piece::Piece(const RoundedPolytope& pair, const DifferencePart& part,
                                      std::span<const DifferenceSide> sides)
    : pair_(&pair), solid_(false), part_(part), distance_(pair.motion_, pair.radius_), window_(pair.window_) {
  bool near = add_distance();
  for (const DifferenceSide& side : sides) {
    if (!near && pair.motion_.whole()) break;
    near = add_side(side) && near;
  }
  if (!near) window_ = pair.motion_.whole() ? TimeWindow{1, 0} : pair.after_end();
}

/// The coordinates of the distance from what the part spans; whether that may be less than the radius.
template <int Degree>
bool RoundedPolytope<Degree>::Piece::add_distance() {
  const RoundedPolytope& pair = *pair_;
  const Vector3d at = pair.places_[0][part_.point[0]] - pair.places_[1][part_.point[1]];
  const auto shifted = [](Along p, double by) {
    p[0] -= by;
    return p;
  };
  if (part_.dimension == 2) {
    // Most are far off, which a normal says that is known to 2^-38: QuickMotion charges 2^-46 for axes that are known
    // better.
    const Vector3d roughly =
        cross(unit_direction(pair.hulls_, part_.edges[0]), unit_direction(pair.hulls_, part_.edges[1]));
    if (norm(roughly) > 0x1p-9) {
      const Vector3d n = normalized(roughly);
      const Along along = shifted(pair.motion_.along(n), dot(n, at));
      const double within = pair.radius_ + 0x1p9 * pair.motion_.error();
      if (!pair.motion_.clip(along, 1, within, window_) || !pair.motion_.clip(along, -1, within, window_)) return false;
    }
    const PreciseVector u = precise_direction(pair.hulls_, part_.edges[0]);
    const PreciseVector v = precise_direction(pair.hulls_, part_.edges[1]);
    bool known = false;
    const Vector3d normal = unit_vector(cross(u, v), norm(u.rounded()) * norm(v.rounded()), known);
    if (known) distance_.add(shifted(pair.motion_.along(normal), dot(normal, at)));
    return distance_.clip(window_);
  }
  Vector3d u = Vector3d::Zero();
  if (part_.dimension == 1) u = unit_direction(pair.hulls_, part_.edges[0]);
  const Along along = shifted(pair.motion_.along(u), dot(u, at));
  for (std::size_t d = 0; d < 3; ++d) {
    const auto i = static_cast<Eigen::Index>(d);
    Along y = shifted(pair.coordinates_[d], at[i]);
    for (std::size_t k = 0; k <= Degree; ++k) y[k] -= along[k] * u[i];
    distance_.add(y);
  }
  return distance_.clip(window_);
}

template <int Degree>
bool RoundedPolytope<Degree>::Piece::add_side(const DifferenceSide& side) {
  const RoundedPolytope& pair = *pair_;
  const PreciseVector e = precise_direction(pair.hulls_, side.edge);
  PreciseVector m = e;
  double lengths = norm(e.rounded());
  if (side.of_face) {
    const PreciseVector u = precise_direction(pair.hulls_, side.normal[0]);
    const PreciseVector v = precise_direction(pair.hulls_, side.normal[1]);
    m = cross(e, cross(u, v));
    lengths *= norm(u.rounded()) * norm(v.rounded());
  }
  bool known = false;
  const Vector3d axis = unit_vector(m, lengths, known);
  const Vector3d at = pair.places_[0][side.point[0]] - pair.places_[1][side.point[1]];
  sides_.push_back({side, known, pair.motion_.along(axis), dot(axis, at)});
  return !known || pair.motion_.clip(sides_.back().along, 1, sides_.back().height, window_);
}

/// Calls ask(along, height) of a gap that is no distance, if it is known; else returns what that gives for nothing.
template <int Degree>
template <class Ask>
auto RoundedPolytope<Degree>::Piece::filter(std::size_t i, const Ask& ask) const {
  if (solid_) {
    const Plane& plane = pair_->planes_[i];
    return ask(plane.known, plane.along, plane.height);
  }
  return ask(sides_[i].known, sides_[i].along, sides_[i].height);
}

template <int Degree>
template <class Ask>
auto RoundedPolytope<Degree>::Piece::with_gap(std::size_t i, const Ask& ask) const {
  const RoundedPolytope& pair = *pair_;
  const auto& a = pair.a_.motion;
  const auto& b = pair.b_.motion;
  if (solid_) {
    const Plane& plane = pair.planes_[i];
    const auto points = [&](const Points& some) {
      return std::span(pair.points_).subspan(some.begin, some.end - some.begin);
    };
    return ask(certificates::DifferencePlane<Degree>{
        a, b, pair.hulls_, plane.edges, {points(plane.farthest[0]), points(plane.farthest[1])}});
  }
  if (is_distance(i)) {
    return ask(
        certificates::PartDistance<Degree>{a, b, pair.hulls_, part_, {pair.core_a_.radius(), pair.core_b_.radius()}});
  }
  return ask(certificates::BeyondSide<Degree>{a, b, pair.hulls_, sides_[i].side});
}

template <int Degree>
double RoundedPolytope<Degree>::Piece::failure_time(std::size_t i, double t, double horizon) const {
  return with_gap(i, [&](const auto& gap) { return kds::failure_time(gap, t, horizon); });
}

template <int Degree>
double RoundedPolytope<Degree>::Piece::recovery_time(std::size_t i, double t, double horizon) const {
  return with_gap(i, [&](const auto& gap) { return kds::recovery_time(gap, t, horizon); });
}

template <int Degree>
bool RoundedPolytope<Degree>::Piece::closed(std::size_t i, double t) const {
  return with_gap(i, [&](const auto& gap) { return sign_after(gap, t) < 0; });
}

template <int Degree>
bool RoundedPolytope<Degree>::Piece::surely_closed(std::size_t i, double t) const {
  const Quick& motion = pair_->motion_;
  const double tau = motion.tau(t);
  if (is_distance(i)) return distance_.size() > 0 && distance_.surely_closed(tau);
  return filter(i, [&](bool known, const Along& along, double height) {
    return known && motion.surely_closed(along, 1, height, tau);
  });
}

template <int Degree>
double RoundedPolytope<Degree>::Piece::closed_until(std::size_t i, double t) const {
  if (is_distance(i)) return t;
  return filter(i, [&](bool known, const Along& along, double height) {
    return known ? pair_->motion_.closed_until(along, 1, height, t) : t;
  });
}

template <int Degree>
double RoundedPolytope<Degree>::Piece::opened_by(std::size_t i) const {
  const Quick& motion = pair_->motion_;
  if (is_distance(i)) return distance_.size() > 0 ? motion.time_after(distance_.opened_by()) : never;
  return filter(i, [&](bool known, const Along& along, double height) {
    return known ? motion.time_after(motion.opened_by(along, 1, height)) : never;
  });
}

#define KDS_INSTANTIATE(degree) template class RoundedPolytope<degree>;
KDS_FOR_EACH_DEGREE(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
