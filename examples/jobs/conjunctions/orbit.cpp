#include "examples/jobs/conjunctions/orbit.hpp"

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace conjunctions {
namespace {

using Eigen::Vector3d;

constexpr double turn = 2 * std::numbers::pi;

/// Solves E - e sin E = M by Newton's method. From M + e sin M / (1 - sin(M + e) + sin M) it takes two or three steps
/// on near-circular orbits; that start and the limit suffice up to e = 0.99.
double eccentric_anomaly(double mean, double e) {
  const double sine = std::sin(mean);
  double anomaly = mean + e * sine / (1 - std::sin(mean + e) + sine);
  for (int i = 0; i < 20; ++i) {
    const double step = (anomaly - e * std::sin(anomaly) - mean) / (1 - e * std::cos(anomaly));
    anomaly -= step;
    // Newton's method squares the error: after a step as small as this the next would change nothing.
    if (std::abs(step) < 1e-9) break;
  }
  return anomaly;
}

void require(bool right, const char* element, double value) {
  if (!right) throw std::invalid_argument(std::string("Orbit: ") + element + " is " + std::to_string(value));
}

}  // namespace

Orbit::Orbit(const Elements& elements) : elements_(elements) {
  const double a = elements.semi_major_axis, e = elements.eccentricity;
  require(a > 0 && std::isfinite(a), "semi_major_axis", a);
  require(e >= 0 && e < 1, "eccentricity", e);
  require(std::isfinite(elements.inclination), "inclination", elements.inclination);
  require(std::isfinite(elements.node), "node", elements.node);
  require(std::isfinite(elements.perigee), "perigee", elements.perigee);
  require(std::isfinite(elements.mean_anomaly), "mean_anomaly", elements.mean_anomaly);
  mean_motion_ = std::sqrt(mu / a) / a;
  const Eigen::Matrix3d plane = (Eigen::AngleAxisd(elements.node, Vector3d::UnitZ()) *
                                 Eigen::AngleAxisd(elements.inclination, Vector3d::UnitX()) *
                                 Eigen::AngleAxisd(elements.perigee, Vector3d::UnitZ()))
                                    .toRotationMatrix();
  axis_ = a * plane.col(0);
  side_ = a * std::sqrt((1 - e) * (1 + e)) * plane.col(1);
}

State Orbit::state(double t) const {
  const double e = elements_.eccentricity;
  const double anomaly = eccentric_anomaly(std::remainder(elements_.mean_anomaly + mean_motion_ * t, turn), e);
  const double c = std::cos(anomaly), s = std::sin(anomaly);
  const double shrink = 1 - e * c;  // distance over the semi-major axis
  const double rate = mean_motion_ / shrink;
  State state;
  state.position = (c - e) * axis_ + s * side_;
  state.velocity = rate * (c * side_ - s * axis_);
  state.acceleration = -mean_motion_ * mean_motion_ / (shrink * shrink * shrink) * state.position;
  return state;
}

/// Hermite's quintic through both ends of a stretch of h seconds is off by at most h^6 / 46080 times the greatest sixth
/// derivative (of the path's part along the error, so in its Euclidean length): (h / 2)^6 / 6!.
///
/// That derivative follows from x'' = -u x with u = mu / r^3, p = x . x' / r^2, q = |x'|^2 / r^2 - u, for which
/// u' = -3 u p, p' = q - 2 p^2, q' = -p (u + 2 q). Four more derivatives give x^(6) = f x + g x' with
///   f = -u^3 - 24 u^2 q - 45 u q^2 + 210 u^2 p^2 + 630 u p^2 q - 945 u p^4,
///   g = -30 u^2 p - 180 u p q + 420 u p^3.
/// On an ellipse |q| <= e u, p^2 <= P u with P = 2 (1 - sqrt(1 - e^2)), and |x'|^2 <= (1 + e) u r^2. What is left,
/// r u^3 = mu^3 / r^8, is greatest at perigee.
double Orbit::piece_length(double error) const {
  const double e = elements_.eccentricity;
  const double P = 2 * (1 - std::sqrt((1 - e) * (1 + e)));
  const double f = 1 + 24 * e + 45 * e * e + 210 * P + 630 * P * e + 945 * P * P;
  const double g = std::sqrt(P) * (30 + 180 * e + 420 * P);
  const double nearest = elements_.semi_major_axis * (1 - e);
  const double u = mu / (nearest * nearest * nearest);
  const double sixth_derivative = nearest * u * u * u * (f + g * std::sqrt(1 + e));
  return std::pow(46080 * error / sixth_derivative, 1.0 / 6);
}

}  // namespace conjunctions
