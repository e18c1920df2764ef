// Vectors whose memory is kept for the next ones.
#pragma once

#include <cstddef>
#include <new>
#include <vector>

namespace kds {
namespace detail {

/// As ::operator new and ::operator delete; of what is given back the thread keeps some, for its next requests of about
/// the same size.
void* take_memory(std::size_t bytes);
void keep_memory(void* memory, std::size_t bytes) noexcept;

}  // namespace detail

/// For large arrays that are made and thrown away again and again. The C library gives much memory back to the system
/// each time, and gets it page by page, filled with zeros, when it is asked for again, which may take longer than what
/// the array is made for: a test of two surfaces of 6 000 triangles takes eight times as long. Cost: a thread
/// keeps up to eight arrays, of 32 MB in all, until it ends; an array takes up to a quarter more.
template <class T>
struct KeptAllocator {
  using value_type = T;
  static_assert(alignof(T) <= __STDCPP_DEFAULT_NEW_ALIGNMENT__);

  KeptAllocator() = default;
  template <class Other>
  KeptAllocator(const KeptAllocator<Other>&) {}

  T* allocate(std::size_t n) {
    if (n > static_cast<std::size_t>(-1) / 2 / sizeof(T)) throw std::bad_array_new_length();
    return static_cast<T*>(detail::take_memory(n * sizeof(T)));
  }
  void deallocate(T* memory, std::size_t n) noexcept { detail::keep_memory(memory, n * sizeof(T)); }

  friend bool operator==(const KeptAllocator&, const KeptAllocator&) { return true; }
};

template <class T>
using KeptVector = std::vector<T, KeptAllocator<T>>;

}  // namespace kds
