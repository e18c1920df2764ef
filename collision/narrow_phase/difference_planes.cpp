#include "collision/narrow_phase/difference_planes.hpp"

#include "collision/narrow_phase/hull_distance.hpp"
#include "collision/shapes/polytope.hpp"
#include "collision/shapes/rotation.hpp"
#include "collision/vectors.hpp"

#include <cmath>

namespace kds::collision {
namespace {

using certificates::DifferenceEdge;
using certificates::HullDifference;
using Eigen::Vector3d;

/// A point of the difference, and those of the two that make it.
struct DifferencePoint {
  Vector3d point;
  std::array<Vector3d, 2> of;
};
const Vector3d& point_of(const DifferencePoint& x) { return x.point; }

/// Of the corners of a core the one that is the farthest along a vector.
const Vector3d& farthest_place(const ConvexCore& core, std::span<const Vector3d> places, const Vector3d& along) {
  const auto& corners = core.structure().corners;
  std::uint32_t best = corners[0];
  double most = dot(along, places[best]);
  for (const std::uint32_t i : corners) {
    if (const double height = dot(along, places[i]); height > most) best = i, most = height;
  }
  return places[best];
}

/// Exactly. Where axes are exact, balls know their products to be zero.
bool parallel(const HullDifference& hulls, const std::array<DifferenceEdge, 2>& edges) {
  const auto quick = hulls.normal<Ball<double>>(edges);
  if (std::any_of(quick.begin(), quick.end(), [](const auto& x) { return certain_sign(x) != 0; })) return false;
  if (std::all_of(quick.begin(), quick.end(), [](const auto& x) { return x.is_zero(); })) return true;
  const auto n = hulls.normal<Exact>(edges);
  return n[0].sign() == 0 && n[1].sign() == 0 && n[2].sign() == 0;
}

}  // namespace

template <int Degree>
DifferencePlanes<Degree>::DifferencePlanes(const PlacedShape& a, const ConvexCore& core_a, const PlacedShape& b,
                                           const ConvexCore& core_b, const HullDifference& hulls,
                                           const std::array<std::vector<Vector3d>, 2>& places, const Quick& motion)
    : bodies_{{{a, core_a, 1}, {b, core_b, -1}}}, hulls_(hulls), places_(places), motion_(motion) {
  for (int d = 0; d < 3; ++d) coordinates_[static_cast<std::size_t>(d)] = motion.along(Vector3d::Unit(d));
}

// ---- What is seen in doubles ----------------------------------------------------------------------------------------

/// Unit vectors known to 2^-48: normals and the ways between points are known to some roundings, and so are their
/// products, which are at right angles.
template <int Degree>
auto DifferencePlanes<Degree>::seen(std::size_t body, std::uint32_t number) const -> SeenEdge {
  const auto& [shape, core, sign] = bodies_[body];
  const HullEdge& edge = core.structure().edges[number];
  const Vector3d u = normalized(core.points()[edge.ends[1]] - core.points()[edge.ends[0]]);
  SeenEdge seen;
  seen.along = sign * rotated(shape.rotation, u);
  if (edge.faces[0] == HullStructure::no_face) return seen;
  seen.faces = 2;
  seen.inward[0] = sign * rotated(shape.rotation, cross(core.normal(edge.faces[0]), u));
  seen.inward[1] = sign * rotated(shape.rotation, cross(u, core.normal(edge.faces[1])));
  return seen;
}

/// Whether the edge may be the farthest part of its polytope along n, a vector across it of length up to 1.
template <int Degree>
bool DifferencePlanes<Degree>::SeenEdge::may_support(const Vector3d& n) const {
  constexpr double rounding = 0x1p-44;
  for (std::size_t k = 0; k < faces; ++k) {
    if (dot(inward[k], n) > rounding) return false;
  }
  return true;
}

template <int Degree>
Vector3d DifferencePlanes<Degree>::place(double tau) const {
  return {Quick::value(coordinates_[0], tau), Quick::value(coordinates_[1], tau), Quick::value(coordinates_[2], tau)};
}

/// How far the place of b may get from where it is at tau, until `last`.
template <int Degree>
double DifferencePlanes<Degree>::reach(double tau, double last) const {
  double sum = 0, power = 1, power_of_last = 1;
  for (std::size_t i = 1; i <= Degree; ++i) {
    power *= tau, power_of_last *= last;
    const Vector3d coefficient(coordinates_[0][i], coordinates_[1][i], coordinates_[2][i]);
    sum += norm(coefficient) * (power_of_last - power);
  }
  return sum * (1 + 0x1p-40);
}

/// How far the place of b may be, between two times, from the chord between where it is at these.
template <int Degree>
double DifferencePlanes<Degree>::bend(double tau, double last) const {
  double most = 0, power = 1;  // of the second derivative
  for (std::size_t i = 2; i <= Degree; ++i, power *= last) {
    const Vector3d coefficient(coordinates_[0][i], coordinates_[1][i], coordinates_[2][i]);
    most += static_cast<double>(i * (i - 1)) * norm(coefficient) * power;
  }
  return 0.125 * most * (last - tau) * (last - tau) * (1 + 0x1p-40);
}

/// Sums of corners with positive weights, so that they are points of the two but for roundings, whether they are the
/// nearest ones or not.
template <int Degree>
auto DifferencePlanes<Degree>::nearest(const Vector3d& place) const -> Nearest {
  const auto farthest = [&](const Vector3d& along) {
    const Vector3d& x = farthest_place(bodies_[in_a].core, places_[in_a], along);
    const Vector3d& y = farthest_place(bodies_[in_b].core, places_[in_b], -along);
    return DifferencePoint{x - y - place, {x, y}};
  };
  const auto found = nearest_to_origin(farthest, Vector3d(-place));
  Nearest nearest{{Vector3d::Zero(), Vector3d::Zero()}, 0};
  for (std::size_t i = 0; i < found.corners.size(); ++i) {
    for (const std::size_t body : {in_a, in_b}) nearest.point[body] += found.weights[i] * found.corners[i].of[body];
  }
  nearest.gap = norm(nearest.point[in_a] - nearest.point[in_b] - place);
  return nearest;
}

/// The faces whose planes a point of the body, from its centre, is no farther below than that, and their edges.
template <int Degree>
auto DifferencePlanes<Degree>::near(std::size_t body, const Vector3d& point, double within) const -> Near {
  const auto& [shape, core, sign] = bodies_[body];
  const HullStructure& structure = core.structure();
  const Vector3d seen = rotated_back(shape.rotation, point);
  Near near;
  std::vector<bool> is_near(structure.faces.size());
  for (std::uint32_t f = 0; f < structure.faces.size(); ++f) {
    if (dot(core.normal(f), core.points()[structure.faces[f][0]] - seen) > within) continue;
    is_near[f] = true;
    near.faces.push_back(f);
  }
  for (std::uint32_t i = 0; i < structure.edges.size(); ++i) {
    const auto& faces = structure.edges[i].faces;
    if (is_near[faces[0]] || is_near[faces[1]]) near.edges.push_back(i);
  }
  return near;
}

// ---- Which planes are needed ----------------------------------------------------------------------------------------

template <int Degree>
bool DifferencePlanes<Degree>::find_more(double from, double until) {
  if (all_) return false;
  const double tau = motion_.tau(from);
  double last = motion_.tau(until);
  if (last > motion_.end() && motion_.whole()) last = std::max(tau, motion_.end());
  if (tau >= 0 && last <= motion_.end()) return find_between(tau, last);
  const std::size_t before = planes_.size();
  find_all([](const Plane&) { return true; });
  return planes_.size() > before;
}

/// Between two times at which it is inside, the place is farther below a plane than at one of them, but for what its
/// path bends. A stretch in which too many planes come near for that is halved. Where it is outside at the end, what
/// counts is how far it gets.
template <int Degree>
bool DifferencePlanes<Degree>::find_between(double tau, double last, int halvings) {
  if (tau == last) return find_at(tau, 0, false) == Found::some;
  constexpr int most_halvings = 40;
  const double middle = tau + (last - tau) / 2, bends = bend(tau, last);
  const bool may_halve = bends > 0 && tau < middle && middle < last && halvings < most_halvings;
  const Found at_last = find_at(last, bends, may_halve);
  if (at_last == Found::some) return true;
  const Found found = at_last == Found::apart  ? find_at(tau, reach(tau, last), false)
                      : at_last == Found::none ? find_at(tau, bends, may_halve)
                                               : at_last;
  if (found != Found::too_many) return found == Found::some;
  return find_between(tau, middle, halvings + 1) || find_between(middle, last, halvings + 1);
}

/// Those that the place is not farther below than that, so long after the time from which the motion is known; or some
/// that keep the two apart then, unless one that is found does.
template <int Degree>
auto DifferencePlanes<Degree>::find_at(double tau, double below, bool may_be_too_many) -> Found {
  if (all_) return Found::none;
  const auto surely_open = [&](const Plane& plane) {
    return plane.known && Quick::value(plane.along, tau) - plane.height > motion_.error();
  };
  if (std::any_of(planes_.begin(), planes_.end(), surely_open)) return Found::apart;
  const auto [point, gap] = nearest(place(tau));
  const bool apart = gap > margin();
  const double within = margin() + (apart ? 0 : gap + below);
  const Near near_a = near(in_a, point[in_a], within), near_b = near(in_b, point[in_b], within);
  const HullStructure &of_a = bodies_[in_a].core.structure(), &of_b = bodies_[in_b].core.structure();
  const std::size_t many = 4 * (of_a.edges.size() + of_b.edges.size());
  if (may_be_too_many && !apart && near_a.edges.size() * near_b.edges.size() > many) return Found::too_many;
  const std::size_t before = planes_.size();
  for (const std::uint32_t f : near_a.faces) add_face(in_a, f);
  for (const std::uint32_t f : near_b.faces) add_face(in_b, f);
  std::vector<SeenEdge> edges_b;
  for (const std::uint32_t j : near_b.edges) edges_b.push_back(seen(in_b, j));
  const double size = bodies_[in_a].shape.bounding_radius + bodies_[in_b].shape.bounding_radius;
  for (const std::uint32_t i : near_a.edges) {
    const SeenEdge u = seen(in_a, i);
    const Vector3d below_a = places_[in_a][of_a.edges[i].ends[0]] - point[in_a];
    for (std::size_t k = 0; k < edges_b.size(); ++k) {
      const std::uint32_t j = near_b.edges[k];
      const Vector3d product = cross(u.along, edges_b[k].along);
      const Vector3d above_b = point[in_b] - places_[in_b][of_b.edges[j].ends[0]];
      const double most = within * norm(product) + 0x1p-44 * size;  // the product is known to 2^-47
      for (const double side : {1.0, -1.0}) {
        const Vector3d n = side * product;
        if (dot(n, below_a) > most || dot(n, above_b) > most) continue;
        if (u.may_support(n) && edges_b[k].may_support(n)) add_edges(i, j, side, product);
      }
    }
  }
  if (planes_.size() == before && apart) find_all([](const Plane&) { return true; });
  return planes_.size() > before ? Found::some : Found::none;
}

/// Of planes that are not found the place is lower below than what find_between() takes: if it is beyond one that is,
/// by what it is apart, that is the outmost.
template <int Degree>
auto DifferencePlanes<Degree>::outmost(double tau) -> Outmost {
  const Vector3d place = this->place(tau);
  find_at(tau, 0, false);
  const double gap = nearest(place).gap;
  for (;;) {
    const Plane* best = nullptr;
    double height = -never;
    for (const Plane& plane : planes_) {
      if (!plane.known) continue;
      const double h = dot(plane.normal, place) - plane.height;
      if (!best || h > height || (h == height && plane.number < best->number)) best = &plane, height = h;
    }
    if (all_ || (best && height > gap - 0.5 * margin())) return {best ? best->normal : Vector3d::UnitX(), height};
    find_all([](const Plane&) { return true; });
  }
}

// ---- Planes ---------------------------------------------------------------------------------------------------------

/// All that may be the farthest along a vector, of a length up to 1 that is known to 2^-47: heights are known to that
/// and some roundings of what a point's coordinates can be.
template <int Degree>
auto DifferencePlanes<Degree>::farthest_points(std::size_t body, const Vector3d& along) -> Points {
  constexpr double rounding = 0x1p-44;
  const std::vector<Vector3d>& places = places_[body];
  const auto& corners = bodies_[body].core.structure().corners;
  double most = -never, size = 0;
  for (const std::uint32_t i : corners) {
    most = std::max(most, dot(along, places[i]));
    size = std::max(size, places[i].cwiseAbs().maxCoeff());
  }
  const auto begin = static_cast<std::uint32_t>(points_.size());
  for (const std::uint32_t i : corners) {
    if (dot(along, places[i]) >= most - rounding * size) points_.push_back(i);
  }
  return {begin, static_cast<std::uint32_t>(points_.size())};
}

/// Whether it had not been found.
template <int Degree>
bool DifferencePlanes<Degree>::add_face(std::size_t body, std::uint32_t face) {
  const std::uint64_t number = face + (body == in_b ? faces(in_a) : 0);
  if (is_found(number)) return false;
  const auto [p, q, r] = spanning_corners(bodies_[body].core.structure().faces[face]);
  if (body == in_a) {
    add({{{false, p, q}, {false, p, r}}}, {p, std::nullopt}, nullptr, number);
  } else {  // seen from outside of -B they turn the other way
    add({{{true, p, r}, {true, p, q}}}, {std::nullopt, p}, nullptr, number);
  }
  return true;
}

/// The same; false, too, if they are parallel. `product`: of the edges as they are in the difference.
template <int Degree>
bool DifferencePlanes<Degree>::add_edges(std::uint32_t edge_a, std::uint32_t edge_b, double side,
                                         const Vector3d& product) {
  const std::uint64_t number = this->number(edge_a, edge_b, side);
  if (is_found(number)) return false;
  constexpr double maybe_parallel = 0x1p-44;  // the edges are known to 2^-48
  const auto [a0, a1] = bodies_[in_a].core.structure().edges[edge_a].ends;
  const auto [b0, b1] = bodies_[in_b].core.structure().edges[edge_b].ends;
  const DifferenceEdge u{false, side > 0 ? a0 : a1, side > 0 ? a1 : a0}, v{true, b0, b1};
  if (norm(product) < maybe_parallel && parallel(hulls_, {u, v})) return false;
  const Vector3d n = side * product;  // -B: directions and ends of b are turned round
  add({u, v}, {}, &n, number);
  return true;
}

/// `on`: a point of the body in the plane, if it is known; `across`: the normal for those of both, if not.
template <int Degree>
void DifferencePlanes<Degree>::add(const std::array<DifferenceEdge, 2>& edges,
                                   const std::array<std::optional<std::uint32_t>, 2>& on, const Vector3d* across,
                                   std::uint64_t number) {
  const PreciseVector u = precise_direction(hulls_, edges[0]), v = precise_direction(hulls_, edges[1]);
  Plane plane{edges, {}, {}, false, {}, 0, number};
  plane.normal = unit_vector(cross(u, v), norm(u.rounded()) * norm(v.rounded()), plane.known);
  const Vector3d& along = across ? *across : plane.normal;
  for (const std::size_t body : {in_a, in_b}) {
    if (!on[body]) {
      plane.farthest[body] = farthest_points(body, bodies_[body].sign * along);
    } else {
      const auto begin = static_cast<std::uint32_t>(points_.size());
      points_.push_back(*on[body]);
      plane.farthest[body] = {begin, begin + 1};
    }
    double most = -never;
    for (const std::uint32_t i : points(plane.farthest[body])) {
      most = std::max(most, bodies_[body].sign * dot(plane.normal, places_[body][i]));
    }
    plane.height += most;
  }
  plane.along = motion_.along(plane.normal);
  planes_.push_back(plane);
  numbers_.insert(std::lower_bound(numbers_.begin(), numbers_.end(), number), number);
}

#define KDS_INSTANTIATE(degree) template class DifferencePlanes<degree>;
KDS_FOR_EACH_DEGREE(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
