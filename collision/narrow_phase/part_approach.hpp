// Whether something round on a path comes nearer to a part of a polyhedron, and from when on.
#pragma once

#include "collision/narrow_phase/curve_spans.hpp"
#include "collision/narrow_phase/mesh_margins.hpp"
#include "collision/narrow_phase/relative_motion.hpp"
#include "collision/narrow_phase/touch_condition.hpp"
#include "collision/vectors.hpp"
#include "kds/certificate.hpp"
#include "kds/motion.hpp"
#include "kds/roots/failure_time.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace kds::collision {

/// A corner of a polyhedron, the line of an edge or the plane of a face.
struct PolyhedronPart {
  Eigen::Vector3d at;         ///< a place on it
  int dimension;              ///< 0: a corner, 1: an edge, 2: a face
  Eigen::Vector3d direction;  ///< unit: along an edge, out of a face
};

/// Half the derivative of the squared distance of a point on a path from the origin, and a line: y . y' + slack >= 0.
template <int PathDegree>
struct PartingFromOrigin {
  static constexpr int degree = 2 * PathDegree - 1;

  std::array<kds::Motion<PathDegree>, 3> way;
  kds::Motion<1> slack;

  template <class Number>
  Polynomial<degree, Number> polynomial(double epoch) const {
    const auto half_derivative = [&](const kds::Motion<PathDegree>& x) {
      const auto p = about<Number>(x, epoch);
      return p * derivative(p);
    };
    return half_derivative(way[0]) + half_derivative(way[1]) + half_derivative(way[2]) + about<Number>(slack, epoch);
  }
};

