// Eight floats at a time, in one register of processors with AVX2.
#pragma once

#ifdef __AVX2__

#include <immintrin.h>

#include <cstdint>
#include <limits>

namespace kds {

/// As FourFloats (four_floats.hpp), for files that are compiled for processors with registers of that size: the rules
/// for such files are in four_wide.hpp.
using EightFloats = float __attribute__((vector_size(32)));
using EightFloatsBits = std::int32_t __attribute__((vector_size(32)));

[[gnu::always_inline]] inline EightFloats magnitude(EightFloats x) {
  return reinterpret_cast<EightFloats>(reinterpret_cast<EightFloatsBits>(x) & INT32_MAX);
}

[[gnu::always_inline]] inline EightFloats square_root(EightFloats x) { return _mm256_sqrt_ps(x); }

/// x where a comparison holds, else y.
[[gnu::always_inline]] inline EightFloats where(EightFloatsBits holds, EightFloats x, EightFloats y) {
  return _mm256_blendv_ps(y, x, reinterpret_cast<__m256>(holds));
}
/// x where a comparison holds, else 0.
[[gnu::always_inline]] inline EightFloats where(EightFloatsBits holds, EightFloats x) {
  return reinterpret_cast<EightFloats>(holds & reinterpret_cast<EightFloatsBits>(x));
}
/// x, or -x where the sign bit of a number is set.
[[gnu::always_inline]] inline EightFloats signed_by(EightFloats number, EightFloats x) {
  const EightFloatsBits sign = reinterpret_cast<EightFloatsBits>(number) & INT32_MIN;
  return reinterpret_cast<EightFloats>(sign ^ reinterpret_cast<EightFloatsBits>(x));
}

/// Lane by lane; where one is not a number the second.
[[gnu::always_inline]] inline EightFloats lesser(EightFloats x, EightFloats y) { return _mm256_min_ps(x, y); }
[[gnu::always_inline]] inline EightFloats greater(EightFloats x, EightFloats y) { return _mm256_max_ps(x, y); }

/// Bit i if a comparison holds in lane i.
[[gnu::always_inline]] inline unsigned set_of_lanes(EightFloatsBits x) {
  return static_cast<unsigned>(_mm256_movemask_ps(reinterpret_cast<__m256>(x)));
}

/// Three of the four floats from a place on in each of eight rows: lane i of x, y and z is from the i-th.
[[gnu::always_inline]] inline void read_three(const float* const* rows, int place, EightFloats& x, EightFloats& y,
                                              EightFloats& z) {
  const auto two = [&](int i) __attribute__((always_inline)) {
    return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(rows[i] + place)),
                                _mm_loadu_ps(rows[i + 4] + place), 1);
  };
  const __m256 of_0 = two(0), of_1 = two(1), of_2 = two(2), of_3 = two(3);
  const __m256 low_even = _mm256_unpacklo_ps(of_0, of_2), low_odd = _mm256_unpacklo_ps(of_1, of_3);
  x = _mm256_unpacklo_ps(low_even, low_odd);
  y = _mm256_unpackhi_ps(low_even, low_odd);
  z = _mm256_unpacklo_ps(_mm256_unpackhi_ps(of_0, of_2), _mm256_unpackhi_ps(of_1, of_3));
}

}  // namespace kds

#endif
