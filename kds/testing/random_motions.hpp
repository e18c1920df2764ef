// Random motions of the kinds that are hard on a kinetic structure.
#pragma once

#include "kds/motion.hpp"
#include "kds/testing/random.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace kds::testing {

/// What the numbers of a scenario look like.
enum class Kind {
  generic,  ///< all bits random
  lattice,  ///< small integers: many values meet at one time, touch, or are one
  mixed,    ///< lines among parabolas
  resting,  ///< most do not move
  scales,   ///< 1e-6 next to 1e6
  late,     ///< clock at 1e9
  coarse,   ///< clock where doubles are a second apart: many events at one time, each up to a second late
};
inline constexpr std::array all_kinds{Kind::generic, Kind::lattice, Kind::mixed, Kind::resting,
                                      Kind::scales,  Kind::late,    Kind::coarse};

/// Where the clock starts, in seconds.
inline double beginning(Kind kind) { return kind == Kind::late ? 1e9 : (kind == Kind::coarse ? 0x1p52 : 0); }

/// A motion that starts about `now`. One of an element with several coordinates is made of several of these.
template <int Degree>
Motion<Degree> random_motion(Random& random, Kind kind, double now) {
  Motion<Degree> motion;
  motion.start = now;
  auto& c = motion.position.c;
  switch (kind) {
    case Kind::generic:
    case Kind::late:
      for (double& x : c) x = random.between(-1, 1);
      motion.start = now + random.between(-1, 1);
      break;
    case Kind::lattice:
      for (double& x : c) x = random.integer(-3, 3);
      if (Degree >= 2 && random.one_in(2)) c[Degree] = 0;
      motion.start = std::floor(now) + random.integer(-1, 1);
      break;
    case Kind::mixed:
      for (double& x : c) x = random.between(-1, 1);
      if (random.one_in(2)) std::fill(c.begin() + 2, c.end(), 0.0);
      break;
    case Kind::resting:
      c.fill(0);
      c[0] = random.integer(-5, 5);
      if (random.one_in(4)) c[1] = random.integer(-2, 2);
      motion.start = now + random.integer(-1, 1);
      break;
    case Kind::scales: {
      constexpr double small = 1e-6, large = 1e6;
      const double scale = random.one_in(2) ? small : large;
      for (double& x : c) x = random.between(-scale, scale);
      if (random.one_in(3)) c[1] = random.between(-large, large);
      break;
    }
    case Kind::coarse:  // A few seconds from one to the next, half of them with an acceleration in common.
      for (double& x : c) x = random.between(-4, 4);
      std::fill(c.begin() + 2, c.end(), random.one_in(2) ? 0.5 : random.between(-1, 1));
      motion.start = now + random.integer(-1, 1);
      break;
  }
  return motion;
}

/// How long nothing is edited, in seconds.
inline double random_delay(Random& random, Kind kind) {
  if (kind == Kind::coarse) return random.integer(0, 3);
  return kind == Kind::lattice || kind == Kind::resting ? random.integer(0, 4) / 4.0 : random.between(0, 0.5);
}

}  // namespace kds::testing
