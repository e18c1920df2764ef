// Solution of exercise 4: b is (t - 4)^2 / 16 above a, a double root; c, d and e are all at 8 when t = 2.
#pragma once

#include "kds/motion.hpp"

#include <array>

namespace kds::exercises {

inline std::array<Motion<2>, 5> motions() {
  return {{
      {{{0.5, 0, 0}}, 0},
      {{{1.5, -0.5, 0.0625}}, 0},
      {{{6, 1, 0}}, 0},
      {{{8, 0, 0}}, 0},
      {{{10, -1, 0}}, 0},
  }};
}

}  // namespace kds::exercises
