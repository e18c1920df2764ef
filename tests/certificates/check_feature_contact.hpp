// What an answer about vertex-face or edge-edge contact must be, against exact numbers.
#pragma once

#include "certificates/features/feature_contact.hpp"
#include "tests/certificates/check_certificate.hpp"
#include "tests/certificates/exact_features.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

namespace kds::tests {

using certificates::ContactTolerance;
using certificates::FeatureContact;
using certificates::FeatureContactStatus;
using certificates::PointMotion;

/// Four points at time 0 and at time 1.
using Ends = std::array<std::array<Eigen::Vector3d, 4>, 2>;

inline std::array<Path, 4> exact_paths(const Ends& ends) {
  std::array<Path, 4> paths;
  for (std::size_t k = 0; k < 4; ++k) {
    for (std::size_t d = 0; d < 3; ++d) {
      const auto begin = oracle::rational(ends[0][k][static_cast<int>(d)]);
      const auto end = oracle::rational(ends[1][k][static_cast<int>(d)]);
      paths[k][d] = oracle::Polynomial({begin, end - begin});
    }
  }
  return paths;
}

template <int Degree>
std::array<Path, 4> exact_paths(const std::array<PointMotion<Degree>, 4>& points) {
  return {exact(points[0]), exact(points[1]), exact(points[2]), exact(points[3])};
}

inline FeatureContact ask(Features kind, const Ends& ends, const ContactTolerance& tolerance = {}) {
  return kind == Features::vertex_face ? certificates::vertex_face_contact(ends[0], ends[1], tolerance)
                                       : certificates::edge_edge_contact(ends[0], ends[1], tolerance);
}

template <int Degree>
FeatureContact ask(Features kind, const std::array<PointMotion<Degree>, 4>& p, double t0, double t1,
                   const ContactTolerance& tolerance = {}) {
  return kind == Features::vertex_face ? certificates::vertex_face_contact(p[0], p[1], p[2], p[3], t0, t1, tolerance)
                                       : certificates::edge_edge_contact(p[0], p[1], p[2], p[3], t0, t1, tolerance);
}

/// The size by which tolerances are measured, from the numbers as they are.
inline double size_of(Features kind, const std::array<Path, 4>& paths, double t0, double t1) {
  double size = 0;
  const std::size_t firsts = kind == Features::vertex_face ? 1 : 2;
  for (std::size_t i = 0; i < firsts; ++i) {
    for (std::size_t j = firsts; j < 4; ++j) {
      for (std::size_t d = 0; d < 3; ++d) {
        const auto q = paths[i][d] - paths[j][d];
        // About t0, in units of the duration.
        oracle::Rational sum = 0;
        oracle::Polynomial derivative = q;
        oracle::Rational factor = 1;
        for (int n = 0; n <= q.degree(); ++n) {
          sum += abs(derivative(oracle::rational(t0)) * factor);
          derivative = derivative.derivative();
          factor *= (oracle::rational(t1) - oracle::rational(t0)) / oracle::Rational(n + 1);
        }
        size = std::max(size, approximate(sum));
      }
    }
  }
  return size;
}

/// Every law of FeatureContact, against exact numbers: what is wrong, or nothing.
inline std::string complaint(Features kind, const FeatureContact& r, const std::array<Path, 4>& paths, double t0,
                             double t1, const ContactTolerance& tolerance,
                             const std::optional<oracle::Instant>& truth) {
  if (!r) return truth ? "missed" : "";
  const auto now = oracle::rational(r.time);
  if (!(r.time >= t0 && r.time <= t1)) return "time outside the interval";
  if (truth && truth->compare(now) < 0) return "late";
  if (r.status == FeatureContactStatus::at_start && r.time != t0) return "at start, but later";
  if (r.status == FeatureContactStatus::contact) {
    if (!truth) return "a contact that is none";
    if (truth->compare(oracle::rational(r.latest)) > 0) return "the latest time is too early";
    if (!(r.latest >= r.time && r.latest <= t1)) return "latest time outside the interval";
  }
  // The distance at the time reported. Two ulps of the clock are allowed for.
  const auto p = places(paths, now);
  const auto distance = squared_distance(kind, p);
  const double size = size_of(kind, paths, t0, t1);
  const double allowed = std::max(std::min(tolerance.absolute, tolerance.relative * size), 0x1p-38 * size);
  const double clock = t1 > t0 ? 8 * size * 0x1p-50 * (std::abs(r.time) + t1 - t0) / (t1 - t0) : 0;
  if (distance > oracle::square(oracle::rational(r.distance))) return "farther apart than it says";
  if (!(r.distance <= allowed * (1 + 1e-12) + clock)) return "farther apart than the tolerance";
  if (!(std::abs(r.tolerance - allowed) <= 1e-12 * allowed)) return "another tolerance";
  // The points named are that close, up to the rounding of their weights.
  const auto& w = r.weights;
  const std::size_t firsts = kind == Features::vertex_face ? 1 : 2;
  Place difference{};
  for (std::size_t d = 0; d < 3; ++d) {
    for (std::size_t k = 0; k < 4; ++k) {
      const auto term = oracle::rational(w[k]) * (p[k][d] - p[3][d]);
      difference[d] = k < firsts ? difference[d] + term : difference[d] - term;
    }
  }
  double sum = 0;
  for (std::size_t k = firsts; k < 4; ++k) sum += w[k];
  if (*std::min_element(w.begin(), w.end()) < 0 || std::abs(sum - 1) > 1e-15 * 4) return "weights";
  if (kind == Features::edge_edge && std::abs(w[0] + w[1] - 1) > 1e-15 * 4) return "weights of the first edge";
  if (approximate(squared_length(difference)) > std::pow(r.distance + 1e-14 * size, 2))
    return "the points named are apart";
  if (!(std::abs(r.normal.norm() - 1) < 1e-12)) return "normal";
  return "";
}

/// The same of a whole query: asks, finds the truth, and compares.
inline std::string complaint(Features kind, const Ends& ends, const ContactTolerance& tolerance = {}) {
  const auto paths = exact_paths(ends);
  return complaint(kind, ask(kind, ends, tolerance), paths, 0, 1, tolerance,
                   ExactFeatures(kind, paths).first_touch(0, 1));
}
template <int Degree>
std::string complaint(Features kind, const std::array<PointMotion<Degree>, 4>& points, double t0, double t1,
                      const ContactTolerance& tolerance = {}) {
  const auto paths = exact_paths(points);
  return complaint(kind, ask(kind, points, t0, t1, tolerance), paths, t0, t1, tolerance,
                   ExactFeatures(kind, paths).first_touch(t0, t1));
}

}  // namespace kds::tests
