#include "collision/narrow_phase/capsule_touch.hpp"

#include "collision/narrow_phase/near_spans.hpp"
#include "collision/narrow_phase/placed_surface.hpp"
#include "collision/narrow_phase/round_touch.hpp"
#include "collision/narrow_phase/segment_ways.hpp"
#include "collision/narrow_phase/zonotope_cells.hpp"
#include "collision/vectors.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace kds::collision {
namespace {

using Eigen::Vector3d;

/// Zero stays zero.
Vector3d unit_or_zero(const Vector3d& v) {
  const double largest = v.cwiseAbs().maxCoeff();
  if (!(largest > 0)) return Vector3d::Zero();
  const Vector3d scaled = v / largest;
  return scaled / std::sqrt(dot(scaled, scaled));
}

/// How deep within the prism of a triangle and a segment what is nearer to its faces ends, in radii.
constexpr double inset = 0.5;

/// The part of v across a unit vector.
Vector3d across(const Vector3d& v, const Vector3d& along) { return v - dot(along, v) * along; }

/// The directions of the parallelogram of an edge and a segment: that of the longer one, across it within the
/// parallelogram, and across both.
struct Frame {
  Vector3d along;
  Vector3d beside;
  Vector3d normal;
};
Frame frame_of(const Vector3d& edge, const Vector3d& segment) {
  const Vector3d along = unit_or_zero(dot(edge, edge) > dot(segment, segment) ? edge : segment);
  Vector3d normal = unit_or_zero(across(unit_or_zero(accurate_cross(edge, segment)), along));
  if (normal.isZero(0)) {
    int smallest = 0;
    along.cwiseAbs().minCoeff(&smallest);
    normal = unit_or_zero(cross(along, Vector3d::Unit(smallest)));
  }
  return {along, cross(normal, along), normal};
}

}  // namespace

template <int Degree>
CapsuleTouch<Degree>::CapsuleTouch(const PlacedTriangle& triangle, const PlacedCapsule& capsule,
                                   const RelativeMotion<Degree>& motion, const ContactGap<Degree>& gap, bool sharp,
                                   double horizon, const TimeWindow& interest)
    : triangle_(triangle),
      half_(capsule.half),
      radius_(capsule.radius),
      motion_(motion),
      gap_(gap),
      horizon_(horizon),
      interest_{std::max(interest.begin, 0.0), std::min(interest.end, horizon)} {
  add_inside();
  for (const double end : {-1.0, 1.0}) add_triangle(end, sharp);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t next = (i + 1) % 3;
    const auto far = beyond(triangle_, i);
    add_parallelogram(i);
    std::vector<Vector3d> around;
    if (!flat_corner(triangle_, i)) each_around(triangle_, i, [&](const Vector3d& each) { around.push_back(each); });
    if (!flat_corner(triangle_, i)) add_line(corner(i, -1), corner(i, 1), around, -1);
    for (const double end : {-1.0, 1.0}) {
      std::vector<Vector3d> beside;
      if (triangle_.surface) beside.push_back(triangle_.vertices[(i + 2) % 3]);
      if (far) beside.push_back(*far);
      if (!flat_edge(triangle_, i)) add_line(corner(i, end), corner(next, end), beside, end);
      if (!flat_corner(triangle_, i)) add_point(corner(i, end), around, end);
    }
  }
}

template <int Degree>
auto CapsuleTouch<Degree>::from(const Vector3d& at) const -> Path {
  Path path = motion_.coefficients;
  path[0] -= at;
  return path;
}

/// When normal . r - distance < gap, or < 0.
template <int Degree>
SpansOf<Degree> CapsuleTouch<Degree>::below(const Vector3d& normal, double distance, bool with_gap) const {
  const auto& r = motion_.coefficients;
  std::array<double, std::size_t{Degree} + 1> c;
  for (std::size_t i = 0; i <= Degree; ++i) c[i] = dot(normal, r[i]) - (with_gap ? gap_.c[i] : 0.0);
  c[0] -= distance;
  return spans_below_zero<Degree>(c, horizon_);
}

