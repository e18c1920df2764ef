// Vectors whose memory comes in large pages where there is much of it.
#pragma once

#include <cstddef>
#include <new>
#include <vector>

namespace kds {
namespace detail {

/// Bytes from which memory is asked for in large pages: two of these.
inline constexpr std::size_t large_page = std::size_t{2} << 20;
inline constexpr std::size_t much_memory = 2 * large_page;

/// As ::operator new and ::operator delete, at a boundary of large pages; where the system has these (Linux), it is
/// asked to use them.
void* allocate_large_pages(std::size_t bytes);
void free_large_pages(void* memory) noexcept;

}  // namespace detail

/// Allocates little memory as std::allocator does, and much in large pages. What touches many places of a large array
/// in no order spends most of its time on finding the addresses of ordinary pages: a gas of 100 000 balls takes a fifth
/// less time, a thin one of 400 000 two fifths (docs/what-was-tried.md). Cost: a large page is used whole.
template <class T>
struct LargeAllocator {
  using value_type = T;

  LargeAllocator() = default;
  template <class Other>
  LargeAllocator(const LargeAllocator<Other>&) {}

  T* allocate(std::size_t n) {
    if (n < detail::much_memory / sizeof(T)) return static_cast<T*>(::operator new(n * sizeof(T), alignment));
    if (n > static_cast<std::size_t>(-1) / sizeof(T)) throw std::bad_array_new_length();
    return static_cast<T*>(detail::allocate_large_pages(n * sizeof(T)));
  }
  void deallocate(T* memory, std::size_t n) noexcept {
    if (n < detail::much_memory / sizeof(T)) return ::operator delete(memory, alignment);
    detail::free_large_pages(memory);
  }

  friend bool operator==(const LargeAllocator&, const LargeAllocator&) { return true; }

 private:
  static constexpr std::align_val_t alignment{alignof(T)};
};

/// For arrays by body, slot or cell, which grow with the scene.
template <class T>
using LargeVector = std::vector<T, LargeAllocator<T>>;

}  // namespace kds
