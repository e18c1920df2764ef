// Four floats at a time.
#pragma once

#include "kds/simd/target.hpp"
#include "kds/simd/vectors.hpp"

#include <cstdint>
#include <limits>

namespace kds {

inline FourFloats splat(float x) { return FourFloats{x, x, x, x}; }

inline FourFloats magnitude(FourFloats x) {
  return reinterpret_cast<FourFloats>(reinterpret_cast<FourFloatsBits>(x) & std::numeric_limits<std::int32_t>::max());
}

inline FourFloats square_root(FourFloats x) { return simd::target::square_root(x); }

/// x where a comparison holds, else y.
inline FourFloats where(FourFloatsBits holds, FourFloats x, FourFloats y) {
  return reinterpret_cast<FourFloats>((holds & reinterpret_cast<FourFloatsBits>(x)) |
                                      (~holds & reinterpret_cast<FourFloatsBits>(y)));
}
/// x where a comparison holds, else 0.
inline FourFloats where(FourFloatsBits holds, FourFloats x) {
  return reinterpret_cast<FourFloats>(holds & reinterpret_cast<FourFloatsBits>(x));
}
/// x, or -x where the sign bit of a number is set.
inline FourFloats signed_by(FourFloats number, FourFloats x) {
  const FourFloatsBits sign = reinterpret_cast<FourFloatsBits>(number) & std::numeric_limits<std::int32_t>::min();
  return reinterpret_cast<FourFloats>(sign ^ reinterpret_cast<FourFloatsBits>(x));
}

/// Lane by lane; where one is not a number the second.
inline FourFloats lesser(FourFloats x, FourFloats y) { return simd::target::lesser(x, y); }
inline FourFloats greater(FourFloats x, FourFloats y) { return simd::target::greater(x, y); }

inline float lowest(FourFloats x) {
  x = lesser(x, __builtin_shufflevector(x, x, 2, 3, 0, 1));
  x = lesser(x, __builtin_shufflevector(x, x, 1, 0, 3, 2));
  return x[0];
}
inline float highest(FourFloats x) {
  x = greater(x, __builtin_shufflevector(x, x, 2, 3, 0, 1));
  x = greater(x, __builtin_shufflevector(x, x, 1, 0, 3, 2));
  return x[0];
}

/// Bit i if a comparison holds in lane i.
inline unsigned set_of_four(FourFloatsBits x) { return simd::target::set_of_four(x); }
/// Whether a comparison holds in all lanes.
inline bool all_set(FourFloatsBits x) { return set_of_four(x) == 0xF; }

}  // namespace kds
