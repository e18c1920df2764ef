// Eight times in a cache line, compared at once: which is the least.
#pragma once

#include "kds/simd/target.hpp"

#include <cstddef>
#include <limits>
#include <new>

namespace kds::detail {

/// An allocator for vectors that begin at a cache line.
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

/// The least of some times, and whose it is: two bits each, in their order.
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
  const auto [time, who] = simd::target::least_of_eight(times);
  return {time, who};
}

}  // namespace kds::detail
