#include "collision/narrow_phase/ball_touch.hpp"

#include "collision/degrees.hpp"
#include "collision/narrow_phase/placed_surface.hpp"
#include "collision/narrow_phase/round_touch.hpp"
#include "collision/vectors.hpp"

#include <algorithm>
#include <cmath>

namespace kds::collision {
using Eigen::Vector3d;

template <int Degree>
BallTouch<Degree>::BallTouch(const PlacedTriangle& triangle, const PlacedBall& ball,
                             const RelativeMotion<Degree>& motion, const ContactGap<Degree>& gap, double horizon,
                             const TimeWindow& interest)
    : triangle_(triangle),
      radius_(ball.radius),
      motion_(motion),
      gap_(gap),
      horizon_(horizon),
      interest_{std::max(interest.begin, 0.0), std::min(interest.end, horizon)} {}

template <int Degree>
BallTouch<Degree>::BallTouch(const PlacedTriangle& triangle, const PlacedBall& ball,
                             const RelativeMotion<Degree>& motion, const ContactGap<Degree>& gap, bool sharp,
                             double horizon, const TimeWindow& interest)
    : BallTouch(triangle, ball, motion, gap, horizon, interest) {
  add_face(sharp);
  add_rim();
}

template <int Degree>
BallTouch<Degree> BallTouch<Degree>::until_met(const PlacedTriangle& triangle, const PlacedBall& ball,
                                               const RelativeMotion<Degree>& motion, const ContactGap<Degree>& gap,
                                               bool sharp, double horizon, const TimeWindow& interest, double tau) {
  BallTouch touch(triangle, ball, motion, gap, horizon, interest);
  touch.add_face(sharp);
  TimeWindow& left = touch.interest_;
  left.end = std::min(left.end, std::max(left.begin, touch.first_inside(tau)));
  touch.add_rim();
  return touch;
}

/// The edges and vertices.
template <int Degree>
void BallTouch<Degree>::add_rim() {
  for (std::size_t i = 0; i < 3; ++i) {
    if (!flat_edge(triangle_, i)) add_edge(i);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    if (!flat_corner(triangle_, i)) add_vertex(i);
  }
}

template <int Degree>
auto BallTouch<Degree>::from(std::size_t vertex) const -> Path {
  Path path = motion_.coefficients;
  path[0] -= triangle_.vertices[vertex];
  return path;
}

/// The motion across the edge: without its part along the edge.
template <int Degree>
auto BallTouch<Degree>::across_edge(std::size_t i) const -> Path {
  const Vector3d along = unit(triangle_.edge(i));
  Path path = from(i);
  for (Vector3d& c : path) c -= dot(along, c) * along;
  return path;
}

/// When normal . r - distance < gap.
template <int Degree>
SpansOf<Degree> BallTouch<Degree>::below(const Vector3d& normal, double distance) const {
  const auto& r = motion_.coefficients;
  std::array<double, std::size_t{Degree} + 1> c;
  c[0] = dot(normal, r[0]) - distance - gap_.c[0];
  for (std::size_t i = 1; i <= Degree; ++i) c[i] = dot(normal, r[i]) - gap_.c[i];
  return spans_below_zero<Degree>(c, horizon_);
}

/// Whether the path comes near the origin within the window of interest.
template <int Degree>
bool BallTouch<Degree>::matters(const Path& path) const {
  return may_come_near<Degree>(path, interest_, radius_ + 4 * gap_(interest_.end));
}

template <int Degree>
SpansOf<Degree> BallTouch<Degree>::within(const Path& path) const {
  std::array<double, std::size_t{Degree} + 1> distance = gap_.c;
  distance[0] += radius_;
  return near_spans(path, distance, horizon_);
}

template <int Degree>
void BallTouch<Degree>::add_face(bool sharp) {
  const Vector3d normal = unit(cross(triangle_.edge(0), triangle_.edge(1)));
  Piece piece;
  for (const double side : {1.0, -1.0}) {
    const Vector3d out = side * normal;
    piece.conditions.push_back(below(out, triangle_.project(out).high + radius_));
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3d out = unit(cross(triangle_.edge(i), normal));
    piece.conditions.push_back(
        below(out, std::max(dot(out, triangle_.vertices[i]), dot(out, triangle_.vertices[(i + 1) % 3]))));
  }
  // Across each corner: opposite to the mean of the directions of its edges.
  const auto along = [this](std::size_t i) { return unit(triangle_.edge(i)); };
  for (std::size_t i = 0; sharp && i < 3; ++i) {
    const Vector3d out = unit(along((i + 2) % 3) - along(i));
    piece.conditions.push_back(below(out, triangle_.project(out).high));
  }
  pieces_.add(piece);
}

template <int Degree>
void BallTouch<Degree>::add_edge(std::size_t i) {
  const Path path = across_edge(i);
  if (!matters(path)) return;
  const Vector3d along = unit(triangle_.edge(i));
  Piece piece;
  piece.conditions.push_back(below(along, dot(along, triangle_.vertices[(i + 1) % 3])));
  piece.conditions.push_back(below(-along, -dot(along, triangle_.vertices[i])));
  const auto add_before = [&](const Vector3d& far) {
    const PlaneSide side = nearer_to_edge(triangle_.vertices[i], along, far, radius_);
    piece.conditions.push_back(below(side.out, side.distance));
  };
  if (triangle_.surface) add_before(triangle_.vertices[(i + 2) % 3]);
  if (const auto far = beyond(triangle_, i)) add_before(*far);
  // The expensive condition last, and only if the others hold.
  if (!(first_inside_all(piece.spans(), interest_.begin) <= interest_.end)) return;
  piece.conditions.push_back(within(path));
  pieces_.add(piece);
}

template <int Degree>
void BallTouch<Degree>::add_vertex(std::size_t i) {
  const Path path = from(i);
  if (!matters(path)) return;
  Piece piece;
  const Vector3d& at = triangle_.vertices[i];
  each_around(triangle_, i, [&](const Vector3d& other) {
    if (piece.conditions.size() + 1 == most_conditions) return;  // One fewer leaves the piece larger.
    const Vector3d along = unit(Vector3d(other - at));
    piece.conditions.push_back(below(along, dot(along, at)));
  });
  if (!(first_inside_all(piece.spans(), interest_.begin) <= interest_.end)) return;
  piece.conditions.push_back(within(path));
  pieces_.add(piece);
}

template <int Degree>
PolyhedronPart BallTouch<Degree>::part(int dimension, std::size_t i) const {
  const Vector3d& at = triangle_.vertices[i];
  if (dimension == 2) return {at, 2, unit(cross(triangle_.edge(0), triangle_.edge(1)))};
  return {at, dimension, dimension == 1 ? unit(triangle_.edge(i)) : Vector3d(Vector3d::Zero())};
}

/// The part that a place is nearest to. If a gap is given, that is the face over all of its prism, which is wider than
/// the triangle by some gaps: so a ball that slides from a face to the next goes on along their plane.
template <int Degree>
NearestPart BallTouch<Degree>::nearest_part(const Vector3d& place, double gap) const {
  const NearestPoint nearest = nearest_point(triangle_, place);
  const Vector3d apart = place - nearest.point;
  PolyhedronPart face = part(2, 0);
  const bool inside = nearest.dimension == 2;
  if (!inside && !(gap > 0 && is_over_face(apart, face.direction, radius_, gap)))
    return {part(nearest.dimension, nearest.index), apart};
  const double height = dot(face.direction, apart);
  const Vector3d from_face = inside ? apart : Vector3d(height * face.direction);
  if (height < 0) face.direction = -face.direction;
  return {face, from_face};
}

template <int Degree>
TouchDirection BallTouch<Degree>::direction(double tau) const {
  const Vector3d centre = motion_.position(tau);
  const Vector3d velocity = motion_.velocity(tau);
  const double gap = gap_(tau);
  const NearestPart nearest = nearest_part(centre, gap);
  const bool inside = nearest_part(centre, 0).dimension == 2;
  const Vector3d& apart = nearest.apart;
  if (!(apart.cwiseAbs().maxCoeff() > 0)) {
    // The centre passes through the surface: from now on it moves away.
    const Vector3d normal = part(2, 0).direction;
    return {dot(normal, velocity) < 0 ? Vector3d(-normal) : normal, -radius_, false};
  }
  const Vector3d normal = unit(apart);
  const double distance = std::sqrt(dot(apart, apart));
  bool approaching = false;
  if constexpr (Degree >= 3) {
    // A ball that has sunk in by a gap approaches however slowly it does.
    const double tilt = nearest.dimension == 2 && distance > radius_ - gap ? tilt_of(triangle_) : 0.0;
    approaching = curve_approaches(motion_, gap, tau, tilt, nearest, inside,
                                   [&](const Vector3d& place) { return nearest_part(place, 0); });
  } else {
    // It may be about to pass from one part to another: from an edge to the face, say.
    NearestPart ahead = nearest;
    const Vector3d sideways = velocity - dot(normal, velocity) * normal;
    if (!inside && sideways.cwiseAbs().maxCoeff() > 0) ahead = nearest_part(centre + gap * unit(sideways), 0);
    // Off a face it may be carried by its speed, over its edge: then it approaches neither.
    approaching = approach_to(ahead).approaching(tau) &&
                  (nearest.dimension < 2 || inside || approach_to(nearest).approaching(tau));
  }
  return {normal, distance - radius_, approaching};
}

/// The first time at which the ball, which does not approach, begins to.
template <int Degree>
double BallTouch<Degree>::turning(double tau, double end) const {
  if constexpr (Degree <= 2) {
    const auto look = [&](const PolyhedronPart& each) { end = approach_begins(*this, approach_to(each), tau, end); };
    PolyhedronPart face = part(2, 0);
    look(face);
    face.direction = -face.direction;
    look(face);
    for (const int dimension : {1, 0}) {
      for (std::size_t i = 0; i < 3; ++i) look(part(dimension, i));
    }
  } else {
    // Where the distance to a part of the triangle has a maximum while that part is the nearest.
    const auto consider = [&](double top, double distance) {
      const Vector3d centre = motion_.position(top);
      const Vector3d apart = centre - nearest_point(triangle_, centre).point;
      if (!(distance <= std::sqrt(dot(apart, apart)) + gap_(top) / 4)) return false;
      end = top;
      return true;
    };
    distance_maxima(motion_, part(2, 0).direction, triangle_.vertices[0], tau, end, consider);
    for (std::size_t i = 0; i < 3; ++i) distance_maxima<Degree>(across_edge(i), tau, end, consider);
    for (std::size_t i = 0; i < 3; ++i) distance_maxima<Degree>(from(i), tau, end, consider);
  }
  return end;
}

#define KDS_INSTANTIATE(degree) template class BallTouch<degree>;
KDS_FOR_EACH_DEGREE(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
