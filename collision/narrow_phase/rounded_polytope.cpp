#include "collision/narrow_phase/rounded_polytope.hpp"

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

/// A direction of the difference as a unit vector: known to ten roundings.
Vector3d unit_direction(const HullDifference& hulls, const DifferenceEdge& edge) {
  const certificates::TurnedPoints& body = edge.of_b ? hulls.b : hulls.a;
  const Vector3d way = body.points[edge.to] - body.points[edge.from];
  return normalized(rotated(body.turn, edge.of_b ? Vector3d(-way) : way));
}

}  // namespace

/// Error bounds: QuickMotion has room for axes that are off by some roundings and for the heights of points, sums of
/// six products; see RoundedZonotope.
template <int Degree>
RoundedPolytope<Degree>::RoundedPolytope(const Body& a, const Body& b, double now, double horizon, bool even_apart)
    : a_(a),
      b_(b),
      core_a_(a.shape.shape),
      core_b_(b.shape.shape),
      hulls_{{a.shape.rotation, core_a_.points()}, {b.shape.rotation, core_b_.points()}},
      radius_(core_a_.radius() + core_b_.radius()),
      motion_(a.motion, b.motion, now, horizon, a.shape.bounding_radius + b.shape.bounding_radius),
      planes_(a.shape, core_a_, b.shape, core_b_, hulls_, places_, motion_),
      window_{0, 0},
      even_apart_(even_apart) {
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
  if (!core_a_.solid() || !core_b_.solid()) {
    planes_.find_all([this](const Plane& plane) { return near(plane); });
  } else if (!even_apart) {
    find_first_planes();
  }
}

/// Planes that keep the two apart until the window begins, and move its beginning.
template <int Degree>
void RoundedPolytope<Degree>::find_first_planes() {
  constexpr int most_rounds = 8;
  for (int round = 0; round < most_rounds; ++round) {
    const std::size_t known = planes_.found().size();
    const double begin = window_.begin;
    if (!planes_.find_more_at(begin)) return;
    for (const Plane& plane : planes_.found().subspan(known)) {
      if (!near(plane)) return;
    }
    if (window_.begin == begin) return;
  }
}

/// Whether b's place may be below a plane; cuts the window.
template <int Degree>
bool RoundedPolytope<Degree>::near(const Along& along, double side, double within) {
  if (motion_.clip(along, side, within, window_)) return true;
  apart_ = motion_.whole();
  window_ = after_end();
  return !apart_ || even_apart_;
}

// ---- Pieces ----------------------------------------------------------------------------------------------------

template <int Degree>
RoundedPolytope<Degree>::Piece::Piece(const RoundedPolytope& pair) : pair_(&pair), solid_(true), window_(pair.window_) {
  for (const Plane& plane : pair.planes_.found()) {
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
    const Plane& plane = pair_->planes_.found()[i];
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
    const Plane& plane = pair.planes_.found()[i];
    return ask(certificates::DifferencePlane<Degree>{
        a,
        b,
        pair.hulls_,
        plane.edges,
        {pair.planes_.points(plane.farthest[0]), pair.planes_.points(plane.farthest[1])}});
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
