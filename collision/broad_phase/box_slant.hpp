// What a body on a straight path leaves empty of the box that it sweeps.
#pragma once

#include "collision/broad_phase/box_bounds.hpp"
#include "collision/broad_phase/swept_box.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace kds::collision {

/// All places of a box that moves along an infinite line: a prism. A fast body sweeps a long box and a small part of
/// it: what is outside the prism does not meet the body.
class BoxSlant {
 public:
  BoxSlant() {}  // the implicit one would set all to zero first
  /// The places of a box that contains the body at one time, and moves with it. Precondition: pays(box, velocity).
  BoxSlant(const StaticBox& box, const Eigen::Vector3d& velocity);

  /// Whether the prism is much less than the swept box; along one axis only it is all of it. False also near 0, where
  /// products might underflow.
  static bool pays(const StaticBox& box, const Eigen::Vector3d& velocity);

  /// Whether a box is certainly outside: separated along an axis that is normal to the velocity and to an edge. The
  /// same answer for the same numbers, always.
  ///
  /// Error bound: with F, the sum over both boxes of the greatest magnitude of an end along an axis, twice a centre
  /// and an extent err by at most 2 units of 2^-53 F, the direction by one for each place up to F; with the sums,
  /// differences and products that follow these are less than 32 units for each coordinate, times the other one's
  /// speed. The margin is twice that.
  bool apart(const BoxBounds& other) const;

  /// The first axis of the greatest speed.
  std::size_t main_axis() const { return along_[0].speed() == 1 ? 0 : (along_[1].speed() == 1 ? 1 : 2); }
  /// Where the prism is along another axis d: at most `half` from at + rate x, for x along the main axis, up to
  /// rounding.
  struct Line {
    double at, rate, half;
  };
  Line line(std::size_t d) const {
    const Along& main = along_[main_axis()];
    const double rate = along_[d].velocity * main.velocity;  // that of the main axis is 1 or -1
    return {0.5 * (along_[d].twice_centre - rate * main.twice_centre), rate,
            0.5 * (along_[d].extent + std::abs(rate) * main.extent)};
  }
  /// Of its box, along any axis, from 0, up to rounding.
  double farthest() const { return std::max({along_[0].farthest(), along_[1].farthest(), along_[2].farthest()}); }

 private:
  /// Along one axis; the box is given by twice its centre and by its extent.
  struct Along {
    double velocity;  ///< over the greatest speed along an axis
    double twice_centre, extent;

    double speed() const { return std::abs(velocity); }
    double farthest() const { return 0.5 * (std::abs(twice_centre) + extent); }  ///< of its ends, up to rounding
  };
  /// Twice the distance of the centres along an axis, and the greatest at which boxes overlap.
  struct Side {
    double distance, greatest;
  };
  Side side(std::size_t d, double min, double minus_max) const;
  bool apart(std::size_t i, const Side& at_i, std::size_t j, const Side& at_j) const;

  std::array<Along, 3> along_;
};

inline BoxSlant::Side BoxSlant::side(std::size_t d, double min, double minus_max) const {
  const double farthest = along_[d].farthest() + std::max(std::abs(min), std::abs(minus_max));
  return {min - minus_max - along_[d].twice_centre, along_[d].extent - (min + minus_max) + 0x1p-47 * farthest};
}

inline bool BoxSlant::apart(std::size_t i, const Side& at_i, std::size_t j, const Side& at_j) const {
  return std::abs(along_[j].velocity * at_i.distance - along_[i].velocity * at_j.distance) >
         along_[j].speed() * at_i.greatest + along_[i].speed() * at_j.greatest;
}

inline bool BoxSlant::apart(const BoxBounds& other) const {
  const Side x = side(0, other.xy[0], other.zx[1]);
  const Side y = side(1, other.xy[1], other.yz[0]);
  if (apart(0, x, 1, y)) return true;
  const Side z = side(2, other.zx[0], other.yz[1]);
  return apart(1, y, 2, z) || apart(2, z, 0, x);
}

}  // namespace kds::collision
