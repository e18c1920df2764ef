// When two boxes penetrate.
#pragma once

#include "certificates/plane_separation.hpp"
#include "collision/narrow_phase/gap_conditions.hpp"
#include "collision/narrow_phase/narrow_phase.hpp"
#include "collision/narrow_phase/quick_motion.hpp"
#include "collision/vectors.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace kds::collision {

/// Directions that can separate two boxes: three face normals each, nine products of edges.
///
/// Cross products of edges shorter than this (relative, squared) come from parallel edges, whose common directions
/// the face normals cover: leaving one out lets a contact be reported early by at most 2^-40 of the boxes' size.
inline constexpr double surely_crossing = 0x1p-80;

/// Axis number k of fifteen.
inline Eigen::Vector3d box_axis(const PlacedShape& a, const PlacedShape& b, int k) {
  if (k < 3) return a.rotation.col(k);
  if (k < 6) return b.rotation.col(k - 3);
  return cross(a.rotation.col((k - 6) / 3), b.rotation.col((k - 6) % 3));
}

/// Calls visit(axis, its number) until it returns false.
template <class Visit>
void every_box_axis(const PlacedShape& a, const PlacedShape& b, const Visit& visit) {
  const int count = a.rotation == b.rotation ? 3 : 15;
  for (int k = 0; k < count; ++k) {
    const Eigen::Vector3d axis = box_axis(a, b, k);
    if ((k < 6 || squared_norm(axis) > surely_crossing) && !visit(axis, k)) return;
  }
}

/// The gaps of two boxes on both sides of every axis, from `now` to the horizon: they penetrate while all are closed.
///
/// A gap that stays open all the time ends the search; this is the usual case, and costs some ten operations for each
/// axis tried.
template <int Degree>
class BoxAndBox {
 public:
  using Body = TranslatingShape<Degree>;

  /// With `faces_do` products of edges are tested only if no face separates the boxes now: the object is then for
  /// apart_until() only.
  BoxAndBox(const Body& a, const Body& b, double now, double horizon, bool faces_do = false)
      : a_(a),
        b_(b),
        motion_(a.motion, b.motion, now, horizon, a.shape.bounding_radius + b.shape.bounding_radius),
        window_{0, motion_.end()} {
    for (int k = 0; k < 3 && !motion_.whole(); ++k) {
      const Axis axis = placed(a, b, motion_, box_axis(a.shape, b.shape, k));
      motion_.note_parting(axis.along, axis.half_width);
    }
    every_box_axis(a.shape, b.shape, [&](const Eigen::Vector3d& axis, int k) {
      return !(faces_do && k >= 6 && separated_ > 0) && add(axis, k);
    });
  }

  /// A time not before now before which they do not penetrate, or `never`: until then one axis separates them, and
  /// `memory` says which. That one is tried first, and is the only one if it separates them now; otherwise the best of
  /// all is taken.
  static double apart_until(const Body& a, const Body& b, double now, double horizon, PairMemory& memory);

  /// The first double t in [now, horizon] just after which they penetrate, or `never`. `from`: where to begin.
  double first_inside(double from, double horizon) const {
    if (apart_) return never;
    return first_all_closed(*this, std::max(from, apart_until()), horizon);
  }
  double apart_until() const { return apart_ ? never : motion_.time_before(window_.begin); }
  bool inside(double t) const { return !apart_ && all_closed(*this, t); }
  /// Precondition: inside(t).
  double first_outside(double t, double horizon) const { return first_any_open(*this, t, horizon); }

  // ---- For gap_conditions.hpp: gaps 2 k and 2 k + 1 are the two sides of axis k.

