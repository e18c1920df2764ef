// Exercise 4: find the degenerate case. Give five motions for which the sorted list of 03 has exactly three events from
// t = 0 to t = 8, all three at one time: c, d and e meet in one point and turn round their order. Besides, a and b are
// to meet once in that time, but without an event. (08 shows both.)
#pragma once

#include "kds/motion.hpp"

#include <array>

namespace kds::exercises {

/// a, b, c, d, e: height, speed, half the acceleration; all about time 0.
inline std::array<Motion<2>, 5> motions() {
  return {{
      {{{0.5, 0, 0}}, 0},
      {{{1.5, -0.75, 0.125}}, 0},
      {{{6, 1, 0}}, 0},
      {{{8, 0, 0}}, 0},
      {{{9, -1, 0.0625}}, 0},
  }};
}

}  // namespace kds::exercises
