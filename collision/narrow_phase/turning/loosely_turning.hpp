// Bodies of which only bounds are known on how they turn: for how long a plane surely separates two of them.
#pragma once

#include "certificates/turning/rigid_motion.hpp"
#include "collision/shapes/shape.hpp"

namespace kds::collision {

/// A body that precesses, from one time on, whatever pieces of constant angular velocity its motion is made of.
///
/// Law: let G be the rotation that begins as `motion` does and turns with angular velocities w(t) of which the first is
/// within `rate_error` of that of `motion`, and |w|^2 + |w'| is at most `bend`. As long as nothing acts on the body, a
/// point x of it, about its origin, is within off |x| of G(t) x; and its origin is on the path of `motion`, but for
/// roundings of 2^-46 of the terms of `path`.
///
/// So x keeps within off |x| + rate_error |x| s + bend |x| s^2 / 2 of a straight line for s seconds.
template <int Degree>
struct LooselyTurning {
  certificates::RigidMotion<Degree> motion;  ///< starts then
  certificates::PointMotion<Degree> path;    ///< of the origin, as it was begun
  double off = 0;                            ///< rad
  double rate_error = 0;                     ///< rad/s
  double bend = 0;                           ///< rad/s^2
};

/// A time until which two bodies are surely apart while nothing acts on them; that at which their motions start if no
/// plane is found between them. Precondition: their motions start at the same time. Of compounds, half-spaces and
/// meshes that bend it tells nothing.
template <int Degree>
double apart_until(const PlacedShape& shape_a, const LooselyTurning<Degree>& a, const PlacedShape& shape_b,
                   const LooselyTurning<Degree>& b);

extern template double apart_until(const PlacedShape&, const LooselyTurning<1>&, const PlacedShape&,
                                   const LooselyTurning<1>&);
extern template double apart_until(const PlacedShape&, const LooselyTurning<2>&, const PlacedShape&,
                                   const LooselyTurning<2>&);

}  // namespace kds::collision
