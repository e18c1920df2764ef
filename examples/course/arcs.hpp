// Paths for pictures: parabolas in the plane that stay in a square.
#pragma once

#include "certificates/plane_motion.hpp"

#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

namespace kds::course {

/// A coordinate that is p at time 0, q at half the time and r at the end.
inline Polynomial<2> through(double p, double q, double r, double duration) {
  return {{p, (4 * q - 3 * p - r) / duration, (2 * p - 4 * q + 2 * r) / (duration * duration)}};
}

/// n paths through random places of the unit square at the beginning, in the middle and at the end. The same on every
/// machine.
inline std::vector<certificates::PlaneMotion<2>> arcs(std::size_t n, std::uint32_t seed, double duration) {
  std::mt19937 random(seed);
  const auto place = [&] { return random() * 0x1p-32; };
  std::vector<certificates::PlaneMotion<2>> paths(n);
  for (auto& path : paths) {
    for (auto& coordinate : path.coordinate) {
      const double p = place(), q = place(), r = place();
      coordinate = through(p, q, r, duration);
    }
  }
  return paths;
}

}  // namespace kds::course
