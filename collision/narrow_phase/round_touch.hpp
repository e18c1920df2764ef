// The common part of the tests of balls and of capsules against a triangle.
#pragma once

#include "collision/narrow_phase/convex_touch.hpp"
#include "collision/narrow_phase/curve_spans.hpp"
#include "collision/narrow_phase/mesh_margins.hpp"
#include "collision/narrow_phase/near_spans.hpp"
#include "collision/narrow_phase/part_approach.hpp"
#include "collision/narrow_phase/relative_motion.hpp"
#include "collision/narrow_phase/time_spans.hpp"
#include "collision/vectors.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace kds::collision {

template <int Degree>
using PathCoefficients = std::array<Eigen::Vector3d, std::size_t{Degree} + 1>;  ///< polynomial of tau

/// When c[0] + c[1] tau + ... < 0, from 0 to the horizon.
template <int Degree>
SpansOf<Degree> spans_below_zero(const std::array<double, std::size_t{Degree} + 1>& c, double horizon) {
  if constexpr (Degree == 1) {
    return negative_spans(c[0], c[1]);
  } else if constexpr (Degree == 2) {
    return negative_spans(c[0], c[1], c[2]);
  } else {
    return broken_spans<std::size_t{Degree} + 1>(PolynomialCertificate<Degree>{{Polynomial<Degree>{c}, 0.0}}, horizon);
  }
}

/// Whether a path comes as near to the origin as `distance` within a window, judged by its chord: which it leaves by no
/// more than an eighth of the second derivative's bound times length^2. A parabola also by how far it comes along the
/// direction in which its chord is nearest.
template <int Degree>
bool may_come_near(const PathCoefficients<Degree>& path, const TimeWindow& window, double distance) {
  const double length = window.end - window.begin;
  const Eigen::Vector3d begin = place_on(path, window.begin);
  const Eigen::Vector3d along = place_on(path, window.end) - begin;
  const double square = dot(along, along);
  const double part = square > 0 ? std::clamp(-dot(begin, along) / square, 0.0, 1.0) : 0.0;
  const Eigen::Vector3d nearest = begin + part * along;
  if constexpr (Degree == 2) {
    const double chord = std::sqrt(dot(nearest, nearest));
    if (!(chord > distance)) return true;
    const double c1 = dot(nearest, path[1]), c2 = dot(nearest, path[2]);
    const auto along_nearest = [&](double tau) { return dot(nearest, place_on(path, tau)); };
    double least = std::min(along_nearest(window.begin), along_nearest(window.end));
    const double turn = -0.5 * c1 / c2;
    if (c2 > 0 && turn > window.begin && turn < window.end) least = std::min(least, along_nearest(turn));
    return !(least > distance * chord);
  }
  if constexpr (Degree >= 3) {
    double bend = 0;
    for (std::size_t i = Degree; i >= 2; --i) {
      bend = bend * window.end + static_cast<double>(i * (i - 1)) * std::sqrt(dot(path[i], path[i]));
    }
    distance += 0.125 * length * length * bend;
  }
  return !(dot(nearest, nearest) > distance * distance);
}

/// The part of a polyhedron that is nearest to a point.
struct NearestPart : PolyhedronPart {
  Eigen::Vector3d apart;  ///< the point from there
};

/// Whether the middle of something round, which is at `apart` from the edge or corner of a face that is nearest to it,
/// counts as over the face all the same: it is no deeper than a gap, and over the prism of the face, which is wider
/// than that by some gaps.
inline bool is_over_face(const Eigen::Vector3d& apart, const Eigen::Vector3d& face, double radius, double gap) {
  constexpr double widest = 9;       // in gaps: the corners of the prism
  constexpr double least = 0x1p-20;  // what is so small that this matters meets edges as they are
  const double height = dot(face, apart);
  if (!(std::abs(height) > radius - gap)) return false;
  return norm(Eigen::Vector3d(apart - height * face)) <= std::min(widest * gap, least * std::abs(height));
}

/// Whether a point on a path of degree 3 or above comes nearer to a polyhedron just after tau: the sign of the first
/// derivative of the squared distance from the nearest part that exceeds rounding errors; if it is about to pass from
/// one part to another, from an edge to a face, say, of the part that it comes to.
///
/// About tau the point moves on y0 + y1 x + ..., across the edge or along the normal if those are near, and the square
/// of the distance is a polynomial with the coefficients q_k = sum y_j . y_(k-j), q_k / (2 |y0|) the first of the
/// distance that is not zero. A y_k is known as well as smallest_speeds() says, and the products to a few roundings.
///
/// `nearest`: at tau; `inside`: whether it is a face for certain, and the point not about to leave it. `tilt`: by how
/// much its direction may be off. `nearest_part(place)`: of another place of the point.
template <int Degree, class Nearest>
bool curve_approaches(const RelativeMotion<Degree>& motion, double gap, double tau, double tilt,
                      const NearestPart& nearest, bool inside, const Nearest& nearest_part) {
  constexpr double rounding = 16 * 0x1p-53;
  const auto speeds = smallest_speeds(motion);
  const Eigen::Vector3d place = motion.position(tau);
  PathCoefficients<Degree> y;
  std::array<double, std::size_t{Degree} + 1> error;
  double factorial = 1;
  for (std::size_t k = 0; k <= Degree; ++k) {
    const int order = static_cast<int>(k);
    factorial *= std::max(order, 1);
    y[k] = motion.coefficient(order, tau);
    error[k] = derivative_at(speeds, order, tau) / factorial + tilt * norm(y[k]);
  }
  y[0] = nearest.apart;
  NearestPart ahead = nearest;
  for (std::size_t k = 1; k <= Degree && !inside; ++k) {
    const Eigen::Vector3d sideways = y[k] - (dot(y[0], y[k]) / dot(y[0], y[0])) * y[0];
    if (!(sideways.cwiseAbs().maxCoeff() > error[k])) continue;
    ahead = nearest_part(place + gap * normalized(sideways));
    break;
  }
  for (Eigen::Vector3d& c : y) {
    if (ahead.dimension == 2) c = dot(ahead.direction, c) * ahead.direction;
    if (ahead.dimension == 1) c -= dot(ahead.direction, c) * ahead.direction;
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

/// Degree 3 and above: calls consider(time, distance) for the maxima between tau and end, both excluded, of the
/// distance of a point on a path from a plane with a unit normal, or from the origin; until it returns true.
template <int Degree, class Consider>
void distance_maxima(const RelativeMotion<Degree>& motion, const Eigen::Vector3d& normal, const Eigen::Vector3d& at,
                     double tau, double end, const Consider& consider) {
  for (const double side : {1.0, -1.0}) {
    Motion<Degree> height;
    for (std::size_t i = 0; i <= Degree; ++i) height.position.c[i] = side * dot(normal, motion.coefficients[i]);
    height.position.c[0] -= side * dot(normal, at);
    each_maximum(PolynomialCertificate<Degree>{height}, tau, end, [&](double top) {
      const double above = height(top);
      return above > 0 && consider(top, above);
    });
  }
}
template <int Degree, class Consider>
void distance_maxima(const PathCoefficients<Degree>& path, double tau, double end, const Consider& consider) {
  each_maximum(FarCurve<Degree>(path, {}), tau, end,
               [&](double top) { return consider(top, norm(place_on(path, top))); });
}

}  // namespace kds::collision
