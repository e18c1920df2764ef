// Two moving points in order along a direction.
#pragma once

#include "kds/bounded.hpp"
#include "kds/certificate.hpp"
#include "kds/lasting.hpp"
#include "kds/motion.hpp"

#include <array>
#include <cstddef>

namespace kds::certificates {

/// direction . (upper(t) - lower(t)) >= 0. The direction, any doubles, is taken as exact and need not be a unit vector.
/// Degree that of the paths. A path is anything with axis(d): PointMotion, PlaneMotion.
template <class Path, std::size_t Dimension>
struct DirectionOrder {
  static constexpr int degree = Path::degree;
  Held<Path> lower;
  Held<Path> upper;
  const std::array<double, Dimension>& direction;

  DirectionOrder(Lasting<Path> low, Lasting<Path> high, Lasting<std::array<double, Dimension>> along_which)
      : lower(low), upper(high), direction(along_which) {}

  template <class Number>
  auto polynomial(double epoch) const {
    auto f = along<Number>(0, epoch);
    for (std::size_t d = 1; d < Dimension; ++d) f = f + along<Number>(d, epoch);
    return f;
  }

  bool is_negative_of(const DirectionOrder& other) const {
    return is_same_thing(lower, other.upper) && is_same_thing(upper, other.lower) && &direction == &other.direction;
  }

  bool vanishes() const {
    for (std::size_t d = 0; d < Dimension; ++d) {
      if (direction[d] != 0 && !(lower.axis(static_cast<int>(d)) == upper.axis(static_cast<int>(d)))) return false;
    }
    return true;
  }

 private:
  template <class Number>
  auto along(std::size_t d, double epoch) const {
    const int axis = static_cast<int>(d);
    return difference_about<Number>(upper.axis(axis), lower.axis(axis), epoch) * direction[d];
  }
};

}  // namespace kds::certificates
