// What is asked of the pieces of a motion that callers give.
#pragma once

#include "certificates/turning/rigid_motion.hpp"
#include "collision/body_description.hpp"
#include "collision/body_motion.hpp"
#include "collision/motion_range.hpp"
#include "collision/response/rotation_piece.hpp"
#include "collision/shapes/shape.hpp"
#include "collision/vectors.hpp"
#include "kds/arithmetic/lattice.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>

namespace kds::collision {

/// Throws std::invalid_argument, naming the piece `name`[i], unless their numbers are in range and each starts later
/// than the one before.
template <class Motion>
void require_pieces(std::span<const Motion> pieces, const char* name) {
  const auto name_of = [name](std::size_t i) { return std::string(name) + "[" + std::to_string(i) + "]"; };
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (!in_range(pieces[i])) refuse_motion(pieces[i], name_of(i));
    if (i > 0 && !(path_of(pieces[i]).start > path_of(pieces[i - 1]).start)) {
      throw std::invalid_argument(name_of(i) + ".start: pieces must be sorted by start");
    }
  }
}

/// A body that precesses moves in pieces, and the clock has to tell these from each other. Throws
/// std::invalid_argument, naming the motion by `name`, if it cannot at some time from `now` on.
template <int Degree>
void require_steady_clock(const certificates::RigidMotion<Degree>& motion, double now, const std::string& name) {
  const double t = std::max(std::abs(now), std::abs(motion.start()));
  if (norm(motion.angular_velocity) * (next_up(t) - t) <= longest_turn) return;
  throw std::invalid_argument(name +
                              ".angular_velocity: the body precesses, and turns by more than a radian between two "
                              "doubles of the clock");
}

/// Whether bodies of a shape keep their orientation: a half-space, since what it would sweep has no bounds, and a mesh
/// that bends, since its script can turn it.
inline bool keeps_orientation(const Shape& shape) { return unbounded(shape) || bends(shape); }

/// Throws std::invalid_argument, naming the motion by `name`, if it would turn a body that keeps its orientation.
template <int Degree>
void require_no_spin(const Shape& shape, const certificates::RigidMotion<Degree>& motion, const std::string& name) {
  if (!keeps_orientation(shape) || motion.angular_velocity.isZero(0)) return;
  throw std::invalid_argument(name + ".angular_velocity: a " + kind_name(shape) + " does not turn" +
                              (bends(shape) ? ": its vertices say how it moves" : ""));
}

}  // namespace kds::collision
