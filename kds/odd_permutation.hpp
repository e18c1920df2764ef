// Certificates of several things whose sign changes when two of these are exchanged.
#pragma once

#include "kds/lasting.hpp"

#include <array>
#include <cstddef>
#include <utility>

namespace kds {

namespace detail {

template <std::size_t N, class Thing, class Same>
bool is_odd_permutation_by(std::array<const Thing*, N> things, const std::array<const Thing*, N>& others,
                           const Same& same) {
  bool odd = false;
  for (std::size_t i = 0; i < N; ++i) {
    std::size_t j = i;
    while (j < N && !same(*things[j], *others[i])) ++j;
    if (j == N) return false;
    if (j == i) continue;
    std::swap(things[i], things[j]);
    odd = !odd;
  }
  return odd;
}

}  // namespace detail

/// Whether the others are the same things, by their addresses, after an odd number of exchanges. So a certificate that
/// changes its sign with each exchange is the negative of that of the others. Copies of points (PathCopy) may all be
/// displaced by one vector: such a certificate has to be of their relative positions.
template <class T, std::size_t N>
bool is_odd_permutation(const std::array<const T*, N>& things, const std::array<const T*, N>& others) {
  if constexpr (Refers<T>) {
    for (const T* other : others) {
      if (!is_copy_of_same(*things[0], *other)) continue;
      const auto displaced_as_that = [&](const T& a, const T& b) {
        return is_copy_of_same(a, b) && a.offset - things[0]->offset == b.offset - other->offset;
      };
      if (detail::is_odd_permutation_by(things, others, displaced_as_that)) return true;
    }
    return false;
  } else {
    return detail::is_odd_permutation_by(things, others, is_same_thing<T>);
  }
}

}  // namespace kds
