// Eight times in a cache line: which is the least, all compared at once.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <new>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace kds::detail {

/// For vectors that begin with a cache line.
template <class T>
struct LineAllocator {
  using value_type = T;
  static constexpr std::align_val_t line{64};  ///< bytes

  LineAllocator() = default;
  template <class Other>
  LineAllocator(const LineAllocator<Other>&) {}

  T* allocate(std::size_t n) { return static_cast<T*>(::operator new(n * sizeof(T), line)); }
  void deallocate(T* memory, std::size_t) { ::operator delete(memory, line); }

  friend bool operator==(const LineAllocator&, const LineAllocator&) { return true; }
};

/// The least of some times, and who has it: two bits each, in their order.
struct LeastTime {
  double time;
  unsigned who;

  std::size_t first() const { return static_cast<std::size_t>(__builtin_ctz(who)) / 2; }
  bool has(std::size_t i) const { return (who >> (2 * i) & 1) != 0; }
  /// Several that are equal. (All are, where there is no event.)
  bool shared() const { return who >> (2 * first()) != 3 && time < std::numeric_limits<double>::infinity(); }
};

/// Precondition: eight times, none a NaN, at the beginning of a cache line.
inline LeastTime least_of_eight(const double* times) {
#ifdef __SSE2__
  const __m128d a = _mm_load_pd(times);
  const __m128d b = _mm_load_pd(times + 2);
  const __m128d c = _mm_load_pd(times + 4);
  const __m128d d = _mm_load_pd(times + 6);
  const __m128d m = _mm_min_pd(_mm_min_pd(a, b), _mm_min_pd(c, d));
  const __m128d least = _mm_min_pd(m, _mm_shuffle_pd(m, m, 1));
  const auto has = [&](__m128d x) { return _mm_castpd_si128(_mm_cmpeq_pd(x, least)); };
  const __m128i who = _mm_packs_epi16(_mm_packs_epi32(has(a), has(b)), _mm_packs_epi32(has(c), has(d)));
  return {_mm_cvtsd_f64(least), static_cast<unsigned>(_mm_movemask_epi8(who))};
#else
  const double least = *std::min_element(times, times + 8);
  unsigned who = 0;
  for (std::size_t i = 0; i < 8; ++i) who |= times[i] == least ? 3u << (2 * i) : 0;
  return {least, who};
#endif
}

}  // namespace kds::detail
