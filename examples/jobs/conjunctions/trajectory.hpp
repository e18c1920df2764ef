// An object's path as a stream of quintics.
#pragma once

#include "certificates/point_motion.hpp"
#include "examples/jobs/conjunctions/orbit.hpp"

#include <algorithm>
#include <stdexcept>

namespace conjunctions {

using Path = kds::certificates::PointMotion<5>;

/// The greatest distance between an object and the quintic that stands for it, km. Distances are exact for the
/// quintics, so that of a pair is off by twice this at most: only conjunctions whose closest approach is within 2 m of
/// the screening distance depend on it.
inline constexpr double interpolation_error = 0.001;

/// Pieces begin and end at multiples of this, s, so that objects share the times at which pieces change.
inline constexpr double tick = 60;

/// Makes the pieces of one object one after the other; it knows no more than the end of the last.
class Trajectory {
 public:
  /// Throws std::invalid_argument for an orbit that bends too sharply for pieces of one tick.
  explicit Trajectory(const Elements& elements) : orbit_(elements), end_(orbit_.state(0)) {
    constexpr double longest = 8 * tick;
    const double length = std::min(orbit_.piece_length(interpolation_error), longest);
    if (!(length >= tick))
      throw std::invalid_argument("Trajectory: the orbit bends too sharply for pieces of a minute");
    ticks_ = static_cast<int>(length / tick);
  }

  /// Whether the last piece ends at this tick; at tick 0 the first has to be made.
  bool ends_at(int k) const { return k == end_tick_; }

  /// The piece that begins where the last has ended. Both have the same state there, so that no body jumps.
  Path next() {
    const State begin = end_;
    const double t0 = end_tick_ * tick;
    end_tick_ += ticks_;
    const double t1 = end_tick_ * tick;
    end_ = orbit_.state(t1);
    return Path::quintic(begin.position, begin.velocity, begin.acceleration, end_.position, end_.velocity,
                         end_.acceleration, t0, t1);
  }

 private:
  Orbit orbit_;
  State end_;
  int end_tick_ = 0;
  int ticks_;
};

}  // namespace conjunctions