/// How the distance of the middle of something round from a part of a polyhedron changes, as polynomials of the time
/// that shapes and motion alone decide: so whether they approach at a time does not depend on what else is asked, and
/// the times at which they begin to are the exact failure times of these polynomials.
///
/// Law. Just after tau they approach if the rate f at which the distance grows is negative there, by more than an error
/// e: f + e < 0, or at least falling, (f + e)' < 0. The error is that of speeds, and the part of them by which the
/// direction across the part is not known: by roundings of places, over the radius, and by `tilt`. It grows with the
/// time. Once the two are deeper than a gap that part counts no more: so they do not sink in however slowly they
/// approach.
template <int Degree>
requires(Degree <= 2) class PartApproach {
 public:
  /// `radius`: the distance at which they touch, but for the gap.
  PartApproach(const PolyhedronPart& part, const RelativeMotion<Degree>& motion, double radius,
               const ContactGap<Degree>& gap, double tilt)
      : plane_(part.dimension == 2), gap_(gap), may_be_deep_(gap.c[0] < 0.5 * radius) {
    way_ = motion.coefficients;
    way_[0] -= part.at;
    if (part.dimension == 1) {
      for (Eigen::Vector3d& c : way_) c -= dot(part.direction, c) * part.direction;
    }
    const auto speeds = smallest_speeds(motion);
    const double distance = plane_ ? 1.0 : radius;
    constexpr double rounded_places = 0x1p-3;  // of a gap, which is 64 roundings
    constexpr double most = 0x1p-20;
    const double off = tilt + std::min(rounded_places * gap.c[0] / radius, most);
    for (std::size_t i = 0; i < Degree; ++i) {
      const double speed = static_cast<double>(i + 1) * norm(motion.coefficients[i + 1]);
      speeds_[i] = speed;
      deep_error_[i] = distance * speeds[i];
      error_[i] = distance * (speeds[i] + off * speed);
    }
    for (std::size_t i = 0; i <= Degree; ++i) {
      room_[i] = (i == 0 ? radius : 0.0) - gap.c[i];
      if (plane_) height_[i] = dot(part.direction, way_[i]);
    }
  }

  bool approaching(double tau) const {
    const double error = error_[0] + tau * error_[1];
    if (plane_) {
      const double rate = height_[1] + tau * acceleration();
      const double rounding = 0x1p-49 * (std::abs(height_[1]) + tau * std::abs(acceleration()));
      if (std::abs(rate) > 2 * error + rounding) return rate < 0;
      return decide(rate_from_plane({0, 0}), rate_from_plane(error_), rate_from_plane(deep_error_), depth_in_plane(),
                    tau);
    }
    Eigen::Vector3d place = way_[0] + tau * way_[1], velocity = way_[1];
    if constexpr (Degree == 2) {
      place += tau * tau * way_[2];
      velocity += 2 * tau * way_[2];
    }
    const double product = dot(place, velocity);
    if (std::abs(product) > 2 * error + gap_(tau) * (speeds_[0] + tau * speeds_[1])) return product < 0;
    return decide(rate_from_origin({0, 0}), rate_from_origin(error_), rate_from_origin(deep_error_),
                  depth_from_origin(), tau);
  }

  /// Calls visit(time) for times between tau and end, both excluded, among which are all at which approaching() becomes
  /// true; after one for which it returns true only for earlier ones.
  template <class Visit>
  void each_begin(double tau, double end, const Visit& visit) const {
    if (plane_) {
      begins(rate_from_plane({0, 0}), rate_from_plane(error_), rate_from_plane(deep_error_), depth_in_plane(), tau, end,
             visit);
    } else {
      begins(rate_from_origin({0, 0}), rate_from_origin(error_), rate_from_origin(deep_error_), depth_from_origin(),
             tau, end, visit);
    }
  }

 private:
  using Error = std::array<double, 2>;

  template <class Rate, class Depth>
  bool decide(const Rate& rate, const Rate& with_error, const Rate& with_deep_error, const Depth& depth,
              double tau) const {
    if (sign_after(rate, tau) >= 0) return false;
    const auto exceeds = [&](const Rate& sum) { return sign_after(sum, tau) < 0 || sign_after(sum, tau, 1) < 0; };
    return exceeds(with_error) || (may_be_deep_ && exceeds(with_deep_error) && sign_after(depth, tau) < 0);
  }

  /// Where the sum of rate and error becomes negative it has been falling before.
  template <class Rate, class Depth, class Visit>
  void begins(const Rate& rate, const Rate& with_error, const Rate& with_deep_error, const Depth& depth, double tau,
              double end, const Visit& visit) const {
    const auto look = [&](double t) {
      const bool found = visit(t);
      if (found) end = t;
      return found;
    };
    if (may_be_deep_) each_failure(depth, tau, end, look);
    if constexpr (Degree == 2) {  // The distance from what a straight path passes is convex.
      each_failure(rate, tau, end, look);
      if constexpr (Rate::degree > 1) {
        each_failure(DerivativeCertificate<Rate>{with_error}, tau, end, look);
        each_failure(DerivativeCertificate<Rate>{with_deep_error}, tau, end, look);
      }
    }
  }

  double acceleration() const { return Degree == 2 ? 2 * height_[Degree] : 0.0; }
  PolynomialCertificate<1> rate_from_plane(const Error& error) const {
    return {{{{height_[1] + error[0], acceleration() + error[1]}}, 0.0}};
  }
  PolynomialCertificate<Degree> depth_in_plane() const {
    Polynomial<Degree> above;
    for (std::size_t i = 0; i <= Degree; ++i) above.c[i] = height_[i] - room_[i];
    return {{above, 0.0}};
  }
  PartingFromOrigin<Degree> rate_from_origin(const Error& error) const {
    PartingFromOrigin<Degree> rate;
    for (std::size_t i = 0; i <= Degree; ++i) {
      for (std::size_t d = 0; d < 3; ++d) rate.way[d].position.c[i] = way_[i][static_cast<Eigen::Index>(d)];
    }
    rate.slack.position.c = error;
    return rate;
  }
  FarCurve<Degree> depth_from_origin() const { return {way_, room_}; }

  bool plane_;
  ContactGap<Degree> gap_;
  bool may_be_deep_;
  std::array<Eigen::Vector3d, std::size_t{Degree} + 1> way_;  ///< from the part
  std::array<double, std::size_t{Degree} + 1> height_{};      ///< of a plane
  std::array<double, std::size_t{Degree} + 1> room_;          ///< the radius less the gap
  Error speeds_{};
  Error error_{};       ///< constant, then times tau; times the radius, if this is no plane
  Error deep_error_{};  ///< the same without the tilt
};

/// The first time between tau and end, both excluded, at which two shapes begin to approach at a part, so that they do:
/// `touch.approaching()`; or end.
template <class Touch, int Degree>
double approach_begins(const Touch& touch, const PartApproach<Degree>& part, double tau, double end) {
  double first = end;
  part.each_begin(tau, end, [&](double t) {
    if (!touch.approaching(t)) return false;
    first = t;
    return true;
  });
  return first;
}

}  // namespace kds::collision
