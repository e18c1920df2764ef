// Certificates of several things whose sign changes when two of these are exchanged.
#pragma once

#include <array>
#include <cstddef>
#include <utility>

namespace kds {

/// Whether the others are the same things, by their addresses, after an odd number of exchanges. So a certificate that
/// changes its sign with each exchange is the negative of that of the others.
template <class T, std::size_t N>
bool is_odd_permutation(std::array<const T*, N> things, const std::array<const T*, N>& others) {
  bool odd = false;
  for (std::size_t i = 0; i < N; ++i) {
    std::size_t j = i;
    while (j < N && things[j] != others[i]) ++j;
    if (j == N) return false;
    if (j == i) continue;
    std::swap(things[i], things[j]);
    odd = !odd;
  }
  return odd;
}

}  // namespace kds
