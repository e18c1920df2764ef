// What a screening finds.
#pragma once

#include <cstddef>
#include <vector>

namespace conjunctions {

/// Two objects, a < b, are nearer to each other than the screening distance from `entry` to `exit`.
struct Conjunction {
  std::size_t a = 0, b = 0;  ///< places in the catalogue
  double entry = 0;          ///< s; 0 with near_at_start
  double closest = 0;        ///< s, when they are nearest
  double distance = 0;       ///< km, how near
  double speed = 0;          ///< km/s, of one relative to the other then
  double height = 0;         ///< km, of a above the Earth's equatorial radius then
  double exit = 0;           ///< s; the end of the screening with near_at_end
  bool near_at_start = false;
  bool near_at_end = false;
};

struct Screening {
  double distance = 5;  ///< km, between centres
  double hours = 24;
};

}  // namespace conjunctions
