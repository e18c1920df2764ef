// When the balls of two pairs may meet, computed together.
#pragma once

#include "certificates/ball_separation.hpp"
#include "certificates/relative_line.hpp"
#include "kds/arithmetic/lattice.hpp"
#include "kds/arithmetic/two.hpp"

namespace kds::certificates {

/// Of two pairs of balls, lane by lane.
struct TwoApproaches {
  /// Not before `now` and not after first_approach(now, horizon), `never` just where that is certain; or a NaN where it
  /// takes more care.
  Two earliest;
  /// Whether the balls are surely apart at `now`; false says nothing.
  TwoBits apart;
};

/// Most pairs of balls whose motions change are asked for more often than they meet, so a lower bound is what is wanted
/// of them first. It knows the paths that BallSeparation::quick_failure_time() knows.
///
/// Two lanes, and without a branch: whether balls approach is what processors cannot foresee. Along a line f (the
/// square of the distance less that of the reach) is convex: it has its first root where it falls, at c / (p + sqrt(p^2
/// - c s)) with c = f now, p half its rate downward and s that of v . v. Bounds in place of c, p and the discriminant
/// give a lower bound of that, and whether it is a root at all need not be known.
template <int PathDegree>
[[gnu::always_inline]] inline TwoApproaches earliest_approaches(const BallSeparation<PathDegree>& one,
                                                                const BallSeparation<PathDegree>& other, double now,
                                                                double horizon) {
  using Line = detail::RelativeLine<Two>;
  const Two undecided = both(kds::detail::undecided);
  const Line line(one, other, now);
  const Two error = Line::unit * (line.M * line.W) + Line::lost;  // of the product
  const Two size = line.M * line.M + line.reach * line.reach;
  const Two least = line.square - (Line::unit * size + Line::lost);
  // The discriminant is off by unit W^2 (4 M^2 + 2 reach^2), and by its own rounding.
  const Two spare = 8 * Line::unit * (line.W * line.W) * size + Line::lost;
  const Two discriminant = line.product * line.product - line.square * line.speeds + spare;
  const Two root = least / (square_root(discriminant) - line.product + error);
  const Two sum = now + root * (1 - 0x1p-50);
  const Two t = sum - 0x1p-52 * magnitude(sum);  // not after what was rounded

  TwoBits known = line.M + line.W + line.reach < Line::small;
  if constexpr (PathDegree > 1) known &= TwoBits{-one.relative_path_is_line(), -other.relative_path_is_line()};
  const TwoBits parts = (line.product > error) | (line.W == 0.0);  // or one stands as seen from the other
  const TwoBits comes = (line.product < -error) & (least > 0.0);
  Two earliest = t <= horizon ? greater(t, both(now)) : both(never);  // t is a NaN where there is no root
  earliest = comes ? earliest : undecided;
  earliest = parts ? both(never) : earliest;
  return {known ? earliest : undecided, known & (least > 0.0)};
}

}  // namespace kds::certificates
