// Kinetic bounding volumes: axis-aligned boxes whose ends move.
#pragma once

#include "certificates/order.hpp"
#include "certificates/point_motion.hpp"
#include "kds/roots/failure_time.hpp"

#include <array>
#include <bit>
#include <cstdint>

namespace kds::collision {

using BodyId = std::uint32_t;

/// An axis-aligned box with a motion for each corner: it may grow and shrink ([Paper] section 5.2).
///
/// It must contain its body until `valid_until`; then the owner asks for a new one.
template <int Degree>
struct KineticBox {
  certificates::PointMotion<Degree> min;
  certificates::PointMotion<Degree> max;
  double valid_until = never;  ///< s
};

/// The double next to x, below or above by `direction` (1, -1), if `moved`; without a branch, since nobody can predict
/// how a sum rounds. Precondition: x is not zero if moved, as a rounded sum is not.
inline double moved_if(bool moved, double x, std::int64_t direction) {
  const auto bits = std::bit_cast<std::int64_t>(x);
  const std::int64_t outward = direction * (bits >> 63 | 1);  // in magnitude
  return std::bit_cast<double>(bits + (outward & -static_cast<std::int64_t>(moved)));
}

/// The box that moves with `motion` and spans [low, high] about it, rounded outward: its real ends are never inside
/// the exact sums.
template <int Degree>
KineticBox<Degree> box_around(const certificates::PointMotion<Degree>& motion, const Eigen::Vector3d& low,
                              const Eigen::Vector3d& high) {
  KineticBox<Degree> box{motion, motion};
  for (int d = 0; d < 3; ++d) {
    const DoubleDouble lower = two_sum(motion.coefficients[0][d], low[d]);
    const DoubleDouble upper = two_sum(motion.coefficients[0][d], high[d]);
    box.min.coefficients[0][d] = moved_if(lower.low < 0, lower.high, -1);
    box.max.coefficients[0][d] = moved_if(upper.low > 0, upper.high, 1);
  }
  return box;
}

/// The six facts that say where two boxes overlap, as coordinates in order: a.min <= b.max and b.min <= a.max, axis by
/// axis. All broken in the opposite sense means overlap.
template <int Degree>
class BoxOverlap {
 public:
  using Apart = certificates::Order<Degree>;

  BoxOverlap(const KineticBox<Degree>& a, const KineticBox<Degree>& b) {
    for (int d = 0; d < 3; ++d) {
      ends_[static_cast<std::size_t>(d)] = {a.min.axis(d), a.max.axis(d), b.min.axis(d), b.max.axis(d)};
    }
  }
  BoxOverlap(const BoxOverlap&) = delete;
  BoxOverlap& operator=(const BoxOverlap&) = delete;

  /// "a lies left of b" and "b lies left of a" on each axis; the boxes overlap where all six are broken.
  std::array<Apart, 6> separations() const {
    return {Apart{ends_[0].a_max, ends_[0].b_min}, Apart{ends_[0].b_max, ends_[0].a_min},
            Apart{ends_[1].a_max, ends_[1].b_min}, Apart{ends_[1].b_max, ends_[1].a_min},
            Apart{ends_[2].a_max, ends_[2].b_min}, Apart{ends_[2].b_max, ends_[2].a_min}};
  }

 private:
  struct Ends {
    Motion<Degree> a_min, a_max, b_min, b_max;
  };
  std::array<Ends, 3> ends_;
};

}  // namespace kds::collision
