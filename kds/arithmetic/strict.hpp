// Checks the assumption of all exact signs: + - * / and sqrt of doubles are rounded once, to the nearest double.
#pragma once

#include <cfloat>
#include <limits>
#include <stdexcept>
#include <string>

// The error bounds of kds are those of single operations in the order in which they are written. Options that let a
// compiler reorder or contract them make it remove the very terms that measure an error.
#if defined(__FAST_MATH__)
#error "kds: compile without -ffast-math and -Ofast: signs are exact only if every operation is rounded as it is written"
#elif defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__
#error "kds: compile without -ffinite-math-only: times that never come are infinite, and what is undecided is a NaN"
#elif defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__)
#error "kds: compile without -funsafe-math-optimizations, -fassociative-math and -freciprocal-math: signs are exact only if every operation is rounded as it is written"
#elif FLT_EVAL_METHOD != 0
#error "kds: compile for arithmetic in double precision (SSE2, not x87; FLT_EVAL_METHOD == 0): signs are exact only if every operation is rounded to a double"
#endif

namespace kds {
namespace detail {

[[noreturn]] inline void refuse_arithmetic(const char* who, const char* why) {
  throw std::runtime_error(std::string(who) + ": " + why);
}

}  // namespace detail

/// Throws std::runtime_error, in the name of `who`, if the thread that calls it, or the file that it is compiled with,
/// does not calculate as the exact signs need it: rounding to nearest, with subnormal numbers, each operation by itself
/// and in the order written. Graphics and audio libraries, and any shared library linked with -ffast-math, are known to
/// change the mode of the processor and to leave it so; and not every compiler defines macros, as are tested above, for
/// all these options.
///
/// Cost: about ten operations. Worlds, simulators and sorted lists call it when they are made; a program that changes
/// the mode later, or runs them in another thread, may call it there.
[[gnu::always_inline]] inline void require_strict_arithmetic(const char* who) {
  const auto refuse = [who](const char* why) { detail::refuse_arithmetic(who, why); };
  // Volatile: calculated at run time, and not by the compiler.
  volatile double one = 1;
  volatile double tiny = std::numeric_limits<double>::epsilon() / 1024;  // far below half a rounding of 1
  volatile double sum = one + tiny;
  volatile double difference = one - tiny;
  if (sum != one || difference != one) {
    refuse("this thread does not round to nearest: call std::fesetround(FE_TONEAREST) first");
  }
  volatile double normal = std::numeric_limits<double>::min();
  volatile double subnormal = std::numeric_limits<double>::denorm_min();
  volatile double half = normal * 0.5;
  volatile double enlarged = subnormal * 0x1p60;
  if (half == 0 || enlarged == 0) {
    refuse("this thread takes subnormal numbers for zero: switch off FTZ and DAZ (on x86 by _mm_setcsr) first");
  }
  const double small = one;
  const double large = 0x1p60 * small;
  volatile double lost = (small + large) - large;
  if (lost != 0) refuse("it is compiled with options that change the order of sums, such as -fassociative-math");
  const double factor = one + 0x1p-30;
  const double square = 1 + 0x1p-29 * small;
  volatile double rounding = factor * factor - square;  // 2^-60, if it is not rounded in between
  if (rounding != 0) refuse("it is compiled with fused multiply-add for * and +: use -ffp-contract=off");
}

}  // namespace kds
