// Four doubles at a time, in one register of processors with AVX2.
#pragma once

#ifdef __AVX2__

#include <immintrin.h>

#include <cstdint>

namespace kds {

/// As Two (two_doubles.hpp), for files that are compiled for processors with registers of that size. Such a file has
/// functions of these types only, and all others inlined: of an ordinary function that two files contain the linker may
/// take either, and so call AVX2 instructions where there are none.
using Four = double __attribute__((vector_size(32)));
using FourBits = std::int64_t __attribute__((vector_size(32)));

[[gnu::always_inline]] inline Four magnitude(Four x) {
  return reinterpret_cast<Four>(reinterpret_cast<FourBits>(x) & INT64_MAX);
}

/// Lane by lane; where one is not a number the second.
[[gnu::always_inline]] inline Four greater(Four x, Four y) { return x > y ? x : y; }

[[gnu::always_inline]] inline Four square_root(Four x) { return _mm256_sqrt_pd(x); }

/// Lane j of places[i] is lane i of the j-th. In intrinsics, since compilers need more instructions for the generic
/// shuffles.
[[gnu::always_inline]] inline void transpose(Four x0, Four x1, Four x2, Four x3, Four (&places)[4]) {
  const Four even01 = _mm256_unpacklo_pd(x0, x1), odd01 = _mm256_unpackhi_pd(x0, x1);
  const Four even23 = _mm256_unpacklo_pd(x2, x3), odd23 = _mm256_unpackhi_pd(x2, x3);
  places[0] = _mm256_permute2f128_pd(even01, even23, 0x20);
  places[1] = _mm256_permute2f128_pd(odd01, odd23, 0x20);
  places[2] = _mm256_permute2f128_pd(even01, even23, 0x31);
  places[3] = _mm256_permute2f128_pd(odd01, odd23, 0x31);
}

}  // namespace kds

#endif
