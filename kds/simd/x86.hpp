// The functions of portable.hpp in instructions of x86 processors with SSE2. These are all intrinsics of the library,
// except those of wider registers in four_wide.hpp.
//
// They are in a header because each is one to ten instructions in the innermost loop of its caller: a call would cost
// more than the function.
#pragma once

#ifdef __SSE2__

#include "kds/simd/vectors.hpp"

#include <emmintrin.h>

#include <cstdint>

namespace kds::simd::x86 {

[[gnu::always_inline]] inline Two square_root(Two x) { return _mm_sqrt_pd(x); }
[[gnu::always_inline]] inline FourFloats square_root(FourFloats x) { return _mm_sqrt_ps(x); }

[[gnu::always_inline]] inline Two lesser(Two x, Two y) { return _mm_min_pd(x, y); }
[[gnu::always_inline]] inline Two greater(Two x, Two y) { return _mm_max_pd(x, y); }
[[gnu::always_inline]] inline FourFloats lesser(FourFloats x, FourFloats y) { return _mm_min_ps(x, y); }
[[gnu::always_inline]] inline FourFloats greater(FourFloats x, FourFloats y) { return _mm_max_ps(x, y); }

[[gnu::always_inline]] inline unsigned set_of_two(TwoBits x) {
  return static_cast<unsigned>(_mm_movemask_pd(reinterpret_cast<__m128d>(x)));
}
[[gnu::always_inline]] inline unsigned set_of_four(FourFloatsBits x) {
  return static_cast<unsigned>(_mm_movemask_ps(reinterpret_cast<__m128>(x)));
}

[[gnu::always_inline]] inline LeastOfEight least_of_eight(const double* numbers) {
  const __m128d a = _mm_load_pd(numbers);
  const __m128d b = _mm_load_pd(numbers + 2);
  const __m128d c = _mm_load_pd(numbers + 4);
  const __m128d d = _mm_load_pd(numbers + 6);
  const __m128d m = _mm_min_pd(_mm_min_pd(a, b), _mm_min_pd(c, d));
  const __m128d least = _mm_min_pd(m, _mm_shuffle_pd(m, m, 1));
  const auto has = [&](__m128d x) { return _mm_castpd_si128(_mm_cmpeq_pd(x, least)); };
  const __m128i who = _mm_packs_epi16(_mm_packs_epi32(has(a), has(b)), _mm_packs_epi32(has(c), has(d)));
  return {_mm_cvtsd_f64(least), static_cast<unsigned>(_mm_movemask_epi8(who))};
}

[[gnu::always_inline]] inline std::uint64_t within_limits(const EightBytes* four, EightBytes limits) {
  const __m128i most = _mm_set1_epi64x(static_cast<long long>(limits));
  const auto* const from = reinterpret_cast<const __m128i*>(four);
  const auto exceed = [&](const __m128i& two) { return _mm_cmpgt_epi8(_mm_load_si128(&two), most); };
  const __m128i all = _mm_packs_epi32(exceed(from[0]), exceed(from[1]));  // only zero becomes zero
  const __m128i none_exceeds = _mm_cmpeq_epi32(all, _mm_setzero_si128());
  return static_cast<std::uint64_t>(_mm_movemask_ps(_mm_castsi128_ps(none_exceeds)));
}

}  // namespace kds::simd::x86

#endif
