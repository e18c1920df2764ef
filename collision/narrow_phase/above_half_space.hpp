// When a shape is above the plane of a half-space.
#pragma once

#include "certificates/half_space_separation.hpp"
#include "collision/narrow_phase/gap_conditions.hpp"
#include "collision/narrow_phase/lowest_place.hpp"
#include "collision/narrow_phase/narrow_phase.hpp"
#include "collision/narrow_phase/quick_motion.hpp"
#include "collision/shapes/half_space.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace kds::collision {

/// The gap between a half-space (a) and the lowest place of a shape (b) that keep their orientations, from `now` to the
/// horizon: they penetrate while it is closed. It is the one piece of the relative positions in contact, as
/// PiecewiseContact needs it.
template <int Degree>
class AboveHalfSpace {
 public:
  using Body = TranslatingShape<Degree>;

  AboveHalfSpace(const Body& a, const Body& b, double now, double horizon)
      : a_(a),
        b_(b),
        plane_(placed_half_space(a.shape)),
        lowest_(b.shape, plane_.normal),
        motion_(a.motion, b.motion, now, horizon, std::abs(plane_.offset) + b.shape.bounding_radius),
        along_(motion_.along(plane_.normal)),
        distance_(plane_.offset - lowest_.height()),
        window_{0, motion_.end()} {
    if (!motion_.whole()) motion_.note_opening(along_, 1, distance_);
    if (motion_.clip(along_, 1, distance_, window_)) return;
    apart_ = motion_.whole();
    // Apart as long as the filter is valid: later times are decided by exact signs.
    window_ = {motion_.end(), motion_.end()};
  }

  template <class Visit>
  void every_piece(const Visit& visit) const {
    if (!apart_) visit(*this);
  }
  template <class Visit>
  void earliest_pieces(double horizon, const Visit& visit) const {
    if (!apart_ && earliest() <= horizon) visit(*this);
  }

  /// They do not penetrate between now and this time.
  double earliest() const { return motion_.time_before(window_.begin); }
  bool inside(double t) const { return all_closed(*this, t); }
  /// The first double t in [now, horizon] just after which they penetrate, or `never`. `from`: where to begin.
  double first_inside(double from, double horizon) const {
    return first_all_closed(*this, std::max(from, earliest()), horizon);
  }
  /// Precondition: inside(t).
  double first_outside(double t, double horizon) const { return first_any_open(*this, t, horizon); }

  // ---- For gap_conditions.hpp: one gap.

  static std::size_t size() { return 1; }
  bool surely_closed(std::size_t, double t) const {
    return motion_.surely_closed(along_, 1, distance_, motion_.tau(t));
  }
  double closed_until(std::size_t, double t) const { return motion_.closed_until(along_, 1, distance_, t); }
  double failure_time(std::size_t, double t, double horizon) const {
    return kds::failure_time(certificate(), t, horizon);
  }
  double recovery_time(std::size_t, double t, double horizon) const {
    return kds::recovery_time(certificate(), t, horizon);
  }
  double opened_by(std::size_t) const { return motion_.time_after(motion_.opened_by(along_, 1, distance_)); }
  bool closed(std::size_t, double t) const { return sign_after(certificate(), t) < 0; }

 private:
  certificates::HalfSpaceSeparation<Degree> certificate() const {
    return {a_.motion, b_.motion, plane_.normal, plane_.offset, lowest_.place()};
  }

  const Body& a_;
  const Body& b_;
  HalfSpace plane_;
  LowestOfShape lowest_;
  QuickMotion<Degree> motion_;
  typename QuickMotion<Degree>::Along along_;
  double distance_;
  TimeWindow window_;
  bool apart_ = false;
};

}  // namespace kds::collision
