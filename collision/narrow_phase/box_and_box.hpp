// When two boxes penetrate.
#pragma once

#include "certificates/plane_separation.hpp"
#include "collision/narrow_phase/gap_conditions.hpp"
#include "collision/narrow_phase/narrow_phase.hpp"
#include "collision/narrow_phase/quick_motion.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace kds::collision {

/// Directions that can separate two boxes: three face normals each, nine products of edges.
///
/// Cross products of edges shorter than this (relative, squared) come from parallel edges, whose common directions
/// the face normals cover: leaving one out lets a contact be reported early by at most 2^-40 of the boxes' size.
inline constexpr double parallel_edges = 0x1p-80;

/// Calls visit(axis) until it returns false.
template <class Visit>
void every_box_axis(const PlacedShape& a, const PlacedShape& b, const Visit& visit) {
  for (int d = 0; d < 3; ++d) {
    if (!visit(Eigen::Vector3d(a.rotation.col(d)))) return;
  }
  if (a.rotation == b.rotation) return;
  for (int d = 0; d < 3; ++d) {
    if (!visit(Eigen::Vector3d(b.rotation.col(d)))) return;
  }
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const Eigen::Vector3d axis = cross(a.rotation.col(i), b.rotation.col(j));
      if (axis.squaredNorm() > parallel_edges && !visit(axis)) return;
    }
  }
}

/// The gaps of two boxes on both sides of every axis, from `now` to the horizon: they penetrate while all are closed.
///
/// A gap that stays open all the time ends the search for more of them; it is the usual case, and costs some ten
/// operations an axis tried.
template <int Degree>
class BoxAndBox {
 public:
  using Body = MovingShape<Degree>;

  BoxAndBox(const Body& a, const Body& b, double now, double horizon)
      : a_(a),
        b_(b),
        motion_(a.motion, b.motion, now, horizon, a.shape.bounding_radius + b.shape.bounding_radius),
        window_{0, motion_.end()} {
    every_box_axis(a.shape, b.shape, [&](const Eigen::Vector3d& axis) { return add(axis); });
  }

  /// The first double t in [now, horizon] just after which they penetrate, or `never`. `from`: where to begin.
  double first_inside(double from, double horizon) const {
    if (apart_) return never;
    return first_all_closed(*this, std::max(from, apart_until()), horizon);
  }
  /// A time not before now before which they do not penetrate, or `never`.
  double apart_until() const { return apart_ ? never : motion_.time_before(window_.begin); }
  bool inside(double t) const { return !apart_ && all_closed(*this, t); }
  /// Precondition: inside(t).
  double first_outside(double t, double horizon) const { return first_any_open(*this, t, horizon); }

  // ---- For gap_conditions.hpp: gaps 2 k and 2 k + 1 are the two sides of axis k.

  std::size_t size() const { return 2 * size_; }
  bool surely_closed(std::size_t i, double t) const {
    const Axis& axis = axes_[i / 2];
    return motion_.surely_closed(axis.along, side(i), axis.reach, motion_.tau(t));
  }
  double closed_until(std::size_t i, double t) const {
    const Axis& axis = axes_[i / 2];
    return motion_.closed_until(axis.along, side(i), axis.reach, t);
  }
  double failure_time(std::size_t i, double t, double horizon) const {
    return kds::failure_time(certificate(i), t, horizon);
  }
  double recovery_time(std::size_t i, double t, double horizon) const {
    return kds::recovery_time(certificate(i), t, horizon);
  }
  bool closed(std::size_t i, double t) const { return sign_after(certificate(i), t) < 0; }

 private:
  struct Axis {
    Eigen::Vector3d direction;
    typename QuickMotion<Degree>::Along along;
    double reach;
  };

  bool add(const Eigen::Vector3d& direction) {
    double reach = 0;
    for (const auto& half : a_.shape.half_axes) reach += std::abs(dot(direction, half));
    for (const auto& half : b_.shape.half_axes) reach += std::abs(dot(direction, half));
    axes_[size_] = {direction, motion_.along(direction), reach};
    const Axis& axis = axes_[size_++];
    const bool near = motion_.clip(axis.along, 1, reach, window_) && motion_.clip(axis.along, -1, reach, window_);
    if (near) return true;
    if (motion_.whole()) {
      apart_ = true;
      return false;
    }
    // Apart for as long as is known: what comes after is for exact signs.
    window_ = {motion_.end(), motion_.end()};
    return true;
  }

  static double side(std::size_t i) { return i % 2 == 0 ? 1.0 : -1.0; }
  certificates::PlaneSeparation<Degree> certificate(std::size_t i) const {
    const auto& u = a_.shape.half_axes;
    const auto& w = b_.shape.half_axes;
    return {a_.motion, b_.motion,
            axes_[i / 2].direction, side(i), {&u[0], &u[1], &u[2], &w[0], &w[1], &w[2]}, {}};
  }

  const Body& a_;
  const Body& b_;
  QuickMotion<Degree> motion_;
  TimeWindow window_;
  bool apart_ = false;
  std::size_t size_ = 0;
  std::array<Axis, 15> axes_;
};

}  // namespace kds::collision
