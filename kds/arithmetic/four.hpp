// Four doubles at a time.
#pragma once

#ifdef __AVX2__

#include "kds/arithmetic/strict.hpp"

#include <immintrin.h>

#include <cstdint>

namespace kds {

/// As Two (two.hpp), for files that are compiled for processors with registers of that size. Such a file has functions
/// of these alone, all others inlined: of an ordinary function that is in two files any one may be linked.
using Four = double __attribute__((vector_size(32)));
using FourBits = std::int64_t __attribute__((vector_size(32)));

[[gnu::always_inline]] inline Four magnitude(Four x) {
  return reinterpret_cast<Four>(reinterpret_cast<FourBits>(x) & INT64_MAX);
}

/// Lane by lane; where one is not a number the second.
[[gnu::always_inline]] inline Four greater(Four x, Four y) { return x > y ? x : y; }

[[gnu::always_inline]] inline Four square_root(Four x) { return _mm256_sqrt_pd(x); }

}  // namespace kds

#endif
