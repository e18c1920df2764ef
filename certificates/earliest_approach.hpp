// When balls may meet, in registers of several doubles: a lower bound, lane by lane.
#pragma once

#include "certificates/relative_line.hpp"
#include "kds/arithmetic/lattice.hpp"

#include <cstddef>

namespace kds::certificates::detail {

/// Four pairs of balls, each read as the bytes of a MovingBall: the doubles of its coefficients, three of each, its
/// start and its radius.
struct FourPairs {
  const std::byte* a[4];
  const std::byte* b[4];
};

/// A double of a ball, by its place from 0.
[[gnu::always_inline]] inline double number_of(const std::byte* ball, int i) {
  double x;
  __builtin_memcpy(&x, ball + i * static_cast<int>(sizeof x), sizeof x);
  return x;
}

/// The numbers of a MovingBall, lane by lane.
template <class Lanes, int PathDegree>
struct BallNumbers {
  MotionNumbers<Lanes, PathDegree> motion;
  Lanes radius;
};

/// x in each lane.
template <class Lanes>
[[gnu::always_inline]] inline Lanes all(double x) {
  return x - Lanes{};
}

/// See BallsTogether::earliest_approaches(). `known` where the path is a line.
///
/// Along a line f (the square of the distance less that of the sum of the radii) is convex: its first root is where it
/// falls, at c / (p + sqrt(p^2 - c s)) with c = f now, p = -f' / 2 now and s = v . v. Bounds in place of c, p and the
/// discriminant give a lower bound of the root, whether or not there is one.
///
/// Without a branch, since processors cannot predict whether balls approach; and all functions that it calls are
/// inlined (see kds/simd/four_wide.hpp).
template <class Lanes, class Bits>
[[gnu::always_inline]] inline Lanes earliest_approach(const RelativeLine<Lanes>& line, Bits known, double now,
                                                      double horizon) {
  using Line = RelativeLine<Lanes>;
  const Lanes undecided = all<Lanes>(__builtin_nan(""));
  const Lanes no_meeting = all<Lanes>(never);
  const Lanes error = Line::unit * (line.M * line.W) + Line::lost;  // of the product
  const Lanes size = line.M * line.M + line.radii * line.radii;
  const Lanes least = line.square - (Line::unit * size + Line::lost);
  // The discriminant is off by unit W^2 (4 M^2 + 2 radii^2), and by its own rounding.
  const Lanes spare = 8 * Line::unit * (line.W * line.W) * size + Line::lost;
  const Lanes discriminant = line.product * line.product - line.square * line.speeds + spare;
  const Lanes root = least / (square_root(discriminant) - line.product + error);
  const Lanes sum = now + root * (1 - 0x1p-50);
  const Lanes t = sum - 0x1p-52 * magnitude(sum);  // a lower bound in spite of rounding

  known &= line.M + line.W + line.radii < Line::small;
  const Bits apart = least > 0.0;
  const Bits parts = (line.product > error) | (line.W == 0.0);               // or they move alike
  Lanes earliest = t <= horizon ? greater(t, all<Lanes>(now)) : no_meeting;  // t is a NaN where there is no root
  const Bits comes = apart & (line.product < -error);
  earliest = comes ? earliest : undecided;
  earliest = parts ? (apart ? no_meeting : -no_meeting) : earliest;
  return known ? earliest : undecided;
}

/// How many doubles a register has.
template <class Lanes>
inline constexpr int lanes_of = sizeof(Lanes) / sizeof(double);

/// Reads as many balls as a register has doubles.
template <int PathDegree>
[[gnu::always_inline]] inline void read(const std::byte* const* balls, BallNumbers<Two, PathDegree>& numbers) {
  const auto place = [&](int i) { return Two{number_of(balls[0], i), number_of(balls[1], i)}; };
  for (int k = 0; k <= PathDegree; ++k) {
    for (int d = 0; d < 3; ++d) numbers.motion.coefficients[k][d] = place(3 * k + d);
  }
  constexpr int start = 3 * (PathDegree + 1);
  numbers.motion.start = place(start);
  numbers.radius = place(start + 1);
}

template <class Lanes, int PathDegree>
[[gnu::always_inline]] inline void find_approaches_in(const FourPairs& pairs, double now, double horizon,
                                                      double* earliest) {
  constexpr int width = lanes_of<Lanes>;
  for (int first = 0; first < 4; first += width) {
    BallNumbers<Lanes, PathDegree> a, b;
    read(pairs.a + first, a);
    read(pairs.b + first, b);
    const Lanes radii = a.radius + b.radius;
    auto known = radii == radii;
    if constexpr (PathDegree > 1) {
      for (int d = 0; d < 3; ++d) known &= a.motion.coefficients[2][d] == b.motion.coefficients[2][d];
    }
    const Lanes found = earliest_approach(RelativeLine<Lanes>(a.motion, b.motion, radii, now), known, now, horizon);
    __builtin_memcpy(earliest + first, &found, sizeof found);
  }
}

/// In registers of four doubles where the build and the processor have them, else of two.
template <int PathDegree>
void find_approaches(const FourPairs& pairs, double now, double horizon, double* earliest);

/// In registers of two.
template <int PathDegree>
void find_approaches_by_two(const FourPairs& pairs, double now, double horizon, double* earliest);

/// In registers of four; for processors with AVX2 only.
template <int PathDegree>
void find_approaches_by_four(const FourPairs& pairs, double now, double horizon, double* earliest);

}  // namespace kds::certificates::detail
