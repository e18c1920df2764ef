// When a moving point is near the origin.
#pragma once

#include "collision/narrow_phase/curve_spans.hpp"
#include "collision/narrow_phase/relative_motion.hpp"
#include "collision/narrow_phase/time_spans.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace kds::collision {

/// Place at tau of a point on a path given by coefficients, constant first.
template <std::size_t Size>
Eigen::Vector3d place_on(const std::array<Eigen::Vector3d, Size>& path, double tau) {
  Eigen::Vector3d value = path[Size - 1];
  for (std::size_t i = Size - 1; i-- > 0;) value = path[i] + tau * value;
  return value;
}

/// When |s0 + s1 tau| < g0 + g1 tau, for all tau. From the nearest approach, whose distance is computed from the place
/// itself.
TimeSpans near_spans(const std::array<Eigen::Vector3d, 2>& s, const std::array<double, 2>& g, double horizon);

/// The same for a quadratic path and radius, from tau = 0 to the horizon: the sign changes of a quartic, bracketed
/// between those of its derivatives.
TimeSpans near_spans(const std::array<Eigen::Vector3d, 3>& s, const std::array<double, 3>& g, double horizon);

/// The same for paths of degree 3 and above, exactly (curve_spans.hpp).
template <std::size_t Count>
CurveSpans<Count> near_spans(const std::array<Eigen::Vector3d, Count>& s, const std::array<double, Count>& g,
                             double horizon) {
  static_assert(Count >= 4);
  return broken_spans<Count>(FarCurve<static_cast<int>(Count) - 1>(s, g), horizon);
}

/// f(tau) = |s(tau)|^2 - g(tau)^2 and its derivatives.
class DistanceQuartic {
 public:
  DistanceQuartic(const std::array<Eigen::Vector3d, 3>& s, const std::array<double, 3>& g) : s_(s), g_(g) {}

  double value(double tau) const {
    const Eigen::Vector3d place = place_on(s_, tau);
    const double radius = g_[0] + tau * (g_[1] + tau * g_[2]);
    const double distance = std::sqrt(dot(place, place));
    return (distance - radius) * (distance + radius);
  }

  double slope(double tau) const {
    const Eigen::Vector3d velocity = s_[1] + (2 * tau) * s_[2];
    return 2 * (dot(place_on(s_, tau), velocity) - (g_[0] + tau * (g_[1] + tau * g_[2])) * (g_[1] + 2 * tau * g_[2]));
  }

  double bend(double tau) const { return b_[0] + tau * (b_[1] + tau * b_[2]); }

  /// Where the slope changes sign in (0, horizon), in order.
  struct Points {
    std::array<double, 3> at{};
    std::size_t size = 0;
  };
  Points turning_points(double horizon) const {
    Points bends;  // the slope is monotone between them
    if (b_[2] != 0 || b_[1] != 0) {
      if (b_[1] * b_[1] - 4 * b_[2] * b_[0] > 0) {
        const auto [falling, rising] = quadratic_roots(b_[0], b_[1], b_[2]);
        for (const double root : {std::min(falling, rising), std::max(falling, rising)}) {
          if (root > 0 && root < horizon) bends.at[bends.size++] = root;
        }
      }
    }
    return crossings([this](double tau) { return slope(tau); }, bends, horizon);
  }

  /// A double, at most two roundings after the change, at which g has the sign that it has at `above`; at `below` it
  /// has the other. Regula falsi, Illinois variant, with bisection steps in between, so that convergence cannot be
  /// slow.
  template <class Function>
  static double crossing(const Function& g, double below, double above) {
    constexpr double enough = 4 * 0x1p-53;
    double at_below = g(below);
    double at_above = g(above);
    const bool negative_above = at_above < 0;
    int moved = 0;  // the end that the last step replaced: -1 below, 1 above
    for (int step = 1; above - below > enough * above; ++step) {
      double middle = below + (above - below) * (at_below / (at_below - at_above));
      if (step % 8 == 0 || !(middle > below && middle < above)) middle = below + 0.5 * (above - below);
      if (!(middle > below && middle < above)) break;
      const double value = g(middle);
      if ((value < 0) == negative_above) {
        above = middle;
        at_above = value;
        if (moved == 1) at_below *= 0.5;
        moved = 1;
      } else {
        below = middle;
        at_below = value;
        if (moved == -1) at_above *= 0.5;
        moved = -1;
      }
    }
    return above;
  }

  /// Sign changes of g in (0, horizon), given points between which it is monotone.
  template <class Function>
  static Points crossings(const Function& g, const Points& monotone, double horizon) {
    Points found;
    double below = 0;
    for (std::size_t i = 0; i <= monotone.size && found.size < found.at.size(); ++i) {
      const double above = i < monotone.size ? monotone.at[i] : horizon;
      if ((g(below) < 0) != (g(above) < 0)) found.at[found.size++] = crossing(g, below, above);
      below = above;
    }
    return found;
  }

  /// When f < 0, from tau = 0 to the horizon.
  TimeSpans negative(double horizon) const {
    const Points turns = turning_points(horizon);
    const auto f = [this](double tau) { return value(tau); };
    TimeSpans spans;
    std::size_t n = 0;
    bool inside = f(0) < 0;
    if (inside) spans.begin[0] = -TimeSpans::infinity;
    double below = 0;
    for (std::size_t i = 0; i <= turns.size && n < 2; ++i) {
      const double above = i < turns.size ? turns.at[i] : horizon;
      if ((f(above) < 0) != inside) {
        const double change = crossing(f, below, above);
        (inside ? spans.end[n++] : spans.begin[n]) = change;
        inside = !inside;
      }
      below = above;
    }
    if (inside && n < 2) spans.end[n] = TimeSpans::infinity;
    return spans;
  }

 private:
  std::array<Eigen::Vector3d, 3> s_;
  std::array<double, 3> g_;
  /// f'' about tau = 0: to cut the time into stretches, not to decide a sign of f.
  std::array<double, 3> b_{2 * (dot(s_[1], s_[1]) - g_[1] * g_[1] + 2 * (dot(s_[0], s_[2]) - g_[0] * g_[2])),
                           12 * (dot(s_[1], s_[2]) - g_[1] * g_[2]), 12 * (dot(s_[2], s_[2]) - g_[2] * g_[2])};
};

}  // namespace kds::collision
