// Random motions of points in a plane that repeats itself.
#pragma once

#include "certificates/plane_motion.hpp"
#include "tests/structures/random_values.hpp"

namespace kds::tests {

inline certificates::PlaneMotion<1> random_periodic_motion(Random& random, Kind kind, double now) {
  auto path = random_plane_motion<1>(random, kind, now);
  // Those of large numbers would run round the rectangle 1 000 000 times a second.
  for (auto& coordinate : path.coordinate) {
    if (kind == Kind::scales) coordinate.c[1] *= 0x1p-20;
  }
  return path;
}

}  // namespace kds::tests
