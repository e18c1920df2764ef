// The doubles as a lattice of points in time.
#pragma once

#include "kds/arithmetic/strict.hpp"

#include <bit>
#include <cstdint>
#include <limits>

namespace kds {

/// The failure time of a certificate that does not fail within the horizon.
inline constexpr double never = std::numeric_limits<double>::infinity();

/// Position of a double in the order of all doubles: consecutive doubles have consecutive numbers.
inline std::int64_t lattice_index(double t) {
  const auto bits = std::bit_cast<std::int64_t>(t);
  return bits >= 0 ? bits : std::numeric_limits<std::int64_t>::min() - bits;
}

inline double lattice_point(std::int64_t index) {
  return std::bit_cast<double>(index >= 0 ? index : std::numeric_limits<std::int64_t>::min() - index);
}

/// The next double above / below. Precondition: finite.
inline double next_up(double t) { return lattice_point(lattice_index(t) + 1); }
inline double next_down(double t) { return lattice_point(lattice_index(t) - 1); }

/// How many steps lead from a up to b. Precondition: a <= b.
inline std::uint64_t lattice_distance(double a, double b) {
  return static_cast<std::uint64_t>(lattice_index(b)) - static_cast<std::uint64_t>(lattice_index(a));
}

/// Half way in steps, not in value: bisection reaches any double within 64 halvings.
inline double lattice_middle(double a, double b) {
  return lattice_point(lattice_index(a) + static_cast<std::int64_t>(lattice_distance(a, b) / 2));
}

}  // namespace kds