/// Slightly more than the distance of the farthest corner.
template <int Degree>
void CapsuleTouch<Degree>::bound(Piece& piece, const Vector3d& out, Corners corners, double more) const {
  double distance = -TimeSpans::infinity;
  for (const Vector3d& each : corners) distance = std::max(distance, dot(out, each));
  piece.conditions.push_back(below(out, distance + more));
}

/// As BallTouch::matters().
template <int Degree>
bool CapsuleTouch<Degree>::matters(const Path& path) const {
  return may_come_near<Degree>(path, interest_, radius_ + 4 * gap_(interest_.end));
}

template <int Degree>
SpansOf<Degree> CapsuleTouch<Degree>::within(const Path& path) const {
  std::array<double, std::size_t{Degree} + 1> distance = gap_.c;
  distance[0] += radius_;
  return near_spans(path, distance, horizon_);
}

/// Pieces whose conditions hold at no time of interest are left out.
template <int Degree>
void CapsuleTouch<Degree>::add(const Piece& piece) {
  if (first_inside_all(piece.spans(), interest_.begin) <= interest_.end) pieces_.add(piece);
}

template <int Degree>
void CapsuleTouch<Degree>::add_inside() {
  const Vector3d normal = unit_or_zero(accurate_cross(triangle_.edge(0), triangle_.edge(1)));
  const double thickness = std::abs(dot(normal, half_));
  if (!(thickness > radius_)) return;
  Piece piece;
  const double depth = inset * radius_;
  const double height = dot(normal, triangle_.vertices[0]);
  piece.conditions.push_back(below(normal, height + thickness - depth, false));
  piece.conditions.push_back(below(-normal, -height + thickness - depth, false));
  for (std::size_t i = 0; i < 3; ++i) {
    Vector3d out = frame_of(triangle_.edge(i), half_).normal;
    const Vector3d& third = triangle_.vertices[(i + 2) % 3];
    if (dot(out, third - triangle_.vertices[i]) > 0) out = -out;
    piece.conditions.push_back(below(out, dot(out, triangle_.vertices[i]) - depth, false));
  }
  add(piece);
}

/// The triangle at one end of the segment.
template <int Degree>
void CapsuleTouch<Degree>::add_triangle(double end, bool sharp) {
  const Vector3d normal = unit_or_zero(accurate_cross(triangle_.edge(0), triangle_.edge(1)));
  const std::array<Vector3d, 3> corners{corner(0, end), corner(1, end), corner(2, end)};
  Piece piece;
  bound(piece, normal, corners, radius_);
  bound(piece, -normal, corners, radius_);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::array<Vector3d, 2> ends{corners[i], corners[(i + 1) % 3]};
    bound(piece, unit_or_zero(cross(triangle_.edge(i), normal)), ends);
  }
  // Across each corner: away from the middle between the directions of its edges.
  for (std::size_t i = 0; sharp && i < 3; ++i) {
    bound(piece, unit_or_zero(unit_or_zero(triangle_.edge((i + 2) % 3)) - unit_or_zero(triangle_.edge(i))), corners);
  }
  add(piece);
}

template <int Degree>
void CapsuleTouch<Degree>::add_parallelogram(std::size_t edge) {
  const std::size_t next = (edge + 1) % 3;
  const std::array<Vector3d, 4> corners{corner(edge, -1), corner(next, -1), corner(next, 1), corner(edge, 1)};
  const Vector3d e = triangle_.edge(edge);
  const Frame frame = frame_of(e, half_);
  Piece piece;
  // On a side on which the surface goes on, and comes out farther, the parallelogram is met from within alone.
  const auto far = beyond(triangle_, edge);
  const double high = far ? dot(frame.normal, Vector3d(*far - triangle_.vertices[edge])) : 0.0;
  const bool flat = flat_edge(triangle_, edge);
  bound(piece, frame.normal, corners, flat || high > gap_.c[0] ? inset * radius_ : radius_);
  bound(piece, -frame.normal, corners, flat || -high > gap_.c[0] ? inset * radius_ : radius_);
  // Across the longer sides, the shorter ones, and the corners.
  const Vector3d shorter = unit_or_zero(across(dot(e, e) > dot(half_, half_) ? half_ : e, frame.normal));
  for (const Vector3d& out : {frame.beside, unit_or_zero(cross(frame.normal, shorter)),
                              unit_or_zero(frame.along + shorter), unit_or_zero(frame.along - shorter)}) {
    bound(piece, out, corners);
    bound(piece, -out, corners);
  }
  add(piece);
}

