// The certificates that keep two bodies apart in the directions without a list: a part of unlisted_axes.cpp.
#pragma once

#include "collision/broad_phase/unlisted_axes.hpp"

#include <boost/container/static_vector.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

namespace kds::collision {

/// The certificates that keep two bodies apart in the directions without a list; for one pair at a time.
template <int Degree>
class UnlistedAxes<Degree>::Sides {
 public:
  Sides(const UnlistedAxes& axes, BodySlot a, BodySlot b)
      : ends_{ends(axes, 0, a, b), ends(axes, 1, a, b)},
        apart_{Apart{ends_[0].a_max, ends_[0].b_min}, Apart{ends_[0].b_max, ends_[0].a_min},
               Apart{ends_[1].a_max, ends_[1].b_min}, Apart{ends_[1].b_max, ends_[1].a_min}},
        count_(axes.count_) {
    for (const std::size_t d : axes.more_) {
      const KineticSlab<Degree>& slab_a = axes.slab(a, d);
      const KineticSlab<Degree>& slab_b = axes.slab(b, d);
      more_.push_back({slab_a.max, slab_b.min});
      more_.push_back({slab_b.max, slab_a.min});
    }
  }
  Sides(const Sides&) = delete;
  Sides& operator=(const Sides&) = delete;

  std::span<const Apart> apart() const { return {apart_.data(), 2 * count_}; }  ///< on axes
  std::span<const Apart> more() const { return {more_.data(), more_.size()}; }  ///< in other directions

  /// Whether the boxes certainly do not overlap from now to the horizon: straight paths in doubles.
  ///
  /// A side is gap + rate (t - now); the errors of gap are within 2^-50 of the terms it is made of (see Order::line()),
  /// the rate is a difference of doubles with an exact sign. A side is broken after `begin` seconds, or until `end`:
  /// each is rounded to the safe side by more than the errors of the quotient and the rate, 2^-53 each.
  bool stay_apart(double now, double horizon) const {
    if constexpr (Degree == 1) {
      double begin = 0;
      double end = (horizon - now) * (1 + 0x1p-48);
      for (const Apart& side : apart()) {
        if (narrow(side, now, begin, end)) return true;
      }
      for (const Apart& side : more()) {
        if (begin > end || narrow(side, now, begin, end)) return true;
      }
      return begin > end;
    } else {
      return false;
    }
  }

 private:
  /// Reduces [begin, end] to the seconds from now for which a side may be broken; true if it never will be.
  static bool narrow(const Apart& side, double now, double& begin, double& end) {
    const double run_lower = side.lower.position.c[1] * (now - side.lower.start);
    const double run_upper = side.upper.position.c[1] * (now - side.upper.start);
    const double gap = (side.upper.position.c[0] + run_upper) - (side.lower.position.c[0] + run_lower);
    const double least = gap -
                         0x1p-50 * (std::abs(side.upper.position.c[0]) + std::abs(run_upper) +
                                    std::abs(side.lower.position.c[0]) + std::abs(run_lower)) -
                         0x1p-1000;  // for underflow
    const double rate = side.upper.position.c[1] - side.lower.position.c[1];
    if (rate >= 0 && least > 0) return true;
    if (rate < 0) begin = std::max(begin, least / -rate * (1 - 0x1p-48));
    if (rate > 0) end = std::min(end, -least / rate * (1 + 0x1p-48));
    return false;
  }

  struct Ends {
    Motion<Degree> a_min, a_max, b_min, b_max;
  };

  static Ends ends(const UnlistedAxes& axes, std::size_t i, BodySlot a, BodySlot b) {
    const int d = axes.axes_[i];
    const auto& box_a = axes.boxes_[a];
    const auto& box_b = axes.boxes_[b];
    return {box_a.min.axis(d), box_a.max.axis(d), box_b.min.axis(d), box_b.max.axis(d)};
  }

  std::array<Ends, 2> ends_;
  std::array<Apart, 4> apart_;
  std::size_t count_;
  boost::container::static_vector<Apart, 2 * most_directions> more_;
};

}  // namespace kds::collision