  std::size_t size() const { return 2 * size_; }
  bool surely_closed(std::size_t i, double t) const {
    const Axis& axis = axes_[i / 2];
    return motion_.surely_closed(axis.along, side(i), axis.half_width, motion_.tau(t));
  }
  double closed_until(std::size_t i, double t) const {
    const Axis& axis = axes_[i / 2];
    return motion_.closed_until(axis.along, side(i), axis.half_width, t);
  }
  double failure_time(std::size_t i, double t, double horizon) const {
    return kds::failure_time(certificate(i), t, horizon);
  }
  double recovery_time(std::size_t i, double t, double horizon) const {
    return kds::recovery_time(certificate(i), t, horizon);
  }
  double opened_by(std::size_t i) const {
    const Axis& axis = axes_[i / 2];
    return motion_.time_after(motion_.opened_by(axis.along, side(i), axis.half_width));
  }
  bool closed(std::size_t i, double t) const { return sign_after(certificate(i), t) < 0; }

 private:
  struct Axis {
    Eigen::Vector3d direction;
    typename QuickMotion<Degree>::Along along;
    double half_width;
  };

  static Axis placed(const Body& a, const Body& b, const QuickMotion<Degree>& motion, const Eigen::Vector3d& axis) {
    double half_width = 0;
    for (const auto& half : a.shape.half_axes) half_width += std::abs(dot(axis, half));
    for (const auto& half : b.shape.half_axes) half_width += std::abs(dot(axis, half));
    return {axis, motion.along(axis), half_width};
  }
  static bool clip(const QuickMotion<Degree>& motion, const Axis& axis, TimeWindow& window) {
    return motion.clip(axis.along, 1, axis.half_width, window) && motion.clip(axis.along, -1, axis.half_width, window);
  }

  bool add(const Eigen::Vector3d& direction, int number) {
    const Axis& axis = axes_[size_++] = placed(a_, b_, motion_, direction);
    TimeWindow near{0, motion_.end()};
    bool meet = clip(motion_, axis, near);
    const double until = meet ? near.begin : never;
    if (until > separated_) {
      separated_ = until;
      separating_ = number;
    }
    window_ = {std::max(window_.begin, near.begin), std::min(window_.end, near.end)};
    meet = meet && window_.begin <= window_.end;
    if (meet) return true;
    if (motion_.whole()) {
      apart_ = true;
      return false;
    }
    // Apart as long as the filter is valid: later times are decided by exact signs.
    window_ = {motion_.end(), motion_.end()};
    return true;
  }

  static double side(std::size_t i) { return i % 2 == 0 ? 1.0 : -1.0; }
  certificates::PlaneSeparation<Degree> certificate(std::size_t i) const {
    const auto& u = a_.shape.half_axes;
    const auto& w = b_.shape.half_axes;
    return {a_.motion, b_.motion, axes_[i / 2].direction, side(i), {&u[0], &u[1], &u[2], &w[0], &w[1], &w[2]}, {}};
  }

  const Body& a_;
  const Body& b_;
  QuickMotion<Degree> motion_;
  TimeWindow window_;
  bool apart_ = false;
  int separating_ = 0;  ///< number of the axis that separates them longest by itself, as far as is known
  double separated_ = 0;
  std::size_t size_ = 0;
  std::array<Axis, 15> axes_;
};

// ---------------------------------------------------------------------------------------------------------------

template <int Degree>
double BoxAndBox<Degree>::apart_until(const Body& a, const Body& b, double now, double horizon, PairMemory& memory) {
  if (memory.axis != PairMemory::none) {
    QuickMotion<Degree> motion(a.motion, b.motion, now, horizon, a.shape.bounding_radius + b.shape.bounding_radius);
    TimeWindow window{0, motion.end()};
    const Axis axis = placed(a, b, motion, box_axis(a.shape, b.shape, memory.axis));
    motion.note_parting(axis.along, axis.half_width);
    const bool near = clip(motion, axis, window);
    if (!near && motion.whole()) return never;
    if (near && window.begin > 0) return motion.time_before(window.begin);
  }
  const BoxAndBox pair(a, b, now, horizon, true);
  memory.axis = static_cast<std::uint8_t>(pair.separating_);
  return pair.apart_until();
}

}  // namespace kds::collision
