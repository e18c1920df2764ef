#include "collision/narrow_phase/ball_touch.hpp"

#include "collision/degrees.hpp"
#include "collision/vectors.hpp"

#include <algorithm>
#include <cmath>

namespace kds::collision {
using Eigen::Vector3d;

template <int Degree>
BallTouch<Degree>::BallTouch(const PlacedTriangle& triangle, const PlacedBall& ball,
                             const RelativeMotion<Degree>& motion, const ContactGap<Degree>& gap, bool sharp,
                             double horizon, const TimeWindow& interest)
    : triangle_(triangle),
      radius_(ball.radius),
      motion_(motion),
      gap_(gap),
      horizon_(horizon),
      interest_{std::max(interest.begin, 0.0), std::min(interest.end, horizon)} {
  add_face(sharp);
  for (std::size_t i = 0; i < 3; ++i) add_edge(i);
  for (std::size_t i = 0; i < 3; ++i) add_vertex(i);
}

template <int Degree>
auto BallTouch<Degree>::from(std::size_t vertex) const -> Path {
  Path path = motion_.coefficients;
  path[0] -= triangle_.vertices[vertex];
  return path;
}

/// What is left of the motion when that along the edge is taken out.
template <int Degree>
auto BallTouch<Degree>::across_edge(std::size_t i) const -> Path {
  const Vector3d along = unit(triangle_.edge(i));
  Path path = from(i);
  for (Vector3d& c : path) c -= dot(along, c) * along;
  return path;
}

/// When normal . r - reach < gap.
template <int Degree>
SpansOf<Degree> BallTouch<Degree>::below(const Vector3d& normal, double reach) const {
  const auto& r = motion_.coefficients;
  if constexpr (Degree >= 3) {
    Polynomial<Degree> apart;
    for (std::size_t i = 0; i <= Degree; ++i) apart.c[i] = dot(normal, r[i]) - gap_.c[i];
    apart.c[0] = dot(normal, r[0]) - reach - gap_.c[0];
    return broken_spans<std::size_t{Degree} + 1>(PolynomialCertificate<Degree>{{apart, 0.0}}, horizon_);
  } else if constexpr (Degree == 1) {
    return negative_spans(dot(normal, r[0]) - reach - gap_.c[0], dot(normal, r[1]) - gap_.c[1]);
  } else {
    return negative_spans(dot(normal, r[0]) - reach - gap_.c[0], dot(normal, r[1]) - gap_.c[1],
                          dot(normal, r[2]) - gap_.c[2]);
  }
}

/// Whether the path comes near the origin within the window of interest, judged by its chord: which it leaves by no
/// more than an eighth of the second derivative's bound times length^2.
template <int Degree>
bool BallTouch<Degree>::matters(const Path& path) const {
  const double length = interest_.end - interest_.begin;
  const Vector3d begin = place_on(path, interest_.begin);
  const Vector3d along = place_on(path, interest_.end) - begin;
  const double square = dot(along, along);
  const double part = square > 0 ? std::clamp(-dot(begin, along) / square, 0.0, 1.0) : 0.0;
  const Vector3d nearest = begin + part * along;
  double reach = radius_ + 4 * gap_(interest_.end);
  if constexpr (Degree == 2) reach += 0.25 * length * length * std::sqrt(dot(path[2], path[2]));
  if constexpr (Degree >= 3) {
    double bend = 0;
    for (std::size_t i = Degree; i >= 2; --i) {
      bend = bend * interest_.end + static_cast<double>(i * (i - 1)) * std::sqrt(dot(path[i], path[i]));
    }
    reach += 0.125 * length * length * bend;
  }
  return !(dot(nearest, nearest) > reach * reach);
}

template <int Degree>
SpansOf<Degree> BallTouch<Degree>::within(const Path& path) const {
  std::array<double, std::size_t{Degree} + 1> reach = gap_.c;
  reach[0] += radius_;
  return near_spans(path, reach, horizon_);
}

template <int Degree>
void BallTouch<Degree>::add_face(bool sharp) {
  const Vector3d normal = unit(cross(triangle_.edge(0), triangle_.edge(1)));
  Piece piece;
  for (const double side : {1.0, -1.0}) {
    const Vector3d out = side * normal;
    piece.conditions[piece.size++] = below(out, triangle_.project(out).high + radius_);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3d out = unit(cross(triangle_.edge(i), normal));
    piece.conditions[piece.size++] =
        below(out, std::max(dot(out, triangle_.vertices[i]), dot(out, triangle_.vertices[(i + 1) % 3])));
  }
  // Across each corner: away from the middle between the directions of its edges.
  const auto along = [this](std::size_t i) { return unit(triangle_.edge(i)); };
  for (std::size_t i = 0; sharp && i < 3; ++i) {
    const Vector3d out = unit(along((i + 2) % 3) - along(i));
    piece.conditions[piece.size++] = below(out, triangle_.project(out).high);
  }
  pieces_[size_++] = piece;
}

template <int Degree>
void BallTouch<Degree>::add_edge(std::size_t i) {
  const Vector3d along = unit(triangle_.edge(i));
  Piece piece;
  piece.conditions[piece.size++] = below(along, dot(along, triangle_.vertices[(i + 1) % 3]));
  piece.conditions[piece.size++] = below(-along, -dot(along, triangle_.vertices[i]));
  // The costly condition last, and only if it counts.
  if (!(first_inside_all(piece.spans(), interest_.begin) <= interest_.end)) return;
  const Path path = across_edge(i);
  if (!matters(path)) return;
  piece.conditions[piece.size++] = within(path);
  pieces_[size_++] = piece;
}

template <int Degree>
void BallTouch<Degree>::add_vertex(std::size_t i) {
  const Path path = from(i);
  if (!matters(path)) return;
  Piece piece;
  piece.conditions[piece.size++] = within(path);
  pieces_[size_++] = piece;
}

template <int Degree>
double BallTouch<Degree>::first_inside(double tau) const {
  double first = TimeSpans::infinity;
  for (std::size_t i = 0; i < size_; ++i) first = std::min(first, first_inside_all(pieces_[i].spans(), tau));
  return first;
}

template <int Degree>
double BallTouch<Degree>::enter(double tau) const {
  // Downwards through the pieces that contain the time, as far as they reach.
  double begin = TimeSpans::infinity;
  for (std::size_t i = 0; i < size_; ++i) {
    if (pieces_[i].contains(tau)) begin = std::min(begin, enter_all(pieces_[i].spans(), tau));
  }
  return begin;
}

template <int Degree>
double BallTouch<Degree>::leave(double tau) const {
  for (bool moved = true; moved;) {
    moved = false;
    for (std::size_t i = 0; i < size_; ++i) {
      if (tau == TimeSpans::infinity) return tau;
      if (!pieces_[i].contains(tau)) continue;
      tau = leave_all(pieces_[i].spans(), tau);
      moved = true;
    }
  }
  return tau;
}

template <int Degree>
TouchDirection BallTouch<Degree>::direction(double tau) const {
  const Vector3d centre = motion_.position(tau);
  const Vector3d velocity = motion_.velocity(tau);
  const NearestPoint nearest = nearest_point(triangle_, centre);
  const Vector3d apart = centre - nearest.point;
  const auto speeds = smallest_speeds(motion_);
  if (!(apart.cwiseAbs().maxCoeff() > 0)) {
    // The centre passes through the surface: from now on it moves away.
    const Vector3d normal = unit(cross(triangle_.edge(0), triangle_.edge(1)));
    return {dot(normal, velocity) < 0 ? Vector3d(-normal) : normal, -radius_, false};
  }
  const Vector3d normal = unit(apart);
  const double distance = std::sqrt(dot(apart, apart));
  const double rate = dot(normal, velocity);
  bool approaching = rate < 0;
  if constexpr (Degree >= 3) {
    approaching = curve_approaches(tau, nearest);
  } else if (std::abs(rate) <= speeds[0] + tau * speeds[1]) {
    // Second derivative of the distance: bending towards the surface beats leaving its round. What is round is the part
    // of the triangle that the ball comes to: it may be about to pass from an edge to the face.
    Vector3d sideways = velocity - rate * normal;
    NearestPoint ahead = nearest;
    if (nearest.dimension != 2 && sideways.cwiseAbs().maxCoeff() > 0) {
      ahead = nearest_point(triangle_, centre + gap_(tau) * unit(sideways));
    }
    if (ahead.dimension == 1) {
      const Vector3d along = unit(triangle_.edge(ahead.index));
      sideways -= dot(along, sideways) * along;
    }
    const double round = ahead.dimension == 2 ? 0.0 : dot(sideways, sideways) / distance;
    approaching = dot(normal, motion_.acceleration()) + round < -speeds[1];
  }
  return {normal, distance - radius_, approaching};
}

/// Of degree 3 and above: the sign of the first derivative of the squared distance from the nearest part of the
/// triangle that is more than rounding; of the part that the ball comes to, if it is about to pass from an edge, say,
/// to the face.
///
/// About tau the centre moves on y0 + y1 x + ..., across the edge or along the normal if those are near, and the square
/// of the distance is a polynomial with the coefficients q_k = sum y_j . y_(k-j), q_k / (2 |y0|) the first of the
/// distance that is not zero. A y_k is known as well as smallest_speeds() says, and the products to a few roundings.
template <int Degree>
bool BallTouch<Degree>::curve_approaches(double tau, const NearestPoint& nearest) const {
  constexpr double rounding = 16 * 0x1p-53;
  const auto speeds = smallest_speeds(motion_);
  Path y;
  std::array<double, std::size_t{Degree} + 1> error;
  double factorial = 1;
  for (std::size_t k = 0; k <= Degree; ++k) {
    const int order = static_cast<int>(k);
    factorial *= std::max(order, 1);
    y[k] = motion_.coefficient(order, tau);
    error[k] = derivative_at(speeds, order, tau) / factorial;
  }
  y[0] -= nearest.point;
  NearestPoint ahead = nearest;
  for (std::size_t k = 1; k <= Degree && nearest.dimension != 2; ++k) {
    const Vector3d sideways = y[k] - (dot(y[0], y[k]) / dot(y[0], y[0])) * y[0];
    if (!(sideways.cwiseAbs().maxCoeff() > error[k])) continue;
    ahead = nearest_point(triangle_, nearest.point + y[0] + gap_(tau) * unit(sideways));
    break;
  }
  const Vector3d normal = unit(cross(triangle_.edge(0), triangle_.edge(1)));
  const Vector3d along = ahead.dimension == 1 ? unit(triangle_.edge(ahead.index)) : Vector3d(Vector3d::Zero());
  for (Vector3d& c : y) {
    if (ahead.dimension == 2) c = dot(normal, c) * normal;
    if (ahead.dimension == 1) c -= dot(along, c) * along;
  }
  const double distance = std::sqrt(dot(y[0], y[0]));
  for (std::size_t k = 1; k <= Degree; ++k) {
    double q = 0;
    double size = 0;
    for (std::size_t j = 0; j <= k; ++j) {
      const double product = dot(y[j], y[k - j]);
      q += product;
      if (j > 0 && j < k) size += std::abs(product);
    }
    if (std::abs(q) > 2 * distance * error[k] + rounding * size) return q < 0;
  }
  return false;
}

/// Of degree 3 and above: where the distance from a part of the triangle has a maximum while that part is the nearest.
template <int Degree>
double BallTouch<Degree>::curve_turning(double tau, double end) const {
  const auto consider = [&](double top, double distance) {
    const Vector3d centre = motion_.position(top);
    const Vector3d apart = centre - nearest_point(triangle_, centre).point;
    if (!(distance <= std::sqrt(dot(apart, apart)) + gap_(top) / 4)) return false;
    end = top;
    return true;
  };
  const Vector3d normal = unit(cross(triangle_.edge(0), triangle_.edge(1)));
  for (const double side : {1.0, -1.0}) {
    Motion<Degree> height;
    for (std::size_t i = 0; i <= Degree; ++i) height.position.c[i] = side * dot(normal, motion_.coefficients[i]);
    height.position.c[0] -= side * dot(normal, triangle_.vertices[0]);
    each_maximum(PolynomialCertificate<Degree>{height}, tau, end, [&](double top) {
      const double above = height(top);
      return above > 0 && consider(top, above);
    });
  }
  const auto consider_path = [&](const Path& path) {
    each_maximum(FarCurve<Degree>(path, {}), tau, end,
                 [&](double top) { return consider(top, std::sqrt(dot(place_on(path, top), place_on(path, top)))); });
  };
  for (std::size_t i = 0; i < 3; ++i) consider_path(across_edge(i));
  for (std::size_t i = 0; i < 3; ++i) consider_path(from(i));
  return end;
}

template <int Degree>
double BallTouch<Degree>::turning(double tau, double end) const {
  if constexpr (Degree >= 3) return curve_turning(tau, end);
  if constexpr (Degree == 2) {
    // Where the distance to a part of the triangle has a maximum while that part is the nearest.
    const auto consider = [&](double top, double distance) {
      if (!(top > tau && top < end)) return;
      const Vector3d centre = motion_.position(top);
      const Vector3d apart = centre - nearest_point(triangle_, centre).point;
      if (distance <= std::sqrt(dot(apart, apart)) + gap_(top) / 4) end = top;
    };
    const auto consider_path = [&](const Path& path) {
      const DistanceQuartic quartic(path, {0, 0, 0});
      const auto points = quartic.turning_points(horizon_);
      for (std::size_t i = 0; i < points.size; ++i) {
        const double top = points.at[i];
        if (quartic.bend(top) < 0) consider(top, norm(place_on(path, top)));
      }
    };
    const Vector3d normal = unit(cross(triangle_.edge(0), triangle_.edge(1)));
    const double p1 = dot(normal, motion_.coefficients[1]);
    const double p2 = dot(normal, motion_.coefficients[2]);
    if (p2 != 0) {
      const double top = -p1 / (2 * p2);
      const double height = dot(normal, motion_.position(top) - triangle_.vertices[0]);
      if ((height > 0) == (p2 < 0)) consider(top, std::abs(height));
    }
    for (std::size_t i = 0; i < 3; ++i) consider_path(across_edge(i));
    for (std::size_t i = 0; i < 3; ++i) consider_path(from(i));
  }
  return end;
}

#define KDS_INSTANTIATE(degree) template class BallTouch<degree>;
KDS_FOR_EACH_DEGREE(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