/// A cylinder about a line, only where no triangle is nearer that has a corner `beside` it, moved to an end of the
/// segment.
template <int Degree>
void CapsuleTouch<Degree>::add_line(const Vector3d& begin, const Vector3d& to, Corners beside, double end) {
  const Vector3d along = unit_or_zero(to - begin);
  Piece piece;
  piece.conditions.push_back(below(along, dot(along, to)));
  piece.conditions.push_back(below(-along, -dot(along, begin)));
  for (const Vector3d& each : beside) {
    if (piece.conditions.size() + 1 == most_conditions) break;  // One fewer leaves the piece larger.
    const PlaneSide side = nearer_to_edge(begin, along, each + end * half_, radius_);
    piece.conditions.push_back(below(side.out, side.distance));
  }
  // The expensive condition last, and only if the others hold.
  if (!(first_inside_all(piece.spans(), interest_.begin) <= interest_.end)) return;
  Path path = from(begin);
  for (Vector3d& c : path) c = across(c, along);
  if (!matters(path)) return;
  piece.conditions.push_back(within(path));
  add(piece);
}

/// A ball about a corner, only where no edge is nearer that leads to a vertex `around` it.
template <int Degree>
void CapsuleTouch<Degree>::add_point(const Vector3d& at, Corners around, double end) {
  const Path path = from(at);
  if (!matters(path)) return;
  Piece piece;
  for (const Vector3d& each : around) {
    if (piece.conditions.size() + 1 == most_conditions) break;
    const Vector3d along = unit_or_zero(Vector3d(each + end * half_ - at));
    piece.conditions.push_back(below(along, dot(along, at)));
  }
  if (!(first_inside_all(piece.spans(), interest_.begin) <= interest_.end)) return;
  piece.conditions.push_back(within(path));
  add(piece);
}

/// The part of the prism that its connection with a place begins on.
template <int Degree>
NearestPart CapsuleTouch<Degree>::part_of(const SegmentWay& way) const {
  Vector3d direction = Vector3d::Zero();
  if (way.dimension == 1) direction = unit_or_zero(way.along);
  if (way.dimension == 2) direction = unit_or_zero(way.along);
  if (way.dimension == 2 && dot(direction, way.apart) < 0) direction = -direction;
  return {{way.at, way.dimension, direction}, way.apart};
}

/// The part that a place of the centre is nearest to. If a gap is given, that is a face over all of the slab of the
/// triangle at an end, which is wider by some gaps.
template <int Degree>
NearestPart CapsuleTouch<Degree>::nearest_part(const Vector3d& place, double gap) const {
  SegmentWay way = shortest_way(triangle_, place, half_);
  const Vector3d face = unit_or_zero(accurate_cross(triangle_.edge(0), triangle_.edge(1)));
  if (gap > 0 && way.dimension < 2 && is_over_face(way.apart, face, radius_, gap)) {
    way.apart = dot(face, way.apart) * face;
    way.dimension = 2;
    way.along = face;
  }
  return part_of(way);
}

