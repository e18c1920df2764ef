// Boxes with rounded edges, in the form that a grid compares.
#pragma once

#include "collision/broad_phase/swept_box.hpp"
#include "kds/simd/two_doubles.hpp"

#include <algorithm>

namespace kds::collision {

/// A box as six numbers (min, -max).
struct BoxBounds {
  Two xy, zx, yz;

  BoxBounds() = default;
  explicit BoxBounds(const StaticBox& box)
      : xy{box.min[0], box.min[1]}, zx{box.min[2], -box.max[0]}, yz{-box.max[1], -box.max[2]} {}

  StaticBox box() const { return {{xy[0], xy[1], zx[0]}, {-zx[1], -yz[0], -yz[1]}}; }
  BoxBounds joined(const BoxBounds& other) const {
    BoxBounds result;
    result.xy = lesser(xy, other.xy), result.zx = lesser(zx, other.zx), result.yz = lesser(yz, other.yz);
    return result;
  }
  bool contains(const BoxBounds& other) const {
    return (set_of_two(xy <= other.xy) & set_of_two(zx <= other.zx) & set_of_two(yz <= other.yz)) == 3;
  }
  double extent() const { return std::max({-zx[1] - xy[0], -yz[0] - xy[1], -yz[1] - zx[0]}); }
};

/// A radius as a box stores it: reduced so far that the roundings of a comparison never make two boxes disjoint that
/// overlap. (Reducing is safe: a box rounded by a radius lies in the same box rounded by a smaller one. A gap along a
/// single axis is compared without an error, since rounding is monotone; where a second axis adds to it, by more than
/// 2^-40 of the square, the reduction exceeds the roundings.)
inline float kept_rounding(double radius) {
  return radius > 0x1p-100 ? static_cast<float>(std::min(radius, 0x1p100) * (1 - 0x1p-20)) : 0;  // a normal number
}

/// Tests two boxes at a time, lane by lane and without a branch, for overlap with another one.
///
/// A box rounded by a radius is the set of points within that radius of a smaller box, that of the centres of balls of
/// this radius that lie in the box. So two overlap if the gap between the smaller boxes is at most the sum R of the
/// radii: if the vector with the components max(0, s + R), for the separations s of the unrounded boxes along the axes,
/// has length R at most. With dense balls in fat boxes this excludes a fifth of the pairs that overlap as boxes.
///
/// Boxes that overlap rounded also overlap unrounded; with radii 0 the converse is true too.
class BoxOverlaps {
 public:
  BoxOverlaps(const BoxBounds& a, float rounding_a, const BoxBounds& b, float rounding_b)
      : min_{Two{a.xy[0], b.xy[0]}, Two{a.xy[1], b.xy[1]}, Two{a.zx[0], b.zx[0]}},
        minus_max_{Two{a.zx[1], b.zx[1]}, Two{a.yz[0], b.yz[0]}, Two{a.yz[1], b.yz[1]}},
        rounding_{rounding_a, rounding_b} {}

  /// Bit 0 if the first box overlaps, bit 1 if the second does.
  unsigned with(const BoxBounds& other, float rounding) const {
    const Two radius = rounding_ + both(rounding);
    const Two x = greater(both(other.xy[0]) + minus_max_[0], both(other.zx[1]) + min_[0]);
    const Two y = greater(both(other.xy[1]) + minus_max_[1], both(other.yz[0]) + min_[1]);
    const Two z = greater(both(other.zx[0]) + minus_max_[2], both(other.yz[1]) + min_[2]);
    const Two gap = square(x + radius) + square(y + radius) + square(z + radius);
    const Two apart = greater(greater(greater(x, y), z), gap - radius * radius);
    return set_of_two(apart <= 0);
  }

 private:
  static Two square(Two x) {
    x = greater(x, Two{0, 0});
    return x * x;
  }

  Two min_[3];
  Two minus_max_[3];
  Two rounding_;
};

}  // namespace kds::collision
