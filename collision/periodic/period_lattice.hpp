// The places of a periodic box and of its copies.
#pragma once

#include "certificates/point_motion.hpp"
#include "collision/periodic/periodic_options.hpp"
#include "kds/arithmetic/double_double.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>

namespace kds::collision {

/// Which copy of the box: numbers of periods along the axes, 0 along those that are not periodic.
using Offset = std::array<std::int64_t, 3>;

inline Offset operator+(const Offset& a, const Offset& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline Offset operator-(const Offset& a) { return {-a[0], -a[1], -a[2]}; }

/// The copies of the box lie in a lattice. With shear it is that of Lees and Edwards [Lees72]: the layers of boxes
/// along y slide past each other in x, each at the speed `sliding()` relative to the one below. They are in line at the
/// start.
class PeriodLattice {
 public:
  explicit PeriodLattice(const PeriodicOptions& options) : start_(options.world.start_time) {
    for (int d = 0; d < 3; ++d) {
      periodic_[static_cast<std::size_t>(d)] = options.boundaries[static_cast<std::size_t>(d)] == Boundary::periodic;
      if (periodic(d)) period_[d] = options.max[d] - options.min[d];
    }
    sliding_ = options.shear_rate == 0 ? 0 : options.shear_rate * period_[1];
  }

  bool periodic(int axis) const { return periodic_[static_cast<std::size_t>(axis)]; }
  /// Length; 0 of an axis that is not periodic.
  double period(int axis) const { return period_[axis]; }
  double sliding() const { return sliding_; }  ///< length/s
  bool slides() const { return sliding_ != 0; }

  /// From a place in the box to that in a copy, at t: computed in double-double, rounded once.
  Eigen::Vector3d displacement(const Offset& offset, double t) const {
    Eigen::Vector3d way;
    for (std::size_t d = 0; d < 3; ++d) way[static_cast<int>(d)] = double(offset[d]) * period_[static_cast<int>(d)];
    if (offset[1] == 0 || !slides()) return way;
    const DoubleDouble slid = two_sum(t, -start_) * two_product(double(offset[1]), sliding_);
    way[0] = double(two_product(double(offset[0]), period_[0]) + slid);
    return way;
  }
  /// By how much faster what is there moves.
  Eigen::Vector3d velocity(const Offset& offset) const { return {double(offset[1]) * sliding_, 0, 0}; }

  /// The motion of a body as it is in a copy: position and velocity are rounded once each, and the start is the same.
  template <int Degree>
  certificates::PointMotion<Degree> moved(certificates::PointMotion<Degree> motion, const Offset& offset) const {
    motion.coefficients[0] += displacement(offset, motion.start);
    motion.coefficients[1] += velocity(offset);
    return motion;
  }

 private:
  Eigen::Vector3d period_ = Eigen::Vector3d::Zero();
  std::array<bool, 3> periodic_{};
  double sliding_ = 0;
  double start_;
};

}  // namespace kds::collision