template <int Degree>
TouchDirection CapsuleTouch<Degree>::direction(double tau) const {
  const Vector3d centre = motion_.position(tau);
  const Vector3d velocity = motion_.velocity(tau);
  const Vector3d face = unit_or_zero(accurate_cross(triangle_.edge(0), triangle_.edge(1)));
  // How deep the segment penetrates the triangle, by the faces of their prism.
  TouchDirection deepest{face, -TimeSpans::infinity, false};
  const auto look = [&](const Vector3d& normal) {
    const double high = triangle_.project(normal).high + std::abs(dot(normal, half_));
    const double separation = dot(normal, centre) - high;
    if (separation > deepest.separation) deepest = {normal, separation, dot(normal, velocity) < 0};
  };
  look(face), look(-face);
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3d normal = frame_of(triangle_.edge(i), half_).normal;
    look(normal), look(-normal);
  }
  const double gap = gap_(tau);
  const NearestPart nearest = nearest_part(centre, gap);
  const Vector3d& apart = nearest.apart;
  const bool through = deepest.separation < 0;
  if (through || !(apart.cwiseAbs().maxCoeff() > 0)) {
    return {deepest.normal, deepest.separation - radius_, through && deepest.approaching};
  }
  const Vector3d normal = unit_or_zero(apart);
  const double distance = std::sqrt(dot(apart, apart));
  const bool inside = shortest_way(triangle_, centre, half_).dimension == 2;
  bool approaching = false;
  if constexpr (Degree >= 3) {
    // One that has sunk in by a gap approaches however slowly it does.
    const double tilt = nearest.dimension == 2 && distance > radius_ - gap ? tilt_of(triangle_) : 0.0;
    approaching = curve_approaches(motion_, gap, tau, tilt, nearest, inside,
                                   [&](const Vector3d& place) { return nearest_part(place, 0); });
  } else {
    // It may be about to pass from one part to another.
    NearestPart ahead = nearest;
    const Vector3d sideways = across(velocity, normal);
    if (!inside && sideways.cwiseAbs().maxCoeff() > 0) ahead = nearest_part(centre + gap * unit_or_zero(sideways), 0);
    // Off a face it may be carried by its speed, over its edge: then it approaches neither.
    approaching = approach_to(ahead).approaching(tau) &&
                  (nearest.dimension < 2 || inside || approach_to(nearest).approaching(tau));
  }
  return {normal, distance - radius_, approaching};
}

/// As BallTouch::turning().
template <int Degree>
double CapsuleTouch<Degree>::turning(double tau, double end) const {
  const Vector3d face = unit_or_zero(accurate_cross(triangle_.edge(0), triangle_.edge(1)));
  if constexpr (Degree <= 2) {
    const auto look = [&](const PolyhedronPart& each) { end = approach_begins(*this, approach_to(each), tau, end); };
    const auto look_at_both = [&](const Vector3d& at, const Vector3d& normal) {
      look({at, 2, normal}), look({at, 2, -normal});
    };
    for (const double side : {-1.0, 1.0}) look_at_both(corner(0, -side), face);
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector3d edge = triangle_.edge(i);
      const Vector3d normal = accurate_cross(edge, half_);
      if (normal.cwiseAbs().maxCoeff() > 0) look_at_both(corner(i, 0), unit_or_zero(normal));
      look({corner(i, 0), 1, unit_or_zero(half_)});
      for (const double side : {-1.0, 1.0}) {
        look({corner(i, side), 1, unit_or_zero(edge)});
        look({corner(i, side), 0, Vector3d::Zero()});
      }
    }
  } else {
    const auto consider = [&](double top, double distance) {
      const Vector3d apart = shortest_way(triangle_, motion_.position(top), half_).apart;
      if (!(distance <= std::sqrt(dot(apart, apart)) + gap_(top) / 4)) return false;
      end = top;
      return true;
    };
    const auto consider_plane = [&](const Vector3d& normal, const Vector3d& at) {
      distance_maxima(motion_, normal, at, tau, end, consider);
    };
    const auto consider_line = [&](const Vector3d& at, const Vector3d& along) {
      Path path = from(at);
      for (Vector3d& c : path) c = across(c, along);
      distance_maxima<Degree>(path, tau, end, consider);
    };
    for (const double side : {-1.0, 1.0}) consider_plane(face, corner(0, side));
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector3d edge = triangle_.edge(i);
      consider_plane(frame_of(edge, half_).normal, corner(i, 0));
      consider_line(corner(i, 0), unit_or_zero(half_));
      for (const double side : {-1.0, 1.0}) {
        consider_line(corner(i, side), unit_or_zero(edge));
        distance_maxima<Degree>(from(corner(i, side)), tau, end, consider);
      }
    }
  }
  return end;
}

#define KDS_INSTANTIATE(degree) template class CapsuleTouch<degree>;
KDS_FOR_EACH_DEGREE(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
